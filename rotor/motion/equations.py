"""State and equations of motion of a rotor in modal coordinates.

A rotor of n modes and S stations has the state

    q = (p_x, p_y, v_x, v_y, angle, spin, loss, work of the brake, work of the load at each station,
         z, z', work of the thrust)                                                  (4 n + 4 + S + 3,)

of which functions here give views. Modal coordinates p (n,) in m kg^0.5 and velocities v = p' (n,) in
m kg^0.5/s are those of mass-normalised free-free modes, the same in both planes; angle in rad, spin in
rad/s; loss and work in J, since the start. Along the shaft the rotor is rigid, and moves where `axial` is
on.

With both planes in one complex number p = p_x + i p_y, (3.29) reads

    p'' = -omega^2 p - 2 zeta omega p' + i Omega G p' + i alpha G p
          + shape^T F - i tilt^T M - i g w + (Omega^2 - i alpha) U exp(i theta)
    I alpha = M - Re sum p'' conj(i U exp(i theta))

F = F_x + i F_y and M = M_x + i M_y: forces and moments at the stations; shape, tilt: of the modes there,
their deflection and its slope. G (n, n): modal polar matrix (polar inertia per length), which couples the
modes gyroscopically, w: modal weight, U: modal unbalance. In the last line M is the moment about the shaft;
it gives the unbalance's reaction on the spin, without which it would make energy.

v' = i Omega G v alone turns the velocities in the principal axes of G: with G = Q diag(g) Q^T, those of
Q^T v by the angles g_k int Omega dt.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ...modelkit.base_motion import base_acceleration, base_jerk, moving
from ...modelkit.gravity import gravity_across, gravity_along
from ...modelkit.kernel import kernel
from ...modelkit.numerics import squared
from ..brake import brake_torque, drag
from ..thrust import thrust

ANGLE, SPIN, LOSS, BRAKED, WORK = range(
    5
)  # behind the modal coordinates and velocities; WORK: one per station
Z, VZ, WORK_OUTSIDE = range(3)  # of what moves along the shaft, behind them; of thrust and moving base
ALONG = 3


class Planar(NamedTuple):
    """A quantity of every mode in both planes, (n,) each."""

    x: np.ndarray
    y: np.ndarray


class Modal(NamedTuple):
    """Modal coordinates and velocities, (n,) each; of a derivative, its velocities and accelerations."""

    px: np.ndarray
    py: np.ndarray
    vx: np.ndarray
    vy: np.ndarray


@kernel
def planar(row, m):
    """The first 2 n places of `row` as `Planar` views."""
    n = m.d.modes
    return Planar(row[:n], row[n : 2 * n])


@kernel
def modal(q, m):
    """The modal part of a state or of its derivative, (N,): views of n each."""
    n = m.d.modes
    return Modal(q[:n], q[n : 2 * n], q[2 * n : 3 * n], q[3 * n : 4 * n])


@kernel
def auxiliary(q, m):
    """The state behind the modes: a view with places from ANGLE to WORK + station, then `shaftwise`."""
    return q[4 * m.d.modes :]


@kernel
def shaftwise(q, m):
    """Motion along the shaft in a state q: a view (3,) with the places Z, VZ, WORK_OUTSIDE."""
    return q[4 * m.d.modes + WORK + m.d.stations :]


@kernel
def shaft_force(m, since_middle):
    """Force (N) along the shaft of gravity, thrust and all loads, `since_middle` (s) after the middle."""
    p = m.p
    total = gravity_along(p.gravity, p.inclination) * m.d.mass + thrust(p, m.time + m.half + since_middle)
    for j in range(m.d.stations):
        total += m.u.station[j].fz + m.u.station[j].dfz * since_middle
    return total


@kernel
def moment(m, since_middle):
    """Torque (N m) of all loads, `since_middle` (s) after the middle of the macro step."""
    total = 0.0
    for j in range(m.d.stations):
        load = m.u.station[j]
        total += load.mz + load.dmz * since_middle
    return total


@kernel
def spin_up(m, since_middle, spin):
    """Spin acceleration (rad/s2) by loads and drag at `spin` (rad/s), without the unbalance's reaction."""
    return (moment(m, since_middle) - drag(spin, m.time + m.half + since_middle, m.p)) / m.d.inertia


