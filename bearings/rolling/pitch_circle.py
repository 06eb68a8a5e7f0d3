"""A ball whose centre runs on the pitch circle, between both races: what the simplified models share.

One spring in series stands for both contacts (2.5, 2.6). With n the outward and t = (-n_y, n_x) the
tangential direction at the ball, e the ring's place from the bearing's middle, F the force of the spring
and s_i, s_o the sliding speeds at the inner and the outer race:

    F_o = F + r_m m gamma'^2                                                                       (2.9)
    along t, on the ball:    mu(s_i) F + mu(s_o) F_o - F (e . t)/r_m

The last term is that of a ball driven into the narrowing gap; Halminen (2016) leaves it out, and without
it the model creates energy.

Rolling resistance, read from the second term of (2.10): a ball that orbits is held back along its race by
a coefficient times F + F_o. The force acts between the ball and the outer race, at the ball's centre; its
moment about the middle goes to the housing, which takes no moments here, and its work is heat. The
printed factor r_b/r_m is left out: with it the rotor of Halminen (2016) would run down 6 times too slowly.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

from ...modelkit.kernel import inlined, kernel
from ...modelkit.variables import integer, real
from ..contact.friction import coefficient
from ..contact.pair import damped_normal

REVERSAL_SPEED = 0.05  # m/s; a ball's speed along the race around which rolling resistance changes its sign


@dataclass(frozen=True)
class RollingResistance:
    """Loss of the rolling balls."""

    resistance: float = real(
        0.0,
        "1",
        "rolling resistance coefficient: drag force on a ball along its race over the sum of its normal "
        "forces on both races",
        minimum=0.0,
    )


class RingMotion(NamedTuple):
    """The inner ring as balls meet it: place from the middle (m), velocity (m/s), spin (rad/s)."""

    ex: float
    ey: float
    ux: float
    uy: float
    spin: float


class NormalLoads(NamedTuple):
    """Forces at one ball, without friction, in N."""

    force: float  # between the rings
    elastic: float
    outer: float  # on the outer race, with what the ball's orbit adds
    held: float  # of the narrowing gap and of rolling resistance on the ball, against t
    drag: float  # the latter alone


class BallLoads(NamedTuple):
    """Loads at one ball in N, heat in W."""

    force: float  # between the rings
    elastic: float
    indentation: float  # approach of the rings, m
    inner: float  # friction of the inner race on the ball, along t
    outer: float  # friction of the outer race on the ball, along t
    held: float  # of the narrowing gap and of rolling resistance on the ball, against t
    lever: float  # of the inner contact from the ring's centre, m
    heat: float
    outside: float  # what of it arises at the outer race


@dataclass(frozen=True)
class LoadedBalls:
    """Balls pressed by both rings, at the last evaluation."""

    loaded: float = real(0.0, "1", "how many")
    force: float = real(0.0, "N", "largest")
    total: float = real(0.0, "N", "of all forces between the rings")
    indentation: float = real(0.0, "m", "largest")
    energy: float = real(0.0, "J", "stored in the contacts")
    outside: float = real(0.0, "W", "what of the balls' heat arises at the outer race")
    most_loaded: int = integer(0, "which ball bears the largest force")
    deepest: int = integer(0, "at which ball the rings come closest")


class Raceway(NamedTuple):
    """Data of balls and races for loops over the balls."""

    play: float  # m
    radius: float  # on which a ball's centre runs, m
    share: float  # of the rings' approach by which that radius grows
    stiffness: float  # N/m^1.5, of both contacts in series
    damping: float  # N s/m2
    inner_radius: float  # m
    ball_radius: float  # m
    mass: float  # kg, of a ball
    resistance: float  # of rolling, force over force


class Meeting(NamedTuple):
    """How a ball lies and slides between the races."""

    indentation: float  # approach of the rings, m
    rate: float  # m/s
    radius: float  # on which the ball's centre runs, m
    lever: float  # of the inner contact from the ring's centre, m
    inner: float  # sliding speed of the inner race over the ball along t, m/s
    outer: float  # of the outer race over the ball, m/s


@inlined
def meet(gap, c, s, orbit, spin, way, bulge):
    """`Meeting` (m, m/s) of a ball at the angle of cosine c and sine s that orbits and spins (rad/s).

    bulge: how far the inner race bends outwards there (m), and its rate (m/s).
    """
    indentation = gap.ex * c + gap.ey * s - way.play + bulge[0]
    radius = way.radius + way.share * max(indentation, 0.0)
    lever = way.inner_radius - gap.ex * c - gap.ey * s  # the ring's centre stands off by e
    v, around = radius * orbit, way.ball_radius * spin
    inner = gap.spin * lever + gap.uy * c - gap.ux * s - v + around
    rate = gap.ux * c + gap.uy * s + bulge[1]
    return Meeting(indentation, rate, radius, lever, inner, -(v + around))


@inlined
def rolling_drag(speed):
    """Rolling resistance over its full value, with the sign of a ball's `speed` along the race (m/s)."""
    return speed / math.sqrt(speed * speed + REVERSAL_SPEED * REVERSAL_SPEED)


