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
- Friction moment and gaps act at the ring's actual place, so that action equals reaction.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from bearings import ring, seat
from bearings.balls import MOST_BALLS, Coordinates, watch_balls
from bearings.cage import Cage
from bearings.contact import ContactLaw, elastic_energy, elastic_force
from bearings.friction import prepared
from bearings.friction import problem as friction_problem
from bearings.rolling import (
    RollingDerived,
    RollingMemory,
    RollingOutputs,
    RollingParameters,
    race_stiffness,
    starts_from,
    state_constants,
)
from modelkit import dopri
from modelkit.kernel import kernel
from modelkit.model import Model, memory_layout
from modelkit.ports import Load
from modelkit.variables import array, group, real

ROLLING_EXPONENT = 0.55  # of the load over the static rating, in the friction moment


@dataclass(frozen=True)
class Rolling:
    """Friction moment of the rolling bearing, M = f1 (F/C0)^0.55 F d_m (Harris)."""

    f1: float = real(5e-4, "1", "factor f1", minimum=0.0)
    static_rating: float = real(5000.0, "N", "static load rating C0", above=0.0)
    slope: float = real(100.0, "s/m", "steepness of the moment through zero race speed", above=0.0)


@dataclass(frozen=True)
class Parameters(RollingParameters):
    """Defaults: SKF 6004 under the disk of section 4.3."""

    damping: float = real(0.0, "N.s/m", "damping between the rings, also out of contact (2.7)", minimum=0.0)
    cage: Cage = group(Cage)
    rolling: Rolling = group(Rolling)


@dataclass(frozen=True)
class Speeds(ring.RaceSpeeds):
    """Circumferential speeds that agree where nothing slips (4.2; the source's Figs 25 and 26)."""

    cage: float = real(0.0, "m/s", "circumferential speed of the cage on the pitch circle", local=True)
    ball: float = real(0.0, "m/s", "circumferential speed of the balls by their spin", local=True)


@dataclass(frozen=True)
class Outputs(RollingOutputs):
    """Loads, and what to know of the inside."""

    speed: Speeds = group(Speeds)


@dataclass(frozen=True)
class Derived(RollingDerived):
    """What parameters fix."""

    race: ContactLaw = group(ContactLaw)
    inertia: float = real(0.0, "kg.m2", "equivalent moment of inertia of the ring (4.3)")
    cage_ratio: float = real(0.0, "1", "cage speed over ring speed (4.2)")
    ball_ratio: float = real(0.0, "1", "ball spin over ring speed (4.2)")
    cosine: tuple = array(MOST_BALLS)
    sine: tuple = array(MOST_BALLS)


@dataclass(frozen=True)
class BallMemory:
    """Loaded balls at the last evaluation."""

    loaded: float = real(0.0, "1", "how many")
    force: float = real(0.0, "N", "largest")
    indentation: float = real(0.0, "m", "largest")
    energy: float = real(0.0, "J", "stored in them")


@dataclass(frozen=True)
class Hidden(RollingMemory):
    """Memory between evaluations and steps."""

    balls: BallMemory = group(BallMemory)


MEMORY = memory_layout(Parameters, seat.BearingInputs, Outputs, ring.NEXT, derived=Derived, hidden=Hidden)


@kernel
def _ball_forces(ex, ey, ux, uy, cage_angle, m):
    """Force on the ring (N) and moment about the cage (N m) by the balls; heat in W.

    (ex, ey), (ux, uy): position and velocity of the ring from the housing.
    """
    law, play, count = m.d.race, m.p.balls.play, m.p.balls.count
    s = m.s.balls
    s.loaded, s.force, s.indentation, s.energy = 0.0, 0.0, 0.0, 0.0
    fx, fy, moment, heat = 0.0, 0.0, 0.0, 0.0
    if play >= 0.0 and ex * ex + ey * ey <= play * play:
        return fx, fy, moment, heat
    ca, sa = math.cos(cage_angle), math.sin(cage_angle)
    for b in range(count):
        c0, s0 = m.d.cosine[b], m.d.sine[b]
        nx, ny = ca * c0 - sa * s0, sa * c0 + ca * s0
        indentation = ex * nx + ey * ny - play
        if indentation <= 0.0:
            continue
        rate = ux * nx + uy * ny
        elastic = elastic_force(indentation, law)
        force = max(elastic + law.damping * indentation * rate, 0.0)
        fx -= force * nx
        fy -= force * ny
        # the ball moves along t = (-ny, nx) into the narrowing gap, which the source leaves out
        moment -= elastic * (ey * nx - ex * ny)
        heat += (force - elastic) * rate
        s.loaded += 1.0
        s.energy += 0.4 * elastic * indentation
        if force > s.force:
            s.force = force
        if indentation > s.indentation:
            s.indentation = indentation
    return fx, fy, moment, heat


