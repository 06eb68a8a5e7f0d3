"""Parts of a bearing that take up heat, pass it on, and grow with it.

Five bodies, in the order of `network`: the journal, the inner ring, the balls, the outer ring, and the
housing with what is mounted in it. Geometry and masses are the model's; all else is assumed, and no figure
that rests on it is better than that:

- the journal takes up heat over the width of the bearing, through its whole section, and its shaft leads
  heat away over two diameters on either side, beyond which it stays as warm as at the start;
- the outer ring is as thick and as dense as the inner one, whose race and bore are known;
- half of the balls touch either race, in spots whose radius is `SPOT` of a ball's diameter: 2 k a on each
  side of a spot of radius a, the constriction of a half-space;
- the journal touches its bore along a strip whose half-width is `STRIP` of its radius:
  pi k L/(2 ln(2/`STRIP`)), two half-cylinders one after the other;
- the outer ring's fit in its housing passes `FIT`, the housing's surface, that of a cube of steel, passes
  `AIR` to surroundings as warm as the housing at the start; no heat leaves rings and balls by the air
  between them.

`Surroundings` set these paths, and how much warmer shaft and housing are than the bearing at the start.

Thermal constants are rounded and from memory.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import NamedTuple

from ...modelkit.kernel import kernel
from ...modelkit.variables import real
from ..contact.materials import (
    SILICON_NITRIDE,
    SILICON_NITRIDE_DENSITY,
    STEEL,
    STEEL_DENSITY,
)

JOURNAL, INNER, BALLS, OUTER, HOUSING = range(5)
NODES = 5
SPOT, STRIP = 0.03, 0.01
FIT, AIR = 3000.0, 10.0  # W/(m2 K)


class Thermal(NamedTuple):
    """A material as heat meets it."""

    conductivity: float  # W/(m K)
    specific: float  # J/(kg K)
    expansion: float  # 1/K


STEEL_THERMAL = Thermal(46.0, 460.0, 11.5e-6)
SILICON_NITRIDE_THERMAL = Thermal(25.0, 700.0, 3.2e-6)


@dataclass(frozen=True)
class Surroundings:
    """How heat leaves a bearing, and how warm it is around it."""

    shaft_conductance: float = real(
        0.0, "W/K", "of the shaft on both sides of the journal; 0: over two diameters of steel", minimum=0.0
    )
    housing_conductance: float = real(
        0.0, "W/K", "of the fit of the outer ring in its housing; 0: 3000 W/(m2 K)", minimum=0.0
    )
    ambient_conductance: float = real(
        0.0,
        "W/K",
        "from the housing to its surroundings; 0: 10 W/(m2 K) around a cube of steel of its mass",
        minimum=0.0,
    )
    shaft_temperature: float = real(0.0, "K", "of the shaft farther on, above the bearing's at the start")
    housing_temperature: float = real(
        0.0, "K", "of the housing at the start, and of its surroundings, above the bearing's at the start"
    )


class Bodies(NamedTuple):
    """A bearing with balls, its journal and its housing."""

    journal_radius: float  # m
    clearance: float  # m, radial
    width: float  # m
    pitch_diameter: float  # m
    ball_diameter: float  # m
    balls: float  # how many, of all rows
    ball_mass: float  # kg, of all balls together
    ball_material: int  # as `bearings.contact.materials`
    ring_mass: float  # kg, of the inner ring
    ring_material: int
    inv_housing_mass: float  # 1/kg; 0: it does not move, and stays as warm as it is
    shaft: float = 0.0  # W/K, as `Surroundings`
    fit: float = 0.0
    ambient: float = 0.0
    shaft_warmth: float = 0.0  # K above the start
    housing_warmth: float = 0.0


def bodies_by(values: Mapping[str, float]) -> Bodies:
    """From the parameters and inputs of a ball bearing's model by name ("balls.count", ...), SI.

    Raises KeyError for a name that is lacking.
    """
    material = int(values.get("balls.material", STEEL))
    density = values.get("balls.density", 0.0) or (
        SILICON_NITRIDE_DENSITY if material == SILICON_NITRIDE else STEEL_DENSITY
    )
    balls = values["balls.count"] * values.get("balls.rows", 1)
    return Bodies(
        values["journal_radius"],
        values["clearance"],
        values.get("ring.width", 0.0) or values["contact.length"],
        values["balls.pitch_diameter"],
        values["balls.diameter"],
        balls,
        balls * density * math.pi / 6.0 * values["balls.diameter"] ** 3.0,
        material,
        values["ring.mass"],
        int(values.get("ring.material", STEEL)),
        values.get("housing.inv_m", 0.0),
        *(values.get(f"heat.{f.name}", 0.0) for f in fields(Surroundings)),
    )


@kernel
def thermal_of(material):
    """`Thermal` constants of a material, by its number."""
    return SILICON_NITRIDE_THERMAL if material == SILICON_NITRIDE else STEEL_THERMAL


@kernel
def bore_radius(b):
    """Of the inner ring (m)."""
    return b.journal_radius + b.clearance


@kernel
def inner_race(b):
    """Radius of the inner race (m)."""
    return 0.5 * (b.pitch_diameter - b.ball_diameter)


@kernel
def outer_race(b):
    """Radius of the outer race (m)."""
    return 0.5 * (b.pitch_diameter + b.ball_diameter)


@kernel
def thickness(b):
    """Of a ring between race and rim (m); 0 where the bore is wider than the race."""
    return max(inner_race(b) - bore_radius(b), 0.0)


@kernel
def outer_mass(b):
    """Of the outer ring (kg), which has the inner one's section."""
    half = 0.5 * thickness(b)
    return b.ring_mass * (outer_race(b) + half) / (inner_race(b) - half)


