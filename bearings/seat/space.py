"""The copies of a bearing in space: those of `copies`, the same along the shaft, and the journal's tilt.

    z'' = az_free + inv_m_z F(t) [- k/m (z - z_n) - c/m (z' - z'_n)]
    rx'' = alpha_x_free + inv_I_t Mx - inv_mI Fy        ry'' = alpha_y_free + inv_I_t My + inv_mI Fx

The journal is one mass along the shaft, and the housing a mass on its springs, where it says so. The
moments move the journal's place by the same inv_mI by which forces tilt it, and the elastic modes that are
carried pull the tilt back as they pull the journal. The gyroscopic acceleration is part of `alpha_*_free`,
as it was at the restart; what it changes by follows from `gyro` (`_gyroscopic`). The housing does not tilt.
Where nothing is stated along the shaft or of a tilt and no load acts there, all of it stays 0.

The kernels are those that `copies` and `step` have for planar bearings, under the same names.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ...modelkit import numerics
from ...modelkit.integrators.dopri import StateParts
from ...modelkit.kernel import inlined, kernel
from ...modelkit.ports import (
    ACCELERATION,
    MODEL,
    VELOCITY,
    FlexibleSeatMotion,
    Load,
    MountMotion,
    SpatialLoad,
)
from ...modelkit.variables import group, real
from . import copies, step
from .copies import (
    HE,
    HX,
    HY,
    IMPULSE_SCALE,
    IN_SPACE,
    JE,
    JVX,
    JVY,
    JX,
    JY,
    PER_MODE,
    POSITION_SCALE,
    PX,
    PY,
    QUADRATURES,
    VELOCITY_SCALE,
    ZVX,
    ZVY,
    ZX,
    ZY,
    SeatMemory,
)
from .step import BODY_LOAD_SIZE, MAX_HALF_PERIODS, Carried

# Quadratures: impulse and first moment along the shaft, impulse on the housing; impulse and first moment of
# the moments; one of a bearing's own.
JPZ, JQZ, HPZ, JPMX, JPMY, JQMX, JQMY, OWN = range(QUADRATURES, QUADRATURES + 8)
FIRST = OWN + 1
JZ, JVZ, HZ, HVZ, HFZ, HFVZ = range(FIRST, FIRST + 6)  # both copies, the housing's response to the load
JRX, JRY, JWX, JWY = range(FIRST + 6, FIRST + 10)  # tilt of the journal copy
assert FIRST + 10 == QUADRATURES + IN_SPACE
PARTS = StateParts(FIRST, FIRST)

TILT_SCALE = 1e-4  # rad; an indentation over a centimetre or so
TILT_RATE_SCALE = 1.0  # rad/s; a landing's velocity over as much
MOMENT_IMPULSE_SCALE = 1e-3  # N m s; a landing's impulse over as much


@dataclass(frozen=True)
class SpatialInputs:
    """Inputs that every bearing in space takes."""

    journal: FlexibleSeatMotion = group(FlexibleSeatMotion)
    housing: MountMotion = group(MountMotion)


@dataclass(frozen=True)
class SpatialSeatMemory(SeatMemory):
    """The same in space."""

    jz: float = real(0.0, "N", "on the journal, along the shaft")
    hz: float = real(0.0, "N", "on the housing, along the shaft")
    jmx: float = real(0.0, "N.m", "on the journal, about x")
    jmy: float = real(0.0, "N.m", "on the journal, about y")


@kernel
def set_weights(weight):
    """Set the error weights of the copies in a bearing's `weight` (n,), but for the tilt."""
    copies.set_weights(weight)
    weight[JZ] = weight[HZ] = 1.0 / POSITION_SCALE
    weight[JVZ] = weight[HVZ] = 1.0 / VELOCITY_SCALE


@kernel
def weigh_tilt(weight):
    """Have micro-steps resolve the tilt, in a bearing whose load depends on it."""
    weight[JRX] = weight[JRY] = 1.0 / TILT_SCALE
    weight[JWX] = weight[JWY] = 1.0 / TILT_RATE_SCALE


