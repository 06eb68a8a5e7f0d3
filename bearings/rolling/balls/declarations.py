"""What is declared of the balls of a bearing: the set, and what is reported of it."""

from __future__ import annotations

import math
from dataclasses import dataclass

from touchdown.bearings.contact.stiffness import EXACT
from touchdown.modelkit.variables import SWITCH, Choices, choice, integer, real

MOST_BALLS = 32  # room in the state vector
INTEGRALS = Choices("EllipticIntegrals", ("exact", "printed"), ("", "as the source prints them (2.46)"))


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
    hertz: int = choice(EXACT, INTEGRALS, "elliptic integrals of the race contacts")
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
    crowded: int = choice(
        0,
        SWITCH,
        "more balls are admitted than fit, evenly pressed into each other at the start, as the source's "
        "Table 1 has them",
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


@dataclass(frozen=True)
class RaceStiffness:
    """Contact stiffness that follows from the geometry (2.43-2.46)."""

    inner: float = real(0.0, "N/m^n", "ball on inner race, n = 1.5", constant=True)
    outer: float = real(0.0, "N/m^n", "ball on outer race, n = 1.5", constant=True)
    series: float = real(0.0, "N/m^n", "inner to outer ring through a ball, n = 1.5", constant=True)
