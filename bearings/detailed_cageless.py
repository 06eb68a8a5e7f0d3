"""Detailed touchdown bearing without a cage: every ball a body (Halminen (2016), 2.2, 2.3 and 4.3).

Inner ring and balls have three coordinates each, the outer ring has the housing's two, its rotation is
fixed: with 17 balls 57 coordinates and one constraint. Contacts: journal and ring, ball and inner race,
ball and outer race, each ball and the next.

The rotation of the outer ring is eliminated; `bearings.rolling.augmented` holds it by a Lagrange
multiplier instead (2.18-2.28), as a check. Balls are counted around the bearing and do not pass each other.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from ..modelkit.integrators import dopri
from ..modelkit.kernel import kernel
from ..modelkit.model import Model, constants
from ..modelkit.numerics import blank, missing
from ..modelkit.ports import Load
from ..modelkit.variables import group, real
from . import seat
from .contact import friction
from .contact.friction import FrictionLaw
from .contact.laws import ContactLaw, broadcast_law, damp
from .contact.line import BoreContact
from .contact.pair import OUTSIDE, ContactPlace
from .rolling import bodies, gaps, ring
from .rolling.ball_bodies import (
    X,
    Y,
    ball_motion,
    bodies_kicked,
    drift,
    fastest_ball,
    fill_body_accounts,
    follow_gaps,
    lay_out_balls,
    press_races,
    push_ball,
    rub_ball_races,
    set_weights,
)
from .rolling.ball_contacts import (
    Chain,
    after,
    ball_heat,
    link,
    part_ways,
    press_of,
    rub_sides,
    set_normal_forces,
    stored_energy,
)
from .rolling.ball_set import BallContacts, FreeBallSet, ball_mass, spread_of
from .rolling.bodies import BallBodiesDerived, BallBodiesMemory, BallBodiesOutputs, BallBodiesParameters
from .rolling.declarations import starts_from, state_constants
from .rolling.micro_step import BENDING_RESOLUTION, fastest_bending, leapfrog, record_work
from .rolling.ring import MAX_STATES, part


@dataclass(frozen=True)
class Parameters(BallBodiesParameters):
    """Defaults: Koyo 6904 under the disk of section 4.3, pitch diameter corrected to 28.5 mm."""

    contact: BoreContact = group(BoreContact, damping=1e7)
    balls: FreeBallSet = group(FreeBallSet)
    ring: ring.Ring = group(ring.Ring, mass=0.0095, inertia=1.08e-6)
    ball_contact: ContactLaw = group(ContactLaw, stiffness=1e8)
    ball_friction: FrictionLaw = group(FrictionLaw, static=0.03, dynamic=0.02)


@dataclass(frozen=True)
class _Speeds(ring.RaceSpeeds):
    """Circumferential speeds that agree where nothing slips (Halminen (2016), 4.2, Fig 25)."""

    orbit: float = real(0.0, "m/s", "mean speed of the balls along the pitch circle", local=True)
    ball: float = real(0.0, "m/s", "mean circumferential speed of the balls by their spin", local=True)


@dataclass(frozen=True)
class Outputs(BallBodiesOutputs):
    """Loads, and what to know of the inside."""

    neighbours: BallContacts = group(BallContacts)
    speed: _Speeds = group(_Speeds)


@dataclass(frozen=True)
class Derived(BallBodiesDerived):
    """Constants that follow from the parameters."""

    ball_contact: ContactLaw = group(ContactLaw)
    ball_friction: FrictionLaw = group(FrictionLaw)


@dataclass(frozen=True)
class Hidden(BallBodiesMemory):
    """Memory between evaluations and steps."""

    chain: Chain = group(Chain)


MEMORY = seat.bearing_memory(Parameters, Outputs, MAX_STATES, derived=Derived, hidden=Hidden)
SCRATCH = dopri.scratch_layout(MAX_STATES + seat.MODES_SIZE)
STATIC = Parameters().ball_friction.static
CONSTANTS, PROBLEMS = constants(MEMORY, bodies.bodies_problems("ball_friction"))


@kernel
def _neighbour_contacts(q, m):
    """Each ball in q against the next; adds to the balls' accelerations."""
    d, s, count = m.d, m.s, m.p.balls.count
    _find_neighbours(q, m)
    set_normal_forces(s.side, s.chain, count)
    rub_sides(s.side, count, d.ball_friction, s.lines)
    for b in range(count):
        if s.side.indentation[b] > 0.0:
            c = press_of(s.side, b, OUTSIDE, d.ball_contact)
            push_ball(after(b, count), c.fx, c.fy, c.first_moment, m)
            push_ball(b, -c.fx, -c.fy, c.second_moment, m)


