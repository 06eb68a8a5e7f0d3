"""Simplified touchdown bearing without a cage (section 2.1 of the source, harmonised as in 4.3).

The inner ring has three coordinates; each ball has its attitude angle and its spin (2.4). Where a ball
is pressed between the rings, one spring in series stands for both of its contacts (2.5, 2.6); friction
at both drives the ball along the race (2.10) and spins it (2.11); neighbours push and rub (2.8).

All angles and spins are counter-clockwise here (the source counts a ball's spin clockwise). With n the
outward and t = (-n_y, n_x) the tangential direction at a ball, s_i and s_o the sliding speeds at the
inner and outer race:

    r_m m gamma'' = mu(s_i) F + mu(s_o) F_o + H_b - H_(b+1) - g m cos(gamma) - F (e . t)/r_m     (2.10)
    I theta''     = r_b (mu(s_o) F_o - mu(s_i) F) - r_b mu_bb (H_b + H_(b+1))                      (2.11)

with F and F_o as in `bearings.rolling.pitch_circle`.

Deviations from the source, each named where it acts:
- (2.10) as printed has a further term mu r_b/r_m (F + F_o), which counts the contact moment twice;
  `as_printed` adds it (a passive bearing then loses angular momentum to nowhere).
- A ball driven into the narrowing gap resists with -F (e . t)/r_m.
- (5.1), the pitch radius corrected for indentation, is an option (`corrected_pitch`); as printed its signs
  take a loaded ball inwards, where the ring presses it outwards, into the outer race.
- Friction on a ball reacts on the rings as a force, too, so that action equals reaction.
- Neighbours push along the chord between their centres.
- Balls have no inertia or weight across the race: what (2.9) adds at the outer race loads friction, not
  the housing.

The balls' angles, orbits and spins lie in the state vector one after another, so that loops over the
balls become vector code. Friction on a ball of half a gram is stiff (1e7 per second under load),
everything else is not. The default are leapfrog steps within which friction may stop the sliding; with
`micro_step = 0` a linearly implicit method whose matrix holds the slopes of friction is the reference.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from touchdown.bearings import seat
from touchdown.bearings.contact.friction import (
    FrictionLaw,
    coefficient,
    curve,
    follow,
    prepared,
    slope,
)
from touchdown.bearings.contact.friction import problem as friction_problem
from touchdown.bearings.contact.laws import ContactLaw, abreast, damped, elastic_energy, normal_and_elastic
from touchdown.bearings.contact.pair import friction_force
from touchdown.bearings.rolling import ring
from touchdown.bearings.rolling.ball_bodies import resolved_step
from touchdown.bearings.rolling.balls import (
    MOST_BALLS,
    BallContacts,
    Coordinates,
    FreeBallSet,
    watch_balls,
    watch_contacts,
)
from touchdown.bearings.rolling.pitch_circle import Raceway, RollingResistance, meet, press_ball
from touchdown.bearings.rolling.race_contacts import LANES, rounded
from touchdown.bearings.rolling.resistance import (
    RollingDerived,
    RollingMemory,
    RollingOutputs,
    RollingParameters,
    race_stiffness,
    starts_from,
    state_constants,
)
from touchdown.modelkit.angles import cosine_and_sine
from touchdown.modelkit.integrators import dopri, rosenbrock, verlet
from touchdown.modelkit.kernel import kernel
from touchdown.modelkit.model import Model
from touchdown.modelkit.ports import Interface, Load
from touchdown.modelkit.variables import array, group, integer, real

BALLS = ring.NEXT  # from here each component of all balls in turn,
ANGLE, ORBIT, SPIN = range(3)  # in this order: attitude angle, its rate, spin
MOST_STATES = BALLS + 3 * MOST_BALLS + LANES  # and room to run past the last ball
BALL_SPIN_SCALE = 1e3  # rad/s
ORBIT_SCALE = 100.0  # rad/s; a ball's speed along the race over its radius

NOMINAL, CORRECTED, AS_PRINTED = range(3)


@dataclass(frozen=True)
class Parameters(RollingParameters):
    """Defaults: Koyo 6904 under the disk of section 4.3, pitch diameter corrected to 28.5 mm."""

    interface: Interface = group(Interface, tolerance=2e-5)
    micro_step: float = real(
        2e-6,
        "s",
        "longest step inside, of the velocity Verlet method; 0: adaptive linearly implicit steps of the "
        "error interface.tolerance",
        minimum=0.0,
        maximum=1e-4,
    )
    balls: FreeBallSet = group(FreeBallSet)
    ring: ring.Ring = group(ring.Ring, mass=0.0095, inertia=1.08e-6)
    as_printed: int = integer(
        0, "1: (2.10) with its last friction term as printed, which breaks momentum", minimum=0, maximum=1
    )
    corrected_pitch: int = integer(
        NOMINAL,
        "radius on which balls run: 0 the pitch circle's, 1 corrected for indentation and play, "
        "2 corrected with the signs of (5.1) as printed",
        minimum=0,
        maximum=2,
    )
    rolling: RollingResistance = group(RollingResistance)
    race_friction: FrictionLaw = group(FrictionLaw)
    ball_contact: ContactLaw = group(ContactLaw, stiffness=1e8)
    ball_friction: FrictionLaw = group(FrictionLaw, static=0.03, dynamic=0.02)


@dataclass(frozen=True)
class Speeds(ring.RaceSpeeds):
    """Circumferential speeds that agree where nothing slips (4.2; the source's Figs 25 and 26)."""

    orbit: float = real(0.0, "m/s", "mean speed of the balls along the pitch circle", local=True)
    ball: float = real(0.0, "m/s", "mean circumferential speed of the balls by their spin", local=True)


@dataclass(frozen=True)
class Outputs(RollingOutputs):
    """Loads, and what to know of the inside."""

    neighbours: BallContacts = group(BallContacts)
    speed: Speeds = group(Speeds)


@dataclass(frozen=True)
class Derived(RollingDerived):
    """What parameters fix."""

    race: ContactLaw = group(ContactLaw)
    race_friction: FrictionLaw = group(FrictionLaw)
    ball_contact: ContactLaw = group(ContactLaw)
    ball_friction: FrictionLaw = group(FrictionLaw)
    mass: float = real(0.0, "kg", "of a ball, or of those side by side")
    inertia: float = real(0.0, "kg.m2", "of a ball, or of those side by side")
    ball_radius: float = real(0.0, "m", "of a ball")
    pitch_radius: float = real(0.0, "m", "where ball centres run")
    touch_angle: float = real(0.0, "rad", "between neighbours that just touch")
    run_radius: float = real(0.0, "m", "where ball centres run, unloaded: as (5.1) corrects it")
    run_share: float = real(0.0, "1", "of the rings' approach by which that radius grows")
    micro_step: float = real(0.0, "s", "longest step inside")
    bore_grip: float = real(0.0, "1/kg", "answer of the sliding speed to a force: journal on ring")
    race_grip: float = real(0.0, "1/kg", "ball on race, with all that hangs together")
    side_grip: float = real(0.0, "1/kg", "ball on ball")
    angles: tuple = array(MOST_BALLS)


@dataclass(frozen=True)
class RaceBalls:
    """Each ball between the races, at the last evaluation."""

    cosine: tuple = array(MOST_BALLS)
    sine: tuple = array(MOST_BALLS)
    force: tuple = array(MOST_BALLS)  # between the rings
    elastic: tuple = array(MOST_BALLS)
    indentation: tuple = array(MOST_BALLS)
    fx: tuple = array(MOST_BALLS)  # on the ring
    fy: tuple = array(MOST_BALLS)
    moment: tuple = array(MOST_BALLS)
    along: tuple = array(MOST_BALLS)  # angular acceleration along the race
    turning: tuple = array(MOST_BALLS)  # and of the spin
    heat: tuple = array(MOST_BALLS)


@dataclass(frozen=True)
class PushedBalls:
    """Balls that push each other, at the last evaluation."""

    force: float = real(0.0, "N", "largest")
    overlap: float = real(0.0, "m", "largest")
    energy: float = real(0.0, "J", "stored in the contacts")
    stiffness: float = real(0.0, "N/m", "largest")


@dataclass(frozen=True)
class Hidden(RollingMemory):
    """Memory between evaluations and steps."""

    balls: RaceBalls = group(RaceBalls)
    pushed: PushedBalls = group(PushedBalls)
    step: float = real(0.0, "s", "length of the micro-step, within which friction may stop; 0: no limit")


MEMORY = seat.bearing_memory(Parameters, Outputs, MOST_STATES, derived=Derived, hidden=Hidden)
SCRATCH = dopri.scratch_layout(MOST_STATES + seat.ROOM)


@kernel
def part(y, component, m):
    """One component of all balls in the state, or its derivative."""
    count = m.p.balls.count
    return y[BALLS + component * count : BALLS + (component + 1) * count]


@kernel
def _directions(angle, cosine, sine):
    for b in range(len(cosine)):
        cosine[b], sine[b] = cosine_and_sine(angle[b])


@kernel
def _press_all(gap, way, friction, weight, printed, inertia, moving, out):
    """Loads of all balls; friction: a `Curve`.

    weight: of a ball (N); printed: 1 for (2.10) as printed; inertia: of a ball (kg m2).
    """
    orbit, spin, cosine, sine = moving
    force, elastic, indentation, fx, fy, moment, along, turning, heat = out
    spun = way.ball_radius / inertia
    for b in range(len(cosine)):
        c, s = cosine[b], sine[b]
        at = meet(gap, c, s, orbit[b], spin[b], way)
        mu_inner, _ = follow(at.inner, friction)
        mu_outer, _ = follow(at.outer, friction)
        ball = press_ball(at, gap, c, s, orbit[b], (mu_inner, mu_outer), way)
        force[b] = ball.force
        elastic[b] = ball.elastic
        indentation[b] = ball.indentation
        fx[b] = ball.inner * s - ball.force * c
        fy[b] = -(ball.force * s + ball.inner * c)
        moment[b] = -ball.inner * ball.lever
        push = ball.inner + ball.outer - ball.held - weight * c
        push += printed * (ball.outer - ball.inner) * way.ball_radius / at.radius
        along[b] = push / (at.radius * way.mass)
        turning[b] = spun * (ball.outer - ball.inner)
        heat[b] = ball.heat


@kernel
def _race_forces(y, dy, m):
    """Ring against balls against housing: (force on the ring x, y; moment on it; heat).

    Sets the derivatives of the balls' angles, speeds and spins as far as races and gravity go.
    """
    p, d, s = m.p, m.d, m.s.balls
    count = p.balls.count
    n = rounded(count)
    gap, law = ring.gap(y), d.race
    size, grip = (d.inner_radius, d.ball_radius, d.mass), m.s.step * d.race_grip
    way = Raceway(
        p.balls.play,
        d.run_radius,
        d.run_share,
        law.stiffness,
        law.damping,
        *size,
        grip,
        p.rolling.resistance,
    )
    angle, orbit, spin = part(y, ANGLE, m), part(y, ORBIT, m), part(y, SPIN, m)
    _directions(angle, s.cosine[:n], s.sine[:n])
    moving = orbit, spin, s.cosine[:n], s.sine[:n]
    loads = s.fx[:n], s.fy[:n], s.moment[:n], s.along[:n], s.turning[:n], s.heat[:n]
    out = (s.force[:n], s.elastic[:n], s.indentation[:n], *loads)
    weight, printed = p.gravity * d.mass, 1.0 if p.as_printed == 1 else 0.0
    _press_all(gap, way, curve(d.race_friction), weight, printed, d.inertia, moving, out)
    fx, fy, moment, heat = 0.0, 0.0, 0.0, 0.0
    for b in range(count):
        i = BALLS + b
        dy[i] = orbit[b]
        dy[i + count] = s.along[b]
        dy[i + 2 * count] = s.turning[b]
        fx += s.fx[b]
        fy += s.fy[b]
        moment += s.moment[b]
        heat += s.heat[b]
    return fx, fy, moment, heat


@kernel
def _neighbour_forces(y, dy, m):
    """Each ball against the next one; adds to the derivatives, returns the heat."""
    p, d, s, at = m.p, m.d, m.s.pushed, m.s.balls
    rm, rb, count = d.pitch_radius, d.ball_radius, p.balls.count
    angle, orbit, spin = part(y, ANGLE, m), part(y, ORBIT, m), part(y, SPIN, m)
    faster, turning = part(dy, ORBIT, m), part(dy, SPIN, m)
    heat = 0.0
    s.force, s.overlap, s.energy, s.stiffness = 0.0, 0.0, 0.0, 0.0
    for b in range(count):
        k = b + 1 if b + 1 < count else 0
        between = angle[k] - angle[b] + (0.0 if b + 1 < count else 2.0 * math.pi)
        if between >= d.touch_angle:
            continue
        ex, ey = at.cosine[k] - at.cosine[b], at.sine[k] - at.sine[b]
        square = 0.25 * (ex * ex + ey * ey)  # of the sine of half the angle between them
        overlap = 2.0 * (rb - rm * math.sqrt(square))
        lever = rm * math.sqrt(1.0 - square)
        rate = lever * (orbit[b] - orbit[k])
        force, elastic = normal_and_elastic(overlap, rate, d.ball_contact)
        sliding = rb * (spin[b] + spin[k])
        mu = coefficient(sliding, d.ball_friction)
        rub = -friction_force(sliding, mu, force, m.s.step * d.side_grip)
        push = force * lever / (rm * rm * d.mass)
        faster[b] -= push
        faster[k] += push
        turning[b] -= rb * rub / d.inertia
        turning[k] -= rb * rub / d.inertia
        heat += rub * sliding + (force - elastic) * rate
        s.energy += elastic_energy(overlap, d.ball_contact)
        s.force = max(s.force, force)
        s.overlap = max(s.overlap, overlap)
        s.stiffness = max(s.stiffness, d.ball_contact.exponent * force / overlap)
    return heat


@kernel
def react(t, y, dy, m):
    """Derivative of ring and balls, and the load on journal and housing."""
    p = m.p
    j = ring.journal_on_ring(y, m, m.s.step * m.d.bore_grip)
    bx, by, moment, heat = _race_forces(y, dy, m)
    heat += _neighbour_forces(y, dy, m)
    dy[ring.RX] = y[ring.RVX]
    dy[ring.RY] = y[ring.RVY]
    dy[ring.RVX] = (bx - j.fx) / p.ring.mass
    dy[ring.RVY] = (by - j.fy) / p.ring.mass - p.gravity
    dy[ring.RANGLE] = y[ring.RW]
    dy[ring.RW] = (j.ring_moment + moment) / p.ring.inertia
    dy[ring.LOSS] = j.loss + heat
    return Load(j.fx, j.fy, j.journal_moment, -bx, -by)


@kernel
def rhs(t, y, dy, m):
    """Everything the bearing integrates within a macro step."""
    seat.copy_rates(t, y, dy, m, m.half, react(t, y, dy, m))


@kernel
def drift(x, y, v, h, m):
    """Positions in x: those in y and h (s) times the velocities in v."""
    seat.drift(x, y, v, h, m)
    ring.drift(x, y, v, h)
    n = m.p.balls.count
    for i in range(BALLS, BALLS + n):
        x[i] = y[i] + h * v[i + n]


@kernel
def forecast(x, dy, h, m):
    """Velocities of the copies at the end of a micro-step of h seconds, which is noted."""
    seat.forecast(x, dy, h)
    m.s.step = h


@kernel
def fastest(m):
    """Largest angular frequency of a body on its contacts, at the last evaluation (rad/s)."""
    d, s = m.d, m.s
    below = 0.0
    for b in range(m.p.balls.count):
        if s.balls.indentation[b] > 0.0:
            below += s.balls.elastic[b] / s.balls.indentation[b]
    below *= d.race.exponent
    if s.ring.indentation > 0.0:
        below += m.p.contact.exponent * s.ring.normal / s.ring.indentation
    return max(math.sqrt(max(below / m.p.ring.mass, 4.0 * s.pushed.stiffness / d.mass)), s.seat.fastest)


@kernel
def _largest(m):
    """(Largest force on one of a row, largest indentation) of the balls between the rings."""
    s = m.s.balls
    force, indentation = 0.0, 0.0
    for b in range(m.p.balls.count):
        force = max(force, s.force[b])
        indentation = max(indentation, s.indentation[b])
    return force / m.p.balls.rows, indentation


@kernel
def observe(t, y, m):
    """Peaks and events, after each accepted micro-step."""
    ring.watch(t, y, m)
    force, indentation = _largest(m)
    watch_balls(force, indentation, m)
    watch_contacts(m.s.pushed.force / m.p.balls.rows, m.s.pushed.overlap, m.o.neighbours)


@kernel
def report(y, m):
    """Outputs wanted once per macro step."""
    p, d, o, s = m.p, m.d, m.o, m.s.balls
    count = p.balls.count
    ring.report(y, m, d.inner_radius)
    o.balls.force, o.balls.indentation = _largest(m)
    o.neighbours.force = m.s.pushed.force / p.balls.rows
    o.neighbours.indentation = m.s.pushed.overlap
    moving = d.mass * d.pitch_radius**2
    angular, turning = part(y, ORBIT, m), part(y, SPIN, m)
    kinetic, height, stored, orbit, spin, loaded = 0.0, 0.0, 0.0, 0.0, 0.0, 0
    for b in range(count):
        kinetic += 0.5 * moving * angular[b] ** 2 + 0.5 * d.inertia * turning[b] ** 2
        height += d.pitch_radius * s.sine[b]
        orbit += angular[b]
        spin += abs(turning[b])
        if s.indentation[b] > 0.0:
            loaded += 1
            stored += 0.4 * s.elastic[b] * s.indentation[b]
    o.balls.loaded = loaded
    o.speed.orbit = orbit / count * d.pitch_radius
    o.speed.ball = spin / count * d.ball_radius
    height *= p.gravity * d.mass
    ring.report_energy(y, m, kinetic, stored + m.s.pushed.energy + height, p.ring.inertia)


@kernel
def start(words):
    """Ring and balls at rest, the first ball at its angle."""
    m = words.view(MEMORY)[0]
    y, d, count = m.q, m.d, m.p.balls.count
    seat.take_inputs(y, m)
    ring.place(y, d.rest_x, d.rest_y)
    for b in range(count):
        y[BALLS + b] = d.angles[b]
        y[BALLS + b + count], y[BALLS + b + 2 * count] = 0.0, 0.0
    m.s.step = d.micro_step
    state_constants(m)
    seat.begin(react, report, m)


@kernel
def linearise(y, j, m):
    """What is stiff: slopes of friction times load at the inner and the outer race of each ball, its
    inner contact's distance from the ring's centre (in place of its angle, orbit and spin), and the
    journal's slope on the ring.
    """
    p, d, s = m.p, m.d, m.s.balls
    n, law, gap = p.balls.count, d.race, ring.gap(y)
    size = d.inner_radius, d.ball_radius, d.mass
    way = Raceway(p.balls.play, d.run_radius, d.run_share, law.stiffness, law.damping, *size, 0.0, 0.0)
    for b in range(n):
        i = BALLS + b
        orbit = y[i + n]
        at = meet(gap, s.cosine[b], s.sine[b], orbit, y[i + 2 * n], way)
        pressed = s.force[b] + at.radius * d.mass * orbit * orbit
        j[i] = slope(at.inner, d.race_friction) * s.force[b] if s.force[b] > 0.0 else 0.0
        j[i + n] = slope(at.outer, d.race_friction) * pressed
        j[i + 2 * n] = at.lever
    bore = p.journal_radius + p.clearance
    j[ring.RW] = 0.0
    if m.s.ring.normal > 0.0:
        sliding = y[seat.JW] * p.journal_radius - y[ring.RW] * bore
        j[ring.RW] = slope(sliding, d.friction) * m.s.ring.normal * bore * bore / p.ring.inertia


@kernel
def _ball_block(inner, outer, lever, s, d):
    """s - J of a ball, [[a, g], [h, e]], and what the ring's spin brings into it, (o, q)."""
    rm, rb, mass, inertia = d.pitch_radius, d.ball_radius, d.mass, d.inertia
    a = s + (inner + outer) / mass
    g = (outer - inner) * rb / (rm * mass)
    h = (outer - inner) * rb * rm / inertia
    e = s + (inner + outer) * rb * rb / inertia
    return a, g, h, e, inner * lever / (rm * mass), -inner * lever * rb / inertia


@kernel
def solve(j, s, r, m):
    """Overwrite r with the solution of (s - J) x = r, J that of the balls' and the ring's turning.

    J is an arrow: each ball's orbit and spin are tied to each other and to the ring's spin only. So the
    balls are eliminated one by one, the ring is solved for, and its share handed back to them.
    """
    p, d = m.p, m.d
    rm, rb, n = d.pitch_radius, d.ball_radius, p.balls.count
    pivot, right = s + j[ring.RW], r[ring.RW]
    for i in range(BALLS, BALLS + n):
        inner, outer, lever = j[i], j[i + n], j[i + 2 * n]
        a, g, h, e, o, q = _ball_block(inner, outer, lever, s, d)
        scale = 1.0 / (a * e - g * h)
        x, z = (e * r[i + n] - g * r[i + 2 * n]) * scale, (a * r[i + 2 * n] - h * r[i + n]) * scale
        xo, zo = (e * o - g * q) * scale, (a * q - h * o) * scale
        r[i], r[i + n], r[i + 2 * n] = r[i] / s, x, z
        back = inner * lever / p.ring.inertia
        pivot += back * (lever - rm * xo + rb * zo)
        right += back * (rm * x - rb * z)
    turned = right / pivot
    for i in range(BALLS, BALLS + n):
        a, g, h, e, o, q = _ball_block(j[i], j[i + n], j[i + 2 * n], s, d)
        scale = turned / (a * e - g * h)
        r[i + n] += (e * o - g * q) * scale
        r[i + 2 * n] += (a * q - h * o) * scale
    for i in range(BALLS):
        r[i] /= s
    for i in range(m.s.seat.inside, m.n):
        r[i] /= s
    r[ring.RW] = turned


@kernel
def integrate(m, work, span):
    """Advance the state by `span` (s)."""
    tolerance, longest = m.p.interface.tolerance, m.d.micro_step
    if longest > 0.0:
        status, evaluations = verlet.integrate(
            rhs, drift, forecast, fastest, observe, m, m.q, m.n, work, span, longest
        )
        return m.h, status, evaluations
    return rosenbrock.integrate(
        rhs, linearise, solve, observe, m, m.q, m.n, m.weight, work, span, m.h, tolerance
    )


@kernel
def instant(t, y, dy, m):
    """Derivative and load under the motion m.u, friction as it stands."""
    m.s.step = 0.0
    seat.instant(react, t, y, dy, m)


@kernel
def advance(words, work, time, step):
    """One macro step."""
    rows = work.ravel().view(SCRATCH)[0].rows
    m = words.view(MEMORY)[0]
    return seat.advance(react, integrate, report, words, m, rows, time, step)


def derive(p: Parameters) -> Derived:
    """Stiffness and masses from geometry, and where everything starts."""
    b = p.balls
    rest_x, rest_y = b.resting_place(p.ring.mass * p.gravity)
    race, touching = b.race_law(b.series_stiffness()), damped(abreast(p.ball_contact, b.rows), b.ball_mass)
    hit = [(p.contact, p.ring.mass), (race, p.ring.mass), (touching, 0.5 * b.ball_mass)]
    spun = b.ball_radius**2 / b.ball_inertia
    bore = p.journal_radius + p.clearance
    of_ring = 1.0 / p.ring.mass + b.inner_radius**2 / p.ring.inertia
    run_radius, run_share = {
        NOMINAL: (b.pitch_radius, 0.0),
        CORRECTED: (b.pitch_radius + 0.5 * b.play, b.outer_share),
        AS_PRINTED: (b.pitch_radius, -0.5),
    }[p.corrected_pitch]
    return Derived(
        contact=damped(p.contact, p.ring.mass),
        friction=prepared(p.friction),
        race_friction=prepared(p.race_friction),
        ball_contact=touching,
        ball_friction=prepared(p.ball_friction),
        race=race,
        stiffness=race_stiffness(b),
        size=Coordinates(coordinates=5 + 2 * b.count, ball_ball=b.count, rings=b.count),
        mass=b.ball_mass,
        inertia=b.ball_inertia,
        ball_radius=b.ball_radius,
        pitch_radius=b.pitch_radius,
        inner_radius=b.inner_radius,
        touch_angle=b.touch_angle,
        run_radius=run_radius,
        run_share=run_share,
        micro_step=resolved_step(p.micro_step, hit),
        bore_grip=1.0 / p.ring.mass + bore**2 / p.ring.inertia,
        # both races of a ball: its orbit and its spin answer one each at most; half of the balls are loaded
        race_grip=2.0 * max(1.0 / b.ball_mass, spun) + 0.5 * b.count * of_ring,
        side_grip=4.0 * spun,
        rest_x=rest_x,
        rest_y=rest_y,
        angles=tuple(b.angles() + [0.0] * (MOST_BALLS - b.count)),
    )


def check(p: Parameters) -> str | None:
    """What is wrong between the parameters."""
    laws = {
        "friction": p.friction,
        "race_friction": p.race_friction,
        "ball_friction": p.ball_friction,
    }
    found = [p.balls.problem(), *(friction_problem(law, name) for name, law in laws.items())]
    return next((text for text in found if text), None)


def weights(p: Parameters) -> np.ndarray:
    """Error weights of the state."""
    b = p.balls
    scales = b.pitch_radius / seat.POSITION_SCALE, 1.0 / ORBIT_SCALE, 1.0 / BALL_SPIN_SCALE
    return seat.weights(ring.error_weights() + [w for w in scales for _ in range(b.count)])


MODEL = Model(
    name="simplified_cageless",
    title="Simplified cageless touchdown bearing",
    about="Full-complement ball bearing: one ring on springs at the balls, each of them with its "
    "angle and spin",
    parameters=Parameters,
    inputs=seat.BearingInputs,
    outputs=Outputs,
    derived=Derived,
    hidden=Hidden,
    memory=MEMORY,
    start=start,
    advance=advance,
    weights=weights,
    derive=derive,
    check=check,
    instant=instant,
    starts_from=starts_from("coordinates", "ball_ball", "rings"),
)
