"""How a bearing carries its journal and its housing through a macro step.

The bearing steps first, from the bodies' state at t_n. Within the step it integrates, beside its own
bodies, a copy of the journal and of the housing, each driven by the bearing's own load F(t):

    z'' = a_free + inv_m F(t) [- k/m (z - z_n) - c/m (z' - z'_n)]        omega' = alpha_free + inv_I M(t)

(the bracket for a housing on its springs, where it says so). A journal on a flexible rotor is the sum of
a point mass and of such oscillators, one for each of the rotor's elastic modes that it is told of.

With it run the quadratures of what crosses the interface: impulse, first moment in time, and work. The
load handed back is mean + slope (t - t_mid) with the same impulse and first moment, so a body that is a
point mass ends the step exactly where its copy did. For a housing on springs the two numbers are chosen
so that it does, too (`modelkit.oscillator.load_for`); without springs that is the same impulse and first
moment again. For elastic modes, which may be faster than the macro step, what mean and slope leave open
is handed over beside them (`ModeLoad`).

At the next restart the copy takes the body's state; half the sum of the loads before and after times
that jump is the work the copy missed, and is accounted for as `jump`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from touchdown.modelkit import oscillator
from touchdown.modelkit.kernel import inlined, kernel
from touchdown.modelkit.model import memory_layout
from touchdown.modelkit.ports import (
    ACCELERATION,
    MODEL,
    MODES,
    VELOCITY,
    FlexibleSeatMotion,
    Load,
    Motion,
    MountMotion,
)
from touchdown.modelkit.status import BAD_INPUT, BAD_LOAD, OK
from touchdown.modelkit.variables import Nothing, group, integer, real

# State of the copies and quadratures, at the head of every bearing's state vector.
JX, JY, JVX, JVY, JW = range(5)  # journal copy
JPX, JPY, JPM, JQX, JQY, JQM, JE = range(5, 12)  # impulse, first moment, work
HX, HY, HVX, HVY = range(12, 16)  # housing copy
HFX, HFY, HFVX, HFVY, HE = range(16, 21)  # its response to the load alone, per mass; work
HPX, HPY = range(21, 23)  # impulse
INSIDE = 23  # first component of what is inside the bearing
# Of each elastic mode, behind what is inside: its share in the journal copy's motion, and the response
# of a mode of unit inv_m to the load alone.
ZX, ZY, ZVX, ZVY, QX, QY, PX, PY = range(8)
PER_MODE = 8
ROOM = PER_MODE * MODES  # in the state vector

POSITION_SCALE = 1e-5  # m; an indentation
VELOCITY_SCALE = 0.1  # m/s; a landing
SPIN_SCALE = 1e3  # rad/s
IMPULSE_SCALE = 0.1  # N s; of a kilogram that lands
STIFFEST = 3.0  # half a period of the housing per macro step; beyond, two numbers cannot stand for its load


@dataclass(frozen=True)
class BearingInputs:
    """What every bearing takes."""

    journal: FlexibleSeatMotion = group(FlexibleSeatMotion)
    housing: MountMotion = group(MountMotion)


@dataclass(frozen=True)
class SeatMemory:
    """The bearing's last known load: at the end of the last macro step, then at the restart."""

    jx: float = real(0.0, "N", "on the journal")
    jy: float = real(0.0, "N", "on the journal")
    jm: float = real(0.0, "N.m", "on the journal")
    hx: float = real(0.0, "N", "on the housing")
    hy: float = real(0.0, "N", "on the housing")
    inside: int = integer(0, "components of the state up to the elastic modes")
    modes: int = integer(0, "elastic modes that are carried")
    fastest: float = real(0.0, "rad/s", "largest angular frequency among them")


def bearing_memory(
    parameters: type,
    outputs: type,
    size: int,
    derived: type = Nothing,
    hidden: type = Nothing,
    inputs: type = BearingInputs,
) -> np.dtype:
    """Memory of a bearing whose state, with the copies, has up to `size` components."""
    return memory_layout(parameters, inputs, outputs, size + ROOM, derived, hidden)


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
    for k in range(m.s.seat.modes):
        i, z = m.s.seat.inside + PER_MODE * k, j.mode[k]
        y[i + ZX], y[i + ZY], y[i + ZVX], y[i + ZVY] = z.x, z.y, z.vx, z.vy
    clear(y, m)


@kernel
def clear(y, m):
    """Clear what is gathered over a macro step: impulse, first moment, work, responses to the load."""
    for i in range(JPX, JE + 1):
        y[i] = 0.0
    for i in range(HFX, HPY + 1):
        y[i] = 0.0
    for k in range(m.s.seat.modes):
        i = m.s.seat.inside + PER_MODE * k
        y[i + QX], y[i + QY], y[i + PX], y[i + PY] = 0.0, 0.0, 0.0, 0.0


