"""Motion of a rotor in modal coordinates, both planes in one complex number p = p_x + i p_y.

(3.29) with mass-normalised free-free modes, the same in both planes:

    p'' = -omega^2 p - 2 zeta omega p' + i Omega G p' + i alpha G p
          + shape^T F - i g w + (Omega^2 - i alpha) U exp(i theta)
    I alpha = M - Re sum p'' conj(i U exp(i theta))

G: modal polar matrix (polar inertia per length), w: modal weight, U: modal unbalance. The last line gives
the unbalance's reaction on the spin, without which it would make energy.
"""

from __future__ import annotations

import math

from touchdown.modelkit.kernel import kernel
from touchdown.rotor.drag import drag
from touchdown.rotor.motion.gyroscopics import polar_product
from touchdown.rotor.motion.loads import modal_forces, moment
from touchdown.rotor.motion.state import ANGLE, LOSS, SPIN, WORK, modal, rest
from touchdown.rotor.motion.unbalance import spin_momentum, unbalance_of


@kernel
def accelerate(q, m, since_middle, ax, ay):
    """Modal accelerations of the state q (N,) into ax, ay (n,), m kg^0.5/s2; returns the spin's (rad/s2).

    `since_middle`: s after the middle of the macro step, for the loads.
    """
    d, n = m.d, m.d.modes
    px, py, vx, vy = modal(q, m)
    spin = rest(q, m)[SPIN]
    angle = rest(q, m)[ANGLE] + m.p.unbalance_angle
    cosine, sine = math.cos(angle), math.sin(angle)
    modal_forces(m, since_middle, ax, ay)
    reaction, inertia = 0.0, d.inertia
    for k in range(n):
        gvx, gvy = polar_product(m, k, vx, vy)
        gpx, gpy = polar_product(m, k, px, py)
        ux, uy = unbalance_of(m, k, cosine, sine)
        ax[k] += spin * spin * ux - d.stiffness[k] * px[k] - d.damping[k] * vx[k] - spin * gvy
        ay[k] += spin * spin * uy - d.stiffness[k] * py[k] - d.damping[k] * vy[k] + spin * gvx
        reaction += ay[k] * ux - ax[k] * uy
        inertia += (gpx - ux) * ux + (gpy - uy) * uy
    alpha = (moment(m, since_middle) - drag(spin, m.p) - reaction) / inertia
    for k in range(n):
        gpx, gpy = polar_product(m, k, px, py)
        ux, uy = unbalance_of(m, k, cosine, sine)
        ax[k] += alpha * (uy - gpy)
        ay[k] += alpha * (gpx - ux)
    return alpha


@kernel
def rhs(t, q, dq, m):
    """Derivative dq (N,) of the state q (N,), t (s) after the start of the macro step.

    The loads are mean + slope (t - t_mid). For monolithic solutions; a macro step is taken by `macro_step`.
    """
    since_middle = t - m.half
    now, rate = modal(q, m), modal(dq, m)
    tail, tail_rate = rest(q, m), rest(dq, m)
    spin = tail[SPIN]
    rate.px[:], rate.py[:] = now.vx, now.vy
    tail_rate[SPIN] = accelerate(q, m, since_middle, rate.vx, rate.vy)
    tail_rate[ANGLE] = spin
    heat = drag(spin, m.p) * spin
    for k in range(m.d.modes):
        heat += m.d.damping[k] * (now.vx[k] * now.vx[k] + now.vy[k] * now.vy[k])
    tail_rate[LOSS] = heat
    for j in range(m.d.stations):
        tail_rate[WORK + j] = _power(m, j, since_middle, now.vx, now.vy, spin)


@kernel
def _power(m, j, since_middle, vx, vy, spin):
    """Power (W) of the load at station j at modal velocities (n,) and `spin` (rad/s)."""
    load = m.u.station[j]
    station_vx, station_vy = 0.0, 0.0
    for k in range(m.d.modes):
        station_vx += m.d.shape[j, k] * vx[k]
        station_vy += m.d.shape[j, k] * vy[k]
    power = (load.fx + load.dfx * since_middle) * station_vx + (
        load.fy + load.dfy * since_middle
    ) * station_vy
    return power + (load.mz + load.dmz * since_middle) * spin


@kernel
def energies(q, m):
    """(kinetic, potential) energy (J) of q (N,); that of height counts from the rotor's middle at y = 0."""
    d = m.d
    px, py, vx, vy = modal(q, m)
    tail = rest(q, m)
    kinetic = 0.5 * d.inertia * tail[SPIN] ** 2
    kinetic += tail[SPIN] * spin_momentum(vx, vy, m, tail[ANGLE] + m.p.unbalance_angle)
    potential = 0.0
    for k in range(d.modes):
        kinetic += 0.5 * (vx[k] * vx[k] + vy[k] * vy[k])
        potential += 0.5 * d.stiffness[k] * (px[k] * px[k] + py[k] * py[k])
        potential += m.p.gravity * d.weight[k] * py[k]
    return kinetic, potential
