"""Versions of numba whose inner workings are relied on where they were tried, and nowhere else."""

from __future__ import annotations

from functools import cache
from importlib.metadata import version

NUMBA = ((0, 68), (0, 68))  # the first and the last


@cache
def is_tried() -> bool:
    """Whether numba is of a version among them."""
    numbers = tuple(int(part) for part in version("numba").split(".")[:2])
    return NUMBA[0] <= numbers <= NUMBA[1]
