"""Ways in which what a bond carries crosses."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from touchdown.master.scene.run_spec import AUTO, RunSpec
from touchdown.modelkit.ports import HOLD


@dataclass(frozen=True)
class Way:
    """How motion is told ahead and force handed on over a macro step.

    `stretches`: parts of the step after each of which the force is known; `ahead` and `force`: points that
    the polynomials of motion and force pass through at most, 0 and 1 for values that are held. Their errors
    fall with macro step ** `error_order`.
    """

    name: str
    title: str
    stretches: int
    ahead: int
    force: int
    error_order: int

    @property
    def held(self) -> bool:
        """Whether plain values are held over the step."""
        return self.ahead == 0


WAYS: Mapping[str, Way] = {
    way.name: way
    for way in (
        Way("smooth", "motion told ahead, force after it, each by two holds", 1, 2, 4, 4),
        Way("contact", "the same twice a step", 2, 2, 3, 3),
        Way("hold", "force and motion held", 1, 0, 1, 1),
    )
}


def way_of(run: RunSpec) -> Way:
    """The one that a run asks for, or that fits its scheme."""
    if run.bonds != AUTO:
        return WAYS[run.bonds]
    if run.scheme.order == HOLD:
        return WAYS["hold"]
    return WAYS["smooth" if run.scheme.sequence == "gauss-seidel" else "contact"]
