"""A bearing's macro step: the order in which it is taken, and the load that it hands over.

The load is handed over as mean and slope over the macro step, with the elastic modes' part beside them
(`hand_over`). With the impulse P and the first moment Q about the middle of a step of H seconds

    mean = P/H        slope = 12 Q/H^3

or, for a housing on springs, the two numbers that bring it where its copy went. Half the sum of the loads
before and after a restart times the jump of the copy is booked (`account_jump`).

A bearing brings four kernels, which are compiled into the functions below:

    react(t, q, dq, m)          the `Load` (N, N m) at t (s), and in dq the derivative of what is inside
    integrate(m, work, span)    advances m.q by span (s): (micro-step to try next (s), status, evaluations);
                                the first row of work holds the state's derivative at the start
    observe(t, q, m)            keeps peaks and events, after each accepted micro-step
    report(q, m)                fills the outputs that are wanted once per macro step
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ...modelkit import numerics
from ...modelkit.integrators import dopri
from ...modelkit.kernel import kernel
from ...modelkit.ports import MODEL
from ...modelkit.status import BAD_INPUT, BAD_LOAD, OK
from .along import HZ, JPZ, JZ, hand_along
from .copies import (
    HE,
    HFVX,
    HFVY,
    HFX,
    HFY,
    HPX,
    HPY,
    HX,
    HY,
    IMPULSE_SCALE,
    JE,
    JPM,
    JPX,
    JPY,
    JQM,
    JQX,
    JQY,
    JX,
    JY,
    PER_MODE,
    PX,
    PY,
    QX,
    QY,
    clear,
    copy_rates,
    take_inputs,
    take_modes,
)
from .tilt import JPMX, JPMY, JRX, JRY, MOMENT_IMPULSE_SCALE, hand_tilt

# Half a period of the housing per macro step; beyond, two numbers cannot stand for its load
MAX_HALF_PERIODS = 3.0
BODY_LOAD_SIZE = 18  # numbers of the load on journal and housing; each mode has four more


@kernel
def hand_over(q, m, step):
    """Turn impulses and first moments in q into the mean (N) and slope (N/s) that the bodies take, in m.o.

    step: the macro step (s).
    """
    first = 1.0 / step
    second = 12.0 / (step * step * step)
    j = m.o.journal
    j.fx, j.fy, j.mz = first * q[JPX], first * q[JPY], first * q[JPM]
    j.dfx, j.dfy, j.dmz = second * q[JQX], second * q[JQY], second * q[JQM]
    hand_tilt(q, m, first, second)
    j.work += q[JE]
    _hand_modes_over(q, m, step)
    h = m.o.housing
    u = m.u.housing
    if max(step * math.sqrt(u.k_over_m), step * u.c_over_m) < MAX_HALF_PERIODS:
        response = numerics.step(u.k_over_m, u.c_over_m, step)
        h.fx, h.dfx = numerics.load_for(response, q[HFX], q[HFVX])
        h.fy, h.dfy = numerics.load_for(response, q[HFY], q[HFVY])
    else:
        h.fx, h.fy, h.dfx, h.dfy = first * q[HPX], first * q[HPY], 0.0, 0.0
    hand_along(q, m, step, MAX_HALF_PERIODS)
    h.work += q[HE]


@kernel
def _hand_modes_over(q, m, step):
    """Put into m.o the load on the elastic modes (kg m, N s) that mean and slope leave out."""
    j = m.o.journal
    for n in range(m.s.seat.modes):
        i, z, lacking = m.s.seat.inside + PER_MODE * n, m.u.journal.mode[n], j.mode[n]
        response = numerics.step(z.k_over_m, z.c_over_m, step)
        fx, dfx = j.fx + z.slope * j.my, j.dfx + z.slope * j.dmy
        fy, dfy = j.fy - z.slope * j.mx, j.dfy - z.slope * j.dmx
        lacking.qx = q[i + QX] - (response.zf * fx + response.zg * dfx)
        lacking.qy = q[i + QY] - (response.zf * fy + response.zg * dfy)
        lacking.px = q[i + PX] - (response.vf * fx + response.vg * dfx)
        lacking.py = q[i + PY] - (response.vf * fy + response.vg * dfy)


@kernel
def hand_now(m, load):
    """Put a momentary load (`Load`: N, N m) in the outputs as the mean, its slope zero."""
    j, h = m.o.journal, m.o.housing
    j.fx, j.fy, j.mz, j.dfx, j.dfy, j.dmz = load.jx, load.jy, load.jm, 0.0, 0.0, 0.0
    h.fx, h.fy, h.dfx, h.dfy = load.hx, load.hy, 0.0, 0.0
    j.fz, j.dfz, h.fz, h.dfz = load.jz, 0.0, load.hz, 0.0
    j.mx, j.my, j.dmx, j.dmy = load.jmx, load.jmy, 0.0, 0.0


@kernel
def handed_over(m):
    """The load as it stands in m.o, in its units: (18 + 4 modes,) on journal, housing and modes."""
    j, h = m.o.journal, m.o.housing
    load = np.empty(BODY_LOAD_SIZE + 4 * m.s.seat.modes)
    load[0], load[1], load[2], load[3], load[4], load[5] = j.fx, j.fy, j.mz, j.dfx, j.dfy, j.dmz
    load[6], load[7], load[8], load[9] = h.fx, h.fy, h.dfx, h.dfy
    load[10], load[11], load[12], load[13] = j.fz, j.dfz, h.fz, h.dfz
    load[14], load[15], load[16], load[17] = j.mx, j.my, j.dmx, j.dmy
    for k in range(m.s.seat.modes):
        i, z = BODY_LOAD_SIZE + 4 * k, j.mode[k]
        load[i], load[i + 1], load[i + 2], load[i + 3] = z.qx, z.qy, z.px, z.py
    return load


@kernel
def hand_instead(m, load):
    """Put a load from `handed_over`, (18 + 4 modes,), in the outputs."""
    j, h = m.o.journal, m.o.housing
    j.fx, j.fy, j.mz, j.dfx, j.dfy, j.dmz = load[0], load[1], load[2], load[3], load[4], load[5]
    h.fx, h.fy, h.dfx, h.dfy = load[6], load[7], load[8], load[9]
    j.fz, j.dfz, h.fz, h.dfz = load[10], load[11], load[12], load[13]
    j.mx, j.my, j.dmx, j.dmy = load[14], load[15], load[16], load[17]
    for k in range(m.s.seat.modes):
        i, z = BODY_LOAD_SIZE + 4 * k, j.mode[k]
        z.qx, z.qy, z.px, z.py = load[i], load[i + 1], load[i + 2], load[i + 3]


@kernel
def is_finite(m):
    """Whether every number of the load handed over to journal and housing is finite."""
    j, h = m.o.journal, m.o.housing
    total = j.fx + j.fy + j.mz + j.dfx + j.dfy + j.dmz + h.fx + h.fy + h.dfx + h.dfy + j.work + h.work
    total += j.mx + j.my + j.dmx + j.dmy
    return math.isfinite(total + j.fz + j.dfz + h.fz + h.dfz)


class Places(NamedTuple):
    """Where the copies of journal and housing are (m), and how the journal's is tilted (rad)."""

    jx: float
    jy: float
    jz: float
    hx: float
    hy: float
    hz: float
    rx: float
    ry: float


