"""What both detailed models declare alike: parameters, outputs, what follows from parameters, memory."""

from __future__ import annotations

from dataclasses import dataclass

from touchdown.bearings.contact import friction, profile
from touchdown.bearings.contact.friction import FrictionLaw
from touchdown.bearings.contact.laws import ContactLaw
from touchdown.bearings.contact.peaks import PeakMemory
from touchdown.bearings.contact.profile import RaceProfile
from touchdown.bearings.contact.search import SearchReport
from touchdown.bearings.rolling import declarations
from touchdown.bearings.rolling.balls import MOST_BALLS, BallContacts
from touchdown.bearings.rolling.balls.geometry import (
    ball_inertia,
    ball_mass,
    inner_radius,
    outer_radius,
    set_race_law,
)
from touchdown.bearings.rolling.balls.rest import place_balls
from touchdown.bearings.rolling.bodies.race import Contacts
from touchdown.bearings.rolling.declarations import (
    RollingDerived,
    RollingMemory,
    RollingOutputs,
    RollingParameters,
)
from touchdown.bearings.rolling.micro_step import (
    MICRO_STEP,
    RESOLUTION,
    KickMemory,
    refined,
    step_in_hit,
)
from touchdown.bearings.rolling.rubbing import FrictionLines
from touchdown.bearings.rolling.sides.contact import SideContacts
from touchdown.modelkit.kernel import kernel
from touchdown.modelkit.variables import array, group, groups, integer, real


@dataclass(frozen=True)
class BallBodiesParameters(RollingParameters):
    """What both detailed models share."""

    micro_step: float = real(
        MICRO_STEP,
        "s",
        "longest step inside, of the velocity Verlet method; shorter ones follow below the default; "
        "0: adaptive Dormand-Prince steps of the "
        "error interface.tolerance",
        minimum=0.0,
        maximum=1e-4,
    )
    race_friction: FrictionLaw = group(FrictionLaw)
    inner_profile: RaceProfile = group(RaceProfile)
    outer_profile: RaceProfile = group(RaceProfile)


@dataclass(frozen=True)
class HardestHit:
    """The ball that has borne the largest force so far."""

    ball: int = integer(0, "which, counted from 1; 0: none yet", local=True)
    inner_normal: float = real(0.0, "N", "normal force of the inner race now", local=True)
    inner_tangential: float = real(0.0, "N", "friction of the inner race now", local=True)
    outer_normal: float = real(0.0, "N", "normal force of the outer race now", local=True)
    outer_tangential: float = real(0.0, "N", "friction of the outer race now", local=True)
    side_normal: float = real(0.0, "N", "normal force of cage or neighbours now", local=True)
    side_tangential: float = real(0.0, "N", "friction of cage or neighbours now", local=True)
    speed: float = real(0.0, "m/s", "circumferential speed by its spin", local=True)


@dataclass(frozen=True)
class Ball:
    """One ball."""

    x: float = real(0.0, "m", "horizontal position", local=True)
    y: float = real(0.0, "m", "vertical position", local=True)
    spin: float = real(0.0, "rad/s", "spin speed", local=True)
    inner: float = real(0.0, "N", "normal force of the inner race", local=True)
    outer: float = real(0.0, "N", "normal force of the outer race", local=True)
    side: float = real(0.0, "N", "normal force of the cage, or of the next ball", local=True)


@dataclass(frozen=True)
class BallBodiesOutputs(RollingOutputs):
    """What both detailed models report."""

    inner: BallContacts = group(BallContacts)
    outer: BallContacts = group(BallContacts)
    hardest: HardestHit = group(HardestHit)
    ball: tuple = groups(Ball, MOST_BALLS)


@dataclass(frozen=True)
class BallBodiesDerived(RollingDerived):
    """What parameters fix."""

    inner: ContactLaw = group(ContactLaw)
    outer: ContactLaw = group(ContactLaw)
    race_friction: FrictionLaw = group(FrictionLaw)
    mass: float = real(0.0, "kg", "of a ball, or of those side by side")
    inertia: float = real(0.0, "kg.m2", "of a ball, or of those side by side")
    ball_radius: float = real(0.0, "m", "of a ball")
    outer_radius: float = real(0.0, "m", "outer race")
    micro_step: float = real(0.0, "s", "longest step inside")
    resolution: float = real(0.0, "rad", "of the fastest contact, longest step inside")
    searched: int = integer(0, "1: contacts with races are searched for")
    cage_answer: float = real(0.0, "1/kg", "answer of the cage to a force in a pocket")
    x: tuple = array(MOST_BALLS)  # where the balls start, from the middle
    y: tuple = array(MOST_BALLS)