@kernel
def take_modes(m):
    """Note which elastic modes the rotor tells of, and make room for them in the state."""
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
def finite_inputs(m):
    """Whether every input is a finite number."""
    j = m.u.journal
    h = m.u.housing
    total = j.x + j.y + j.vx + j.vy + j.ax_free + j.ay_free + j.inv_m + j.omega
    total += j.alpha_free + j.inv_I + h.x + h.y + h.vx + h.vy + h.ax_free + h.ay_free + h.inv_m
    total += h.k_over_m + h.c_over_m
    for k in range(m.s.seat.modes):
        z = j.mode[k]
        total += z.x + z.y + z.vx + z.vy + z.ax_free + z.ay_free + z.inv_m + z.k_over_m + z.c_over_m
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
    back_x, back_y = _mode_rates(y, dy, m, load)
    dy[JVX] = speeds_up * (j.ax_free + j.inv_m * own.jx) - back_x
    dy[JVY] = speeds_up * (j.ay_free + j.inv_m * own.jy) - back_y
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
def _mode_rates(y, dy, m, load):
    """Derivatives of the elastic modes under `load`; returns how they pull the journal back (m/s2)."""
    back_x, back_y = 0.0, 0.0
    for n in range(m.s.seat.modes):
        i, z = m.s.seat.inside + PER_MODE * n, m.u.journal.mode[n]
        k, c = z.k_over_m, z.c_over_m
        pull_x = k * (y[i + ZX] - z.x) + c * (y[i + ZVX] - z.vx)
        pull_y = k * (y[i + ZY] - z.y) + c * (y[i + ZVY] - z.vy)
        dy[i + ZX] = y[i + ZVX]
        dy[i + ZY] = y[i + ZVY]
        dy[i + ZVX] = z.ax_free + z.inv_m * load.jx - pull_x
        dy[i + ZVY] = z.ay_free + z.inv_m * load.jy - pull_y
        dy[i + QX] = y[i + PX]
        dy[i + QY] = y[i + PY]
        dy[i + PX] = load.jx - k * y[i + QX] - c * y[i + PX]
        dy[i + PY] = load.jy - k * y[i + QY] - c * y[i + PY]
        back_x += pull_x
        back_y += pull_y
    return back_x, back_y


@kernel
def drift(x, y, v, h, m):
    """The copies' positions in x: those in y and h (s) times the velocities in v (`verlet`)."""
    moves = 1.0 if m.p.interface.order >= VELOCITY else 0.0  # a held copy stays
    x[JX] = y[JX] + moves * h * v[JVX]
    x[JY] = y[JY] + moves * h * v[JVY]
    x[HX] = y[HX] + moves * h * v[HVX]
    x[HY] = y[HY] + moves * h * v[HVY]
    x[HFX] = y[HFX] + h * v[HFVX]
    x[HFY] = y[HFY] + h * v[HFVY]
    _drift_modes(x, y, v, h, m)


@kernel
def forecast(x, dy, h):
    """Take the copies' velocities in x from the middle of a micro-step of h (s) to its end.

    Their accelerations dy change little from one to the next; with them the work that crosses the seat
    is of second order.
    """
    for i in (JVX, JVY, JW, HVX, HVY, HFVX, HFVY):
        x[i] += 0.5 * h * dy[i]


@kernel
def _drift_modes(x, y, v, h, m):
    """`drift` of the elastic modes."""
    for n in range(m.s.seat.modes):
        i = m.s.seat.inside + PER_MODE * n
        x[i + ZX] = y[i + ZX] + h * v[i + ZVX]
        x[i + ZY] = y[i + ZY] + h * v[i + ZVY]
        x[i + QX] = y[i + QX] + h * v[i + PX]
        x[i + QY] = y[i + QY] + h * v[i + PY]


@kernel
def _hand_modes_over(y, m, step):
    """What mean and slope do not say of the load to the elastic modes."""
    j = m.o.journal
    for n in range(m.s.seat.modes):
        i, z, o = m.s.seat.inside + PER_MODE * n, m.u.journal.mode[n], j.mode[n]
        found = oscillator.step(z.k_over_m, z.c_over_m, step)
        o.qx = y[i + QX] - (found.zf * j.fx + found.zg * j.dfx)
        o.qy = y[i + QY] - (found.zf * j.fy + found.zg * j.dfy)
        o.px = y[i + PX] - (found.vf * j.fx + found.vg * j.dfx)
        o.py = y[i + PY] - (found.vf * j.fy + found.vg * j.dfy)


