"""A mount's slides from its measured loop of force over displacement.

Between two turning points a loop follows the first loading curve, doubled (Masing): from one of them on,
the change D of the force over the way u is

    D(u) = K u + sum k_i min(u, 2 F_i/k_i)

of a spring K beside slides of stiffness k_i that give way at F_i. For given F_i/k_i that is linear in what
is looked for, which is not negative: non-negative least squares over a fine row of F_i/k_i finds where
slides are wanted; neighbours are joined until few are left, and those are moved to where they fit best.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np
from scipy.optimize import least_squares, nnls

from ...bearings.supports.mount_law import SLIDES as MOST_SLIDES
from ...modelkit.errors import require
from ...modelkit.reader import number
from ...modelkit.sheets import rows

COLUMNS = {"displacement": number("m"), "force": number("N")}
ALSO = {
    "weg": "displacement",
    "verschiebung": "displacement",
    "auslenkung": "displacement",
    "kraft": "force",
}
FULL = 0.98  # of the largest way between turning points; shorter branches are left out
TURN = 0.05  # of it; a way back that is shorter is noise
SHORTEST = 0.01  # of the amplitude; a slide that gives way sooner is one that slides at once
GRID = 80  # ways at which slides may give way, to start from
ENOUGH = 1e-3  # of the force; a better fit is not worth another slide
WORTH = 1.1  # times the misfit of the most slides; fewer are taken up to that


@dataclass(frozen=True)
class Loop:
    """Force (N) over displacement (m), as they were measured one after the other; each (n,)."""

    way: np.ndarray
    force: np.ndarray


@dataclass(frozen=True)
class _Leg:
    """From one turning point to the next: way and change of force since then, both counted forwards."""

    way: np.ndarray  # m, from 0 on
    force: np.ndarray  # N


@dataclass(frozen=True)
class Fit:
    """A spring beside slides, and how well they follow a loop."""

    spring: float  # N/m
    slides: tuple[tuple[float, float], ...]  # stiffness (N/m), force (N)
    misfit: float  # N, root of the mean square
    legs: tuple[_Leg, ...]

    @property
    def amplitude(self) -> float:
        """Half the way between the turning points (m)."""
        return 0.5 * max(float(leg.way[-1]) for leg in self.legs)

    @property
    def force(self) -> float:
        """Half the force between the turning points (N)."""
        return 0.5 * max(float(leg.force[-1]) for leg in self.legs)

    @property
    def measured(self) -> float:
        """Heat of a cycle as measured (J): twice what a leg encloses with its chord, in the mean."""
        areas = [np.trapezoid(leg.force, leg.way) - 0.5 * leg.way[-1] * leg.force[-1] for leg in self.legs]
        return 2.0 * float(np.mean(areas))

    @property
    def loss(self) -> float:
        """Heat of a cycle as fitted (J)."""
        reach = self.amplitude
        return sum(4.0 * force * max(reach - force / k, 0.0) for k, force in self.slides)

    def doubled(self, way: np.ndarray) -> np.ndarray:
        """Change of the force (N) over the way since a turning point (m)."""
        found = self.spring * way
        for k, force in self.slides:
            found = found + np.minimum(k * way, 2.0 * force)
        return found


def read_loop(path: Path) -> Loop:
    """A table with the columns displacement and force, each with its unit. Raises TouchdownError."""
    units = {name: kind.unit for name, kind in COLUMNS.items()}
    found = rows(path, units, (*COLUMNS,), ALSO, others=True)
    return Loop(*(np.array([row.get(name, kind) for row in found]) for name, kind in COLUMNS.items()))


def legs_of(loop: Loop) -> tuple[_Leg, ...]:
    """The parts between turning points that are as long as the longest. Raises TouchdownError."""
    way, force = _from_an_end(loop)
    reach = float(np.ptp(way)) if len(way) else 0.0
    require(
        len(way) >= 10 and reach > 0.0,
        f"a loop of {len(way)} points cannot be fitted; it needs 10, there and back",
    )
    ends = _turns(way, TURN * reach)
    found = list[_Leg]()
    for start, end in pairwise(ends):
        sign = 1.0 if way[end] > way[start] else -1.0
        leg = _Leg(
            sign * (way[start : end + 1] - way[start]), sign * (force[start : end + 1] - force[start])
        )
        if leg.way[-1] >= FULL * reach and end - start >= 4:
            found.append(leg)
    require(
        found,
        "no way from one turning point to the other is in the loop; a whole cycle is needed, and where "
        "its amplitude grows, the last of it alone",
    )
    require(
        min(float(leg.force[-1]) for leg in found) > 0.0,
        "the force falls where the displacement grows; give it as what moves the mount, not as what it "
        "resists with",
    )
    return tuple(found)


def _from_an_end(loop: Loop) -> tuple[np.ndarray, np.ndarray]:
    """A closed loop begins where it turns; what is not closed begins as it was given."""
    way, force = loop.way, loop.force
    if len(way) < 10:
        return way, force
    closed = all(abs(v[-1] - v[0]) < TURN * np.ptp(v) for v in (way, force))
    inner = way[:-1] if closed and way[0] == way[-1] else way
    count = len(inner)
    if not closed or len(_turns(way, TURN * float(np.ptp(way)))) > 4:  # several cycles
        return way, force
    first = int(np.argmax(inner))
    order = np.concatenate((np.arange(first, count), np.arange(first + 1)))
    return way[order], force[order]


def _turns(way: np.ndarray, noise: float) -> list[int]:
    """Where the way turns back by more than `noise` (m), with both ends of it."""
    ends, last, growing = [0], 0, None
    for i in range(1, len(way)):
        if growing is None:
            if abs(way[i] - way[0]) > noise:
                growing, last = bool(way[i] > way[0]), i
        elif (way[i] > way[last]) == growing:
            last = i
        elif abs(way[i] - way[last]) > noise:
            ends.append(last)
            growing, last = not growing, i
    return [*ends, last] if last > ends[-1] else ends


def fit(loop: Loop, most: int = MOST_SLIDES) -> Fit:
    """The fewest slides, up to `most`, that follow a loop as well as more would. Raises TouchdownError."""
    legs = legs_of(loop)
    longest = max(float(leg.way[-1]) for leg in legs)
    grid = np.geomspace(SHORTEST, 0.999, GRID) * longest
    parts, _ = _weights(legs, grid)
    tried = list[Fit]()
    for count in range(1, most + 1):
        starts = [_joined(grid, parts[1:], count)]
        if tried:
            starts += _with_one_more(tried[-1], longest)
        tried.append(min((_moved(legs, start) for start in starts), key=lambda one: one.misfit))
    top = max(float(leg.force[-1]) for leg in legs)
    enough = max(WORTH * tried[-1].misfit, ENOUGH * 0.5 * top)
    return next(one for one in tried if one.misfit <= enough)


def _weights(legs: Sequence[_Leg], ends: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Stiffness (N/m) of the spring and of slides that give way after `ends` (m); misfits (N)."""
    way = np.concatenate([leg.way for leg in legs])
    force = np.concatenate([leg.force for leg in legs])
    scale = float(np.max(way))
    matrix = np.stack([way, *(np.minimum(way, end) for end in ends)], axis=1) / scale
    found, _ = nnls(matrix, force)
    return found / scale, matrix @ found - force


