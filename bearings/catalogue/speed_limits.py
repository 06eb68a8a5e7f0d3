"""How fast ball bearings run for long, by their cages: bore diameter times speed, the d n of catalogues.

Figures of cages are those of New Hampshire Ball Bearings (Engineering reference: cages for radial and for
miniature ball bearings, in 1000 dN). Bearings without a cage have none there: their balls rub on one
another, and catalogues call their speed moderate. Makers of hybrid bearings state 20 to 40 % more with
ceramic balls, of which the lower is taken. All is for lubricated bearings that run for hours; a touchdown
bearing runs for seconds, most often dry: a limit kept proves nothing, and one exceeded is to
be asked about.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from types import MappingProxyType

from ..contact.materials import STEEL
from .entry import Bearing

MM_RPM = 1e-3 * 2.0 * math.pi / 60.0  # m rad/s
SPEED_FACTORS: Mapping[str, float] = MappingProxyType(  # m rad/s, bore times speed
    {
        "steel ribbon, clinched": 150e3 * MM_RPM,
        "steel ribbon, riveted": 250e3 * MM_RPM,
        "phosphor bronze": 1000e3 * MM_RPM,
        "machined phenolic or polyamide-imide": 1200e3 * MM_RPM,
    }
)
HYBRID = 1.2  # of the limit with steel balls


def speed_factor(bearing: Bearing, speed: float) -> float:
    """Bore times `speed` (rad/s): m rad/s."""
    return bearing.bore * abs(speed)


def limits(bearing: Bearing) -> Mapping[str, float]:
    """Largest speed factor (m rad/s) of the bearing for long, by what its cage may be."""
    more = 1.0 if bearing.balls.material == STEEL else HYBRID
    return {cage: more * limit for cage, limit in SPEED_FACTORS.items()}


def cages_for(bearing: Bearing, speed: float) -> tuple[str, ...]:
    """Cages that run the bearing at `speed` (rad/s) for long; none where it is faster than all."""
    factor = speed_factor(bearing, speed)
    return tuple(cage for cage, limit in limits(bearing).items() if factor <= limit)
