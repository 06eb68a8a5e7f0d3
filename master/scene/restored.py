"""A scene read back from the values that `Scene.resolved` gives, as a run leaves them in scene.json."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from touchdown.master.common.errors import TouchdownError
from touchdown.master.scene.run_spec import READERS, RunSpec, with_changes
from touchdown.master.scene.scene import ComponentSpec, Scene
from touchdown.master.scene.tables import (
    pairs,
    reference,
    references,
    refuse_unknown,
    switch,
    table,
    whole,
)
from touchdown.master.scene.wires import BondSpec, Wire


def read_resolved(path: Path) -> Scene:
    """The scene in a scene.json. Raises TouchdownError where it cannot be read, or is none."""
    try:
        return restored(json.loads(path.read_text(encoding="utf-8")))
    except TouchdownError as error:
        raise TouchdownError(f"scene {path}: {error}") from None
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
    given = table(parts["components"], "components")
    own = tuple(parts["own"])
    refuse_unknown(dict.fromkeys(own), tuple(READERS), "own")
    parts |= {
        **{key: _text(parts[key], key) for key in ("name", "title", "about")},
        "components": {name: _component(part, f"components.{name}") for name, part in given.items()},
        "attach": pairs(parts["attach"], "attach"),
        "sense": pairs(parts["sense"], "sense"),
        "connect": tuple(_wire(wire) for wire in parts["connect"]),
        "bond": tuple(_bond(*bond) for bond in parts["bond"]),
        "zero": None if parts["zero"] is None else reference(parts["zero"], "zero"),
        "energy_scale": references(parts["energy_scale"], "energy_scale"),
        "own": own,
        "run": with_changes(RunSpec(), table(parts["run"], "run")),
        "folder": Path(parts["folder"]),
    }
    return Scene(**parts)


def _component(values: object, where: str) -> ComponentSpec:
    parts = dict(table(values, where))
    settings, own = table(parts["set"], f"{where}.set"), tuple(parts["own"])
    refuse_unknown(dict.fromkeys(own), (*settings, "preset"), f"{where}.own")
    names = table(parts["names"], f"{where}.names")
    parts |= {
        **{key: _text(parts[key], f"{where}.{key}") for key in ("fmu", "instead_of")},
        "set": settings,
        "preset": None if parts["preset"] is None else _text(parts["preset"], f"{where}.preset"),
        "every": whole(parts["every"], f"{where}.every"),
        "names": {name: _text(own_name, f"{where}.names.{name}") for name, own_name in names.items()},
        "inherited": table(parts["inherited"], f"{where}.inherited"),
        **{key: switch(parts[key], f"{where}.{key}") for key in ("isolate", "native")},
        "own": own,
    }
    return ComponentSpec(**parts)


def _text(value: object, where: str) -> str:
    if not isinstance(value, str):
        raise TouchdownError(f"{where} = {value!r} must be text")
    return value


def _wire(wire: Sequence[Any]) -> Wire:
    source, target, scale = wire
    return Wire(reference(source, "wire"), reference(target, "wire"), scale and (scale[0], scale[1]))


def _bond(force: Any, position: Any, velocity: Any, motion: Sequence[Any]) -> BondSpec:
    return BondSpec(
        _wire(force),
        position and _wire(position),
        velocity and _wire(velocity),
        tuple(_wire(wire) for wire in motion),
    )