@kernel
def _weigh_impulse(m):
    """Have micro-steps resolve the load where no copy moves under it; 1/(N s), and 1/(N m s) of moments."""
    step.weigh_impulse(m)
    if m.p.interface.order < MODEL or m.u.journal.inv_m_z == 0.0:
        m.weight[JPZ] = 1.0 / IMPULSE_SCALE
    if m.weight[JRX] > 0.0 and (m.p.interface.order < MODEL or m.u.journal.inv_I_t == 0.0):
        m.weight[JPMX] = m.weight[JPMY] = 1.0 / MOMENT_IMPULSE_SCALE


@kernel
def take_spatial_inputs(q, m):
    """Set the copies in q to the bodies' state in m.u and clear the quadratures."""
    copies.take_inputs(q, m)
    j, h = m.u.journal, m.u.housing
    q[JZ], q[JVZ], q[HZ], q[HVZ] = j.z, j.vz, h.z, h.vz
    q[JRX], q[JRY], q[JWX], q[JWY] = j.rx, j.ry, j.wx, j.wy
    _clear_gathered(q, m)


@kernel
def _clear_gathered(q, m):
    """Clear what the state q gathers over a macro step, as `copies.clear_gathered`."""
    copies.clear_gathered(q, m)
    for i in range(QUADRATURES, OWN):
        q[i] = 0.0
    q[HFZ], q[HFVZ] = 0.0, 0.0


@kernel
def last_spatial_load(m):
    """The last known `SpatialLoad` (N, N m)."""
    s = m.s.seat
    return SpatialLoad(s.jx, s.jy, s.jm, s.hx, s.hy, s.jz, s.hz, s.jmx, s.jmy)


@kernel
def spatial_copy_rates(t, q, dq, m, half, load):
    """Derivatives dq of the copies and quadratures under `load` (`SpatialLoad`), as `copies.copy_rates`."""
    copies.copy_rates(t, q, dq, m, half, Load(load.jx, load.jy, load.jm, load.hx, load.hy))
    order = m.p.interface.order
    moves = 1.0 if order >= VELOCITY else 0.0
    speeds_up = 1.0 if order >= ACCELERATION else 0.0
    part = load
    if order == ACCELERATION:
        part = last_spatial_load(m)
    s, j, h = t - half, m.u.journal, m.u.housing
    about_x, about_y, across_x, across_y = _gyroscopic(q, m)
    dq[JVX] += speeds_up * j.inv_mI * part.jmy + across_x
    dq[JVY] += across_y - speeds_up * j.inv_mI * part.jmx
    dq[JRX], dq[JRY] = moves * q[JWX], moves * q[JWY]
    dq[JWX] = speeds_up * (j.alpha_x_free + j.inv_I_t * part.jmx - j.inv_mI * part.jy) + about_x
    dq[JWY] = speeds_up * (j.alpha_y_free + j.inv_I_t * part.jmy + j.inv_mI * part.jx) + about_y
    dq[JPMX], dq[JPMY] = load.jmx, load.jmy
    dq[JQMX], dq[JQMY] = s * load.jmx, s * load.jmy
    _tilt_modes(q, dq, m, load)
    dq[JZ] = moves * q[JVZ]
    dq[JVZ] = speeds_up * (j.az_free + j.inv_m_z * part.jz)
    dq[JPZ] = load.jz
    dq[JQZ] = s * load.jz
    spring = h.k_over_m_z * (q[HZ] - h.z) + h.c_over_m_z * (q[HVZ] - h.vz)
    dq[HZ] = moves * q[HVZ]
    dq[HVZ] = speeds_up * (h.az_free + h.inv_m_z * part.hz - spring)
    dq[HFZ] = q[HFVZ]
    dq[HFVZ] = load.hz - h.k_over_m_z * q[HFZ] - h.c_over_m_z * q[HFVZ]
    dq[HPZ] = load.hz
    dq[JE] += load.jz * dq[JZ] + load.jmx * dq[JRX] + load.jmy * dq[JRY]
    dq[HE] += load.hz * dq[HZ]


