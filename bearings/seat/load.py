"""What a bearing makes of its load over a macro step: mean and slope, what the modes lack, the account.

With the impulse P and the first moment Q about the middle of a step of H seconds

    mean = P/H        slope = 12 Q/H^3

or, for a housing on springs, the two numbers that bring it where its copy went.
"""

from __future__ import annotations

import math

import numpy as np

from touchdown.bearings.seat.layout import (
    HE,
    HFVX,
    HFVY,
    HFX,
    HFY,
    HPX,
    HPY,
    JE,
    JPM,
    JPX,
    JPY,
    JQM,
    JQX,
    JQY,
    PER_MODE,
    PX,
    PY,
    QX,
    QY,
)
from touchdown.modelkit.kernel import kernel
from touchdown.modelkit.numerics import oscillator
from touchdown.modelkit.ports import Load

STIFFEST = 3.0  # half a period of the housing per macro step; beyond, two numbers cannot stand for its load
OF_BODIES = 10  # numbers of the load on journal and housing; each mode has four more


@kernel
def hand_over(q, m, step):
    """Turn impulses and first moments in q into the mean (N) and slope (N/s) that the bodies take, in m.o.

    step: the macro step (s).
    """
    first = 1.0 / step
    second = 12.0 / step**3
    j = m.o.journal
    j.fx, j.fy, j.mz = first * q[JPX], first * q[JPY], first * q[JPM]
    j.dfx, j.dfy, j.dmz = second * q[JQX], second * q[JQY], second * q[JQM]
    j.work += q[JE]
    _hand_modes_over(q, m, step)
    h = m.o.housing
    u = m.u.housing
    if max(step * math.sqrt(u.k_over_m), step * u.c_over_m) < STIFFEST:
        response = oscillator.step(u.k_over_m, u.c_over_m, step)
        h.fx, h.dfx = oscillator.load_for(response, q[HFX], q[HFVX])
        h.fy, h.dfy = oscillator.load_for(response, q[HFY], q[HFVY])
    else:
        h.fx, h.fy, h.dfx, h.dfy = first * q[HPX], first * q[HPY], 0.0, 0.0
    h.work += q[HE]


@kernel
def _hand_modes_over(q, m, step):
    """What mean and slope do not say of the load to the elastic modes (kg m, N s), in m.o."""
    j = m.o.journal
    for n in range(m.s.seat.modes):
        i, z, lacking = m.s.seat.inside + PER_MODE * n, m.u.journal.mode[n], j.mode[n]
        response = oscillator.step(z.k_over_m, z.c_over_m, step)
        lacking.qx = q[i + QX] - (response.zf * j.fx + response.zg * j.dfx)
        lacking.qy = q[i + QY] - (response.zf * j.fy + response.zg * j.dfy)
        lacking.px = q[i + PX] - (response.vf * j.fx + response.vg * j.dfx)
        lacking.py = q[i + PY] - (response.vf * j.fy + response.vg * j.dfy)


@kernel
def hand_now(m, load):
    """Put a momentary load (`Load`: N, N m) in the outputs as the mean, its slope zero."""
    j, h = m.o.journal, m.o.housing
    j.fx, j.fy, j.mz, j.dfx, j.dfy, j.dmz = load.jx, load.jy, load.jm, 0.0, 0.0, 0.0
    h.fx, h.fy, h.dfx, h.dfy = load.hx, load.hy, 0.0, 0.0


@kernel
def handed_over(m):
    """The load as it stands in m.o, in its units: (10 + 4 modes,) on journal, housing and modes."""
    j, h = m.o.journal, m.o.housing
    load = np.empty(OF_BODIES + 4 * m.s.seat.modes)
    load[0], load[1], load[2], load[3], load[4], load[5] = j.fx, j.fy, j.mz, j.dfx, j.dfy, j.dmz
    load[6], load[7], load[8], load[9] = h.fx, h.fy, h.dfx, h.dfy
    for k in range(m.s.seat.modes):
        i, z = OF_BODIES + 4 * k, j.mode[k]
        load[i], load[i + 1], load[i + 2], load[i + 3] = z.qx, z.qy, z.px, z.py
    return load


@kernel
def hand_instead(m, load):
    """Put a load from `handed_over`, (10 + 4 modes,), in the outputs."""
    j, h = m.o.journal, m.o.housing
    j.fx, j.fy, j.mz, j.dfx, j.dfy, j.dmz = load[0], load[1], load[2], load[3], load[4], load[5]
    h.fx, h.fy, h.dfx, h.dfy = load[6], load[7], load[8], load[9]
    for k in range(m.s.seat.modes):
        i, z = OF_BODIES + 4 * k, j.mode[k]
        z.qx, z.qy, z.px, z.py = load[i], load[i + 1], load[i + 2], load[i + 3]


@kernel
def is_finite(m):
    """Whether every number of the load handed over to journal and housing is finite."""
    j, h = m.o.journal, m.o.housing
    return math.isfinite(
        j.fx + j.fy + j.mz + j.dfx + j.dfy + j.dmz + h.fx + h.fy + h.dfx + h.dfy + j.work + h.work
    )


@kernel
def account_jump(m, load, djx, djy, dhx, dhy):
    """Work (J) missed where the copies were moved by (djx, djy) and (dhx, dhy) (m) at the restart."""
    s = m.s.seat
    m.o.journal.jump += 0.5 * ((s.jx + load.jx) * djx + (s.jy + load.jy) * djy)
    m.o.housing.jump += 0.5 * ((s.hx + load.hx) * dhx + (s.hy + load.hy) * dhy)


@kernel
def last_load(m):
    """The last known `Load` (N, N m)."""
    s = m.s.seat
    return Load(s.jx, s.jy, s.jm, s.hx, s.hy)


@kernel
def remember(m, load):
    """Keep `load` (`Load`: N, N m) as the last known one."""
    s = m.s.seat
    s.jx, s.jy, s.jm, s.hx, s.hy = load.jx, load.jy, load.jm, load.hx, load.hy
