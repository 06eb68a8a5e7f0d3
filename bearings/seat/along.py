"""Copies of journal and housing along the shaft, and what is made of the axial load.

    z'' = az_free + inv_m_z F(t) [- k/m (z - z_n) - c/m (z' - z'_n)]

as `copies` has it across the shaft, with its state behind that of `copies`: the journal is one mass along
the shaft, and the housing a mass on its springs, where it says so. Where neither states `inv_m_z` and no
load acts along the shaft, all of it stays 0.
"""

from __future__ import annotations

import math

from ...modelkit import numerics
from ...modelkit.kernel import inlined, kernel

PLANAR = 23  # components of the state before these
JZ, JVZ, JPZ, JQZ = range(PLANAR, PLANAR + 4)  # journal copy; impulse, first moment
HZ, HVZ, HFZ, HFVZ, HPZ = range(PLANAR + 4, PLANAR + 9)  # housing copy, its response to the load; impulse
BEHIND_ALONG = PLANAR + 9  # first component of what follows


@kernel
def take_along(q, m):
    """Set the axial copies in q to the bodies' state in m.u."""
    j, h = m.u.journal, m.u.housing
    q[JZ], q[JVZ], q[HZ], q[HVZ] = j.z, j.vz, h.z, h.vz


@kernel
def clear_along(q):
    """Clear what the state q gathers of the axial load over a macro step."""
    q[JPZ], q[JQZ], q[HFZ], q[HFVZ], q[HPZ] = 0.0, 0.0, 0.0, 0.0, 0.0


@kernel
def along_rates(s, q, dq, m, load, own, moves, speeds_up):
    """Derivatives dq of the axial copies and quadratures under `load` (`Load`), s (s) after the middle.

    own: the load that moves the copies; moves, speeds_up: 1, or 0 where the order of extrapolation says so.
    """
    j, h = m.u.journal, m.u.housing
    dq[JZ] = moves * q[JVZ]
    dq[JVZ] = speeds_up * (j.az_free + j.inv_m_z * own.jz)
    dq[JPZ] = load.jz
    dq[JQZ] = s * load.jz
    spring = h.k_over_m_z * (q[HZ] - h.z) + h.c_over_m_z * (q[HVZ] - h.vz)
    dq[HZ] = moves * q[HVZ]
    dq[HVZ] = speeds_up * (h.az_free + h.inv_m_z * own.hz - spring)
    dq[HFZ] = q[HFVZ]
    dq[HFVZ] = load.hz - h.k_over_m_z * q[HFZ] - h.c_over_m_z * q[HFVZ]
    dq[HPZ] = load.hz


@inlined
def drift_along(trial, q, mid, h, moves):
    """The axial copies' positions in the state `trial`, as `copies.drift` has the others; h: s."""
    trial[JZ] = q[JZ] + moves * h * mid[JVZ]
    trial[HZ] = q[HZ] + moves * h * mid[HVZ]
    trial[HFZ] = q[HFZ] + h * mid[HFVZ]


@kernel
def hand_along(q, m, step, half_periods):
    """Put mean (N) and slope (N/s) of the axial load into m.o, after a macro step of `step` (s).

    half_periods: how fast, in radians a step, a housing may be for two numbers to stand for its load.
    """
    j, h, u = m.o.journal, m.o.housing, m.u.housing
    j.fz, j.dfz = q[JPZ] / step, 12.0 / (step * step * step) * q[JQZ]
    h.fz, h.dfz = q[HPZ] / step, 0.0
    if max(step * math.sqrt(u.k_over_m_z), step * u.c_over_m_z) < half_periods:
        response = numerics.step(u.k_over_m_z, u.c_over_m_z, step)
        h.fz, h.dfz = numerics.load_for(response, q[HFZ], q[HFVZ])
