"""The row of balls of a cageless bearing, each free along its race and in its spin.

Each ball has its angular position, its orbit (the angle's rate) and its spin; the ring's race and the
housing's drive it (`bearings.rolling.pitch_circle`), its neighbours push and rub.

Friction on a ball of half a gram is stiff: 1e7 per second under load. Linearly implicit steps
(`modelkit.integrators.rosenbrock`) take its slopes from `linearise`. With k_i and k_o the slope of friction
times load (N s/m) at the inner and the outer race of a ball, and l the inner contact's distance from the
ring's centre, the slopes of its orbit's and its spin's accelerations are

    orbit   -(k_i + k_o)/m               over orbit    (k_i - k_o) r_b/(r_m m)    over spin
    spin    (k_i - k_o) r_b r_m/I        over orbit   -(k_i + k_o) r_b^2/I        over spin

and those over the ring's spin k_i l/(r_m m) and -k_i l r_b/I. The ring's acceleration answers with
k_i l r_m/I_r and -k_i l r_b/I_r, and with -k_i l^2/I_r and the journal's slope to itself. So the matrix
is an arrow: each ball's orbit and spin are tied to each other and to the ring's spin only.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

from ...modelkit.kernel import inlined, kernel
from ...modelkit.numerics import cosine_and_sine
from ...modelkit.ports import Motion
from ...modelkit.variables import array, real
from .. import seat
from ..contact.friction import slope
from ..contact.laws import elastic_energy
from ..contact.pair import OUTSIDE, ContactPlace
from ..contact.passivity import Beat, middle_of, passive, settled_account
from . import bending, gaps, ring
from .ball_contacts import (
    after,
    ball_heat,
    fill_sides,
    link,
    part_ways,
    press_of,
    rub_sides,
    set_normal_forces,
    settle_sides,
)
from .ball_set import MAX_BALLS
from .balls import Total
from .friction import Answers, Inner, rubbed_of
from .micro_step import beat_of, missed_motion, withhold
from .pitch_circle import Meeting, Raceway, across_of, elastic_at, meet, squeeze_ball
from .ring import BALLS, LANES, lanes, part, rounded_lanes

ANGLE, ORBIT, SPIN = range(3)  # components of a ball, in this order: angular position, its rate, spin
# with a ring that bends, and room to run past the last ball
MAX_STATES = BALLS + 3 * MAX_BALLS + bending.MAX_STATES + LANES


@dataclass(frozen=True)
class RaceBalls:
    """Each ball between the races, at the last evaluation."""

    cosine: tuple = array(MAX_BALLS)
    sine: tuple = array(MAX_BALLS)
    elastic: tuple = array(MAX_BALLS)  # N, between the rings
    indentation: tuple = array(MAX_BALLS)
    lever: tuple = array(MAX_BALLS)  # m, of the inner contact from the ring's centre
    cross: tuple = array(MAX_BALLS)  # of the directions along both races: they are one
    radius: tuple = array(MAX_BALLS)  # m, on which the ball's centre runs
    along: tuple = array(MAX_BALLS)  # m/s2, along the race, but for friction and neighbours
    rate: tuple = array(MAX_BALLS)  # m/s, at which the rings approach, before the kick
    across: tuple = array(MAX_BALLS)  # m, how far the ring lies off the middle along the ball's race
    closing: tuple = array(MAX_BALLS)  # m/s, of the indentation, before the kick: the ball's orbit, too
    middle: tuple = array(MAX_BALLS)  # m/s, likewise in the middle of the kick
    stored: tuple = array(MAX_BALLS)  # J, as `bearings.contact.passivity`
    damped: tuple = array(MAX_BALLS)  # N, what of the force between the rings is damping
    drag: tuple = array(MAX_BALLS)  # N, rolling resistance
    rolled: tuple = array(MAX_BALLS)  # W, heat of damping and rolling resistance, of both races
    faster: tuple = array(MAX_BALLS)  # rad/s2, of the orbit, on its way through an evaluation
    turning: tuple = array(MAX_BALLS)  # rad/s2, of the spin, likewise
    outside: float = real(0.0, "W", "what of the balls' heat arises at the outer race")


class _BallCourse(NamedTuple):
    """How all balls lie and move along their race, an array each."""

    orbit: object  # rad/s
    spin: object  # rad/s
    cosine: object  # of the angular position
    sine: object


class _RingBefore(NamedTuple):
    """The ring's change of velocity in the kick before, and what it answers to a force over a kick."""

    x: float  # m/s
    y: float
    answer: float  # s/kg, where its mates move it, too
    alone: float  # s/kg
    beat: Beat


