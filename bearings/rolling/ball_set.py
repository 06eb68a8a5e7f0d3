"""The balls of a bearing: what is declared of them, and what follows from geometry and material.

A ball set `b` is a record of `BallSet` or `FreeBallSet`. Balls side by side, in `b.rows`, are one: mass,
inertia and the laws of their contacts are those of all of them, the stiffness of the races is that of a
single ball. `spread` is the spacing of the balls at the start over even spacing.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from ...modelkit.kernel import kernel
from ...modelkit.numerics import squared
from ...modelkit.variables import SWITCH, Choices, choice, integer, real
from ..contact import journal
from ..contact.journal import out_of_proportion
from ..contact.laws import EXACT, broadcast_law, damp, in_series, race_contact_stiffness
from ..contact.materials import MATERIALS, STEEL, density_of, effective_modulus, elastic_of

MAX_BALLS = 32  # room in the state vector
INTEGRALS = Choices("EllipticIntegrals", ("exact", "printed"), ("", "as in Halminen (2016), (2.46)"))


@dataclass(frozen=True)
class BallSet:
    """Balls and races. Defaults: SKF 6004 of Halminen (2016), Table 1.

    Bearings mounted in pairs, or with several rows, are one set of balls: each stands for the `rows` balls
    side by side, with their mass and inertia together and the stiffness of all their contacts. Geometry,
    contact stiffness and forces are stated per ball.
    """

    count: int = integer(9, "number of balls in a row", minimum=3, maximum=MAX_BALLS)
    rows: int = integer(1, "rows of balls side by side that share the load alike", minimum=1, maximum=8)
    diameter: float = real(6.4e-3, "m", "ball diameter", above=0.0)
    pitch_diameter: float = real(31e-3, "m", "pitch diameter", above=0.0)
    play: float = real(
        5e-6,
        "m",
        "radial play between balls and races: half the radial internal clearance of ISO 5753-1, which is "
        "measured on diameter; negative: preload",
    )
    conformity: float = real(
        1.04,
        "1",
        "groove radius over ball radius: twice the conformity r/D, of which 0.52 is 1.04 here",
        above=1.0,
        maximum=2.0,
    )
    outer_conformity: float = real(
        0.0, "1", "the same of the outer race; 0: as of the inner one", minimum=0.0, maximum=2.0
    )
    hertz: int = choice(EXACT, INTEGRALS, "elliptic integrals of the race contacts")
    material: int = choice(
        STEEL, MATERIALS, "material of the balls; ceramic ones in steel rings make a hybrid bearing"
    )
    modulus: float = real(
        0.0, "Pa", "modulus of elasticity of the balls; 0: the material's", minimum=0.0, shown="GPa"
    )
    poisson: float = real(
        0.0, "1", "Poisson's ratio of the balls; 0: the material's", minimum=0.0, maximum=0.5
    )
    density: float = real(0.0, "kg/m3", "density of the balls; 0: the material's", minimum=0.0)
    first_angle: float = real(-math.pi / 2, "rad", "angular position of the first ball at the start")
    damping: float = real(
        0.0,
        "N.s/m2",
        "damping of the race contacts: c times indentation times its rate (2.38)",
        minimum=0.0,
    )
    damping_ratio: float = real(
        0.0, "1", "damping ratio (2.47) of a ball on a race, added to `damping`", minimum=0.0
    )
    dissipation: float = real(
        0.0,
        "s/m",
        "Hunt-Crossley coefficient epsilon (2.12) of a ball on a race, added to `damping`",
        minimum=0.0,
    )
    expected_indentation: float = real(
        3e-6,
        "m",
        "peak elastic approach for which damping ratio and dissipation hold",
        above=0.0,
        needs="damping_ratio or dissipation",
    )


@dataclass(frozen=True)
class FreeBallSet(BallSet):
    """Balls without a cage, which need not be evenly spaced. Defaults: Koyo 6904 of Halminen (2016),
    Table 1, its pitch diameter corrected to 28.5 mm.
    """

    count: int = integer(17, "number of balls", minimum=3, maximum=MAX_BALLS)
    diameter: float = real(4.8e-3, "m", "ball diameter", above=0.0)
    pitch_diameter: float = real(28.5e-3, "m", "pitch diameter", above=0.0)
    play: float = real(
        0.0,
        "m",
        "radial play between balls and races: half the radial internal clearance of ISO 5753-1, which is "
        "measured on diameter; negative: preload",
    )
    bunching: float = real(
        0.0,
        "1",
        "how far the balls start bunched around the first: 0 evenly spaced, 1 touching",
        minimum=0.0,
        maximum=1.0,
    )
    crowded: int = choice(
        0,
        SWITCH,
        "more balls are admitted than fit, evenly pressed into each other at the start, as Table 1 of "
        "Halminen (2016) has them",
    )


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
    """Counts of the model's coordinates and contacts (Halminen (2016), Tables 5 and 6)."""

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


