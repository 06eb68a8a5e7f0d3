"""Effects of spin on a bearing's inner ring: speed of its race, and growth."""

from __future__ import annotations

import math
from typing import NamedTuple

from ...modelkit.variables import as_record
from ..angular.angular_row import series_stiffness
from ..contact.materials import SILICON_NITRIDE, SILICON_NITRIDE_DENSITY, STEEL_DENSITY, elastic_of
from ..heat.growth import spin_growth
from ..rolling.ball_set import RaceStiffness, inner_radius, set_stiffness
from .entry import Bearing
from .landing import STRIBECK

WORTH_GROWTH = 0.1  # of the play, or of the load by which the balls are pressed


class Spun(NamedTuple):
    """Of an inner ring, and what its growth is judged by."""

    surface: float  # m/s, speed of the race
    bore: float  # m, growth of the bore on radius, which adds to the clearance
    race: float  # m, growth of the race on radius, which takes from the play
    play: float  # m, radial
    preload: float  # m, indentation of a ball on both races by the preload of a pair
    weight: float  # m, of the most loaded ball by the weight that lies on the bearing

    @property
    def judged_by(self) -> tuple[float, str]:
        """(What growth is compared with (m), in words): of preload, else play, else weight; 0: none."""
        if self.preload > 0.0:
            return self.preload, "what the preload presses the balls in"
        if self.play > 0.0:
            return self.play, "the radial play"
        return self.weight, "what the weight presses the most loaded ball in"

    @property
    def matters(self) -> bool:
        """Whether growth changes play or ball loads by more than a little."""
        size = self.judged_by[0]
        power = 1.0 if size == self.play else 1.5  # of a load by its indentation
        return size == 0.0 or (1.0 + self.race / size) ** power - 1.0 > WORTH_GROWTH

    def words(self) -> str:
        """The growth beside what it is judged by."""
        size, by = self.judged_by
        share = f"{float(f'{self.race / size:.2g}'):g} times {by}" if size > 0.0 else "with no play to take"
        return f"the race grows by {1e6 * self.race:.2g} um on radius, {share}"


def spun(bearing: Bearing, speed: float, weight: float = 0.0) -> Spun:
    """The inner ring of `bearing`, from the bore to the bottom of its groove, at `speed` (rad/s).

    weight: N, on the bearing once the rotor lies; 0: not known.
    """
    b, elastic = bearing.balls, elastic_of(as_record(bearing.ring))
    race = float(inner_radius(as_record(b)))
    ceramic = bearing.ring.material == SILICON_NITRIDE
    density = SILICON_NITRIDE_DENSITY if ceramic else STEEL_DENSITY
    grown = spin_growth(0.5 * bearing.bore, race, speed, density, elastic)
    radial = as_record(RaceStiffness())
    set_stiffness(radial, as_record(b), elastic)
    lying = STRIBECK * weight / (b.count * b.rows) / float(radial["series"])
    clamped = 0.0
    if bearing.preload > 0.0:
        angle = bearing.contact_angle
        ball = bearing.preload / (b.count * math.sin(angle))
        clamped = ball / float(series_stiffness(as_record(b), elastic, angle))
    indented = (amount ** (2.0 / 3.0) for amount in (clamped, lying))
    return Spun(abs(speed) * race, float(grown.bore), float(grown.rim), max(b.play, 0.0), *indented)
