"""How much of a bearing's rating life a drop takes (Palmgren and Miner): an estimate.

Rating lives are of bearings that run long, lubricated and not pressed beyond half of C; a drop is none of
that. They rank designs and loads, and tell when fatigue is not what ends a touchdown bearing.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from touchdown.bearings.rating.bearing import RatedBearing
from touchdown.bearings.rating.distribution import load_distribution
from touchdown.bearings.rating.life import reference_life


def drop_damage(
    bearing: RatedBearing, dynamic_rating: float, largest_load: ArrayLike, revolutions: ArrayLike
) -> float:
    """Share of the life L_10r (ISO/TS 16281) that a drop takes: the sum of revolutions over life.

    largest_load: of the most loaded ball (N, (K,)), from a histogram or a recording; revolutions: of the
    rings against each other while it acts ((K,), at least 0). The other balls are taken as loaded as in a
    bearing without clearance, whose life falls with the third power of that load. Raises ValueError for
    arrays of different lengths.
    """
    load, turns = np.maximum(np.asarray(largest_load, float), 0.0), np.asarray(revolutions, float)
    if load.shape != turns.shape:
        raise ValueError(f"{load.size} loads and {turns.size} numbers of revolutions")
    shared = load_distribution(bearing, 1.0).loads
    life = reference_life(bearing, dynamic_rating, shared / shared.max())  # revolutions, at 1 N
    return float(np.sum(turns * load**3)) / life


def drops(damage: float) -> float:
    """Drops until 10 % of such bearings have failed by fatigue, all of one `damage`; inf without any."""
    return 1.0 / damage if damage > 0.0 else math.inf
