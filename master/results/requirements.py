"""Whether a run keeps to what its scene requires, and with which margin."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import NamedTuple

from ..common.units import percent
from ..scene.requirements import KINDS, Requirement
from .capture import capture_keys
from .whirl.evidence import touched
from .whirl.verdict import TURNS

MET, MARGIN = "requirements_met", "requirement_margin_"  # figures of a summary
FORCES = "contact_force", "ball_force"  # requirements by figures that a bearing has once it is touched
FIRST_CONTACT = "first_contact_time_s"  # of such a bearing, too, its name behind


class Judged(NamedTuple):
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
        kind = KINDS[self.requirement.kind]
        bound = "at least" if kind.at_least else "at most"
        limit = _shown(self.requirement.limit, kind.unit)
        if self.found is None or self.margin is None:
            return f"{kind.meaning}: {bound} {limit}, but this run has no such figure"
        found = _shown(self.found, kind.unit)
        how = "met" if self.met else "not met"
        return f"{kind.meaning}: {found}, {bound} {limit}: {how}, margin {percent(self.margin)}"


HANDY = {"m": (1e6, "um"), "Pa": (1e-9, "GPa"), "1": (1.0, "")}  # units that figures are shown in


def _shown(value: float, unit: str) -> str:
    factor, name = HANDY.get(unit, (1.0, unit))
    return f"{round(factor * value, 9):.4g} {name}".rstrip()


def judged(wanted: Iterable[Requirement], summary: Mapping[str, object]) -> list[Judged]:
    """All requirements beside the figures of a `summary`; of several bearings the worst counts.

    A run that ends before the rotor has landed tells nothing, unless it was asked to catch the rotor again.
    """
    if not touched(summary) and not capture_keys(summary):
        return [Judged(one, None, None) for one in wanted]
    return [_judged(one, summary) for one in wanted]


def _judged(wanted: Requirement, summary: Mapping[str, object]) -> Judged:
    kind = KINDS[wanted.kind]
    if wanted.kind == "settling_time":  # one for all bearings
        figures = [summary.get(kind.figure)]
    elif wanted.kind == "whirl_turns":
        figures = [v for key, v in summary.items() if key.startswith(kind.figure) and key.endswith(TURNS)]
    elif wanted.kind in FORCES:
        figures = _forces(kind.figure, summary)
    else:
        figures = [v for key, v in summary.items() if key.startswith(kind.figure)]
    numbers = [float(v) for v in figures if isinstance(v, (int, float)) and not isinstance(v, bool)]
    if not numbers or len(numbers) < len(figures):
        return Judged(wanted, None, None)
    found = kind.factor * (min(numbers) if kind.at_least else max(numbers))
    return Judged(wanted, found, _margin(found, wanted.limit, kind.at_least))


def _forces(figure: str, summary: Mapping[str, object]) -> list[object]:
    """Figures of the bearings that were touched, as no force is on the others; where none was, of all."""
    by_seat = {key.removeprefix(figure): value for key, value in summary.items() if key.startswith(figure)}
    touched = [v for tail, v in by_seat.items() if summary.get(f"{FIRST_CONTACT}{tail}", v) is not None]
    return touched or list(by_seat.values())


def _margin(found: float, limit: float, at_least: bool) -> float:
    """(found - limit)/limit, with the sign that is above 0 where it is met."""
    way = found - limit if at_least else limit - found
    if limit == 0.0:
        return 0.0 if way == 0.0 else math.copysign(1.0, way)
    return way / limit


def requirement_figures(wanted: Sequence[Requirement], summary: Mapping[str, object]) -> dict[str, object]:
    """Figures of a run: whether all are met, and the margin of each; none where nothing is required."""
    found = judged(wanted, summary)
    if not found:
        return {}
    figures: dict[str, object] = {MET: all(one.met for one in found)}
    return figures | {f"{MARGIN}{one.requirement.kind}": one.margin for one in found}
