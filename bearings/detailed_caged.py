"""Detailed touchdown bearing with a cage: balls and cage as bodies (Halminen (2016), 2.2, 2.3, 4.3).

Inner ring, balls and cage have three coordinates each, the outer ring has the housing's two, its rotation
is fixed: with nine balls 36 coordinates and one constraint. Contacts: journal and ring, ball and inner
race, ball and outer race, ball and cage. The rotation of the outer ring is eliminated; see
`bearings.rolling.augmented` for the form with a Lagrange multiplier.
"""

from __future__ import annotations

from dataclasses import dataclass

from ..modelkit.integrators import dopri
from ..modelkit.kernel import kernel
from ..modelkit.model import Model, constants
from ..modelkit.numerics import blank, missing, squared
from ..modelkit.ports import Load
from ..modelkit.variables import array, group, real
from . import seat
from .contact import friction
from .contact.friction import FrictionLaw
from .contact.laws import ContactLaw, broadcast_law, damp
from .rolling import bodies, cage, gaps, ring
from .rolling.ball_bodies import (
    bodies_kicked,
    drift,
    fastest_ball,
    fill_body_accounts,
    follow_gaps,
    lay_out_balls,
    press_races,
    rub_ball_races,
    set_weights,
)
from .rolling.ball_contacts import stored_energy
from .rolling.ball_set import EVEN_SPREAD, MAX_BALLS, BallContacts, ball_mass
from .rolling.bodies import BallBodiesDerived, BallBodiesMemory, BallBodiesOutputs, BallBodiesParameters
from .rolling.declarations import starts_from, state_constants
from .rolling.micro_step import BENDING_RESOLUTION, fastest_bending, leapfrog, record_work
from .rolling.ring import MAX_STATES


@dataclass(frozen=True)
class Parameters(BallBodiesParameters):
    """Defaults: SKF 6004 under the disk of section 4.3."""

    cage: cage.CageBody = group(cage.CageBody)
    cage_contact: ContactLaw = group(ContactLaw, stiffness=1e8)
    cage_friction: FrictionLaw = group(FrictionLaw, static=0.03, dynamic=0.02)


@dataclass(frozen=True)
class _Speeds(ring.RaceSpeeds):
    """Circumferential speeds that agree where nothing slips (Halminen (2016), 4.2, Fig 26)."""

    cage: float = real(0.0, "m/s", "circumferential speed of the cage on the pitch circle", local=True)
    orbit: float = real(0.0, "m/s", "mean speed of the balls along the pitch circle", local=True)
    ball: float = real(0.0, "m/s", "mean circumferential speed of the balls by their spin", local=True)


@dataclass(frozen=True)
class Outputs(BallBodiesOutputs):
    """Loads, and what to know of the inside."""

    cage: cage.CageReport = group(cage.CageReport)
    pockets: BallContacts = group(BallContacts)
    speed: _Speeds = group(_Speeds)


@dataclass(frozen=True)
class Derived(BallBodiesDerived):
    """Constants that follow from the parameters."""

    cage_contact: ContactLaw = group(ContactLaw)
    cage_friction: FrictionLaw = group(FrictionLaw)
    cage_inertia: float = real(0.0, "kg.m2", "of the cage")
    pocket_x: tuple = array(MAX_BALLS)  # from the cage's centre, at the start
    pocket_y: tuple = array(MAX_BALLS)


@dataclass(frozen=True)
class Hidden(BallBodiesMemory):
    """Memory between evaluations and steps."""


MEMORY = seat.bearing_memory(Parameters, Outputs, MAX_STATES, derived=Derived, hidden=Hidden)
SCRATCH = dopri.scratch_layout(MAX_STATES + seat.MODES_SIZE)
STATIC = Parameters().cage_friction.static
_SHARED = bodies.bodies_problems("cage_friction")
SHARED = len(_SHARED)
CONSTANTS, PROBLEMS = constants(MEMORY, (*_SHARED, *cage.PROBLEMS))


