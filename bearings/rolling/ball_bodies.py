"""Balls as bodies between both races: their state, their motion, and the forces of the races on them.

Each ball's state is its centre, velocity, rotation and spin, in the common frame. Balls lie in the state
vector component by component (`bearings.rolling.ring`), so that loops over them become vector code; these
loops, and those of `bearings.rolling.friction`, make up most of a detailed bearing's cost. A cage
follows the balls with the same six components.

A ball touches the inner ring from outside and the outer ring, which is fixed in the housing, from inside,
each with its own stiffness and with friction. The contact is that of `bearings.contact.pair`, for all
balls of a race at once. Races are circles, or curves where a profile says so; on a curve the contact is
searched for.

Forces on the balls are found in two rounds: the races press (`press_races`), then, when all else is known,
they rub (`rub_ball_races`).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

from ...modelkit.kernel import inlined, kernel
from ...modelkit.ports import Motion
from ...modelkit.variables import array
from .. import seat
from ..contact.laws import elastic_energy, hertz
from ..contact.pair import INSIDE, OUTSIDE, ContactPlace, damped_normal, slip
from ..contact.passivity import Beat, middle_of, passive, settled_account
from ..contact.profile import BallOutline, Outline, active, race_place
from . import bending, gaps, ring
from .ball_contacts import fill_sides, settle_sides
from .ball_set import MAX_BALLS, inner_radius
from .balls import Total
from .friction import Answers, Inner, RubbedRace
from .micro_step import beat_of, missed_motion, withhold
from .ring import BALLS, lanes, part, rounded_lanes

X, Y, VX, VY, ANGLE, SPIN = range(6)  # components of a ball, in this order
SIZE = 6


@kernel
def ball_motion(q, b, m):
    """`Motion` of ball number `b` (m, m/s, rad/s) in the state q."""
    i, n = BALLS + b, m.p.balls.count
    return Motion(q[i + X * n], q[i + Y * n], q[i + VX * n], q[i + VY * n], q[i + SPIN * n])


@inlined
def balls_of(q, m):
    """`Balls` (m, m/s, rad/s): views of all balls in the state q."""
    place, velocity = (lanes(q, X, m), lanes(q, Y, m)), (lanes(q, VX, m), lanes(q, VY, m))
    return Balls(place[0], place[1], velocity[0], velocity[1], lanes(q, SPIN, m), m.d.ball_radius)


@kernel
def push_ball(b, fx, fy, moment, m):
    """Add a force (N) and a moment (N m) on ball `b` to its accelerations in m.s.faster."""
    m.s.faster.x[b] += fx / m.d.mass
    m.s.faster.y[b] += fy / m.d.mass
    m.s.faster.spin[b] += moment / m.d.inertia


@kernel
def lay_out_balls(q, m):
    """Put the balls in the state q at rest where they start, m.d.x and m.d.y from the middle (m)."""
    d, n = m.d, m.p.balls.count
    for b in range(n):
        i = BALLS + b
        q[i + X * n], q[i + Y * n] = q[seat.HX] + d.x[b], q[seat.HY] + d.y[b]
        q[i + VX * n], q[i + VY * n] = q[seat.HVX], q[seat.HVY]
        q[i + ANGLE * n], q[i + SPIN * n] = 0.0, 0.0
    m.s.inner_starts[:] = math.nan
    m.s.outer_starts[:] = math.nan


@inlined
def drift(trial, q, mid, h, m):
    """Positions in the state `trial`: those in q and h (s) times the velocities in `mid` (`verlet`)."""
    seat.drift(trial, q, mid, h, m)
    ring.drift(trial, q, mid, h)
    n = m.p.balls.count
    ring.drift_balls(trial, q, mid, h, BALLS + X * n, BALLS + VX * n, 2 * n)  # and y, which follows
    ring.drift_balls(trial, q, mid, h, BALLS + ANGLE * n, BALLS + SPIN * n, n)
    for i in range(BALLS + SIZE * n, m.d.bending.first, SIZE):  # the cage
        trial[i + X] = q[i + X] + h * mid[i + VX]
        trial[i + Y] = q[i + Y] + h * mid[i + VY]
        trial[i + ANGLE] = q[i + ANGLE] + h * mid[i + SPIN]
    bending.drift(trial, q, mid, h, m.d.bending)


@inlined
def fastest_ball(m):
    """Largest angular frequency of a body on its contacts, at the last evaluation (rad/s)."""
    d, s = m.d, m.s
    stiffest, below, side, sides = 0.0, 0.0, 0.0, 0.0
    for b in range(m.p.balls.count):
        below += s.inner.stiffness[b]
        stiffest = max(stiffest, s.inner.stiffness[b] + s.outer.stiffness[b])
        side = max(side, s.side.stiffness[b])
        sides += s.side.stiffness[b]
    below += ring.bore_stiffness(m)
    of_ball, of_ring = (stiffest + 2.0 * side) / d.mass, ring.ring_frequency_squared(below, m)
    light = max(of_ball, of_ring, sides * d.cage_answer)
    return max(math.sqrt(light), m.s.seat.fastest)


@kernel
def bodies_kicked(q, dq, kick, m):
    """Settle all contacts' accounts after a `kick` (s) under dq; what they withheld is in q as heat."""
    s, n, off = m.s, m.p.balls.count, missed_motion(dq, kick, m)
    inner = settle_race(s.inner, OUTSIDE, n, kick, off.part, 0.0, 0.0)
    outer = settle_race(s.outer, INSIDE, n, kick, off.part, off.hx, off.hy)
    sides = settle_sides(s.side, n, kick, off.part)
    bore = ring.settle_bore(kick, off.part, off.jx, off.jy, m)
    withhold(q, (inner, outer), sides, bore, m)


