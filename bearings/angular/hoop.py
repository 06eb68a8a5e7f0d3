"""Rings that balls press together and apart all around: their hoop compliance, and what preload it leaves.

Of a ring of bore a, rim b and width w in plane stress, under a pressure p at its rim or in its bore, that
surface moves by

    rim     p b/E ((b^2 + a^2)/(b^2 - a^2) - nu)         bore     p a/E ((b^2 + a^2)/(b^2 - a^2) + nu)

and the other by p 2 a b/(b^2 - a^2)/E times the pressed one's radius (Lamé; Timoshenko, Strength of
Materials, part II). Balls whose loads outwards add up to P press the inner ring's race by P/(2 pi r w), and
that of the outer ring as much. With c_i and c_o, by which these move for each newton, the race opens by

    u = -(c_i + c_o) P

which is one mode in motion (`rolling.bending`), of the ring's mass; the bore moves with the inner ring.
The outer ring may be held by a stiff seat, c_o = 0, stand loose, or be pressed into a housing that is
itself a ring; the fit's pressure takes its part as long as it lasts.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

from ...modelkit.kernel import kernel
from ...modelkit.numerics import squared
from ...modelkit.variables import SWITCH, Choices, choice, real
from ..contact.materials import Elastic, elastic_of
from ..rolling import bending
from ..rolling.ball_set import inner_radius, outer_radius
from ..rolling.follower import FASTEST_BENDING
from .angular_row import outwards_at_rest
from .inner_ring import SpatialRing

HELD, LOOSE, PRESSED = range(3)
SEATS = Choices(
    "OuterSeat",
    ("held", "loose", "pressed"),
    (
        "in a seat that does not give",
        "in a seat that does not touch it",
        "into a housing that gives with it",
    ),
)
PROBLEM = (
    "ring.hoop = 1 lets a ring give whose bore of {0:g} m reaches its race of {1:g} m (radii); correct "
    "them, or set ring.hoop = 0"
)
HALVINGS = 200  # of the search for what a preload leaves


@dataclass(frozen=True)
class HoopRing(SpatialRing):
    """Inner ring, which tilts, bends, and breathes."""

    damping_ratio: float = real(
        0.0, "1", "damping ratio of each of its modes", minimum=0.0, maximum=1.0, needs="harmonics or hoop"
    )
    hoop: int = choice(0, SWITCH, "both rings give all around under the mean load of the balls")


@dataclass(frozen=True)
class OuterRing:
    """The outer ring and its seat, of the inner one's width and material."""

    seat: int = choice(HELD, SEATS, "how it sits")
    thickness: float = real(
        0.0,
        "m",
        "between race and rim; 0: as of the inner ring between race and bore",
        minimum=0.0,
        needs="seat",
    )
    housing_thickness: float = real(
        0.0, "m", "of the housing; 0: three times the ring's", minimum=0.0, needs="seat == 2"
    )
    housing_modulus: float = real(
        0.0,
        "Pa",
        "modulus of elasticity of the housing; 0: the ring's",
        minimum=0.0,
        shown="GPa",
        needs="seat == 2",
    )


@kernel
def pressed_rim(bore, rim, elastic):
    """By how much (m) the rim of a ring gives under a pressure of 1 Pa on it; bore, rim: radii (m)."""
    inside, outside = bore * bore, rim * rim
    return rim / elastic.modulus * ((outside + inside) / (outside - inside) - elastic.poisson)


@kernel
def pressed_bore(bore, rim, elastic):
    """By how much (m) the bore of a ring gives under a pressure of 1 Pa in it."""
    inside, outside = bore * bore, rim * rim
    return bore / elastic.modulus * ((outside + inside) / (outside - inside) + elastic.poisson)


@kernel
def bore_stress(bore, rim, pressure):
    """Hoop stress (Pa), below 0, at the bore of a ring under a `pressure` (Pa) on its rim; radii in m."""
    return -2.0 * pressure * rim * rim / (rim * rim - bore * bore)