class RaceLoads(NamedTuple):
    """Forces between the races at all balls, an array each, as in `RaceBalls`."""

    elastic: object  # N
    indentation: object  # m
    lever: object  # m
    radius: object  # m
    along: object  # m/s2
    rate: object  # m/s
    damped: object  # N
    drag: object  # N
    across: object  # m
    closing: object  # m/s
    stored: object  # J


@inlined
def drift(trial, q, mid, h, m):
    """Positions in the state `trial`: those in q and h (s) times the velocities in `mid` (`verlet`)."""
    seat.drift(trial, q, mid, h, m)
    ring.drift(trial, q, mid, h)
    n = m.p.balls.count
    ring.drift_balls(trial, q, mid, h, BALLS + ANGLE * n, BALLS + ORBIT * n, n)
    bending.drift(trial, q, mid, h, m.d.bending)


@kernel
def raceway(m):
    """The `Raceway` of all balls."""
    d, law = m.d, m.d.race
    size = d.inner_radius, d.ball_radius, d.mass
    return Raceway(
        m.s.gaps.play, d.run_radius, d.run_share, law.stiffness, law.damping, *size, m.p.rolling.resistance
    )


@kernel
def _loads_of(s, n):
    """`RaceLoads` (n,) as views of `s` (RaceBalls)."""
    ways = s.lever[:n], s.radius[:n], s.along[:n]
    account = s.across[:n], s.closing[:n], s.stored[:n]
    return RaceLoads(
        s.elastic[:n], s.indentation[:n], *ways, s.rate[:n], s.damped[:n], s.drag[:n], *account
    )


@inlined
def _directions(angle, cosine, sine):
    """Set (n,) cosines and sines of the angular positions (rad)."""
    for b in range(len(cosine)):
        cosine[b], sine[b] = cosine_and_sine(angle[b])


@inlined
def _meet_all(gap, way, course, loads, inner, outer, shape):
    """Set where all balls on their `course` (n,) lie between the races, and how they move there.

    Arguments as of `_press_all`. One loop with that would have too many arrays to become vector code.
    """
    for b in range(len(course.cosine)):
        c, s = course.cosine[b], course.sine[b]
        bulge = shape.opening[b], shape.rate[b]
        meeting = meet(gap, c, s, course.orbit[b], course.spin[b], way, bulge)
        across = across_of(gap, c, s) + shape.slope[b]
        loads.across[b], loads.closing[b] = across, meeting.rate + across * course.orbit[b]
        loads.indentation[b], loads.rate[b] = meeting.indentation, meeting.rate
        loads.lever[b], loads.radius[b] = meeting.lever, meeting.radius
        inner.sliding[b], outer.sliding[b] = -meeting.inner, -meeting.outer


@inlined
def _press_all(way, before, gravity, course, loads, inner, outer, faster):
    """Set the `loads` (n,) of all balls on their `course` (n,), but for friction, at both races (Rubbed).

    way: `Raceway`; before: `_RingBefore`; gravity: m/s2; faster: m/s2, of the inner race as it bends.
    """
    by_mass = 1.0 / way.mass
    for b in range(len(course.cosine)):
        c, s = course.cosine[b], course.sine[b]
        meeting = Meeting(loads.indentation[b], loads.rate[b], loads.radius[b], 0.0, 0.0, 0.0)
        moved = before.x * c + before.y * s + before.beat.kick * faster[b]
        by_mates = moved + before.alone * inner.normal[b]
        elastic, scale, closing = elastic_at(meeting, way), 0.4 * meeting.indentation, loads.closing[b]
        elastic = passive(elastic, scale, loads.stored[b], closing, by_mates, before.alone, before.beat)
        others = moved + before.answer * inner.normal[b]
        ball = squeeze_ball(meeting, elastic, loads.across[b], course.orbit[b], way, before.answer, others)
        loads.elastic[b], loads.along[b] = ball.elastic, -ball.held * by_mass - gravity * c
        inner.normal[b], outer.normal[b] = ball.force, ball.outer
        loads.damped[b], loads.drag[b] = ball.force - ball.elastic, ball.drag


