"""Drops over phases of the unbalance, and what the source's Fig 14 says of them."""

from __future__ import annotations

import statistics
from collections.abc import Mapping, Sequence

SEATS = ("A", "B")
NO_LIMIT = {"run.stop_residual": 1000.0}  # of what is turned over: never, so that every drop counts
PHASE = "rotor.unbalance_angle"


def phases(members: int) -> dict[str, list[str]]:
    """The ensemble: unbalance phases around the circle."""
    return {PHASE: [f"{360.0 * i / members:g} deg" for i in range(members)]}


def numbers(figures: Sequence[Mapping[str, object]], key: str) -> list[float]:
    """A figure of the drops that have it."""
    return [float(v) for f in figures if isinstance(v := f.get(key), (int, float))]


def spread(values: Sequence[float]) -> str:
    """Median, smallest and largest; a dash where there is none."""
    if not values:
        return "-"
    return f"{statistics.median(values):.3g} ({min(values):.3g} to {max(values):.3g})"


SPEEDS = (9000, 18000)  # rpm
SOURCE = {  # misalignment of each bearing [um]: the source's verdict
    0: "settles",
    75: "settles",
    150: "settles",
    225: "whirls",
}
DURATION = 0.5  # s
