"""The same drop at other clearances."""

from __future__ import annotations

from ...master.common.progress import Progress
from ...master.scene.scene import Scene
from .drops import against_own
from .engine import Comparison, Options, Variant

CLEARANCES = "0.2 mm", "0.25 mm"


def compare(scene: Scene, options: Options, progress: Progress) -> Comparison:
    """The scene's own clearance, and each of these."""
    variants = [Variant(text, scene.set({"bearing.clearance": text})) for text in CLEARANCES]
    return against_own("clearances", scene, variants, options, progress)