@kernel
def _gyroscopic(q, m):
    """The change of the gyroscopic accelerations since the restart.

    Of the tilt about x and y (rad/s2), and of the seat along x and y (m/s2), which is off the centre of
    mass by inv_mI/inv_I_t (m). None of a tilt that is prescribed.
    """
    j = m.u.journal
    if j.gyro == 0.0 or j.inv_I_t == 0.0 or m.p.interface.order < MODEL:
        return 0.0, 0.0, 0.0, 0.0
    about_x, about_y = -j.gyro * (q[JWY] - j.wy), j.gyro * (q[JWX] - j.wx)
    lever = j.inv_mI / j.inv_I_t
    return about_x, about_y, lever * about_y, -lever * about_x


@kernel
def _tilt_modes(q, dq, m, load):
    """Add to dq what elastic modes that tilt the seat take from the moments, and how they pull it back."""
    for n in range(m.s.seat.modes):
        i, z = m.s.seat.inside + PER_MODE * n, m.u.journal.mode[n]
        fx, fy = z.slope * load.jmy, -z.slope * load.jmx
        dq[i + ZVX] += z.inv_m * fx
        dq[i + ZVY] += z.inv_m * fy
        dq[i + PX] += fx
        dq[i + PY] += fy
        dq[JWX] += z.slope * (z.k_over_m * (q[i + ZY] - z.y) + z.c_over_m * (q[i + ZVY] - z.vy))
        dq[JWY] -= z.slope * (z.k_over_m * (q[i + ZX] - z.x) + z.c_over_m * (q[i + ZVX] - z.vx))


@inlined
def drift(trial, q, mid, h, m):
    """The copies' positions in the state `trial`: those in q and h (s) times the velocities in `mid`."""
    copies.drift(trial, q, mid, h, m)
    moves = 1.0 if m.p.interface.order >= VELOCITY else 0.0  # a held copy stays
    trial[JZ] = q[JZ] + moves * h * mid[JVZ]
    trial[HZ] = q[HZ] + moves * h * mid[HVZ]
    trial[HFZ] = q[HFZ] + h * mid[HFVZ]
    trial[JRX] = q[JRX] + moves * h * mid[JWX]
    trial[JRY] = q[JRY] + moves * h * mid[JWY]


@inlined
def forecast_copies(trial, dq, h):
    """Take the copies' velocities in `trial` to the end of a micro-step of h (s), as `copies.forecast`."""
    copies.forecast(trial, dq, h)
    for i in (JVZ, HVZ, HFVZ, JWX, JWY):
        trial[i] += 0.5 * h * dq[i]


@kernel
def _hand_over(q, m, step_size):
    """Turn what the state q gathered into the mean and slope that the bodies take, as `step.hand_over`."""
    step.hand_over(q, m, step_size)
    first, second = 1.0 / step_size, 12.0 / (step_size * step_size * step_size)
    j, h, u = m.o.journal, m.o.housing, m.u.housing
    j.mx, j.my = first * q[JPMX], first * q[JPMY]
    j.dmx, j.dmy = second * q[JQMX], second * q[JQMY]
    j.fz, j.dfz = first * q[JPZ], second * q[JQZ]
    h.fz, h.dfz = first * q[HPZ], 0.0
    if max(step_size * math.sqrt(u.k_over_m_z), step_size * u.c_over_m_z) < MAX_HALF_PERIODS:
        response = numerics.oscillator_step(u.k_over_m_z, u.c_over_m_z, step_size)
        h.fz, h.dfz = numerics.load_for(response, q[HFZ], q[HFVZ])
    if j.mx == 0.0 and j.my == 0.0 and j.dmx == 0.0 and j.dmy == 0.0:
        return
    for n in range(m.s.seat.modes):
        z, lacking = m.u.journal.mode[n], j.mode[n]
        response = numerics.oscillator_step(z.k_over_m, z.c_over_m, step_size)
        lacking.qx -= z.slope * (response.zf * j.my + response.zg * j.dmy)
        lacking.qy += z.slope * (response.zf * j.mx + response.zg * j.dmx)
        lacking.px -= z.slope * (response.vf * j.my + response.vg * j.dmy)
        lacking.py += z.slope * (response.vf * j.mx + response.vg * j.dmx)


