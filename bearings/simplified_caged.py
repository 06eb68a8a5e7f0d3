"""Simplified touchdown bearing with a cage (Halminen (2016), section 2.1, harmonised as in 4.3).

The inner ring has three coordinates; balls and cage follow it without slip (4.2). Where a ball is
pressed between the rings, one spring in series stands for both of its contacts (2.5, 2.6). A
rolling-bearing friction moment (Harris) brakes the ring. The inertia of balls and cage is added to the
ring's (4.3).

Deviations from Halminen (2016), each named where it acts:
- (4.3) prints a minus before the inertia of the balls; kinetic energy is quadratic in their spin, so it
  is a plus.
- A ball carried by the turning ring into the narrowing gap resists with the moment -F (e . t) about the
  bearing's centre. Halminen (2016) leaves it out; without it the model creates energy and angular momentum.
- `slip = 1` (section 5.3) gives cage and balls coordinates of their own, driven by friction at both races
  as in the cageless model; it takes the place of the friction moment.
- Friction moment and gaps act at the ring's actual place, so that action equals reaction.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from ..modelkit.kernel import kernel
from ..modelkit.model import Model, constants
from ..modelkit.numerics import blank, missing, squared
from ..modelkit.ports import Load
from ..modelkit.variables import SWITCH, choice, group
from . import seat
from .contact import friction
from .contact.friction import FrictionLaw
from .contact.laws import elastic_force
from .contact.peaks import Largest
from .rolling import bending, declarations, follower, gaps, ring
from .rolling.balls import Total, watch_balls
from .rolling.declarations import (
    RollingMemory,
    RollingOutputs,
    RollingParameters,
    starts_from,
    state_constants,
)
from .rolling.follower import (
    FASTEST_BENDING,
    FollowerDerived,
    FollowerMemory,
    FollowerParameters,
    FollowerSpeeds,
)
from .rolling.pitch_circle import BallLoads, between_races, forget_loaded, note_ball

CAGE_ANGLE, CAGE_SPEED, BALL_SPIN = range(ring.NEXT, ring.NEXT + 3)  # in use where they may slip
ORBIT_SCALE = 100.0  # rad/s; of the cage


@dataclass(frozen=True)
class Parameters(FollowerParameters, RollingParameters):
    """Defaults: SKF 6004 under the disk of section 4.3."""

    slip: int = choice(
        0, SWITCH, "cage and balls may slip, driven by friction instead of following the ring"
    )
    race_friction: FrictionLaw = group(FrictionLaw, needs="slip")


@dataclass(frozen=True)
class Outputs(RollingOutputs):
    """Loads, and what to know of the inside."""

    speed: FollowerSpeeds = group(FollowerSpeeds)


@dataclass(frozen=True)
class Derived(FollowerDerived):
    """Constants that follow from the parameters."""

    race_friction: FrictionLaw = group(FrictionLaw)


@dataclass(frozen=True)
class Hidden(FollowerMemory, RollingMemory):
    """Memory between evaluations and steps."""


STATES = ring.NEXT + 3 + bending.MAX_STATES
MEMORY = seat.bearing_memory(Parameters, Outputs, STATES, derived=Derived, hidden=Hidden)
STATIC = Parameters().race_friction.static
CONSTANTS, PROBLEMS = constants(MEMORY, declarations.rolling_problems("race_friction"))


@kernel
def _springs(q, gap, cage_angle, m):
    """Balls that follow the ring without slip: `Total` on it (N, W), its moment (N m) that on the cage.

    q: the state; cage_angle: rad.
    """
    law, play, count = m.d.race, m.s.gaps.play, m.p.balls.count
    fx, fy, moment, heat = 0.0, 0.0, 0.0, 0.0
    flexible = m.d.bending.waves > 0
    if not flexible and play >= 0.0 and gap.ex * gap.ex + gap.ey * gap.ey <= play * play:
        return Total(fx, fy, moment, heat)
    ca, sa = math.cos(cage_angle), math.sin(cage_angle)
    for b in range(count):
        c0, s0 = m.d.cosine[b], m.d.sine[b]
        nx, ny = ca * c0 - sa * s0, sa * c0 + ca * s0
        bent = bending.shape_at(q, nx, ny, m.d.bending) if flexible else bending.ROUND
        indentation = gap.ex * nx + gap.ey * ny - play + bent.opening
        if indentation <= 0.0:
            continue
        rate = gap.ux * nx + gap.uy * ny + bent.rate
        elastic = elastic_force(indentation, law)
        force = max(elastic + law.damping * indentation * rate, 0.0)
        fx -= force * nx
        fy -= force * ny
        # the ball moves along t = (-ny, nx) into the narrowing gap, which Halminen (2016) leaves out
        moment -= elastic * (gap.ey * nx - gap.ex * ny + bent.slope)
        heat += (force - elastic) * rate
        if flexible:
            bending.press_modes(-force, nx, ny, m.d.bending, m.s.shape)
        note_ball(m.s.balls, b, BallLoads(force, elastic, indentation, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0))
    return Total(fx, fy, moment, heat)


@kernel
def _rolling(q, gap, m):
    """Ring, cage and balls turn as one (4.2): `Total` (N, N m, W) on the ring in the state q."""
    springs = _springs(q, gap, m.d.cage_ratio * q[ring.RANGLE], m)
    load = math.sqrt(springs.fx * springs.fx + springs.fy * springs.fy)
    return follower.braked(springs, follower.friction_load(load, m.p.balls.rows, m.p), q, m)


@kernel
def _slipping(q, dq, gap, m):
    """Cage and balls turn on their own, driven by friction: `Total` (N, N m, W) on the ring in the state q.

    The cage keeps the balls on their places on the pitch circle; all share one spin. Sets their derivatives
    in dq.
    """
    d, count = m.d, m.p.balls.count
    orbit, spin = q[CAGE_SPEED], q[BALL_SPIN]
    ca, sa = math.cos(q[CAGE_ANGLE]), math.sin(q[CAGE_ANGLE])
    fx, fy, moment, along, turning, heat, outside = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for b in range(count):
        c0, s0 = d.cosine[b], d.sine[b]
        c, s = ca * c0 - sa * s0, sa * c0 + ca * s0
        bent = bending.shape_at(q, c, s, d.bending)
        ball = between_races(gap, c, s, orbit, spin, d.pitch_radius, bent, m)
        if ball.indentation > 0.0:
            bending.press_modes(-ball.force, c, s, d.bending, m.s.shape)
            note_ball(m.s.balls, b, ball)
            fx -= ball.force * c - ball.inner * s
            fy -= ball.force * s + ball.inner * c
            moment -= ball.inner * ball.lever
        along += ball.inner + ball.outer - ball.held - d.gravity * d.mass * c
        turning += ball.outer - ball.inner
        heat += ball.heat
        outside += ball.outside
    m.s.balls.outside = outside
    dq[CAGE_ANGLE] = orbit
    dq[CAGE_SPEED] = d.pitch_radius * along / d.orbiting
    dq[BALL_SPIN] = d.ball_radius * turning / d.spinning
    return Total(fx, fy, moment, heat)


@kernel
def react(t, q, dq, m):
    """Derivative dq of what is inside, in q, and the `Load` (N, N m) on journal and housing."""
    p, inertia = m.p, m.d.ring_inertia
    forget_loaded(m.s.balls)
    flexible, bent = m.d.bending.waves > 0, 0.0
    if flexible:
        m.s.shape.acceleration[:] = 0.0
    j = ring.journal_on_ring(q, m.s.shape, m)
    gap = ring.gap(q)
    balls = _slipping(q, dq, gap, m) if p.slip == 1 else _rolling(q, gap, m)
    fx, fy = balls.fx - p.damping * gap.ux, balls.fy - p.damping * gap.uy
    ring.translate(q, dq, m, j, fx, fy)
    if flexible:
        bent = bending.accelerate_modes(q, 0.0, m.d.bending, m.s.shape)
        bending.hand_over_modes(q, dq, m.d.bending, m.s.shape)
    dq[ring.RW] = balls.moment / inertia + j.ring_moment / inertia
    damped = p.damping * (gap.ux * gap.ux + gap.uy * gap.uy)
    follower.share_follower_heat(dq, j, bent, balls, damped, 0.0, m)
    return Load(j.fx, j.fy, j.journal_moment, -fx, -fy)


@kernel
def rhs(t, q, dq, m):
    """Derivative dq (m.n,) of everything the bearing integrates, t (s) into the macro step."""
    seat.copy_rates(t, q, dq, m, m.half, react(t, q, dq, m))


@kernel
def observe(t, q, m):
    """Peaks and events, after each accepted micro-step, t (s) into the macro step."""
    ring.watch_bore(t, q, m)
    s = m.s.balls
    force = s.force / m.p.balls.rows
    watch_balls(m.time + t, Largest(force, s.indentation, s.most_loaded, s.deepest), m)


@kernel
def report(q, m):
    """Outputs wanted once per macro step, from the state q (m.n,)."""
    p, d, o, s = m.p, m.d, m.o, m.s.balls
    ring.report(q, m, d.inner_radius)
    gaps.report(m)
    o.balls.loaded = int(s.loaded)
    o.balls.force, o.balls.indentation = s.force / p.balls.rows, s.indentation
    cage, spin = d.cage_ratio * q[ring.RW], d.ball_ratio * q[ring.RW]
    inside, elastic = bending.bending_energy(q, d.bending)
    o.ring.ovality = bending.ovality(q, d.bending)
    if p.slip == 1:
        cage, spin = q[CAGE_SPEED], q[BALL_SPIN]
        inside += 0.5 * d.orbiting * squared(cage) + 0.5 * d.spinning * squared(spin)
    o.speed.cage = cage * d.pitch_radius
    o.speed.ball = abs(spin) * d.ball_radius
    ring.report_energy(q, m, inside, s.energy + elastic, d.ring_inertia)


@kernel
def _set_weights(m):
    """Error weights, and how many components are in use: cage and balls where they may slip."""
    w = m.weight
    seat.set_weights(w)
    ring.set_weights(w)
    m.n = ring.NEXT
    if m.p.slip == 1:
        w[CAGE_ANGLE] = m.d.pitch_radius / seat.POSITION_SCALE
        w[CAGE_SPEED], w[BALL_SPIN] = 1.0 / ORBIT_SCALE, 1.0 / seat.SPIN_SCALE
        m.n += 3


@kernel
def derive(words):
    """Stiffness, inertia and ratios from geometry, and error weights; returns a problem's number, or 0."""
    m = words.view(MEMORY)[0]
    p, d = m.p, m.d
    blank(words, CONSTANTS)
    problem = declarations.rolling_problem(p, 0, m.message_numbers)
    problem = declarations.law_problem(
        problem, p.race_friction, STATIC, declarations.OWN, m.message_numbers
    )
    if problem != 0:
        return problem
    follower.derive(m)
    follower.derive_turning(m)
    d.race_friction = p.race_friction
    friction.derive(d.race_friction)
    if p.slip == 1:
        d.size.coordinates, d.ring_inertia = 7, p.ring.inertia
    _set_weights(m)
    ring.append_bending(FASTEST_BENDING, m)
    return missing(words, CONSTANTS)