@kernel
def follow_gaps(m, since):
    """Have the gaps follow temperatures and spins as a macro step begins; since: s after that."""
    if gaps.due(m, since):
        closed, n = gaps.change_gaps(m), m.p.balls.count
        inner = _press_by(0.5 * closed.play, n, m.s.inner, m.d.inner)
        outer = _press_by(0.5 * closed.play, n, m.s.outer, m.d.outer)
        gaps.book_closing(closed, inner, outer, m)


@kernel
def _press_by(way, count, contacts, law):
    """Work (J) on `count` contacts that are pressed in farther by a `way` (m), kept in their accounts."""
    work, c = 0.0, contacts
    for b in range(count):
        pressed = gaps.pressed_in(way, c.indentation[b], c.stored[b], law)
        c.stored[b] += pressed
        work += pressed
    return work


@kernel
def fill_body_accounts(m, side):
    """Have the contacts that press at the last evaluation hold what their laws have stored.

    side: law of the balls' contacts with each other or the cage, a record.
    """
    s = m.s
    fill_sides(s.side, side, m.p.balls.count)
    for b in range(m.p.balls.count):
        s.inner.stored[b] = elastic_energy(s.inner.indentation[b], m.d.inner)
        s.outer.stored[b] = elastic_energy(s.outer.indentation[b], m.d.outer)
    s.ring.stored = elastic_energy(s.ring.indentation, m.d.contact)


@kernel
def set_weights(m):
    """Set the error weights up to the balls', and m.n to what is in use without a cage.

    The ring's angle matters where its race is not a circle; that of a ball does not.
    """
    p, w, n = m.p, m.weight, m.p.balls.count
    length, speed, spin = 1.0 / seat.POSITION_SCALE, 1.0 / seat.VELOCITY_SCALE, 1.0 / seat.SPIN_SCALE
    seat.set_weights(w)
    ring.set_weights(w)
    if active(p.inner_profile):
        w[ring.RANGLE] = inner_radius(p.balls) / seat.POSITION_SCALE
    for i in range(BALLS, BALLS + n):
        w[i + X * n] = w[i + Y * n] = length
        w[i + VX * n] = w[i + VY * n] = speed
        w[i + SPIN * n] = spin
    m.n = BALLS + SIZE * n


@dataclass(frozen=True)
class Contacts(RubbedRace):
    """One contact of each ball, at the last evaluation; places as in `pair.ContactPlace`."""

    nx: tuple = array(MAX_BALLS)
    ny: tuple = array(MAX_BALLS)
    indentation: tuple = array(MAX_BALLS)
    second: tuple = array(MAX_BALLS)
    across: tuple = array(MAX_BALLS)
    stiffness: tuple = array(MAX_BALLS)
    rate: tuple = array(MAX_BALLS)  # m/s, of the indentation, before the kick
    middle: tuple = array(MAX_BALLS)  # m/s, in the middle of the kick
    damped: tuple = array(MAX_BALLS)  # N, what of the normal force is damping
    stored: tuple = array(MAX_BALLS)  # J, as `bearings.contact.passivity`