@kernel
def react(t, y, dy, m):
    """Derivative of the ring's motion, and the load on journal and housing."""
    p, d = m.p, m.d
    j = ring.journal_on_ring(y, m)
    ex, ey = y[ring.RX] - y[seat.HX], y[ring.RY] - y[seat.HY]
    ux, uy = y[ring.RVX] - y[seat.HVX], y[ring.RVY] - y[seat.HVY]
    bx, by, wedge, heat = _ball_forces(ex, ey, ux, uy, d.cage_ratio * y[ring.RANGLE], m)
    load = math.sqrt(bx * bx + by * by)
    moment = p.rolling.f1 * (load / p.rolling.static_rating) ** ROLLING_EXPONENT * load
    moment *= p.balls.pitch_diameter * math.tanh(p.rolling.slope * y[ring.RW] * d.inner_radius)
    bx -= p.damping * ux
    by -= p.damping * uy
    dy[ring.RX] = y[ring.RVX]
    dy[ring.RY] = y[ring.RVY]
    dy[ring.RVX] = (bx - j.fx) / p.ring.mass
    dy[ring.RVY] = (by - j.fy) / p.ring.mass - p.gravity
    dy[ring.RANGLE] = y[ring.RW]
    dy[ring.RW] = (j.ring_moment + d.cage_ratio * wedge - moment) / d.inertia
    dy[ring.LOSS] = j.loss + heat + moment * y[ring.RW] + p.damping * (ux * ux + uy * uy)
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


@kernel
def report(y, m):
    """Outputs wanted once per macro step."""
    p, d, o, s = m.p, m.d, m.o, m.s.balls
    ring.report(y, m, d.inner_radius)
    o.balls.loaded = int(s.loaded)
    o.balls.force, o.balls.indentation = s.force, s.indentation
    o.speed.cage = d.cage_ratio * y[ring.RW] * 0.5 * p.balls.pitch_diameter
    o.speed.ball = abs(d.ball_ratio * y[ring.RW]) * 0.5 * p.balls.diameter
    speed2 = y[ring.RVX] ** 2 + y[ring.RVY] ** 2
    o.energy.kinetic = 0.5 * p.ring.mass * speed2 + 0.5 * d.inertia * y[ring.RW] ** 2
    stored = s.energy + elastic_energy(m.s.ring.indentation, p.contact)
    o.energy.potential = stored + p.ring.mass * p.gravity * y[ring.RY]
    o.energy.dissipated = y[ring.LOSS]


@kernel
def start(words):
    """The ring at rest on the balls, the first of them at its angle."""
    m = words.view(MEMORY)[0]
    y, d = m.y, m.d
    seat.take_inputs(y, m)
    ring.place(y, d.rest_x, d.rest_y)
    state_constants(m)
    seat.begin(react, report, m)


@kernel
def integrate(m, work, span):
    """Advance the state by `span` (s)."""
    tolerance = m.p.interface.tolerance
    return dopri.integrate(rhs, observe, m, m.y, m.n, m.weight, work, span, m.h, tolerance)


@kernel
def instant(t, y, dy, m):
    """Derivative and load under the motion m.u."""
    seat.instant(react, t, y, dy, m)


@kernel
def advance(words, work, time, step):
    """One macro step."""
    return seat.advance(react, integrate, report, words.view(MEMORY)[0], work, time, step)


def derive(p: Parameters) -> Derived:
    """Stiffness, inertia and ratios from geometry."""
    b = p.balls
    cage_ratio = 0.5 * b.inner_radius / b.pitch_radius
    ball_ratio = -0.5 * b.inner_radius / b.ball_radius
    cage_inertia = p.cage.mass * b.pitch_radius**2
    orbiting = cage_inertia + b.count * b.ball_mass * b.pitch_radius**2
    spinning = b.count * b.ball_inertia
    angles = b.angles()
    rest_x, rest_y = b.resting_place(p.ring.mass * p.gravity)
    unused = [0.0] * (MOST_BALLS - b.count)
    return Derived(
        friction=prepared(p.friction),
        race=ContactLaw(stiffness=b.series_stiffness(), damping=b.damping),
        stiffness=race_stiffness(b),
        size=Coordinates(coordinates=5, rings=b.count),
        inertia=p.ring.inertia + orbiting * cage_ratio**2 + spinning * ball_ratio**2,
        cage_ratio=cage_ratio,
        ball_ratio=ball_ratio,
        inner_radius=b.inner_radius,
        rest_x=rest_x,
        rest_y=rest_y,
        cosine=tuple([math.cos(a) for a in angles] + unused),
        sine=tuple([math.sin(a) for a in angles] + unused),
    )


def check(p: Parameters) -> str | None:
    """What is wrong between the parameters."""
    return p.balls.problem() or friction_problem(p.friction, "friction")


def weights(p: Parameters) -> np.ndarray:
    """Error weights of the state."""
    return seat.weights(ring.error_weights())


MODEL = Model(
    name="simplified_caged",
    title="Simplified caged touchdown bearing",
    about="Ball bearing with cage as one ring on springs at the balls, which follow it without slip",
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
    starts_from=starts_from("rings"),
)
