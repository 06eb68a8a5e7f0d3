"""A macro step of the flexible rotor.

In a stride the gyroscopic coupling turns the velocities (exactly, in the principal axes of G) for half of
it, each mode swings alone (exactly, under a load linear in time) for the whole of it, and the velocities
are turned for another half: Strang splitting, of second order in the stride. Stable for every mode,
however fast. Along the shaft each stride is exact under loads and a thrust that are linear in time.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ...modelkit import numerics
from ...modelkit.base_motion import base_acceleration, base_jerk, moving
from ...modelkit.kernel import kernel
from ...modelkit.numerics import squared
from ...modelkit.ports import MODES
from ...modelkit.variables import array, real
from ..brake import brake_torque, drag
from ..modal.data import MAX_MODES
from ..thrust import thrust
from . import outputs
from .equations import (
    ANGLE,
    BRAKED,
    LOSS,
    SPIN,
    VZ,
    WORK,
    WORK_OUTSIDE,
    Z,
    accelerations,
    add_spin_up,
    auxiliary,
    modal,
    modal_force_rates,
    modal_forces,
    moment,
    planar,
    shaft_force,
    shaftwise,
    spin_momentum,
    spin_up,
    turn_velocities,
    unbalance_of,
)


@kernel
def account(q, m, step, start, area, turned, swept):
    """Add the work (J) of each load over a macro step of `step` (s) to the state q (N,) at its end.

    Mean times displacement, and slope times the first moment of the velocity about the middle: int s v dt
    is half the step times the sum of both ends' displacements, less the area under them. start, area:
    `Planar`, modal coordinates at the start (m kg^0.5) and their integrals over the step. Of the spin,
    displacement and first moment are `turned` (rad) and `swept` (rad s).
    """
    px, py, _, _ = modal(q, m)
    start_x, start_y = start
    area_x, area_y = area
    tail = auxiliary(q, m)
    half = 0.5 * step
    for j in range(m.d.stations):
        u = m.u.station[j]
        if u.mx != 0.0 or u.my != 0.0 or u.dmx != 0.0 or u.dmy != 0.0:
            tail[WORK + j] += _tilting_work(q, m, j, half, start, area)
        if u.fx == 0.0 and u.fy == 0.0 and u.dfx == 0.0 and u.dfy == 0.0 and u.mz == 0.0 and u.dmz == 0.0:
            continue
        x, y, moment_x, moment_y = 0.0, 0.0, 0.0, 0.0
        for k in range(m.d.modes):
            shape = m.d.shape[j, k]
            x += shape * (px[k] - start_x[k])
            y += shape * (py[k] - start_y[k])
            moment_x += shape * (half * (px[k] + start_x[k]) - area_x[k])
            moment_y += shape * (half * (py[k] + start_y[k]) - area_y[k])
        work = u.fx * x + u.fy * y + u.dfx * moment_x + u.dfy * moment_y
        tail[WORK + j] += work + u.mz * turned + u.dmz * swept
    if moving(m.p.base):
        shaftwise(q, m)[WORK_OUTSIDE] += _work_of_base(q, m, half, start, area)


@kernel
def _tilting_work(q, m, j, half, start, area):
    """The work that `account` adds for the moments that tilt station j (J); half: of the macro step (s)."""
    px, py, _, _ = modal(q, m)
    u, work = m.u.station[j], 0.0
    for k in range(m.d.modes):
        x, y = px[k] - start.x[k], py[k] - start.y[k]
        moment_x = half * (px[k] + start.x[k]) - area.x[k]
        moment_y = half * (py[k] + start.y[k]) - area.y[k]
        work += m.d.tilt[j, k] * (u.my * x - u.mx * y + u.dmy * moment_x - u.dmx * moment_y)
    return work


@kernel
def _work_of_base(q, m, half, start, area):
    """The work that `account` adds for the base's acceleration (J); half: of the macro step (s)."""
    px, py, _, _ = modal(q, m)
    base, jerk, work = base_acceleration(m, 0.0), base_jerk(m), 0.0
    for k in range(m.d.modes):
        moment_x = half * (px[k] + start.x[k]) - area.x[k]
        moment_y = half * (py[k] + start.y[k]) - area.y[k]
        mean = base[0] * (px[k] - start.x[k]) + base[1] * (py[k] - start.y[k])
        work -= m.d.weight[k] * (mean + jerk[0] * moment_x + jerk[1] * moment_y)
    return work


@kernel
def take_mode_loads(q, m):
    """Give each mode of q (N,) what mean and slope did not say of the loads.

    Their work is the energy it brings. What they change of the unbalance's momentum is taken from the spin.
    """
    _, _, vx, vy = modal(q, m)
    tail = auxiliary(q, m)
    angle = tail[ANGLE] + m.p.unbalance_angle
    after = spin_momentum(vx, vy, m, angle)
    for j in range(m.d.stations):
        before = after
        for k in range(m.d.modes):
            slot = int(m.d.slot[j, k])
            if slot >= 0 and not (m.d.lumped[j] > 0.0 and slot == MODES - 1):
                tail[WORK + j] += _kick(q, m, j, k, m.u.station[j].mode[slot])
        after = spin_momentum(vx, vy, m, angle)
        change = (before - after) / m.d.inertia
        tail[WORK + j] += 0.5 * change * (before + after)
        tail[SPIN] += change