class Balls(NamedTuple):
    """States of all balls, an array each, and their radius."""

    x: object  # m
    y: object
    vx: object  # m/s
    vy: object
    spin: object  # rad/s
    radius: float  # m


class Race(NamedTuple):
    """A race as its balls meet it: the side on which they lie, its radius and its law."""

    side: float
    radius: float  # m
    stiffness: float  # N/m^1.5
    damping: float  # N s/m2


class RacePlaces(NamedTuple):
    """Where all balls touch a race, an array each; a ball's own distance is its radius."""

    nx: object
    ny: object
    indentation: object  # m
    second: object  # m
    across: object  # m


class KickBefore(NamedTuple):
    """Changes of velocity over the kick before: of all balls, an array each, and of their race's centre."""

    beat: Beat
    ax: object  # m/s2, of the balls
    ay: object
    race_x: float  # m/s
    race_y: float
    answer: float  # s/kg, of a ball's speed to a force over the kick


class Forces(NamedTuple):
    """Forces on a race and on all balls, an array each; on entry, `normal` is that of the kick before.

    The race's own rate, outwards, and its acceleration in the kick before are zero where it is rigid.
    """

    normal: object  # N
    stiffness: object  # N/m, at this load
    damped: object  # N, what of it is damping
    sliding: object  # m/s, before the kick
    rate: object  # m/s, of the indentation, before the kick
    stored: object  # J, in their accounts
    race_rate: object  # m/s
    race_faster: object  # m/s2


@kernel
def forces_of(contacts, n):
    """`Forces` (n,) as views of `contacts` (Contacts)."""
    c = contacts
    moving = c.shape.rate[:n], c.shape.faster[:n]
    speeds = c.sliding[:n], c.rate[:n], c.stored[:n]
    return Forces(c.normal[:n], c.stiffness[:n], c.damped[:n], *speeds, *moving)


@kernel
def find_on_curve(balls, count, ring, angle, race, profile, starts, search, contacts):
    """Set the places (m) of `count` balls on a race with a profile, turned by `angle` (rad), in `contacts`.

    starts, search: as `bearings.contact.profile.race_place` keeps them.
    """
    outline, c = Outline(ring.x, ring.y, angle, race.radius), contacts
    for b in range(count):
        ball = BallOutline(balls.x[b], balls.y[b], balls.radius)
        place = race_place(b, race.side, ball, outline, profile, starts, search)
        c.nx[b], c.ny[b], c.indentation[b] = place.nx, place.ny, place.indentation
        c.second[b], c.across[b] = place.second, place.across


RIGID = (0.0, 0.0)  # m/s, a race's own rate, and its change in the kick before


class _NormalContact(NamedTuple):
    """A ball pressed against a race, before friction."""

    normal: float  # N
    stiffness: float  # N/m
    damped: float  # N
    sliding: float  # m/s
    rate: float  # m/s


@inlined
def _squeeze(b, balls, ring, place, race, before, last, stored, moving):
    """Ball `b` at its `ContactPlace` on a race, `_NormalContact`.

    last: its normal force (N) in the kick before; stored: energy in its account (J); moving: the race's own
    rate outwards, and its change in the kick before (m/s).
    """
    ball = Motion(balls.x[b], balls.y[b], balls.vx[b], balls.vy[b], balls.spin[b])
    sliding, rate = slip(ball, ring, place, race.side)
    rate -= race.side * moving[0]
    elastic, damping, stiffness = hertz(place.indentation, race.stiffness, race.damping)
    faster_x = before.beat.kick * before.ax[b] - before.race_x
    faster_y = before.beat.kick * before.ay[b] - before.race_y
    others = race.side * (faster_x * place.nx + faster_y * place.ny - moving[1]) + before.answer * last
    elastic = passive(elastic, 0.4 * place.indentation, stored, rate, others, before.answer, before.beat)
    normal = damped_normal(elastic, damping, rate, before.answer, others)
    return _NormalContact(normal, stiffness, normal - elastic, sliding, rate)


