"""Polynomials over a macro step: tau = 0 is its begin, 1 its end; points before it have tau < 0."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

import numpy as np


class Polynomial:
    """sum of c[k] tau^k."""

    __slots__ = ("c",)

    def __init__(self, coefficients: Sequence[float]) -> None:
        self.c = coefficients

    def at(self, tau: float) -> float:
        """Its value."""
        value = 0.0
        for c in reversed(self.c):
            value = value * tau + c
        return value

    def mean(self, begin: float, end: float) -> float:
        """Over [begin, end]."""
        total, low, high = 0.0, 1.0, 1.0
        for k, c in enumerate(self.c, 1):
            low, high = low * begin, high * end
            total += c * (high - low) / k
        return total / (end - begin)

    def moment(self, begin: float, end: float) -> float:
        """Mean over [begin, end] of the polynomial times (s - 1/2), where s goes from 0 to 1 there."""
        total, low, high = 0.0, begin, end
        for k, c in enumerate(self.c, 2):
            low, high = low * begin, high * end
            total += c * (high - low) / k
        length = end - begin
        return (total / length - 0.5 * (begin + end) * self.mean(begin, end)) / length

    def slope(self) -> Polynomial:
        """Its derivative in tau."""
        return Polynomial([k * c for k, c in enumerate(self.c)][1:] or [0.0])

    def sum(self) -> Polynomial:
        """Its integral in tau from 0."""
        return Polynomial([0.0, *(c / k for k, c in enumerate(self.c, 1))])

    def times(self, factor: float) -> Polynomial:
        """A multiple of it."""
        return Polynomial([factor * c for c in self.c])


def work(force: Polynomial, place: Polynomial) -> float:
    """Integral of `force` along `place` over the whole step."""
    return sum(f * p * k / (i + k) for i, f in enumerate(force.c) for k, p in enumerate(place.c) if k > 0)


def through(nodes: Sequence[float], values: Sequence[float], slopes: Sequence[float] = ()) -> Polynomial:
    """The polynomial with these values, and slopes in tau, at the first nodes (Lagrange, Hermite)."""
    inverse = _inverse(tuple(round(tau, 9) for tau in nodes), len(values), len(slopes))
    return Polynomial((inverse @ np.array((*values, *slopes))).tolist())


@lru_cache(maxsize=512)
def _inverse(nodes: tuple[float, ...], values: int, slopes: int) -> np.ndarray:
    powers = range(values + slopes)
    rows = [[tau**k for k in powers] for tau in nodes[:values]]
    rows += [[k * tau ** (k - 1) if k else 0.0 for k in powers] for tau in nodes[:slopes]]
    return np.linalg.inv(np.array(rows))
