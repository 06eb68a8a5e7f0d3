"""Ratings of a rolling bearing in a run: pressure, static safety, drops until a limit. All are estimates."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from touchdown.bearings import rating
from touchdown.master.coupling.connections import Attachment
from touchdown.master.report.subject import Subject

NEEDED = ("balls.count", "balls.diameter", "balls.pitch_diameter", "balls.conformity")
STATIC = "rolling.static_rating"


@dataclass(frozen=True)
class Rated:
    """A bearing with what a run did to it."""

    bearing: rating.RatedBearing
    load: np.ndarray  # N, of the most loaded ball, (rows,)
    peak_load: float  # N, also between recorded values
    time: np.ndarray  # s, (rows,)
    ring_speed: np.ndarray  # rad/s, of the inner ring, (rows,)
    static_rating: float  # N
    static_source: str
    dynamic_rating: float  # N
    dynamic_source: str

    def pressure(self, load: np.ndarray) -> np.ndarray:
        """Largest on the inner race (Pa) under a ball load (N)."""
        return rating.point_contact(self.bearing, rating.INNER).pressure(load)

    def pressure_outside(self, load: np.ndarray) -> np.ndarray:
        """Largest on the outer race (Pa) under a ball load (N)."""
        return rating.point_contact(self.bearing, rating.OUTER).pressure(load)

    @property
    def axes(self) -> tuple[float, float]:
        """Half axes of the largest contact on the inner race (m)."""
        across, along = rating.point_contact(self.bearing, rating.INNER).semi_axes(np.array(self.peak_load))
        return float(across), float(along)