@kernel
def places(q):
    """`Places` (m, rad) in the state q."""
    return Places(q[JX], q[JY], q[JZ], q[HX], q[HY], q[HZ], q[JRX], q[JRY])


@kernel
def account_jump(m, load, before, now):
    """Work (J) missed where the restart moved the copies from `before` to `now` (`Places`)."""
    s = m.s.seat
    across = (s.jx + load.jx) * (now.jx - before.jx) + (s.jy + load.jy) * (now.jy - before.jy)
    turned = (s.jmx + load.jmx) * (now.rx - before.rx) + (s.jmy + load.jmy) * (now.ry - before.ry)
    m.o.journal.jump += 0.5 * (across + (s.jz + load.jz) * (now.jz - before.jz) + turned)
    across = (s.hx + load.hx) * (now.hx - before.hx) + (s.hy + load.hy) * (now.hy - before.hy)
    m.o.housing.jump += 0.5 * (across + (s.hz + load.hz) * (now.hz - before.hz))


@kernel
def remember(m, load):
    """Keep `load` (`Load`: N, N m) as the last known one."""
    s = m.s.seat
    s.jx, s.jy, s.jm, s.hx, s.hy = load.jx, load.jy, load.jm, load.hx, load.hy
    s.jz, s.hz, s.jmx, s.jmy = load.jz, load.hz, load.jmx, load.jmy


@kernel
def finite_inputs(m):
    """Whether every input that is in use is a finite number."""
    j = m.u.journal
    total = j.x + j.y + j.vx + j.vy + j.ax_free + j.ay_free + j.inv_m + j.omega
    total += j.alpha_free + j.inv_I + _sum_of(m.u.housing) + _sum_along(j)
    total += _sum_along(m.u.housing) + m.u.housing.k_over_m_z + m.u.housing.c_over_m_z
    total += j.rx + j.ry + j.wx + j.wy + j.alpha_x_free + j.alpha_y_free + j.inv_I_t + j.inv_mI + j.gyro
    for k in range(m.s.seat.modes):
        total += _sum_of(j.mode[k]) + j.mode[k].slope
    return math.isfinite(total)


