"""Balls as bodies: three coordinates each, pressed and rubbed by both races (section 2.2 of the source).

Each ball's state is its centre, velocity, rotation and spin, in the common frame; they lie in the state
vector component by component, so that loops over the balls become vector code. A ball touches the inner
ring from outside and the outer ring, which is fixed in the housing, from inside, each with its own
stiffness (2.45) and with friction (2.39). Races are circles, or curves where a profile says so.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from touchdown.bearings import seat
from touchdown.bearings.contact import profile as race_profile
from touchdown.bearings.contact.friction import FrictionLaw, prepared
from touchdown.bearings.contact.friction import problem as friction_problem
from touchdown.bearings.contact.laws import ContactLaw, damped
from touchdown.bearings.contact.pair import INSIDE, OUTSIDE
from touchdown.bearings.contact.profile import RaceProfile
from touchdown.bearings.contact.search import SearchReport
from touchdown.bearings.rolling import ring
from touchdown.bearings.rolling.balls import MOST_BALLS, BallContacts, watch_balls, watch_contacts
from touchdown.bearings.rolling.race_contacts import (
    LANES,
    Balls,
    Contacts,
    Race,
    find_on_circle,
    find_on_curve,
    press_race,
    rounded,
)
from touchdown.bearings.rolling.resistance import (
    RollingDerived,
    RollingMemory,
    RollingOutputs,
    RollingParameters,
    race_stiffness,
)
from touchdown.modelkit.kernel import kernel
from touchdown.modelkit.ports import Motion
from touchdown.modelkit.variables import array, group, groups, integer, real

BALLS = ring.NEXT  # from here each component of all balls in turn,
X, Y, VX, VY, ANGLE, SPIN = range(6)  # in this order
SIZE = 6
STEPS_A_HIT = 0.2  # of the duration of a hit, at most a step
MOST_STATES = BALLS + SIZE * (MOST_BALLS + 1) + LANES  # with a cage, and room to run past the last ball


@dataclass(frozen=True)
class BallBodiesParameters(RollingParameters):
    """What both detailed models share."""

    micro_step: float = real(
        2e-6,
        "s",
        "longest step inside, of the velocity Verlet method; 0: adaptive Dormand-Prince steps of the "
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
    searched: int = integer(0, "1: contacts with races are searched for")
    bore_grip: float = real(0.0, "1/kg", "answer of the sliding speed to a force: journal on ring")
    race_grip: float = real(0.0, "1/kg", "ball on race, with all that hangs together")
    side_grip: float = real(0.0, "1/kg", "ball on ball, or on the cage")
    cage_grip: float = real(0.0, "1/kg", "answer of the cage to a force in a pocket")
    x: tuple = array(MOST_BALLS)  # where the balls start, from the middle
    y: tuple = array(MOST_BALLS)


@dataclass(frozen=True)
class SideContacts:
    """Contact of each ball with the next, or with the cage, at the last evaluation."""

    normal: tuple = array(MOST_BALLS)
    tangential: tuple = array(MOST_BALLS)
    indentation: tuple = array(MOST_BALLS)
    stiffness: tuple = array(MOST_BALLS)


@dataclass(frozen=True)
class BallBodiesMemory(RollingMemory):
    """Memory between evaluations and steps."""

    inner: Contacts = group(Contacts)
    outer: Contacts = group(Contacts)
    side: SideContacts = group(SideContacts)
    step: float = real(0.0, "s", "length of the micro-step, within which friction may stop; 0: no limit")
    outer_spin: float = real(0.0, "rad/s", "of the outer ring, where its rotation is not eliminated")
    outer_moment: float = real(0.0, "N.m", "of the balls on the outer ring, about its centre")
    inner_starts: tuple = array(2 * MOST_BALLS)
    outer_starts: tuple = array(2 * MOST_BALLS)
    search: SearchReport = group(SearchReport)


@kernel
def part(y, component, m):
    """One component of all balls in the state, or its derivative."""
    count = m.p.balls.count
    return y[BALLS + component * count : BALLS + (component + 1) * count]


@kernel
def ball_motion(y, b, m):
    """Motion of ball `b`."""
    i, n = BALLS + b, m.p.balls.count
    return Motion(y[i + X * n], y[i + Y * n], y[i + VX * n], y[i + VY * n], y[i + SPIN * n])


@kernel
def push(dy, b, fx, fy, moment, m):
    """Add a force (N) and a moment (N m) on ball `b` to its accelerations."""
    i, n = BALLS + b, m.p.balls.count
    dy[i + VX * n] += fx / m.d.mass
    dy[i + VY * n] += fy / m.d.mass
    dy[i + SPIN * n] += moment / m.d.inertia


@kernel
def note(contacts, b, press, indentation, law):
    """Remember the side contact of ball `b`."""
    contacts.normal[b] = press.normal
    contacts.tangential[b] = press.tangential
    contacts.indentation[b] = indentation
    contacts.stiffness[b] = law.exponent * press.normal / indentation


@kernel
def note_apart(contacts, b):
    """Remember that ball `b` has no side contact."""
    contacts.normal[b], contacts.tangential[b] = 0.0, 0.0
    contacts.indentation[b], contacts.stiffness[b] = -1.0, 0.0


@kernel
def _one_race(balls, body, angle, race, profile, starts, contacts, m):
    n = rounded(m.p.balls.count)
    if m.d.searched == 1:
        find_on_curve(balls, body, angle, race, profile, starts, m.s.search, contacts)
    else:
        c = contacts
        places = c.nx[:n], c.ny[:n], c.indentation[:n], c.second[:n], c.across[:n]
        find_on_circle(balls, body, race, *places)
    return press_race(balls, body, race, m.d.race_friction, contacts)


@kernel
def race_contacts(y, dy, m):
    """All balls against both races; sets the balls' derivatives, gravity included.

    Returns the `Total` on the inner and on the outer race.
    """
    p, d, s = m.p, m.d, m.s
    balls = balls_of(y, m)
    grip = s.step * d.race_grip
    at_outer = Race(INSIDE, d.outer_radius, d.outer.stiffness, d.outer.damping, grip)
    at_inner = Race(OUTSIDE, d.inner_radius, d.inner.stiffness, d.inner.damping, grip)
    inner_ring, at = ring.ring_motion(y), seat.housing_motion(y)
    housing = Motion(at.x, at.y, at.vx, at.vy, s.outer_spin)
    outer = _one_race(balls, housing, 0.0, at_outer, p.outer_profile, s.outer_starts, s.outer, m)
    angle = y[ring.RANGLE]
    inner = _one_race(balls, inner_ring, angle, at_inner, p.inner_profile, s.inner_starts, s.inner, m)
    s.outer_moment = outer.moment
    _accelerate(balls, dy, m)
    return inner, outer


@kernel
def _accelerate(balls, dy, m):
    """Derivatives of the balls under what both races do to them, and gravity."""
    d, gravity, inner, outer = m.d, m.p.gravity, m.s.inner, m.s.outer
    dx, dz, turning = part(dy, X, m), part(dy, Y, m), part(dy, ANGLE, m)
    ax, az, alpha = part(dy, VX, m), part(dy, VY, m), part(dy, SPIN, m)
    by_mass, by_inertia = 1.0 / d.mass, d.ball_radius / d.inertia
    for b in range(len(ax)):
        dx[b] = balls.vx[b]
        dz[b] = balls.vy[b]
        turning[b] = balls.spin[b]
        ax[b] = (outer.fx[b] + inner.fx[b]) * by_mass
        az[b] = (outer.fy[b] + inner.fy[b]) * by_mass - gravity
        alpha[b] = (outer.tangential[b] - inner.tangential[b]) * by_inertia


@kernel
def drift(x, y, v, h, m):
    """Positions in x: those in y and h (s) times the velocities in v."""
    seat.drift(x, y, v, h, m)
    ring.drift(x, y, v, h)
    n = m.p.balls.count
    for i in range(BALLS, BALLS + 2 * n):  # x and y of all balls
        x[i] = y[i] + h * v[i + 2 * n]
    for i in range(BALLS + ANGLE * n, BALLS + SPIN * n):
        x[i] = y[i] + h * v[i + n]
    for i in range(BALLS + SIZE * n, m.s.seat.inside, SIZE):  # the cage
        x[i + X] = y[i + X] + h * v[i + VX]
        x[i + Y] = y[i + Y] + h * v[i + VY]
        x[i + ANGLE] = y[i + ANGLE] + h * v[i + SPIN]


@kernel
def forecast(x, dy, h, m):
    """Velocities of the copies at the end of a micro-step of h seconds, which is noted."""
    seat.forecast(x, dy, h)
    m.s.step = h


@kernel
def balls_of(y, m):
    """States of all balls."""
    at, velocity = (part(y, X, m), part(y, Y, m)), (part(y, VX, m), part(y, VY, m))
    return Balls(at[0], at[1], velocity[0], velocity[1], part(y, SPIN, m), m.d.ball_radius)


@kernel
def fastest(m):
    """Largest angular frequency of a body on its contacts, at the last evaluation (rad/s)."""
    d, s = m.d, m.s
    stiffest, below, side, sides = 0.0, 0.0, 0.0, 0.0
    for b in range(m.p.balls.count):
        below += s.inner.stiffness[b]
        stiffest = max(stiffest, s.inner.stiffness[b] + s.outer.stiffness[b])
        side = max(side, s.side.stiffness[b])
        sides += s.side.stiffness[b]
    if s.ring.indentation > 0.0:
        below += m.p.contact.exponent * s.ring.normal / s.ring.indentation
    of_ball, of_ring = (stiffest + 2.0 * side) / d.mass, below / m.p.ring.mass
    return max(math.sqrt(max(of_ball, of_ring, sides * d.cage_grip)), m.s.seat.fastest)


@kernel
def largest(contacts, balls):
    """(Normal force on one of a row, indentation, ball) of the most loaded contact; 0 where none is.

    balls: the record of `BallSet`.
    """
    force, indentation, ball = 0.0, 0.0, 0
    for b in range(balls.count):
        if contacts.normal[b] > force:
            force, ball = contacts.normal[b], b
        indentation = max(indentation, contacts.indentation[b])
    return force / balls.rows, indentation, ball


@kernel
def watch(m, sides):
    """Peaks, after an accepted micro-step; `sides` is the report of the cage's or neighbours' contacts."""
    s, o, balls = m.s, m.o, m.p.balls
    inner, sunk_in, first = largest(s.inner, balls)
    outer, sunk_out, second = largest(s.outer, balls)
    side, overlap, _ = largest(s.side, balls)
    watch_contacts(inner, sunk_in, o.inner)
    watch_contacts(outer, sunk_out, o.outer)
    watch_contacts(side, overlap, sides)
    if max(inner, outer) > o.balls.peak_force:
        o.hardest.ball = (first if inner >= outer else second) + 1
    watch_balls(max(inner, outer), approach(m), m)


@kernel
def approach(m):
    """Largest approach of the rings at a ball that both press (m)."""
    found = 0.0
    for b in range(m.p.balls.count):
        inner, outer = m.s.inner.indentation[b], m.s.outer.indentation[b]
        if inner > 0.0 and outer > 0.0:
            found = max(found, inner + outer)
    return found


@kernel
def state_contacts(report, contacts, balls):
    """The present of a `BallContacts`; balls: the record of `BallSet`."""
    report.force, report.indentation, _ = largest(contacts, balls)


@kernel
def stored(contacts, law, count):
    """Energy of one kind of contact (J)."""
    energy = 0.0
    for b in range(count):
        depth = contacts.indentation[b]
        if depth > 0.0:
            energy += law.stiffness * depth ** (law.exponent + 1.0) / (law.exponent + 1.0)
    return energy


@kernel
def report(y, m, neighbours):
    """Outputs of the balls at the end of the macro step.

    `neighbours`: side contacts lie between a ball and the next one, not between a ball and the cage.
    Returns (kinetic energy, energy of the race contacts and of the balls' weight) in J.
    """
    p, d, o, s = m.p, m.d, m.o, m.s
    count = p.balls.count
    state_contacts(o.inner, s.inner, p.balls)
    state_contacts(o.outer, s.outer, p.balls)
    o.balls.force = max(o.inner.force, o.outer.force)
    o.balls.indentation = approach(m)
    kinetic, height, orbit, spin, loaded = 0.0, 0.0, 0.0, 0.0, 0
    for b in range(count):
        now = ball_motion(y, b, m)
        dx, dy = now.x - y[seat.HX], now.y - y[seat.HY]
        kinetic += 0.5 * d.mass * (now.vx**2 + now.vy**2) + 0.5 * d.inertia * now.spin**2
        height += now.y
        across = dx * (now.vy - y[seat.HVY]) - dy * (now.vx - y[seat.HVX])
        orbit += across / math.sqrt(dx * dx + dy * dy)
        spin += abs(now.spin)
        if s.inner.normal[b] > 0.0 and s.outer.normal[b] > 0.0:
            loaded += 1
        ball = o.ball[b]
        ball.x, ball.y, ball.spin = now.x, now.y, now.spin
        ball.inner, ball.outer = s.inner.normal[b] / p.balls.rows, s.outer.normal[b] / p.balls.rows
        ball.side = s.side.normal[b] / p.balls.rows
    o.balls.loaded = loaded
    o.speed.orbit = orbit / count
    o.speed.ball = spin / count * d.ball_radius
    if o.hardest.ball > 0:
        _report_hardest(o.hardest.ball - 1, y, m, neighbours)
    potential = (
        p.gravity * d.mass * height + stored(s.inner, d.inner, count) + stored(s.outer, d.outer, count)
    )
    return kinetic, potential


@kernel
def _report_hardest(b, y, m, neighbours):
    h, s, rows = m.o.hardest, m.s, m.p.balls.rows
    h.inner_normal, h.inner_tangential = s.inner.normal[b] / rows, s.inner.tangential[b] / rows
    h.outer_normal, h.outer_tangential = s.outer.normal[b] / rows, s.outer.tangential[b] / rows
    side = b
    before = b - 1 if b > 0 else m.p.balls.count - 1
    if neighbours and s.side.normal[before] > s.side.normal[b]:
        side = before
    h.side_normal, h.side_tangential = s.side.normal[side] / rows, s.side.tangential[side] / rows
    h.speed = abs(ball_motion(y, b, m).spin) * m.d.ball_radius


@kernel
def place(y, m):
    """Put the balls at rest where they start."""
    d, n = m.d, m.p.balls.count
    for b in range(n):
        i = BALLS + b
        y[i + X * n], y[i + Y * n] = y[seat.HX] + d.x[b], y[seat.HY] + d.y[b]
        y[i + VX * n], y[i + VY * n] = y[seat.HVX], y[seat.HVY]
        y[i + ANGLE * n], y[i + SPIN * n] = 0.0, 0.0
    m.s.inner_starts[:] = math.nan
    m.s.outer_starts[:] = math.nan


def derived(p: BallBodiesParameters, side: ContactLaw, lighter: float) -> dict[str, object]:
    """Fields of `BallBodiesDerived`, those of `side_grip` and `size` left to the model.

    side, lighter: law and mass (kg) of the balls' contacts with each other or the cage.
    """
    b = p.balls
    inner, outer = b.race_law(b.inner_stiffness()), b.race_law(b.outer_stiffness())
    hit = [(p.contact, p.ring.mass), (inner, b.ball_mass), (outer, b.ball_mass), (side, lighter)]
    rest = b.resting_place(p.ring.mass * p.gravity)
    places = b.starting_places(rest)
    unused = [0.0] * (MOST_BALLS - b.count)
    inner_radius = b.inner_radius - 0.5 * b.play
    ball = 1.0 / b.ball_mass + b.ball_radius**2 / b.ball_inertia
    bore = p.journal_radius + p.clearance
    of_ring = 1.0 / p.ring.mass + inner_radius**2 / p.ring.inertia
    return {
        "contact": damped(p.contact, p.ring.mass),
        "friction": prepared(p.friction),
        "race_friction": prepared(p.race_friction),
        "stiffness": race_stiffness(b),
        "inner": inner,
        "outer": outer,
        "micro_step": resolved_step(p.micro_step, hit),
        "mass": b.ball_mass,
        "inertia": b.ball_inertia,
        "ball_radius": b.ball_radius,
        "inner_radius": inner_radius,
        "outer_radius": b.outer_radius + 0.5 * b.play,
        "searched": int(p.inner_profile.active or p.outer_profile.active),
        "bore_grip": 1.0 / p.ring.mass + bore**2 / p.ring.inertia,
        "race_grip": 2.0 * ball + 0.5 * b.count * of_ring,
        "rest_x": rest[0],
        "rest_y": rest[1],
        "x": tuple([x for x, _ in places] + unused),
        "y": tuple([y for _, y in places] + unused),
    }


def resolved_step(longest: float, contacts: Sequence[tuple[ContactLaw, float]]) -> float:
    """Longest step (s) of the leapfrog method: the one asked for, and short enough for every contact.

    contacts: (law, mass in kg of the lighter body). A body that hits at the landing's speed v must not fly
    past the contact: it gets ((n + 1)/2 m v^2/k)^(1/(n + 1)) deep and stays three times that over v.
    """
    steps = [longest]
    for law, mass in contacts:
        power = 1.0 / (law.exponent + 1.0)
        depth = (0.5 * (law.exponent + 1.0) * mass * seat.VELOCITY_SCALE**2 / law.stiffness) ** power
        steps.append(STEPS_A_HIT * 3.0 * depth / seat.VELOCITY_SCALE)
    return min(steps)


def problem(p: BallBodiesParameters) -> str | None:
    """What is wrong between the parameters of balls and races, or None."""
    b = p.balls
    inner, outer = b.inner_radius - 0.5 * b.play, b.outer_radius + 0.5 * b.play
    found = (
        b.problem(),
        friction_problem(p.friction, "friction"),
        friction_problem(p.race_friction, "race_friction"),
        race_profile.problem("inner_profile", p.inner_profile, inner, b.ball_radius, hollow=False),
        race_profile.problem("outer_profile", p.outer_profile, outer, b.ball_radius, hollow=True),
    )
    return next((text for text in found if text), None)


def ring_weights(p: BallBodiesParameters) -> list[float]:
    """Error weights of the ring's components; its angle matters where its race is no circle."""
    weights = ring.error_weights()
    if p.inner_profile.active:
        weights[ring.RANGLE - ring.RX] = p.balls.inner_radius / seat.POSITION_SCALE
    return weights


def ball_weights(count: int) -> list[float]:
    """Error weights of the balls' components."""
    length, speed, spin = 1.0 / seat.POSITION_SCALE, 1.0 / seat.VELOCITY_SCALE, 1.0 / seat.SPIN_SCALE
    return [w for w in (length, length, speed, speed, 0.0, spin) for _ in range(count)]
