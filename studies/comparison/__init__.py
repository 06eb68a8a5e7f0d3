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
SHORTENED = ("schemes", "models")  # kinds that cut levitation short


def check_options(of: str, scene: object, given: Iterable[str], dashes: str = "") -> None:
    """Raise TouchdownError for an unknown kind, and for options that it does not take."""
    if of not in KINDS:
        raise TouchdownError(f"there is no comparison of {of}; {one_of(of, KINDS)}")
    for name in given:
        if name not in KINDS[of]:
            shown = [dashes + (n.replace("_", "-") if dashes else n) for n in (name, *KINDS[of])]
            raise TouchdownError(
                f"{shown[0]} does not go with {dashes}of {of}, which takes {', '.join(shown[1:])}"
            )
    if of == STABILITY and scene is not None:
        raise TouchdownError("a comparison of stability has scenes of its own; choose some by their cases")
    if of != STABILITY and scene is None:
        raise TouchdownError("a comparison needs a scene; only that of stability has scenes of its own")


def compare(of: str, scene: Scene | None, options: Options, progress: Progress) -> Comparison:
    """Compare variants of `scene`; that of stability takes none. Raises TouchdownError."""
    if scene is not None and of in SHORTENED:
        scene = import_module("..drop.impact_watch", __package__).shortened(scene)
    found: Comparison = import_module(f".{of}", __package__).compare(scene, options, progress)
    return found
