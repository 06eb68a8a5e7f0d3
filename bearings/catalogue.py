"""Bearings of the source's Tables 1 and 3, ready to be set in a model.

Filled in, because the source does not give them: masses and inertias of the inner rings, masses of the
outer rings (catalogue mass less the other parts), static load ratings of the small bearings, the cage
as heavy as two balls. Corrected: the pitch diameter of the 6904, printed as 26.1 mm, which cannot hold
17 balls of 4.8 mm; 28.5 mm is the mean of bore and outside diameter. Read: the 5 um of Table 1 as radial
play, which reproduces the source's Table 7; the clearances of Table 3 as printed, on diameter. Stiffness of
the races is the source's, with its fits for the elliptic integrals.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

from touchdown.bearings.contact.stiffness import PRINTED
from touchdown.bearings.rolling.balls import BallSet
from touchdown.bearings.rolling.balls.geometry import ball_mass
from touchdown.bearings.rolling.ring import Ring


@dataclass(frozen=True)
class Bearing:
    """A rolling bearing: geometry, masses, rating. Lengths in m, masses in kg."""

    designation: str
    bore: float
    outside: float
    width: float
    balls: BallSet
    ring: Ring
    caged: bool
    outer_ring: float  # mass
    static_rating: float  # N, of a row
    damping: float = 0.0  # N s/m, between the rings (2.7)

    def settings(self) -> dict[str, float]:
        """Values by parameter name; a model takes those it has."""
        b = self.balls
        return {
            "balls.count": b.count,
            "balls.rows": b.rows,
            "balls.diameter": b.diameter,
            "balls.pitch_diameter": b.pitch_diameter,
            "balls.play": b.play,
            "balls.conformity": b.conformity,
            "balls.hertz": b.hertz,
            "ring.mass": self.ring.mass,
            "ring.inertia": self.ring.inertia,
            "cage.mass": 2.0 * ball_mass(b.rows, b.diameter, b.density),
            "rolling.static_rating": self.static_rating,
            "damping": self.damping,
        }


_balls = partial(BallSet, hertz=PRINTED)

CATALOGUE = {
    bearing.designation: bearing
    for bearing in (
        Bearing(
            "6004",
            bore=20e-3,
            outside=42e-3,
            width=12e-3,
            balls=_balls(count=9, diameter=6.4e-3, pitch_diameter=31e-3, play=5e-6),
            ring=Ring(mass=0.015, inertia=1.9e-6),
            caged=True,
            outer_ring=0.042,
            static_rating=5000.0,
        ),
        Bearing(
            "6904",
            bore=20e-3,
            outside=37e-3,
            width=9e-3,
            balls=_balls(count=17, diameter=4.8e-3, pitch_diameter=28.5e-3, play=0.0),
            ring=Ring(mass=0.0095, inertia=1.08e-6),
            caged=False,
            outer_ring=0.020,
            static_rating=3650.0,
        ),
        Bearing(
            "6014",
            bore=70e-3,
            outside=110e-3,
            width=20e-3,
            balls=_balls(count=11, diameter=12e-3, pitch_diameter=90e-3, play=7.5e-6),
            ring=Ring(mass=0.376, inertia=5.2e-4),  # with the bronze ring
            caged=True,
            outer_ring=0.30,
            static_rating=31000.0,
            damping=300.0,
        ),
        Bearing(
            "7914",  # one of the pair; its half of the bronze ring is in the inner ring
            bore=70e-3,
            outside=100e-3,
            width=16e-3,
            balls=_balls(count=11, diameter=11.7e-3, pitch_diameter=85e-3, play=4.5e-6),
            ring=Ring(mass=0.2265, inertia=3.05e-4),
            caged=True,
            outer_ring=0.18,
            static_rating=20900.0,
            damping=270.0,
        ),
        Bearing(
            "7914 pair",  # both, as one set of two rows under the whole bronze ring
            bore=70e-3,
            outside=100e-3,
            width=32e-3,
            balls=_balls(count=11, rows=2, diameter=11.7e-3, pitch_diameter=85e-3, play=4.5e-6),
            ring=Ring(mass=0.453, inertia=6.1e-4),
            caged=True,
            outer_ring=0.36,
            static_rating=20900.0,
            damping=2 * 270.0,
        ),
    )
}
