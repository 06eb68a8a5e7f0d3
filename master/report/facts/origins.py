"""Where a setting in force comes from."""

from __future__ import annotations

from collections.abc import Mapping
from enum import StrEnum
from functools import cache

from touchdown.fmus.recipes import preset
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
    if variable in catalogued(spec.preset):
        return Origin.CATALOGUE
    return Origin.DEFAULT


@cache
def catalogued(name: str | None) -> Mapping[str, float]:
    """What a bearing of the catalogue sets; nothing where it is gone from there since."""
    try:
        return preset(name) if name is not None else {}
    except KeyError:
        return {}


def run_origin(scene: Scene, key: str) -> Origin:
    """Of a key of [run]."""
    if key in scene.own:
        return Origin.SET
    return Origin.DEFAULT if getattr(scene.run, key) == getattr(RunSpec(), key) else Origin.SCENE