@dataclass(frozen=True)
class BallRates:
    """Accelerations of all balls, on their way through an evaluation."""

    x: tuple = array(MOST_BALLS)  # m/s2
    y: tuple = array(MOST_BALLS)
    spin: tuple = array(MOST_BALLS)  # rad/s2


@dataclass(frozen=True)
class BallBodiesMemory(RollingMemory, KickMemory):
    """Memory between evaluations and steps."""

    lines: FrictionLines = group(FrictionLines)
    faster: BallRates = group(BallRates)
    inner: Contacts = group(Contacts)
    outer: Contacts = group(Contacts)
    side: SideContacts = group(SideContacts)
    inner_peaks: PeakMemory = group(PeakMemory)
    outer_peaks: PeakMemory = group(PeakMemory)
    side_peaks: PeakMemory = group(PeakMemory)
    cross: tuple = array(MOST_BALLS)  # of the directions along both races at a ball
    outer_spin: float = real(0.0, "rad/s", "of the outer ring, where its rotation is not eliminated")
    outer_moment: float = real(0.0, "N.m", "of the balls on the outer ring, about its centre")
    inner_starts: tuple = array(2 * MOST_BALLS)
    outer_starts: tuple = array(2 * MOST_BALLS)
    search: SearchReport = group(SearchReport)


STATIC = BallBodiesParameters().race_friction.static
RACES = declarations.OWN + 4  # problems ahead of those of the races' profiles


def problems(side: str) -> tuple[str, ...]:
    """What is found wrong by `problem`; side: name of the friction law at the balls' sides."""
    profiles = (*profile.problems("inner_profile"), *profile.problems("outer_profile"))
    return (*declarations.problems("race_friction", side), *profiles)


@kernel
def problem(p, crowded, side, usual, told):
    """What is wrong between the parameters p of journal, balls and races: its number, or 0.

    crowded: 1 where more balls are admitted than fit; side: friction law of the balls' contacts with each
    other or the cage, a record, and `usual`, its static coefficient by default; told: `Model`'s m.told.
    """
    b = p.balls
    found = declarations.problem(p, crowded, told)
    found = declarations.law_problem(found, p.race_friction, STATIC, declarations.OWN, told)
    found = declarations.law_problem(found, side, usual, declarations.OWN + 2, told)
    if found == 0:
        inner = inner_radius(b) - 0.5 * b.play
        found = profile.problem(p.inner_profile, inner, 0.5 * b.diameter, -1.0, told)
        found = RACES + found if found != 0 else 0
    if found == 0:
        outer = outer_radius(b) + 0.5 * b.play
        found = profile.problem(p.outer_profile, outer, 0.5 * b.diameter, 1.0, told)
        found = RACES + 3 + found if found != 0 else 0
    return found


@kernel
def settle(m, spread, side, lighter, reach):
    """Set in m.d what both detailed models share, but for the size; spread: as in `balls.geometry`.

    side, lighter: law, a record, and mass (kg) of the balls' contacts with each other or the cage;
    reach: as for `place_balls` (m).
    """
    p, d, b = m.p, m.d, m.p.balls
    declarations.settle(m, spread)
    d.mass, d.ball_radius = ball_mass(b.rows, b.diameter, b.density), 0.5 * b.diameter
    d.inertia = ball_inertia(d.mass, b.diameter)
    d.inner_radius, d.outer_radius = inner_radius(b) - 0.5 * b.play, outer_radius(b) + 0.5 * b.play
    set_race_law(d.inner, b, d.stiffness.inner, d.mass)
    set_race_law(d.outer, b, d.stiffness.outer, d.mass)
    d.race_friction = p.race_friction
    friction.settle(d.race_friction)
    d.micro_step = min(
        p.micro_step,
        step_in_hit(p.micro_step, d.contact, p.ring.mass),
        step_in_hit(p.micro_step, d.inner, d.mass),
        step_in_hit(p.micro_step, d.outer, d.mass),
        step_in_hit(p.micro_step, side, lighter),
    )
    d.resolution = refined(p.micro_step) * RESOLUTION
    d.searched = 1 if profile.active(p.inner_profile) or profile.active(p.outer_profile) else 0
    place_balls(d, b, spread, reach)
