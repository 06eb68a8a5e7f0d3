"""Completions for the shell at <TAB>. Where nothing fits, it offers files.

Nothing that is slow to import is imported here: an answer takes a few tenths of a second.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterable
from typing import Any

from ..master.common.errors import TouchdownError

Completer = Callable[..., Iterable[str]]
"""Takes `prefix`, what is typed of the word, and `parsed_args`, the options before it."""


def _scenes(**_: object) -> list[str]:
    """Names of the scenes that come with the project."""
    from ..master.scene.file import shipped_scenes

    return list(shipped_scenes())


def _figures(**_: object) -> list[str]:
    """Names of figures and tables of Halminen (2016)."""
    from ..validation.case import figures

    return ["all", "list", *figures(studies=True)]


def _fmus(**_: object) -> list[str]:
    """Names of the project's models."""
    from ..fmus.model_names import models

    return list(models())


def _targets(**_: object) -> list[str]:
    """Machines that native FMUs are built for."""
    from ..fmus.native.compiler import TARGETS

    return list(TARGETS)


def _settings(parsed_args: argparse.Namespace, **_: object) -> list[str]:
    """NAME= of what --set takes: the keys of [run], and what the scene itself sets."""
    from ..master.scene.run_spec import RunSpec
    from ..master.scene.tables import dotted_keys

    keys = [f"run.{key}=" for key in RunSpec.__dataclass_fields__]
    for name, part in _components(parsed_args):
        keys += [f"{name}.{key}=" for key in dotted_keys(part.get("set", {}))]
    return keys


def _swaps(parsed_args: argparse.Namespace, **_: object) -> list[str]:
    """COMPONENT=FMU of what --swap takes."""
    return [f"{name}={fmu}" for name, _ in _components(parsed_args) for fmu in _fmus()]


def components(parsed_args: argparse.Namespace, **_: object) -> list[str]:
    """Names of the scene's components."""
    return [name for name, _ in _components(parsed_args)]


def _components(parsed_args: argparse.Namespace) -> list[tuple[str, Any]]:
    """[components] of the scene that is named already, unchecked; none where it cannot be read."""
    from ..master.scene.file import locate_scene, merged_tables

    try:
        return list(merged_tables(locate_scene(parsed_args.scene_name))["components"].items())
    except (AttributeError, KeyError, TouchdownError):
        return []


COMPLETERS: dict[str, Completer] = {  # by the parameter of which an option is
    "scene_name": _scenes,
    "rotors": _scenes,
    "settings": _settings,
    "swap": _swaps,
    "component": components,
    "fmus": _fmus,
    "targets": _targets,
    "figure_name": _figures,
}
