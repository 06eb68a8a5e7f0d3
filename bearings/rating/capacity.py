"""Load ratings of radial ball bearings, static (ISO 76) and dynamic (ISO 281); safety against the first.

The first is computed as ISO/TR 10657 derives the factors that ISO 76 tabulates, and meets them; the second
takes the factors f_c that ISO 281 tabulates, less where grooves are wider than those they are for, by the
formula behind them (ISO/TR 1281-1). Makers state their own, for other grooves and better steel.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from touchdown.bearings.rating.bearing import RACES, RatedBearing
from touchdown.bearings.rating.hertz import point_contact

PRESSURE_LIMIT = 4.2e9  # Pa; of ISO 76 for ball bearings: a ball and its race keep 1e-4 of its diameter
BALL_SHARE = 5.0  # of the mean load, on the most loaded ball of a bearing with usual clearance (ISO 76)
STEEL = 1.3  # b_m of ISO 281, radial ball bearings of contemporary steel
LARGEST_BALL = 25.4  # mm, from which on the rating rises less
INNER_GROOVE, OUTER_GROOVE = 0.52, 0.53  # the widest for which f_c holds
EXPONENT = 10.0 / 3.0
FACTORS = (  # f_c of ISO 281 (2007), Table 2, single-row radial ball bearings, for 0.01, 0.02, ... of gamma
    *(29.1, 35.8, 40.3, 43.8, 46.7, 49.1, 51.1, 52.8, 54.3, 55.5),
    *(56.6, 57.5, 58.2, 58.8, 59.3, 59.6, 59.8, 59.9, 60.0, 59.9),
    *(59.8, 59.6, 59.3, 59.0, 58.6, 58.2, 57.7, 57.1, 56.6, 56.0),
    *(55.3, 54.6, 53.9, 53.2, 52.4, 51.7, 50.9, 50.0, 49.2, 48.4),
)


class Capacity(NamedTuple):
    """Load ratings of a whole bearing, all its rows."""

    static: float  # C_0r, N
    dynamic: float  # C_r, N


def capacity(bearing: RatedBearing, static: float = 0.0, dynamic: float = 0.0) -> Capacity:
    """`Capacity` by the ratings of a row that a maker states (N), where above 0, else by the standards."""
    all_static, all_dynamic = bearing.rows * static, bearing.rows**0.7 * dynamic
    return Capacity(all_static or static_rating(bearing), all_dynamic or dynamic_rating(bearing))


def static_rating(bearing: RatedBearing) -> float:
    """C_0r (N) by ISO 76: the load at which the most loaded ball presses a race with 4200 MPa."""
    most = min(float(point_contact(bearing, race).load(PRESSURE_LIMIT)) for race in RACES)
    return bearing.rows * bearing.count * math.cos(bearing.contact_angle) * most / BALL_SHARE


def ring_ratio(bearing: RatedBearing) -> float:
    """Rating of the inner ring over that of the outer one (ISO/TS 16281, what its Q_ci raises to 10/3)."""
    return _ring_ratio(bearing.gamma, bearing.inner_groove, bearing.outer_groove)


def _ring_ratio(gamma: float, inner: float, outer: float) -> float:
    grooves = inner / outer * (2.0 * outer - 1.0) / (2.0 * inner - 1.0)
    return 1.044 * ((1.0 - gamma) / (1.0 + gamma)) ** 1.72 * grooves**0.41


def dynamic_rating(bearing: RatedBearing) -> float:
    """C_r (N) by ISO 281, b_m = 1.3; beyond its table, gamma from 0.01 to 0.40, by the nearest value."""
    b = bearing
    wider = max(b.inner_groove, INNER_GROOVE), max(b.outer_groove, OUTER_GROOVE)
    share = _grooves(b.gamma, *wider) / _grooves(b.gamma, INNER_GROOVE, OUTER_GROOVE)
    factor = share * float(np.interp(100.0 * b.gamma, np.arange(1, len(FACTORS) + 1), FACTORS))
    size = 1e3 * b.diameter
    ball = size**1.8 if size <= LARGEST_BALL else 3.647 * size**1.4
    rows = (b.rows * math.cos(b.contact_angle)) ** 0.7
    return STEEL * factor * rows * b.count ** (2.0 / 3.0) * ball


def _grooves(gamma: float, inner: float, outer: float) -> float:
    """What f_c owes to the grooves, but for a factor (ISO/TR 1281-1)."""
    both = (1.0 + _ring_ratio(gamma, inner, outer) ** EXPONENT) ** (-1.0 / EXPONENT)
    return both * (2.0 * inner / (2.0 * inner - 1.0)) ** 0.41


def static_safety(rating: float, load: ArrayLike) -> np.ndarray:
    """s_0 = C_0 / P_0 (ISO 76) of a bearing under a radial `load` (N, any shape); inf without one."""
    with np.errstate(divide="ignore"):
        return rating / np.abs(np.asarray(load, float))


def pressure_safety(pressure: ArrayLike) -> np.ndarray:
    """The same from a contact's largest pressure (Pa): load over that at 4200 MPa is as its third power."""
    with np.errstate(divide="ignore"):
        return (PRESSURE_LIMIT / np.asarray(pressure, float)) ** 3
