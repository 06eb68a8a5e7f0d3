"""The exchange over a bond in a macro step, and the energy error that it causes.

A polynomial is given to an FMU as two held values, one after the other, that act as it would: a held input
acts as a smooth one, to fourth order in the step, where mean and first moment are kept. An FMU that gives
force answers at once to the motion it is given, so the last of these must be that of the end.

The energy is found from both sides of the bond. The component that takes the force got the work of that
force along its own motion. The work of the one that gives it, along the motion that it was given, is not
seen directly: at the beginning of a step its motion is set to where the other really came to, and its force
jumps there by feedthrough, D = dF/d(motion), times the error of the predicted motion. D is found from what
every step shows anyway: the force under the first of two holds, which differs from the course of the force
by D times the difference of that hold and the predicted motion.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import asdict, dataclass, field, replace
from functools import lru_cache
from typing import NamedTuple, TypeVar

import numpy as np

from ..snapshot import Kept, Saved
from ..system import System
from .bond import Bond, BondHold


class _Polynomial:
    """sum of c[k] tau^k."""

    __slots__ = ("c",)

    def __init__(self, coefficients: Sequence[float]) -> None:
        self.c = coefficients

    def at(self, tau: float) -> float:
        """Its value."""
        value = 0.0
        for c in reversed(self.c):
            value = value * tau + c
        return value

    def mean(self, begin: float, end: float) -> float:
        """Over [begin, end]."""
        total, low, high = 0.0, 1.0, 1.0
        for k, c in enumerate(self.c, 1):
            low, high = low * begin, high * end
            total += c * (high - low) / k
        return total / (end - begin)

    def moment(self, begin: float, end: float) -> float:
        """Mean over [begin, end] of the polynomial times (s - 1/2), where s goes from 0 to 1 there."""
        total, low, high = 0.0, begin, end
        for k, c in enumerate(self.c, 2):
            low, high = low * begin, high * end
            total += c * (high - low) / k
        length = end - begin
        return (total / length - 0.5 * (begin + end) * self.mean(begin, end)) / length

    def slope(self) -> _Polynomial:
        """Its derivative in tau."""
        return _Polynomial([k * c for k, c in enumerate(self.c)][1:] or [0.0])

    def sum(self) -> _Polynomial:
        """Its integral in tau from 0."""
        return _Polynomial([0.0, *(c / k for k, c in enumerate(self.c, 1))])

    def times(self, factor: float) -> _Polynomial:
        """A multiple of it."""
        return _Polynomial([factor * c for c in self.c])


def _work(force: _Polynomial, place: _Polynomial) -> float:
    """Integral of `force` along `place` over the whole step."""
    return sum(f * p * k / (i + k) for i, f in enumerate(force.c) for k, p in enumerate(place.c) if k > 0)


def _through(nodes: Sequence[float], values: Sequence[float], slopes: Sequence[float] = ()) -> _Polynomial:
    """The polynomial with these values, and slopes in tau, at the first nodes (Lagrange, Hermite)."""
    inverse = _inverse(tuple(round(tau, 9) for tau in nodes), len(values), len(slopes))
    return _Polynomial((inverse @ np.array((*values, *slopes))).tolist())


@lru_cache(maxsize=512)
def _inverse(nodes: tuple[float, ...], values: int, slopes: int) -> np.ndarray:
    powers = range(values + slopes)
    rows = [[tau**k for k in powers] for tau in nodes[:values]]
    rows += [[k * tau ** (k - 1) if k else 0.0 for k in powers] for tau in nodes[:slopes]]
    return np.linalg.inv(np.array(rows))


FIRST_SHARE = 2.0 / 3.0  # of a stretch, for which the first of two motions is held


def _motion_holds(p: _Polynomial, begin: float, end: float) -> tuple[float, float]:
    """For 2/3 and 1/3 of [begin, end]: mean kept, the second is the value at the end.

    Where it is a straight line the first moment is kept as well; of c tau^2 it is c/36 too large.
    """
    last = p.at(end)
    return 1.5 * p.mean(begin, end) - 0.5 * last, last


def force_holds(p: _Polynomial, begin: float, end: float, split: float) -> tuple[float, float]:
    """For [begin, end] divided at the share `split` of it: mean and first moment are kept."""
    mean = p.mean(begin, end)
    jump = 2.0 * p.moment(begin, end) / (split * (1.0 - split))
    return mean - (1.0 - split) * jump, mean + split * jump


FORGETTING_SHARE = 0.1  # share of what was learned that each observation takes the place of
RIDGE_PARAMETER = 1e-6  # of the sum of squares; where position and velocity do not tell apart, it decides
MAX_REACH = 0.1  # of the motion asked for; what was told apart by less does not reach so far


@dataclass(frozen=True)
class _Feedthrough:
    """How a force follows a motion (one or two values of one size) at once, by damped least squares."""

    aa: float = 0.0  # sums of products of what was told apart, a and b, and the force's difference, f
    ab: float = 0.0
    bb: float = 0.0
    af: float = 0.0
    bf: float = 0.0

    def learned(self, apart: Sequence[float], force: float) -> _Feedthrough:
        """With an observation: a motion that is `apart` from the held one would change it by `force`."""
        a, b = (*apart, 0.0)[:2]
        kept = 1.0 - FORGETTING_SHARE
        return _Feedthrough(
            kept * self.aa + a * a,
            kept * self.ab + a * b,
            kept * self.bb + b * b,
            kept * self.af + a * force,
            kept * self.bf + b * force,
        )

    def of(self, motion: Sequence[float]) -> float:
        """The force that a change of motion makes at once; towards 0 where less than MAX_REACH of it was
        seen.

        Motions that are hardly apart show rounding, and what else moves the force.
        """
        a, b = (*motion, 0.0)[:2]
        ridge = RIDGE_PARAMETER * (self.aa + self.bb) + MAX_REACH**2 * (a * a + b * b)
        aa, bb = self.aa + ridge, self.bb + ridge
        whole = aa * bb - self.ab * self.ab
        if whole <= 0.0:
            return 0.0
        return (a * (bb * self.af - self.ab * self.bf) + b * (aa * self.bf - self.ab * self.af)) / whole


@dataclass(frozen=True)
class _Audit:
    """Work so far."""

    total: float = 0.0  # J, sum of |made| over steps
    made: float = 0.0  # J, by the exchange, less what it lost
    turned: float = 0.0  # J, sum of |work| over steps
    loaded: int = 0  # steps in which work was done
    passed: float = 0.0  # J, sum of the motion side's work with its sign
    lowest: float = 0.0  # J, of that sum so far
    highest: float = 0.0
    drift: float = 0.0  # J, the largest |made| so far

    @property
    def error_share(self) -> float:
        """How large a part of what crossed was wrong, at least as much as the larger of two measures.

        Errors of both signs add up over the work of all steps. One that always has the same sign drains
        what swings to and fro, or feeds it, while work adds up with every cycle: so the sum of errors is
        also measured by the energy that swung across, the range of the work's sum.
        """
        swung = self.highest - self.lowest
        return max(
            self.total / self.turned if self.turned > 0.0 else 0.0,
            self.drift / swung if swung > 0.0 else 0.0,
        )

    def booked(self, factor: float, taken: float, returned: float) -> _Audit:
        """With a step in which the motion side got and the force side gave so much; `factor`: in J."""
        excess = factor * (taken - returned)
        passed = self.passed + factor * taken
        return _Audit(
            self.total + abs(excess),
            self.made + excess,
            self.turned + abs(factor * taken),
            self.loaded + (taken != 0.0),
            passed,
            min(self.lowest, passed),
            max(self.highest, passed),
            max(self.drift, abs(self.made + excess)),
        )


HISTORY_POINTS = 8  # points of the past
MIN_POINT_DISTANCE = 1.0 / 32.0  # of the step; points closer to each other would say little but rounding
POSITION_POINTS, VELOCITY_POINTS = 5, 4  # points that the polynomial of a lonely one passes through


class _MotionSample(NamedTuple):
    """Where the motion side was."""

    time: float  # s
    values: tuple[float, ...]  # of Bond.motion


class _ForceSample(NamedTuple):
    """The force side's force."""

    time: float  # s
    force: float
    lacking: float = 0.0  # what it lacks since the force side was told where the motion side really came to


