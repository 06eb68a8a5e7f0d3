"""Balls as bodies between both races, which press and rub them (2.39, 2.45).

A ball touches the inner ring from outside and the outer ring, which is fixed in the housing, from inside,
each with its own stiffness and with friction. Races are circles, or curves where a profile says so.

What acts on the balls is found in two rounds: the races press (`press_races`), then, when all else is
known, they rub (`rub_races`).
"""

from __future__ import annotations

from touchdown.bearings import seat
from touchdown.bearings.contact.pair import INSIDE, OUTSIDE
from touchdown.bearings.rolling import ball_state, ring
from touchdown.bearings.rolling.ball_state import part, rounded
from touchdown.bearings.rolling.bodies.race import (
    Before,
    Race,
    find_on_curve,
    forces_of,
    places_of,
    press_circle,
    press_curve,
    pressing,
    with_friction,
)
from touchdown.bearings.rolling.bodies.state import ANGLE, SPIN, VX, VY, X, Y, balls_of
from touchdown.bearings.rolling.micro_step import beat_of
from touchdown.bearings.rolling.rubbing import Answers, Inner
from touchdown.modelkit.kernel import woven
from touchdown.modelkit.ports import Motion


@woven
def press_races(q, m):
    """Both races press all balls in the state q; sets their accelerations in m.s.faster, with gravity."""
    p, d, s = m.p, m.d, m.s
    balls, moved = balls_of(q, m), ring.moved_before(m)
    inner_ring, at = ring.ring_motion(q), seat.housing_motion(q)
    housing = Motion(at.x, at.y, at.vx, at.vy, s.outer_spin)
    ax, ay = part(s.before, VX, m), part(s.before, VY, m)
    beat = beat_of(m)
    over_outer = Before(beat, ax, ay, 0.0, 0.0, s.kick / d.mass)
    over_inner = Before(beat, ax, ay, moved.x, moved.y, s.kick / d.mass)
    at_outer = Race(INSIDE, d.outer_radius, d.outer.stiffness, d.outer.damping)
    at_inner = Race(OUTSIDE, d.inner_radius, d.inner.stiffness, d.inner.damping)
    angle = q[ring.RANGLE]
    _one_race(balls, housing, 0.0, at_outer, over_outer, p.outer_profile, s.outer_starts, s.outer, m)
    _one_race(balls, inner_ring, angle, at_inner, over_inner, p.inner_profile, s.inner_starts, s.inner, m)
    _accelerate(m)


@woven
def _one_race(balls, body, angle, race, before, profile, starts, contacts, m):
    """All balls press the race of `body` (Motion), turned by `angle` (rad)."""
    n = rounded(m.p.balls.count)
    places, forces = places_of(contacts, n), forces_of(contacts, n)
    if m.d.searched == 1:
        find_on_curve(balls, body, angle, race, profile, starts, m.s.search, contacts)
        press_curve(balls, body, race, before, places, forces)
    else:
        press_circle(balls, body, race, before, places, forces)


@woven
def _accelerate(m):
    """Accelerations in m.s.faster of the balls that both races press, and under gravity."""
    gravity, inner, outer, faster, by_mass = m.p.gravity, m.s.inner, m.s.outer, m.s.faster, 1.0 / m.d.mass
    for b in range(rounded(m.p.balls.count)):
        faster.x[b] = (inner.normal[b] * inner.nx[b] - outer.normal[b] * outer.nx[b]) * by_mass
        faster.y[b] = (inner.normal[b] * inner.ny[b] - outer.normal[b] * outer.ny[b]) * by_mass - gravity
        faster.spin[b] = 0.0


@woven
def rub_races(q, dq, m):
    """Friction at both races and in the bore, when all else on the balls is in m.s.faster; sets them in dq.

    Returns the journal's `Touch` and the `Total` (N, N m, W) on the inner and on the outer race.
    """
    d, s, h, count = m.d, m.s, m.s.kick, m.p.balls.count
    n = rounded(count)
    _drive(m)
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


@woven
def _drive(m):
    """How all but friction at races changes the sliding speeds over the kick."""
    s, inner, outer, rb, h, faster = m.s, m.s.inner, m.s.outer, m.d.ball_radius, m.s.kick, m.s.faster
    for b in range(rounded(m.p.balls.count)):
        along_outer = faster.y[b] * outer.nx[b] - faster.x[b] * outer.ny[b]
        along_inner = faster.y[b] * inner.nx[b] - faster.x[b] * inner.ny[b]
        outer.driven[b] = h * (along_outer + rb * faster.spin[b])
        inner.driven[b] = h * (along_inner - rb * faster.spin[b])
        s.cross[b] = outer.nx[b] * inner.nx[b] + outer.ny[b] * inner.ny[b]


@woven
def _rub(moved, m):
    """Add friction at both races to the balls' accelerations, and the heat of damping to that of friction.

    moved: what the kick does to the ring (`Moved`).
    """
    inner, outer, h, faster = m.s.inner, m.s.outer, m.s.kick, m.s.faster
    by_mass, by_inertia = 1.0 / m.d.mass, m.d.ball_radius / m.d.inertia
    for b in range(rounded(m.p.balls.count)):
        f_o, f_i = outer.tangential[b], inner.tangential[b]
        ax = faster.x[b] - (f_o * outer.ny[b] + f_i * inner.ny[b]) * by_mass
        ay = faster.y[b] + (f_o * outer.nx[b] + f_i * inner.nx[b]) * by_mass
        faster.x[b], faster.y[b] = ax, ay
        faster.spin[b] += (f_o - f_i) * by_inertia
        dx, dy = h * ax, h * ay
        into_outer = dx * outer.nx[b] + dy * outer.ny[b]
        into_inner = (moved.x - dx) * inner.nx[b] + (moved.y - dy) * inner.ny[b]
        into_inner -= moved.spin * inner.across[b]
        outer.middle[b] = outer.rate[b] + 0.5 * into_outer
        inner.middle[b] = inner.rate[b] + 0.5 * into_inner
        outer.loss[b] += outer.damped[b] * outer.middle[b]
        inner.loss[b] += inner.damped[b] * inner.middle[b]


@woven
def _hand_over(q, dq, m):
    """Set the balls' derivatives in dq (m.n,), component by component: each loop is vector code."""
    n, faster = m.p.balls.count, m.s.faster
    ball_state.copy(part(q, VX, m), part(dq, X, m))
    ball_state.copy(part(q, VY, m), part(dq, Y, m))
    ball_state.copy(part(q, SPIN, m), part(dq, ANGLE, m))
    ball_state.copy(faster.x[:n], part(dq, VX, m))
    ball_state.copy(faster.y[:n], part(dq, VY, m))
    ball_state.copy(faster.spin[:n], part(dq, SPIN, m))