@kernel
def react(t, q, dq, m):
    """Derivative dq of ring, balls and cage in q, and the `Load` (N, N m) on journal and housing."""
    press_races(q, m)
    turned = cage.pocket_contacts(q, dq, m)
    j, inner, outer = rub_ball_races(q, dq, m)
    ring.accelerate(q, dq, m, j, inner)
    among = cage.pockets_heat(dq, turned, m)
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
    bodies.watch_bearing(m.time + t, m, m.o.pockets)


@kernel
def report(q, m):
    """Outputs wanted once per macro step, from the state q (m.n,)."""
    p, o, count = m.p, m.o, m.p.balls.count
    ring.report(q, m, m.d.inner_radius)
    gaps.report(m)
    kinetic, potential = bodies.report(q, m, neighbours=False)
    bodies.state_contacts(o.pockets, m.s.side, m)
    of_cage, weight = cage.report(q, m)
    in_sides = stored_energy(m.s.side, m.d.cage_contact, count)
    ring.report_energy(q, m, kinetic + of_cage, potential + weight + in_sides, p.ring.inertia)


@kernel
def _problem(p, numbers):
    """Number of what is wrong between the parameters p, or 0."""
    found = cage.pocket_problem(p, numbers)
    if found != 0:
        return SHARED + found
    return bodies.bodies_problem(p, 0, p.cage_friction, STATIC, numbers)


@kernel
def _derive_cage(m):
    """Set in m.d the cage, its pockets and the laws in them; returns the lighter mass there (kg)."""
    p, d, b = m.p, m.d, m.p.balls
    radius, lighter = 0.5 * b.pitch_diameter, min(ball_mass(b), p.cage.mass)
    d.cage_contact, d.cage_friction = p.cage_contact, p.cage_friction
    broadcast_law(d.cage_contact, b.rows)
    damp(d.cage_contact, lighter)
    friction.derive(d.cage_friction)
    d.cage_inertia = cage.inertia_of(p, p.cage.mass)
    d.cage_answer = 1.0 / p.cage.mass + squared(radius) / d.cage_inertia
    cage.set_pockets(d, b, radius)
    return lighter


@kernel
def derive(words):
    """Stiffness and masses from geometry, where all starts, error weights; returns a problem, or 0."""
    m = words.view(MEMORY)[0]
    size, count = m.d.size, m.p.balls.count
    blank(words, CONSTANTS)
    problem = _problem(m.p, m.message_numbers)
    if problem != 0:
        return problem
    lighter = _derive_cage(m)
    bodies.derive(m, EVEN_SPREAD, m.d.cage_contact, lighter, m.p.cage.clearance)
    size.coordinates, size.constraints = 9 + 3 * count, 1
    size.ball_cage, size.ball_outer, size.ball_inner = count, count, count
    set_weights(m)
    cage.set_weights(m)
    ring.append_bending(fastest_bending(m.p.micro_step, BENDING_RESOLUTION), m)
    return missing(words, CONSTANTS)


@kernel
def start(words):
    """Ring, balls and cage at rest, the first ball at its angle; words: the memory, in 8-byte words."""
    m = words.view(MEMORY)[0]
    seat.take_inputs(m.q, m)
    gaps.start_gaps(m)
    ring.place_ring(m.q, m.d.rest_x, m.d.rest_y)
    lay_out_balls(m.q, m)
    cage.place_cage(m.q, m)
    state_constants(m)
    m.s.kick = m.s.drift = m.s.lately = 0.0
    seat.begin(seat.PLANAR, react, report, m)
    fill_body_accounts(m, m.d.cage_contact)
    bodies.watch_bearing(m.time, m, m.o.pockets)
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
    name="detailed_caged",
    title="Detailed caged touchdown bearing",
    about="Ball bearing with every ball and the cage a body of its own",
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
    starts_from=starts_from("coordinates", "ball_cage", "ball_outer", "ball_inner"),
)