@kernel
def _kick(q, m, j, k, load):
    """Move mode k by a `ModeLoad` at station j; returns the energy (J) that brings."""
    px, py, vx, vy = modal(q, m)
    shape = m.d.shape[j, k]
    x, y, u, v = shape * load.qx, shape * load.qy, shape * load.px, shape * load.py
    energy = m.d.stiffness[k] * (x * (px[k] + 0.5 * x) + y * (py[k] + 0.5 * y))
    energy += u * (vx[k] + 0.5 * u) + v * (vy[k] + 0.5 * v)
    px[k] += x
    py[k] += y
    vx[k] += u
    vy[k] += v
    return energy


@dataclass(frozen=True)
class Stride:
    """`oscillator.Step` of every mode, for one length."""

    length: float = real(0.0, "s", "of the stride")
    zz: np.ndarray = array(MAX_MODES)
    zv: np.ndarray = array(MAX_MODES)
    vz: np.ndarray = array(MAX_MODES)
    vv: np.ndarray = array(MAX_MODES)
    zf: np.ndarray = array(MAX_MODES)
    vf: np.ndarray = array(MAX_MODES)
    zg: np.ndarray = array(MAX_MODES)
    vg: np.ndarray = array(MAX_MODES)


class LinearLoad(NamedTuple):
    """Modal forces f + df s, s (s) after the middle of the macro step; (n,) each, N/kg^0.5 and per s."""

    fx: np.ndarray
    fy: np.ndarray
    dfx: np.ndarray
    dfy: np.ndarray


class Swung(NamedTuple):
    """One mode in one plane at the end of a stride, and what it gathered."""

    p: float  # m kg^0.5
    v: float  # m kg^0.5/s
    area: float  # int p dt
    heat: float  # int 2 zeta omega v^2 dt, J


@kernel
def prepare_stride(m, h):
    """Set m.s.stride to every mode's exact stride of h (s), unless it is so already."""
    stride = m.s.stride
    if stride.length == h:
        return
    for k in range(m.d.modes):
        s = numerics.oscillator_step(m.d.stiffness[k], m.d.damping[k], h)
        stride.zz[k], stride.zv[k], stride.vz[k], stride.vv[k] = s.zz, s.zv, s.vz, s.vv
        stride.zf[k], stride.vf[k], stride.zg[k], stride.vg[k] = s.zf, s.vf, s.zg, s.vg
    stride.length = h


@kernel
def swing(q, m, load, since_middle, h, alpha, area):
    """Each mode of q (N,) alone for h (s) about `since_middle` (s), under a `LinearLoad` and unbalance.

    alpha: spin acceleration (rad/s2). Adds int p dt to `area` (`Planar`); returns the heat (J).
    """
    px, py, vx, vy = modal(q, m)
    area_x, area_y = area
    spin, angle = auxiliary(q, m)[SPIN], auxiliary(q, m)[ANGLE] + m.p.unbalance_angle
    angle_end = angle + h * (spin + 0.5 * alpha * h)
    cosine, sine = math.cos(angle), math.sin(angle)
    cosine_end, sine_end = math.cos(angle_end), math.sin(angle_end)
    square, square_end = spin * spin, squared(spin + alpha * h)
    lost = 0.0
    for k in range(m.d.modes):
        fx, fy = load.fx[k] + load.dfx[k] * since_middle, load.fy[k] + load.dfy[k] * since_middle
        dfx, dfy = load.dfx[k], load.dfy[k]
        if m.d.unbalance.present:
            ux, uy = _pull(m, k, cosine, sine, square, alpha)
            ux_end, uy_end = _pull(m, k, cosine_end, sine_end, square_end, alpha)
            fx, fy = fx + 0.5 * (ux + ux_end), fy + 0.5 * (uy + uy_end)
            dfx, dfy = dfx + (ux_end - ux) / h, dfy + (uy_end - uy) / h
        in_x = _along(m, k, h, px[k], vx[k], fx, dfx)
        in_y = _along(m, k, h, py[k], vy[k], fy, dfy)
        px[k], vx[k], py[k], vy[k] = in_x.p, in_x.v, in_y.p, in_y.v
        area_x[k] += in_x.area
        area_y[k] += in_y.area
        lost += in_x.heat + in_y.heat
    return lost


@kernel
def _pull(m, k, cosine, sine, square, alpha):
    """Modal force (x, y) of the unbalance: (square - i alpha) U exp(i theta), square that of the spin."""
    ux, uy = unbalance_of(m, k, cosine, sine)
    return square * ux + alpha * uy, square * uy - alpha * ux


