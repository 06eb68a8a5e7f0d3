"""Turning one way: an angle over time cut into stretches from extreme to extreme, and these timed."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from touchdown.master.results.whirl.contacts import TURN

ENDS = TURN / 8.0  # left out of a stretch's either end to time it: there it may set out or swing out slowly
SECTION = TURN / 100.0  # so little of a turn
REST = 0.5  # of a pendulum's period that it takes for a section: it has come to rest in between


class Stretch(NamedTuple):
    """Turning one way: indices into an angle, and the turn between them (rad, counter-clockwise).

    `timed` are such indices without the stretch's ends, `timed_turn` (rad, no sign) lies between them.
    """

    first: int
    last: int
    turn: float
    timed: tuple[int, int]
    timed_turn: float


def stretches(angle: np.ndarray, back: float) -> list[Stretch]:
    """Stretches of turning one way, where turning back by less than `back` (rad) is passed over.

    They follow one another from extreme to extreme. Each is at least `back` long.
    """
    ways: list[Stretch] = []
    low = high = begun = best = sign = 0
    for i in _turning_points(angle):
        if sign == 0:
            low, high = (i if angle[i] < angle[low] else low), (i if angle[i] > angle[high] else high)
            if angle[high] - angle[low] >= back:
                sign = 1 if high > low else -1
                begun, best = min(low, high), max(low, high)
        elif sign * (angle[i] - angle[best]) > 0.0:
            best = i
        elif sign * (angle[best] - angle[i]) >= back:
            ways.append(stretch(angle, begun, best))
            begun, best, sign = best, i, -sign
    if sign:
        ways.append(stretch(angle, begun, best))
    return ways


def _turning_points(angle: np.ndarray) -> list[int]:
    """Indices of the first and last value and of all local extremes."""
    rate = np.diff(angle)
    inner = np.flatnonzero(rate[:-1] * rate[1:] <= 0.0) + 1
    return [0, *inner.tolist(), len(angle) - 1]


def stretch(angle: np.ndarray, begun: int, best: int) -> Stretch:
    """From extreme to extreme; timed from where it left the first for good to where it neared the last."""
    part = angle[begun : best + 1]
    turned = np.abs(part - part[0])
    turn = float(part[-1] - part[0])
    margin = min(ENDS, 0.25 * abs(turn))
    b = int(np.argmax(turned >= abs(turn) - margin))
    a = int(np.flatnonzero(turned[: b + 1] <= margin)[-1])
    return Stretch(begun, best, turn, (begun + a, begun + b), float(abs(part[b] - part[a])))


def without_rests(time: np.ndarray, angle: np.ndarray, whole: Stretch, pendulum: float) -> list[Stretch]:
    """What is left of a stretch when it is cut where it rests; pendulum: a pendulum's period (s).

    time: s, of each of `angle` (rad). Rests at the stretch's very ends stay: they add no turn.
    """
    turned = math.copysign(1.0, whole.turn) * (angle[whole.first : whole.last + 1] - angle[whole.first])
    furthest = np.maximum.accumulate(turned)
    levels = np.arange(SECTION, furthest[-1], SECTION)
    after = np.searchsorted(furthest, levels)
    rests = np.flatnonzero(
        np.diff(_reached(time[whole.first :], furthest, levels, after)) > REST * pendulum
    )
    begins = [whole.first, *(whole.first + after[rests + 1] - 1).tolist()]
    ends = [*(whole.first + after[rests]).tolist(), whole.last]
    return [stretch(angle, a, b) for a, b in zip(begins, ends, strict=True) if a < b]


def _reached(time: np.ndarray, furthest: np.ndarray, levels: np.ndarray, after: np.ndarray) -> np.ndarray:
    """When each of `levels` was reached (s); `after`: the first index that lies at it or beyond."""
    gone = (levels - furthest[after - 1]) / (furthest[after] - furthest[after - 1])
    return time[after - 1] + gone * (time[after] - time[after - 1])


def period(time: np.ndarray, s: Stretch) -> float:
    """Mean time of a revolution (s); time: s, of each of the angle's values."""
    return float(time[s.timed[1]] - time[s.timed[0]]) * TURN / s.timed_turn


def times(time: np.ndarray, s: Stretch) -> tuple[float, float]:
    """Start and end (s), the ends taken as fast as the rest: beyond them it may have rested anywhere."""
    ends = ENDS / TURN * period(time, s)
    start = max(float(time[s.first]), float(time[s.timed[0]]) - ends)
    return start, min(float(time[s.last]), float(time[s.timed[1]]) + ends)
