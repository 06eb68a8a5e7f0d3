"""Motion of a rotor in modal coordinates, both planes in one complex number p = p_x + i p_y.

(3.29) with mass-normalised free-free modes, the same in both planes:

    p'' = -omega^2 p - 2 zeta omega p' + i Omega G p' + i alpha G p
          + shape^T F - i g w + (Omega^2 - i alpha) U exp(i theta)
    I alpha = M - Re sum p'' conj(i U exp(i theta))

G: modal polar matrix (polar inertia per length), w: modal weight, U: modal unbalance. The last line gives
the unbalance's reaction on the spin, without which it would make energy.

A macro step is divided into strides: the gyroscopic coupling turns the velocities (exactly, in the
principal axes of G) for half a stride, each mode swings alone (exactly, under a load linear in time) for
a whole one, and the velocities are turned for another half (Strang splitting, of second order in the
stride). Stable for every mode, however fast.
"""

from __future__ import annotations

import math

import numpy as np

from touchdown.modelkit import oscillator
from touchdown.modelkit.kernel import kernel
from touchdown.modelkit.ports import MODES
from touchdown.rotor.drag import drag

ANGLE, SPIN, LOSS, WORK = range(4)  # behind the modal coordinates and velocities; WORK: one per station
SLOW = 1e-4  # (omega h)^2 of a stride; below, Hermite's rule errs by 1e-11, and the exact form cancels


@kernel
def modal(y, m):
    """Modal coordinates and velocities: views (p_x, p_y, v_x, v_y)."""
    n = m.d.modes
    return y[:n], y[n : 2 * n], y[2 * n : 3 * n], y[3 * n : 4 * n]


@kernel
def rest(y, m):
    """What is behind them: angle, spin, loss, work."""
    return y[4 * m.d.modes :]


@kernel
def moment(m, s):
    """Torque (N m) of all loads, s seconds after the middle of the macro step."""
    total = 0.0
    for j in range(m.d.stations):
        u = m.u.station[j]
        total += u.mz + u.dmz * s
    return total


@kernel
def loads(m, s, slope, fx, fy):
    """Modal forces of loads and gravity, s seconds after the middle; slope = 1: their rates instead."""
    n, g = m.d.modes, 0.0 if slope else m.p.gravity
    for k in range(n):
        fx[k] = 0.0
        fy[k] = -g * m.d.weight[k]
    for j in range(m.d.stations):
        u = m.u.station[j]
        jx, jy = (u.dfx, u.dfy) if slope else (u.fx + u.dfx * s, u.fy + u.dfy * s)
        if jx != 0.0 or jy != 0.0:
            for k in range(n):
                fx[k] += m.d.shape[j, k] * jx
                fy[k] += m.d.shape[j, k] * jy


@kernel
def accelerate(y, m, s, ax, ay):
    """Modal accelerations into (ax, ay), s seconds after the middle; returns the spin's (rad/s2)."""
    d, n = m.d, m.d.modes
    px, py, vx, vy = modal(y, m)
    spin = rest(y, m)[SPIN]
    angle = rest(y, m)[ANGLE] + m.p.unbalance_angle
    c, sn = math.cos(angle), math.sin(angle)
    loads(m, s, False, ax, ay)
    reaction, inertia = 0.0, d.inertia
    for k in range(n):
        gvx, gvy = _polar(m, k, vx, vy)
        gpx, gpy = _polar(m, k, px, py)
        wx, wy = _unbalance(m, k, c, sn)
        ax[k] += spin * spin * wx - d.stiffness[k] * px[k] - d.damping[k] * vx[k] - spin * gvy
        ay[k] += spin * spin * wy - d.stiffness[k] * py[k] - d.damping[k] * vy[k] + spin * gvx
        reaction += ay[k] * wx - ax[k] * wy
        inertia += (gpx - wx) * wx + (gpy - wy) * wy
    alpha = (moment(m, s) - drag(spin, m.p) - reaction) / inertia
    for k in range(n):
        gpx, gpy = _polar(m, k, px, py)
        wx, wy = _unbalance(m, k, c, sn)
        ax[k] += alpha * (wy - gpy)
        ay[k] += alpha * (gpx - wx)
    return alpha