@kernel
def _along(m, k, h, p, v, f, df):
    """`Swung` of mode k over a stride of h (s) under the load f + df (t - h/2), from p and v.

    The heat is the work of the load less the energy gained.
    """
    s, damping, stiffness = m.s.stride, m.d.damping[k], m.d.stiffness[k]
    p_end = s.zz[k] * p + s.zv[k] * v + s.zf[k] * f + s.zg[k] * df
    v_end = s.vz[k] * p + s.vv[k] * v + s.vf[k] * f + s.vg[k] * df
    area = numerics.area(stiffness, damping, h, f, (p, v), (p_end, v_end))
    heat = 0.0
    if damping > 0.0:
        heat = f * (p_end - p) + df * (0.5 * h * (p_end + p) - area)
        heat -= 0.5 * ((v_end - v) * (v_end + v) + stiffness * (p_end - p) * (p_end + p))
    return Swung(p_end, v_end, area, heat)


@kernel
def advance(q, m, step, longest, work):
    """Advance the state q (N,) in place by a macro step of `step` (s), in strides of at most `longest` (s).

    work: scratch, at least seven rows of N. Stresses are looked at after every stride but the last, whose
    end the loads may yet correct.
    """
    state, tail = modal(q, m), auxiliary(q, m)
    strides = max(1, math.ceil(step / longest - 1e-9))
    h = step / strides
    prepare_stride(m, h)
    mean, slope = planar(work[0], m), planar(work[1], m)
    start, area, spare = planar(work[2], m), planar(work[3], m), planar(work[4], m)
    load = LinearLoad(mean.x, mean.y, slope.x, slope.y)
    modal_forces(m, 0.0, load.fx, load.fy)
    modal_force_rates(m, load.dfx, load.dfy)
    # i alpha G p is all but constant over a macro step
    add_spin_up(q, m, spin_up(m, 0.0, tail[SPIN]), load.fx, load.fy)
    for k in range(m.d.modes):  # assigned by slices, this takes numba seconds to compile
        start.x[k], start.y[k], area.x[k], area.y[k] = state.px[k], state.py[k], 0.0, 0.0
    angle, swept = tail[ANGLE], 0.0
    reaction = 0.0  # spin acceleration by the unbalance's reaction, as it was in the stride before
    if m.d.unbalance.present:
        reaction = accelerations(q, m, -0.5 * step, spare.x, spare.y) - spin_up(m, -0.5 * step, tail[SPIN])
    for i in range(strides):
        since_middle = (i + 0.5) * h - 0.5 * step
        turned, reaction = _stride(q, m, since_middle, h, load, reaction, area, spare)
        swept += since_middle * turned
        if m.p.stress.active and i + 1 < strides:
            outputs.stress_peaks(q, m, since_middle + 0.5 * h, work[5:7])
    account(q, m, step, start, area, tail[ANGLE] - angle, swept)
    if m.p.axial == 1:
        for i in range(strides):
            _slide(q, m, i * h - 0.5 * step, h)


@kernel
def _slide(q, m, since_middle, h):
    """Move the rotor along its shaft for h (s), from `since_middle` (s) after the middle; work follows."""
    along, tail, mass = shaftwise(q, m), auxiliary(q, m), m.d.mass
    first = shaft_force(m, since_middle)
    slope = (shaft_force(m, since_middle + h) - first) / h
    v, a, jerk = along[VZ], first / mass, slope / mass
    way = h * (v + h * (a / 2.0 + h * jerk / 6.0))
    late = h * h * (v / 2.0 + h * (a / 3.0 + h * jerk / 8.0))  # int t v dt
    clock = m.time + m.half + since_middle
    push = thrust(m.p, clock)
    along[WORK_OUTSIDE] += push * way + (thrust(m.p, clock + h) - push) / h * late
    for j in range(m.d.stations):
        load = m.u.station[j]
        tail[WORK + j] += (load.fz + load.dfz * since_middle) * way + load.dfz * late
    along[Z] += way
    along[VZ] += h * (a + h * jerk / 2.0)


@kernel
def _stride(q, m, since_middle, h, load, reaction, area, spare):
    """One stride of h (s) about `since_middle` (s) under a `LinearLoad`; area, spare: `Planar`.

    reaction: spin acceleration (rad/s2) by the unbalance, before the stride. Returns (the angle the rotor
    turned by (rad), that acceleration after it).
    """
    _, _, vx, vy = modal(q, m)
    tail = auxiliary(q, m)
    spin = tail[SPIN]
    clock = m.time + m.half + since_middle
    braking = drag(spin, clock, m.p)
    torque = moment(m, since_middle) - braking
    alpha = torque / m.d.inertia + reaction
    middle = tail[ANGLE] + m.p.unbalance_angle + 0.5 * h * spin
    before = spin_momentum(vx, vy, m, middle)
    turn_velocities(vx, vy, 0.5 * h * spin, m, spare.x, spare.y)
    tail[LOSS] += swing(q, m, load, since_middle, h, alpha, area)
    turn_velocities(vx, vy, 0.5 * h * (spin + alpha * h), m, spare.x, spare.y)
    change = (torque * h - spin_momentum(vx, vy, m, middle) + before) / m.d.inertia
    turned = h * (spin + 0.5 * change)
    tail[LOSS] += braking * turned
    tail[BRAKED] += brake_torque(spin, clock, m.p) * turned
    tail[ANGLE] += turned
    tail[SPIN] += change
    return turned, (change - torque * h / m.d.inertia) / h
