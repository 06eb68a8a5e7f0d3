"""How far a ball bearing may be loaded: contact pressure, static safety, rating life, drops until a limit.

Arithmetic after the standards, for pictures and reports; nothing of it acts in a simulation. `bearing` is
what is rated, `hertz` the contact of a ball with a race, `distribution` how balls share a load, `capacity`
the load ratings of ISO 76 and ISO 281, `life` rating lives by ISO 281 and ISO/TS 16281, `drops` the share
of such a life that a drop takes.
"""

from __future__ import annotations

from touchdown.bearings.rating.bearing import INNER, OUTER, RatedBearing
from touchdown.bearings.rating.capacity import (
    BALL_SHARE,
    PRESSURE_LIMIT,
    Capacity,
    capacity,
    dynamic_rating,
    pressure_safety,
    static_rating,
    static_safety,
)
from touchdown.bearings.rating.distribution import LoadDistribution, load_distribution
from touchdown.bearings.rating.drops import drop_damage, drops
from touchdown.bearings.rating.hertz import PointContact, point_contact
from touchdown.bearings.rating.life import basic_life, reference_life

__all__ = [
    "BALL_SHARE",
    "INNER",
    "OUTER",
    "PRESSURE_LIMIT",
    "Capacity",
    "LoadDistribution",
    "PointContact",
    "RatedBearing",
    "basic_life",
    "capacity",
    "drop_damage",
    "drops",
    "dynamic_rating",
    "load_distribution",
    "point_contact",
    "pressure_safety",
    "reference_life",
    "static_rating",
    "static_safety",
]
