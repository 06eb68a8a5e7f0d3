"""What a magnetic bearing sees: the journal or a place beside it, and the static load it has to hold.

The sensors of a bearing with a controller have a first-order low-pass, a range, a gain, and noise in each
sample.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ...modelkit.kernel import kernel
from ...modelkit.ports import (
    FlexibleSeatMotion,
    PlanarFlexibleSeatMotion,
    PointMotion,
    SprungMotion,
    StaticLoad,
)
from ...modelkit.variables import Choices, choice, group, integer, real
from .. import seat
from .law import limited

SENSED = Choices("SensedAt", ("journal", "sensor"))
AT_SENSOR = 1
_STRIDE, _FIRST, _SECOND = (
    np.uint64(0x9E3779B97F4A7C15),
    np.uint64(0xBF58476D1CE4E5B9),
    np.uint64(0x94D049BB133111EB),
)
_27, _30, _31, _11 = np.uint64(27), np.uint64(30), np.uint64(31), np.uint64(11)
UNIT = 1.0 / 2.0**53


@dataclass(frozen=True)
class HeldMotion(StaticLoad, PlanarFlexibleSeatMotion):
    """Motion of the journal, and what it takes to hold it."""


@dataclass(frozen=True)
class SpatialHeldMotion(StaticLoad, FlexibleSeatMotion):
    """Motion of the journal in space, and what it takes to hold it."""


@dataclass(frozen=True)
class SensedInputs:
    """Motion of journal, stator and sensor."""

    journal: HeldMotion = group(HeldMotion)
    housing: SprungMotion = group(SprungMotion)
    sensor: PointMotion = group(PointMotion)


@dataclass(frozen=True)
class Transducer:
    """Of each axis."""

    bandwidth: float = real(1e4 * math.pi, "rad/s", "of the low-pass", above=0.0, shown="rad/s")
    range: float = real(0.5e-3, "m", "beyond it the signal stays where it is", above=0.0)
    gain: float = real(1.0, "1", "signal over position")
    noise: float = real(0.0, "m", "largest deviation of a sample, evenly distributed", minimum=0.0)
    seed: int = integer(1, "of the noise", minimum=0, needs="noise")


@dataclass(frozen=True)
class Sensor(Transducer):
    """Both axes alike."""

    at: int = choice(0, SENSED, "where position is measured")


@kernel
def rate(position, signal, p):
    """Time derivative (m/s) of the low-pass's `signal` (m) at a position (m)."""
    return p.bandwidth * (limited(position, p.range) - signal)


@kernel
def _mixed(z):
    """A whole number's bits mixed (the finaliser of SplitMix64)."""
    z = (z ^ (z >> _30)) * _FIRST
    z = (z ^ (z >> _27)) * _SECOND
    return z ^ (z >> _31)


@kernel
def deviation(tick, axis, p):
    """Noise (m) of a sample: a hash of seed, tick and axis, so that a restored state tells it again."""
    if p.noise == 0.0:
        return 0.0
    z = _mixed(np.uint64(p.seed) * _STRIDE + np.uint64(2 * tick + axis))
    return p.noise * (2.0 * UNIT * np.float64(_mixed(z + _STRIDE) >> _11) - 1.0)


@kernel
def sum_of_inputs(u):
    """Of all `SensedInputs` in use beside those of every bearing, in no unit: finite where they are."""
    j, sensor = u.journal, u.sensor
    return sensor.x + sensor.y + sensor.vx + sensor.vy + j.static_fx + j.static_fy + j.static_fz


@kernel
def sensed_places(t, q, u, place):
    """Displacement of the journal from the stator (m, m), then of the place that is sensed (m, m).

    A sensor sees what it saw at the inputs, t (s) ago, moved on as the journal moved; place: `SENSED`.
    """
    ex, ey = q[seat.JX] - q[seat.HX], q[seat.JY] - q[seat.HY]
    sx, sy = ex, ey
    if place == AT_SENSOR:
        j, sensor = u.journal, u.sensor
        sx += sensor.x - j.x + t * (sensor.vx - j.vx)
        sy += sensor.y - j.y + t * (sensor.vy - j.vy)
    return ex, ey, sx, sy


@kernel
def static_load(j):
    """Force (N, N) that holds the journal j at rest: as it states, or what the seat alone would need."""
    if j.inv_m > 0.0 and j.static_fx == 0.0 and j.static_fy == 0.0:
        return -j.ax_free / j.inv_m, -j.ay_free / j.inv_m
    return j.static_fx, j.static_fy


@kernel
def static_load_along(j):
    """Force (N) that holds the journal j at rest along the shaft: as it states, or what it needs there."""
    if j.inv_m_z != 0.0 and j.static_fz == 0.0:
        return -j.az_free / j.inv_m_z
    return j.static_fz if j.inv_m_z != 0.0 else 0.0
