"""What follows from geometry and material of a ball set, `b`: a record of `BallSet` or `FreeBallSet`.

Balls side by side, in `b.rows`, are one: mass, inertia and the laws of their contacts are those of all of
them, stiffness of races is a ball's. `spread` is the spacing of the balls at the start over even spacing.
"""

from __future__ import annotations

import math

from touchdown.bearings.contact import proportion
from touchdown.bearings.contact.laws import damp, lay_abreast
from touchdown.bearings.contact.proportion import out_of_proportion
from touchdown.bearings.contact.stiffness import in_series, race_contact_stiffness
from touchdown.modelkit.kernel import kernel

EVEN = 1.0  # spread
ROUNDING = 1e-12  # of a full turn of balls


@kernel
def ball_mass(rows, diameter, density):
    """Of the balls side by side (kg); diameter: m, density: kg/m3."""
    return rows * (density * math.pi / 6.0 * diameter**3.0)


@kernel
def ball_inertia(mass, diameter):
    """Of solid spheres of `mass` (kg) about their centres (kg m2); diameter: m."""
    return 0.4 * mass * (0.5 * diameter) ** 2.0


@kernel
def inner_radius(b):
    """Radius of the inner race where the balls run (m)."""
    return 0.5 * b.pitch_diameter - 0.5 * b.diameter


@kernel
def outer_radius(b):
    """Radius of the outer race where the balls run (m)."""
    return 0.5 * b.pitch_diameter + 0.5 * b.diameter


@kernel
def touch_angle(b):
    """Angle at the bearing's centre between neighbours that just touch (rad)."""
    return 2.0 * math.asin(min(1.0, b.diameter / b.pitch_diameter))


@kernel
def spread_of(b):
    """`spread` of a `FreeBallSet`: 1 for even spacing, less for balls bunched around the first."""
    touching = min(1.0, b.count * touch_angle(b) / (2.0 * math.pi))
    return 1.0 + b.bunching * (touching - 1.0)


@kernel
def start_angle(first, count, spread, i):
    """Attitude angle of ball `i` of `count` at the start (rad): less than a turn on from the `first`."""
    angle = first + spread * (2.0 * math.pi / count) * i
    gap = (1.0 - spread) * 2.0 * math.pi  # left open opposite the first ball
    return angle + gap if i > count // 2 else angle


@kernel
def set_stiffness(stiffness, b):
    """Set `stiffness`, a record of `RaceStiffness`: of a ball on either race (2.45), and through both."""
    groove = b.outer_conformity if b.outer_conformity != 0.0 else b.conformity
    inner, outer = inner_radius(b), -outer_radius(b)
    stiffness.inner = race_contact_stiffness(b.diameter, inner, b.conformity, b.modulus, b.poisson, b.hertz)
    stiffness.outer = race_contact_stiffness(b.diameter, outer, groove, b.modulus, b.poisson, b.hertz)
    stiffness.series = in_series(stiffness.inner, stiffness.outer)


@kernel
def outer_share(stiffness):
    """How much of the rings' approach at a ball is indentation of the outer race; a `RaceStiffness`."""
    inner, outer = stiffness.inner ** (-2.0 / 3.0), stiffness.outer ** (-2.0 / 3.0)
    return outer / (inner + outer)


@kernel
def set_race_law(law, b, stiffness, mass):
    """Set `law`, a record, to that of the balls side by side on races, each of `stiffness` (N/m^1.5).

    mass: of the balls side by side (kg).
    """
    law.stiffness, law.exponent = stiffness, 1.5
    law.damping, law.dissipation, law.viscous, law.mass = b.damping, 0.0, 0.0, 0.0
    law.damping_ratio, law.expected_indentation = b.damping_ratio, b.expected_indentation
    lay_abreast(law, b.rows)
    damp(law, mass)


PROBLEMS = (
    "balls.diameter = {0:g} m does not fit balls.pitch_diameter = {1:g} m; it must be smaller",
    "balls.count = {0:g} balls of {1:g} m do not fit balls.pitch_diameter = {2:g} m; "
    "it must be at least {3:g} m",
    "balls.outer_conformity = {0:g} must be above 1, or 0 for a groove like the inner race's",
    proportion.problem("balls.play", "half of balls.diameter"),
    proportion.problem("balls.expected_indentation", "half of balls.diameter"),
)


@kernel
def problem(b, crowded, told):
    """Why these balls cannot be put together: its number in `PROBLEMS`, or 0.

    crowded: 1 where more balls are admitted than fit; told: `Model`'s m.told.
    """
    found = 0
    if b.diameter >= b.pitch_diameter:
        told[0], told[1] = b.diameter, b.pitch_diameter
        found = 1
    elif crowded == 0 and b.count * touch_angle(b) > 2.0 * math.pi * (1.0 + ROUNDING):
        told[0], told[1], told[2] = b.count, b.diameter, b.pitch_diameter
        # rounded up, so that the remedy is one
        told[3] = math.ceil(1e6 * b.diameter / math.sin(math.pi / b.count)) / 1e6
        found = 2
    elif 0.0 < b.outer_conformity <= 1.0:
        told[0] = b.outer_conformity
        found = 3
    elif out_of_proportion(b.play, 0.5 * b.diameter, told):
        found = 4
    elif out_of_proportion(b.expected_indentation, 0.5 * b.diameter, told):
        found = 5
    return found