@inlined
def press_circle(balls, ring, race, before, places, forces):
    """Set `places` (n,) (m) of all `balls` on a circular race around `ring` (Motion), and their `forces`.

    before: `KickBefore`. Forces (n,) (N, N/m, m/s) are those of pressing, friction comes later.
    """
    reach = race.side * balls.radius
    for b in range(len(places.nx)):
        dx, dy = balls.x[b] - ring.x, balls.y[b] - ring.y
        distance = math.sqrt(dx * dx + dy * dy)
        inverse = 1.0 / distance
        second = distance + reach
        place = ContactPlace(
            dx * inverse, dy * inverse, race.side * (second - race.radius), reach, second, 0.0
        )
        last = forces.normal[b], forces.stored[b]
        pressed = _squeeze(b, balls, ring, place, race, before, last[0], last[1], RIGID)
        places.nx[b], places.ny[b] = place.nx, place.ny
        places.indentation[b], places.second[b], places.across[b] = place.indentation, second, 0.0
        forces.normal[b], forces.stiffness[b] = pressed.normal, pressed.stiffness
        forces.damped[b], forces.sliding[b], forces.rate[b] = pressed.damped, pressed.sliding, pressed.rate


@inlined
def find_on_circle(balls, ring, race, places):
    """Set `places` (n,) (m) of all `balls` on a circular race around `ring` (Motion)."""
    reach = race.side * balls.radius
    for b in range(len(places.nx)):
        dx, dy = balls.x[b] - ring.x, balls.y[b] - ring.y
        distance = math.sqrt(dx * dx + dy * dy)
        inverse, second = 1.0 / distance, distance + reach
        places.nx[b], places.ny[b] = dx * inverse, dy * inverse
        places.indentation[b] = race.side * (second - race.radius)
        places.second[b], places.across[b] = second, 0.0


@inlined
def bend_race(q, balls, ring, race, places, shape, m):
    """Have the `places` (n,) (m) of all `balls` be those on a race that bends; shape: `BendingMemory`."""
    n, s = len(places.nx), shape
    if m.d.searched == 1:  # normals of a curve do not point to its centre
        for b in range(n):
            dx, dy = balls.x[b] - ring.x, balls.y[b] - ring.y
            inverse = 1.0 / math.sqrt(dx * dx + dy * dy)
            s.nx[b], s.ny[b] = dx * inverse, dy * inverse
    else:
        for b in range(n):
            s.nx[b], s.ny[b] = places.nx[b], places.ny[b]
    bending.bend(q, n, m.d.bending, s)
    reach = race.side * balls.radius
    for b in range(n):
        turned = s.slope[b] / (places.second[b] - reach)
        nx, ny = places.nx[b], places.ny[b]
        places.nx[b], places.ny[b] = nx + turned * ny, ny - turned * nx
        places.indentation[b] -= race.side * s.opening[b]


@inlined
def press_curve(balls, ring, race, before, places, forces):
    """Set the `forces` (n,) of all `balls` on any race, whose `places` were found (`find_on_curve`).

    The rest as for `press_circle`.
    """
    reach, p = race.side * balls.radius, places
    for b in range(len(p.nx)):
        place = ContactPlace(p.nx[b], p.ny[b], p.indentation[b], reach, p.second[b], p.across[b])
        last, faster = (forces.normal[b], forces.stored[b]), before.beat.kick * forces.race_faster[b]
        moving = forces.race_rate[b], faster
        pressed = _squeeze(b, balls, ring, place, race, before, last[0], last[1], moving)
        forces.normal[b], forces.stiffness[b] = pressed.normal, pressed.stiffness
        forces.damped[b], forces.sliding[b], forces.rate[b] = pressed.damped, pressed.sliding, pressed.rate


@inlined
def pressing(contacts, side, count):
    """The `Total` (N, N m) of normal forces that `count` balls on that `side` of a race exert on it."""
    fx, fy, moment = 0.0, 0.0, 0.0
    for b in range(count):
        along = side * contacts.normal[b]
        fx += along * contacts.nx[b]
        fy += along * contacts.ny[b]
        moment -= along * contacts.across[b]
    return Total(fx, fy, moment, 0.0)