@inlined
def _crowd(m):
    """By how much more than one ball's force its mates' move the ring, so that much damping is stable.

    Each takes the others' damping from the kick before; along any direction half of a full row counts.
    """
    loaded = 0.0
    for b in range(m.p.balls.count):
        loaded += 1.0 if m.s.inner.normal[b] > 0.0 else 0.0
    return max(1.0, 0.5 * loaded)


@inlined
def press_balls(q, m):
    """Both races press all balls in the state q; sets their accelerations, gravity included."""
    s, balls = m.s, m.s.balls
    n = rounded_lanes(m.p.balls.count)
    angle, orbit, spin = lanes(q, ANGLE, m), lanes(q, ORBIT, m), lanes(q, SPIN, m)
    _directions(angle, balls.cosine[:n], balls.sine[:n])
    moved = ring.moved_before(m)
    alone = s.kick / m.p.ring.mass + s.kick * m.d.bending.answer
    if m.d.bending.waves > 0:
        ring.copy(balls.cosine[:n], s.inner.shape.nx[:n])
        ring.copy(balls.sine[:n], s.inner.shape.ny[:n])
        bending.bend(q, n, m.d.bending, s.inner.shape)
    before = _RingBefore(moved.x, moved.y, _crowd(m) * alone, alone, beat_of(m))
    course = _BallCourse(orbit, spin, balls.cosine[:n], balls.sine[:n])
    inner, outer = rubbed_of(s.inner, n), rubbed_of(s.outer, n)
    loads, shape, way = _loads_of(balls, n), s.inner.shape, raceway(m)
    _meet_all(ring.gap(q), way, course, loads, inner, outer, shape)
    _press_all(way, before, m.d.gravity, course, loads, inner, outer, shape.faster)
    for b in range(n):
        balls.faster[b] = balls.along[b] / balls.radius[b]
        balls.turning[b] = 0.0


@kernel
def neighbour_forces(q, m):
    """Each ball in the state q against the next one; adds to the balls' accelerations."""
    d, s, count = m.d, m.s, m.p.balls.count
    _find_neighbours(q, m)
    set_normal_forces(s.side, s.chain, count)
    rub_sides(s.side, count, d.ball_friction, s.lines)
    faster, turning = s.balls.faster, s.balls.turning
    for b in range(count):
        if s.side.indentation[b] > 0.0:
            k = after(b, count)
            c = press_of(s.side, b, OUTSIDE, d.ball_contact)
            push = c.normal * s.lever[b] / (d.pitch_radius * d.pitch_radius * d.mass)
            faster[b] -= push
            faster[k] += push
            turning[b] += c.second_moment / d.inertia
            turning[k] += c.first_moment / d.inertia


@kernel
def _find_neighbours(q, m):
    """Balls in the state q that touch the next one, and what their forces depend on (`sides.chain`)."""
    p, d, balls, before = m.p, m.d, m.s.balls, m.s.before
    rm, rb, count = d.pitch_radius, d.ball_radius, p.balls.count
    angle, spun = part(q, ANGLE, m), 2.0 * rb * rb / d.inertia
    m.s.side.touching = 0
    for b in range(count):
        k = after(b, count)
        between = angle[k] - angle[b] + (0.0 if b + 1 < count else 2.0 * math.pi)
        if between >= d.touch_angle:
            part_ways(m.s.side, b)
            continue
        ex, ey = balls.cosine[k] - balls.cosine[b], balls.sine[k] - balls.sine[b]
        square = 0.25 * (ex * ex + ey * ey)  # of the sine of half the angle between them
        m.s.lever[b] = lever = rm * math.sqrt(1.0 - square)
        # the bodies that touch: along the chord, and by their spins
        following, this = _along_chord(q, k, lever, m), _along_chord(q, b, lever, m)
        rates = _along_chord(before, k, lever, m), _along_chord(before, b, lever, m)
        place = ContactPlace(1.0, 0.0, 2.0 * (rb - rm * math.sqrt(square)), -rb, rb, 0.0)
        answers = spun, lever * lever / (rm * rm * d.mass)
        link(b, count, following, this, rates, place, d.ball_contact, answers, m)