@kernel
def outer_compliance(seat, race, rim, elastic, housing):
    """By how much (m) the race of an outer ring in its `seat` gives under a pressure of 1 Pa on it.

    race, rim: radii (m); housing: (outside radius (m), `Elastic`) of what the ring is pressed into.
    """
    if seat == HELD:
        return 0.0
    alone = pressed_bore(race, rim, elastic)
    if seat == LOOSE:
        return alone
    across = 2.0 * race * rim / (elastic.modulus * (rim * rim - race * race))
    fit = pressed_rim(race, rim, elastic) + pressed_bore(rim, housing[0], housing[1])
    return alone - race * rim * across * across / fit


@kernel
def is_hollow(p, numbers):
    """Whether a ring that is to give has no section between bore and race; numbers: of `PROBLEM`."""
    bore, race = p.journal_radius + p.clearance, inner_radius(p.balls)
    numbers[0], numbers[1] = bore, race
    return p.ring.hoop == 1 and bore >= race


class Hoop(NamedTuple):
    """How rings give under the balls' loads together."""

    race: float  # m/N, by which the race opens for each newton inwards
    bore: float  # of that, by which the bore opens
    outer: float  # of that, by which the outer ring gives


@kernel
def hoop_compliance(p):
    """`Hoop` of a bearing with the parameters p."""
    elastic, outer = elastic_of(p.ring), p.outer_ring
    bore, race, far = p.journal_radius + p.clearance, inner_radius(p.balls), outer_radius(p.balls)
    width = p.ring.width if p.ring.width > 0.0 else p.contact.length
    rim = far + (outer.thickness if outer.thickness > 0.0 else race - bore)
    around = outer.housing_thickness if outer.housing_thickness > 0.0 else 3.0 * (rim - far)
    stiff = outer.housing_modulus if outer.housing_modulus > 0.0 else elastic.modulus
    housing = rim + around, Elastic(stiff, elastic.poisson)
    pressed = pressed_rim(bore, race, elastic)
    inside = pressed / (2.0 * math.pi * race * width)
    outside = outer_compliance(outer.seat, far, rim, elastic, housing) / (2.0 * math.pi * far * width)
    moved = 2.0 * bore * race * race / (elastic.modulus * (race * race - bore * bore))
    both = inside + outside
    return Hoop(both, inside / both * moved / pressed, outside / both)


@kernel
def closed_at_rest(rows, count, compliance):
    """By how much (m) the race closes under the preload of `rows` of `count` balls, the ring in the middle.

    rows: `BallRow`s; compliance: m/N.
    """
    low, high = 0.0, 0.0
    for row in rows:
        high += compliance * count * outwards_at_rest(row, 0.0)
    for _ in range(HALVINGS):
        middle, load = 0.5 * (low + high), 0.0
        for row in rows:
            load += count * outwards_at_rest(row, middle)
        low, high = (middle, high) if compliance * load > middle else (low, middle)
    return low


@kernel
def hoop_of(p):
    """`Hoop` of a bearing whose rings give, or are stiff, as its parameters p say."""
    return hoop_compliance(p) if p.ring.hoop == 1 else Hoop(0.0, 0.0, 0.0)


@kernel
def append_breathing(hoop, m):
    """Have the ring breathe as the last of its modes, where it gives; before the modes are counted."""
    m.d.space.outer_share = hoop.outer
    if hoop.race > 0.0:
        bending.add_breathing(m.d.bending, hoop.race, hoop.bore, m.p.ring.mass, FASTEST_BENDING)


@kernel
def place_breathing(q, m):
    """Set the ring's breathing in the state q to what its preload makes of it, if it breathes."""
    d = m.d.bending
    if d.waves % 2 == 1:
        space, weight = m.d.space, d.weight[d.waves // 2]
        compliance = squared(weight / d.frequency[d.waves // 2])
        rows = space.row[0], space.row[1]
        q[d.first + d.waves - 1] = -closed_at_rest(rows, m.p.balls.count, compliance) / weight
