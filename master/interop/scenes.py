"""Scenes from wherever they come: the project's own, files of the user's, packages of other tools."""

from __future__ import annotations

from pathlib import Path

from ..common.errors import TouchdownError
from ..scene import file
from ..scene.file import read_resolved
from ..scene.scene import Scene
from .ssp.read import read


def find_scene(name: str) -> Scene:
    """A scene of the project's by name, or by path: a .toml of the user's, an SSP package (.ssp), or the
    scene.json that a run left.

    Raises TouchdownError where there is none, or it has a mistake.
    """
    if "\0" in name:
        raise TouchdownError(f"no scene can be called {name!r}")
    if name.endswith(".ssp"):
        return read(Path(name))
    return read_resolved(Path(name)) if name.endswith(".json") else file.load_scene(name)