@kernel
def _polar(m, k, x, y):
    """Component k of G x and of G y."""
    gx, gy = 0.0, 0.0
    for i in range(m.d.modes):
        gx += m.d.polar[k, i] * x[i]
        gy += m.d.polar[k, i] * y[i]
    return gx, gy


@kernel
def _unbalance(m, k, c, s):
    """Modal unbalance in the fixed frame; (c, s): cosine and sine of the rotor's angle."""
    ux, uy = m.p.unbalance_scale * m.d.unbalance_x[k], m.p.unbalance_scale * m.d.unbalance_y[k]
    return ux * c - uy * s, ux * s + uy * c


@kernel
def rhs(t, y, dy, m):
    """Derivative of the whole state under the loads mean + slope (t - t_mid)."""
    n = m.d.modes
    _, _, vx, vy = modal(y, m)
    dpx, dpy, ax, ay = modal(dy, m)
    now, rate = rest(y, m), rest(dy, m)
    s = t - m.half
    dpx[:], dpy[:] = vx, vy
    rate[SPIN] = accelerate(y, m, s, ax, ay)
    rate[ANGLE] = now[SPIN]
    heat = drag(now[SPIN], m.p) * now[SPIN]
    for k in range(n):
        heat += m.d.damping[k] * (vx[k] * vx[k] + vy[k] * vy[k])
    rate[LOSS] = heat
    for j in range(m.d.stations):
        u = m.u.station[j]
        ux, uy = 0.0, 0.0
        for k in range(n):
            ux += m.d.shape[j, k] * vx[k]
            uy += m.d.shape[j, k] * vy[k]
        work = (u.fx + u.dfx * s) * ux + (u.fy + u.dfy * s) * uy
        rate[WORK + j] = work + (u.mz + u.dmz * s) * now[SPIN]


@kernel
def prepare_stride(m, h):
    """Every mode's exact stride of h seconds, kept as long as h stays."""
    s = m.s.stride
    if s.length == h:
        return
    for k in range(m.d.modes):
        found = oscillator.step(m.d.stiffness[k], m.d.damping[k], h)
        s.zz[k], s.zv[k], s.vz[k], s.vv[k] = found.zz, found.zv, found.vz, found.vv
        s.zf[k], s.vf[k], s.zg[k], s.vg[k] = found.zf, found.vf, found.zg, found.vg
    s.length = h


@kernel
def turn_velocities(vx, vy, angle, m, a, b):
    """v <- exp(i angle G) v; a, b: scratch."""
    n, q = m.d.modes, m.d.turn
    for k in range(n):
        sx, sy = 0.0, 0.0
        for i in range(n):
            sx += q[k, i] * vx[i]
            sy += q[k, i] * vy[i]
        turned = angle * m.d.principal[k]
        c, s = math.cos(turned), math.sin(turned)
        a[k], b[k] = sx * c - sy * s, sx * s + sy * c
    for i in range(n):
        vx[i], vy[i] = 0.0, 0.0
    for k in range(n):
        for i in range(n):
            vx[i] += q[k, i] * a[k]
            vy[i] += q[k, i] * b[k]


@kernel
def _along(m, k, h, z, v, f, g):
    """Mode k in one plane over a stride of h seconds under the load f + g (t - h/2), from z and v.

    Returns both at its end, int z dt and int c z'^2 dt. The area follows from the equation of motion, the
    heat is the work of the load less the energy gained.
    """
    c, stiffness, damping = m.s.stride, m.d.stiffness[k], m.d.damping[k]
    z1 = c.zz[k] * z + c.zv[k] * v + c.zf[k] * f + c.zg[k] * g
    v1 = c.vz[k] * z + c.vv[k] * v + c.vf[k] * f + c.vg[k] * g
    if stiffness * h * h < SLOW:
        area = 0.5 * h * (z + z1) + h * h / 12.0 * (v - v1)
    else:
        area = (f * h - (v1 - v) - damping * (z1 - z)) / stiffness
    heat = 0.0
    if damping > 0.0:
        heat = f * (z1 - z) + g * (0.5 * h * (z1 + z) - area)
        heat -= 0.5 * ((v1 - v) * (v1 + v) + stiffness * (z1 - z) * (z1 + z))
    return z1, v1, area, heat


