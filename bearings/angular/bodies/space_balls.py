"""Balls as bodies in space: how they lie in the state, and where they start.

A ball has a place, a velocity and a spin of three components each, in axes that do not turn; it is a
sphere, so how it is turned is of no account. Balls of both rows lie one behind the other in the state,
component by component, behind the ring (`memory_layout`). An evaluation copies them into arrays of a fixed
length (`SpaceBalls`), over which all loops run as vector code (`bearings.rolling.ring`). What lies behind
the last ball is in no groove: it is far from touching.
"""

from __future__ import annotations

from dataclasses import dataclass

from ....modelkit.kernel import inlined, kernel
from ....modelkit.variables import array
from ... import seat
from ...rolling.ring import drift_balls, rounded_lanes
from ...seat import space
from .memory_layout import FIRST_BALL, ROOM, SIZE, VX, VY, VZ, WX, WY, WZ, X, Y, Z, component


@dataclass(frozen=True)
class SpaceBalls:
    """All balls in an evaluation, an array for each component."""

    x: tuple = array(ROOM)  # m
    y: tuple = array(ROOM)
    z: tuple = array(ROOM)
    vx: tuple = array(ROOM)  # m/s, before the kick
    vy: tuple = array(ROOM)
    vz: tuple = array(ROOM)
    wx: tuple = array(ROOM)  # rad/s, before the kick
    wy: tuple = array(ROOM)
    wz: tuple = array(ROOM)
    orbit: tuple = array(ROOM)  # rad/s, around the housing's axis
    bx: tuple = array(ROOM)  # m/s2, in the kick before
    by: tuple = array(ROOM)
    bz: tuple = array(ROOM)
    ax: tuple = array(ROOM)  # m/s2, in this one, as far as known
    ay: tuple = array(ROOM)
    az: tuple = array(ROOM)
    px: tuple = array(ROOM)  # rad/s2, likewise
    py: tuple = array(ROOM)
    pz: tuple = array(ROOM)


@inlined
def _copy(values, to, n):
    for b in range(n):
        to[b] = values[b]


@inlined
def gather_balls(q, m):
    """Copy the balls of the state q, and their accelerations in the kick before, to m.s.balls."""
    s, n, before = m.s.balls, m.d.balls, m.s.before
    _copy(component(q, X, m), s.x, n)
    _copy(component(q, Y, m), s.y, n)
    _copy(component(q, Z, m), s.z, n)
    _copy(component(q, VX, m), s.vx, n)
    _copy(component(q, VY, m), s.vy, n)
    _copy(component(q, VZ, m), s.vz, n)
    _copy(component(q, WX, m), s.wx, n)
    _copy(component(q, WY, m), s.wy, n)
    _copy(component(q, WZ, m), s.wz, n)
    _copy(component(before, VX, m), s.bx, n)
    _copy(component(before, VY, m), s.by, n)
    _copy(component(before, VZ, m), s.bz, n)


@inlined
def find_orbits(balls, hx, hy, hvx, hvy, n):
    """Set at which rates `n` balls go round the axis of the housing, at (hx, hy) (m), (hvx, hvy) (m/s)."""
    for b in range(n):
        dx, dy = balls.x[b] - hx, balls.y[b] - hy
        vx, vy = balls.vx[b] - hvx, balls.vy[b] - hvy
        balls.orbit[b] = (dx * vy - dy * vx) / (dx * dx + dy * dy)


@inlined
def hand_over_balls(dq, m):
    """Set the balls' derivatives in dq (m.n,)."""
    s, n = m.s.balls, m.d.balls
    _copy(s.vx, component(dq, X, m), n)
    _copy(s.vy, component(dq, Y, m), n)
    _copy(s.vz, component(dq, Z, m), n)
    _copy(s.ax, component(dq, VX, m), n)
    _copy(s.ay, component(dq, VY, m), n)
    _copy(s.az, component(dq, VZ, m), n)
    _copy(s.px, component(dq, WX, m), n)
    _copy(s.py, component(dq, WY, m), n)
    _copy(s.pz, component(dq, WZ, m), n)


@inlined
def drift(trial, q, mid, h, m):
    """The balls' places in the state `trial`: those in q and h (s) times the velocities in `mid`."""
    n = m.d.balls
    drift_balls(trial, q, mid, h, FIRST_BALL + X * n, FIRST_BALL + VX * n, 3 * n)  # y and z follow


@kernel
def lay_out_rows(q, m):
    """Put the balls at rest where they start, m.d.x, m.d.y and m.d.z (m) from the housing's middle."""
    d, s, n = m.d, m.s.balls, m.d.balls
    for b in range(n):
        i = FIRST_BALL + b
        q[i + X * n], q[i + Y * n], q[i + Z * n] = (
            q[seat.HX] + d.x[b],
            q[seat.HY] + d.y[b],
            q[space.HZ] + d.z[b],
        )
        q[i + VX * n], q[i + VY * n], q[i + VZ * n] = q[seat.HVX], q[seat.HVY], q[space.HVZ]
        q[i + WX * n] = q[i + WY * n] = q[i + WZ * n] = 0.0
    for b in range(n, ROOM):
        s.x[b], s.y[b], s.z[b] = 1.0, 0.0, 0.0


@kernel
def set_weights(m):
    """Set the balls' error weights, and m.n to what is in use."""
    w, n = m.weight, m.d.balls
    for b in range(FIRST_BALL, FIRST_BALL + n):
        for k in (X, Y, Z):
            w[b + k * n] = 1.0 / seat.POSITION_SCALE
        for k in (VX, VY, VZ):
            w[b + k * n] = 1.0 / seat.VELOCITY_SCALE
        for k in (WX, WY, WZ):
            w[b + k * n] = 1.0 / seat.SPIN_SCALE
    m.n = FIRST_BALL + SIZE * n


@inlined
def ball_lanes(m):
    """How many balls the loops run over (`bearings.rolling.ring.rounded_lanes`)."""
    return rounded_lanes(m.d.balls)
