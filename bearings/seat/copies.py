"""The copies of journal and housing: how they take the bodies' state and move under the bearing's load.

The journal's copy is a point mass, or with a flexible rotor the sum of one and of the rotor's elastic
modes; the housing's is a mass on its springs. Quadratures of the load run beside them.
"""

from __future__ import annotations

import math

from touchdown.bearings.seat.layout import (
    HE,
    HFVX,
    HFVY,
    HFX,
    HFY,
    HPX,
    HPY,
    HVX,
    HVY,
    HX,
    HY,
    JE,
    JPM,
    JPX,
    JPY,
    JQM,
    JQX,
    JQY,
    JVX,
    JVY,
    JW,
    JX,
    JY,
    PER_MODE,
    POSITION_SCALE,
    PX,
    PY,
    QX,
    QY,
    VELOCITY_SCALE,
    ZVX,
    ZVY,
    ZX,
    ZY,
)
from touchdown.modelkit.kernel import kernel, woven
from touchdown.modelkit.ports import ACCELERATION, MODEL, MODES, VELOCITY, Load, Motion


@kernel
def journal_motion(q):
    """`Motion` of the journal copy (m, m/s, rad/s) in the state q."""
    return Motion(q[JX], q[JY], q[JVX], q[JVY], q[JW])


@kernel
def housing_motion(q):
    """`Motion` of the housing copy (m, m/s), which does not turn, in the state q."""
    return Motion(q[HX], q[HY], q[HVX], q[HVY], 0.0)


@kernel
def take_modes(m):
    """Note which elastic modes the rotor tells of, and make room for them in the state.

    Sets m.s.seat and lengthens m.q and m.weight by `PER_MODE` components for each mode.
    """
    s = m.s.seat
    s.inside, s.modes, s.fastest = m.n, 0, 0.0
    if m.p.interface.order < MODEL:
        return
    while s.modes < MODES and m.u.journal.mode[s.modes].inv_m > 0.0:
        z = m.u.journal.mode[s.modes]
        i = m.n
        m.q[i + ZX], m.q[i + ZY], m.q[i + ZVX], m.q[i + ZVY] = z.x, z.y, z.vx, z.vy
        for w in range(PER_MODE):
            m.weight[i + w] = 0.0
        m.weight[i + ZX] = m.weight[i + ZY] = 1.0 / POSITION_SCALE
        m.weight[i + ZVX] = m.weight[i + ZVY] = 1.0 / VELOCITY_SCALE
        s.fastest = max(s.fastest, math.sqrt(z.k_over_m))
        s.modes += 1
        m.n += PER_MODE


@kernel
def take_inputs(q, m):
    """Set the copies in q to the bodies' state in m.u and clear the quadratures."""
    j = m.u.journal
    q[JX], q[JY], q[JVX], q[JVY], q[JW] = j.x, j.y, j.vx, j.vy, j.omega
    h = m.u.housing
    q[HX], q[HY], q[HVX], q[HVY] = h.x, h.y, h.vx, h.vy
    for k in range(m.s.seat.modes):
        i, z = m.s.seat.inside + PER_MODE * k, j.mode[k]
        q[i + ZX], q[i + ZY], q[i + ZVX], q[i + ZVY] = z.x, z.y, z.vx, z.vy
    clear(q, m)


@kernel
def clear(q, m):
    """Clear what the state q gathers over a macro step: impulse, moment, work, responses to the load."""
    for i in range(JPX, JE + 1):
        q[i] = 0.0
    for i in range(HFX, HPY + 1):
        q[i] = 0.0
    for k in range(m.s.seat.modes):
        i = m.s.seat.inside + PER_MODE * k
        q[i + QX], q[i + QY], q[i + PX], q[i + PY] = 0.0, 0.0, 0.0, 0.0


