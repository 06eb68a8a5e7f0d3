"""Balls and cage that follow the inner ring without slip (Halminen (2016), 4.2).

A rolling-bearing friction moment (Harris) and the balls' rolling resistance brake the ring, and the inertia
of balls and cage is added to its own (4.3). (4.3) prints a minus before the inertia of the balls; kinetic
energy is quadratic in their spin, so it is a plus.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from ...modelkit.kernel import kernel
from ...modelkit.numerics import squared
from ...modelkit.variables import array, group, real
from ..contact.laws import ContactLaw
from ..heat import shares
from ..heat.shares import Sources
from . import declarations, ring
from .ball_set import (
    EVEN_SPREAD,
    MAX_BALLS,
    ball_mass,
    series_dissipation,
    set_race_law,
    solid_ball_inertia,
    start_angle,
)
from .balls import Total
from .bending import BendingMemory
from .declarations import RollingDerived
from .pitch_circle import LoadedBalls, RollingResistance, rolling_drag

ROLLING_EXPONENT = 0.55  # of the load over the static rating, in the friction moment
# rad/s, to which frequencies of the ring's modes are lowered, with the compliance kept: the load of balls
# is nearly a static matter, and the fastest of them would bound the adaptive steps
FASTEST_BENDING = 1.2e5


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
class FollowerParameters:
    """Parameters of a ring that balls and cage follow, beside those of all rolling bearings."""

    damping: float = real(0.0, "N.s/m", "damping between the rings, also out of contact (2.7)", minimum=0.0)
    cage: Cage = group(Cage)
    rolling: Rolling = group(Rolling)


@dataclass(frozen=True)
class FollowerSpeeds(ring.RaceSpeeds):
    """Circumferential speeds that agree where nothing slips (Halminen (2016), 4.2, Figs 25 and 26)."""

    cage: float = real(0.0, "m/s", "circumferential speed of the cage on the pitch circle", local=True)
    ball: float = real(0.0, "m/s", "circumferential speed of the balls by their spin", local=True)


@dataclass(frozen=True)
class FollowerDerived(RollingDerived):
    """Constants that follow from the parameters."""

    race: ContactLaw = group(ContactLaw)
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


@dataclass(frozen=True)
class FollowerMemory:
    """Memory between evaluations and steps, beside that of all rolling bearings."""

    balls: LoadedBalls = group(LoadedBalls)
    shape: BendingMemory = group(BendingMemory)


@kernel
def friction_load(load, abreast, p):
    """f1 (F/C0)^0.55 F (N) of a row under a `load` F (N), or of those `abreast` together."""
    if load <= 0.0 or p.rolling.f1 <= 0.0:
        return 0.0
    return p.rolling.f1 * (load / (abreast * p.rolling.static_rating)) ** ROLLING_EXPONENT * load


@kernel
def braked(springs, friction, q, m):
    """`Total` (N, N m, W) on a ring that turns with cage and balls, and is pressed by `springs`.

    springs: `Total`, its moment on the cage; friction: sum of all rows' `friction_load` (N). The heat at
    the outer race is kept in m.s.balls.
    """
    p, d = m.p, m.d
    moment = friction * (p.balls.pitch_diameter * math.tanh(p.rolling.slope * q[ring.RW] * d.inner_radius))
    if p.rolling.resistance > 0.0:
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
def share_follower_heat(dq, journal, bent, balls, damped, faces, m):
    """Set in dq all heat but that of faces, and the heat of each part (W).

    Of the journal's `Touch`, of bending, of the balls' `Total`, of damping between the rings, of faces.
    """
    outside = m.s.balls.outside
    dq[ring.LOSS] = journal.loss + balls.loss + bent + damped
    inside, outside = balls.loss - outside + 0.5 * damped, outside + 0.5 * damped
    sources = Sources(journal.loss + faces, bent, inside, outside, 0.0)
    shares.set_rates(sources, journal.sliding, dq, ring.HEAT)


@kernel
def derive(m):
    """Set in m.d what parameters fix, where cage and balls follow the ring."""
    d, b = m.d, m.p.balls
    declarations.derive(m, EVEN_SPREAD)
    d.mass = ball_mass(b)
    set_race_law(d.race, b, d.stiffness.series, d.mass, series_dissipation(d.stiffness))
    d.size.coordinates, d.size.rings = 5, b.count
    for i in range(b.count):
        angle = start_angle(b.first_angle, b.count, EVEN_SPREAD, i)
        d.cosine[i], d.sine[i] = math.cos(angle), math.sin(angle)


@kernel
def derive_turning(m):
    """Set in m.d what turns, once it has the race's radius: inertia, ratios of speeds."""
    p, d, b = m.p, m.d, m.p.balls
    d.ball_radius, d.pitch_radius = 0.5 * b.diameter, 0.5 * b.pitch_diameter
    d.cage_ratio = 0.5 * d.inner_radius / d.pitch_radius
    d.ball_ratio = -0.5 * d.inner_radius / d.ball_radius
    square = squared(d.pitch_radius)
    d.orbiting = p.cage.mass * square + b.count * d.mass * square
    d.spinning = b.count * solid_ball_inertia(d.mass, b.diameter)
    d.ring_inertia = p.ring.inertia
    d.ring_inertia += d.orbiting * squared(d.cage_ratio) + d.spinning * squared(d.ball_ratio)
