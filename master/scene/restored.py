"""A scene read back from the values that `Scene.resolved` gives, as a run leaves them in scene.json."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from touchdown.master.common.errors import TouchdownError
from touchdown.master.scene.run_spec import RunSpec, with_changes
from touchdown.master.scene.scene import ComponentSpec, Scene
from touchdown.master.scene.wires import BondSpec, Wire


def read_resolved(path: Path) -> Scene:
    """The scene in a scene.json. Raises TouchdownError where it cannot be read, or is none."""
    try:
        return restored(json.loads(path.read_text(encoding="utf-8")))
    except OSError as error:
        raise TouchdownError(f"cannot read scene {path}: {error.strerror}") from None
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        what = f"{type(error).__name__}: {error}"
        raise TouchdownError(f"scene {path} is not as a run leaves it ({what}); give a .toml") from None


def restored(values: Mapping[str, Any]) -> Scene:
    """The scene whose `resolved()` gives `values`, lists taken as tuples and paths as text.

    Raises TouchdownError, KeyError or TypeError where they are not such values.
    """
    parts = dict(values)
    parts |= {
        "components": {name: _component(part) for name, part in parts["components"].items()},
        "attach": _pairs(parts["attach"]),
        "sense": _pairs(parts["sense"]),
        "connect": tuple(_wire(wire) for wire in parts["connect"]),
        "bond": tuple(_bond(*bond) for bond in parts["bond"]),
        "energy_scale": tuple(parts["energy_scale"]),
        "own": tuple(parts["own"]),
        "run": with_changes(RunSpec(), parts["run"]),
        "folder": Path(parts["folder"]),
    }
    return Scene(**parts)


def _component(values: Mapping[str, Any]) -> ComponentSpec:
    parts = dict(values)
    parts["own"] = tuple(parts["own"])
    return ComponentSpec(**parts)


def _pairs(pairs: Sequence[Sequence[str]]) -> tuple[tuple[str, str], ...]:
    return tuple((first, second) for first, second in pairs)


def _wire(wire: Sequence[Any]) -> Wire:
    source, target, scale = wire
    return Wire(source, target, scale and (scale[0], scale[1]))


def _bond(force: Any, position: Any, velocity: Any, motion: Sequence[Any]) -> BondSpec:
    return BondSpec(
        _wire(force),
        position and _wire(position),
        velocity and _wire(velocity),
        tuple(_wire(wire) for wire in motion),
    )
