"""The row of balls of a cageless bearing, each free along its race and in its spin (2.8, 2.10, 2.11).

Each ball has its attitude angle, its orbit (the angle's rate) and its spin; the ring's race and the
housing's drive it (`bearings.rolling.pitch_circle`), its neighbours push and rub.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

from touchdown.bearings import seat
from touchdown.bearings.contact.friction import coefficient, curve, follow
from touchdown.bearings.contact.laws import elastic_energy, normal_and_elastic
from touchdown.bearings.contact.pair import friction_force
from touchdown.bearings.rolling import ring
from touchdown.bearings.rolling.ball_state import BALLS, LANES, part, rounded
from touchdown.bearings.rolling.balls import MOST_BALLS, Total
from touchdown.bearings.rolling.pitch_circle import Raceway, meet, press_ball
from touchdown.modelkit.angles import cosine_and_sine
from touchdown.modelkit.kernel import inlined, kernel
from touchdown.modelkit.variables import array, integer, real

ANGLE, ORBIT, SPIN = range(3)  # components of a ball, in this order: attitude angle, its rate, spin
MOST_STATES = BALLS + 3 * MOST_BALLS + LANES  # and room to run past the last ball


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
    loaded: int = integer(0, "first ball of the most loaded pair")
    deepest: int = integer(0, "first ball of the pair that overlaps most")
    energy: float = real(0.0, "J", "stored in the contacts")
    stiffness: float = real(0.0, "N/m", "largest")


class Course(NamedTuple):
    """How all balls lie and move along their race, an array each."""

    orbit: object  # rad/s
    spin: object  # rad/s
    cosine: object  # of the attitude angle
    sine: object


class Weight(NamedTuple):
    """What pulls and turns a ball, beside its contacts."""

    weight: float  # N
    inertia: float  # kg m2
    printed: float  # 1 for (2.10) as printed, else 0


class Loads(NamedTuple):
    """What happens between the races at all balls, an array each, as in `RaceBalls`."""

    force: object  # N
    elastic: object  # N
    indentation: object  # m
    fx: object  # N
    fy: object
    moment: object  # N m
    along: object  # rad/s2
    turning: object  # rad/s2
    heat: object  # W


@kernel
def place(q, count, angles):
    """Put `count` balls in the state q at rest at their `angles` (count,) (rad)."""
    for b in range(count):
        q[BALLS + b] = angles[b]
        q[BALLS + b + count], q[BALLS + b + 2 * count] = 0.0, 0.0


@kernel
def drift(trial, q, mid, h, m):
    """Positions in the state `trial`: those in q and h (s) times the velocities in `mid` (`verlet`)."""
    seat.drift(trial, q, mid, h, m)
    ring.drift(trial, q, mid, h)
    n = m.p.balls.count
    for i in range(BALLS, BALLS + n):
        trial[i] = q[i] + h * mid[i + n]


@inlined
def raceway(m, grip, resistance):
    """The `Raceway` of all balls; grip (s/kg) and rolling resistance (1) as they are to act."""
    d, law = m.d, m.d.race
    size = d.inner_radius, d.ball_radius, d.mass
    return Raceway(
        m.p.balls.play, d.run_radius, d.run_share, law.stiffness, law.damping, *size, grip, resistance
    )


@inlined
def _loads_of(s, n):
    """`Loads` (n,) as views of `s` (RaceBalls)."""
    loads = s.fx[:n], s.fy[:n], s.moment[:n], s.along[:n], s.turning[:n], s.heat[:n]
    return Loads(s.force[:n], s.elastic[:n], s.indentation[:n], *loads)


@kernel
def _directions(angle, cosine, sine):
    """Set (n,) cosines and sines of the attitude angles (rad)."""
    for b in range(len(cosine)):
        cosine[b], sine[b] = cosine_and_sine(angle[b])


@kernel
def _press_all(gap, way, friction, own, course, loads):
    """Set the `loads` (n,) of all balls on their `course` (n,).

    gap: `Gap`; way: `Raceway`; friction: a `Curve`; own: `Weight`.
    """
    spun = way.ball_radius / own.inertia
    for b in range(len(course.cosine)):
        c, s = course.cosine[b], course.sine[b]
        at = meet(gap, c, s, course.orbit[b], course.spin[b], way)
        mu_inner, _ = follow(at.inner, friction)
        mu_outer, _ = follow(at.outer, friction)
        ball = press_ball(at, gap, c, s, course.orbit[b], (mu_inner, mu_outer), way)
        loads.force[b] = ball.force
        loads.elastic[b] = ball.elastic
        loads.indentation[b] = ball.indentation
        loads.fx[b] = ball.inner * s - ball.force * c
        loads.fy[b] = -(ball.force * s + ball.inner * c)
        loads.moment[b] = -ball.inner * ball.lever
        push = ball.inner + ball.outer - ball.held - own.weight * c
        push += own.printed * (ball.outer - ball.inner) * way.ball_radius / at.radius
        loads.along[b] = push / (at.radius * way.mass)
        loads.turning[b] = spun * (ball.outer - ball.inner)
        loads.heat[b] = ball.heat


@kernel
def race_forces(q, dq, m):
    """Ring against balls against housing, in the state q: `Total` (N, N m, W) on the ring.

    Sets the derivatives dq of the balls' angles, orbits and spins as far as races and gravity go.
    """
    p, d, s = m.p, m.d, m.s.balls
    count = p.balls.count
    n = rounded(count)
    gap, way = ring.gap(q), raceway(m, m.s.step * d.race_grip, p.rolling.resistance)
    angle, orbit, spin = part(q, ANGLE, m), part(q, ORBIT, m), part(q, SPIN, m)
    _directions(angle, s.cosine[:n], s.sine[:n])
    course = Course(orbit, spin, s.cosine[:n], s.sine[:n])
    own = Weight(p.gravity * d.mass, d.inertia, 1.0 if p.as_printed == 1 else 0.0)
    _press_all(gap, way, curve(d.race_friction), own, course, _loads_of(s, n))
    fx, fy, moment, heat = 0.0, 0.0, 0.0, 0.0
    for b in range(count):
        i = BALLS + b
        dq[i] = orbit[b]
        dq[i + count] = s.along[b]
        dq[i + 2 * count] = s.turning[b]
        fx += s.fx[b]
        fy += s.fy[b]
        moment += s.moment[b]
        heat += s.heat[b]
    return Total(fx, fy, moment, heat)


@kernel
def neighbour_forces(q, dq, m):
    """Each ball in the state q against the next one; adds to the derivatives dq, returns the heat (W)."""
    p, d, s, at = m.p, m.d, m.s.pushed, m.s.balls
    rm, rb, count = d.pitch_radius, d.ball_radius, p.balls.count
    angle, orbit, spin = part(q, ANGLE, m), part(q, ORBIT, m), part(q, SPIN, m)
    faster, turning = part(dq, ORBIT, m), part(dq, SPIN, m)
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
        if force > s.force:
            s.force, s.loaded = force, b
        if overlap > s.overlap:
            s.overlap, s.deepest = overlap, b
        s.stiffness = max(s.stiffness, d.ball_contact.exponent * force / overlap)
    return heat


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
