"""Which part of all drops whirls, from those that were looked at."""

from __future__ import annotations

from typing import NamedTuple

from scipy.stats import beta

CONFIDENCE = 0.95


class Share(NamedTuple):
    """A part of all, 0 to 1, and the interval that has it with CONFIDENCE."""

    value: float
    low: float
    high: float


def clopper_pearson(hits: float, count: float) -> Share:
    """The share of `hits` among `count` independent drops, and its exact binomial interval.

    Both may be no whole numbers, where drops weigh differently. `count` must be above 0.
    """
    tail, misses = 0.5 * (1.0 - CONFIDENCE), count - hits
    low = 0.0 if hits <= 0.0 else float(beta.ppf(tail, hits, misses + 1.0))
    high = 1.0 if misses <= 0.0 else float(beta.ppf(1.0 - tail, hits + 1.0, misses))
    return Share(hits / count, low, high)
