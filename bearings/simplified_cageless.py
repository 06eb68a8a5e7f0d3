"""Simplified touchdown bearing without a cage (section 2.1 of the source, harmonised as in 4.3).

The inner ring has three coordinates; each ball has its attitude angle and its spin (2.4). Where a ball
is pressed between the rings, one spring in series stands for both of its contacts (2.5, 2.6); friction
at both drives the ball along the race (2.10) and spins it (2.11); neighbours push and rub (2.8).

All angles and spins are counter-clockwise here (the source counts a ball's spin clockwise). With n the
outward and t = (-n_y, n_x) the tangential direction at a ball, s_i and s_o the sliding speeds at the
inner and outer race:

    r_m m gamma'' = mu(s_i) F + mu(s_o) F_o + H_b - H_(b+1) - g m cos(gamma) - F (e . t)/r_m     (2.10)
    I theta''     = r_b (mu(s_o) F_o - mu(s_i) F) - r_b mu_bb (H_b + H_(b+1))                      (2.11)

with F and F_o as in `bearings.pitch_circle`.

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

Friction on a ball of half a gram is stiff (1e7 per second under load), everything else is not; so the
state is advanced by a linearly implicit method whose matrix holds the slopes of friction only.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from bearings import ring, seat
from bearings.balls import MOST_BALLS, BallContacts, Coordinates, FreeBallSet, watch_balls, watch_contacts
from bearings.contact import ContactLaw, damped, elastic_energy, elastic_force, normal_force
from bearings.friction import FrictionLaw, coefficient, prepared, slope
from bearings.friction import problem as friction_problem
from bearings.pitch_circle import LoadedBalls, between_races, clear, note
from bearings.rolling import (
    RollingDerived,
    RollingMemory,
    RollingOutputs,
    RollingParameters,
    race_stiffness,
    starts_from,
    state_constants,
)
from modelkit import rosenbrock
from modelkit.kernel import kernel
from modelkit.model import Model
from modelkit.ports import Interface, Load
from modelkit.variables import array, group, integer, real

BALLS = ring.NEXT  # three components a ball from here: attitude angle, its rate, spin
BALL_SPIN_SCALE = 1e3  # rad/s
ORBIT_SCALE = 100.0  # rad/s; a ball's speed along the race over its radius

NOMINAL, CORRECTED, AS_PRINTED = range(3)


@dataclass(frozen=True)
class Parameters(RollingParameters):
    """Defaults: Koyo 6904 under the disk of section 4.3, pitch diameter corrected to 28.5 mm."""

    interface: Interface = group(Interface, tolerance=2e-5)
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
    mass: float = real(0.0, "kg", "of a ball")
    inertia: float = real(0.0, "kg.m2", "of a ball")
    ball_radius: float = real(0.0, "m", "of a ball")
    pitch_radius: float = real(0.0, "m", "where ball centres run")
    touch_angle: float = real(0.0, "rad", "between neighbours that just touch")
    outer_share: float = real(0.0, "1", "of the rings' approach, at the outer race")
    angles: tuple = array(MOST_BALLS)


@dataclass(frozen=True)
class PushedBalls:
    """Balls that push each other, at the last evaluation."""

    force: float = real(0.0, "N", "largest")
    overlap: float = real(0.0, "m", "largest")
    energy: float = real(0.0, "J", "stored in the contacts")


@dataclass(frozen=True)
class Hidden(RollingMemory):
    """Memory between evaluations and steps."""

    balls: LoadedBalls = group(LoadedBalls)
    pushed: PushedBalls = group(PushedBalls)


MEMORY = seat.bearing_memory(Parameters, Outputs, BALLS + 3 * MOST_BALLS, derived=Derived, hidden=Hidden)


@kernel
def _pitch_radius(gap, c, sn, m):
    """Radius on which a ball's centre runs (m): the pitch circle's, or as (5.1) corrects it."""
    p, d = m.p, m.d
    if p.corrected_pitch == NOMINAL:
        return d.pitch_radius
    approach = max(gap.ex * c + gap.ey * sn - p.balls.play, 0.0)
    if p.corrected_pitch == AS_PRINTED:
        return d.pitch_radius - 0.5 * approach
    return d.pitch_radius + 0.5 * p.balls.play + d.outer_share * approach


@kernel
def _race_forces(y, dy, m):
    """Ring against balls against housing: (force on the ring x, y; moment on it; heat).

    Sets the derivatives of the balls' angles, speeds and spins as far as races and gravity go.
    """
    p, d = m.p, m.d
    gap = ring.gap(y)
    fx, fy, moment, heat = 0.0, 0.0, 0.0, 0.0
    for b in range(p.balls.count):
        i = BALLS + 3 * b
        c, sn = math.cos(y[i]), math.sin(y[i])
        rm = _pitch_radius(gap, c, sn, m)
        ball = between_races(gap, c, sn, y[i + 1], y[i + 2], rm, m)
        if ball.indentation > 0.0:
            note(m.s.balls, ball)
            fx -= ball.force * c - ball.inner * sn
            fy -= ball.force * sn + ball.inner * c
            moment -= ball.inner * ball.lever
        heat += ball.heat
        along = ball.inner + ball.outer - ball.wedge - p.gravity * d.mass * c
        if p.as_printed == 1:
            along += (ball.outer - ball.inner) * d.ball_radius / rm
        dy[i] = y[i + 1]
        dy[i + 1] = along / (rm * d.mass)
        dy[i + 2] = d.ball_radius * (ball.outer - ball.inner) / d.inertia
    return fx, fy, moment, heat


@kernel
def _neighbour_forces(y, dy, m):
    """Each ball against the next one; adds to the derivatives, returns the heat."""
    p, d, s = m.p, m.d, m.s.pushed
    rm, rb, count = d.pitch_radius, d.ball_radius, p.balls.count
    heat = 0.0
    for b in range(count):
        i = BALLS + 3 * b
        k = i + 3 if b + 1 < count else BALLS
        between = y[k] - y[i] + (0.0 if b + 1 < count else 2.0 * math.pi)
        if between >= d.touch_angle:
            continue
        half = 0.5 * between
        overlap = 2.0 * (rb - rm * math.sin(half))
        lever = rm * math.cos(half)
        rate = lever * (y[i + 1] - y[k + 1])
        elastic = elastic_force(overlap, p.ball_contact)
        force = normal_force(overlap, rate, d.ball_contact)
        sliding = rb * (y[i + 2] + y[k + 2])
        rub = coefficient(sliding, d.ball_friction) * force
        push = force * lever / (rm * rm * d.mass)
        dy[i + 1] -= push
        dy[k + 1] += push
        dy[i + 2] -= rb * rub / d.inertia
        dy[k + 2] -= rb * rub / d.inertia
        heat += rub * sliding + (force - elastic) * rate
        s.energy += elastic_energy(overlap, p.ball_contact)
        if force > s.force:
            s.force = force
        if overlap > s.overlap:
            s.overlap = overlap
    return heat


@kernel
def react(t, y, dy, m):
    """Derivative of ring and balls, and the load on journal and housing."""
    p, s = m.p, m.s.pushed
    clear(m.s.balls)
    s.force, s.overlap, s.energy = 0.0, 0.0, 0.0
    j = ring.journal_on_ring(y, m)
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
def observe(t, y, m):
    """Peaks and events, after each accepted micro-step."""
    ring.watch(t, y, m)
    watch_balls(m.s.balls.force, m.s.balls.indentation, m)
    watch_contacts(m.s.pushed.force, m.s.pushed.overlap, m.o.neighbours)


@kernel
def report(y, m):
    """Outputs wanted once per macro step."""
    p, d, o, s = m.p, m.d, m.o, m.s.balls
    ring.report(y, m, d.inner_radius)
    o.balls.loaded = int(s.loaded)
    o.balls.force, o.balls.indentation = s.force, s.indentation
    o.neighbours.force, o.neighbours.indentation = m.s.pushed.force, m.s.pushed.overlap
    moving = d.mass * d.pitch_radius**2
    kinetic, height, orbit, spin = 0.0, 0.0, 0.0, 0.0
    for b in range(p.balls.count):
        i = BALLS + 3 * b
        kinetic += 0.5 * moving * y[i + 1] ** 2 + 0.5 * d.inertia * y[i + 2] ** 2
        height += d.pitch_radius * math.sin(y[i])
        orbit += y[i + 1]
        spin += abs(y[i + 2])
    o.speed.orbit = orbit / p.balls.count * d.pitch_radius
    o.speed.ball = spin / p.balls.count * d.ball_radius
    height *= p.gravity * d.mass
    ring.report_energy(y, m, kinetic, s.energy + m.s.pushed.energy + height, p.ring.inertia)


@kernel
def start(words):
    """Ring and balls at rest, the first ball at its angle."""
    m = words.view(MEMORY)[0]
    y, d = m.y, m.d
    seat.take_inputs(y, m)
    ring.place(y, d.rest_x, d.rest_y)
    for b in range(m.p.balls.count):
        y[BALLS + 3 * b] = d.angles[b]
        y[BALLS + 3 * b + 1] = 0.0
        y[BALLS + 3 * b + 2] = 0.0
    state_constants(m)
    seat.begin(react, report, m)


@kernel
def linearise(y, j, m):
    """What is stiff: slopes of friction times load at the inner (j[i]) and outer race (j[i + 1]) of each
    ball, its inner contact's distance from the ring's centre (j[i + 2]), and the journal's on the ring.
    """
    p, d = m.p, m.d
    rm, rb, play = d.pitch_radius, d.ball_radius, p.balls.play
    ex, ey = y[ring.RX] - y[seat.HX], y[ring.RY] - y[seat.HY]
    ux, uy = y[ring.RVX] - y[seat.HVX], y[ring.RVY] - y[seat.HVY]
    for b in range(p.balls.count):
        i = BALLS + 3 * b
        c, sn = math.cos(y[i]), math.sin(y[i])
        orbit, spin = y[i + 1], y[i + 2]
        indentation = ex * c + ey * sn - play
        force, inner = 0.0, 0.0
        j[i + 2] = d.inner_radius - ex * c - ey * sn
        if indentation > 0.0:
            force = elastic_force(indentation, d.race)
            sliding = y[ring.RW] * j[i + 2] + uy * c - ux * sn - rm * orbit + rb * spin
            inner = slope(sliding, d.race_friction) * force
        pressed = force + rm * d.mass * orbit * orbit
        j[i] = inner
        j[i + 1] = slope(rm * orbit + rb * spin, d.race_friction) * pressed
    bore = p.journal_radius + p.clearance
    j[ring.RW] = 0.0
    if m.s.ring.normal > 0.0:
        sliding = y[seat.JW] * p.journal_radius - y[ring.RW] * bore
        j[ring.RW] = slope(sliding, d.friction) * m.s.ring.normal * bore * bore / p.ring.inertia


@kernel
def _ball_block(i, j, s, d):
    """s - J of the ball at state i, [[a, g], [h, e]], and what the ring's spin brings into it, (o, q)."""
    rm, rb, mass, inertia = d.pitch_radius, d.ball_radius, d.mass, d.inertia
    inner, outer, lever = j[i], j[i + 1], j[i + 2]
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
    rm, rb = d.pitch_radius, d.ball_radius
    pivot, right = s + j[ring.RW], r[ring.RW]
    for b in range(p.balls.count):
        i = BALLS + 3 * b
        a, g, h, e, o, q = _ball_block(i, j, s, d)
        scale = 1.0 / (a * e - g * h)
        x, z = (e * r[i + 1] - g * r[i + 2]) * scale, (a * r[i + 2] - h * r[i + 1]) * scale
        xo, zo = (e * o - g * q) * scale, (a * q - h * o) * scale
        r[i], r[i + 1], r[i + 2] = r[i] / s, x, z
        lever = j[i + 2]
        back = j[i] * lever / p.ring.inertia
        pivot += back * (lever - rm * xo + rb * zo)
        right += back * (rm * x - rb * z)
    turned = right / pivot
    for b in range(p.balls.count):
        i = BALLS + 3 * b
        a, g, h, e, o, q = _ball_block(i, j, s, d)
        scale = turned / (a * e - g * h)
        r[i + 1] += (e * o - g * q) * scale
        r[i + 2] += (a * q - h * o) * scale
    for i in range(BALLS):
        r[i] /= s
    for i in range(m.s.seat.inside, m.n):
        r[i] /= s
    r[ring.RW] = turned


