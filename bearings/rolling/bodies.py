"""Declarations that the detailed bearings share: parameters, outputs, memory of balls and cage.

Outputs are peaks, taken after each micro-step, and forces and motion after each macro step. Of balls side
by side the forces are those of one.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from ...modelkit.kernel import kernel
from ...modelkit.numerics import squared
from ...modelkit.variables import array, group, groups, integer, real
from .. import seat
from ..contact import friction, profile
from ..contact.friction import FrictionLaw
from ..contact.laws import ContactLaw
from ..contact.peaks import Largest, PeakMemory, watch_peaks
from ..contact.profile import RaceProfile, SearchReport
from . import bending, declarations
from .ball_bodies import Contacts, ball_motion
from .ball_contacts import SideContacts, highest, stored_energy
from .ball_set import (
    MAX_BALLS,
    BallContacts,
    ball_mass,
    inner_radius,
    outer_radius,
    set_race_law,
    solid_ball_inertia,
)
from .balls import largest_contact, place_balls, watch_balls
from .declarations import RollingDerived, RollingMemory, RollingOutputs, RollingParameters
from .friction import FrictionLines
from .micro_step import MICRO_STEP, RESOLUTION, KickMemory, refined, step_in_hit


@dataclass(frozen=True)
class BallBodiesParameters(RollingParameters):
    """Parameters that both detailed models share."""

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
class _BallReport:
    """One ball."""

    x: float = real(0.0, "m", "horizontal position", local=True)
    y: float = real(0.0, "m", "vertical position", local=True)
    spin: float = real(0.0, "rad/s", "spin speed", local=True)
    inner: float = real(0.0, "N", "normal force of the inner race", local=True)
    outer: float = real(0.0, "N", "normal force of the outer race", local=True)
    side: float = real(0.0, "N", "normal force of the cage, or of the next ball", local=True)


@dataclass(frozen=True)
class BallBodiesOutputs(RollingOutputs):
    """Outputs that both detailed models share."""

    inner: BallContacts = group(BallContacts)
    outer: BallContacts = group(BallContacts)
    hardest: HardestHit = group(HardestHit)
    ball: tuple = groups(_BallReport, MAX_BALLS)


@dataclass(frozen=True)
class BallBodiesDerived(RollingDerived):
    """Constants that follow from the parameters."""

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
    x: tuple = array(MAX_BALLS)  # where the balls start, from the middle
    y: tuple = array(MAX_BALLS)


@dataclass(frozen=True)
class BallRates:
    """Accelerations of all balls, on their way through an evaluation."""

    x: tuple = array(MAX_BALLS)  # m/s2
    y: tuple = array(MAX_BALLS)
    spin: tuple = array(MAX_BALLS)  # rad/s2


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
    cross: tuple = array(MAX_BALLS)  # of the directions along both races at a ball
    outer_spin: float = real(0.0, "rad/s", "of the outer ring, where its rotation is not eliminated")
    outer_moment: float = real(0.0, "N.m", "of the balls on the outer ring, about its centre")
    inner_starts: tuple = array(2 * MAX_BALLS)
    outer_starts: tuple = array(2 * MAX_BALLS)
    search: SearchReport = group(SearchReport)


STATIC = BallBodiesParameters().race_friction.static
RACES = declarations.OWN + 4  # problems ahead of those of the races' profiles


def bodies_problems(side: str) -> tuple[str, ...]:
    """Faults that `bodies_problem` may find; side: name of the friction law at the balls' sides."""
    profiles = (*profile.profile_problems("inner_profile"), *profile.profile_problems("outer_profile"))
    return (*declarations.rolling_problems("race_friction", side), *profiles)


@kernel
def bodies_problem(p, crowded, side, usual, numbers):
    """The number of a fault in the parameters p of journal, balls and races, or 0.

    crowded: 1 where more balls are admitted than fit; side: friction law of the balls' contacts with each
    other or the cage, a record, and `usual`, its static coefficient by default; numbers: of the message.
    """
    b = p.balls
    found = declarations.rolling_problem(p, crowded, numbers)
    found = declarations.law_problem(found, p.race_friction, STATIC, declarations.OWN, numbers)
    found = declarations.law_problem(found, side, usual, declarations.OWN + 2, numbers)
    if found == 0:
        inner = inner_radius(b) - 0.5 * b.play
        found = profile.profile_problem(p.inner_profile, inner, 0.5 * b.diameter, -1.0, numbers)
        found = RACES + found if found != 0 else 0
    if found == 0:
        outer = outer_radius(b) + 0.5 * b.play
        found = profile.profile_problem(p.outer_profile, outer, 0.5 * b.diameter, 1.0, numbers)
        found = RACES + 3 + found if found != 0 else 0
    return found


@kernel
def derive(m, spread, side, lighter, reach):
    """Set in m.d what both detailed models share, but for the size; spread: as in `ball_set.spread_of`.

    side, lighter: law, a record, and mass (kg) of the balls' contacts with each other or the cage;
    reach: as for `place_balls` (m).
    """
    p, d, b = m.p, m.d, m.p.balls
    declarations.derive(m, spread)
    d.mass, d.ball_radius = ball_mass(b), 0.5 * b.diameter
    d.inertia = solid_ball_inertia(d.mass, b.diameter)
    d.inner_radius, d.outer_radius = inner_radius(b) - 0.5 * b.play, outer_radius(b) + 0.5 * b.play
    set_race_law(d.inner, b, d.stiffness.inner, d.mass, 1.0)
    set_race_law(d.outer, b, d.stiffness.outer, d.mass, 1.0)
    d.race_friction = p.race_friction
    friction.derive(d.race_friction)
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


