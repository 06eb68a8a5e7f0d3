"""Position sensors of both axes: a first-order low-pass, a range, a gain, and noise in each sample."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ...modelkit.kernel import kernel
from ...modelkit.variables import Choices, choice, integer, real

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
class Sensor:
    """Both axes alike."""

    at: int = choice(0, SENSED, "where position is measured")
    bandwidth: float = real(1e4 * math.pi, "rad/s", "of the low-pass", above=0.0, shown="rad/s")
    range: float = real(0.5e-3, "m", "beyond it the signal stays where it is", above=0.0)
    gain: float = real(1.0, "1", "signal over position")
    noise: float = real(0.0, "m", "largest deviation of a sample, evenly distributed", minimum=0.0)
    seed: int = integer(1, "of the noise", minimum=0, needs="noise")


@kernel
def rate(position, signal, p):
    """Time derivative (m/s) of the low-pass's `signal` (m) at a position (m)."""
    return p.bandwidth * (min(max(position, -p.range), p.range) - signal)


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
