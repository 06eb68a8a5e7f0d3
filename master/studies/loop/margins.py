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
    """Of a loop whose `values` S (n,) at omega (n,), rad/s, rising, are fine enough to see every peak."""
    size = np.abs(values)
    k = int(np.argmax(size))
    peak, at = float(size[k]), float(omega[k])
    if 0 < k < len(omega) - 1:
        found: Any = minimize_scalar(
            lambda x: -abs(sensitivity(math.exp(x))),
            bounds=(math.log(omega[k - 1]), math.log(omega[k + 1])),
            method="bounded",
            options={"xatol": 1e-9},
        )
        if -found.fun > peak:
            peak, at = -float(found.fun), math.exp(float(found.x))
    crossings = tuple(_crossings(sensitivity, omega, values))
    return Margins(peak, at, crossings, min((_bears(sensitivity, w) for w in crossings), default=math.inf))


def _gain(s: complex) -> float:
    """log |L|."""
    return math.log(abs(1.0 / s - 1.0))


def _crossings(sensitivity: Sensitivity, omega: np.ndarray, values: np.ndarray) -> list[float]:
    above = np.abs(1.0 / values - 1.0) > 1.0
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