@kernel
def _find_neighbours(q, m):
    """Balls in q that touch the next one, and what their forces depend on (`sides.chain`)."""
    d, before, count, apart = m.d, m.s.before, m.p.balls.count, 2.0 * m.d.ball_radius
    x, y = part(q, X, m), part(q, Y, m)
    m.s.side.touching = 0
    for b in range(count):
        k = after(b, count)
        ex, ey = x[k] - x[b], y[k] - y[b]
        square = ex * ex + ey * ey
        if square >= apart * apart:
            part_ways(m.s.side, b)
            continue
        distance = math.sqrt(square)
        half = 0.5 * distance
        place = ContactPlace(ex / distance, ey / distance, apart - distance, -half, half, 0.0)
        rates = ball_motion(before, k, m), ball_motion(before, b, m)
        answers = 2.0 / d.mass + 2.0 * half * half / d.inertia, 1.0 / d.mass
        link(b, count, ball_motion(q, k, m), ball_motion(q, b, m), rates, place, d.ball_contact, answers, m)


@kernel
def _rubbing(dq, m):
    """Heat (W) between neighbours over the kick whose accelerations are in dq."""
    loss, count = 0.0, m.p.balls.count
    for b in range(count):
        if m.s.side.indentation[b] > 0.0:
            k = after(b, count)
            this, following = ball_motion(dq, b, m), ball_motion(dq, k, m)
            loss += ball_heat(m.s.side, b, m.s.kick, following, this, OUTSIDE)
    return loss


@kernel
def react(t, q, dq, m):
    """Derivative dq of ring and balls in q, and the `Load` (N, N m) on journal and housing."""
    press_races(q, m)
    _neighbour_contacts(q, m)
    j, inner, outer = rub_ball_races(q, dq, m)
    ring.accelerate(q, dq, m, j, inner)
    among = _rubbing(dq, m)
    dq[ring.LOSS] = j.loss + inner.loss + outer.loss + among
    ring.share_heat(dq, j, inner.loss, outer.loss, among, m)
    return Load(j.fx, j.fy, j.journal_moment, outer.fx, outer.fy)


@kernel
def rhs(t, q, dq, m):
    """Derivative dq (m.n,) of everything the bearing integrates, t (s) into the macro step."""
    load = react(t, q, dq, m)
    seat.copy_rates(t, q, dq, m, m.half, load)
    record_work(dq, load, m)


@kernel
def observe(t, q, m):
    """Peaks and events, after each accepted micro-step, t (s) into the macro step."""
    ring.watch_bore(t, q, m)
    bodies.watch_bearing(m.time + t, m, m.o.neighbours)


@kernel
def report(q, m):
    """Outputs wanted once per macro step, from the state q (m.n,)."""
    p, o, count = m.p, m.o, m.p.balls.count
    ring.report(q, m, m.d.inner_radius)
    gaps.report(m)
    kinetic, potential = bodies.report(q, m, neighbours=True)
    bodies.state_contacts(o.neighbours, m.s.side, m)
    in_sides = stored_energy(m.s.side, m.d.ball_contact, count)
    ring.report_energy(q, m, kinetic, potential + in_sides, p.ring.inertia)