@kernel
def hand_over(y, m, step):
    """Turn impulses and first moments into the mean and slope that the bodies take."""
    first = 1.0 / step
    second = 12.0 / step**3
    j = m.o.journal
    j.fx, j.fy, j.mz = first * y[JPX], first * y[JPY], first * y[JPM]
    j.dfx, j.dfy, j.dmz = second * y[JQX], second * y[JQY], second * y[JQM]
    j.work += y[JE]
    _hand_modes_over(y, m, step)
    h = m.o.housing
    u = m.u.housing
    if max(step * math.sqrt(u.k_over_m), step * u.c_over_m) < STIFFEST:
        found = oscillator.step(u.k_over_m, u.c_over_m, step)
        h.fx, h.dfx = oscillator.load_for(found, y[HFX], y[HFVX])
        h.fy, h.dfy = oscillator.load_for(found, y[HFY], y[HFVY])
    else:
        h.fx, h.fy, h.dfx, h.dfy = first * y[HPX], first * y[HPY], 0.0, 0.0
    h.work += y[HE]


@kernel
def handed_over(m):
    """The load as it stands in the outputs: on the journal, on the housing, on the modes."""
    j, h = m.o.journal, m.o.housing
    found = np.empty(10 + 4 * m.s.seat.modes)
    found[0], found[1], found[2], found[3], found[4], found[5] = j.fx, j.fy, j.mz, j.dfx, j.dfy, j.dmz
    found[6], found[7], found[8], found[9] = h.fx, h.fy, h.dfx, h.dfy
    for k in range(m.s.seat.modes):
        i, z = 10 + 4 * k, j.mode[k]
        found[i], found[i + 1], found[i + 2], found[i + 3] = z.qx, z.qy, z.px, z.py
    return found


@kernel
def hand_instead(m, load):
    """Put a load from `handed_over` in the outputs."""
    j, h = m.o.journal, m.o.housing
    j.fx, j.fy, j.mz, j.dfx, j.dfy, j.dmz = load[0], load[1], load[2], load[3], load[4], load[5]
    h.fx, h.fy, h.dfx, h.dfy = load[6], load[7], load[8], load[9]
    for k in range(m.s.seat.modes):
        i, z = 10 + 4 * k, j.mode[k]
        z.qx, z.qy, z.px, z.py = load[i], load[i + 1], load[i + 2], load[i + 3]


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


@kernel
def _weigh_impulse(m):
    """Have micro-steps resolve the load where no copy moves under it, and so none would show its error."""
    if m.p.interface.order < MODEL or m.u.journal.inv_m == 0.0:
        m.weight[JPX] = m.weight[JPY] = 1.0 / IMPULSE_SCALE


@inlined
def begin(react, report, m):
    """First outputs, from state and inputs; the first restart compares with the load now."""
    take_modes(m)
    _weigh_impulse(m)
    load = react(0.0, m.q, np.zeros(m.n), m)
    remember(m, load)
    report(m.q, m)


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


@kernel
def any_time(m, since):
    """A bearing whose law does not depend on time has nothing to get ready."""


@inlined
def advance(react, integrate, report, words, m, work, time, step):
    """One macro step of a bearing whose memory is `words`, seen as the record m.

    react(t, y, dy, m) gives the `Load` and the derivative of what is inside; integrate(m, work, step)
    advances the state; report(y, m) fills the outputs that are wanted once per macro step.
    """
    return advance_timed(any_time, react, integrate, report, words, m, work, time, step)


@inlined
def advance_timed(ready, react, integrate, report, words, m, work, time, step):
    """`advance` of a bearing that looks at the clock.

    ready(m, since) prepares it for the stretch of 2 m.half (s) that begins at m.time, `since` (s) after
    the inputs.
    """
    status = BAD_INPUT
    if finite_inputs(m):
        y = m.q
        m.time = time
        m.half = 0.5 * step
        jx, jy, hx, hy = y[JX], y[JY], y[HX], y[HY]
        take_inputs(y, m)
        ready(m, 0.0)
        before = react(0.0, y, work[0], m)
        account_jump(m, before, y[JX] - jx, y[JY] - jy, y[HX] - hx, y[HY] - hy)
        remember(m, before)
        m.h, status, evaluations = integrate(m, work, step)
        m.evaluations += evaluations
        hand_over(y, m, step)
        remember(m, react(step, y, work[0], m))
        report(y, m)
        if status == OK and m.p.interface.lead == 1:
            kept = words.copy()
            m.time = time + step
            ready(m, step)
            clear(y, m)
            _, status, evaluations = integrate(m, work, step)
            hand_over(y, m, step)
            ahead = handed_over(m)
            words[:] = kept
            m.evaluations += evaluations
            hand_instead(m, ahead)
        if status == OK and not finite_load(m):
            status = BAD_LOAD
    return status
