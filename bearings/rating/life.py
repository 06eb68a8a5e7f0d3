"""Rating lives: ISO 281 by the bearing's load, ISO/TS 16281 by those of its balls. 10 % fail before."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from touchdown.bearings.rating.bearing import INNER, OUTER, RatedBearing
from touchdown.bearings.rating.capacity import EXPONENT, ring_ratio

MILLION = 1e6  # revolutions
SLOPE = 10.0 / 9.0  # of the Weibull distribution, point contact
TURNING, RESTING = 3.0, EXPONENT  # exponents of the mean load on a ring that turns or rests under the load


def basic_life(dynamic_rating: float, load: ArrayLike) -> np.ndarray:
    """L_10 = (C/P)^3 million revolutions (ISO 281), in revolutions; load: P (N, any shape)."""
    with np.errstate(divide="ignore"):
        return MILLION * (dynamic_rating / np.abs(np.asarray(load, float))) ** 3


def ball_ratings(bearing: RatedBearing, dynamic_rating: float) -> tuple[float, float]:
    """Q_ci and Q_ce (N), dynamic ratings of a ball on inner and outer race, from C_r (ISO/TS 16281)."""
    ratio = ring_ratio(bearing) ** EXPONENT
    mean = dynamic_rating / (bearing.count * math.cos(bearing.contact_angle) * bearing.rows**0.7)
    root = 1.0 / EXPONENT
    return mean / 0.407 * (1.0 + ratio) ** root, mean / 0.389 * (1.0 + 1.0 / ratio) ** root


def reference_life(
    bearing: RatedBearing, dynamic_rating: float, loads: ArrayLike, turning: str = INNER
) -> float:
    """L_10r (ISO/TS 16281) in revolutions of the rings against each other; inf without load.

    dynamic_rating: C_r of the whole bearing (N); loads: of each ball (count,) or, where they differ on
    inner and outer race, (count, 2), N; turning: the ring that turns under the load, the other rests.
    Rows carry the same.
    """
    pressing = np.maximum(np.asarray(loads, float).reshape(bearing.count, -1), 0.0)
    exponents = {INNER: (TURNING, RESTING), OUTER: (RESTING, TURNING)}[turning]
    ratings = ball_ratings(bearing, dynamic_rating)
    worn = 0.0
    for on_race, rating, exponent in zip(
        (pressing[:, 0], pressing[:, -1]), ratings, exponents, strict=True
    ):
        equivalent = float(np.mean(on_race**exponent)) ** (1.0 / exponent)
        worn += bearing.rows * (equivalent / rating) ** EXPONENT
    return MILLION * worn ** (-1.0 / SLOPE) if worn > 0.0 else math.inf