@kernel
def modal_forces(m, since_middle, fx, fy):
    """Modal forces of loads and gravity into fx, fy (n,), N/kg^0.5, `since_middle` (s) after the middle."""
    down = gravity_across(m.p.gravity, m.p.inclination)
    for k in range(m.d.modes):
        fx[k] = 0.0
        fy[k] = -down * m.d.weight[k]
    if moving(m.p.base):
        base_x, base_y = base_acceleration(m, since_middle)
        for k in range(m.d.modes):
            fx[k] -= base_x * m.d.weight[k]
            fy[k] -= base_y * m.d.weight[k]
    for j in range(m.d.stations):
        load = m.u.station[j]
        _add(m, j, load.fx + load.dfx * since_middle, load.fy + load.dfy * since_middle, fx, fy)
        _tilt(m, j, load.mx + load.dmx * since_middle, load.my + load.dmy * since_middle, fx, fy)


@kernel
def modal_force_rates(m, dfx, dfy):
    """Their rates into dfx, dfy (n,), N/(kg^0.5 s), the same throughout the macro step."""
    for k in range(m.d.modes):
        dfx[k] = 0.0
        dfy[k] = 0.0
    if moving(m.p.base):
        jerk_x, jerk_y = base_jerk(m)
        for k in range(m.d.modes):
            dfx[k] = -jerk_x * m.d.weight[k]
            dfy[k] = -jerk_y * m.d.weight[k]
    for j in range(m.d.stations):
        load = m.u.station[j]
        _add(m, j, load.dfx, load.dfy, dfx, dfy)
        _tilt(m, j, load.dmx, load.dmy, dfx, dfy)


@kernel
def _add(m, j, x, y, fx, fy):
    """Add a force (x, y) at station j, in N or N/s, to modal ones (n,)."""
    if x != 0.0 or y != 0.0:
        for k in range(m.d.modes):
            fx[k] += m.d.shape[j, k] * x
            fy[k] += m.d.shape[j, k] * y


@kernel
def _tilt(m, j, about_x, about_y, fx, fy):
    """Add moments about x and y at station j, in N m or N m/s, to modal forces (n,), as `_add` does."""
    if about_x != 0.0 or about_y != 0.0:
        for k in range(m.d.modes):
            fx[k] += m.d.tilt[j, k] * about_y
            fy[k] -= m.d.tilt[j, k] * about_x


@kernel
def unbalance_of(m, k, cosine, sine):
    """Unbalance (x, y) of mode k in the fixed frame, kg^0.5 m; cosine and sine of the rotor's angle."""
    unbalance = m.d.unbalance
    ux, uy = m.p.unbalance_scale * unbalance.x[k], m.p.unbalance_scale * unbalance.y[k]
    return ux * cosine - uy * sine, ux * sine + uy * cosine


@kernel
def spin_momentum(vx, vy, m, angle):
    """Angular momentum (N m s) that the modal velocities (n,) give the unbalance at `angle` (rad).

    Re sum v conj(i U exp(i angle)).
    """
    if not m.d.unbalance.present:
        return 0.0
    cosine, sine = math.cos(angle), math.sin(angle)
    total = 0.0
    for k in range(m.d.modes):
        ux, uy = unbalance_of(m, k, cosine, sine)
        total += vy[k] * ux - vx[k] * uy
    return total


@kernel
def polar_product(m, k, x, y):
    """Component k of G x and of G y, x and y (n,); in their unit."""
    gx, gy = 0.0, 0.0
    for i in range(m.d.modes):
        gx += m.d.gyroscopic.polar[k, i] * x[i]
        gy += m.d.gyroscopic.polar[k, i] * y[i]
    return gx, gy


@kernel
def turn_velocities(vx, vy, angle, m, spare_x, spare_y):
    """v <- exp(i angle G) v in place, v (n,) in any unit, angle (rad) that of the rotor; spare: (n,)."""
    n, axes = m.d.modes, m.d.gyroscopic.turn
    for k in range(n):
        along_x, along_y = 0.0, 0.0  # the principal axis
        for i in range(n):
            along_x += axes[k, i] * vx[i]
            along_y += axes[k, i] * vy[i]
        turned = angle * m.d.gyroscopic.principal[k]
        cosine, sine = math.cos(turned), math.sin(turned)
        spare_x[k] = along_x * cosine - along_y * sine
        spare_y[k] = along_x * sine + along_y * cosine
    for i in range(n):
        vx[i], vy[i] = 0.0, 0.0
    for k in range(n):
        for i in range(n):
            vx[i] += axes[k, i] * spare_x[k]
            vy[i] += axes[k, i] * spare_y[k]


