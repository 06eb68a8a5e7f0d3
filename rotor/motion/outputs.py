"""What a rotor tells of its state: motion at the stations and sensors, energy, and what never changes."""

from __future__ import annotations

import math

import numpy as np

from touchdown.modelkit.kernel import kernel
from touchdown.rotor.motion.equations import accelerate, energies
from touchdown.rotor.motion.state import LOSS, SPIN, WORK, Planar, modal, rest


@kernel
def publish(q, m):
    """Outputs m.o from the state q (N,) at the end of the macro step."""
    n = m.d.modes
    acceleration = Planar(np.empty(n), np.empty(n))
    alpha = accelerate(q, m, m.half, acceleration.x, acceleration.y)
    for j in range(m.d.stations):
        _publish_station(q, m, j, acceleration, alpha)
    for j in range(m.d.sensors):
        o = m.o.sensor[j]
        o.x, o.y, o.vx, o.vy = _motion(m.d.sensor_shape[j], q, m)
    e = m.o.energy
    e.kinetic, e.potential = energies(q, m)
    e.dissipated = rest(q, m)[LOSS]


@kernel
def _motion(shape, q, m):
    """(x, y, vx, vy), m and m/s, where the modes have this shape (n,), 1/kg^0.5."""
    px, py, pvx, pvy = modal(q, m)
    x, y, vx, vy = 0.0, 0.0, 0.0, 0.0
    for k in range(m.d.modes):
        x += shape[k] * px[k]
        y += shape[k] * py[k]
        vx += shape[k] * pvx[k]
        vy += shape[k] * pvy[k]
    return x, y, vx, vy


@kernel
def _publish_station(q, m, j, acceleration, alpha):
    """What a bearing at station j needs to know; 'free' is what it does not cause itself.

    acceleration: `Planar`, of the modes (m kg^0.5/s2); alpha: of the spin (rad/s2).
    """
    d, shape = m.d, m.d.shape[j]
    o, u, tail = m.o.station[j], m.u.station[j], rest(q, m)
    ax, ay = acceleration
    fx, fy = u.fx + u.dfx * m.half, u.fy + u.dfy * m.half
    o.x, o.y, o.vx, o.vy = _motion(shape, q, m)
    o.omega = tail[SPIN]
    o.alpha_free = alpha - (u.mz + u.dmz * m.half) / d.inertia
    o.work = tail[WORK + j]
    o.ax_free, o.ay_free = -d.inv_m[j] * fx, -d.inv_m[j] * fy
    for k in range(d.modes):
        o.ax_free += shape[k] * ax[k]
        o.ay_free += shape[k] * ay[k]
    for i in range(int(d.slots[j])):
        z = o.mode[i]
        z.x, z.y, z.vx, z.vy, z.ax_free, z.ay_free = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    px, py, vx, vy = modal(q, m)
    for k in range(d.modes):
        if d.slot[j, k] >= 0.0:
            z = o.mode[int(d.slot[j, k])]
            z.x += shape[k] * px[k]
            z.y += shape[k] * py[k]
            z.vx += shape[k] * vx[k]
            z.vy += shape[k] * vy[k]
            z.ax_free += shape[k] * (ax[k] - shape[k] * fx)
            z.ay_free += shape[k] * (ay[k] - shape[k] * fy)


@kernel
def publish_constants(m):
    """Outputs that stay: mass (kg), polar inertia (kg m2), positions of nodes (m), and at stations."""
    m.o.mass, m.o.polar_inertia = m.d.mass, m.d.inertia
    for i in range(m.d.watched):
        m.o.node[i].position = m.d.position[i]
    for j in range(m.d.stations):
        _publish_station_constants(m, j)


@kernel
def _publish_station_constants(m, j):
    """What stays at station j; modes that share a slot there become one of the same static flexibility."""
    d, o = m.d, m.o.station[j]
    o.static_fy = d.static_fy[j]
    o.inv_m = d.inv_m[j]
    o.inv_I = 1.0 / d.inertia
    for i in range(int(d.slots[j])):
        gain, flexibility = 0.0, 0.0
        for k in range(d.modes):
            if d.slot[j, k] == i:
                gain += d.shape[j, k] ** 2
                flexibility += d.shape[j, k] ** 2 / d.stiffness[k]
        z = o.mode[i]
        z.inv_m, z.k_over_m = gain, gain / flexibility
        z.c_over_m = 2.0 * d.damping_ratio * math.sqrt(z.k_over_m)