def _joined(grid: np.ndarray, parts: np.ndarray, count: int) -> np.ndarray:
    """Ways (m) of `count` slides at most, for those in use: the nearest two are joined each time."""
    used = parts > 0.0
    ends, weights = list(np.log(grid[used])), list(parts[used])
    while len(ends) > count:
        near = int(np.argmin(np.diff(ends)))
        both = weights[near] + weights[near + 1]
        ends[near] = (weights[near] * ends[near] + weights[near + 1] * ends[near + 1]) / both
        weights[near] = both
        del ends[near + 1], weights[near + 1]
    return np.exp(np.array(ends))


def _with_one_more(found: Fit, longest: float) -> list[np.ndarray]:
    """Ways (m) at which the slides of a fit give way, and one between two of them, each in turn."""
    ends = np.array([2.0 * force / k for k, force in found.slides])
    marks = np.log(np.array([SHORTEST * longest, *ends, longest]))
    return [np.sort(np.append(ends, math.exp(m))) for m in 0.5 * (marks[1:] + marks[:-1])]


def _moved(legs: tuple[_Leg, ...], ends: np.ndarray) -> Fit:
    """Slides that give way near `ends` (m), where they fit best."""
    longest = max(float(leg.way[-1]) for leg in legs)
    top = max(float(leg.force[-1]) for leg in legs)
    logs = np.log(ends)
    if len(logs):
        low, high = math.log(0.5 * SHORTEST * longest), math.log(longest)
        best = least_squares(
            lambda logs: _weights(legs, np.exp(logs))[1] / top,
            np.clip(logs, low + 1e-9, high - 1e-9),
            bounds=(low, high),
            xtol=1e-14,
        )
        logs = np.sort(best.x)
    weights, left = _weights(legs, np.exp(logs))
    slides = [
        (float(k), 0.5 * float(k) * float(end))
        for k, end in zip(weights[1:], np.exp(logs), strict=True)
        if k > 0.0
    ]
    return Fit(float(weights[0]), tuple(slides), math.sqrt(float(np.mean(left * left))), legs)