@kernel
def start(words):
    """The ring at rest on the balls, the first of them at its angle; words: the memory, in 8-byte words."""
    m = words.view(MEMORY)[0]
    q, d = m.q, m.d
    seat.take_inputs(q, m)
    gaps.start_gaps(m)
    ring.place_ring(q, d.rest_x, d.rest_y)
    state_constants(m)
    seat.begin(seat.PLANAR, react, report, m)


@kernel
def _follow_gaps(m, since):
    """Have the gaps follow temperatures and spins as a macro step begins; since: s after that."""
    if gaps.due(m, since):
        closed = gaps.change_gaps(m)
        work = closed.play * m.s.balls.total
        gaps.book_closing(closed, 0.5 * work, 0.5 * work, m)


@kernel
def integrate(m, work, span):
    """Advance m.q by `span` (s); work: (8, m.n) or wider. As `seat.integrate`."""
    return seat.integrate(seat.PLANAR, rhs, observe, m, work, span)


@kernel
def instant(t, q, dq, words):
    """Derivative dq (m.n,) and load in m.o (N, N m) under the motion m.u."""
    m = words.view(MEMORY)[0]
    seat.instant(seat.PLANAR, react, t, q, dq, m)


@kernel
def advance(words, work, time, step):
    """One macro step of `step` (s) from `time` (s); returns a status."""
    m = words.view(MEMORY)[0]
    status = seat.advance(seat.PLANAR, _follow_gaps, react, integrate, report, words, m, work, time, step)
    return gaps.status_when_warm(status, m)


@kernel
def _advance_as_built(words, work, time, step):
    """The same where play and clearance stay as they are (`gaps.EFFECTS`)."""
    m = words.view(MEMORY)[0]
    return seat.advance(seat.PLANAR, seat.any_time, react, integrate, report, words, m, work, time, step)


MODEL = Model(
    name="simplified_caged",
    title="Simplified caged touchdown bearing",
    about="Ball bearing with cage as one ring on springs at the balls, which follow it, or may slip",
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
    starts_from=starts_from("rings") | {"size.coordinates": ("slip",)},
)
