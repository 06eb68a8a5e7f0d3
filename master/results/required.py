"""Whether a run keeps to what its scene requires, and with which margin."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple

from ..common.text import percent
from ..quantities import Owner, Quantity, Summary, Worse, enter, worst
from ..scene.requirements import KINDS, Requirement
from .capture import captures
from .whirl.evidence import touched


class _Judged(NamedTuple):
    """A requirement beside what a run found. `margin` is 0 at the limit, below 0 beyond it."""

    requirement: Requirement
    found: float | None  # SI; None: the run does not tell, and nothing is met by that
    margin: float | None

    @property
    def met(self) -> bool:
        """Whether the run keeps to it."""
        return self.margin is not None and self.margin >= 0.0

    def words(self) -> str:
        """A line for people."""
        quantity = KINDS[self.requirement.kind].quantity
        bound = "at least" if quantity.worse is Worse.SMALLER else "at most"
        limit = _shown(self.requirement.limit, quantity)
        if self.found is None or self.margin is None:
            return f"{quantity.words}: {bound} {limit}, but this run has no such figure"
        how = "met" if self.met else "not met"
        found = _shown(self.found, quantity)
        return f"{quantity.words}: {found}, {bound} {limit}: {how}, margin {percent(self.margin)}"


def _shown(value: float, quantity: Quantity) -> str:
    return f"{round(quantity.factor * value, 9):.4g} {quantity.read_in}".rstrip()


def judged(requirements: Iterable[Requirement], summary: Mapping[str, Any]) -> list[_Judged]:
    """All requirements beside a `summary`; of several bearings the worst counts.

    A run that ends before the rotor has landed tells nothing, unless it was asked to catch the rotor again.
    """
    if not touched(summary) and not captures(summary):
        return [_Judged(one, None, None) for one in requirements]
    return [_judged(one, summary) for one in requirements]


def _judged(requirement: Requirement, summary: Mapping[str, Any]) -> _Judged:
    quantity = KINDS[requirement.kind].quantity
    found = worst(summary, quantity)
    if found is None:
        return _Judged(requirement, None, None)
    return _Judged(requirement, found, _margin(found, requirement.limit, quantity.worse is Worse.SMALLER))


def _margin(found: float, limit: float, at_least: bool) -> float:
    """(found - limit)/limit, with the sign that is above 0 where it is met."""
    way = found - limit if at_least else limit - found
    if limit == 0.0:
        return 0.0 if way == 0.0 else math.copysign(1.0, way)
    return way / limit


def add_requirements(summary: Summary, requirements: Sequence[Requirement]) -> None:
    """Add whether all are met, and the margin of each; nothing where nothing is required."""
    found = judged(requirements, summary)
    if found:
        enter(summary, {"requirements_met": all(one.met for one in found)})
    for one in found:
        enter(summary, {"margin": one.margin}, Owner.REQUIREMENT, one.requirement.kind)
