"""The order at which an error falls with the macro step."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

ABOVE_FLOOR = 10.0  # an error counts from this many times the floor of what it is measured against
RISING = 0.5  # least slope between neighbours: below it something else than the macro step errs
FEWEST = 3  # steps that a slope is fitted to


@dataclass(frozen=True)
class Order:
    """Slope of log error over log step, and the steps (s) it was fitted to."""

    value: float
    steps: tuple[float, ...]


def fitted_order(
    steps: Sequence[float], errors: Sequence[float], floor: float, saturated: float
) -> Order | None:
    """The slope over the longest stretch of steps in which the error rises with the step.

    Errors within ABOVE_FLOOR times `floor`, from `saturated` on, and what is not a number are left out;
    a plateau, such as that of the steps inside a bearing, ends a stretch. None where it is too short.
    """
    stretch: list[tuple[float, float]] = []
    longest: list[tuple[float, float]] = []
    for step, error in sorted(zip(steps, errors, strict=True)):
        counts = error > 0.0 and ABOVE_FLOOR * floor < error < saturated
        if not counts:
            stretch = []
            continue
        if stretch and np.log(error / stretch[-1][1]) < RISING * np.log(step / stretch[-1][0]):
            stretch = []
        stretch.append((step, error))
        longest = max(longest, stretch, key=len).copy()
    if len(longest) < FEWEST:
        return None
    used, errors_used = zip(*longest, strict=True)
    return Order(float(np.polyfit(np.log(used), np.log(errors_used), 1)[0]), used)
