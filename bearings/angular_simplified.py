"""Simplified touchdown bearing in space: one ring with six coordinates, on rows of balls that follow it.

`simplified_caged` for rows with a contact angle, single or in pairs, for deep grooves under thrust, and for
faces on which a shoulder of the rotor lands: the ring also moves along the shaft and tilts
(`bearings.angular.inner_ring`), and each ball is one spring between the centres of its grooves. At contact
angle 0, in the plane, the two are one model. A ball's orbit may throw it outwards (`balls.centrifugal`,
`angular.thrown_ball`); where that is left out, `along.centrifugal` says how large it is. Rings may give all
around (`ring.hoop`, `angular.hoop`). Balls and cage do not slip here; with balls as bodies they do
(`angular_caged`, `angular_cageless`).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from ..modelkit.kernel import kernel
from ..modelkit.model import Model, constants
from ..modelkit.numerics import blank, missing
from ..modelkit.ports import SpatialLoad
from ..modelkit.variables import SWITCH, choice, group
from . import seat
from .angular import arrangement, hoop, inner_ring
from .angular.angular_row import Pose, grooves_apart
from .angular.arrangement import RowsParameters
from .angular.hoop import HoopRing, OuterRing
from .angular.inner_ring import (
    AlongReport,
    AngularBallSet,
    SpaceConstants,
    SpaceRingMemory,
    SpatialMemory,
    SpatialOutputs,
)
from .angular.thrown_ball import LANES, OrbitingBalls, step_balls
from .contact.face import watch_faces
from .contact.peaks import Largest
from .rolling import bending, declarations, follower, gaps, ring
from .rolling.ball_set import MAX_BALLS
from .rolling.balls import Total, watch_balls
from .rolling.declarations import RollingParameters, starts_from, state_constants
from .rolling.follower import (
    FASTEST_BENDING,
    FollowerDerived,
    FollowerMemory,
    FollowerParameters,
    FollowerSpeeds,
)
from .rolling.pitch_circle import BallLoads, forget_loaded, note_ball
from .seat import any_time, space


@dataclass(frozen=True)
class ThrownBallSet(AngularBallSet):
    """Balls that their orbit may throw outwards."""

    centrifugal: int = choice(0, SWITCH, "its orbit throws a ball outwards, which parts its contact angles")


@dataclass(frozen=True)
class Parameters(RowsParameters, FollowerParameters, RollingParameters):
    """Defaults: SKF 6004 under the disk of section 4.3, as `simplified_caged`."""

    balls: ThrownBallSet = group(ThrownBallSet)
    ring: HoopRing = group(HoopRing)
    outer_ring: OuterRing = group(OuterRing, needs="ring.hoop")


@dataclass(frozen=True)
class Outputs(SpatialOutputs):
    """Loads, and what to know of the inside."""

    speed: FollowerSpeeds = group(FollowerSpeeds)
    along: AlongReport = group(AlongReport)


@dataclass(frozen=True)
class Derived(FollowerDerived):
    """Constants that follow from the parameters."""

    space: SpaceConstants = group(SpaceConstants)


@dataclass(frozen=True)
class Hidden(FollowerMemory, SpatialMemory):
    """Memory between evaluations and steps."""

    space: SpaceRingMemory = group(SpaceRingMemory)
    orbit: OrbitingBalls = group(OrbitingBalls)


STATES = inner_ring.NEXT + bending.MAX_STATES
MEMORY = seat.bearing_memory(
    Parameters, Outputs, STATES, derived=Derived, hidden=Hidden, inputs=space.SpatialInputs
)
_OTHERS = declarations.rolling_problems()
BEFORE = len(_OTHERS)  # numbers of problems
CONSTANTS, PROBLEMS = constants(MEMORY, (*_OTHERS, *arrangement.PROBLEMS, hoop.PROBLEM))


@kernel
def _held(row, there, rates, nx, ny, at, m):
    """`HeldBall` of a ball that is light."""
    return inner_ring.held_ball(row, there, rates, nx, ny, m)


@kernel
def _held_in_orbit(row, there, rates, nx, ny, at, m):
    """`HeldBall` of a ball that its orbit throws outwards, once it does."""
    if m.s.space.centrifugal > 0.0:
        return inner_ring.orbiting_ball(row, there, rates, nx, ny, at, m)
    return inner_ring.held_ball(row, there, rates, nx, ny, m)


@kernel
def _rest(k, q, pose, closed, turned, m):
    """Balls that are light need no search."""


@kernel
def _search(k, q, pose, closed, turned, m):
    """Take a step towards where balls of row `k` are thrown, once they are, with the ring at a `Pose`.

    closed: by how much the race opens (m); turned: cosine and sine of the cage's angle.
    """
    space, s, row, n = m.s.space, m.s.orbit, m.d.space.row[k], m.p.balls.count
    lanes = (n + LANES - 1) // LANES * LANES
    if space.centrifugal <= 0.0:
        return
    first, (ca, sa) = k * MAX_BALLS, turned
    for b in range(n):
        c0, s0 = m.d.cosine[b], m.d.sine[b]
        nx, ny = ca * c0 - sa * s0, sa * c0 + ca * s0
        wider = closed
        if m.d.bending.waves > 1:
            wider += bending.shape_at(q, nx, ny, m.d.bending).opening
        there = Pose(pose.x + wider * nx, pose.y + wider * ny, pose.z, pose.rx, pose.ry)
        s.u[first + b], s.v[first + b] = grooves_apart(row, there, nx, ny)
    size = space.centrifugal, space.outer_alone, m.s.gaps.ball_growth
    step_balls(row, *size, first, lanes, s)


@kernel
def _springs(search, hold, q, cage_angle, m):
    """Balls that follow the ring: `Total` on it across the shaft (N, W), its moment (N m) that on the cage,
    and the sum of each row's `friction_load` (N).

    What they do beyond the plane is kept in m.s.space. search, hold: `_rest` and `_held`, or others; q: the
    state; cage_angle: rad.
    """
    rows, balls = m.d.space, m.s.balls
    fx, fy, moment, heat, friction = 0.0, 0.0, 0.0, 0.0, 0.0
    ca, sa = math.cos(cage_angle), math.sin(cage_angle)
    pose, moving = inner_ring.ring_pose(q), inner_ring.pose_rates(q)
    # since the start the race is wider by that, beside what balls grow along their contact lines
    closed = m.p.balls.play - m.s.gaps.play - m.s.gaps.ball_growth
    flexible, (breathed, breathing), pushed = m.d.bending.waves > 1, bending.breath(q, m.d.bending), 0.0
    closed += breathed
    for k in range(rows.rows):
        row, before = rows.row[k], (fx, fy, m.s.space.fz)
        z = pose.z + row.inner_at * m.s.gaps.strain_along  # rings as long as they are warm
        search(k, q, Pose(pose.x, pose.y, z, pose.rx, pose.ry), closed, (ca, sa), m)
        for b in range(m.p.balls.count):
            c0, s0 = m.d.cosine[b], m.d.sine[b]
            nx, ny = ca * c0 - sa * s0, sa * c0 + ca * s0
            bent = bending.shape_at(q, nx, ny, m.d.bending) if flexible else bending.ROUND
            wider, rate = bent.opening + closed, bent.rate + breathing
            there = Pose(pose.x + wider * nx, pose.y + wider * ny, z, pose.rx, pose.ry)
            rates = Pose(moving.x + rate * nx, moving.y + rate * ny, moving.z, moving.rx, moving.ry)
            ball = hold(row, there, rates, nx, ny, k * MAX_BALLS + b, m)
            if ball.indentation <= 0.0:
                continue
            fx, fy = fx - ball.across * nx, fy - ball.across * ny
            inner_ring.add_ball(m.s.space, row, ball, nx, ny)
            # along its path, as in the plane
            moment -= ball.turning + ball.elastic * ball.cosine * bent.slope
            heat += (ball.force - ball.elastic) * ball.rate
            pushed -= ball.across
            if flexible:
                bending.press_modes(-ball.across, nx, ny, m.d.bending, m.s.shape)
            if ball.outer > balls.force:
                m.s.space.sine = ball.sine
            note_ball(
                balls,
                b,
                BallLoads(ball.outer, ball.elastic, ball.indentation, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
            )
            balls.total += ball.force - ball.outer  # of the inner race, as in the plane
        x, y, z = fx - before[0], fy - before[1], m.s.space.fz - before[2]
        friction += follower.friction_load(math.sqrt(x * x + y * y + z * z), rows.abreast, m.p)
        m.s.space.stretch -= row.inner_at * z
    thrown = m.s.space.centrifugal * m.p.balls.count * rows.rows  # opens the outer race, pressed or not
    balls.energy += rows.outer_share * thrown * breathed
    m.s.space.lifted -= rows.outer_share * m.p.balls.count * rows.rows * breathed
    bending.press_breath(pushed - rows.outer_share * thrown, m.d.bending, m.s.shape)
    return Total(fx, fy, moment, heat), friction


@kernel
def _react(search, hold, q, dq, m):
    """Derivative dq of what is inside, in q, and the `SpatialLoad` (N, N m) on journal and housing.

    search, hold: as for `_springs`.
    """
    p, s, inertia = m.p, m.s.space, m.d.ring_inertia
    forget_loaded(m.s.balls)
    s.fz = s.mx = s.my = s.across = s.sine = s.lifted = s.orbit_load = s.stretch = 0.0
    m.s.shape.acceleration[:] = 0.0
    j = inner_ring.journal_on_edges(q, m.s.shape, m)
    springs, friction = _springs(search, hold, q, m.d.cage_ratio * q[ring.RANGLE], m)
    balls, moving = follower.braked(springs, friction, q, m), inner_ring.pose_rates(q)
    fx, fy, held = (
        balls.fx - p.damping * moving.x,
        balls.fy - p.damping * moving.y,
        s.fz - p.damping * moving.z,
    )
    f = inner_ring.accelerate_in_space(q, dq, held, m)
    ring.translate(q, dq, m, j, fx - f.fx, fy - f.fy)
    bent = bending.accelerate_modes(q, 0.0, m.d.bending, m.s.shape)
    bending.hand_over_modes(q, dq, m.d.bending, m.s.shape)
    dq[ring.RW] = (balls.moment + j.ring_moment - f.moment) / inertia
    damped = p.damping * (moving.x * moving.x + moving.y * moving.y + moving.z * moving.z)
    follower.share_follower_heat(dq, j, bent, balls, damped, f.loss, m)
    across = j.fx + f.fx, j.fy + f.fy, j.journal_moment + f.moment, -fx, -fy
    return SpatialLoad(*across, f.fz, -held, s.edge_mx + f.mx, s.edge_my + f.my)


@kernel
def react(t, q, dq, m):
    """Derivative dq and the `SpatialLoad` (N, N m) of balls that are light."""
    return _react(_rest, _held, q, dq, m)


@kernel
def react_in_orbit(t, q, dq, m):
    """Derivative dq and the `SpatialLoad` (N, N m) of balls that their orbit may throw outwards."""
    return _react(_search, _held_in_orbit, q, dq, m)


@kernel
def rhs(t, q, dq, m):
    """Derivative dq (m.n,) of everything the bearing integrates, t (s) into the macro step."""
    space.spatial_copy_rates(t, q, dq, m, m.half, react(t, q, dq, m))


@kernel
def rhs_in_orbit(t, q, dq, m):
    """The same with `react_in_orbit`."""
    space.spatial_copy_rates(t, q, dq, m, m.half, react_in_orbit(t, q, dq, m))


@kernel
def observe(t, q, m):
    """Peaks and events, after each accepted micro-step, t (s) into the macro step."""
    ring.watch_bore(t, q, m)
    s, time = m.s.balls, m.time + t
    force = s.force / m.d.space.abreast
    if m.p.balls.centrifugal == 0:
        inner_ring.note_orbit(time, force, m.d.cage_ratio * q[ring.RW], m)
    watch_balls(time, Largest(force, s.indentation, s.most_loaded, s.deepest), m)
    watch_faces(time, m.p.shoulder, m.o.shoulder, m.s.shoulder)


@kernel
def report(q, m):
    """Outputs wanted once per macro step, from the state q (m.n,)."""
    d, o, s = m.d, m.o, m.s.balls
    ring.report(q, m, d.inner_radius)
    gaps.report(m)
    o.balls.loaded = int(s.loaded)
    o.balls.force, o.balls.indentation = s.force / d.space.abreast, s.indentation
    kinetic, elastic = bending.bending_energy(q, d.bending)
    o.ring.ovality = bending.ovality(q, d.bending)
    o.speed.cage = d.cage_ratio * q[ring.RW] * d.pitch_radius
    o.speed.ball = abs(d.ball_ratio * q[ring.RW]) * d.ball_radius
    ring.report_energy(q, m, kinetic, s.energy + elastic, d.ring_inertia)
    inner_ring.report(q, m)


@kernel
def derive(words):
    """Stiffness, inertia and ratios from geometry, and error weights; returns a problem's number, or 0."""
    m = words.view(MEMORY)[0]
    blank(words, CONSTANTS)
    problem = declarations.rolling_problem(m.p, 0, m.message_numbers)
    if problem == 0:
        problem = arrangement.rows_problem(m.p, m.message_numbers)
        if problem == 0 and hoop.is_hollow(m.p, m.message_numbers):
            problem = len(arrangement.PROBLEMS) + 1
        problem += BEFORE if problem != 0 else 0
    if problem != 0:
        return problem
    follower.derive(m)
    giving = hoop.hoop_of(m.p)
    inner_ring.derive(m, giving.race)
    follower.derive_turning(m)
    space.set_weights(m.weight)
    space.weigh_tilt(m.weight)
    ring.set_weights(m.weight)
    inner_ring.set_weights(m.weight)
    m.n = inner_ring.NEXT
    bending.derive(m.d.bending, m.p, m.n, FASTEST_BENDING)
    hoop.append_breathing(giving, m)
    ring.weigh_bending(m)
    return missing(words, CONSTANTS)


