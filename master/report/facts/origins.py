"""Where a setting in force comes from."""

from __future__ import annotations

from enum import StrEnum
from functools import cache

from touchdown.bearings.catalogue import Bearing, CatalogueError, bearing
from touchdown.master.scene.run_spec import RunSpec
from touchdown.master.scene.scene import ComponentSpec, Scene


class Origin(StrEnum):
    """As tables word it."""

    SET = "set for this run"
    SCENE = "scene"
    TAKEN_OVER = "scene, taken over in the swap"
    CATALOGUE = "catalogue"
    DEFAULT = "default"


def origin_of(spec: ComponentSpec, variable: str) -> Origin:
    """Of a component's parameter: the last that had a say, as a run applies them."""
    if variable in spec.set:
        return Origin.SET if variable in spec.own else Origin.SCENE
    if variable in spec.inherited:
        return Origin.TAKEN_OVER
    entry = catalogued(spec.preset)
    if entry is not None and variable in entry.settings():
        return Origin.CATALOGUE
    return Origin.DEFAULT


@cache
def catalogued(preset: str | None) -> Bearing | None:
    """The entry of a component's preset; None without one, or where it is gone since."""
    try:
        return bearing(preset) if preset is not None else None
    except CatalogueError:
        return None


def run_origin(scene: Scene, key: str) -> Origin:
    """Of a key of [run]."""
    if key in scene.own:
        return Origin.SET
    return Origin.DEFAULT if getattr(scene.run, key) == getattr(RunSpec(), key) else Origin.SCENE