@kernel
def _hand_now(m, load):
    """Put a momentary `SpatialLoad` (N, N m) in the outputs as the mean, its slope zero."""
    step.hand_mean(m, load)
    j, h = m.o.journal, m.o.housing
    j.fz, j.dfz, h.fz, h.dfz = load.jz, 0.0, load.hz, 0.0
    j.mx, j.my, j.dmx, j.dmy = load.jmx, load.jmy, 0.0, 0.0


@kernel
def _handed_over(m):
    """The load as it stands in m.o: as `step.load_numbers`, and eight more."""
    j, h, planar = m.o.journal, m.o.housing, step.load_numbers(m)
    n = len(planar)
    load = np.empty(n + 8)
    for i in range(n):
        load[i] = planar[i]
    load[n], load[n + 1], load[n + 2], load[n + 3] = j.fz, j.dfz, h.fz, h.dfz
    load[n + 4], load[n + 5], load[n + 6], load[n + 7] = j.mx, j.my, j.dmx, j.dmy
    return load


@kernel
def _hand_instead(m, load):
    """Put a load from `_handed_over` in the outputs."""
    step.put_load(m, load)
    j, h, n = m.o.journal, m.o.housing, BODY_LOAD_SIZE + 4 * m.s.seat.modes
    j.fz, j.dfz, h.fz, h.dfz = load[n], load[n + 1], load[n + 2], load[n + 3]
    j.mx, j.my, j.dmx, j.dmy = load[n + 4], load[n + 5], load[n + 6], load[n + 7]


@kernel
def _sum_handed(m):
    """Of all numbers handed over, in no unit: finite where each of them is."""
    j, h = m.o.journal, m.o.housing
    tilting = j.mx + j.my + j.dmx + j.dmy
    return step.sum_of_load(m) + tilting + j.fz + j.dfz + h.fz + h.dfz


@kernel
def _sum_inputs(m):
    """Of all inputs that are in use, in no unit: finite where each of them is."""
    j, h = m.u.journal, m.u.housing
    total = step.sum_of_inputs(m) + j.z + j.vz + j.az_free + j.inv_m_z
    total += h.z + h.vz + h.az_free + h.inv_m_z + h.k_over_m_z + h.c_over_m_z
    total += j.rx + j.ry + j.wx + j.wy + j.alpha_x_free + j.alpha_y_free + j.inv_I_t + j.inv_mI + j.gyro
    for k in range(m.s.seat.modes):
        total += j.mode[k].slope
    return total


class _SpatialPlaces(NamedTuple):
    """Where the copies of journal and housing are (m), and how the journal's is tilted (rad)."""

    jx: float
    jy: float
    hx: float
    hy: float
    jz: float
    hz: float
    rx: float
    ry: float


@kernel
def _places(q):
    """`_SpatialPlaces` (m, rad) in the state q."""
    return _SpatialPlaces(q[JX], q[JY], q[HX], q[HY], q[JZ], q[HZ], q[JRX], q[JRY])


@kernel
def _account_jump(m, load, before, after):
    """Work (J) missed where the restart moved the copies from `before` to `after` (`_SpatialPlaces`)."""
    step.jump_work(m, load, before, after)
    s = m.s.seat
    turned = (s.jmx + load.jmx) * (after.rx - before.rx) + (s.jmy + load.jmy) * (after.ry - before.ry)
    m.o.journal.jump += 0.5 * ((s.jz + load.jz) * (after.jz - before.jz) + turned)
    m.o.housing.jump += 0.5 * (s.hz + load.hz) * (after.hz - before.hz)


@kernel
def remember_spatial_load(m, load):
    """Keep `load` (`SpatialLoad`: N, N m) as the last known one."""
    step.remember_load(m, load)
    s = m.s.seat
    s.jz, s.hz, s.jmx, s.jmy = load.jz, load.hz, load.jmx, load.jmy


SPATIAL = Carried(
    parts=PARTS,
    take_inputs=take_spatial_inputs,
    clear=_clear_gathered,
    rates=spatial_copy_rates,
    weigh_impulse=_weigh_impulse,
    hand_over=_hand_over,
    hand_now=_hand_now,
    handed_over=_handed_over,
    hand_instead=_hand_instead,
    sum_handed=_sum_handed,
    sum_inputs=_sum_inputs,
    places=_places,
    account_jump=_account_jump,
    remember=remember_spatial_load,
)