@kernel
def set_inverse_capacities(b, inverse):
    """Set `inverse` (5,) to one over the heat capacities of the `Bodies` b (K/J)."""
    rings = thermal_of(b.ring_material).specific
    journal = STEEL_DENSITY * math.pi * b.journal_radius * b.journal_radius * b.width
    inverse[JOURNAL] = 1.0 / (journal * STEEL_THERMAL.specific)
    inverse[INNER] = 1.0 / (b.ring_mass * rings)
    inverse[BALLS] = 1.0 / (b.ball_mass * thermal_of(b.ball_material).specific)
    inverse[OUTER] = 1.0 / (outer_mass(b) * rings)
    inverse[HOUSING] = b.inv_housing_mass / STEEL_THERMAL.specific


@kernel
def _join(matrix, i, j, passes):
    """Add a path between the bodies i and j that `passes` so much (W/K)."""
    matrix[i, i] += passes
    matrix[j, j] += passes
    matrix[i, j] -= passes
    matrix[j, i] -= passes


@kernel
def along_shaft(b):
    """Conductance of the shaft beside the journal (W/K): by rule 2 k A over four radii."""
    return b.shaft if b.shaft > 0.0 else 0.5 * math.pi * STEEL_THERMAL.conductivity * b.journal_radius


@kernel
def to_surroundings(b):
    """Conductance from the housing to its surroundings (W/K); 0 where it keeps its temperature."""
    if b.inv_housing_mass == 0.0 or b.ambient > 0.0:
        return b.ambient
    side = (1.0 / (STEEL_DENSITY * b.inv_housing_mass)) ** (1.0 / 3.0)
    return AIR * 6.0 * side * side


@kernel
def set_surroundings(b, warmth, inflow):
    """Set `warmth` (5,) (K) to that of the start, and `inflow` (5,) (W) to what warm surroundings give."""
    warmth[:] = inflow[:] = 0.0
    warmth[HOUSING] = b.housing_warmth
    inflow[JOURNAL] = along_shaft(b) * b.shaft_warmth
    inflow[HOUSING] = to_surroundings(b) * b.housing_warmth


@kernel
def set_conductances(b, matrix):
    """Set `matrix` (5, 5), by which heat leaves the bodies at their temperatures (W/K)."""
    matrix[:, :] = 0.0
    steel, balls, rings = (
        STEEL_THERMAL.conductivity,
        thermal_of(b.ball_material),
        thermal_of(b.ring_material),
    )
    both = 2.0 * balls.conductivity * rings.conductivity / (balls.conductivity + rings.conductivity)
    races = 0.5 * b.balls * 2.0 * both * SPOT * b.ball_diameter
    _join(matrix, JOURNAL, INNER, math.pi * steel * b.width / (2.0 * math.log(2.0 / STRIP)))
    _join(matrix, INNER, BALLS, races)
    _join(matrix, BALLS, OUTER, races)
    rim = outer_race(b) + thickness(b)
    _join(matrix, OUTER, HOUSING, b.fit if b.fit > 0.0 else FIT * 2.0 * math.pi * rim * b.width)
    matrix[JOURNAL, JOURNAL] += along_shaft(b)
    matrix[HOUSING, HOUSING] += to_surroundings(b)


@kernel
def play_change(b, warmth):
    """By how much the radial play grows (m) at `warmth` (5,), in K above the start.

    Inner ring and balls take from it, the outer ring, which its housing lets grow, gives it back.
    """
    rings = thermal_of(b.ring_material).expansion
    grown = rings * (outer_race(b) * warmth[OUTER] - inner_race(b) * warmth[INNER])
    return grown - ball_growth(b, warmth)


@kernel
def ball_growth(b, warmth):
    """By how much a ball's diameter grows (m) at `warmth` (5,), in K above the start."""
    return thermal_of(b.ball_material).expansion * b.ball_diameter * warmth[BALLS]


@kernel
def strain_along(b, warmth):
    """By how much of its length the inner ring outgrows the outer one, at `warmth` (5,) in K."""
    return thermal_of(b.ring_material).expansion * (warmth[INNER] - warmth[OUTER])


@kernel
def clearance_change(b, warmth):
    """By how much the radial clearance of the journal grows (m) at `warmth` (5,), in K above the start."""
    bore = thermal_of(b.ring_material).expansion * bore_radius(b) * warmth[INNER]
    return bore - STEEL_THERMAL.expansion * b.journal_radius * warmth[JOURNAL]
