"""Whirl speeds of a rotor over its spin: Campbell diagram, and undamped critical speeds.

A critical speed is a spin at which a whirl is as fast as the unbalance that drives it. A whirl at the spin
speed w, x = X cos w t and y = Y sin w t in the coordinates of `Basis`, has

    K_x X = w^2 (X - G Y),    K_y Y = w^2 (Y - G X),

K with the springs of the supports. Where both planes are held alike, Y = X is the forward whirl, which
unbalance drives, and Y = -X the backward one, which it does not.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
from scipy import linalg, optimize

from ..beams.shaft import Shaft, Station, Support
from .modes import Basis
from .supported import DampedModes, HeldRotor, LinearBearing

OVERDAMPED_RATIO = 0.95  # damping ratio from which a mode hardly swings: such as a controller's lag
# Of a mode and the next speed's: 1 less their likeness, and how far apart their roots are
MAX_UNLIKENESS = 1.0
SENSE_PENALTY = 0.1  # of a root's size that another sense of whirl is worth
SPEED_TOLERANCE = 1e-12  # of a critical speed


def whirl_frequencies(
    basis: Basis, speeds: Sequence[float] | np.ndarray, supports: Iterable[tuple[int, float]] = ()
) -> np.ndarray:
    """Whirl speeds at each spin speed, (len(speeds), 2n), rad/s, ascending; forward whirl is positive.

    `supports` are isotropic springs to the ground: (node counted from 1, stiffness in N/m). An undamped
    motion p exp(i w t) has w^2 p = w Omega G p + K p. With K = B B^T and w s = B^T p this is the
    symmetric problem w (p, s) = [[Omega G, B], [B^T, 0]] (p, s): its w are real, and a free rotor's
    zeros cost no accuracy.
    """
    n = len(basis.omega)
    rows = [np.diag(basis.omega)]
    for node, stiffness in supports:
        rows.append(np.sqrt(stiffness) * basis.deflections([node]))
    _, upper = np.linalg.qr(np.vstack(rows))
    B = upper.T
    whirl = np.empty((len(speeds), 2 * n))
    for i, speed in enumerate(speeds):
        whirl[i] = np.linalg.eigvalsh(np.block([[speed * basis.gyroscopic, B], [B.T, np.zeros((n, n))]]))
    return whirl


@dataclass(frozen=True)
class Crossing:
    """A damped critical speed: the whirl of a line is as fast as the spin."""

    speed: float  # rad/s
    root: complex  # 1/s, of the mode there
    sense: float  # of its whirl: 1 circular, with the spin; -1 circular, against it; 0 in a plane


@dataclass(frozen=True)
class Lines:
    """Modes of a rotor in bearings, followed over its spin speed.

    Where a mode stops swinging, and beyond, its line is nan.
    """

    speeds: np.ndarray  # (S,), rad/s, ascending, not negative
    roots: np.ndarray  # (S, L), complex, 1/s
    sense: np.ndarray  # (S, L), as `Crossing.sense`
    stable: np.ndarray  # (S,), whether nothing grows, lines or not
    crossings: tuple[Crossing, ...]  # by speed


def followed(rotor: HeldRotor, speeds: Sequence[float] | np.ndarray, count: int) -> Lines:
    """The lowest `count` modes over `speeds` (rad/s, ascending, not negative), and where they are critical.

    What hardly swings (a damping ratio of `OVERDAMPED_RATIO` or more) is left out.

    A mode goes on as the one that looks most like it at the next speed. Lines are drawn from the highest
    speed down: at rest, where both planes may be alike, any mix of two whirls is a mode.
    """
    speeds = np.asarray(speeds, dtype=float)
    found = [rotor.damped_modes(speed) for speed in speeds]
    lines: list[dict[int, int]] = []  # of each the mode by the number of the speed
    for i in reversed(range(len(speeds))):
        going = [line for line in lines if i + 1 in line]
        pairs = _likest(found[i + 1], [line[i + 1] for line in going], found[i]) if going else {}
        for number, mode in pairs.items():
            going[number][i] = mode
        taken = set(pairs.values())
        lines += [{i: mode} for mode in _lowest(found[i], count) if mode not in taken]
    roots = np.full((len(speeds), len(lines)), complex(np.nan, np.nan))
    sense = np.full(roots.shape, np.nan)
    for k, line in enumerate(lines):
        for i, mode in line.items():
            roots[i, k], sense[i, k] = found[i].roots[mode], found[i].sense[mode]
    if len(speeds) > 1 and speeds[0] == 0.0:  # whirls of a rotor at rest have no sense of their own
        sense[0] = sense[1]
    stable = np.array([one.stable for one in found])
    return Lines(speeds, roots, sense, stable, tuple(_crossings(rotor, speeds, roots, sense)))


def _lowest(found: DampedModes, count: int) -> list[int]:
    """The lowest `count` modes but those that hardly swing."""
    return np.flatnonzero(found.damping_ratios < OVERDAMPED_RATIO)[:count].tolist()


def _likest(last: DampedModes, modes: Sequence[int], found: DampedModes) -> dict[int, int]:
    """For each of the `modes`, by its place among them, the one of `found` that goes on with it, if any."""
    alike = np.abs(np.conj(last.vectors[:, modes]).T @ found.vectors) ** 2
    before, after = last.roots[modes][:, None], found.roots[None, :]
    apart = np.abs(before - after) / np.maximum(np.abs(before), np.abs(after))
    cost = 1.0 - alike + apart
    rows, columns = optimize.linear_sum_assignment(cost)
    return {int(r): int(c) for r, c in zip(rows, columns, strict=True) if cost[r, c] < MAX_UNLIKENESS}


def _crossings(
    rotor: HeldRotor, speeds: np.ndarray, roots: np.ndarray, sense: np.ndarray
) -> list[Crossing]:
    """Where the lines cross the spin."""
    above = np.imag(roots) - speeds[:, None]  # nan is neither above nor below
    crossings: list[Crossing] = []
    for i, k in zip(*np.nonzero((above[:-1] > 0.0) != (above[1:] > 0.0)), strict=True):
        ends = slice(i, i + 2)
        if np.isfinite(above[ends, k]).all():
            crossings.append(_crossing(rotor, speeds[ends], roots[ends, k], float(sense[i + 1, k])))
    return sorted(crossings, key=lambda one: one.speed)


def _crossing(rotor: HeldRotor, speeds: np.ndarray, roots: np.ndarray, sense: float) -> Crossing:
    """The critical speed between two `speeds` (2,), rad/s, of the mode that has the `roots` (2,) there."""

    @cache
    def at(speed: float) -> Crossing:
        found = rotor.damped_modes(speed)
        share = (speed - speeds[0]) / (speeds[1] - speeds[0])
        guess = roots[0] + share * (roots[1] - roots[0])
        off = np.abs(found.roots - guess) / abs(guess) + SENSE_PENALTY * np.abs(found.sense - sense)
        nearest = int(np.argmin(off if speed > 0.0 else np.abs(found.roots - guess)))
        return Crossing(speed, complex(found.roots[nearest]), float(found.sense[nearest]))

    def ahead(speed: float) -> float:
        return at(speed).root.imag - speed

    low, high = speeds.tolist()
    if (ahead(low) > 0.0) == (ahead(high) > 0.0):  # at an end another mode is as near: as they go
        above = np.imag(roots) - speeds
        share = above[0] / (above[0] - above[1])
        return Crossing(
            float(speeds[0] + share * np.diff(speeds)[0]),
            complex(roots[0] + share * np.diff(roots)[0]),
            sense,
        )
    found = optimize.root_scalar(ahead, bracket=(low, high), xtol=SPEED_TOLERANCE * high)
    return at(float(found.root))


@dataclass(frozen=True)
class HeldModes:
    """A rotor in bearings: its modes at a speed, and its lines over the speeds of a Campbell diagram."""

    bearings: tuple[LinearBearing, ...]
    speed: float  # rad/s, not negative
    modes: DampedModes  # there
    lines: Lines

    @property
    def swinging(self) -> np.ndarray:
        """Which of the modes at `speed` swing (their places): all but those that hardly do."""
        return np.flatnonzero(self.modes.damping_ratios < OVERDAMPED_RATIO)


def held_modes(rotor: HeldRotor, speeds: Sequence[float] | np.ndarray, count: int) -> HeldModes:
    """A rotor at the first of `speeds` (rad/s, not negative), its `count` lowest lines over the others."""
    first, *others = speeds
    lines = followed(rotor, others, count)
    return HeldModes(tuple(rotor.bearings), first, rotor.damped_modes(first), lines)


MAP_STIFFNESSES = 61  # of a map
MAP_DECADES = (-4, 2)  # of a map, about the first bending mode's frequency squared times the mass
MAP_LINES = 5  # of a map
MIN_INVERSE_SQUARE = 1e-12  # of the largest 1 / w^2: below, rounding of what has no critical speed


@dataclass(frozen=True)
class CriticalMap:
    """Critical speeds over the stiffness of the supports at some stations, equal at all of them.

    `marked` are the supports that the shaft itself has there, and `own` its critical speeds on them.
    """

    places: tuple[Station, ...]
    stiffness: np.ndarray  # (K,), N/m, of each support
    speeds: np.ndarray  # (K, L), rad/s, ascending; nan where there are less
    marked: tuple[Support, ...]
    critical: np.ndarray  # (up to L,), rad/s; empty where a place has no support


def critical_speeds(basis: Basis, supports: Sequence[Support]) -> np.ndarray:
    """Critical speeds on `supports`, without their damping, ascending (C,), rad/s.

    Where the planes are held alike, those of the forward whirl; else all, since unbalance drives all. A
    whirl whose gyroscopic moment outruns it has none. At least two nodes must be held.
    """
    planes = [_held(basis, supports, plane) for plane in ("stiffness", "stiffness_y")]
    one, G = np.eye(len(basis.omega)), basis.gyroscopic
    if np.array_equal(planes[0], planes[1]):
        return _speeds(planes[0], one - G)
    return _speeds(np.asarray(linalg.block_diag(*planes)), np.block([[one, -G], [-G, one]]))


def critical_map(shaft: Shaft, basis: Basis, places: Sequence[Station]) -> CriticalMap:
    """The map of `shaft` held at `places`, two nodes or more; about its first bending mode."""
    scale = shaft.mass * basis.omega[2] ** 2
    low, high = (round(np.log10(scale) + decade) for decade in MAP_DECADES)
    stiffness = np.logspace(low, high, MAP_STIFFNESSES)
    held = [Support(node, 1.0) for node in dict.fromkeys(s.node for s in places)]
    speeds = [critical_speeds(basis, [replace(s, stiffness=k) for s in held]) for k in stiffness]
    nodes = {s.node for s in held}
    stiff = [s for s in shaft.supports if 0.0 not in (s.stiffness, s.stiffness_y)]
    marked = tuple(s for s in stiff if s.node in nodes)
    marked_speeds = critical_speeds(basis, marked) if {s.node for s in marked} == nodes else np.zeros(0)
    return CriticalMap(
        tuple(places), stiffness, np.array([_first(s) for s in speeds]), marked, marked_speeds[:MAP_LINES]
    )


def _first(speeds: np.ndarray) -> np.ndarray:
    """The lowest `MAP_LINES` of them (MAP_LINES,), nan where there are less."""
    return np.pad(speeds[:MAP_LINES], (0, max(0, MAP_LINES - len(speeds))), constant_values=np.nan)


def _held(basis: Basis, supports: Sequence[Support], plane: str) -> np.ndarray:
    """Stiffness of a plane with the springs there (n, n)."""
    K = np.diag(basis.omega**2)
    for s in supports:
        stiffness = getattr(s, plane)
        shape = basis.deflections([s.node])[0]
        K += (s.stiffness if stiffness is None else stiffness) * np.outer(shape, shape)
    return K


def _speeds(K: np.ndarray, M: np.ndarray) -> np.ndarray:
    """Real w of K v = w^2 M v, ascending; K is positive definite, M need not be."""
    inverse = linalg.eigh(M, K, eigvals_only=True)  # 1 / w^2
    return 1.0 / np.sqrt(inverse[inverse > MIN_INVERSE_SQUARE * inverse[-1]][::-1])