@kernel
def _sum_of(z):
    """Of all numbers of a `SprungMotion`, in no unit: finite where each of them is."""
    return z.x + z.y + z.vx + z.vy + z.ax_free + z.ay_free + z.inv_m + z.k_over_m + z.c_over_m


@kernel
def _sum_along(z):
    """Of all numbers of an `AxialMotion`, in no unit."""
    return z.z + z.vz + z.az_free + z.inv_m_z


@kernel
def _weigh_impulse(m):
    """Have micro-steps resolve the load where no copy moves under it, and so none would show its error.

    Sets the impulse's error weights, 1/(N s), and 1/(N m s) of the moments in a bearing that has any.
    """
    if m.p.interface.order < MODEL or m.u.journal.inv_m == 0.0:
        m.weight[JPX] = m.weight[JPY] = 1.0 / IMPULSE_SCALE
    if m.p.interface.order < MODEL or m.u.journal.inv_m_z == 0.0:
        m.weight[JPZ] = 1.0 / IMPULSE_SCALE
    if m.weight[JRX] > 0.0 and (m.p.interface.order < MODEL or m.u.journal.inv_I_t == 0.0):
        m.weight[JPMX] = m.weight[JPMY] = 1.0 / MOMENT_IMPULSE_SCALE


@kernel
def begin(react, report, m):
    """First outputs, from state and inputs; the first restart compares with the load now."""
    take_modes(m)
    _weigh_impulse(m)
    load = react(0.0, m.q, np.zeros(m.n), m)
    remember(m, load)
    report(m.q, m)


@kernel
def instant(react, t, q, dq, m):
    """Derivative dq of what is inside and the load now, for a solver that holds all bodies itself.

    The motion comes from m.u; the load (N, N m) goes out as the mean in m.o, its slope zero.
    """
    take_inputs(q, m)
    load = react(t, q, dq, m)
    hand_now(m, load)


@kernel
def integrate(rhs, observe, m, work, span):
    """Advance m.q by `span` (s) in adaptive steps of the error interface.tolerance.

    rhs(t, q, dq, m): derivative dq of the whole state; work: rows of scratch as long as the state.
    Returns (micro-step to try next (s), status, evaluations).
    """
    tolerance = m.p.interface.tolerance
    return dopri.integrate(rhs, observe, m, m.q, m.n, m.weight, work, span, m.h, tolerance)


@kernel
def any_time(m, since):
    """A bearing whose law does not depend on time has nothing to get ready; since: s."""


@kernel
def advance(react, integrate, report, words, m, work, time, step):
    """One macro step of `step` (s) from `time` (s); returns a status.

    words: the bearing's memory, which m is as a record; work: rows of scratch as long as the state.
    """
    return advance_timed(any_time, react, integrate, report, words, m, work, time, step)


@kernel
def advance_timed(ready, react, integrate, report, words, m, work, time, step):
    """`advance` of a bearing that looks at the clock.

    ready(m, since) prepares it for the stretch of 2 m.half (s) that begins at m.time, `since` (s) after
    the inputs.
    """
    status = BAD_INPUT
    if finite_inputs(m):
        q = m.q
        m.time = time
        m.half = 0.5 * step
        left = places(q)
        take_inputs(q, m)
        ready(m, 0.0)
        before = react(0.0, q, work[0], m)
        account_jump(m, before, left, places(q))
        remember(m, before)
        copy_rates(0.0, q, work[0], m, m.half, before)
        m.h, status, evaluations = integrate(m, work, step)
        m.evaluations += evaluations
        hand_over(q, m, step)
        remember(m, react(step, q, work[0], m))
        report(q, m)
        if status == OK and m.p.interface.lead == 1:
            kept = words.copy()
            m.time = time + step
            ready(m, step)
            clear(q, m)
            copy_rates(0.0, q, work[0], m, m.half, react(0.0, q, work[0], m))
            _, status, evaluations = integrate(m, work, step)
            hand_over(q, m, step)
            ahead = handed_over(m)
            for i in range(len(words)):  # a slice would bring the texts of refusals into the machine code
                words[i] = kept[i]
            m.evaluations += evaluations
            hand_instead(m, ahead)
        if status == OK and not is_finite(m):
            status = BAD_LOAD
    return status
