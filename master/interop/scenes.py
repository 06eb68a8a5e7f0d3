"""Scenes from wherever they come: the project's own, files of the user's, packages of other tools."""

from __future__ import annotations

from pathlib import Path

from touchdown.master.common.errors import TouchdownError
from touchdown.master.interop.ssp.read import read
from touchdown.master.scene import file
from touchdown.master.scene.scene import Scene


def find_scene(name: str) -> Scene:
    """A scene of the project's by name, or of the user's by the path of a .toml or an SSP package (.ssp).

    Raises TouchdownError where there is none, or it has a mistake.
    """
    if "\0" in name:
        raise TouchdownError(f"no scene can be called {name!r}")
    return read(Path(name)) if name.endswith(".ssp") else file.load_scene(name)
