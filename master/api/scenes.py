"""Scenes by name, from files, or as they are."""

from __future__ import annotations

import os

from touchdown.master.interop import scenes as anywhere
from touchdown.master.scene.file import shipped
from touchdown.master.scene.scene import Scene

PathLike = str | os.PathLike[str]


def scenes() -> dict[str, str]:
    """The scenes that come with the project: titles by name.

    >>> touchdown.scenes()["rotor2-case1"]
    'Rotor II dropped at 10000 rpm, bearings in line'
    """
    return {name: load(name).title for name in shipped()}


def load(name_or_path: PathLike) -> Scene:
    """A scene by name or path: of the project's, a .toml of yours, an SSP package, a run's scene.json.

    Raises TouchdownError where there is none, or it has a mistake.

    >>> scene = touchdown.load("disk-caged-simplified")
    >>> scene.run.duration  # s
    5.0
    """
    return anywhere.find_scene(os.fspath(name_or_path))


def as_scene(scene: PathLike | Scene) -> Scene:
    """The scene itself, or the one of that name or path."""
    return scene if isinstance(scene, Scene) else load(scene)
