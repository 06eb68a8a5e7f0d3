"""How a bearing carries its journal and its housing through a macro step.

The bearing steps first, from the bodies' state at t_n. Within the step it integrates, beside its own
bodies, a copy of the journal and of the housing, each driven by the bearing's own load F(t):

    z'' = a_free + inv_m F(t) [- k/m (z - z_n) - c/m (z' - z'_n)]        omega' = alpha_free + inv_I M(t)

(the bracket for a housing on its springs, where it says so).

With it run the quadratures of what crosses the interface: impulse, first moment in time, and work. The
load handed back is mean + slope (t - t_mid) with the same impulse and first moment, so a body that is a
point mass ends the step exactly where its copy did. For a housing on springs the two numbers are chosen
so that it does, too (`linear_load`); without springs that is the same impulse and first moment again.

At the next restart the copy takes the body's state; half the sum of the loads before and after times
that jump is the work the copy missed, and is accounted for as `jump`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from modelkit.kernel import inlined, kernel
from modelkit.ports import ACCELERATION, VELOCITY, Load, Motion, MountMotion, SeatMotion
from modelkit.status import BAD_INPUT, BAD_LOAD, OK
from modelkit.variables import group, real

# State of the copies and quadratures, at the head of every bearing's state vector.
JX, JY, JVX, JVY, JW = range(5)  # journal copy
JPX, JPY, JPM, JQX, JQY, JQM, JE = range(5, 12)  # impulse, first moment, work
HX, HY, HVX, HVY = range(12, 16)  # housing copy
HFX, HFY, HFVX, HFVY, HE = range(16, 21)  # its response to the load alone, per mass; work
HPX, HPY = range(21, 23)  # impulse
INSIDE = 23  # first component of what is inside the bearing

POSITION_SCALE = 1e-5  # m; an indentation
VELOCITY_SCALE = 0.1  # m/s; a landing
SPIN_SCALE = 1e3  # rad/s
TERMS = 24  # of the series in `linear_load`, enough up to STIFFEST
STIFFEST = 3.0  # half a period of the housing per macro step; beyond, two numbers cannot stand for its load


@dataclass(frozen=True)
class BearingInputs:
    """What every bearing takes."""

    journal: SeatMotion = group(SeatMotion)
    housing: MountMotion = group(MountMotion)


@dataclass(frozen=True)
class SeatMemory:
    """The bearing's last known load: at the end of the last macro step, then at the restart."""

    jx: float = real(0.0, "N", "on the journal")
    jy: float = real(0.0, "N", "on the journal")
    jm: float = real(0.0, "N.m", "on the journal")
    hx: float = real(0.0, "N", "on the housing")
    hy: float = real(0.0, "N", "on the housing")


def weights(inside: list[float]) -> np.ndarray:
    """Error weights of a bearing's state: the copies' and those of what is `inside`."""
    head = np.zeros(INSIDE)
    head[[JX, JY, HX, HY]] = 1.0 / POSITION_SCALE
    head[[JVX, JVY, HVX, HVY]] = 1.0 / VELOCITY_SCALE
    head[JW] = 1.0 / SPIN_SCALE
    return np.concatenate([head, np.array(inside)])


@kernel
def journal_motion(y):
    """Motion of the journal copy."""
    return Motion(y[JX], y[JY], y[JVX], y[JVY], y[JW])


@kernel
def housing_motion(y):
    """Motion of the housing copy, which does not turn."""
    return Motion(y[HX], y[HY], y[HVX], y[HVY], 0.0)


@kernel
def take_inputs(y, m):
    """Set the copies to the bodies' state and clear the quadratures."""
    j = m.u.journal
    y[JX], y[JY], y[JVX], y[JVY], y[JW] = j.x, j.y, j.vx, j.vy, j.omega
    h = m.u.housing
    y[HX], y[HY], y[HVX], y[HVY] = h.x, h.y, h.vx, h.vy
    for i in range(JPX, JE + 1):
        y[i] = 0.0
    for i in range(HFX, HPY + 1):
        y[i] = 0.0