@kernel
def derive(words):
    """Stiffness and masses from geometry, where all starts, error weights; returns a problem, or 0."""
    m = words.view(MEMORY)[0]
    p, d, size, count = m.p, m.d, m.d.size, m.p.balls.count
    blank(words, CONSTANTS)
    problem = bodies.bodies_problem(p, p.balls.crowded, p.ball_friction, STATIC, m.message_numbers)
    if problem != 0:
        return problem
    d.ball_contact, d.ball_friction = p.ball_contact, p.ball_friction
    broadcast_law(d.ball_contact, p.balls.rows)
    mass = ball_mass(p.balls)
    damp(d.ball_contact, mass)
    friction.derive(d.ball_friction)
    bodies.derive(m, spread_of(p.balls), d.ball_contact, 0.5 * mass, math.inf)
    size.coordinates, size.constraints = 6 + 3 * count, 1
    size.ball_ball, size.ball_outer, size.ball_inner = count, count, count
    set_weights(m)
    ring.append_bending(fastest_bending(m.p.micro_step, BENDING_RESOLUTION), m)
    return missing(words, CONSTANTS)


@kernel
def start(words):
    """Ring and balls at rest, the first ball at its angle; words: the memory, in 8-byte words."""
    m = words.view(MEMORY)[0]
    seat.take_inputs(m.q, m)
    gaps.start_gaps(m)
    ring.place_ring(m.q, m.d.rest_x, m.d.rest_y)
    lay_out_balls(m.q, m)
    state_constants(m)
    m.s.kick = m.s.drift = m.s.lately = 0.0
    seat.begin(seat.PLANAR, react, report, m)
    fill_body_accounts(m, m.d.ball_contact)
    bodies.watch_bearing(m.time, m, m.o.neighbours)
    m.s.kick = m.s.drift = 0.5 * m.d.micro_step


@kernel
def integrate(m, work, span):
    """Advance m.q by `span` (s); work: (8, m.n) or wider. As `seat.integrate`."""
    if m.d.micro_step > 0.0:
        return leapfrog(rhs, drift, fastest_ball, bodies_kicked, observe, m, work, span)
    return seat.integrate(seat.PLANAR, rhs, observe, m, work, span)


@kernel
def instant(t, q, dq, words):
    """Derivative dq (m.n,) and load in m.o (N, N m) under the motion m.u, friction as it stands."""
    m = words.view(MEMORY)[0]
    m.s.kick = m.s.drift = 0.0
    seat.instant(seat.PLANAR, react, t, q, dq, m)


@kernel
def advance(words, work, time, step):
    """One macro step of `step` (s) from `time` (s); returns a status."""
    rows = work.ravel().view(SCRATCH)[0].rows
    m = words.view(MEMORY)[0]
    status = seat.advance(seat.PLANAR, follow_gaps, react, integrate, report, words, m, rows, time, step)
    return gaps.status_when_warm(status, m)


@kernel
def _advance_as_built(words, work, time, step):
    """The same where play and clearance stay as they are (`gaps.EFFECTS`)."""
    rows = work.ravel().view(SCRATCH)[0].rows
    m = words.view(MEMORY)[0]
    return seat.advance(seat.PLANAR, seat.any_time, react, integrate, report, words, m, rows, time, step)


MODEL = Model(
    name="detailed_cageless",
    title="Detailed cageless touchdown bearing",
    about="Full-complement ball bearing with every ball a body of its own",
    parameters=Parameters,
    inputs=seat.BearingInputs,
    outputs=Outputs,
    derived=Derived,
    hidden=Hidden,
    memory=MEMORY,
    derive=derive,
    start=start,
    advance=advance,
    effects=gaps.EFFECTS,
    advance_without=_advance_as_built,
    problems=PROBLEMS,
    instant=instant,
    starts_from=starts_from("coordinates", "ball_ball", "ball_outer", "ball_inner"),
)
