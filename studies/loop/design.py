"""A PID with second-order sections for magnetic bearings, by a search over their sampled loops.

The search makes the largest |S| small, of all axes, at standstill, at the scene's speed and beyond. Its
coordinates are those of a designer: what stiffness is left beside k_s, damping, cut-off of the derivative;
of a section the frequencies and damping ratios of its zeros and poles. A section begins at a bending mode
of the free rotor as a notch or as one that turns the phase ahead or back, whichever is best.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from copy import copy
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from scipy.optimize import minimize

from ...bearings.magnetic.law import SECTIONS, Channel, Gain
from ...bearings.magnetic.linear import LinearLaw
from ...master.scene.scene import Scene
from ...modelkit.variables import flatten
from .linear_loops import LOWEST, TINY, KnownLaws, Sampled, growing

SPEEDS = (0.0, 1.5)  # of the scene's
LATE = 0.5  # weight of the peak with a sample more of delay, which the loops are to stand
GOAL = 2.5  # a peak of |S| that asks for no section: zone A with room
FIRST = [(k, d, f) for k in (0.5, 1.0, 2.0) for d in (0.4, 0.8, 1.5) for f in (0.1, 0.3, 1.0, 3.0)]
WITHIN = ((0.3, 3.0), (0.2, 2.0), (0.02, 5.0))  # stiffness over |k_s|, damping ratio, filter times period
SECTION_STARTS = ((1.0, 0.1, 1.0, 0.7), (0.85, 0.3, 1.3, 0.5), (1.2, 0.3, 0.8, 0.5))  # over the mode
SECTION_WITHIN = ((0.3, 3.0), (0.03, 1.0), (0.3, 3.0), (0.03, 1.0))
MODES = 4  # that may ask for a section
STEP = 0.25  # of the search's first steps, of logarithms
CALLS = 25  # of a search, for each coordinate
WORTH = 0.95  # of the peak that a section leaves, at most
INTEGRAL = 0.05  # its rate over the natural frequency
UNSTABLE = 20.0  # a peak for loops that are not stable, plus 1/s by which they grow over `GROWTH`
GROWTH = 10.0
LINES = 300
FASTEST = 0.8  # zero or pole of a section, of the highest line
HIGHEST_MODE = 0.6  # for which there is a section, of the same


@dataclass(frozen=True)
class Section:
    """(s2 + 2 d_z w_z s + w_z2) / (s2 + 2 d_p w_p s + w_p2), 1 at rest."""

    zero: float  # rad/s
    zero_damping: float
    pole: float  # rad/s
    pole_damping: float

    def coefficients(self, period: float) -> dict[str, float]:
        """As `amb_controller` has them, by Tustin's rule, exact between its zero and its pole."""
        middle = math.sqrt(self.zero * self.pole)
        rate = middle / math.tan(0.5 * middle * period)  # s is rate (z - 1)/(z + 1)

        def in_samples(w: float, d: float) -> np.ndarray:
            across = 2.0 * d * w * rate
            return np.array([rate**2 + across + w**2, 2.0 * (w**2 - rate**2), rate**2 - across + w**2])

        below = in_samples(self.pole, self.pole_damping)
        above = in_samples(self.zero, self.zero_damping) * (self.pole / self.zero) ** 2
        values = *(above / below[0]), *(below[1:] / below[0])
        return dict(zip(("b0", "b1", "b2", "a1", "a2"), map(float, values), strict=True))


@dataclass(frozen=True)
class Bearing:
    """What a controller's gains are made for."""

    mass: float  # kg, that it carries
    current_factor: float  # k_i, N/A
    displacement_factor: float  # k_s, N/m, below zero

    def gains(self, stiffness: float, damping: float, cutoff: float) -> dict[str, float]:
        """By the stiffness left over |k_s|, the damping ratio, and the derivative's cut-off (rad/s)."""
        k = -self.displacement_factor
        natural = math.sqrt(stiffness * k / self.mass)
        return {
            "proportional": (1.0 + stiffness) * k / self.current_factor,
            "derivative": 2.0 * damping * natural * self.mass / self.current_factor,
            "filter": cutoff,
            "integral": INTEGRAL * natural * stiffness * k / self.current_factor,
        }


