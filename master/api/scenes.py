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
    """A scene of the project's by name, or of yours by the path of a .toml or an SSP package (.ssp).

    Raises TouchdownError where there is none, or it has a mistake.

    >>> scene = touchdown.load("disk-caged-simplified")
    >>> scene.run.duration  # s
    5.0
    """
    return anywhere.find_scene(os.fspath(name_or_path))


def as_scene(scene: PathLike | Scene) -> Scene:
    """The scene itself, or the one of that name or path."""
    return scene if isinstance(scene, Scene) else load(scene)
