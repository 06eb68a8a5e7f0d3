"""The ball set of a bearing: geometry, material, and what follows from them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy.optimize import least_squares

from touchdown.bearings.contact.laws import ContactLaw, abreast, damped
from touchdown.bearings.contact.peaks import Largest, watch_peaks
from touchdown.bearings.contact.proportion import out_of_proportion
from touchdown.bearings.contact.stiffness import (
    exact_ellipse,
    in_series,
    printed_ellipse,
    race_contact_stiffness,
)
from touchdown.modelkit.kernel import kernel
from touchdown.modelkit.variables import integer, real

MOST_BALLS = 32  # room in the state vector
EXACT, PRINTED = range(2)  # values of `BallSet.hertz`


@dataclass(frozen=True)
class BallSet:
    """Balls and races. Defaults: SKF 6004 of the source's Table 1.

    Bearings mounted in pairs, or with several rows, are one set of balls: each stands for the `rows` balls
    side by side, with their mass and inertia together and the stiffness of all their contacts. Geometry,
    contact stiffness and forces are stated per ball.
    """

    count: int = integer(9, "number of balls in a row", minimum=3, maximum=MOST_BALLS)
    rows: int = integer(1, "rows of balls side by side that share the load alike", minimum=1, maximum=8)
    diameter: float = real(6.4e-3, "m", "ball diameter", above=0.0)
    pitch_diameter: float = real(31e-3, "m", "pitch diameter", above=0.0)
    play: float = real(5e-6, "m", "radial play between balls and races; negative: preload")
    conformity: float = real(1.04, "1", "groove radius over ball radius", above=1.0, maximum=2.0)
    outer_conformity: float = real(
        0.0, "1", "the same of the outer race; 0: as of the inner one", minimum=0.0, maximum=2.0
    )
    hertz: int = integer(
        EXACT,
        "elliptic integrals of the race contacts: 0 exact, 1 as the source prints them (2.46)",
        minimum=0,
        maximum=1,
    )
    modulus: float = real(207e9, "Pa", "modulus of elasticity of balls and rings", above=0.0)
    poisson: float = real(0.3, "1", "Poisson's ratio of balls and rings", minimum=0.0, maximum=0.5)
    density: float = real(7830.0, "kg/m3", "density of the balls", above=0.0)
    first_angle: float = real(-math.pi / 2, "rad", "attitude angle of the first ball at the start")
    damping: float = real(
        0.0, "N.s/m2", "damping of the race contacts, proportional to indentation (2.38)", minimum=0.0
    )
    damping_ratio: float = real(
        0.0, "1", "damping ratio (2.47) of a ball on a race, added to `damping`", minimum=0.0
    )
    expected_indentation: float = real(
        3e-6, "m", "peak indentation for which the damping ratio holds", above=0.0
    )

    @property
    def spread(self) -> float:
        """Spacing of the balls at the start over even spacing."""
        return 1.0

    @property
    def may_overlap(self) -> bool:
        """Whether more balls are admitted than fit."""
        return False

    @property
    def ball_radius(self) -> float:
        """m"""
        return self.diameter / 2.0

    @property
    def pitch_radius(self) -> float:
        """m"""
        return self.pitch_diameter / 2.0

    @property
    def inner_radius(self) -> float:
        """Radius of the inner race where the balls run (m)."""
        return self.pitch_radius - self.ball_radius

    @property
    def outer_radius(self) -> float:
        """Radius of the outer race where the balls run (m)."""
        return self.pitch_radius + self.ball_radius

    @property
    def ball_mass(self) -> float:
        """Of the balls side by side (kg)."""
        return self.rows * (self.density * math.pi / 6.0 * self.diameter**3)

    @property
    def ball_inertia(self) -> float:
        """Of solid spheres about their centres, those side by side together (kg m2)."""
        return 0.4 * self.ball_mass * self.ball_radius**2

    @property
    def touch_angle(self) -> float:
        """Angle at the bearing's centre between neighbours that just touch (rad)."""
        return 2.0 * math.asin(min(1.0, self.ball_radius / self.pitch_radius))

    def inner_stiffness(self) -> float:
        """Ball on inner race (2.45), N/m^1.5."""
        return self._race_stiffness(self.inner_radius, self.conformity)

    def outer_stiffness(self) -> float:
        """Ball on outer race (2.45), N/m^1.5."""
        return self._race_stiffness(-self.outer_radius, self.outer_conformity or self.conformity)

    def _race_stiffness(self, race_radius: float, conformity: float) -> float:
        """Ball on a race of `race_radius` (m, negative for the outer one), N/m^1.5."""
        ellipse = printed_ellipse if self.hertz == PRINTED else exact_ellipse
        return race_contact_stiffness(
            self.diameter, race_radius, conformity, self.modulus, self.poisson, ellipse
        )

    def series_stiffness(self) -> float:
        """Inner ring over ball to outer ring (2.5), N/m^1.5."""
        return in_series(self.inner_stiffness(), self.outer_stiffness())

    @property
    def outer_share(self) -> float:
        """How much of the rings' approach at a ball is indentation of the outer race."""
        inner, outer = self.inner_stiffness() ** (-2.0 / 3.0), self.outer_stiffness() ** (-2.0 / 3.0)
        return outer / (inner + outer)

    def race_law(self, stiffness: float) -> ContactLaw:
        """Law of the balls side by side on races, each of `stiffness` (N/m^1.5), damped as asked."""
        law = ContactLaw(
            stiffness=stiffness,
            damping=self.damping,
            damping_ratio=self.damping_ratio,
            expected_indentation=self.expected_indentation,
        )
        return damped(abreast(law, self.rows), self.ball_mass)

    def angles(self) -> list[float]:
        """Attitude angles at the start (rad), rising from the first ball's by less than a turn."""
        spacing = 2.0 * math.pi / self.count
        gap = (1.0 - self.spread) * 2.0 * math.pi  # left open opposite the first ball
        return [
            self.first_angle + self.spread * spacing * i + (gap if i > self.count // 2 else 0.0)
            for i in range(self.count)
        ]

    def starting_places(self, rest: tuple[float, float]) -> list[tuple[float, float]]:
        """Centres of the balls at the start, from the middle (m), with the ring at `rest` (m).

        A ball that both rings press sits where their forces balance; any other lies on the outer race in
        the lower half, on the inner one in the upper half.
        """
        places = []
        for angle in self.angles():
            nx, ny = math.cos(angle), math.sin(angle)
            approach = rest[0] * nx + rest[1] * ny - self.play
            radius = self.pitch_radius + 0.5 * self.play
            if approach > 0.0:
                radius += approach * self.outer_share
            elif ny > 0.0:
                radius += approach
            places.append((radius * nx, radius * ny))
        return places

    def resting_place(self, weight: float) -> tuple[float, float]:
        """Where a ring of `weight` (N, downwards) rests on evenly spaced balls, from the centre (m).

        With a ball exactly below it is held sideways by nothing within the play, and rests in the middle;
        without weight it floats there.
        """
        if weight == 0.0:
            return 0.0, 0.0
        angles = np.array(self.angles())
        nx, ny = np.cos(angles), np.sin(angles)
        stiffness = self.rows * self.series_stiffness()
        sunk = (weight / stiffness) ** (1.0 / 1.5)
        scale = max(abs(self.play), sunk, 1e-9)

        def imbalance(place: np.ndarray) -> np.ndarray:
            indentation = np.maximum((place[0] * nx + place[1] * ny) * scale - self.play, 0.0)
            force = stiffness * indentation**1.5
            return np.array([np.sum(force * nx), np.sum(force * ny) + weight]) / weight

        half_gap = math.pi / self.count
        gaps = (-0.5 * math.pi - self.first_angle) / (2.0 * half_gap)  # to the bottom, from the first ball
        off = (gaps - math.floor(gaps) - 0.5) * 2.0 * half_gap  # of the bottom from the middle of its gap
        if abs(abs(off) - half_gap) < 1e-9:  # a ball exactly below: in the middle, on that ball
            direction, reach = -0.5 * math.pi, max(self.play, 0.0) + sunk
        else:  # in the corner of the play between the two lowest balls
            direction = -0.5 * math.pi - off
            reach = (max(self.play, 0.0) + sunk) / math.cos(half_gap)
        guess = [reach / scale * math.cos(direction), reach / scale * math.sin(direction)]
        balance = least_squares(imbalance, guess, xtol=1e-15, ftol=1e-15, gtol=1e-15)
        return float(balance.x[0] * scale), float(balance.x[1] * scale)

    def problem(self) -> str | None:
        """Why these balls cannot be put together, or None."""
        if self.diameter >= self.pitch_diameter:
            return (
                f"balls.diameter = {self.diameter:g} m does not fit "
                f"balls.pitch_diameter = {self.pitch_diameter:g} m; it must be smaller"
            )
        too_many = self.count * self.touch_angle > 2.0 * math.pi * (1.0 + 1e-12)
        if too_many and not self.may_overlap:
            # rounded up, so that the remedy is one
            needed = math.ceil(1e6 * self.diameter / math.sin(math.pi / self.count)) / 1e6
            return (
                f"balls.count = {self.count} balls of {self.diameter:g} m do not fit "
                f"balls.pitch_diameter = {self.pitch_diameter:g} m; it must be at least {needed:.6g} m"
            )
        if 0.0 < self.outer_conformity <= 1.0:
            return (
                f"balls.outer_conformity = {self.outer_conformity:g} must be above 1, "
                "or 0 for a groove like the inner race's"
            )
        lengths = {"play": self.play, "expected_indentation": self.expected_indentation}
        problems = (
            out_of_proportion(f"balls.{name}", length, "half of balls.diameter", self.ball_radius)
            for name, length in lengths.items()
        )
        return next(filter(None, problems), None)


@dataclass(frozen=True)
class FreeBallSet(BallSet):
    """Balls without a cage, which need not be evenly spaced. Defaults: Koyo 6904 of the source's Table 1,
    its pitch diameter corrected to 28.5 mm.
    """

    count: int = integer(17, "number of balls", minimum=3, maximum=MOST_BALLS)
    diameter: float = real(4.8e-3, "m", "ball diameter", above=0.0)
    pitch_diameter: float = real(28.5e-3, "m", "pitch diameter", above=0.0)
    play: float = real(0.0, "m", "radial play between balls and races; negative: preload")
    bunching: float = real(
        0.0,
        "1",
        "how far the balls start bunched around the first: 0 evenly spaced, 1 touching",
        minimum=0.0,
        maximum=1.0,
    )
    crowded: int = integer(
        0,
        "1: more balls are admitted than fit, evenly pressed into each other at the start, as the source's "
        "Table 1 has them",
        minimum=0,
        maximum=1,
    )

    @property
    def may_overlap(self) -> bool:
        """Whether more balls are admitted than fit."""
        return self.crowded == 1

    @property
    def spread(self) -> float:
        """Spacing of the balls at the start over even spacing."""
        touching = min(1.0, self.count * self.touch_angle / (2.0 * math.pi))
        return 1.0 + self.bunching * (touching - 1.0)


class Total(NamedTuple):
    """What all balls do to a race."""

    fx: float  # N
    fy: float
    moment: float  # N m, about its centre
    loss: float  # W, heat


@dataclass(frozen=True)
class BallReport:
    """The balls as a whole."""

    loaded: int = integer(0, "balls pressed by both rings now", local=True)
    force: float = real(0.0, "N", "largest force between a ball and a race now", local=True)
    indentation: float = real(0.0, "m", "largest approach of the rings at a ball now", local=True)
    peak_force: float = real(
        0.0, "N", "largest force between a ball and a race since the start", local=True
    )
    first_impact_force: float = real(
        0.0, "N", "largest force between a ball and a race in the journal's first impact", local=True
    )
    peak_indentation: float = real(
        0.0, "m", "largest approach of the rings at a ball since the start", local=True
    )


@dataclass(frozen=True)
class Coordinates:
    """What the model counts (the source's Tables 5 and 6)."""

    coordinates: int = integer(
        0, "coordinates of rings, balls and cage, the outer ring's too", constant=True
    )
    constraints: int = integer(0, "constraints between them", constant=True)
    ball_ball: int = integer(0, "elastic contacts between balls", constant=True)
    ball_cage: int = integer(0, "elastic contacts of balls with the cage", constant=True)
    ball_outer: int = integer(0, "elastic contacts of balls with the outer ring", constant=True)
    ball_inner: int = integer(0, "elastic contacts of balls with the inner ring", constant=True)
    rings: int = integer(0, "elastic contacts of both rings through a ball", constant=True)


@dataclass(frozen=True)
class BallContacts:
    """Contacts of the balls with one kind of partner: a race, each other, the cage."""

    force: float = real(0.0, "N", "largest normal force now", local=True)
    indentation: float = real(0.0, "m", "largest indentation now", local=True)
    peak_force: float = real(0.0, "N", "largest normal force since the start", local=True)
    peak_indentation: float = real(0.0, "m", "largest indentation since the start", local=True)


@kernel
def largest(force, indentation, count, rows):
    """`Largest` (N on one of those side by side, m) of the contacts of `count` balls in `rows`.

    force, indentation: of each ball, or of those side by side (N, m).
    """
    most, depth, loaded, deepest = 0.0, 0.0, 0, 0
    for b in range(count):
        if force[b] > most:
            most, loaded = force[b], b
        if indentation[b] > depth:
            depth, deepest = indentation[b], b
    return Largest(most / rows, depth, loaded, deepest)


@kernel
def watch_balls(time, now, m):
    """Keep the peaks of the balls' forces (N) and of the rings' approach (m), after a micro-step.

    now: `Largest`, at `time` (s).
    """
    force = watch_peaks(time, now, m.o.balls, m.s.ball_peaks)
    if force > m.o.balls.first_impact_force and m.o.contact.first_time >= 0.0 and m.s.contact.over == 0.0:
        m.o.balls.first_impact_force = force


@dataclass(frozen=True)
class RaceStiffness:
    """Contact stiffness that follows from the geometry (2.43-2.46)."""

    inner: float = real(0.0, "N/m^n", "ball on inner race, n = 1.5", constant=True)
    outer: float = real(0.0, "N/m^n", "ball on outer race, n = 1.5", constant=True)
    series: float = real(0.0, "N/m^n", "inner to outer ring through a ball, n = 1.5", constant=True)
