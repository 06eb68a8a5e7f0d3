"""Margins by a loop's sensitivity: its peak and zone, where the loop gain crosses one, how much delay it
bears.

S(w) is the answer at one sensor to a disturbance there, all loops closed; L = 1/S - 1 is that loop's gain
with the others closed. Zones of the peak of |S| as they are quoted of ISO 14839-3:2006: A below 3 (9.5 dB),
B to 4 (12 dB), C to 5 (14 dB), D above. The text of the standard was not at hand.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.optimize import brentq, minimize_scalar

ZONES = ((3.0, "A"), (4.0, "B"), (5.0, "C"))
WORST = "D"
NEAR = 0.7  # of the largest line; what stands higher is looked at between the lines, too
CLOSE = 0.5  # |log |L|| of a line; nearer to 0 than that, it may cross 0 between the lines
TINY = 1e-300
Sensitivity = Callable[[float], complex]  # by angular frequency, rad/s


@dataclass(frozen=True)
class Margins:
    """Of one loop."""

    peak: float  # of |S|
    at: float  # rad/s, where it is
    crossings: tuple[float, ...]  # rad/s, where |L| = 1
    delay: float  # s, that the loop stands beyond its own; inf: any

    @property
    def zone(self) -> str:
        """By its peak."""
        return zone(self.peak)


def zone(peak: float) -> str:
    """Of a peak of |S|: A, B, C or D."""
    return next((name for limit, name in ZONES if peak < limit), WORST)


def margins(sensitivity: Sensitivity, omega: np.ndarray, values: np.ndarray) -> Margins:
    """Of a loop whose `values` S (n,) at omega (n,), rad/s, rising, show every peak and dip of S and L."""
    size = np.abs(values)
    k = int(np.argmax(size))
    peak, frequency = float(size[k]), float(omega[k])
    for k in _summits(size, (NEAR * peak, math.inf)):
        where, found = _summit(lambda w: abs(sensitivity(w)), omega, k)
        if found > peak:
            peak, frequency = found, where
    crossings = tuple(_crossings(sensitivity, omega, values))
    return Margins(
        peak, frequency, crossings, min((_bears(sensitivity, w) for w in crossings), default=math.inf)
    )


def _summits(values: np.ndarray, within: tuple[float, float]) -> np.ndarray:
    """Where `values` (n,) are larger than beside them, and lie within the bounds."""
    inner = values[1:-1]
    top = (inner >= values[:-2]) & (inner >= values[2:]) & (inner > within[0]) & (inner < within[1])
    return np.flatnonzero(top) + 1


def _summit(function: Callable[[float], float], omega: np.ndarray, k: int) -> tuple[float, float]:
    """Where a function is largest between the lines beside line k (rad/s), and how large it is there."""
    left, right = float(omega[k - 1]), float(omega[k + 1])
    found: Any = minimize_scalar(
        lambda x: -function(left + x * (right - left)),
        bounds=(0.0, 1.0),
        method="bounded",
        options={"xatol": 1e-7},
    )
    return left + float(found.x) * (right - left), -float(found.fun)


def _gain(s: complex) -> float:
    """log |L|."""
    return math.log(max(abs(1.0 - s), TINY) / max(abs(s), TINY))


def _crossings(sensitivity: Sensitivity, omega: np.ndarray, values: np.ndarray) -> list[float]:
    """Where |L| = 1 (rad/s), also twice between two lines, where it just comes to 1."""
    gain = np.array([_gain(s) for s in values])
    for sign in (1.0, -1.0):
        for k in _summits(sign * gain, (-CLOSE, 0.0)):
            where, most = _summit(lambda w, sign=sign: sign * _gain(sensitivity(w)), omega, k)
            if most > 0.0:
                omega, gain = np.append(omega, where), np.append(gain, sign * most)
    order = np.argsort(omega)
    omega, above = omega[order], gain[order] > 0.0
    pairs = np.flatnonzero(above[1:] != above[:-1])
    found: list[Any] = [
        brentq(lambda w: _gain(sensitivity(w)), omega[k], omega[k + 1], xtol=1e-10) for k in pairs
    ]
    return [float(one) for one in found]


def _bears(sensitivity: Sensitivity, omega: float) -> float:
    """Delay (s) that turns L to -1 at a crossing (rad/s)."""
    loop = 1.0 / sensitivity(omega) - 1.0
    phase = (math.atan2(loop.imag, loop.real) + math.pi) % (2.0 * math.pi)
    return phase / omega
