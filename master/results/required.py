"""Whether a run keeps to what its scene requires, and with which margin."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple

from ..common.text import percent
from ..quantities import Item, Owner, Quantity, Summary, Worse, enter, finite_number, worst
from ..scene.requirements import SENSITIVITY, SIDES, Requirement, limited
from .capture import captures
from .whirl.evidence import touched


class Judged(NamedTuple):
    """A requirement beside what a run found. `margin` is 0 at the limit, below 0 beyond it."""

    requirement: Requirement
    found: float | None  # SI; None: the run does not tell, and nothing is met by that
    margin: float | None

    @property
    def met(self) -> bool:
        """Whether the run keeps to it."""
        return self.margin is not None and self.margin >= 0.0

    @property
    def fails(self) -> bool:
        """Whether the run tells that it does not."""
        return self.margin is not None and self.margin < 0.0

    @property
    def item(self) -> Item:
        """What is limited."""
        return limited(self.requirement.key)

    @property
    def quantity(self) -> Quantity:
        """The quantity that is limited."""
        return self.item.quantity

    @property
    def bound(self) -> str:
        """The limit, and the clause that asks for it, for people."""
        text = f"{SIDES[self.quantity.worse]} {_shown(self.requirement.limit, self.quantity)}"
        return f"{text} ({self.requirement.clause})" if self.requirement.clause else text

    @property
    def value(self) -> str:
        """What was found, for people; "": nothing."""
        return "" if self.found is None else _shown(self.found, self.quantity)

    @property
    def used(self) -> float:
        """The part of what is allowed that is taken, 1 at the limit and beyond it."""
        if self.found is None or self.fails:
            return float(self.fails)
        found, limit = max(self.found, 0.0), self.requirement.limit
        part, whole = (limit, found) if self.quantity.worse is Worse.SMALLER else (found, limit)
        return part / whole if whole else 1.0

    def left(self) -> str:
        """The margin, for people: of lengths in their unit, of others in per cent."""
        assert self.found is not None
        assert self.margin is not None
        text = margin_words(self.margin)
        if self.quantity.unit == "m":
            text = _shown(abs(self.found - self.requirement.limit), self.quantity)
        elif text.startswith("far"):
            return text
        return f"{text.removeprefix('-')} {'beyond the limit' if self.fails else 'to spare'}"

    def compared(self) -> str:
        """Words, value and limit: 'largest contact force, 312 N of at most 400 N'."""
        return f"{self.item.words}, {self.value} of {self.bound}"

    def beyond(self) -> str:
        """By what it fails; "": a gap below nothing, which is rubbed."""
        rubbed = self.requirement.kind == "least_gap" and self.found is not None and self.found <= 0.0
        return "" if rubbed else self.compared()

    def words(self) -> str:
        """A line for people."""
        if self.found is None:
            return f"{self.item.words}: {self.bound}, but this run has no such figure"
        how = "met" if self.met else "not met"
        return f"{self.item.words}: {self.value}, {self.bound}: {how}, {self.left()}"


FAR = 10.0  # times the limit: a larger margin is no number for people


def margin_words(margin: float) -> str:
    """A margin over its limit, for people."""
    if abs(margin) <= FAR:
        return percent(margin)
    return "far above" if margin > 0.0 else "far beyond the limit"


def _shown(value: float, quantity: Quantity) -> str:
    rounded = float(f"{round(quantity.factor * value, 9):.4g}")
    return f"{rounded:g} {quantity.read_in}".rstrip()


def judged(requirements: Iterable[Requirement], summary: Mapping[str, Any]) -> list[Judged]:
    """All requirements of a drop beside its `summary`; of several bearings the worst counts.

    A run that ends before the rotor has landed tells nothing, unless it was asked to catch the rotor again.
    """
    tells = touched(summary) or captures(summary)
    return [beside(one, _found(one, summary) if tells else None) for one in of_drops(requirements)]


def of_drops(requirements: Iterable[Requirement]) -> list[Requirement]:
    """Those that a drop is judged by; the others are the loops', of `amb-margins`."""
    return [one for one in requirements if one.kind != SENSITIVITY]


def _found(one: Requirement, summary: Mapping[str, Any]) -> float | None:
    item = limited(one.key)
    return finite_number(item.of(summary)) if one.of else worst(summary, item.quantity)


def beside(one: Requirement, found: float | None) -> Judged:
    """A requirement beside what is found (SI)."""
    at_least = limited(one.key).quantity.worse is Worse.SMALLER
    return Judged(one, found, None if found is None else _margin(found, one.limit, at_least))


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
        enter(summary, {"margin": one.margin}, Owner.REQUIREMENT, one.requirement.key)
