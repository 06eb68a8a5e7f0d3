"""An angular contact bearing at speed: Jones' balls, thrown outwards and turned over, under a thrust.

The models step balls as bodies or leave out their inertia across the orbit; this is the static solution of
the textbooks, to compare both with. With D the ball's diameter, F_c its centrifugal force, and M its
gyroscopic moment, J times orbit and roll times sin b, below 0 as the roll is against the inner ring's
turning:

    Q_o sin a_o - l_o M/D cos a_o = Q_i sin a_i - l_i M/D cos a_i = F_a/Z
    Q_o cos a_o + l_o M/D sin a_o - Q_i cos a_i - l_i M/D sin a_i = F_c

Race control says how a ball turns and which race holds M. Outer: it rolls without spin on the outer race,
tan b = sin a_o/(cos a_o + D/d_m), which holds all of it (l_o = 2, l_i = 0). Inner: it rolls without spin on
the inner race, tan b = sin a_i/(cos a_i - D/d_m), and both hold it alike (1, 1).

Harris, Kotzalas, Rolling Bearing Analysis, 5th ed., volume 2, chapters 2 and 3.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
from scipy.optimize import brentq, root

from ..bearings.angular.angular_row import thrust_angle
from ..bearings.angular.thrown_ball import (
    OrbitingBalls,
    ThrownBall,
    alone_on_outer,
    rolled_orbit,
    thrown_ball,
)
from ..bearings.contact.laws import race_contact_stiffness
from ..bearings.contact.materials import (
    STEEL_DENSITY,
    STEEL_NUMBERS,
    Elastic,
    effective_modulus,
    elastic_of,
)
from ..modelkit.variables import as_record
from .case import Found, Row, curves
from .statics import B218

THRUST = 17.8e3  # N


class _Motion(NamedTuple):
    """A ball under a thrust at speed."""

    inner_angle: float  # rad
    outer_angle: float
    inner_force: float  # N
    outer_force: float
    shift: float  # m, of the inner ring along the shaft
    orbit: float  # rad/s


@dataclass(frozen=True)
class _Control:
    """Which race a ball rolls on without spin, and the parts of its gyroscopic moment that races hold."""

    outer: bool = True
    inner_part: float = 0.0
    outer_part: float = 2.0


OUTER = _Control()
INNER = _Control(outer=False, inner_part=1.0, outer_part=1.0)
NONE = _Control(inner_part=0.0, outer_part=0.0)


def _orbit_and_roll(
    inner: float, outer: float, ratio: float, control: _Control
) -> tuple[float, float, float]:
    """(Orbit and roll of a ball over the inner ring's speed, pitch angle b (rad)); ratio: D/d_m."""
    together = 1.0 + math.cos(inner - outer)
    if control.outer:
        pitch = math.atan2(math.sin(outer), math.cos(outer) + ratio)
        orbit = (1.0 - ratio * math.cos(inner)) / together
    else:
        pitch = math.atan2(math.sin(inner), math.cos(inner) - ratio)
        orbit = (math.cos(inner - outer) - ratio * math.cos(outer)) / together
    t = math.tan(pitch)
    on_outer = (math.cos(outer) + t * math.sin(outer)) / (1.0 + ratio * math.cos(outer))
    on_inner = (math.cos(inner) + t * math.sin(inner)) / (1.0 - ratio * math.cos(inner))
    return orbit, -1.0 / ((on_outer + on_inner) * ratio * math.cos(pitch)), pitch


def at_speed(thrust: float, rpm: float, control: _Control) -> _Motion:
    """A ball of the 218 under a thrust (N). Raises RuntimeError where no balance is found."""
    b, alpha = B218.balls, B218.contact_angle
    (row,) = B218.rows()
    record = as_record(b)
    modulus = effective_modulus(elastic_of(record), STEEL_NUMBERS)
    middle = 0.5 * b.pitch_diameter / math.cos(alpha)
    races = (middle - 0.5 * b.diameter, -middle - 0.5 * b.diameter)
    k_i, k_o = (race_contact_stiffness(b.diameter, r, b.conformity, modulus, b.hertz) for r in races)
    arc = 0.5 * (b.conformity - 1.0) * b.diameter
    mass = STEEL_DENSITY * math.pi / 6.0 * b.diameter**3
    inertia = 0.1 * mass * b.diameter**2
    share, ratio = thrust / b.count, b.diameter / b.pitch_diameter

    def parts(unknowns: np.ndarray, speed: float) -> tuple[list[float], _Motion]:
        along, out, z = unknowns * row.free
        across = (row.inner - row.outer - out, row.inner_at - row.outer_at + z - along)
        length_o, length_i = math.hypot(along, out), math.hypot(*across)
        a_o, a_i = math.atan2(along, out), math.atan2(across[1], across[0])
        q_o, q_i = k_o * max(length_o - arc, 0.0) ** 1.5, k_i * max(length_i - arc, 0.0) ** 1.5
        orbit, roll, pitch = _orbit_and_roll(a_i, a_o, ratio, control)
        moment = inertia * roll * orbit * speed**2 * math.sin(pitch)
        thrown = 0.5 * mass * b.pitch_diameter * (orbit * speed) ** 2
        held_i, held_o = (part * moment / b.diameter for part in (control.inner_part, control.outer_part))
        axial_inner = q_i * math.sin(a_i) - held_i * math.cos(a_i)
        axial_outer = q_o * math.sin(a_o) - held_o * math.cos(a_o)
        outwards = q_o * math.cos(a_o) + held_o * math.sin(a_o)
        inwards = q_i * math.cos(a_i) + held_i * math.sin(a_i)
        off = [axial_inner / share - 1.0, axial_outer / share - 1.0, (outwards - inwards - thrown) / share]
        return off, _Motion(a_i, a_o, q_i, q_o, z, orbit * speed)

    angle = thrust_angle(alpha, share / (row.stiffness * row.free**1.5))
    depth = arc + (share / math.sin(angle) / k_o) ** (2.0 / 3.0)
    lifted = row.free * math.sin(angle - alpha) / math.cos(angle)
    found = np.array([depth * math.sin(angle), depth * math.cos(angle), lifted]) / row.free
    speeds = np.linspace(0.0, rpm * math.pi / 30.0, 11)
    for speed in speeds:  # each from the last
        found = root(lambda unknowns, speed=speed: parts(unknowns, float(speed))[0], found, tol=1e-13).x
    off, motion = parts(found, float(speeds[-1]))
    if max(map(abs, off)) > 1e-9:
        raise RuntimeError(f"no balance at {rpm:g} rpm")
    return motion


def _compared(theirs: dict[float, tuple[float, ...]], control: _Control) -> list[Row]:
    """Rows for contact angles (deg) and loads (N) inside and outside, and the orbit (rad/s), by rpm."""
    rows = []
    for rpm, (inner, outer, q_i, q_o, orbit) in theirs.items():
        found, label = at_speed(THRUST, rpm, control), f"{rpm:g} rpm"
        rows += [
            Row(f"inner contact angle, {label}", "deg", inner, math.degrees(found.inner_angle)),
            Row(f"outer contact angle, {label}", "deg", outer, math.degrees(found.outer_angle)),
            Row(f"load inside, {label}", "N", q_i, found.inner_force),
            Row(f"load outside, {label}", "N", q_o, found.outer_force),
            Row(f"orbit, {label}", "rad/s", orbit, found.orbit),
        ]
    return rows


BY_OUTER = {
    6000.0: (44.72421, 38.01890, 1580.9405, 1738.7768, 275.4880),
    10000.0: (49.97345, 31.28808, 1452.8306, 1923.3129, 476.3905),
    15000.0: (56.79991, 19.16191, 1329.5275, 2721.7382, 791.4300),
}


def speed_218_outer() -> Found:
    """Contact angles, loads and orbit of a ball under 17.8 kN: rolling without spin on the outer race,
    which holds the whole gyroscopic moment."""
    rpm = np.arange(0.0, 15001.0, 1000.0)
    motions = [at_speed(THRUST, float(speed), OUTER) for speed in rpm]
    angles = {
        "inner race": (rpm, np.degrees([motion.inner_angle for motion in motions])),
        "outer race": (rpm, np.degrees([motion.outer_angle for motion in motions])),
    }
    theirs = np.array([(speed, angle) for speed, figures in BY_OUTER.items() for angle in figures[:2]]).T
    picture = curves("speed, rpm", "contact angle, deg", ("OpenJones", (theirs[0], theirs[1])), angles)
    return Found(_compared(BY_OUTER, OUTER), picture)


def speed_218_thrown() -> list[Row]:
    """Only centrifugal force, balls rolling without spin on the outer race: the balls of
    `angular_simplified`."""
    balls, ratio = replace(B218.balls, modulus=206.8e9, density=7800.0), 0.02223 / 0.12526
    (row,) = replace(B218, balls=balls, rings=Elastic(206.8e9, 0.3)).rows()
    mass, speed = 7800.0 * math.pi / 6.0 * balls.diameter**3, 10000.0 * math.pi / 30.0

    found = as_record(OrbitingBalls())

    def balanced(thrown: float) -> ThrownBall:
        def ball(z: float) -> ThrownBall:
            found["u"][0], found["v"][0] = row.inner - row.outer, row.inner_at - row.outer_at + z
            found["missed"][0] = 1.0
            return thrown_ball(row, thrown, alone_on_outer(row, thrown), 0.0, 0, found)

        shift: Any = brentq(
            lambda z: balls.count * ball(z).inner * ball(z).sine - THRUST, -2e-4, 2e-4, xtol=1e-13
        )
        return ball(shift)

    last = balanced(1.0)
    for _ in range(20):  # the orbit goes with the angles
        last = balanced(0.5 * mass * balls.pitch_diameter * (rolled_orbit(last, ratio) * speed) ** 2)
    return [
        Row("inner contact angle", "deg", 47.77, math.degrees(math.asin(last.sine))),
        Row("outer contact angle", "deg", 34.41, math.degrees(math.asin(last.outer_sine))),
    ]


def speed_218_inner() -> list[Row]:
    """Rolling without spin on the inner race, the gyroscopic moment held by both alike; OpenJones' own
    choice of the race is overruled."""
    return _compared(
        {
            6000.0: (43.79319, 39.04200, 1568.1196, 1719.5972, 270.2407),
            10000.0: (47.45557, 34.63300, 1408.1197, 1796.8063, 439.5639),
            15000.0: (52.45779, 27.16105, 1200.9338, 1924.4064, 615.5842),
        },
        INNER,
    )


def speed_218_still() -> list[Row]:
    """Rolling without spin on the outer race, only centrifugal force; OpenJones' gyroscopic moment is 0."""
    return _compared(
        {
            6000.0: (43.83053, 39.05194, 1606.4341, 1765.8041, 274.4157),
            10000.0: (47.78670, 34.38308, 1502.0617, 1969.9914, 467.5317),
            15000.0: (54.14602, 24.88960, 1372.5885, 2643.3269, 751.7002),
        },
        NONE,
    )
