"""Whirl of a rotor round its touchdown bearings, from receptances: how fast, how hard, and what drives it.

The journals press their bearings while the rotor whirls in a circle at W (rad/s), counter-clockwise for
W > 0. With journals z and carriers v at the seats, x + i y, and forces F on the journals, all turning by
exp(i W t),

    z = A(W) F        v_j = -a_j(W) F_j        z_j - v_j = (c_j + d_j) exp(i b_j)

where A are receptances of the rotor, free, with its gyroscopic moments, a_j those of carrier and mount, c_j
the radial clearance and d_j how deep the journal is pressed in. Carriers on one foundation move by each
other's forces, too. A bearing answers with

    F_j = (-N(d_j) + i s T(d_j)) exp(i b_j)

N pushes inwards; T, along the circle, is what friction and rolling resistance make of it, less what the
bearing loses as the load goes round. s is how much of T is needed to sustain the circle: at s = 1 it goes
on, below it is driven and becomes faster. A whirl that starts slowly is driven until then. (After
H. F. Black, Journal of Mechanical Engineering Science 10, 1968, where T is a sliding journal's friction.)

Left out: gravity, unbalance, anisotropy of the mounts, and how a drop gets into a whirl.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import NamedTuple, cast

import numpy as np
from scipy.optimize import brentq, root

from .modes import Basis

TOLERANCE = 1e-10  # of the equations, in parts of the clearance
STEP_UP = 1.08  # of the frequency, from circle to circle
LEAST_STEP = 1e-4  # of it, at which a circle is given up
MOST_STEPS = 12  # of Broyden's method from a circle to the next
SLOWEST_DECREASE = 0.5  # of what is left, from step to step; beyond it the slope is of no use
DIFFERENCE = 1e-7  # of the unknowns, for their slope
REFINEMENTS = 40  # of the frequency at which the drive is just enough
STROKE_TOLERANCE = 1e-9  # of a stroke that its stiffness depends on, in parts of it
DOUBLINGS = 60  # of a stroke, after which no end of it is looked for
SWEEPS = 20  # over mounts of one foundation, each with the others held
DRIVES = (0.5, 0.1, 0.02, 2.0)  # tried where a first circle is looked for

Receptance = Callable[[float], np.ndarray]  # of W (rad/s): (S, S), complex, m/N
Carrier = Callable[[float, float], complex]  # of W (rad/s) and the force on it (N): m/N
# Of carriers on one foundation: of W (rad/s) and the forces on all (S,), complex, N: (S, S), complex, m/N
Ground = Callable[[float, np.ndarray], np.ndarray]
# Of W (rad/s), then of the stroke of a circle (m): force over way, complex, N/m
Stiffness = Callable[[float], Callable[[float], complex]]
Bearing = Callable[[float, float], complex]  # of depth (m) and W: -N + i T, N


class WhirlSeat(NamedTuple):
    """A touchdown bearing, and what carries it."""

    clearance: float  # m, radial
    bearing: Bearing
    carrier: Carrier


@dataclass(frozen=True)
class WhirlCircle:
    """A circular whirl; of each seat in turn."""

    omega: float  # rad/s, counter-clockwise
    depth: np.ndarray  # (S,), m, that the journal is pressed into its bearing
    angle: np.ndarray  # (S,), rad, of its place from that of the first
    force: np.ndarray  # (S,), N, inwards
    along: np.ndarray  # (S,), N, along the circle, as the bearing gives it
    stroke: np.ndarray  # (S,), m, of the carrier
    drive: float  # share of `along` that sustains the circle

    @property
    def friction(self) -> np.ndarray:
        """Required friction coefficients along the circle (S,): tangential force over inward force."""
        return self.drive * np.abs(self.along) / self.force


def receptance(basis: Basis, damping_ratio: float, nodes: Sequence[int], spin: float) -> Receptance:
    """Of a free rotor at its `nodes` (from 1), which spins at `spin` (rad/s, counter-clockwise).

    damping_ratio: of its elastic modes, as in the rotor's model.
    """
    shape, square = basis.deflections(list(nodes)), basis.omega**2
    damping = 2.0 * damping_ratio * basis.omega

    def of(omega: float) -> np.ndarray:
        stiffness = np.diag(square - omega * omega + 1j * omega * damping)
        return shape @ np.linalg.solve(stiffness + spin * omega * basis.gyroscopic, shape.T)

    return of


class ContactWhirl:
    """The circles in which a rotor may whirl round its seats."""

    def __init__(self, rotor: Receptance, seats: Sequence[WhirlSeat], ground: Ground | None = None) -> None:
        """ground: of carriers on one foundation, whose own receptances are then 0."""
        self._rotor, self._seats, self._count = rotor, tuple(seats), len(seats)
        self._ground = ground
        self._clearance = np.array([seat.clearance for seat in seats])

    def at(self, omega: float, like: WhirlCircle | None = None) -> WhirlCircle | None:
        """The circle at `omega` (rad/s) nearest to another; None where none is found."""
        track = _Track(self._equations)
        if like is not None:
            return track.circle_at(omega, _unknowns(like))
        inertia = np.abs(1.0 / np.diag(self._rotor(omega)))
        depth = [
            self._depth(seat, force, omega)
            for seat, force in zip(self._seats, inertia * self._clearance, strict=True)
        ]
        for drive in DRIVES:
            for far in (0.5, 1.0, 2.0):
                guess = np.concatenate([np.log(far * np.array(depth)), np.zeros(self._count - 1), [drive]])
                if (found := track.circle_at(omega, guess)) is not None:
                    return found
        return None

    def _depth(self, seat: WhirlSeat, force: float, omega: float) -> float:
        """How deep (m) a journal is pressed by a force (N), to a factor of two."""
        depth = 1e-9
        while -seat.bearing(depth, omega).real < force and depth < seat.clearance:
            depth *= 2.0
        return depth

    def _equations(self, omega: float) -> _Equations:
        return _Equations(omega, self._rotor(omega), self._seats, self._ground)

    def faster(self, start: float, end: float) -> Iterator[WhirlCircle]:
        """Circles from `start` to `end` (rad/s, of one sign), each from the one before, where there are.

        They begin at the first frequency at which there is one.
        """
        omega, before = start, self.at(start)
        while before is None and abs(omega) < abs(end):
            omega *= STEP_UP
            before = self.at(omega)
        track, step = _Track(self._equations), STEP_UP - 1.0
        last: WhirlCircle | None = None  # the one before
        while before is not None:
            yield before
            if abs(before.omega) >= abs(end):
                return
            found = track.next(before.omega * (1.0 + step), before, last)
            while found is None and step > LEAST_STEP:
                step *= 0.5
                found = track.next(before.omega * (1.0 + step), before, last)
            last, before, step = before, found, min(1.5 * step, STEP_UP - 1.0)

    def settled(self, start: float, end: float) -> tuple[list[WhirlCircle], WhirlCircle | None]:
        """The circles through which a whirl is driven from `start` on, and the one that it settles in.

        None: it is driven beyond `end` (rad/s), or no circle is found beyond the last one, which is slower
        than that; or it is not driven at all, where there is but one circle.
        """
        way: list[WhirlCircle] = []
        for circle in self.faster(start, end):
            way.append(circle)
            if circle.drive >= 1.0:
                break
        if len(way) < 2 or way[-1].drive < 1.0:
            return way, None
        return way, self._balanced(way[-2], way[-1])

    def _balanced(self, below: WhirlCircle, above: WhirlCircle) -> WhirlCircle:
        """Between two circles the one whose drive is just enough, by halving with the secant."""
        best, track = above, _Track(self._equations)
        for _ in range(REFINEMENTS):
            part = (1.0 - below.drive) / (above.drive - below.drive)
            part = min(max(part, 0.05), 0.95)
            found = track.next(below.omega + part * (above.omega - below.omega), below, above)
            if found is None:
                break
            best = found
            if abs(found.drive - 1.0) < 1e-6:
                break
            below, above = (found, above) if found.drive < 1.0 else (below, found)
        return best


class _There(NamedTuple):
    """At the unknowns of `_Equations`, of each seat."""

    depth: list[float]  # m
    turn: list[complex]  # where the journal is
    pushes: list[complex]  # N, by the bearing: -N + i T
    force: list[complex]  # N, on the journal
    carried: list[complex]  # m, that its carrier goes the other way


@dataclass(frozen=True)
class _Equations:
    """Of a circle at one frequency.

    Unknowns: logarithms of the depths (S,), angles but for the first (S - 1,), drive.
    """

    omega: float
    rotor: np.ndarray  # (S, S)
    seats: tuple[WhirlSeat, ...]
    ground: Ground | None

    def gaps(self, u: np.ndarray) -> np.ndarray:
        """Residuals of the seats' equations (2 S,), relative to their clearances."""
        depth, turn, _, force, carried = self._at(u)
        way = [
            sum(a * f for a, f in zip(row, force, strict=True)) + moved
            for row, moved in zip(self._rows, carried, strict=True)
        ]
        seats = zip(way, self.seats, depth, turn, strict=True)
        left = [(gone - (seat.clearance + d) * t) / seat.clearance for gone, seat, d, t in seats]
        return np.array([one.real for one in left] + [one.imag for one in left])

    def circle(self, u: np.ndarray) -> WhirlCircle:
        """The circle of the unknowns."""
        there = self._at(u)
        pushes = np.array(there.pushes)
        return WhirlCircle(
            self.omega,
            np.array(there.depth),
            np.append(0.0, u[len(self.seats) : -1]),
            -np.real(pushes),
            np.imag(pushes),
            np.abs(there.carried),
            float(u[-1]),
        )

    @cached_property
    def _rows(self) -> list[list[complex]]:
        return self.rotor.tolist()

    # plain numbers: for one or two seats that is faster than arrays
    def _at(self, u: np.ndarray) -> _There:
        values, n = u.tolist(), len(self.seats)
        drive = values[-1]
        depth = [math.exp(min(max(one, -40.0), 0.0)) for one in values[:n]]
        turn = [1.0 + 0.0j, *(cmath.rect(1.0, angle) for angle in values[n:-1])]
        pushes = [seat.bearing(d, self.omega) for seat, d in zip(self.seats, depth, strict=True)]
        force = [complex(one.real, drive * one.imag) * t for one, t in zip(pushes, turn, strict=True)]
        carried = [s.carrier(self.omega, abs(f)) * f for s, f in zip(self.seats, force, strict=True)]
        if self.ground is not None:
            together = np.array(force)
            carried = (np.array(carried) + self.ground(self.omega, together) @ together).tolist()
        return _There(depth, turn, pushes, force, carried)