@inlined
def with_friction(pressed, contacts, count):
    """`Total` (N, N m, W) on a race that is `pressed` (Total) and rubbed by `count` balls."""
    fx, fy, moment, loss = pressed.fx, pressed.fy, pressed.moment, 0.0
    for b in range(count):
        fx += contacts.tangential[b] * contacts.ny[b]
        fy -= contacts.tangential[b] * contacts.nx[b]
        moment -= contacts.tangential[b] * contacts.second[b]
        loss += contacts.loss[b]
    return Total(fx, fy, moment, loss)


@inlined
def settle_race(contacts, side, count, kick, part, vx, vy):
    """Settle the accounts of `count` balls on that `side` of a race after a `kick` (s).

    part: of the kick in which the forces were found; vx, vy: by how much the race was faster in its middle
    than it was taken to be (m/s). Returns what the contacts withheld (J).
    """
    withheld, c = 0.0, contacts
    for b in range(count):
        if c.indentation[b] <= 0.0 and c.stored[b] <= 0.0:  # apart for longer
            continue
        closing = middle_of(c.rate[b], c.middle[b], part) - side * (vx * c.nx[b] + vy * c.ny[b])
        taken = kick * (c.normal[b] - c.damped[b]) * closing
        c.stored[b], lost = settled_account(c.stored[b], c.indentation[b], taken)
        withheld += lost
    return withheld


@inlined
def press_races(q, m):
    """Both races press all balls in the state q; sets their accelerations in m.s.faster, with gravity."""
    p, d, s = m.p, m.d, m.s
    balls, moved = balls_of(q, m), ring.moved_before(m)
    inner_ring, seat_motion = ring.ring_motion(q), seat.housing_motion(q)
    housing = Motion(seat_motion.x, seat_motion.y, seat_motion.vx, seat_motion.vy, s.outer_spin)
    ax, ay = lanes(s.before, VX, m), lanes(s.before, VY, m)
    beat = beat_of(m)
    over_outer = KickBefore(beat, ax, ay, 0.0, 0.0, s.kick / d.mass)
    over_inner = KickBefore(beat, ax, ay, moved.x, moved.y, s.kick / d.mass)
    wider = 0.5 * (s.gaps.play - p.balls.play)  # than at the start, of either race
    at_outer = Race(INSIDE, d.outer_radius + wider, d.outer.stiffness, d.outer.damping)
    at_inner = Race(OUTSIDE, d.inner_radius - wider, d.inner.stiffness, d.inner.damping)
    angle = q[ring.RANGLE]
    outer, inner = (housing, 0.0, over_outer), (inner_ring, angle, over_inner)
    _one_race(q, balls, outer, at_outer, p.outer_profile, s.outer_starts, s.outer, m)
    _one_race(q, balls, inner, at_inner, p.inner_profile, s.inner_starts, s.inner, m)
    _accelerate(m)


@inlined
def _one_race(q, balls, moving, race, profile, starts, contacts, m):
    """All balls press a race; moving: `Motion` and angle (rad) of its body, and what was `KickBefore`."""
    n, (body, angle, before) = rounded_lanes(m.p.balls.count), moving
    c, forces = contacts, forces_of(contacts, n)
    places = RacePlaces(c.nx[:n], c.ny[:n], c.indentation[:n], c.second[:n], c.across[:n])
    bends = m.d.bending.waves > 0 and race.side == OUTSIDE
    if m.d.searched == 1:
        find_on_curve(balls, m.p.balls.count, body, angle, race, profile, starts, m.s.search, contacts)
    elif bends:
        find_on_circle(balls, body, race, places)
    if bends:
        bend_race(q, balls, body, race, places, contacts.shape, m)
    if bends or m.d.searched == 1:
        press_curve(balls, body, race, before, places, forces)
    else:
        press_circle(balls, body, race, before, places, forces)


@inlined
def _accelerate(m):
    """Accelerations in m.s.faster of the balls that both races press, and under gravity."""
    gravity, inner, outer, faster, by_mass = m.d.gravity, m.s.inner, m.s.outer, m.s.faster, 1.0 / m.d.mass
    for b in range(rounded_lanes(m.p.balls.count)):
        faster.x[b] = (inner.normal[b] * inner.nx[b] - outer.normal[b] * outer.nx[b]) * by_mass
        faster.y[b] = (inner.normal[b] * inner.ny[b] - outer.normal[b] * outer.ny[b]) * by_mass - gravity
        faster.spin[b] = 0.0


