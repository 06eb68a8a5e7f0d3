"""Balls as bodies between both races, which press and rub them (2.39, 2.45).

A ball touches the inner ring from outside and the outer ring, which is fixed in the housing, from inside,
each with its own stiffness and with friction. Races are circles, or curves where a profile says so.
"""

from __future__ import annotations

from touchdown.bearings import seat
from touchdown.bearings.contact.pair import INSIDE, OUTSIDE
from touchdown.bearings.rolling import ring
from touchdown.bearings.rolling.ball_state import part, rounded
from touchdown.bearings.rolling.bodies.race import (
    Race,
    find_on_circle,
    find_on_curve,
    places_of,
    press_race,
)
from touchdown.bearings.rolling.bodies.state import ANGLE, SPIN, VX, VY, X, Y, balls_of
from touchdown.modelkit.kernel import kernel
from touchdown.modelkit.ports import Motion


@kernel
def race_contacts(q, dq, m):
    """All balls in the state q against both races; sets their derivatives in dq, gravity included.

    Returns the `Total` (N, N m, W) on the inner and on the outer race.
    """
    p, d, s = m.p, m.d, m.s
    balls = balls_of(q, m)
    grip = s.step * d.race_grip
    at_outer = Race(INSIDE, d.outer_radius, d.outer.stiffness, d.outer.damping, grip)
    at_inner = Race(OUTSIDE, d.inner_radius, d.inner.stiffness, d.inner.damping, grip)
    inner_ring, at = ring.ring_motion(q), seat.housing_motion(q)
    housing = Motion(at.x, at.y, at.vx, at.vy, s.outer_spin)
    outer = _one_race(balls, housing, 0.0, at_outer, p.outer_profile, s.outer_starts, s.outer, m)
    angle = q[ring.RANGLE]
    inner = _one_race(balls, inner_ring, angle, at_inner, p.inner_profile, s.inner_starts, s.inner, m)
    s.outer_moment = outer.moment
    _accelerate(balls, dq, m)
    return inner, outer


@kernel
def _one_race(balls, body, angle, race, profile, starts, contacts, m):
    """All balls against the race of `body` (Motion), turned by `angle` (rad); returns the `Total` on it."""
    if m.d.searched == 1:
        find_on_curve(balls, body, angle, race, profile, starts, m.s.search, contacts)
    else:
        find_on_circle(balls, body, race, places_of(contacts, rounded(m.p.balls.count)))
    return press_race(balls, body, race, m.d.race_friction, contacts)


@kernel
def _accelerate(balls, dq, m):
    """Derivatives dq (m.n,) of the `balls` under what both races do to them, and gravity."""
    d, gravity, inner, outer = m.d, m.p.gravity, m.s.inner, m.s.outer
    dx, dy, turning = part(dq, X, m), part(dq, Y, m), part(dq, ANGLE, m)
    ax, ay, alpha = part(dq, VX, m), part(dq, VY, m), part(dq, SPIN, m)
    by_mass, by_inertia = 1.0 / d.mass, d.ball_radius / d.inertia
    for b in range(len(ax)):
        dx[b] = balls.vx[b]
        dy[b] = balls.vy[b]
        turning[b] = balls.spin[b]
        ax[b] = (outer.fx[b] + inner.fx[b]) * by_mass
        ay[b] = (outer.fy[b] + inner.fy[b]) * by_mass - gravity
        alpha[b] = (outer.tangential[b] - inner.tangential[b]) * by_inertia
