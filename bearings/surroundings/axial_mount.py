"""A carrier along the shaft: a mass on a spring and a damper, under a force that is linear in time.

    m z'' = F(t) + m g_z - k z - c z'

What it stands on does not move along the shaft. A macro step is exact; where there is no spring, the
carrier keeps its place. Nothing couples it with the motion across.
"""

from __future__ import annotations

from dataclasses import dataclass

from ...modelkit import numerics
from ...modelkit.kernel import kernel
from ...modelkit.numerics import squared
from ...modelkit.variables import real

Z, VZ = range(2)  # of the state along the shaft: m, m/s
SIZE = 2


@dataclass(frozen=True)
class AxialMount:
    """Spring and damper along the shaft; as stiff as the housing of the source is across."""

    stiffness: float = real(
        2.5e8, "N/m", "along the shaft; 0: the carrier keeps its place", minimum=0.0, needs="@axial"
    )
    damping: float = real(2500.0, "N.s/m", "along the shaft", minimum=0.0, needs="stiffness")


@kernel
def derive_along(p, mass, down, along):
    """Put the state `along` (2,) at rest where `mass` (kg) depends on its spring.

    p: a record of `AxialMount`; down: gravity towards +z (m/s2).
    """
    along[Z], along[VZ] = mass * down / p.stiffness if p.stiffness > 0.0 else 0.0, 0.0


@kernel
def publish_along(p, mass, down, along, o):
    """Set the axial part of the motion `o` (`MountState`); returns (kinetic, potential) energy (J)."""
    if p.stiffness == 0.0:
        return 0.0, 0.0
    z, vz = along[Z], along[VZ]
    o.z, o.vz, o.inv_m_z = z, vz, 1.0 / mass
    o.k_over_m_z, o.c_over_m_z = p.stiffness / mass, p.damping / mass
    o.az_free = down - o.k_over_m_z * z - o.c_over_m_z * vz
    return 0.5 * mass * vz * vz, 0.5 * p.stiffness * z * z - mass * down * z


@kernel
def along_rate(p, mass, down, force, along, rate):
    """Set the `rate` (2,) of the state `along` under an outer `force` (N).

    Returns the force's power and the damper's heat (W).
    """
    rate[Z] = rate[VZ] = 0.0
    if p.stiffness == 0.0:
        return 0.0, 0.0
    rate[Z] = along[VZ]
    rate[VZ] = (force - p.stiffness * along[Z] - p.damping * along[VZ]) / mass + down
    return force * along[VZ], p.damping * squared(along[VZ])


@kernel
def go_along(p, mass, down, u, step, along):
    """Take the state `along` through a macro step of `step` (s) under the load `u` (`MountLoad`).

    Returns the load's work and the damper's heat (J).
    """
    if p.stiffness == 0.0:
        return 0.0, 0.0
    k, c, f, g = p.stiffness / mass, p.damping / mass, u.fz / mass + down, u.dfz / mass
    s, z, v = numerics.step(k, c, step), along[Z], along[VZ]
    z_end = s.zz * z + s.zv * v + s.zf * f + s.zg * g
    v_end = s.vz * z + s.vv * v + s.vf * f + s.vg * g
    area = numerics.area(k, c, step, f, (z, v), (z_end, v_end))
    late = 0.5 * step * (z_end + z) - area  # int (t - t_mid) v dt
    heat = mass * (f * (z_end - z) + g * late)
    heat -= 0.5 * mass * ((v_end - v) * (v_end + v) + k * (z_end - z) * (z_end + z))
    along[Z], along[VZ] = z_end, v_end
    return u.fz * (z_end - z) + u.dfz * late, max(heat, 0.0)
