"""Comparisons of a scene's variants with one reference."""

from __future__ import annotations

from collections.abc import Iterable
from importlib import import_module
from typing import TYPE_CHECKING

from ...master.common.errors import TouchdownError, one_of

if TYPE_CHECKING:
    from ...master.common.progress import Progress
    from ...master.scene.scene import Scene
    from .engine import Comparison, Options

STABILITY = "stability"
KINDS = {  # what is compared, by the module that does it: the options that it takes
    "schemes": ("schemes", "macro_steps", "wanted", "duration", "timed", "repeat", "in_process"),
    "models": ("duration", "repeat", "in_process"),
    "modes": ("modes", "macro_steps", "duration"),
    "bearings": ("bearings", "jobs", "in_process"),
    "steps": ("schemes",),
    STABILITY: ("schemes", "cases", "jobs"),
}
WHOLE = ("bearings", "models")  # kinds whose runs are those of the scene
OF_RUNS = {"duration": "run.duration", "macro_steps": "run.macro_step"}  # options, and what sets runs
SHORTENED = ("schemes", "models")  # kinds that cut levitation short


def check_options(kind: str, scene: object, options: Iterable[str], dashes: str = "") -> None:
    """Raise TouchdownError for an unknown kind, and for options that it does not take."""
    if kind not in KINDS:
        raise TouchdownError(f"there is no comparison of {kind}; {one_of(kind, KINDS)}")
    for name in options:
        if name not in KINDS[kind]:
            shown = [dashes + (n.replace("_", "-") if dashes else n) for n in (name, *KINDS[kind])]
            setting = OF_RUNS.get(name) if kind in WHOLE else None
            hint = f"; set {setting}, that of its runs, instead" if setting else ""
            raise TouchdownError(
                f"{shown[0]} does not go with {dashes}of {kind}, which takes {', '.join(shown[1:])}{hint}"
            )
    if kind == STABILITY and scene is not None:
        raise TouchdownError("a comparison of stability has scenes of its own; choose some by their cases")
    if kind != STABILITY and scene is None:
        raise TouchdownError("a comparison needs a scene; only that of stability has scenes of its own")


def compare(kind: str, scene: Scene | None, options: Options, progress: Progress) -> Comparison:
    """Compare variants of `scene`; that of stability takes none. Raises TouchdownError."""
    if scene is not None and kind in SHORTENED:
        scene = import_module("..drop.impact_watch", __package__).shortened(scene)
    found: Comparison = import_module(f".{kind}", __package__).compare(scene, options, progress)
    return found