@kernel
def start(words):
    """The ring at rest on the balls, the first of them at its angle; words: the memory, in 8-byte words."""
    m = words.view(MEMORY)[0]
    space.take_spatial_inputs(m.q, m)
    gaps.start_gaps(m)
    ring.place_ring(m.q, m.d.rest_x, m.d.rest_y)
    inner_ring.place_in_space(m.q)
    hoop.place_breathing(m.q, m)
    m.s.space.centrifugal, m.s.space.orbit_ratio = 0.0, m.d.cage_ratio
    state_constants(m)
    seat.begin(space.SPATIAL, react, report, m)


@kernel
def _follow_gaps(m, since):
    """Have the gaps follow temperatures and spins as a macro step begins; since: s after that."""
    if since == 0.0 and m.p.balls.centrifugal == 1:
        work = 0.5 * inner_ring.throw_balls(m)
        gaps.book_closing(gaps.Closed(0.0, 0.0), -work, -work, m)
    if gaps.due(m, since):
        g, s = m.s.gaps, m.s.space
        strain, grown = g.strain_along, g.ball_growth
        closed = gaps.change_gaps(m)
        strain, grown = g.strain_along - strain, g.ball_growth - grown
        work = (closed.play - grown) * s.across + strain * s.stretch + grown * m.s.balls.total
        gaps.book_closing(closed, 0.5 * work, 0.5 * work, m)