@kernel
def watch_bearing(time, m, sides):
    """Peaks (N, m), after the micro-step to `time` (s).

    sides: report of the balls' contacts with the cage or with each other.
    """
    s, o, count, rows = m.s, m.o, m.p.balls.count, m.p.balls.rows
    inner = largest_contact(s.inner.normal, s.inner.indentation, count, rows)
    outer = largest_contact(s.outer.normal, s.outer.indentation, count, rows)
    watch_peaks(time, inner, o.inner, s.inner_peaks)
    watch_peaks(time, outer, o.outer, s.outer_peaks)
    watch_peaks(time, highest(s.side, count, rows), sides, s.side_peaks)
    force, contact = inner.force, inner.loaded
    if outer.force > force:
        force, contact = outer.force, outer.loaded + count
    depth, deepest = deepest_approach(m)
    before = o.balls.peak_force
    watch_balls(time, Largest(force, depth, contact, deepest), m)
    if o.balls.peak_force > before:
        o.hardest.ball = contact % count + 1


@kernel
def deepest_approach(m):
    """Largest approach of the rings at a ball that both press (m), and which ball that is."""
    most, ball = 0.0, 0
    for b in range(m.p.balls.count):
        inner, outer = m.s.inner.indentation[b], m.s.outer.indentation[b]
        if inner > 0.0 and outer > 0.0 and inner + outer > most:
            most, ball = inner + outer, b
    return most, ball


@kernel
def state_contacts(report, contacts, m):
    """Largest force (N) and indentation (m) of all balls' `contacts` now, in `report` (BallContacts)."""
    largest = largest_contact(contacts.normal, contacts.indentation, m.p.balls.count, m.p.balls.rows)
    report.force, report.indentation = largest.force, largest.indentation


@kernel
def report(q, m, neighbours):
    """Outputs of the balls at the end of the macro step, from the state q.

    `neighbours`: side contacts lie between a ball and the next one, not between a ball and the cage.
    Returns (kinetic energy, energy of the race contacts, of the balls' weight and of bending) in J.
    """
    p, d, o, s = m.p, m.d, m.o, m.s
    count = p.balls.count
    state_contacts(o.inner, s.inner, m)
    state_contacts(o.outer, s.outer, m)
    o.balls.force = max(o.inner.force, o.outer.force)
    o.balls.indentation, _ = deepest_approach(m)
    kinetic, elastic = bending.bending_energy(q, d.bending)
    o.ring.ovality = bending.ovality(q, d.bending)
    height, orbit, spin, loaded = 0.0, 0.0, 0.0, 0
    for b in range(count):
        body = ball_motion(q, b, m)
        dx, dy = body.x - q[seat.HX], body.y - q[seat.HY]
        kinetic += 0.5 * d.mass * (squared(body.vx) + squared(body.vy)) + 0.5 * d.inertia * squared(
            body.spin
        )
        height += body.y
        across = dx * (body.vy - q[seat.HVY]) - dy * (body.vx - q[seat.HVX])
        orbit += across / math.sqrt(dx * dx + dy * dy)
        spin += abs(body.spin)
        if s.inner.normal[b] > 0.0 and s.outer.normal[b] > 0.0:
            loaded += 1
        ball = o.ball[b]
        ball.x, ball.y, ball.spin = body.x, body.y, body.spin
        ball.inner, ball.outer = s.inner.normal[b] / p.balls.rows, s.outer.normal[b] / p.balls.rows
        ball.side = s.side.normal[b] / p.balls.rows
    o.balls.loaded = loaded
    o.speed.orbit = orbit / count
    o.speed.ball = spin / count * d.ball_radius
    if o.hardest.ball > 0:
        _report_hardest(o.hardest.ball - 1, q, m, neighbours)
    potential = (
        d.gravity * d.mass * height
        + stored_energy(s.inner, d.inner, count)
        + stored_energy(s.outer, d.outer, count)
    )
    return kinetic, potential + elastic


@kernel
def _report_hardest(b, q, m, neighbours):
    """Forces (N) and speed (m/s) of ball `b`, which has borne the largest force."""
    h, s, rows = m.o.hardest, m.s, m.p.balls.rows
    h.inner_normal, h.inner_tangential = s.inner.normal[b] / rows, s.inner.tangential[b] / rows
    h.outer_normal, h.outer_tangential = s.outer.normal[b] / rows, s.outer.tangential[b] / rows
    side = b
    before = b - 1 if b > 0 else m.p.balls.count - 1
    if neighbours and s.side.normal[before] > s.side.normal[b]:
        side = before
    h.side_normal, h.side_tangential = s.side.normal[side] / rows, s.side.tangential[side] / rows
    h.speed = abs(ball_motion(q, b, m).spin) * m.d.ball_radius
