"""Whether a motion grows, stays or decays, told from its size in successive turns or periods.

A straight line is fitted by least squares to the sizes. What counts is by how much it rises from the first
to the last of them, over their mean, and how surely: with the interval of Student's t, which is wide where
sizes are few or scatter.

growing, decaying  the line rises, falls by more than TOLERANCE, and the interval leaves out zero
steady             neither, and the interval stays within PLAIN of zero
cannot tell        all else: fewer than LEAST sizes, or so scattered that it may be either
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from enum import StrEnum

import numpy as np
from scipy.special import stdtrit

from touchdown.master.results.whirl.contacts import FOLLOWED, TURN, Orbit, wrapped

LEAST = 4  # sizes; through fewer a line says nothing
MOST = 40  # turns, the last ones: what comes before them is past
PART = 0.5  # of a whirl's turns, the last ones: it takes the first to come up
TOLERANCE = 0.05  # of the mean, over all the sizes
PLAIN = 0.25  # of the mean: wider, and it is anybody's guess
CONFIDENCE = 0.95


class Trend(StrEnum):
    """How a motion goes on, as reports word it."""

    GROWING = "growing"
    STEADY = "steady"
    DECAYING = "decaying"
    UNTOLD = "cannot tell"


def change(sizes: np.ndarray) -> tuple[float, float]:
    """By how much a line through `sizes` (n,) rises over all of them, and half the width of its interval.

    Both are over the mean of the sizes; the interval is infinite where there are less than three.
    """
    count, mean = len(sizes), float(np.mean(sizes))
    if count < 3 or mean <= 0.0:
        return 0.0, math.inf
    place = np.arange(count) - 0.5 * (count - 1)
    squares = float(np.sum(place**2))
    slope = float(np.sum(place * sizes)) / squares
    left = sizes - mean - slope * place
    error = math.sqrt(float(np.sum(left**2)) / (count - 2) / squares)
    reach = float(stdtrit(count - 2, 0.5 * (1.0 + CONFIDENCE))) * error
    return slope * (count - 1) / mean, reach * (count - 1) / mean


def trend(sizes: np.ndarray) -> Trend:
    """Of sizes (n,), not below zero, in their order."""
    if len(sizes) < LEAST:
        return Trend.UNTOLD
    if not np.any(sizes):
        return Trend.STEADY
    risen, reach = change(sizes)
    if abs(risen) > max(TOLERANCE, reach):
        return Trend.GROWING if risen > 0.0 else Trend.DECAYING
    return Trend.STEADY if abs(risen) + reach <= PLAIN else Trend.UNTOLD


def together(trends: Sequence[Trend]) -> Trend:
    """Of a motion that is told from several sizes, such as amplitude and force: none may contradict."""
    told = set(trends)
    if not told or told >= {Trend.GROWING, Trend.DECAYING}:
        return Trend.UNTOLD
    for one in (Trend.GROWING, Trend.DECAYING, Trend.UNTOLD):
        if one in told:
            return one
    return Trend.STEADY


def turn_by_turn(
    orbit: Orbit, force: np.ndarray | None, start: float, end: float
) -> tuple[np.ndarray, ...]:
    """Means over each of the last turns of a whirl from `start` to `end` (s): of its radius, of the force.

    The radius is about the orbit's own middle, over the clearance; force: size of the contact force (N,
    rows,), None where unknown. Turns are whole ones, counted back from the end, at most MOST and PART of
    all. Without a turn where the recording is too coarse to count them.
    """
    part = (orbit.time >= start) & (orbit.time <= end) & np.isfinite(orbit.radius)
    x, y = (
        values[part] - 0.5 * (np.min(values[part], initial=np.inf) + np.max(values[part], initial=-np.inf))
        for values in (orbit.x, orbit.y)
    )
    steps = wrapped(np.diff(np.arctan2(y, x)))
    if len(steps) == 0 or np.max(np.abs(steps)) >= FOLLOWED:
        return ()
    left = np.abs(np.sum(steps) - np.concatenate([[0.0], np.cumsum(steps)])) / TURN
    count = min(MOST, max(LEAST, int(PART * left[0])), int(left[0]))
    turn = np.minimum(left.astype(int), count)  # from the end; what lies before is the last, left out
    shown = [np.hypot(x, y) / orbit.clearance] + ([] if force is None else [force[part]])
    return tuple(_means(values, turn, count) for values in shown)


def _means(values: np.ndarray, turn: np.ndarray, count: int) -> np.ndarray:
    """Mean over each of the first `count` turns from the end, in the order of time."""
    rows = np.bincount(turn, minlength=count + 1)[:count]
    sums = np.bincount(turn, np.nan_to_num(values), count + 1)[:count]
    return (sums / np.maximum(rows, 1))[::-1]
