"""Declarations that all rolling bearings share: parameters, outputs, memory."""

from __future__ import annotations

from dataclasses import dataclass

from ...modelkit.gravity import INCLINATION, gravity_across
from ...modelkit.kernel import kernel
from ...modelkit.ports import Energy, Interface, PlanarMountReaction, PlanarSeatReaction
from ...modelkit.variables import SWITCH, choice, group, real
from .. import seat
from ..contact import friction
from ..contact import journal as bore
from ..contact.friction import FrictionLaw
from ..contact.journal import RATE_FROM, ContactMemory, ContactReport, Touched, swing_rate
from ..contact.line import BoreContact
from ..contact.materials import elastic_of
from ..contact.peaks import PeakMemory
from ..heat.shares import HeatReport
from ..heat.warm_parts import Surroundings
from . import ball_set, bending, gaps, ring
from .ball_set import BallReport, BallSet, Coordinates, RaceStiffness
from .balls import Springs, resting_place
from .bending import RingBending


@dataclass(frozen=True)
class RollingParameters:
    """The journal in its bore, the balls, the inner ring."""

    clearance: float = real(0.3e-3, "m", "radial clearance of the journal in the bore", above=0.0)
    journal_radius: float = real(9.7e-3, "m", "radius of the journal", above=0.0)
    gravity: float = real(9.81, "m/s2", "gravity, downwards", minimum=0.0)
    interface: Interface = group(Interface)
    contact: BoreContact = group(BoreContact, damping=1e7, length=12e-3, depth=1.635e-3)
    friction: FrictionLaw = group(FrictionLaw)
    balls: BallSet = group(BallSet)
    ring: ring.Ring = group(ring.Ring)
    inclination: float = real(0.0, "rad", INCLINATION)
    thermal: int = choice(
        0, SWITCH, "play and clearance follow the temperatures that the heat of the parts makes"
    )
    heat: Surroundings = group(Surroundings)


STATIC = RollingParameters().friction.static
BALLS = len(ball_set.PROBLEMS)
RING = BALLS + len(bore.PROBLEMS)
OWN = RING + len(bending.PROBLEMS)  # problems of balls and journal; those of a model's other laws follow


def rolling_problems(*frictions: str) -> tuple[str, ...]:
    """Faults that `rolling_problem` may find, and those of friction laws in these groups of parameters."""
    others = (text for name in frictions for text in friction.law_problems(name))
    return (*ball_set.PROBLEMS, *bore.PROBLEMS, *bending.PROBLEMS, *others)


@kernel
def rolling_problem(p, crowded, numbers):
    """The number of a fault in the parameters p that all rolling bearings share, or 0.

    crowded: 1 where more balls are admitted than fit; numbers: of the message.
    """
    found = ball_set.ball_set_problem(p.balls, crowded, numbers)
    if found == 0:
        found = bore.bore_problem(p, STATIC, numbers)
        found = BALLS + found if found != 0 else 0
    if found == 0:
        found = bending.section_problem(p, numbers)
        found = RING + found if found != 0 else 0
    return found


@kernel
def law_problem(found, law, usual, before, numbers):
    """`found`, if that is a problem, else that of a friction law, a record, behind `before` others."""
    if found == 0:
        found = friction.law_problem(law, usual, numbers)
        found = before + found if found != 0 else 0
    return found


@dataclass(frozen=True)
class RollingOutputs:
    """Loads, and what to know of the inside."""

    journal: PlanarSeatReaction = group(PlanarSeatReaction)
    housing: PlanarMountReaction = group(PlanarMountReaction)
    contact: ContactReport = group(ContactReport)
    ring: ring.RingReport = group(ring.RingReport)
    balls: BallReport = group(BallReport)
    energy: Energy = group(Energy)
    heat: HeatReport = group(HeatReport)
    temperature: gaps.Temperatures = group(gaps.Temperatures)
    gaps: gaps.GapReport = group(gaps.GapReport)
    stiffness: RaceStiffness = group(RaceStiffness)
    size: Coordinates = group(Coordinates)


@dataclass(frozen=True)
class RollingDerived:
    """Constants that follow from the parameters."""

    contact: BoreContact = group(BoreContact)
    friction: FrictionLaw = group(FrictionLaw)
    bending: RingBending = group(RingBending)
    stiffness: RaceStiffness = group(RaceStiffness)
    size: Coordinates = group(Coordinates)
    gravity: float = real(0.0, "m/s2", "gravity across the shaft, towards -y")
    inner_radius: float = real(0.0, "m", "inner race")
    rest_x: float = real(0.0, "m", "where the ring rests on the balls, from the middle")
    rest_y: float = real(0.0, "m", "where the ring rests on the balls, from the middle")


@kernel
def state_constants(m):
    """Set the outputs that do not change: the contact's rate (rad/s), stiffness, counts."""
    m.o.contact.rate = swing_rate(m.d.contact, m.u.journal.inv_m)
    stiffness, o = m.d.stiffness, m.o.stiffness
    o.inner, o.outer, o.series = stiffness.inner, stiffness.outer, stiffness.series
    counted, o = m.d.size, m.o.size
    o.coordinates, o.constraints = counted.coordinates, counted.constraints
    o.ball_ball, o.ball_cage = counted.ball_ball, counted.ball_cage
    o.ball_outer, o.ball_inner, o.rings = counted.ball_outer, counted.ball_inner, counted.rings


@kernel
def derive(m, spread):
    """Set in m.d what all rolling bearings share; spread: as in `ball_set.spread_of`."""
    p, d, b = m.p, m.d, m.p.balls
    d.gravity = gravity_across(p.gravity, p.inclination)
    bore.derive(d, p, p.ring.mass)
    ball_set.set_stiffness(d.stiffness, b, elastic_of(p.ring))
    d.inner_radius = ball_set.inner_radius(b)
    springs = Springs(b.count, b.first_angle, spread, b.play, b.rows * d.stiffness.series)
    d.rest_x, d.rest_y = resting_place(springs, p.ring.mass * d.gravity, b.pitch_diameter)


GEOMETRY = (
    *("balls.diameter", "balls.pitch_diameter", "balls.conformity"),
    *("balls.material", "balls.modulus", "balls.poisson", "balls.hertz"),
    *("ring.material", "ring.modulus", "ring.poisson"),
)


def starts_from(*counted: str) -> dict[str, tuple[str, ...]]:
    """Initial dependencies of a rolling bearing's outputs; `counted`: what of `Coordinates` it counts."""
    outer = (*GEOMETRY, "balls.outer_conformity")
    known = {"stiffness.inner": GEOMETRY, "stiffness.outer": outer, "stiffness.series": outer}
    known["contact.rate"] = RATE_FROM
    return known | {f"size.{name}": ("balls.count",) for name in counted}


@dataclass(frozen=True)
class RollingMemory:
    """Memory between evaluations and steps."""

    seat: seat.SeatMemory = group(seat.SeatMemory)
    ring: Touched = group(Touched)
    gaps: gaps.GapMemory = group(gaps.GapMemory)
    contact: ContactMemory = group(ContactMemory)
    ball_peaks: PeakMemory = group(PeakMemory)
