"""Copies of journal and housing within the macro step of a planar bearing.

The state begins with quadratures, those of the load and up to `OWN_QUADRATURES` of the bearing's own; of
bearings in space more follow (`space`). The copies are next, then what is inside the bearing, and behind it
`PER_MODE` components for each elastic mode that is carried.

The journal's copy is a point mass, or with a flexible rotor the sum of one and of the rotor's elastic
modes; the housing's is a mass on its springs.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ...modelkit.integrators.dopri import StateParts
from ...modelkit.kernel import inlined, kernel
from ...modelkit.model import memory_layout
from ...modelkit.ports import (
    ACCELERATION,
    MODEL,
    MODES,
    VELOCITY,
    Load,
    Motion,
    PlanarFlexibleSeatMotion,
    SprungMotion,
)
from ...modelkit.variables import Nothing, group, integer, real

# Quadratures: impulse, first moment and work of the load, impulse and work on the housing.
JPX, JPY, JPM, JQX, JQY, JQM, JE, HPX, HPY, HE = range(10)
OWN = 10  # the first of a bearing's own
OWN_QUADRATURES = 6
QUADRATURES = OWN + OWN_QUADRATURES
IN_SPACE = 18  # components of a bearing in space; of a planar one nothing is there
FIRST = QUADRATURES + IN_SPACE
JX, JY, JVX, JVY, JW = range(FIRST, FIRST + 5)  # journal copy
HX, HY, HVX, HVY = range(FIRST + 5, FIRST + 9)  # housing copy
HFX, HFY, HFVX, HFVY = range(FIRST + 9, FIRST + 13)  # its response to the load alone, per mass
INSIDE = FIRST + 13  # first component of what is inside the bearing
PARTS = StateParts(QUADRATURES, FIRST)
# Of each elastic mode, behind what is inside: its share in the journal copy's motion, and the response
# of a mode of unit inv_m to the load alone.
ZX, ZY, ZVX, ZVY, QX, QY, PX, PY = range(8)
PER_MODE = 8
MODES_SIZE = PER_MODE * MODES  # in the state vector

POSITION_SCALE = 1e-5  # m; an indentation
VELOCITY_SCALE = 0.1  # m/s; a landing
SPIN_SCALE = 1e3  # rad/s
IMPULSE_SCALE = 0.1  # N s; of a kilogram that lands


@dataclass(frozen=True)
class BearingInputs:
    """Inputs that every planar bearing takes."""

    journal: PlanarFlexibleSeatMotion = group(PlanarFlexibleSeatMotion)
    housing: SprungMotion = group(SprungMotion)


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
    return memory_layout(parameters, inputs, outputs, size + MODES_SIZE, derived, hidden)


@kernel
def set_weights(weight):
    """Set the error weights of the copies in a bearing's `weight` (n,)."""
    for i in (JX, JY, HX, HY):
        weight[i] = 1.0 / POSITION_SCALE
    for i in (JVX, JVY, HVX, HVY):
        weight[i] = 1.0 / VELOCITY_SCALE
    weight[JW] = 1.0 / SPIN_SCALE


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
    clear_gathered(q, m)


@kernel
def clear_gathered(q, m):
    """Clear what the state q gathers over a macro step: impulse, moment, work, responses to the load."""
    for i in range(OWN):
        q[i] = 0.0
    for i in range(HFX, HFVY + 1):
        q[i] = 0.0
    for k in range(m.s.seat.modes):
        i = m.s.seat.inside + PER_MODE * k
        q[i + QX], q[i + QY], q[i + PX], q[i + PY] = 0.0, 0.0, 0.0, 0.0


@kernel
def last_load(m):
    """The last known `Load` (N, N m)."""
    s = m.s.seat
    return Load(s.jx, s.jy, s.jm, s.hx, s.hy)


@kernel
def copy_rates(t, q, dq, m, half, load):
    """Derivatives dq of the copies and the quadratures under `load` (`Load`: N, N m).

    t: time in the macro step (s); half: half the macro step (s).
    """
    order = m.p.interface.order
    moves = 1.0 if order >= VELOCITY else 0.0
    speeds_up = 1.0 if order >= ACCELERATION else 0.0
    part = load
    if order == ACCELERATION:  # the bearing's own part, as it was at the restart
        part = last_load(m)
    s = t - half
    j = m.u.journal
    dq[JX] = moves * q[JVX]
    dq[JY] = moves * q[JVY]
    back_x, back_y = _mode_rates(q, dq, m, load)
    dq[JVX] = speeds_up * (j.ax_free + j.inv_m * part.jx) - back_x
    dq[JVY] = speeds_up * (j.ay_free + j.inv_m * part.jy) - back_y
    dq[JW] = speeds_up * (j.alpha_free + j.inv_I * part.jm)
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
    dq[HVX] = speeds_up * (h.ax_free + h.inv_m * part.hx - spring_x)
    dq[HVY] = speeds_up * (h.ay_free + h.inv_m * part.hy - spring_y)
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


@inlined
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


@inlined
def _drift_modes(trial, q, mid, h, m):
    """`drift` of the elastic modes, in the states `trial`, q and `mid` (m.n,)."""
    for n in range(m.s.seat.modes):
        i = m.s.seat.inside + PER_MODE * n
        trial[i + ZX] = q[i + ZX] + h * mid[i + ZVX]
        trial[i + ZY] = q[i + ZY] + h * mid[i + ZVY]
        trial[i + QX] = q[i + QX] + h * mid[i + PX]
        trial[i + QY] = q[i + QY] + h * mid[i + PY]


@inlined
def forecast(trial, dq, h):
    """Take the copies' velocities in `trial` from the middle of a micro-step of h (s) to its end.

    Their accelerations dq change little from one to the next; with them the work that crosses the seat
    is of second order.
    """
    for i in (JVX, JVY, JW, HVX, HVY, HFVX, HFVY):
        trial[i] += 0.5 * h * dq[i]
