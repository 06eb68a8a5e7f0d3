"""Rings that bend."""

from __future__ import annotations

import math

from ..bearings import catalogue
from ..bearings.catalogue.load_sharing import ball_loads, inner_groove
from ..bearings.catalogue.spinning import spun
from ..bearings.rolling.bending import Groove, compliance, frequency, section_of
from .case import Kind, Row, case

MODULUS, POISSON, DENSITY = 207e9, 0.3, 7830.0
WIDTH, HEIGHT = 5e-3, 2e-3  # m
THIN = section_of(Groove(0.099, 0.1, 0.101, WIDTH, 1.0, 0))
ROARK = "W. C. Young, R. G. Budynas, Roark's Formulas for Stress and Strain, Table 9.2, case 1"
ELEMENTS = (
    "2-D finite elements of the rings; the figures were handed down with the plan of this model, "
    "without program and command; `python benchmarks/ring_elements.py`, written apart, finds the same loads"
)


@case(
    "ring-two-loads",
    "two opposite loads on a ring",
    Kind.CLOSED_FORM,
    source=ROARK,
    looked_at=False,
    tolerance=1e-3,
    why="shear and the curvature of the beam add some (h/R)^2, 4e-4; harmonics up to 58 are summed",
)
def two_loads() -> list[Row]:
    """A rectangle of 5 mm by 2 mm at a radius of 0.1 m: how the diameter shrinks under the loads, and grows
    across, in P R^3/(E I)."""
    unit = THIN.radius**3 / (MODULUS * WIDTH * HEIGHT**3 / 12.0)
    given = {n: 4.0 * compliance(THIN, n, MODULUS, POISSON) / unit for n in range(2, 60, 2)}
    across = sum(-((-1.0) ** (n // 2)) * c for n, c in given.items())
    return [
        Row("under the loads", "P R^3/(E I)", math.pi / 4.0 - 2.0 / math.pi, sum(given.values())),
        Row("across", "P R^3/(E I)", 2.0 / math.pi - 0.5, across),
    ]


@case(
    "ring-frequencies",
    "frequencies of a thin ring",
    Kind.CLOSED_FORM,
    source="A. E. H. Love, A Treatise on the Mathematical Theory of Elasticity, section 293",
    looked_at=False,
    tolerance=8e-3,
    why="the formula is for a line; shear and rotary inertia take off some (n h/R)^2, 0.64 % for n = 4",
)
def frequencies() -> list[Row]:
    """In-plane bending of the same ring with 2, 3 and 4 waves around it."""
    inertia, area = WIDTH * HEIGHT**3 / 12.0, WIDTH * HEIGHT
    unit = MODULUS * inertia / (DENSITY * area * THIN.radius**4)
    return [
        Row(
            f"{n} waves",
            "Hz",
            math.sqrt(unit * n**2 * (n**2 - 1) ** 2 / (n**2 + 1)) / (2.0 * math.pi),
            frequency(THIN, n, MODULUS, POISSON, DENSITY) / (2.0 * math.pi),
        )
        for n in (2, 3, 4)
    ]


@case(
    "ring-elements",
    "inner rings of ball bearings, by finite elements",
    Kind.PROGRAM,
    source=ELEMENTS,
    looked_at=False,
    tolerance=0.015,
    why="a curved beam of the section's mean height stands for a ring with a groove",
    afterwards=True,
)
def ring_elements() -> list[Row]:
    """Lowest frequency of the 6904's and 6004's inner rings, and the load of the most loaded ball under
    350 N, 40 harmonics."""
    rows = []
    for name, kilohertz, load in (("6904", 12.88, 133.03), ("6004", 15.24, 222.96)):
        bearing = catalogue.bearing(name)
        section = section_of(inner_groove(bearing))
        found = frequency(section, 2, MODULUS, POISSON, DENSITY) / (2e3 * math.pi)
        rows += [
            Row(f"{name}, lowest frequency", "kHz", kilohertz, found),
            Row(f"{name}, most loaded ball", "N", load, float(ball_loads(bearing, 350.0, 40, 0.0).max())),
        ]
    return rows


@case(
    "ring-growth",
    "growth of a spinning ring",
    Kind.CLOSED_FORM,
    source="S. P. Timoshenko, J. N. Goodier, Theory of Elasticity, the rotating disc with a hole: "
    "rho w^2 r/(4 E) ((3 + nu) s^2 + (1 - nu) r^2), r the edge's radius, s the other's",
    looked_at=False,
    tolerance=1e-9,
    why="the same formula, for the dimensions of the catalogue's entries",
)
def ring_growth() -> list[Row]:
    """Of the 6904's and the 6014's inner rings, bore and race on radius, at 18 000 rpm."""
    rows, speed = [], 18000.0 * math.pi / 30.0
    for name, bore, race in (("6904", 10e-3, 11.85e-3), ("6014", 35e-3, None)):
        bearing = catalogue.bearing(name)
        edge = race or 0.5 * (bearing.balls.pitch_diameter - bearing.balls.diameter)
        found = spun(bearing, speed)
        for what, r, s, ours in (("bore", bore, edge, found.bore), ("race", edge, bore, found.race)):
            grown = (3.0 + POISSON) * s * s + (1.0 - POISSON) * r * r
            exact = DENSITY * speed**2 * r / (4.0 * MODULUS) * grown
            rows.append(Row(f"{name}, {what}", "um", 1e6 * exact, 1e6 * ours))
    return rows