@dataclass(frozen=True)
class Tuned:
    """A controller, the same for all axes."""

    peak: float  # largest |S|, or with more delay `LATE` times that; unstable: above `UNSTABLE`
    period: float  # s, for which it is
    bearing: Bearing
    values: tuple[float, ...]  # logarithms: stiffness, damping, filter times period, then four per section

    @property
    def shape(self) -> tuple[float, float, float]:
        """Stiffness over |k_s|, damping ratio, cut-off of the derivative (rad/s)."""
        stiffness, damping, share = map(math.exp, self.values[:3])
        return stiffness, damping, share / self.period

    @property
    def gains(self) -> dict[str, float]:
        """Of `amb_controller`, by the names of its `gain`."""
        return self.bearing.gains(*self.shape)

    @property
    def sections(self) -> tuple[Section, ...]:
        """Behind the PID."""
        parts = np.exp(self.values[3:]).reshape(-1, 4)
        return tuple(Section(*map(float, part)) for part in parts)

    @property
    def law(self) -> LinearLaw:
        """Of a channel."""
        values = {v.name: v.default for v in flatten(Gain(), "gain.")}
        values |= {v.name: v.default for v in flatten(Channel(), "channel[1].")}
        values |= {f"gain.{name}": value for name, value in self.gains.items()}
        for n, section in enumerate(self.sections, 1):
            found = section.coefficients(self.period)
            values |= {f"channel[1].section[{n}].{name}": value for name, value in found.items()}
        return LinearLaw.of(values.__getitem__, 1, self.period)


def tuned(scene: Scene, mass: float) -> Tuned:
    """The controller for a scene whose rotor is `rotor`; mass (kg): on the bearing that carries most."""
    search = _Search(scene, mass)
    found = min((search.judged(np.log(one)) for one in FIRST), key=lambda one: one.peak)
    found = search.improved(found)
    while found.peak > GOAL and len(found.sections) < SECTIONS and search.modes:
        starts = [
            np.append(found.values, np.log([a * mode, da, b * mode, db]))
            for mode in search.modes
            for a, da, b, db in SECTION_STARTS
        ]
        better = search.improved(min(map(search.judged, starts), key=lambda one: one.peak))
        if better.peak > WORTH * found.peak:
            break
        found = better
    return found


class _Search:
    """The loops at all speeds, with whichever law."""

    def __init__(self, scene: Scene, mass: float) -> None:
        loops = Sampled(scene)
        shown = 1 + int(np.sum(loops.rotor.omega < loops.highest))  # modes that samples show, and one more
        if shown < len(loops.rotor.omega):
            loops = Sampled(scene.set({"rotor.modes": shown}))
        axes = [axis for bearing in loops.bearings for axis in bearing.axes]
        k_s = min(axis.displacement_factor for axis in axes)
        self._bearing = Bearing(mass, loops.bearings[0].current_factor, k_s)
        self._at = [(copy(loops), share * loops.speed) for share in SPEEDS]
        bending = np.imag(loops.rotor.bending(0.0, HIGHEST_MODE * loops.highest))
        self.modes = sorted({float(f"{w:.6g}") for w in bending})[:MODES]
        self._lines = np.geomspace(LOWEST, loops.highest, LINES)
        self._period, self._fastest = loops.period, math.log(FASTEST * loops.highest)

    def judged(self, values: np.ndarray | Sequence[float]) -> Tuned:
        """A controller by its `values`, with its peak."""
        one = Tuned(math.nan, self._period, self._bearing, tuple(map(float, values)))
        law, axes = one.law, len(self._at[0][0].names)
        peaks = []
        for delay, weight in ((1, 1.0), (2, LATE)):
            laws = KnownLaws((law,) * axes, np.eye(axes), delay)
            peaks += [weight * self._peak(loops, speed, laws) for loops, speed in self._at]
        return replace(one, peak=max(peaks))

    def _peak(self, loops: Sampled, speed: float, laws: KnownLaws) -> float:
        """Of |S| on lines and at the poles, by the modes of the closed loops."""
        loops.laws = laws
        closed = loops.closed(speed).balanced()
        values, vectors = np.linalg.eig(closed.A)
        poles = np.log(values[np.abs(values) > TINY].astype(complex)) / self._period
        grows = growing(poles)
        if grows is not None:
            return UNSTABLE + grows.real / GROWTH
        turns = np.imag(poles)
        omega = np.append(self._lines, turns[(turns > LOWEST) & (turns < loops.highest)])
        parts = (closed.C @ vectors).T * np.linalg.solve(vectors, closed.B)  # (states, axes)
        z = np.exp(1j * omega * self._period)
        return float(np.abs(1.0 + (1.0 / (z[:, None] - values)) @ parts).max())

    def improved(self, start: Tuned) -> Tuned:
        """The best that a simplex (Nelder and Mead) finds from a start."""
        x = np.array(start.values)
        ends = np.log(WITHIN)
        for k in range(3, len(x), 4):
            middle = 0.5 * (x[k] + x[k + 2])
            ends = np.vstack([ends, np.log(SECTION_WITHIN) + np.outer([middle, 0.0] * 2, (1.0, 1.0))])
        ends = np.minimum(ends, self._fastest)
        x = np.clip(x, *ends.T)
        found: Any = minimize(
            lambda values: self.judged(values).peak,
            x,
            method="Nelder-Mead",
            bounds=ends,
            options={
                "initial_simplex": np.clip(np.vstack([x, x + STEP * np.eye(len(x))]), *ends.T),
                "xatol": 0.02,
                "fatol": 0.01,
                "maxfev": CALLS * len(x),
            },
        )
        return self.judged(found.x)
