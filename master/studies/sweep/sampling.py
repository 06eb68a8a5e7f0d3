"""Samples of the unit cube, by scipy.stats.qmc."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from touchdown.master.common.errors import TouchdownError


@dataclass(frozen=True)
class Method:
    """A way to spread points."""

    title: str
    draw: Callable[[int, int, np.random.Generator], np.ndarray]  # dimensions, count
    powers_of_two: bool = False  # only so many points are balanced


def _random(dimensions: int, count: int, source: np.random.Generator) -> np.ndarray:
    return source.random((count, dimensions))


def _latin(dimensions: int, count: int, source: np.random.Generator) -> np.ndarray:
    from scipy.stats import qmc  # slow to import

    return qmc.LatinHypercube(dimensions, rng=source).random(count)


def _sobol(dimensions: int, count: int, source: np.random.Generator) -> np.ndarray:
    from scipy.stats import qmc

    return qmc.Sobol(dimensions, rng=source).random(count)


RANDOM = Method("a random sample", _random)
LATIN = Method("a Latin hypercube", _latin)
SOBOL = Method("a Sobol sequence", _sobol, powers_of_two=True)


def unit_cube(method: Method, dimensions: int, count: int, seed: int) -> np.ndarray:
    """Points (count, dimensions) between 0 and 1; equal for equal seeds. Raises TouchdownError."""
    if count < 1:
        raise TouchdownError(f"a sample of {count} points is none; ask for 1 at least")
    if seed < 0:
        raise TouchdownError(f"seed = {seed} must be a whole number, 0 or above")
    if method.powers_of_two and count & (count - 1):
        below = 2 ** (count.bit_length() - 1)
        raise TouchdownError(
            f"{count} points of a Sobol sequence are not balanced; ask for a power of 2: {below} or "
            f"{2 * below}"
        )
    return method.draw(dimensions, count, np.random.default_rng(seed))