@kernel
def _along_chord(q, b, lever, m):
    """Motion of ball `b` in the state q along a chord of a `lever` (m) about the middle, and its spin."""
    return Motion(0.0, 0.0, lever * part(q, ORBIT, m)[b], 0.0, part(q, SPIN, m)[b])


@kernel
def row_heat(dq, m):
    """Heat (W) between neighbours over the kick whose accelerations are in dq."""
    loss, count = 0.0, m.p.balls.count
    for b in range(count):
        if m.s.side.indentation[b] > 0.0:
            k, lever = after(b, count), m.s.lever[b]
            following, this = _along_chord(dq, k, lever, m), _along_chord(dq, b, lever, m)
            loss += ball_heat(m.s.side, b, m.s.kick, following, this, OUTSIDE)
    return loss


@inlined
def rub_balls(q, dq, m):
    """Friction at both races and in the bore, when all else on the balls is in m.s.balls; sets them in dq.

    Returns the journal's `Touch` and the `Total` (N, N m, W) on the ring.
    """
    d, s, h = m.d, m.s, m.s.kick
    n = rounded_lanes(m.p.balls.count)
    share = m.p.as_printed * d.ball_radius / d.pitch_radius  # of (2.10) as printed
    _driven_sliding(m)
    pressed = _pressing(m)
    answers = Answers(
        h * (1.0 + share) / d.mass,
        h * (1.0 - share) / d.mass,
        h * d.ball_radius * d.ball_radius / d.inertia,
    )
    inner = Inner(s.balls.cosine[:n], s.balls.sine[:n], s.balls.lever[:n], s.balls.cross[:n])
    journal, moved = ring.rub_races(q, pressed, answers, inner, m)
    _rub(q, share, moved, m)
    _hand_over(q, dq, m)
    balls = _with_friction(pressed, m)
    s.brake.hx, s.brake.hy = pressed.fx - balls.fx, pressed.fy - balls.fy
    return journal, balls


@inlined
def _driven_sliding(m):
    """How all but friction at races changes the sliding speeds over the kick."""
    s, rb, h = m.s, m.d.ball_radius, m.s.kick
    for b in range(rounded_lanes(m.p.balls.count)):
        along, around = s.balls.radius[b] * s.balls.faster[b], rb * s.balls.turning[b]
        s.outer.driven[b] = h * (along + around)
        s.inner.driven[b] = h * (along - around)


@inlined
def _rub(q, share, moved, m):
    """Add friction at both races to the balls' accelerations, and all other heat to that of friction.

    share: of friction's moment, as printed; moved: what the kick does to the ring (`Moved`).
    """
    s, balls, spun, half = m.s, m.s.balls, m.d.ball_radius / m.d.inertia, 0.5 * m.s.kick
    orbit = lanes(q, ORBIT, m)
    for b in range(rounded_lanes(m.p.balls.count)):
        f_o, f_i = s.outer.tangential[b], s.inner.tangential[b]
        balls.faster[b] += ((1.0 + share) * f_o + (1.0 - share) * f_i) / (balls.radius[b] * m.d.mass)
        balls.turning[b] += spun * (f_o - f_i)
        closing = moved.x * balls.cosine[b] + moved.y * balls.sine[b] + s.kick * s.inner.shape.faster[b]
        middle = balls.rate[b] + 0.5 * closing
        along = balls.radius[b] * (orbit[b] + half * balls.faster[b])
        balls.middle[b] = middle + balls.across[b] * (orbit[b] + half * balls.faster[b])
        balls.rolled[b] = balls.damped[b] * middle + balls.drag[b] * along
        s.inner.loss[b] += balls.rolled[b]


@inlined
def _hand_over(q, dq, m):
    """Set the balls' derivatives in dq (m.n,), component by component: each loop is vector code."""
    n, balls = m.p.balls.count, m.s.balls
    ring.copy(part(q, ORBIT, m), part(dq, ANGLE, m))
    ring.copy(balls.faster[:n], part(dq, ORBIT, m))
    ring.copy(balls.turning[:n], part(dq, SPIN, m))
    bending.hand_over_modes(q, dq, m.d.bending, m.s.inner.shape)