@kernel
def integrate(m, work, span):
    """Advance m.q by `span` (s); work: (8, m.n) or wider. As `seat.integrate`."""
    return seat.integrate(space.SPATIAL, rhs, observe, m, work, span)


@kernel
def integrate_in_orbit(m, work, span):
    """The same with `react_in_orbit`."""
    return seat.integrate(space.SPATIAL, rhs_in_orbit, observe, m, work, span)


@kernel
def instant(t, q, dq, words):
    """Derivative dq (m.n,) and load in m.o (N, N m) under the motion m.u."""
    m = words.view(MEMORY)[0]
    seat.instant(space.SPATIAL, react, t, q, dq, m)


@kernel
def advance(words, work, time, step):
    """One macro step of `step` (s) from `time` (s); returns a status."""
    m = words.view(MEMORY)[0]
    status = seat.advance(
        space.SPATIAL, _follow_gaps, react_in_orbit, integrate_in_orbit, report, words, m, work, time, step
    )
    return arrangement.status_on_row(gaps.status_when_warm(status, m), m, step)


@kernel
def _advance_as_built(words, work, time, step):
    """The same where play and clearance stay as they are, and balls are light."""
    m = words.view(MEMORY)[0]
    status = seat.advance(space.SPATIAL, any_time, react, integrate, report, words, m, work, time, step)
    return arrangement.status_on_row(status, m, step)


MODEL = Model(
    name="angular_simplified",
    title="Simplified touchdown bearing in space",
    about="Angular contact or deep groove bearing, single or in pairs, as one ring on springs at the balls",
    parameters=Parameters,
    inputs=space.SpatialInputs,
    outputs=Outputs,
    derived=Derived,
    hidden=Hidden,
    memory=MEMORY,
    derive=derive,
    start=start,
    advance=advance,
    effects=(*gaps.EFFECTS, "balls.centrifugal"),
    advance_without=_advance_as_built,
    problems=PROBLEMS,
    instant=instant,
    starts_from=starts_from("coordinates", "rings"),
)