@kernel
def copy_rates(t, q, dq, m, half, load):
    """Derivatives dq of the copies and the quadratures under `load` (`Load`: N, N m).

    t: time in the macro step (s); half: half the macro step (s).
    """
    order = m.p.interface.order
    moves = 1.0 if order >= VELOCITY else 0.0
    speeds_up = 1.0 if order >= ACCELERATION else 0.0
    own = load
    if order == ACCELERATION:  # the bearing's own part, as it was at the restart
        own = Load(m.s.seat.jx, m.s.seat.jy, m.s.seat.jm, m.s.seat.hx, m.s.seat.hy)
    s = t - half
    j = m.u.journal
    dq[JX] = moves * q[JVX]
    dq[JY] = moves * q[JVY]
    back_x, back_y = _mode_rates(q, dq, m, load)
    dq[JVX] = speeds_up * (j.ax_free + j.inv_m * own.jx) - back_x
    dq[JVY] = speeds_up * (j.ay_free + j.inv_m * own.jy) - back_y
    dq[JW] = speeds_up * (j.alpha_free + j.inv_I * own.jm)
    dq[JPX] = load.jx
    dq[JPY] = load.jy
    dq[JPM] = load.jm
    dq[JQX] = s * load.jx
    dq[JQY] = s * load.jy
    dq[JQM] = s * load.jm
    dq[JE] = load.jx * dq[JX] + load.jy * dq[JY] + load.jm * q[JW]  # of the copy: held, it does not move
    h = m.u.housing
    dq[HX] = moves * q[HVX]
    dq[HY] = moves * q[HVY]
    spring_x = h.k_over_m * (q[HX] - h.x) + h.c_over_m * (q[HVX] - h.vx)
    spring_y = h.k_over_m * (q[HY] - h.y) + h.c_over_m * (q[HVY] - h.vy)
    dq[HVX] = speeds_up * (h.ax_free + h.inv_m * own.hx - spring_x)
    dq[HVY] = speeds_up * (h.ay_free + h.inv_m * own.hy - spring_y)
    dq[HPX] = load.hx
    dq[HPY] = load.hy
    dq[HFX] = q[HFVX]
    dq[HFY] = q[HFVY]
    dq[HFVX] = load.hx - h.k_over_m * q[HFX] - h.c_over_m * q[HFVX]
    dq[HFVY] = load.hy - h.k_over_m * q[HFY] - h.c_over_m * q[HFVY]
    dq[HE] = load.hx * dq[HX] + load.hy * dq[HY]


@kernel
def _mode_rates(q, dq, m, load):
    """Derivatives dq of the elastic modes under `load`; returns how they pull the journal back (m/s2)."""
    back_x, back_y = 0.0, 0.0
    for n in range(m.s.seat.modes):
        i, z = m.s.seat.inside + PER_MODE * n, m.u.journal.mode[n]
        k, c = z.k_over_m, z.c_over_m
        pull_x = k * (q[i + ZX] - z.x) + c * (q[i + ZVX] - z.vx)
        pull_y = k * (q[i + ZY] - z.y) + c * (q[i + ZVY] - z.vy)
        dq[i + ZX] = q[i + ZVX]
        dq[i + ZY] = q[i + ZVY]
        dq[i + ZVX] = z.ax_free + z.inv_m * load.jx - pull_x
        dq[i + ZVY] = z.ay_free + z.inv_m * load.jy - pull_y
        dq[i + QX] = q[i + PX]
        dq[i + QY] = q[i + PY]
        dq[i + PX] = load.jx - k * q[i + QX] - c * q[i + PX]
        dq[i + PY] = load.jy - k * q[i + QY] - c * q[i + PY]
        back_x += pull_x
        back_y += pull_y
    return back_x, back_y


@woven
def drift(trial, q, mid, h, m):
    """The copies' positions in the state `trial`: those in q and h (s) times the velocities in `mid`."""
    moves = 1.0 if m.p.interface.order >= VELOCITY else 0.0  # a held copy stays
    trial[JX] = q[JX] + moves * h * mid[JVX]
    trial[JY] = q[JY] + moves * h * mid[JVY]
    trial[HX] = q[HX] + moves * h * mid[HVX]
    trial[HY] = q[HY] + moves * h * mid[HVY]
    trial[HFX] = q[HFX] + h * mid[HFVX]
    trial[HFY] = q[HFY] + h * mid[HFVY]
    _drift_modes(trial, q, mid, h, m)


@woven
def _drift_modes(trial, q, mid, h, m):
    """`drift` of the elastic modes, in the states `trial`, q and `mid` (m.n,)."""
    for n in range(m.s.seat.modes):
        i = m.s.seat.inside + PER_MODE * n
        trial[i + ZX] = q[i + ZX] + h * mid[i + ZVX]
        trial[i + ZY] = q[i + ZY] + h * mid[i + ZVY]
        trial[i + QX] = q[i + QX] + h * mid[i + PX]
        trial[i + QY] = q[i + QY] + h * mid[i + PY]


@woven
def forecast(trial, dq, h):
    """Take the copies' velocities in `trial` from the middle of a micro-step of h (s) to its end.

    Their accelerations dq change little from one to the next; with them the work that crosses the seat
    is of second order.
    """
    for i in (JVX, JVY, JW, HVX, HVY, HFVX, HFVY):
        trial[i] += 0.5 * h * dq[i]