@kernel
def _swing(y, m, force, rate, s, h, alpha, area_x, area_y):
    """Each mode alone for h seconds about s after the middle, under `force` and `rate` (2, n).

    Adds int p dt to the areas; returns the heat.
    """
    d = m.d
    px, py, vx, vy = modal(y, m)
    spin, angle = rest(y, m)[SPIN], rest(y, m)[ANGLE] + m.p.unbalance_angle
    ca, sa = math.cos(angle), math.sin(angle)
    end = angle + h * (spin + 0.5 * alpha * h)
    ce, se = math.cos(end), math.sin(end)
    w2, e2 = spin * spin, (spin + alpha * h) ** 2
    lost = 0.0
    for k in range(d.modes):
        fx, fy = force[0, k] + rate[0, k] * s, force[1, k] + rate[1, k] * s
        gx, gy = rate[0, k], rate[1, k]
        if d.unbalanced:
            ax, ay = _unbalance(m, k, ca, sa)
            bx, by = _unbalance(m, k, ce, se)
            ax, ay = w2 * ax + alpha * ay, w2 * ay - alpha * ax
            bx, by = e2 * bx + alpha * by, e2 * by - alpha * bx
            fx, fy = fx + 0.5 * (ax + bx), fy + 0.5 * (ay + by)
            gx, gy = gx + (bx - ax) / h, gy + (by - ay) / h
        px[k], vx[k], under_x, heat_x = _along(m, k, h, px[k], vx[k], fx, gx)
        py[k], vy[k], under_y, heat_y = _along(m, k, h, py[k], vy[k], fy, gy)
        area_x[k] += under_x
        area_y[k] += under_y
        lost += heat_x + heat_y
    return lost


@kernel
def _spun(vx, vy, m, angle):
    """Angular momentum of the unbalance by the rotor's lateral motion: Re sum v conj(i U exp(i angle))."""
    if not m.d.unbalanced:
        return 0.0
    c, s = math.cos(angle), math.sin(angle)
    total = 0.0
    for k in range(m.d.modes):
        wx, wy = _unbalance(m, k, c, s)
        total += vy[k] * wx - vx[k] * wy
    return total


@kernel
def advance(y, m, step, longest, work):
    """One macro step (s) in strides of at most `longest`; work: scratch of at least eight rows."""
    d, n = m.d, m.d.modes
    px, py, vx, vy = modal(y, m)
    tail = rest(y, m)
    strides = max(1, math.ceil(step / longest - 1e-9))
    h = step / strides
    prepare_stride(m, h)
    force, rate, a, b = work[0:2], work[2:4], work[6], work[7]
    start_x, start_y, area_x, area_y = work[4, :n], work[4, n:], work[5, :n], work[5, n:]
    loads(m, 0.0, False, force[0], force[1])
    loads(m, 0.0, True, rate[0], rate[1])
    _add_spin_up(y, m, (moment(m, 0.0) - drag(tail[SPIN], m.p)) / d.inertia, force)
    for k in range(n):
        start_x[k], start_y[k], area_x[k], area_y[k] = px[k], py[k], 0.0, 0.0
    turned, swept = tail[ANGLE], 0.0
    kick = 0.0  # of the spin, by the unbalance's reaction, as it was in the stride before
    if d.unbalanced:
        kick = (
            accelerate(y, m, -0.5 * step, a, b)
            - (moment(m, -0.5 * step) - drag(tail[SPIN], m.p)) / d.inertia
        )
    for i in range(strides):
        s = (i + 0.5) * h - 0.5 * step
        braking = drag(tail[SPIN], m.p)
        torque = moment(m, s) - braking
        alpha = torque / d.inertia + kick
        middle = tail[ANGLE] + m.p.unbalance_angle + 0.5 * h * tail[SPIN]
        before = _spun(vx, vy, m, middle)
        turn_velocities(vx, vy, 0.5 * h * tail[SPIN], m, a, b)
        tail[LOSS] += _swing(y, m, force, rate, s, h, alpha, area_x, area_y)
        turn_velocities(vx, vy, 0.5 * h * (tail[SPIN] + alpha * h), m, a, b)
        change = (torque * h - _spun(vx, vy, m, middle) + before) / d.inertia
        turn = h * (tail[SPIN] + 0.5 * change)
        tail[LOSS] += braking * turn
        tail[ANGLE] += turn
        tail[SPIN] += change
        swept += s * turn
        kick = (change - torque * h / d.inertia) / h
    _account(y, m, step, start_x, start_y, area_x, area_y, tail[ANGLE] - turned, swept)