class _Track:
    """Finds circles one after the other; what the slope of the equations was at one serves for the next."""

    def __init__(self, equations: Callable[[float], _Equations]) -> None:
        self._equations = equations
        self._slope: np.ndarray | None = None

    def next(self, omega: float, before: WhirlCircle, other: WhirlCircle | None) -> WhirlCircle | None:
        """The circle at `omega` (rad/s) on the line through two others, or nearest to the first."""
        unknowns = _unknowns(before)
        if other is not None and self._slope is not None:
            part = math.log(omega / before.omega) / math.log(other.omega / before.omega)
            found = self._followed(omega, unknowns + part * (_unknowns(other) - unknowns))
            if found is not None:
                return found
        return self.circle_at(omega, unknowns)

    def _followed(self, omega: float, guess: np.ndarray) -> WhirlCircle | None:
        """By Broyden's method with the slope that is known; None where it does not lead straight there."""
        equations, slope = self._equations(omega), np.array(self._slope)
        u, gaps = guess, equations.gaps(guess)
        for _ in range(MOST_STEPS):
            size = float(np.abs(gaps).max())
            if size <= TOLERANCE:
                self._slope = slope
                return _valid(equations.circle(u))
            try:
                step = -np.linalg.solve(slope, gaps)
            except np.linalg.LinAlgError:
                return None
            u = u + step
            gaps = equations.gaps(u)
            if not np.abs(gaps).max() < SLOWEST_DECREASE * size:  # also where it is not a number
                return None
            slope += np.outer(gaps, step) / (step @ step)
        return None

    def circle_at(self, omega: float, guess: np.ndarray) -> WhirlCircle | None:
        """The circle at `omega` (rad/s) nearest to a guess of its unknowns."""
        equations = self._equations(omega)
        found = root(equations.gaps, guess, tol=TOLERANCE)
        if not (found.success and np.all(np.isfinite(found.fun))):
            return None
        if (circle := _valid(equations.circle(found.x))) is not None:
            columns = DIFFERENCE * np.eye(len(guess))
            self._slope = np.column_stack(
                [(equations.gaps(found.x + one) - found.fun) / DIFFERENCE for one in columns]
            )
        return circle