@dataclass(frozen=True)
class RaceStiffness:
    """Contact stiffness that follows from the geometry (2.43-2.46)."""

    inner: float = real(0.0, "N/m^n", "ball on inner race, n = 1.5", constant=True)
    outer: float = real(0.0, "N/m^n", "ball on outer race, n = 1.5", constant=True)
    series: float = real(0.0, "N/m^n", "inner to outer ring through a ball, n = 1.5", constant=True)


EVEN_SPREAD = 1.0  # spread
ROUNDING = 1e-12  # of a full turn of balls


@kernel
def ball_mass(b):
    """Of the balls side by side (kg)."""
    return b.rows * (density_of(b) * math.pi / 6.0 * b.diameter**3.0)


@kernel
def solid_ball_inertia(mass, diameter):
    """Of solid spheres of `mass` (kg) about their centres (kg m2); diameter: m."""
    return 0.4 * mass * squared(0.5 * diameter)


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
def set_stiffness(stiffness, b, rings):
    """Set `stiffness`, a record of `RaceStiffness`: of a ball on either race (2.45), and through both.

    rings: `Elastic`.
    """
    modulus = effective_modulus(elastic_of(b), rings)
    groove = b.outer_conformity if b.outer_conformity != 0.0 else b.conformity
    inner, outer = inner_radius(b), -outer_radius(b)
    stiffness.inner = race_contact_stiffness(b.diameter, inner, b.conformity, modulus, b.hertz)
    stiffness.outer = race_contact_stiffness(b.diameter, outer, groove, modulus, b.hertz)
    stiffness.series = in_series(stiffness.inner, stiffness.outer)


@kernel
def outer_share(stiffness):
    """How much of the rings' approach at a ball is indentation of the outer race; a `RaceStiffness`."""
    inner, outer = stiffness.inner ** (-2.0 / 3.0), stiffness.outer ** (-2.0 / 3.0)
    return outer / (inner + outer)


@kernel
def series_dissipation(stiffness):
    """Dissipation parameter of both contacts of a ball as one, over that of each; a `RaceStiffness`.

    At the same force each loses eps F d_i'^2, and the rings approach at the sum of both rates.
    """
    outer = outer_share(stiffness)
    return outer * outer + (1.0 - outer) * (1.0 - outer)


# Hits on a Hertz contact to one depth lose as much by c d as by eps k d^1.5 where c is this times
# eps k times the root of the depth: the integrals of x^1.5 and of x, times sqrt(1 - x^2.5), from 0 to 1
EQUAL_LOSS = 2.0 / 3.0 * math.gamma(2.3) / (math.gamma(0.8) * math.gamma(1.5))


@kernel
def set_race_law(law, b, stiffness, mass, share):
    """Set `law`, a record, to that of the balls side by side on races, each of `stiffness` (N/m^1.5).

    mass: of the balls side by side (kg); share: of the dissipation parameter, 1 for a contact alone and
    `series_dissipation` for both races as one. Hits are damped in proportion to indentation (2.38); one to
    the expected indentation loses what the dissipation parameter of (2.12) asks for, to first order.
    """
    law.stiffness, law.exponent = stiffness, 1.5
    law.damping, law.dissipation, law.viscous, law.mass = b.damping, 0.0, 0.0, 0.0
    law.damping += EQUAL_LOSS * share * b.dissipation * stiffness * math.sqrt(b.expected_indentation)
    law.damping_ratio, law.expected_indentation = b.damping_ratio, b.expected_indentation
    broadcast_law(law, b.rows)
    damp(law, mass)


PROBLEMS = (
    "balls.diameter = {0:g} m does not fit balls.pitch_diameter = {1:g} m; it must be smaller",
    "balls.count = {0:g} balls of {1:g} m do not fit balls.pitch_diameter = {2:g} m; "
    "it must be at least {3:g} m",
    "balls.outer_conformity = {0:g} must be above 1, or 0 for a groove like the inner race's",
    journal.length_problem("balls.play", "half of balls.diameter"),
    journal.length_problem("balls.expected_indentation", "half of balls.diameter"),
)


@kernel
def ball_set_problem(b, crowded, numbers):
    """Why these balls cannot be put together: its number in `PROBLEMS`, or 0.

    crowded: 1 where more balls are admitted than fit; numbers: of the message.
    """
    found = 0
    if b.diameter >= b.pitch_diameter:
        numbers[0], numbers[1] = b.diameter, b.pitch_diameter
        found = 1
    elif crowded == 0 and b.count * touch_angle(b) > 2.0 * math.pi * (1.0 + ROUNDING):
        numbers[0], numbers[1], numbers[2] = b.count, b.diameter, b.pitch_diameter
        # rounded up, so that the remedy is one
        numbers[3] = math.ceil(1e6 * b.diameter / math.sin(math.pi / b.count)) / 1e6
        found = 2
    elif 0.0 < b.outer_conformity <= 1.0:
        numbers[0] = b.outer_conformity
        found = 3
    elif out_of_proportion(b.play, 0.5 * b.diameter, numbers):
        found = 4
    elif out_of_proportion(b.expected_indentation, 0.5 * b.diameter, numbers):
        found = 5
    return found
