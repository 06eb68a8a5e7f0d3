"""What both detailed models declare alike: parameters, outputs, what follows from parameters, memory."""

from __future__ import annotations

from dataclasses import dataclass

from touchdown.bearings.contact import profile as race_profile
from touchdown.bearings.contact.friction import FrictionLaw, prepared
from touchdown.bearings.contact.laws import ContactLaw, damped
from touchdown.bearings.contact.peaks import PeakMemory
from touchdown.bearings.contact.profile import RaceProfile
from touchdown.bearings.contact.search import SearchReport
from touchdown.bearings.rolling.balls import MOST_BALLS, BallContacts
from touchdown.bearings.rolling.bodies.race import Contacts
from touchdown.bearings.rolling.declarations import (
    RollingDerived,
    RollingMemory,
    RollingOutputs,
    RollingParameters,
    race_stiffness,
)
from touchdown.bearings.rolling.declarations import problem as rolling_problem
from touchdown.bearings.rolling.micro_step import MICRO_STEP, KickMemory, step_limits
from touchdown.bearings.rolling.side import SideContacts
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
class BallBodiesMemory(RollingMemory, KickMemory):
    """Memory between evaluations and steps."""

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


def derived(p: BallBodiesParameters, side: ContactLaw, lighter: float) -> dict[str, object]:
    """Fields of `BallBodiesDerived` by name, but for `size` and what the model has of its own.

    side, lighter: law and mass (kg) of the balls' contacts with each other or the cage.
    """
    b = p.balls
    inner, outer = b.race_law(b.inner_stiffness()), b.race_law(b.outer_stiffness())
    hit = [(p.contact, p.ring.mass), (inner, b.ball_mass), (outer, b.ball_mass), (side, lighter)]
    rest = b.resting_place(p.ring.mass * p.gravity)
    places = b.starting_places(rest)
    unused = [0.0] * (MOST_BALLS - b.count)
    inner_radius = b.inner_radius - 0.5 * b.play
    return {
        "contact": damped(p.contact, p.ring.mass),
        "friction": prepared(p.friction),
        "race_friction": prepared(p.race_friction),
        "stiffness": race_stiffness(b),
        "inner": inner,
        "outer": outer,
        **step_limits(p.micro_step, hit),
        "mass": b.ball_mass,
        "inertia": b.ball_inertia,
        "ball_radius": b.ball_radius,
        "inner_radius": inner_radius,
        "outer_radius": b.outer_radius + 0.5 * b.play,
        "searched": int(p.inner_profile.active or p.outer_profile.active),
        "rest_x": rest[0],
        "rest_y": rest[1],
        "x": tuple([x for x, _ in places] + unused),
        "y": tuple([y for _, y in places] + unused),
    }


def problem(p: BallBodiesParameters, side: str) -> str | None:
    """What is wrong between the parameters of journal, balls and races, or None.

    side: name of the friction law of the balls' contacts with each other or the cage.
    """
    b = p.balls
    inner, outer = b.inner_radius - 0.5 * b.play, b.outer_radius + 0.5 * b.play
    problems = (
        rolling_problem(p, "friction", "race_friction", side),
        race_profile.problem("inner_profile", p.inner_profile, inner, b.ball_radius, hollow=False),
        race_profile.problem("outer_profile", p.outer_profile, outer, b.ball_radius, hollow=True),
    )
    return next((text for text in problems if text), None)
