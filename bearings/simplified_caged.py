"""Simplified touchdown bearing with a cage (section 2.1 of the source, harmonised as in 4.3).

The inner ring has three coordinates; balls and cage follow it without slip (4.2). Where a ball is
pressed between the rings, one spring in series stands for both of its contacts (2.5, 2.6). A
rolling-bearing friction moment (Harris) brakes the ring. The inertia of balls and cage is added to the
ring's (4.3).

Deviations from the source, each named where it acts:
- (4.3) prints a minus before the inertia of the balls; kinetic energy is quadratic in their spin, so it
  is a plus.
- A ball carried by the turning ring into the narrowing gap resists with the moment -F (e . t) about the
  bearing's centre. The source leaves it out; without it the model creates energy and angular momentum.
- `slip = 1` (section 5.3) gives cage and balls coordinates of their own, driven by friction at both races
  as in the cageless model; it takes the place of the friction moment.
- Friction moment and gaps act at the ring's actual place, so that action equals reaction.

With a contact angle (`balls.contact_angle`), or faces for a shoulder of the rotor to land on, the ring also
moves along the shaft and tilts (`bearings.angular.inner_ring`). At contact angle 0, in the plane, that is
the model of the source. What a ball's orbit adds, centrifugal force, is left out: `along.centrifugal` says
how large it is.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from ..modelkit.kernel import kernel
from ..modelkit.model import Model, constants
from ..modelkit.numerics import blank, missing, squared
from ..modelkit.ports import Load
from ..modelkit.variables import SWITCH, array, choice, group, real
from . import seat
from .angular import arrangement, inner_ring
from .angular.inner_ring import Along, AngularBallSet, SpaceConstants, SpaceMemory, SpaceParameters
from .angular.row import Pose
from .contact import friction
from .contact.face import ShoulderReport
from .contact.friction import FrictionLaw
from .contact.laws import ContactLaw, elastic_force
from .contact.peaks import Largest
from .heat import parts
from .heat.parts import Sources
from .rolling import bending, declarations, gaps, ring
from .rolling.ball_set import (
    EVEN_SPREAD,
    MAX_BALLS,
    ball_inertia,
    ball_mass,
    series_dissipation,
    set_race_law,
    start_angle,
)
from .rolling.balls import Total, watch_balls
from .rolling.bending import BendingMemory
from .rolling.declarations import (
    RollingDerived,
    RollingMemory,
    RollingOutputs,
    RollingParameters,
    starts_from,
    state_constants,
)
from .rolling.pitch_circle import (
    LoadedBalls,
    Pressed,
    RollingResistance,
    between_races,
    clear,
    note,
    rolling_drag,
)

CAGE_ANGLE, CAGE_SPEED, BALL_SPIN = range(ring.NEXT, ring.NEXT + 3)  # in use where they may slip
ORBIT_SCALE = 100.0  # rad/s; of the cage
ROLLING_EXPONENT = 0.55  # of the load over the static rating, in the friction moment


@dataclass(frozen=True)
class Rolling(RollingResistance):
    """Friction moment of the rolling bearing, M = f1 (F/C0)^0.55 F d_m (Harris) with the load of each row
    over its rating, and loss of its balls.
    """

    f1: float = real(5e-4, "1", "factor f1", minimum=0.0)
    static_rating: float = real(5000.0, "N", "static load rating C0, of one row of balls", above=0.0)
    slope: float = real(100.0, "s/m", "steepness of the moment through zero race speed", above=0.0)


@dataclass(frozen=True)
class Cage:
    """Cage that turns with the balls."""

    mass: float = real(2.15e-3, "kg", "mass of the cage; as heavy as two balls", minimum=0.0)


@dataclass(frozen=True)
class Parameters(SpaceParameters, RollingParameters):
    """Defaults: SKF 6004 under the disk of section 4.3."""

    balls: AngularBallSet = group(AngularBallSet)
    damping: float = real(0.0, "N.s/m", "damping between the rings, also out of contact (2.7)", minimum=0.0)
    slip: int = choice(
        0, SWITCH, "cage and balls may slip, driven by friction instead of following the ring"
    )
    cage: Cage = group(Cage)
    rolling: Rolling = group(Rolling)
    race_friction: FrictionLaw = group(FrictionLaw, needs="slip")


@dataclass(frozen=True)
class Speeds(ring.RaceSpeeds):
    """Circumferential speeds that agree where nothing slips (4.2; the source's Figs 25 and 26)."""

    cage: float = real(0.0, "m/s", "circumferential speed of the cage on the pitch circle", local=True)
    ball: float = real(0.0, "m/s", "circumferential speed of the balls by their spin", local=True)


@dataclass(frozen=True)
class Outputs(RollingOutputs):
    """Loads, and what to know of the inside."""

    speed: Speeds = group(Speeds)
    along: Along = group(Along)
    shoulder: ShoulderReport = group(ShoulderReport)


@dataclass(frozen=True)
class Derived(RollingDerived):
    """Constants that follow from the parameters."""

    race: ContactLaw = group(ContactLaw)
    race_friction: FrictionLaw = group(FrictionLaw)
    mass: float = real(0.0, "kg", "of a ball, or of those side by side")
    ball_radius: float = real(0.0, "m", "of a ball")
    pitch_radius: float = real(0.0, "m", "where ball centres run")
    ring_inertia: float = real(0.0, "kg.m2", "what turns with the ring: without slip all of it (4.3)")
    orbiting: float = real(0.0, "kg.m2", "moment of inertia of cage and balls about the middle")
    spinning: float = real(0.0, "kg.m2", "moment of inertia of the balls about themselves")
    cage_ratio: float = real(0.0, "1", "cage speed over ring speed (4.2)")
    ball_ratio: float = real(0.0, "1", "ball spin over ring speed (4.2)")
    cosine: tuple = array(MAX_BALLS)
    sine: tuple = array(MAX_BALLS)
    space: SpaceConstants = group(SpaceConstants)


@dataclass(frozen=True)
class Hidden(RollingMemory):
    """Memory between evaluations and steps."""

    balls: LoadedBalls = group(LoadedBalls)
    space: SpaceMemory = group(SpaceMemory)
    shape: BendingMemory = group(BendingMemory)


# rad/s, to which frequencies of the ring's modes are lowered, with the compliance kept: the load of balls
# is nearly a static matter, and the fastest of them would bound the adaptive steps
FASTEST_BENDING = 1.2e5
STATES = ring.NEXT + 3 + inner_ring.SIZE + bending.MAX_STATES
MEMORY = seat.bearing_memory(Parameters, Outputs, STATES, derived=Derived, hidden=Hidden)
STATIC = Parameters().race_friction.static
_OTHERS = declarations.problems("race_friction")
BEFORE = len(_OTHERS)  # numbers of problems
CONSTANTS, PROBLEMS = constants(
    MEMORY,
    (
        *_OTHERS,
        *arrangement.PROBLEMS,
        "slip = 1 is for balls in the plane; set slip = 0, or balls.contact_angle = 0 and no "
        "shoulder.gap_minus and gap_plus",
    ),
)


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
        bent = bending.shape_at(q, nx, ny, m.d.bending)
        indentation = gap.ex * nx + gap.ey * ny - play + bent.opening
        if indentation <= 0.0:
            continue
        rate = gap.ux * nx + gap.uy * ny + bent.rate
        elastic = elastic_force(indentation, law)
        force = max(elastic + law.damping * indentation * rate, 0.0)
        fx -= force * nx
        fy -= force * ny
        # the ball moves along t = (-ny, nx) into the narrowing gap, which the source leaves out
        moment -= elastic * (gap.ey * nx - gap.ex * ny + bent.slope)
        heat += (force - elastic) * rate
        bending.press(-force, nx, ny, m.d.bending, m.s.shape)
        note(m.s.balls, b, Pressed(force, elastic, indentation, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0))
    return Total(fx, fy, moment, heat)


@kernel
def _springs_in_space(q, cage_angle, m):
    """`_springs` of rows of balls in space; what they do beyond the plane is kept in m.s.space."""
    space, count, balls = m.d.space, m.p.balls.count, m.s.balls
    fx, fy, moment, heat = 0.0, 0.0, 0.0, 0.0
    ca, sa = math.cos(cage_angle), math.sin(cage_angle)
    at, moving = inner_ring.pose(q, m), inner_ring.rates(q, m)
    closed = m.p.balls.play - m.s.gaps.play  # since the start: the race is wider by that
    for k in range(space.rows):
        row = space.row[k]
        for b in range(count):
            c0, s0 = m.d.cosine[b], m.d.sine[b]
            nx, ny = ca * c0 - sa * s0, sa * c0 + ca * s0
            bent = bending.shape_at(q, nx, ny, m.d.bending)
            wider = bent.opening + closed
            there = Pose(at.x + wider * nx, at.y + wider * ny, at.z, at.rx, at.ry)
            rates = Pose(
                moving.x + bent.rate * nx, moving.y + bent.rate * ny, moving.z, moving.rx, moving.ry
            )
            ball = inner_ring.held(row, there, rates, nx, ny, space.damping)
            if ball.indentation <= 0.0:
                continue
            fx, fy = fx - ball.across * nx, fy - ball.across * ny
            inner_ring.add(m.s.space, row, ball, nx, ny)
            # along its path, as in the plane
            moment -= ball.turning + ball.elastic * ball.cosine * bent.slope
            heat += (ball.force - ball.elastic) * ball.rate
            bending.press(-ball.across, nx, ny, m.d.bending, m.s.shape)
            if ball.force > balls.force:
                m.s.space.sine = ball.sine
            note(
                balls, b, Pressed(ball.force, ball.elastic, ball.indentation, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
            )
    return Total(fx, fy, moment, heat)


@kernel
def _springs_of(q, gap, cage_angle, m):
    """`_springs`, or where rows stand in space theirs."""
    if m.d.space.rows > 0:
        return _springs_in_space(q, cage_angle, m)
    return _springs(q, gap, cage_angle, m)


@kernel
def _rolling(q, gap, m):
    """Ring, cage and balls turn as one (4.2): `Total` (N, N m, W) on the ring in the state q."""
    p, d = m.p, m.d
    springs = _springs_of(q, gap, d.cage_ratio * q[ring.RANGLE], m)
    along = m.s.space.fz
    load = math.sqrt(springs.fx * springs.fx + springs.fy * springs.fy + along * along)
    moment = p.rolling.f1 * (load / (p.balls.rows * p.rolling.static_rating)) ** ROLLING_EXPONENT * load
    moment *= p.balls.pitch_diameter * math.tanh(p.rolling.slope * q[ring.RW] * d.inner_radius)
    moment += _rolling_loss(d.cage_ratio * q[ring.RW], m)
    on_ring = d.cage_ratio * springs.moment - moment
    heat = springs.loss + moment * q[ring.RW]
    m.s.balls.outside = 0.5 * heat
    return Total(springs.fx, springs.fy, on_ring, heat)


@kernel
def _rolling_loss(orbit, m):
    """Moment on the ring (N m) that does the work of the balls' rolling resistance; orbit: rad/s."""
    p, d = m.p, m.d
    pressed = 2.0 * m.s.balls.total + p.balls.count * d.mass * d.pitch_radius * orbit * orbit
    drag = p.rolling.resistance * pressed * rolling_drag(d.pitch_radius * orbit)
    return drag * d.pitch_radius * d.cage_ratio


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
            bending.press(-ball.force, c, s, d.bending, m.s.shape)
            note(m.s.balls, b, ball)
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
    clear(m.s.balls)
    inner_ring.clear(m.s.space)
    m.s.shape.acceleration[:] = 0.0
    j = inner_ring.journal_on_ring(q, m.s.shape, m)
    gap = ring.gap(q)
    balls = _slipping(q, dq, gap, m) if p.slip == 1 else _rolling(q, gap, m)
    fx, fy = balls.fx - p.damping * gap.ux, balls.fy - p.damping * gap.uy
    ring.translate(q, dq, m, j, fx, fy)
    bent = bending.accelerate(q, 0.0, m.d.bending, m.s.shape)
    bending.hand_over(q, dq, m.d.bending, m.s.shape)
    dq[ring.RW] = balls.moment / inertia + j.ring_moment / inertia
    damped, outside = p.damping * (gap.ux * gap.ux + gap.uy * gap.uy), m.s.balls.outside
    if m.d.space.rows > 0:
        uz = q[m.d.space.at + inner_ring.VZ] - q[seat.HVZ]
        damped += p.damping * uz * uz
    dq[ring.LOSS] = j.loss + balls.loss + bent + damped
    inside, outside = balls.loss - outside + 0.5 * damped, outside + 0.5 * damped
    if m.d.space.rows == 0:
        parts.set_rates(Sources(j.loss, bent, inside, outside, 0.0), j.sliding, dq, ring.HEAT)
        return Load(j.fx, j.fy, j.journal_moment, -fx, -fy, 0.0, 0.0, 0.0, 0.0)
    held = m.s.space.fz - p.damping * (q[m.d.space.at + inner_ring.VZ] - q[seat.HVZ])
    f = inner_ring.move(q, dq, held, m)
    parts.set_rates(Sources(j.loss + f.loss, bent, inside, outside, 0.0), j.sliding, dq, ring.HEAT)
    dq[ring.RVX] -= f.fx / p.ring.mass
    dq[ring.RVY] -= f.fy / p.ring.mass
    dq[ring.RW] -= f.moment / inertia
    s, moment = m.s.space, j.journal_moment + f.moment
    tilting = s.edge_mx + f.mx, s.edge_my + f.my
    return Load(j.fx + f.fx, j.fy + f.fy, moment, -fx, -fy, f.fz, -held, *tilting)


@kernel
def rhs(t, q, dq, m):
    """Derivative dq (m.n,) of everything the bearing integrates, t (s) into the macro step."""
    seat.copy_rates(t, q, dq, m, m.half, react(t, q, dq, m))


@kernel
def observe(t, q, m):
    """Peaks and events, after each accepted micro-step, t (s) into the macro step."""
    ring.watch(t, q, m)
    s = m.s.balls
    now = Largest(s.force / m.d.space.abreast, s.indentation, s.most_loaded, s.deepest)
    inner_ring.note_orbit(m.time + t, now.force, m.d.cage_ratio * q[ring.RW], m)
    watch_balls(m.time + t, now, m)
    inner_ring.watch(m.time + t, m)


@kernel
def report(q, m):
    """Outputs wanted once per macro step, from the state q (m.n,)."""
    p, d, o, s = m.p, m.d, m.o, m.s.balls
    ring.report(q, m, d.inner_radius)
    gaps.report(m)
    o.balls.loaded = int(s.loaded)
    o.balls.force, o.balls.indentation = s.force / d.space.abreast, s.indentation
    cage, spin = d.cage_ratio * q[ring.RW], d.ball_ratio * q[ring.RW]
    inside, elastic = bending.energy(q, d.bending)
    o.ring.ovality = bending.ovality(q, d.bending)
    if p.slip == 1:
        cage, spin = q[CAGE_SPEED], q[BALL_SPIN]
        inside += 0.5 * d.orbiting * squared(cage) + 0.5 * d.spinning * squared(spin)
    o.speed.cage = cage * d.pitch_radius
    o.speed.ball = abs(spin) * d.ball_radius
    ring.report_energy(q, m, inside, s.energy + elastic, d.ring_inertia)
    if d.space.rows > 0:
        inner_ring.report(q, m)


@kernel
def _derive_turning(m):
    """Set in m.d what turns: radii, inertia, ratios of speeds, where the balls start."""
    p, d, b = m.p, m.d, m.p.balls
    d.ball_radius, d.pitch_radius = 0.5 * b.diameter, 0.5 * b.pitch_diameter
    d.cage_ratio = 0.5 * d.inner_radius / d.pitch_radius
    d.ball_ratio = -0.5 * d.inner_radius / d.ball_radius
    square = squared(d.pitch_radius)
    d.orbiting = p.cage.mass * square + b.count * d.mass * square
    d.spinning = b.count * ball_inertia(d.mass, b.diameter)
    d.ring_inertia = p.ring.inertia
    if p.slip == 0:
        d.ring_inertia += d.orbiting * squared(d.cage_ratio) + d.spinning * squared(d.ball_ratio)
    for i in range(b.count):
        angle = start_angle(b.first_angle, b.count, EVEN_SPREAD, i)
        d.cosine[i], d.sine[i] = math.cos(angle), math.sin(angle)


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
    inner_ring.append(m)


@kernel
def _problem_in_space(p, numbers):
    """The number of a fault in the rows' parameters p, counted behind `_OTHERS`, or 0."""
    found = arrangement.problem(p, numbers)
    if found == 0 and p.slip == 1 and inner_ring.is_spatial(p):
        found = len(arrangement.PROBLEMS) + 1
    return found


@kernel
def derive(words):
    """Stiffness, inertia and ratios from geometry, and error weights; returns a problem's number, or 0."""
    m = words.view(MEMORY)[0]
    p, d = m.p, m.d
    blank(words, CONSTANTS)
    problem = declarations.problem(p, 0, m.message_numbers)
    problem = declarations.law_problem(
        problem, p.race_friction, STATIC, declarations.OWN, m.message_numbers
    )
    if problem == 0:
        problem = _problem_in_space(p, m.message_numbers)
        problem += BEFORE if problem != 0 else 0
    if problem != 0:
        return problem
    declarations.derive(m, EVEN_SPREAD)
    d.mass = ball_mass(p.balls)
    set_race_law(d.race, p.balls, d.stiffness.series, d.mass, series_dissipation(d.stiffness))
    d.race_friction = p.race_friction
    friction.derive(d.race_friction)
    d.size.coordinates, d.size.rings = 5 + 2 * p.slip, p.balls.count
    inner_ring.derive(m)
    _derive_turning(m)
    _set_weights(m)
    ring.append_bending(FASTEST_BENDING, m)
    return missing(words, CONSTANTS)


@kernel
def start(words):
    """The ring at rest on the balls, the first of them at its angle; words: the memory, in 8-byte words."""
    m = words.view(MEMORY)[0]
    q, d = m.q, m.d
    seat.take_inputs(q, m)
    gaps.start(m)
    ring.place(q, d.rest_x, d.rest_y)
    inner_ring.place(m)
    state_constants(m)
    seat.begin(react, report, m)


@kernel
def _follow_gaps(m, since):
    """Have the gaps follow temperatures and spins as a macro step begins; since: s after that."""
    if gaps.due(m, since):
        closed = gaps.change(m)
        across = m.s.space.across if m.d.space.rows > 0 else m.s.balls.total
        work = closed.play * across
        gaps.press(closed, 0.5 * work, 0.5 * work, m)


@kernel
def integrate(m, work, span):
    """Advance m.q by `span` (s); work: (8, m.n) or wider. As `seat.integrate`."""
    return seat.integrate(rhs, observe, m, work, span)


@kernel
def instant(t, q, dq, words):
    """Derivative dq (m.n,) and load in m.o (N, N m) under the motion m.u."""
    m = words.view(MEMORY)[0]
    seat.instant(react, t, q, dq, m)


@kernel
def advance(words, work, time, step):
    """One macro step of `step` (s) from `time` (s); returns a status."""
    m = words.view(MEMORY)[0]
    status = seat.advance_timed(_follow_gaps, react, integrate, report, words, m, work, time, step)
    return arrangement.checked(status, m, step)


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
    problems=PROBLEMS,
    instant=instant,
    starts_from=starts_from("rings") | {"size.coordinates": ("slip",)},
)
