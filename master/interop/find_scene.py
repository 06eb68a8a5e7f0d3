"""Finds a scene: the project's own, a file of the user's, or a package of another tool."""

from __future__ import annotations

from pathlib import Path

from ..common.errors import TouchdownError
from ..scene import file
from ..scene.file import read_resolved
from ..scene.scene import Scene
from .ssp.read import read_package


def find_scene(name: str, variant: str = "") -> Scene:
    """A scene of the project's by name, or by path: a .toml of the user's, an SSP package (.ssp), or the
    scene.json that a run left.

    variant: of a package, the name of another of its .ssd files.
    Raises TouchdownError where it is missing or has a mistake.
    """
    if "\0" in name:
        raise TouchdownError(f"no scene can be called {name!r}")
    if name.endswith(".ssp"):
        return read_package(Path(name), variant)
    if variant:
        raise TouchdownError(f"{name} has no variants; only a package (.ssp) can have some")
    return read_resolved(Path(name)) if name.endswith(".json") else file.load_scene(name)