@kernel
def finite_inputs(m):
    """Whether every input is a finite number."""
    j = m.u.journal
    h = m.u.housing
    total = j.x + j.y + j.vx + j.vy + j.ax_free + j.ay_free + j.inv_m + j.omega
    total += j.alpha_free + j.inv_I + h.x + h.y + h.vx + h.vy + h.ax_free + h.ay_free + h.inv_m
    total += h.k_over_m + h.c_over_m
    return math.isfinite(total)


@kernel
def finite_load(m):
    """Whether the load handed over is one."""
    j, h = m.o.journal, m.o.housing
    return math.isfinite(
        j.fx + j.fy + j.mz + j.dfx + j.dfy + j.dmz + h.fx + h.fy + h.dfx + h.dfy + j.work + h.work
    )


@kernel
def copy_rates(t, y, dy, m, half, load):
    """Derivatives of the copies and the quadratures under `load`; `half` is half the macro step (s)."""
    order = m.p.interface.order
    moves = 1.0 if order >= VELOCITY else 0.0
    speeds_up = 1.0 if order >= ACCELERATION else 0.0
    own = load
    if order == ACCELERATION:  # the bearing's own part, as it was at the restart
        own = Load(m.s.seat.jx, m.s.seat.jy, m.s.seat.jm, m.s.seat.hx, m.s.seat.hy)
    s = t - half
    j = m.u.journal
    dy[JX] = moves * y[JVX]
    dy[JY] = moves * y[JVY]
    dy[JVX] = speeds_up * (j.ax_free + j.inv_m * own.jx)
    dy[JVY] = speeds_up * (j.ay_free + j.inv_m * own.jy)
    dy[JW] = speeds_up * (j.alpha_free + j.inv_I * own.jm)
    dy[JPX] = load.jx
    dy[JPY] = load.jy
    dy[JPM] = load.jm
    dy[JQX] = s * load.jx
    dy[JQY] = s * load.jy
    dy[JQM] = s * load.jm
    dy[JE] = load.jx * dy[JX] + load.jy * dy[JY] + load.jm * y[JW]  # of the copy: held, it does not move
    h = m.u.housing
    dy[HX] = moves * y[HVX]
    dy[HY] = moves * y[HVY]
    spring_x = h.k_over_m * (y[HX] - h.x) + h.c_over_m * (y[HVX] - h.vx)
    spring_y = h.k_over_m * (y[HY] - h.y) + h.c_over_m * (y[HVY] - h.vy)
    dy[HVX] = speeds_up * (h.ax_free + h.inv_m * own.hx - spring_x)
    dy[HVY] = speeds_up * (h.ay_free + h.inv_m * own.hy - spring_y)
    dy[HPX] = load.hx
    dy[HPY] = load.hy
    dy[HFX] = y[HFVX]
    dy[HFY] = y[HFVY]
    dy[HFVX] = load.hx - h.k_over_m * y[HFX] - h.c_over_m * y[HFVX]
    dy[HFVY] = load.hy - h.k_over_m * y[HFY] - h.c_over_m * y[HFVY]
    dy[HE] = load.hx * dy[HX] + load.hy * dy[HY]


@kernel
def drift(x, y, v, h, m):
    """The copies' positions in x: those in y and h (s) times the velocities in v (`modelkit.verlet`)."""
    moves = 1.0 if m.p.interface.order >= VELOCITY else 0.0  # a held copy stays
    x[JX] = y[JX] + moves * h * v[JVX]
    x[JY] = y[JY] + moves * h * v[JVY]
    x[HX] = y[HX] + moves * h * v[HVX]
    x[HY] = y[HY] + moves * h * v[HVY]
    x[HFX] = y[HFX] + h * v[HFVX]
    x[HFY] = y[HFY] + h * v[HFVY]


@kernel
def forecast(x, dy, h):
    """Take the copies' velocities in x from the middle of a micro-step of h (s) to its end.

    Their accelerations dy change little from one to the next; with them the work that crosses the seat
    is of second order.
    """
    for i in (JVX, JVY, JW, HVX, HVY, HFVX, HFVY):
        x[i] += 0.5 * h * dy[i]


