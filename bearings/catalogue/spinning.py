"""Effects of spin on a bearing's inner ring: speed of its race, and growth."""

from __future__ import annotations

from typing import NamedTuple

from ...modelkit.variables import as_record
from ..contact.materials import SILICON_NITRIDE, SILICON_NITRIDE_DENSITY, STEEL_DENSITY, elastic_of
from ..heat.growth import ring_growth
from ..rolling.ball_set import inner_radius
from .entry import Bearing

# Surface speed (m/s) from which growth is worth a thought: it goes with the square
WORTH_GROWTH = 150.0


class Spun(NamedTuple):
    """Of an inner ring."""

    surface: float  # m/s, speed of the race
    bore: float  # m, growth of the bore on radius, which adds to the clearance
    race: float  # m, growth of the race on radius, which takes from the play

    @property
    def matters(self) -> bool:
        """Whether its surface is so fast that growth is worth a thought."""
        return self.surface > WORTH_GROWTH


def spun(bearing: Bearing, speed: float) -> Spun:
    """The inner ring of `bearing`, from the bore to the bottom of its groove, at `speed` (rad/s)."""
    race = float(inner_radius(as_record(bearing.balls)))
    ceramic = bearing.ring.material == SILICON_NITRIDE
    density = SILICON_NITRIDE_DENSITY if ceramic else STEEL_DENSITY
    grown = ring_growth(0.5 * bearing.bore, race, speed, density, elastic_of(as_record(bearing.ring)))
    return Spun(abs(speed) * race, float(grown.bore), float(grown.rim))