Point = TypeVar("Point", _MotionSample, _ForceSample)


@dataclass(frozen=True)
class History:
    """The history of a bond when a macro step begins; points are the latest first."""

    moved: tuple[_MotionSample, ...] = ()
    pushed: tuple[_ForceSample, ...] = ()
    behind: float = 0.0  # how far a force side that integrates velocity is behind the motion side
    feedthrough: _Feedthrough = field(default_factory=_Feedthrough)
    audit: _Audit = field(default_factory=_Audit)


class BondExchange(Kept):
    """A bond that crosses in one of the ways."""

    KEPT = ("trusted", "_size")

    def __init__(self, bond: Bond, way: BondHold, late: bool) -> None:
        """`late`: the motion side steps before the force side, and the force is told ahead."""
        self.bond, self.way, self.late = bond, way, late
        self.past = History()
        self.trusted = True  # whether the force that the force side starts with may be used
        self._time = self._step = self._size = 0.0
        self._estimated: list[_Polynomial] = []  # Bond.motion, as the force side is told
        self._taken = _Polynomial([0.0])  # force, as the motion side is told
        self._samples: list[_ForceSample] = []  # of this step
        self._under: list[tuple[float, list[float], float]] = []  # tau, motion held up to there, force then

    def find(self, system: System) -> None:
        """Find what it reads and writes, where that now stands."""
        self._signals = system.signals
        self._force = system.position[self.bond.force.source_name]
        self._motion = [system.position[c.source_name] for c in self.bond.motion]

    @property
    def last_motion(self) -> tuple[float, ...]:
        """The motion that the motion side last gave."""
        return tuple(float(self._signals[place]) for place in self._motion)

    def save(self) -> Saved:
        return super().save() | asdict(self.past)

    def load(self, saved: Saved) -> None:
        super().load(saved)
        self.past = History(
            tuple(_MotionSample(time, tuple(values)) for time, values in saved["moved"]),
            tuple(_ForceSample(*point) for point in saved["pushed"]),
            saved["behind"],
            _Feedthrough(**saved["feedthrough"]),
            _Audit(**saved["audit"]),
        )

    # -- what is told ----------------------------------------------------------------------------------

    def begin(self, time: float, step: float) -> None:
        """Tell the motion ahead, from where the motion side is, and a force that comes late."""
        self._time, self._step = time, step
        self._size = self._size or step  # what is learned keeps its measure
        self._samples, self._under = [], []
        if not self.past.moved:
            force = [_ForceSample(time, float(self._signals[self._force]))] if self.trusted else []
            self.past = replace(
                self.past, moved=(_MotionSample(time, self.last_motion),), pushed=tuple(force)
            )
        self._estimated = self._path(self.past.moved, self.way.ahead)
        if self.late:
            self._taken = self._course(self.past.pushed)

    def prescribe(self, end: Sequence[float]) -> None:
        """Have the motion that is told end there."""
        self._estimated = self._path(
            (_MotionSample(self._time + self._step, tuple(end)), *self.past.moved), 2
        )

    @property
    def estimated_end(self) -> tuple[float, ...]:
        """Where the motion that is told ends."""
        return tuple(p.at(1.0) for p in self._estimated)

    def motion_holds(self, begin: float, end: float) -> tuple[list[float], list[float]]:
        """Inputs of the force's side for the first two thirds of a stretch, and for the last."""
        pairs = [_motion_holds(p, begin, end) for p in self._estimated]
        first, last = [a for a, _ in pairs], [b for _, b in pairs]
        if self.bond.position is None and not self.way.held:
            first[0] += 1.5 * self.past.behind / self._step
        return first, last

    @property
    def force(self) -> _Polynomial:
        """The input of the motion's side."""
        return self._taken

    # -- what is seen ----------------------------------------------------------------------------------

    def observe(self, tau: float, held: list[float], last: bool) -> None:
        """The force side has come to `tau` with this motion held; `last`: at the end of a stretch."""
        force = float(self._signals[self._force])
        if not last or self.way.held:  # at the end of a stretch what is held is what is told
            self._under.append((tau, held, force))
        if last:
            self._samples.insert(0, _ForceSample(self._time + tau * self._step, force))
            if not self.late:
                self._taken = self._course((*self._samples, *self.past.pushed))

    def end(self) -> None:
        """Both sides have taken the step: book it, and remember."""
        past, came = self.past, _MotionSample(self._time + self._step, self.last_motion)
        moved = (came, *past.moved)
        real, estimated = self._place(self._path(moved, 2)), self._place(self._estimated)
        feedthrough, lacking, behind = self._learned(), 0.0, 0.0
        if self.way.held:
            returned = self._held_work(estimated)
        else:
            missed = [b - a for a, b in zip(self.estimated_end, came.values, strict=True)]
            lacking = feedthrough.of(self._scaled(missed))
            returned = self._given_work(estimated, lacking, missed[0])
            behind = real.at(1.0) - estimated.at(1.0) if self.bond.position is None else 0.0
        audit = past.audit.booked(self.bond.factor, _work(self._taken, real), returned)
        newest = self._samples[0]._replace(lacking=lacking)
        pushed = (newest, *self._samples[1:], *past.pushed)
        self.past = History(moved[:HISTORY_POINTS], pushed[:HISTORY_POINTS], behind, feedthrough, audit)

    def _learned(self) -> _Feedthrough:
        """With what this step has shown of it."""
        found = self.past.feedthrough
        if self.way.held:
            return found
        course = self._course((*self._samples, *self.past.pushed))
        for tau, held, force in self._under:
            apart = [p.at(tau) - h for p, h in zip(self._estimated, held, strict=True)]
            found = found.learned(self._scaled(apart), course.at(tau) - force)
        return found

    def _given_work(self, estimated: _Polynomial, lacking: float, missed: float) -> float:
        """By a force side that moved as told, then was put where the motion side came to, by `missed`."""
        points = (*self._samples, *self.past.pushed)
        course = self._course(points)
        work = _work(course, estimated) + _work(self._course(points, lacking=True), estimated)
        if self.bond.position is None:  # it moved by itself; its first hold made up for what it was behind
            return work + course.mean(0.0, 1.0) * self.past.behind
        return work + (self._samples[0].force + 0.5 * lacking) * missed

    def _held_work(self, estimated: _Polynomial) -> float:
        """By a force side under held motion: put there as the step began, where its force jumped."""
        if len(self._under) < 2:
            return 0.0
        half, whole = (force for _, _, force in self._under[-2:])
        course = _Polynomial([2.0 * half - whole, 2.0 * (whole - half)])
        if self.bond.position is None or len(self.past.moved) < 2 or not self.past.pushed:
            return _work(course, estimated)
        jump = self.past.moved[0].values[0] - self.past.moved[1].values[0]
        return 0.5 * (course.at(0.0) + self.past.pushed[0].force) * jump

    # -- polynomials -----------------------------------------------------------------------------------

    def _tau(self, time: float) -> float:
        return (time - self._time) / self._step

    def _path(self, points: Sequence[_MotionSample], count: int) -> list[_Polynomial]:
        """Of Bond.motion, through the latest points: at most `count` of them with their velocities."""
        if count == 0:
            return [_Polynomial([value]) for value in points[0].values]
        both = len(self._motion) == 2
        alone = VELOCITY_POINTS if self.bond.position is None else POSITION_POINTS
        points = self._apart(points, count if both else alone)
        nodes = [self._tau(p.time) for p in points]
        first = [p.values[0] for p in points]
        if not both:
            return [_through(nodes, first)]
        position = _through(nodes, first, [p.values[1] * self._step for p in points])
        return [position, position.slope().times(1.0 / self._step)]

    def _place(self, path: Sequence[_Polynomial]) -> _Polynomial:
        """The way along a path of Bond.motion."""
        return path[0] if self.bond.position is not None else path[0].sum().times(self._step)

    def _course(self, points: Sequence[_ForceSample], lacking: bool = False) -> _Polynomial:
        """Of the force, or of what it lacks, through the latest points."""
        points = self._apart(points, self.way.force)
        if not points:
            return _Polynomial([0.0])
        values = [p.lacking if lacking else p.force for p in points]
        return _through([self._tau(p.time) for p in points], values)

    def _apart(self, points: Iterable[Point], count: int) -> list[Point]:
        """The latest `count` points that are not too near each other."""
        kept: list[Point] = []
        for point in points:
            if len(kept) == count:
                break
            if not kept or kept[-1].time - point.time > MIN_POINT_DISTANCE * self._step:
                kept.append(point)
        return kept

    def sizes(self, step: float) -> tuple[float, ...]:
        """By which values of Bond.motion become places, of a velocity what it moves in a `step` (s)."""
        position = () if self.bond.position is None else (1.0,)
        return (*position, step) if self.bond.velocity else position

    def _scaled(self, motion: Sequence[float]) -> tuple[float, ...]:
        return tuple(size * value for size, value in zip(self.sizes(self._size), motion, strict=True))