@inlined
def rub_ball_races(q, dq, m):
    """Friction at both races and in the bore, when all else on the balls is in m.s.faster; sets them in dq.

    Returns the journal's `Touch`, and the `Total` (N, N m, W) on the inner and on the outer race.
    """
    d, s, h, count = m.d, m.s, m.s.kick, m.p.balls.count
    n = rounded_lanes(count)
    _driven_sliding(m)
    pressed = pressing(s.inner, OUTSIDE, count)
    answers = Answers(h / d.mass, h / d.mass, h * d.ball_radius * d.ball_radius / d.inertia)
    inner = Inner(s.inner.nx[:n], s.inner.ny[:n], s.inner.second[:n], s.cross[:n])
    journal, moved = ring.rub_races(q, pressed, answers, inner, m)
    _rub(moved, m)
    _hand_over(q, dq, m)
    on_inner = with_friction(pressed, s.inner, count)
    pressed_out = pressing(s.outer, INSIDE, count)
    on_outer = with_friction(pressed_out, s.outer, count)
    s.outer_moment = on_outer.moment
    s.brake.hx, s.brake.hy = on_outer.fx - pressed_out.fx, on_outer.fy - pressed_out.fy
    return journal, on_inner, on_outer


@inlined
def _driven_sliding(m):
    """How all but friction at races changes the sliding speeds over the kick."""
    s, inner, outer, rb, h, faster = m.s, m.s.inner, m.s.outer, m.d.ball_radius, m.s.kick, m.s.faster
    for b in range(rounded_lanes(m.p.balls.count)):
        along_outer = faster.y[b] * outer.nx[b] - faster.x[b] * outer.ny[b]
        along_inner = faster.y[b] * inner.nx[b] - faster.x[b] * inner.ny[b]
        outer.driven[b] = h * (along_outer + rb * faster.spin[b])
        inner.driven[b] = h * (along_inner - rb * faster.spin[b])
        s.cross[b] = outer.nx[b] * inner.nx[b] + outer.ny[b] * inner.ny[b]


@inlined
def _rub(moved, m):
    """Add friction at both races to the balls' accelerations, and the heat of damping to that of friction.

    moved: what the kick does to the ring (`Moved`).
    """
    inner, outer, h, faster = m.s.inner, m.s.outer, m.s.kick, m.s.faster
    by_mass, by_inertia = 1.0 / m.d.mass, m.d.ball_radius / m.d.inertia
    for b in range(rounded_lanes(m.p.balls.count)):
        f_o, f_i = outer.tangential[b], inner.tangential[b]
        ax = faster.x[b] - (f_o * outer.ny[b] + f_i * inner.ny[b]) * by_mass
        ay = faster.y[b] + (f_o * outer.nx[b] + f_i * inner.nx[b]) * by_mass
        faster.x[b], faster.y[b] = ax, ay
        faster.spin[b] += (f_o - f_i) * by_inertia
        dx, dy = h * ax, h * ay
        into_outer = dx * outer.nx[b] + dy * outer.ny[b]
        into_inner = (moved.x - dx) * inner.nx[b] + (moved.y - dy) * inner.ny[b]
        into_inner += h * inner.shape.faster[b] - moved.spin * inner.across[b]
        outer.middle[b] = outer.rate[b] + 0.5 * into_outer
        inner.middle[b] = inner.rate[b] + 0.5 * into_inner
        outer.loss[b] += outer.damped[b] * outer.middle[b]
        inner.loss[b] += inner.damped[b] * inner.middle[b]


@inlined
def _hand_over(q, dq, m):
    """Set the balls' derivatives in dq (m.n,), component by component: each loop is vector code."""
    n, faster = m.p.balls.count, m.s.faster
    ring.copy(part(q, VX, m), part(dq, X, m))
    ring.copy(part(q, VY, m), part(dq, Y, m))
    ring.copy(part(q, SPIN, m), part(dq, ANGLE, m))
    ring.copy(faster.x[:n], part(dq, VX, m))
    ring.copy(faster.y[:n], part(dq, VY, m))
    ring.copy(faster.spin[:n], part(dq, SPIN, m))
    bending.hand_over_modes(q, dq, m.d.bending, m.s.inner.shape)
