"""Balls as bodies: where each one's three coordinates lie in the state, and how they move.

Each ball's state is its centre, velocity, rotation and spin, in the common frame; they lie in the state
vector component by component, so that loops over the balls become vector code. A cage follows the balls
with the same six components.
"""

from __future__ import annotations

import math

from touchdown.bearings import seat
from touchdown.bearings.contact.laws import elastic_energy
from touchdown.bearings.contact.pair import INSIDE, OUTSIDE
from touchdown.bearings.contact.profile import active
from touchdown.bearings.rolling import ball_state, ring
from touchdown.bearings.rolling.ball_state import BALLS, part
from touchdown.bearings.rolling.balls.geometry import inner_radius
from touchdown.bearings.rolling.bodies.race import Balls, settle_race
from touchdown.bearings.rolling.micro_step import missed, withhold
from touchdown.bearings.rolling.sides.contact import fill_sides, settle_sides
from touchdown.modelkit.kernel import kernel, woven
from touchdown.modelkit.ports import Motion

X, Y, VX, VY, ANGLE, SPIN = range(6)  # components of a ball, in this order
SIZE = 6


@kernel
def ball_motion(q, b, m):
    """`Motion` of ball number `b` (m, m/s, rad/s) in the state q."""
    i, n = BALLS + b, m.p.balls.count
    return Motion(q[i + X * n], q[i + Y * n], q[i + VX * n], q[i + VY * n], q[i + SPIN * n])


@woven
def balls_of(q, m):
    """`Balls` (m, m/s, rad/s): views of all balls in the state q."""
    at, velocity = (part(q, X, m), part(q, Y, m)), (part(q, VX, m), part(q, VY, m))
    return Balls(at[0], at[1], velocity[0], velocity[1], part(q, SPIN, m), m.d.ball_radius)


@kernel
def push(b, fx, fy, moment, m):
    """Add a force (N) and a moment (N m) on ball `b` to its accelerations in m.s.faster."""
    m.s.faster.x[b] += fx / m.d.mass
    m.s.faster.y[b] += fy / m.d.mass
    m.s.faster.spin[b] += moment / m.d.inertia


@kernel
def place(q, m):
    """Put the balls in the state q at rest where they start, m.d.x and m.d.y from the middle (m)."""
    d, n = m.d, m.p.balls.count
    for b in range(n):
        i = BALLS + b
        q[i + X * n], q[i + Y * n] = q[seat.HX] + d.x[b], q[seat.HY] + d.y[b]
        q[i + VX * n], q[i + VY * n] = q[seat.HVX], q[seat.HVY]
        q[i + ANGLE * n], q[i + SPIN * n] = 0.0, 0.0
    m.s.inner_starts[:] = math.nan
    m.s.outer_starts[:] = math.nan


@woven
def drift(trial, q, mid, h, m):
    """Positions in the state `trial`: those in q and h (s) times the velocities in `mid` (`verlet`)."""
    seat.drift(trial, q, mid, h, m)
    ring.drift(trial, q, mid, h)
    n = m.p.balls.count
    ball_state.drift(trial, q, mid, h, BALLS + X * n, BALLS + VX * n, 2 * n)  # and y, which follows
    ball_state.drift(trial, q, mid, h, BALLS + ANGLE * n, BALLS + SPIN * n, n)
    for i in range(BALLS + SIZE * n, m.s.seat.inside, SIZE):  # the cage
        trial[i + X] = q[i + X] + h * mid[i + VX]
        trial[i + Y] = q[i + Y] + h * mid[i + VY]
        trial[i + ANGLE] = q[i + ANGLE] + h * mid[i + SPIN]


@woven
def fastest(m):
    """Largest angular frequency of a body on its contacts, at the last evaluation (rad/s)."""
    d, s = m.d, m.s
    stiffest, below, side, sides = 0.0, 0.0, 0.0, 0.0
    for b in range(m.p.balls.count):
        below += s.inner.stiffness[b]
        stiffest = max(stiffest, s.inner.stiffness[b] + s.outer.stiffness[b])
        side = max(side, s.side.stiffness[b])
        sides += s.side.stiffness[b]
    below += ring.bore_stiffness(m)
    of_ball, of_ring = (stiffest + 2.0 * side) / d.mass, below / m.p.ring.mass
    return max(math.sqrt(max(of_ball, of_ring, sides * d.cage_answer)), m.s.seat.fastest)


@kernel
def kicked(q, dq, kick, m):
    """Settle all contacts' accounts after a `kick` (s) under dq; what they withheld is in q as heat."""
    s, n, off = m.s, m.p.balls.count, missed(dq, kick, m)
    withheld = settle_race(s.inner, OUTSIDE, n, kick, off.part, 0.0, 0.0)
    withheld += settle_race(s.outer, INSIDE, n, kick, off.part, off.hx, off.hy)
    withheld += settle_sides(s.side, n, kick, off.part)
    withhold(q, withheld + ring.settle_bore(kick, off.part, off.jx, off.jy, m), m)


@kernel
def fill_accounts(m, side):
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

    The ring's angle matters where its race is no circle; that of a ball does not.
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
