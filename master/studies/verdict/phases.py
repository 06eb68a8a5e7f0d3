"""Verdicts round the circle of phases: where to look next, which windows whirl, and how much of it.

Phases are in degrees, from 0 to below 360, and the circle closes: from 350 on to 2 it is 12 degrees.
Between two neighbours of different verdicts lies an edge, known to within the gap between them. Neighbours
of equal verdicts are taken to have nothing between them: what is narrower than the grid may be missed.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from touchdown.master.results.whirl.share import Share, clopper_pearson

CIRCLE = 360.0  # deg
DIGITS = 9  # of a phase in degrees: bisection meets the same phase from either side

Verdicts = Mapping[float, str]  # by phase (deg): how it whirls, in words; "" where it does not


class Edge(NamedTuple):
    """Where the verdict changes: somewhere between two phases (deg) that were looked at."""

    low: float
    high: float

    @property
    def middle(self) -> float:
        """Most likely place (deg)."""
        return turned(self.low, 0.5 * self.gap)

    @property
    def gap(self) -> float:
        """What it is known to (deg)."""
        return onwards(self.low, self.high)


@dataclass(frozen=True)
class Window:
    """Phases that whirl, from one edge to another; both None where all of the circle does."""

    begin: Edge | None
    end: Edge | None
    phases: tuple[float, ...]  # looked at within it (deg), strays left out

    @property
    def width(self) -> float:
        """From middle to middle of its edges (deg)."""
        if self.begin is None or self.end is None:
            return CIRCLE
        return onwards(self.begin.middle, self.end.middle)


def turned(phase: float, by: float) -> float:
    """A phase (deg) turned on."""
    return round((phase + by) % CIRCLE, DIGITS) % CIRCLE


def onwards(begin: float, end: float) -> float:
    """From one phase on to another (deg), 0 to below 360."""
    return turned(end, -begin)


def distance(one: float, other: float) -> float:
    """Between two phases, the shorter way round (deg)."""
    return min(onwards(one, other), onwards(other, one))


def grid(spacing: float, through: float) -> list[float]:
    """Phases evenly round the circle, at most `spacing` apart (deg), the first of them `through`."""
    count = math.ceil(CIRCLE / spacing - 1e-9)
    return [turned(through, i * CIRCLE / count) for i in range(count)]


def refinement(verdicts: Verdicts, tried: Collection[float], resolution: float) -> list[float]:
    """Phases to look at next: midway between neighbours that differ and are more than `resolution` apart.

    `tried` has the phases that were looked at, also those whose runs gave no verdict. Empty where nothing
    is left to do.
    """
    middles = [
        turned(low, 0.5 * onwards(low, high))
        for low, high in _neighbours(verdicts)
        if verdicts[low] != verdicts[high] and onwards(low, high) > resolution
    ]
    return [phase for phase in middles if phase not in tried]


def strays(verdicts: Verdicts) -> list[float]:
    """Phases (deg) alone with their answer, to whirl or not: two or more on either side have the other.

    Where verdicts change from one phase to the next all along, no phase is a stray.
    """
    runs = _runs({phase: bool(words) for phase, words in verdicts.items()})
    if len(runs) < 2:
        return []
    alone = [
        run[0]
        for i, run in enumerate(runs)
        if len(run) == 1 and len(runs[i - 1]) > 1 and len(runs[(i + 1) % len(runs)]) > 1
    ]
    return sorted(alone)


def windows(verdicts: Verdicts) -> list[Window]:
    """The windows of phases that whirl, in their order; strays do not make or part them."""
    set_aside = strays(verdicts)
    whirls = {phase: bool(words) for phase, words in verdicts.items() if phase not in set_aside}
    runs = _runs(whirls)
    if len(runs) == 1:
        return [Window(None, None, tuple(runs[0]))] if whirls[runs[0][0]] else []
    found = [
        Window(Edge(runs[i - 1][-1], run[0]), Edge(run[-1], runs[(i + 1) % len(runs)][0]), tuple(run))
        for i, run in enumerate(runs)
        if whirls[run[0]]
    ]
    return sorted(found, key=lambda window: window.begin.middle if window.begin else 0.0)


def edges(verdicts: Verdicts) -> list[Edge]:
    """The edges of all windows, in the order of the windows."""
    return [edge for window in windows(verdicts) for edge in (window.begin, window.end) if edge]


def share(verdicts: Verdicts) -> Share:
    """Part of all phases that whirl: each that was looked at stands for half the way to its neighbours.

    The interval is that of Clopper and Pearson for as many independent phases as weigh the same (Korn and
    Graubard, Survey Methodology 24, 1998): phases of a refined edge lie close together and count for less.
    It says what so many phases drawn at random would leave open; that they are spread evenly makes the
    share better than that. Raises ValueError without any verdict.
    """
    if not verdicts:
        raise ValueError("no verdicts, no share")
    weights = {phase: 0.5 * (before + after) / CIRCLE for phase, before, after in gaps(verdicts)}
    value = sum(weight for phase, weight in weights.items() if verdicts[phase])
    count = 1.0 / sum(weight**2 for weight in weights.values())
    everything, nothing = all(verdicts.values()), not any(verdicts.values())
    return clopper_pearson(count if everything else 0.0 if nothing else count * value, count)


def furthest(found: Iterable[Edge], known: Sequence[Edge]) -> float | None:
    """The largest distance (deg) from an edge to the nearest of those `known`; None without edges."""
    nearest = [min(distance(edge.middle, other.middle) for other in known) for edge in found if known]
    return max(nearest, default=None)


def gaps(verdicts: Verdicts) -> Iterator[tuple[float, float, float]]:
    """Each phase, and how far it is to the one before it and to the one behind (deg)."""
    phases = sorted(verdicts)
    for i, phase in enumerate(phases):
        before, after = phases[i - 1], phases[(i + 1) % len(phases)]
        yield phase, onwards(before, phase) or CIRCLE, onwards(phase, after) or CIRCLE


def _neighbours(verdicts: Verdicts) -> Iterator[tuple[float, float]]:
    """All pairs of neighbours, the last with the first."""
    phases = sorted(verdicts)
    return zip(phases, phases[1:] + phases[:1], strict=True)


def _runs(whirls: Mapping[float, bool]) -> list[list[float]]:
    """Phases in a row that have the same answer, round the circle; the first may begin before 0."""
    rows = [list(row) for _, row in itertools.groupby(sorted(whirls), key=lambda phase: whirls[phase])]
    if len(rows) > 1 and whirls[rows[0][0]] == whirls[rows[-1][0]]:
        rows[0] = rows.pop() + rows[0]
    return rows