@inlined
def _pressing(m):
    """`Total` (N, N m) of the forces of all balls on the ring but for friction."""
    fx, fy, balls = 0.0, 0.0, m.s.balls
    for b in range(m.p.balls.count):
        fx -= m.s.inner.normal[b] * balls.cosine[b]
        fy -= m.s.inner.normal[b] * balls.sine[b]
    return Total(fx, fy, 0.0, 0.0)


@inlined
def _with_friction(pressed, m):
    """`Total` (N, N m, W) on the ring that is `pressed` (Total) and rubbed."""
    fx, fy, moment, heat, balls, s = pressed.fx, pressed.fy, 0.0, 0.0, m.s.balls, m.s
    outside = 0.0
    for b in range(m.p.balls.count):
        rub = s.inner.tangential[b]
        fx += rub * balls.sine[b]
        fy -= rub * balls.cosine[b]
        moment -= rub * balls.lever[b]
        heat += s.inner.loss[b] + s.outer.loss[b]
        outside += s.outer.loss[b] + 0.5 * balls.rolled[b]
    balls.outside = outside
    return Total(fx, fy, moment, heat)


@kernel
def row_kicked(q, dq, kick, m):
    """Settle all contacts' accounts after a `kick` (s) under dq; what they withheld is in q as heat."""
    balls, off, withheld = m.s.balls, missed_motion(dq, kick, m), 0.0
    for b in range(m.p.balls.count):
        if balls.indentation[b] <= 0.0 and balls.stored[b] <= 0.0:  # apart for longer
            continue
        closing = middle_of(balls.closing[b], balls.middle[b], off.part)
        closing -= off.hx * balls.cosine[b] + off.hy * balls.sine[b]
        balls.stored[b], lost = settled_account(
            balls.stored[b], balls.indentation[b], kick * balls.elastic[b] * closing
        )
        withheld += lost
    sides = settle_sides(m.s.side, m.p.balls.count, kick, off.part)
    bore = ring.settle_bore(kick, off.part, off.jx, off.jy, m)
    withhold(q, (0.5 * withheld, 0.5 * withheld), sides, bore, m)


@kernel
def press_by(way, m):
    """Work (J) on balls that are pressed in farther by a `way` (m), kept in their accounts."""
    balls, work = m.s.balls, 0.0
    for b in range(m.p.balls.count):
        pressed = gaps.pressed_in(way, balls.indentation[b], balls.stored[b], m.d.race)
        balls.stored[b] += pressed
        work += pressed
    return work


@kernel
def fill_row_accounts(m):
    """Have the contacts that press at the last evaluation hold what their laws have stored."""
    fill_sides(m.s.side, m.d.ball_contact, m.p.balls.count)
    for b in range(m.p.balls.count):
        m.s.balls.stored[b] = elastic_energy(m.s.balls.indentation[b], m.d.race)
    m.s.ring.stored = elastic_energy(m.s.ring.indentation, m.d.contact)


@inlined
def fastest_in_row(m):
    """Largest angular frequency of a body on its contacts, at the last evaluation (rad/s)."""
    d, s = m.d, m.s
    below, side = 0.0, 0.0
    for b in range(m.p.balls.count):
        below += math.sqrt(max(s.balls.indentation[b], 0.0))
        side = max(side, s.side.stiffness[b])
    below = d.race.exponent * d.race.stiffness * below + ring.bore_stiffness(m)
    return max(math.sqrt(max(ring.ring_frequency_squared(below, m), 4.0 * side / d.mass)), s.seat.fastest)


class BallBlock(NamedTuple):
    """Rows of a ball in s - J: its orbit's and its spin's, over both of them and over the ring's spin.

    Those over the ring's spin bear the sign they have in J.
    """

    orbit_orbit: float
    orbit_spin: float
    spin_orbit: float
    spin_spin: float
    orbit_ring: float
    spin_ring: float