@inlined
def across_of(gap, c, s):
    """How far the ring lies off the middle along t (m), at a ball at the angle of cosine c and sine s."""
    return gap.ey * c - gap.ex * s


@inlined
def elastic_at(meeting, way):
    """Elastic force (N) between the rings at a ball by its `meeting` (Meeting)."""
    depth = max(meeting.indentation, 0.0)
    return way.stiffness * (depth * math.sqrt(depth))


@inlined
def squeeze_ball(meeting, elastic, across, orbit, way, along, others):
    """`NormalLoads` (N) of a ball by its `meeting` (Meeting) and orbit (rad/s), pressed by `elastic` (N).

    across: of the ring's place (`across_of`, m); along (s/kg), others (m/s): as for
    `bearings.contact.pair.damped_normal`.
    """
    depth = max(meeting.indentation, 0.0)
    force = damped_normal(elastic, way.damping * depth, meeting.rate, along, others)
    outer = force + meeting.radius * way.mass * orbit * orbit
    v = meeting.radius * orbit
    drag = way.resistance * (force + outer) * rolling_drag(v)
    held = elastic * across / meeting.radius + drag
    return NormalLoads(force, elastic, outer, held, drag)


@kernel
def between_races(gap, c, s, orbit, spin, rm, bent, m):
    """`BallLoads` of a ball at cosine c and sine s, that orbits and spins (rad/s) on the radius rm (m).

    bent: `Shape` of the inner race there.
    """
    d, law = m.d, m.d.race
    size = d.inner_radius, d.ball_radius, d.mass
    way = Raceway(m.s.gaps.play, rm, 0.0, law.stiffness, law.damping, *size, m.p.rolling.resistance)
    meeting = meet(gap, c, s, orbit, spin, way, (bent.opening, bent.rate))
    across = across_of(gap, c, s) + bent.slope
    ball = squeeze_ball(meeting, elastic_at(meeting, way), across, orbit, way, 0.0, 0.0)
    inner = coefficient(meeting.inner, d.race_friction) * ball.force
    outer = coefficient(meeting.outer, d.race_friction) * ball.outer
    damped, dragged = (ball.force - ball.elastic) * meeting.rate, ball.drag * rm * orbit
    heat = damped + inner * meeting.inner + outer * meeting.outer + dragged
    outside = outer * meeting.outer + 0.5 * (damped + dragged)
    depth = meeting.indentation
    return BallLoads(ball.force, ball.elastic, depth, inner, outer, ball.held, meeting.lever, heat, outside)


@kernel
def note_ball(s, b, ball):
    """Count the loaded ball number `b` in `s` (LoadedBalls); ball: Pressed (N, m)."""
    s.loaded += 1.0
    s.total += ball.force
    s.energy += 0.4 * ball.elastic * ball.indentation
    if ball.force > s.force:
        s.force, s.most_loaded = ball.force, b
    if ball.indentation > s.indentation:
        s.indentation, s.deepest = ball.indentation, b


@kernel
def forget_loaded(s):
    """Forget the loaded balls in `s` (LoadedBalls)."""
    s.loaded, s.force, s.total, s.indentation, s.energy = 0.0, 0.0, 0.0, 0.0, 0.0