@kernel
def linear_load(step, k, c, z, v):
    """Mean and slope of the linear load that brings a resting oscillator to (z, v) in `step` (s).

    The oscillator is z'' = f - k z - c z' (k in 1/s2, c in 1/s). With b = (0, 1) and A its matrix, a
    unit load gives S = sum A^i b H^(i+1)/(i+1)!, a unit ramp R = sum A^i b H^(i+2)/(i+2)!.
    """
    w0, w1 = 0.0, step  # A^i b H^(i+1) / (i+1)!
    s0, s1, r0, r1 = 0.0, 0.0, 0.0, 0.0
    for i in range(TERMS):
        s0 += w0
        s1 += w1
        r0 += w0 * step / (i + 2)
        r1 += w1 * step / (i + 2)
        w0, w1 = w1 * step / (i + 2), -(k * w0 + c * w1) * step / (i + 2)
    r0 -= 0.5 * step * s0
    r1 -= 0.5 * step * s1
    determinant = s0 * r1 - s1 * r0
    return (z * r1 - v * r0) / determinant, (s0 * v - s1 * z) / determinant


@kernel
def hand_over(y, m, step):
    """Turn impulses and first moments into the mean and slope that the bodies take."""
    first = 1.0 / step
    second = 12.0 / step**3
    j = m.o.journal
    j.fx, j.fy, j.mz = first * y[JPX], first * y[JPY], first * y[JPM]
    j.dfx, j.dfy, j.dmz = second * y[JQX], second * y[JQY], second * y[JQM]
    j.work += y[JE]
    h = m.o.housing
    u = m.u.housing
    if max(step * math.sqrt(u.k_over_m), step * u.c_over_m) < STIFFEST:
        h.fx, h.dfx = linear_load(step, u.k_over_m, u.c_over_m, y[HFX], y[HFVX])
        h.fy, h.dfy = linear_load(step, u.k_over_m, u.c_over_m, y[HFY], y[HFVY])
    else:
        h.fx, h.fy, h.dfx, h.dfy = first * y[HPX], first * y[HPY], 0.0, 0.0
    h.work += y[HE]


@kernel
def account_jump(m, load, djx, djy, dhx, dhy):
    """Work missed where the copies were moved by (djx, djy) and (dhx, dhy) at the restart."""
    s = m.s.seat
    m.o.journal.jump += 0.5 * ((s.jx + load.jx) * djx + (s.jy + load.jy) * djy)
    m.o.housing.jump += 0.5 * ((s.hx + load.hx) * dhx + (s.hy + load.hy) * dhy)


@kernel
def remember(m, load):
    """Keep `load` as the last known one."""
    s = m.s.seat
    s.jx, s.jy, s.jm, s.hx, s.hy = load.jx, load.jy, load.jm, load.hx, load.hy


@inlined
def begin(react, report, m):
    """First outputs, from state and inputs; the first restart compares with the load now."""
    load = react(0.0, m.y, np.zeros(m.n), m)
    remember(m, load)
    report(m.y, m)


@inlined
def instant(react, t, y, dy, m):
    """Derivative of what is inside and the load now, for a solver that holds all bodies itself.

    The motion comes from m.u; the load goes out as the mean in m.o, its slope zero.
    """
    take_inputs(y, m)
    load = react(t, y, dy, m)
    j, h = m.o.journal, m.o.housing
    j.fx, j.fy, j.mz, j.dfx, j.dfy, j.dmz = load.jx, load.jy, load.jm, 0.0, 0.0, 0.0
    h.fx, h.fy, h.dfx, h.dfy = load.hx, load.hy, 0.0, 0.0


@inlined
def advance(react, integrate, report, m, work, time, step):
    """One macro step of a bearing.

    react(t, y, dy, m) gives the `Load` and the derivative of what is inside; integrate(m, work, step)
    advances the state; report(y, m) fills the outputs that are wanted once per macro step.
    """
    status = BAD_INPUT
    if finite_inputs(m):
        y = m.y
        m.time = time
        jx, jy, hx, hy = y[JX], y[JY], y[HX], y[HY]
        take_inputs(y, m)
        m.half = 0.5 * step
        before = react(0.0, y, work[0], m)
        account_jump(m, before, y[JX] - jx, y[JY] - jy, y[HX] - hx, y[HY] - hy)
        remember(m, before)
        m.h, status, evaluations = integrate(m, work, step)
        m.evaluations += evaluations
        hand_over(y, m, step)
        remember(m, react(step, y, work[0], m))
        report(y, m)
        if status == OK and not finite_load(m):
            status = BAD_LOAD
    return status
