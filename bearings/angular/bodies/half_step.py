"""Kicks of a bearing in space: what they start from, and how exactly the copies' work and heat are booked.

As `bearings.rolling.micro_step` has it in the plane, with the copies' motion along the shaft.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

from ....modelkit.kernel import inlined, kernel
from ....modelkit.variables import array, group, real
from ...heat import shares
from ...heat.shares import Sources
from ...rolling import micro_step, ring
from ...seat import space
from ...seat.copies import HE, HVX, HVY, JE, JVX, JVY, JW
from ...seat.space import HVZ, JVZ, JWX, JWY
from .memory_layout import MAX_STATES

# their velocities
COPIES = (JVX, JVY, JVZ, JW, HVX, HVY, HVZ, JWX, JWY)


@dataclass(frozen=True)
class SpaceBrake:
    """Loads on the copies that make heat, in the kick at hand."""

    jx: float = real(0.0, "N", "on the journal")
    jy: float = real(0.0, "N", "on the journal")
    jz: float = real(0.0, "N", "on the journal")
    jm: float = real(0.0, "N.m", "on the journal, about its own axis")
    jmx: float = real(0.0, "N.m", "on the journal, across it")
    jmy: float = real(0.0, "N.m", "on the journal, across it")
    hx: float = real(0.0, "N", "on the housing")
    hy: float = real(0.0, "N", "on the housing")
    hz: float = real(0.0, "N", "on the housing")


@dataclass(frozen=True)
class SpaceKickMemory(micro_step.Kicks):
    """Memory of a kick in space."""

    before: tuple = array(MAX_STATES)  # derivative of the state in the kick before
    brake: SpaceBrake = group(SpaceBrake)
    ahead: tuple = array(len(COPIES))  # m/s, by which the velocities of the copies are forecast; rad/s


@inlined
def _forecast(trial, dq, h, kick, m):
    """Velocities of the copies in `trial` at the end of a micro-step of h (s), before a `kick` (s)."""
    space.forecast_copies(trial, dq, h)
    micro_step.note_kick(COPIES, dq, h, kick, m)


class _SpaceMissedMotion(NamedTuple):
    """By how much the copies in the middle of a kick are faster than forces were found for (m/s)."""

    part: float  # of the length of the kick that they were found for
    jx: float
    jy: float
    jz: float
    jw: float  # rad/s
    hx: float
    hy: float
    hz: float
    jwx: float  # rad/s
    jwy: float


@kernel
def missed_in_space(dq, kick, m):
    """`_SpaceMissedMotion` in a `kick` (s) under dq."""
    h, a = 0.5 * kick, m.s.ahead
    part = kick / m.s.kick if m.s.kick > 0.0 else 1.0
    jx, jy, jz = h * dq[JVX] - a[0], h * dq[JVY] - a[1], h * dq[JVZ] - a[2]
    hx, hy, hz = h * dq[HVX] - a[4], h * dq[HVY] - a[5], h * dq[HVZ] - a[6]
    return _SpaceMissedMotion(
        part, jx, jy, jz, h * dq[JW] - a[3], hx, hy, hz, h * dq[JWX] - a[7], h * dq[JWY] - a[8]
    )


@kernel
def record_spatial_work(dq, load, m):
    """Have the copies' work and heat in dq (W) be that of the middle of the kick; load: `SpatialLoad`."""
    b, off = m.s.brake, missed_in_space(dq, m.s.kick, m)
    dq[JE] += load.jx * off.jx + load.jy * off.jy + load.jz * off.jz + load.jm * off.jw
    dq[JE] += load.jmx * off.jwx + load.jmy * off.jwy
    dq[HE] += load.hx * off.hx + load.hy * off.hy + load.hz * off.hz
    at_bore = b.jx * off.jx + b.jy * off.jy + b.jz * off.jz + b.jm * off.jw
    at_bore += b.jmx * off.jwx + b.jmy * off.jwy
    at_outer = b.hx * off.hx + b.hy * off.hy + b.hz * off.hz
    dq[ring.LOSS] -= at_bore + at_outer
    shares.add_heat(Sources(-at_bore, 0.0, 0.0, -at_outer, 0.0), dq, ring.HEAT)


@kernel
def leapfrog_in_space(rhs, drift, fastest, kicked, observe, m, work, span):
    """Advance m.q by `span` (s), as `bearings.rolling.micro_step.leapfrog`."""
    m.s.ahead[:] = 0.0
    record_spatial_work(work[0], space.last_spatial_load(m), m)
    return micro_step.leapfrog_by(_forecast, rhs, drift, fastest, kicked, observe, m, work, span)