@kernel
def linearise(q, stiff, m):
    """Fill `stiff` (m.n,), which describes J at the state q, from the loads of the last evaluation.

    In the places of a ball's angle, orbit and spin it holds k_i, k_o (N s/m) and l (m); in that of the
    ring's spin, what the journal makes of it (1/s).
    """
    p, d, s = m.p, m.d, m.s.balls
    count, gap, way = p.balls.count, ring.gap(q), raceway(m)
    for b in range(count):
        i = BALLS + b
        orbit = q[i + count]
        bulge = m.s.inner.shape.opening[b], m.s.inner.shape.rate[b]
        meeting = meet(gap, s.cosine[b], s.sine[b], orbit, q[i + 2 * count], way, bulge)
        pressed = m.s.inner.normal[b] + meeting.radius * d.mass * orbit * orbit
        stiff[i] = slope(meeting.inner, d.race_friction) * m.s.inner.normal[b]
        stiff[i + count] = slope(meeting.outer, d.race_friction) * pressed
        stiff[i + 2 * count] = meeting.lever
    bore = p.journal_radius + p.clearance
    stiff[ring.RW] = 0.0
    if m.s.ring.normal > 0.0:
        sliding = q[seat.JW] * p.journal_radius - q[ring.RW] * bore
        stiff[ring.RW] = slope(sliding, d.friction) * m.s.ring.normal * bore * bore / p.ring.inertia


@kernel
def _ball_block(inner, outer, lever, shift, d):
    """The `BallBlock` of a ball for s = `shift` (1/s), with its slopes (N s/m) and its lever (m)."""
    rm, rb, mass, inertia = d.pitch_radius, d.ball_radius, d.mass, d.inertia
    return BallBlock(
        shift + (inner + outer) / mass,
        (outer - inner) * rb / (rm * mass),
        (outer - inner) * rb * rm / inertia,
        shift + (inner + outer) * rb * rb / inertia,
        inner * lever / (rm * mass),
        -inner * lever * rb / inertia,
    )


@kernel
def _determinant(block):
    """Of a ball's own four (`BallBlock`), 1/s2."""
    return block.orbit_orbit * block.spin_spin - block.orbit_spin * block.spin_orbit


@kernel
def _solved(block, of_orbit, of_spin, scale):
    """(Orbit, spin) that a ball's own four (`BallBlock`) take to the right-hand side given.

    scale: one over the determinant, times what else is to multiply the solution.
    """
    orbit = (block.spin_spin * of_orbit - block.orbit_spin * of_spin) * scale
    return orbit, (block.orbit_orbit * of_spin - block.spin_orbit * of_orbit) * scale


@kernel
def solve_linearised(stiff, shift, right, m):
    """Overwrite `right` (m.n,) with the solution x of (s - J) x = right; s = `shift` (1/s), J by `stiff`.

    The balls are eliminated one by one, the ring is solved for, and its share handed back to them.
    """
    p, d = m.p, m.d
    rm, rb, count = d.pitch_radius, d.ball_radius, p.balls.count
    ring_ring, of_ring = shift + stiff[ring.RW], right[ring.RW]
    for i in range(BALLS, BALLS + count):
        inner, outer, lever = stiff[i], stiff[i + count], stiff[i + 2 * count]
        block = _ball_block(inner, outer, lever, shift, d)
        scale = 1.0 / _determinant(block)
        orbit, spin = _solved(block, right[i + count], right[i + 2 * count], scale)
        with_ring = _solved(block, block.orbit_ring, block.spin_ring, scale)  # per speed of the ring
        back = inner * lever / p.ring.inertia
        ring_ring += back * (lever - rm * with_ring[0] + rb * with_ring[1])
        of_ring += back * (rm * orbit - rb * spin)
        right[i], right[i + count], right[i + 2 * count] = right[i] / shift, orbit, spin
    turned = of_ring / ring_ring
    for i in range(BALLS, BALLS + count):
        block = _ball_block(stiff[i], stiff[i + count], stiff[i + 2 * count], shift, d)
        orbit, spin = _solved(block, block.orbit_ring, block.spin_ring, turned / _determinant(block))
        right[i + count] += orbit
        right[i + 2 * count] += spin
    for i in range(BALLS):
        right[i] /= shift
    for i in range(BALLS + 3 * count, m.n):
        right[i] /= shift
    right[ring.RW] = turned