def _valid(circle: WhirlCircle) -> WhirlCircle | None:
    """A circle in which all journals press, and something drives."""
    return circle if np.all(circle.force > 0.0) and circle.drive > 0.0 else None


def _unknowns(circle: WhirlCircle) -> np.ndarray:
    """As `_Equations` has them."""
    return np.concatenate([np.log(circle.depth), circle.angle[1:], [circle.drive]])


def steady(mass: float, stiffness: float, damping: float) -> Carrier:
    """A mass (kg) on a spring (N/m) and a damper (N s/m)."""
    return lambda omega, force: 1.0 / (stiffness - mass * omega * omega + 1j * omega * damping)


def _met(after: Callable[[float], float]) -> float:
    """A stroke (m) that equals what its stiffness makes of it, `after`; nan: none was found.

    The bracket is the first in which the sign changes, from no stroke on: what no force is left for is
    beyond the root.
    """
    low, high, left = 0.0, after(0.0), math.nan
    if not math.isfinite(high):
        return math.nan
    for _ in range(DOUBLINGS):
        left = after(high) - high
        if abs(left) <= STROKE_TOLERANCE * high:
            return high
        if not left > 0.0:
            break
        low, high = high, 2.0 * high
    if not left < 0.0:  # also where it is not a number
        return math.nan
    found = cast(
        float, brentq(lambda one: after(one) - one, low, high, xtol=1e-6 * STROKE_TOLERANCE * high)
    )
    return found if abs(after(found) - found) <= STROKE_TOLERANCE * found else math.nan


