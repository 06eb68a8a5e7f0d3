"""How the balls of a bearing share a radial load at rest."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.optimize import root_scalar

from touchdown.bearings.rating.bearing import RACES, RatedBearing
from touchdown.bearings.rating.hertz import point_contact

ROUNDING = 1e-13
TINY = 1e-20  # m


@dataclass(frozen=True)
class LoadDistribution:
    """Loads of the balls of a row; the first is under the load."""

    angles: np.ndarray  # (count,), rad, from the direction of the load
    loads: np.ndarray  # (count,), N, along the contact's normal
    deflection: float  # m, of the rings against each other along the load, from the middle


def load_distribution(
    bearing: RatedBearing, radial_load: float, clearance: float = 0.0
) -> LoadDistribution:
    """A bearing under `radial_load` (N, above 0), rings rigid but for the contacts, no axial displacement.

    clearance: radial play between balls and races (m), half of what tables call radial internal clearance;
    negative is preload. Rows share the load alike. Raises ValueError for any other load.
    """
    if not 0.0 < radial_load < math.inf:
        raise ValueError(f"a radial load of {radial_load:g} N; it must be above 0")
    tilt = math.cos(bearing.contact_angle)
    angles = 2.0 * math.pi / bearing.count * np.arange(bearing.count)
    compliance = sum(point_contact(bearing, race).stiffness ** (-2.0 / 3.0) for race in RACES)

    def loads(deflection: float) -> np.ndarray:
        pressed = np.maximum((deflection * np.cos(angles) - clearance) * tilt, 0.0)
        return (pressed / compliance) ** 1.5

    def lacking(deflection: float) -> float:
        return bearing.rows * tilt * float(loads(deflection) @ np.cos(angles)) - radial_load

    one_ball = (radial_load / (bearing.rows * tilt)) ** (2.0 / 3.0) * compliance / tilt  # bears all of it
    most = max(clearance, 0.0) + (1.0 + ROUNDING) * one_ball
    found = root_scalar(lacking, bracket=(0.0, most), xtol=TINY, rtol=ROUNDING).root
    return LoadDistribution(angles, loads(found), found)
