"""Whether a journal whirls around its bearing, told from its recorded orbit.

The angle of the journal about the bearing's centre means something beyond half the clearance. There it
is followed from one recorded value to the next, as long as these lie less than a third of a turn apart.
The journal is near the bore beyond 0.7 of the clearance. A hop is a stretch between 0.5 and 0.7 of the
clearance that spans at most a third of a turn: a straight flight from bore to bore that stays beyond
half the clearance spans no more.

whirl     near the bore, short hops aside, the journal turns one way by a revolution or more, unbroken,
          and touches; turning back by less than a quarter of a turn does not break it
forward   the whirl turns as the rotor spins, backward against it
pendulum  no whirl, but the journal swings to and fro along the bore by 10 degrees or more
none      it rests, bounces without swinging, or never touches
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

TURN = 2.0 * math.pi
FOLLOWED = 0.5  # of the clearance; beyond it the angle is followed
NEAR = 0.7  # of the clearance; beyond it the journal is near the bore
TOUCHES = 0.95  # of the clearance; a whirl reaches it: the ring may stand a little off its centre
HOP = TURN / 3.0
BACK = TURN / 4.0
SWING = TURN / 36.0  # from side to side
ENDS = TURN / 8.0  # left out of a whirl's either end to time it: there it may set out or swing out slowly
WAIT = 0.5  # periods from a whirl's end to the recording's end: it still whirls


@dataclass(frozen=True)
class Whirl:
    """Verdict on an orbit, with the longest unbroken whirl (most revolutions); None where there is none."""

    verdict: str  # "none", "pendulum", "forward whirl" or "backward whirl"
    sustained: bool = False  # a whirl of that direction goes on at the end of the recording
    revolutions: float = 0.0
    radius: float | None = None  # m, median while whirling
    frequency: float | None = None  # Hz, mean while whirling, without a sign
    start: float | None = None  # s
    end: float | None = None  # s

    @property
    def words(self) -> str:
        """For a report: "no whirl", "pendulum", "transient backward whirl", "sustained forward whirl"..."""
        if self.verdict == "none":
            return "no whirl"
        if self.verdict == "pendulum":
            return self.verdict
        return f"{'sustained' if self.sustained else 'transient'} {self.verdict}"


class Run(NamedTuple):
    """A stretch of the recording along the bore."""

    first: int  # index into the recording
    angle: np.ndarray  # rad, without jumps


class Stretch(NamedTuple):
    """Turning one way: indices into the recording, and the turn between them (rad, counter-clockwise).

    `timed` are such indices without the stretch's ends, `timed_turn` (rad, no sign) lies between them.
    """

    first: int
    last: int
    turn: float
    timed: tuple[int, int]
    timed_turn: float


def classify(time: np.ndarray, x: np.ndarray, y: np.ndarray, clearance: float, spin: float) -> Whirl:
    """What the journal does, from its position x, y (m) relative to the bearing's centre at `time` (s).

    clearance: m, on radius; spin: of the rotor, rad/s, of which the sign counts (0 as above 0). A whirl
    can be told up to a third of the recording's rate.
    """
    radius = np.hypot(x, y)
    runs = [r for r in _runs(x, y, radius, clearance) if _touches(radius, r, clearance)]
    whirls = [s for r in runs for s in _stretches(r, BACK) if abs(s.turn) >= TURN]
    if not whirls:
        swings = any(len(_stretches(r, SWING)) > 1 for r in runs)
        return Whirl("pendulum" if swings else "none")
    longest = max(whirls, key=lambda s: abs(s.turn))
    same = [s for s in whirls if s.turn * longest.turn > 0.0]
    start, end = _times(time, longest)
    return Whirl(
        verdict="forward whirl" if longest.turn * (-1.0 if spin < 0.0 else 1.0) > 0.0 else "backward whirl",
        sustained=any(_goes_on(time, s) for s in same),
        revolutions=abs(longest.turn) / TURN,
        radius=float(np.median(radius[longest.timed[0] : longest.timed[1] + 1])),
        frequency=1.0 / _period(time, longest),
        start=start,
        end=end,
    )


def _runs(x: np.ndarray, y: np.ndarray, radius: np.ndarray, clearance: float) -> list[Run]:
    """Stretches along the bore: they begin and end near it, and hold no more than hops."""
    followed = radius > FOLLOWED * clearance
    angle = np.arctan2(y, x)
    step = (np.diff(angle) + math.pi) % TURN - math.pi
    joined = followed[:-1] & followed[1:] & (np.abs(step) < HOP)
    near = radius > NEAR * clearance
    found: list[Run] = []
    for first, end in _true_stretches(followed, joined):
        unwrapped = np.unwrap(angle[first:end])
        found += [Run(first + a, unwrapped[a:b]) for a, b in _without_flights(near[first:end], unwrapped)]
    return found


def _true_stretches(true: np.ndarray, joined: np.ndarray) -> list[tuple[int, int]]:
    """(first, end) of stretches of `true` values whose neighbours are `joined` (one value less)."""
    before = np.concatenate([[False], joined])
    after = np.concatenate([joined, [False]])
    firsts = np.flatnonzero(true & ~before)
    ends = np.flatnonzero(true & ~after) + 1
    return list(zip(firsts.tolist(), ends.tolist(), strict=True))


def _without_flights(near: np.ndarray, angle: np.ndarray) -> list[tuple[int, int]]:
    """(first, end) of what is left of a stretch when the parts away from the bore that are no hops go."""
    if not near.any():
        return []
    last = int(np.flatnonzero(near)[-1])
    first = int(np.argmax(near))
    away = ~near
    parts: list[tuple[int, int]] = []
    for a, b in _true_stretches(away, away[:-1] & away[1:]):
        if first < a and b <= last and np.ptp(angle[a - 1 : b + 1]) > HOP:
            parts.append((first, a))
            first = b
    return [*parts, (first, last + 1)]


def _touches(radius: np.ndarray, run: Run, clearance: float) -> bool:
    return bool(np.max(radius[run.first : run.first + len(run.angle)]) >= TOUCHES * clearance)


def _stretches(run: Run, back: float) -> list[Stretch]:
    """The run's stretches of turning one way, where turning back by less than `back` (rad) is passed over.

    They follow one another from extreme to extreme. Each is at least `back` long.
    """
    angle = run.angle
    found: list[Stretch] = []
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
            found.append(_stretch(run, begun, best))
            begun, best, sign = best, i, -sign
    if sign:
        found.append(_stretch(run, begun, best))
    return found


def _turning_points(angle: np.ndarray) -> list[int]:
    """Indices of the first and last value and of all local extremes."""
    rate = np.diff(angle)
    inner = np.flatnonzero(rate[:-1] * rate[1:] <= 0.0) + 1
    return [0, *inner.tolist(), len(angle) - 1]


def _stretch(run: Run, begun: int, best: int) -> Stretch:
    """From extreme to extreme; timed from where it left the first for good to where it neared the last."""
    part = run.angle[begun : best + 1]
    turned = np.abs(part - part[0])
    turn = float(part[-1] - part[0])
    margin = min(ENDS, 0.25 * abs(turn))
    b = int(np.argmax(turned >= abs(turn) - margin))
    a = int(np.flatnonzero(turned[: b + 1] <= margin)[-1])
    start = run.first + begun
    return Stretch(start, run.first + best, turn, (start + a, start + b), float(abs(part[b] - part[a])))


def _period(time: np.ndarray, s: Stretch) -> float:
    """Mean time of a revolution (s)."""
    return float(time[s.timed[1]] - time[s.timed[0]]) * TURN / s.timed_turn


def _times(time: np.ndarray, s: Stretch) -> tuple[float, float]:
    """Start and end (s), the ends taken as fast as the rest: beyond them it may have rested anywhere."""
    ends = ENDS / TURN * _period(time, s)
    start = max(float(time[s.first]), float(time[s.timed[0]]) - ends)
    return start, min(float(time[s.last]), float(time[s.timed[1]]) + ends)


def _goes_on(time: np.ndarray, s: Stretch) -> bool:
    return float(time[-1]) - _times(time, s)[1] <= WAIT * _period(time, s)