@kernel
def add_spin_up(q, m, alpha, fx, fy):
    """Add i alpha G p to modal forces fx, fy (n,), N/kg^0.5; alpha: spin acceleration (rad/s2)."""
    px, py, _, _ = modal(q, m)
    for k in range(m.d.modes):
        gx, gy = polar_product(m, k, px, py)
        fx[k] -= alpha * gy
        fy[k] += alpha * gx


@kernel
def accelerations(q, m, since_middle, ax, ay):
    """Modal accelerations of the state q (N,) into ax, ay (n,), m kg^0.5/s2; returns the spin's (rad/s2).

    `since_middle`: s after the middle of the macro step, for the loads.
    """
    d, n = m.d, m.d.modes
    px, py, vx, vy = modal(q, m)
    spin = auxiliary(q, m)[SPIN]
    angle = auxiliary(q, m)[ANGLE] + m.p.unbalance_angle
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
    braking = drag(spin, m.time + m.half + since_middle, m.p)
    alpha = (moment(m, since_middle) - braking - reaction) / inertia
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
    state, rate = modal(q, m), modal(dq, m)
    tail, tail_rate = auxiliary(q, m), auxiliary(dq, m)
    spin = tail[SPIN]
    rate.px[:], rate.py[:] = state.vx, state.vy
    tail_rate[SPIN] = accelerations(q, m, since_middle, rate.vx, rate.vy)
    tail_rate[ANGLE] = spin
    heat = drag(spin, m.time + t, m.p) * spin
    tail_rate[BRAKED] = brake_torque(spin, m.time + t, m.p) * spin
    for k in range(m.d.modes):
        heat += m.d.damping[k] * (state.vx[k] * state.vx[k] + state.vy[k] * state.vy[k])
    tail_rate[LOSS] = heat
    for j in range(m.d.stations):
        tail_rate[WORK + j] = _power(m, j, since_middle, state.vx, state.vy, spin)
    along, rate_along = shaftwise(q, m), shaftwise(dq, m)
    rate_along[Z] = rate_along[VZ] = rate_along[WORK_OUTSIDE] = 0.0
    if m.p.axial == 1:
        rate_along[Z] = along[VZ]
        rate_along[VZ] = shaft_force(m, since_middle) / m.d.mass
        rate_along[WORK_OUTSIDE] = thrust(m.p, m.time + t) * along[VZ]
        for j in range(m.d.stations):
            load = m.u.station[j]
            tail_rate[WORK + j] += (load.fz + load.dfz * since_middle) * along[VZ]
    if moving(m.p.base):
        base_x, base_y = base_acceleration(m, t - m.half)
        for k in range(m.d.modes):
            rate_along[WORK_OUTSIDE] -= m.d.weight[k] * (base_x * state.vx[k] + base_y * state.vy[k])


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
    return power + (load.mz + load.dmz * since_middle) * spin + _tilting_power(m, j, since_middle, vx, vy)


@kernel
def _tilting_power(m, j, since_middle, vx, vy):
    """`_power` of the moments that tilt the station."""
    load = m.u.station[j]
    about_x, about_y = load.mx + load.dmx * since_middle, load.my + load.dmy * since_middle
    power = 0.0
    for k in range(m.d.modes):
        power += m.d.tilt[j, k] * (about_y * vx[k] - about_x * vy[k])
    return power


@kernel
def energies(q, m):
    """(kinetic, potential) energy (J) of q (N,); that of height counts from the rotor's middle at y = 0."""
    d = m.d
    px, py, vx, vy = modal(q, m)
    tail = auxiliary(q, m)
    kinetic = 0.5 * d.inertia * squared(tail[SPIN])
    kinetic += tail[SPIN] * spin_momentum(vx, vy, m, tail[ANGLE] + m.p.unbalance_angle)
    potential, down = 0.0, gravity_across(m.p.gravity, m.p.inclination)
    for k in range(d.modes):
        kinetic += 0.5 * (vx[k] * vx[k] + vy[k] * vy[k])
        potential += 0.5 * d.stiffness[k] * (px[k] * px[k] + py[k] * py[k])
        potential += down * d.weight[k] * py[k]
    if m.p.axial == 1:
        along = shaftwise(q, m)
        kinetic += 0.5 * d.mass * squared(along[VZ])
        potential -= d.mass * gravity_along(m.p.gravity, m.p.inclination) * along[Z] + along[WORK_OUTSIDE]
    elif moving(m.p.base):
        potential -= shaftwise(q, m)[WORK_OUTSIDE]
    return kinetic, potential