def circling(stiffness: Stiffness, mass: float) -> Carrier:
    """A mass (kg) on what resists with a dynamic stiffness that depends on its stroke.

    nan where no stroke is found.
    """
    at_rate = lru_cache(maxsize=1)(stiffness)

    def receptance_of(omega: float, force: float) -> complex:
        resists, inertia = at_rate(omega), mass * omega * omega
        stroke = _met(lambda s: force / abs(resists(s) - inertia))
        return 1.0 / (resists(stroke) - inertia) if math.isfinite(stroke) else complex(math.nan, math.nan)

    return receptance_of


@dataclass(frozen=True)
class ElasticModes:
    """Of a foundation without its carriers."""

    omega: np.ndarray  # (M,), rad/s
    damping_ratio: np.ndarray  # (M,)
    shape: np.ndarray  # (M, S, 2), mass-normalised, x and y at each seat

    def around(self, omega: float) -> np.ndarray:
        """Way over force between seats (S, S) on a circle at `omega` (rad/s), m/N, in the mean over it."""
        swing = self.omega**2 - omega * omega + 2j * self.damping_ratio * self.omega * omega
        x, y = self.shape[:, :, 0], self.shape[:, :, 1]
        by = [np.einsum("mj,mk,m->jk", a, b, 1.0 / swing) for a, b in ((x, x), (y, y), (y, x), (x, y))]
        return 0.5 * (by[0] + by[1] + 1j * (by[2] - by[3]))


def on_modes(modes: ElasticModes, mounts: Sequence[Stiffness], masses: Sequence[float]) -> Ground:
    """Carriers (kg) on mounts, one at each seat of a foundation.

    With K the mounts' stiffness at their strokes and H what the modes give way by, a mount presses with
    f = K (v - u), u = H f, so that ((1 + K H)^-1 K - W^2 m) v = F. nan where no strokes are found.
    """
    mass = np.array(masses)

    @lru_cache(maxsize=1)
    def at_rate(omega: float) -> tuple[list[Callable[[float], complex]], np.ndarray]:
        return [one(omega) for one in mounts], modes.around(omega)

    def receptance_of(omega: float, force: np.ndarray) -> np.ndarray:
        (resists, give), inertia = at_rate(omega), mass * omega * omega

        def at(stroke: np.ndarray) -> np.ndarray:
            k = np.array([one(float(s)) for one, s in zip(resists, stroke, strict=True)])
            through = np.linalg.solve(np.eye(len(mass)) + k[:, None] * give, np.diag(k))
            return np.linalg.inv(through - np.diag(inertia))

        def after(stroke: np.ndarray) -> np.ndarray:
            way = at(stroke) @ force
            return np.abs(way - give @ (force + inertia * way))

        stroke = _all_met(after, len(mass))
        return at(stroke) if np.all(np.isfinite(stroke)) else np.full((len(mass),) * 2, complex(math.nan))

    return receptance_of


def _all_met(after: Callable[[np.ndarray], np.ndarray], count: int) -> np.ndarray:
    """Strokes (m) that equal what their stiffnesses make of them together; nan: none were found.

    Each is met with the others held, in turn. From there they are solved together by their logarithms, in
    which a stiff stop is nearly a straight line.
    """

    def residual(logs: np.ndarray) -> np.ndarray:
        return np.log(after(np.exp(logs))) - logs

    def are_met(stroke: np.ndarray) -> bool:
        return bool(np.all(np.abs(after(stroke) - stroke) <= STROKE_TOLERANCE * stroke))

    stroke = after(np.zeros(count))
    if are_met(stroke):  # as where no stiffness depends on them
        return stroke
    for _ in range(SWEEPS):
        for k in range(count):
            stroke[k] = _met(lambda one, k=k: float(after(_with(stroke, k, one))[k]))
        if not np.all(np.isfinite(stroke)) or are_met(stroke):
            return stroke
        if np.all(stroke > 0.0):
            solved = np.exp(root(residual, np.log(stroke), tol=0.01 * STROKE_TOLERANCE).x)
            if are_met(solved):
                return solved
    return np.full(count, math.nan)


def _with(strokes: np.ndarray, k: int, one: float) -> np.ndarray:
    """A copy whose number k is another one."""
    there = strokes.copy()
    there[k] = one
    return there


def rigid(omega: float, force: float) -> complex:
    """A seat that does not give way."""
    return 0.0 + 0.0j