@kernel
def integrate(m, work, span):
    """Advance the state by `span` (s)."""
    tolerance = m.p.interface.tolerance
    return rosenbrock.integrate(
        rhs, linearise, solve, observe, m, m.y, m.n, m.weight, work, span, m.h, tolerance
    )


@kernel
def instant(t, y, dy, m):
    """Derivative and load under the motion m.u."""
    seat.instant(react, t, y, dy, m)


@kernel
def advance(words, work, time, step):
    """One macro step."""
    return seat.advance(react, integrate, report, words.view(MEMORY)[0], work, time, step)


def derive(p: Parameters) -> Derived:
    """Stiffness and masses from geometry, and where everything starts."""
    b = p.balls
    rest_x, rest_y = b.resting_place(p.ring.mass * p.gravity)
    return Derived(
        contact=damped(p.contact, p.ring.mass),
        friction=prepared(p.friction),
        race_friction=prepared(p.race_friction),
        ball_contact=damped(p.ball_contact, b.ball_mass),
        ball_friction=prepared(p.ball_friction),
        race=b.race_law(b.series_stiffness()),
        stiffness=race_stiffness(b),
        size=Coordinates(coordinates=5 + 2 * b.count, ball_ball=b.count, rings=b.count),
        mass=b.ball_mass,
        inertia=b.ball_inertia,
        ball_radius=b.ball_radius,
        pitch_radius=b.pitch_radius,
        inner_radius=b.inner_radius,
        touch_angle=b.touch_angle,
        outer_share=b.outer_share,
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
    ball = [b.pitch_radius / seat.POSITION_SCALE, 1.0 / ORBIT_SCALE, 1.0 / BALL_SPIN_SCALE]
    return seat.weights(ring.error_weights() + ball * b.count)


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