@kernel
def _add_spin_up(y, m, alpha, force):
    """i alpha G p, all but constant over a macro step."""
    px, py, _, _ = modal(y, m)
    for k in range(m.d.modes):
        gpx, gpy = _polar(m, k, px, py)
        force[0, k] -= alpha * gpy
        force[1, k] += alpha * gpx


@kernel
def _account(y, m, step, start_x, start_y, area_x, area_y, turned, swept):
    """Work of each load: mean times displacement, and slope times the first moment of the velocity.

    int s v dt over the step is its half times the sum of both ends' displacements less the area under it.
    Of the spin, they are the angle `turned` and what the strides have `swept`.
    """
    px, py, _, _ = modal(y, m)
    tail = rest(y, m)
    half = 0.5 * step
    for j in range(m.d.stations):
        u = m.u.station[j]
        if u.fx == 0.0 and u.fy == 0.0 and u.dfx == 0.0 and u.dfy == 0.0 and u.mz == 0.0 and u.dmz == 0.0:
            continue
        dx, dy, qx, qy = 0.0, 0.0, 0.0, 0.0
        for k in range(m.d.modes):
            shape = m.d.shape[j, k]
            dx += shape * (px[k] - start_x[k])
            dy += shape * (py[k] - start_y[k])
            qx += shape * (half * (px[k] + start_x[k]) - area_x[k])
            qy += shape * (half * (py[k] + start_y[k]) - area_y[k])
        work = u.fx * dx + u.fy * dy + u.dfx * qx + u.dfy * qy
        tail[WORK + j] += work + u.mz * turned + u.dmz * swept


@kernel
def take_mode_loads(y, m):
    """Give each mode what mean and slope did not say of the loads; their work is what energy it brings.

    What they change of the unbalance's momentum is taken from the spin.
    """
    px, py, vx, vy = modal(y, m)
    tail = rest(y, m)
    angle = tail[ANGLE] + m.p.unbalance_angle
    after = _spun(vx, vy, m, angle)
    for j in range(m.d.stations):
        before = after
        u, lumped = m.u.station[j], m.d.lumped[j] > 0.0
        for k in range(m.d.modes):
            place = int(m.d.slot[j, k])
            if place < 0 or (lumped and place == MODES - 1):
                continue
            z, shape = u.mode[place], m.d.shape[j, k]
            x1, y1, u1, v1 = shape * z.qx, shape * z.qy, shape * z.px, shape * z.py
            energy = m.d.stiffness[k] * (x1 * (px[k] + 0.5 * x1) + y1 * (py[k] + 0.5 * y1))
            energy += u1 * (vx[k] + 0.5 * u1) + v1 * (vy[k] + 0.5 * v1)
            tail[WORK + j] += energy
            px[k] += x1
            py[k] += y1
            vx[k] += u1
            vy[k] += v1
        after = _spun(vx, vy, m, angle)
        change = (before - after) / m.d.inertia
        tail[WORK + j] += 0.5 * change * (before + after)
        tail[SPIN] += change


@kernel
def energies(y, m):
    """(kinetic, potential) energy in J; that of height counts from the rotor's middle at y = 0."""
    d = m.d
    px, py, vx, vy = modal(y, m)
    tail = rest(y, m)
    kinetic = 0.5 * d.inertia * tail[SPIN] ** 2
    kinetic += tail[SPIN] * _spun(vx, vy, m, tail[ANGLE] + m.p.unbalance_angle)
    potential = 0.0
    for k in range(d.modes):
        kinetic += 0.5 * (vx[k] * vx[k] + vy[k] * vy[k])
        potential += 0.5 * d.stiffness[k] * (px[k] * px[k] + py[k] * py[k])
        potential += m.p.gravity * d.weight[k] * py[k]
    return kinetic, potential


@kernel
def finite(y, m):
    """Whether the state is one."""
    return math.isfinite(np.sum(y[: m.n]))
