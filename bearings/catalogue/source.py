"""Bearings of the source's Tables 1 and 3.

Filled in, because the source does not give them: masses and inertias of the inner rings, masses of the
outer rings (catalogue mass less the other parts), static load ratings of the small bearings, dynamic ones
by ISO 281, the cage as heavy as two balls. Corrected: the pitch diameter of the 6904, printed as 26.1 mm,
which cannot hold 17 balls of 4.8 mm; 28.5 mm is the mean of bore and outside diameter. Read: the 5 um of
Table 1 as radial play, which reproduces the source's Table 7; the clearances of Table 3 as printed, on
diameter. Stiffness of the races is the source's, with its fits for the elliptic integrals.
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial

from touchdown.bearings.catalogue.bearing import NUMBERS, Bearing
from touchdown.bearings.contact.stiffness import PRINTED
from touchdown.bearings.rating import dynamic_rating
from touchdown.bearings.rolling.balls import BallSet
from touchdown.bearings.rolling.balls.geometry import ball_mass
from touchdown.bearings.rolling.ring import Ring

GIVEN = ("bore", "outside", "width", "balls", "rows", "ball_diameter", "pitch_diameter", "play")
GROOVES = ("inner_groove", "outer_groove")
_GROOVES_OF_1 = dict.fromkeys(GROOVES, "as in Table 3")

_balls = partial(BallSet, hertz=PRINTED)
_open = partial(Bearing, cage=0.0, dynamic_rating=0.0)  # what `_complete` fills in


def _complete(bearing: Bearing, table: str, **others: str) -> Bearing:
    """With cage and dynamic rating, and where numbers are from: the `table` of the source, or `others`."""
    row = replace(bearing.rated(), rows=1)
    origins = dict.fromkeys(NUMBERS, "filled in") | dict.fromkeys((*GIVEN, *GROOVES), table)
    origins |= {"cage_mass": "as two balls", "dynamic_rating": "ISO 281", "contact_angle": "not stated"}
    b = bearing.balls
    return replace(
        bearing,
        cage=2.0 * ball_mass(b.rows, b.diameter, b.density),
        dynamic_rating=dynamic_rating(row),
        origins=origins | others,
    )


FROM_SOURCE = (
    _complete(
        _open(
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
        "Table 1",
        **_GROOVES_OF_1,
    ),
    _complete(
        _open(
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
        "Table 1",
        **_GROOVES_OF_1,
        pitch_diameter="mean of bore and outside diameter",
    ),
    _complete(
        _open(
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
        "Table 3",
        damping="Table 3",
        static_rating="Table 3",
    ),
    _complete(
        _open(
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
        "Table 3",
        damping="Table 3",
        static_rating="Table 3",
    ),
    _complete(
        _open(
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
        "Table 3",
        damping="Table 3",
        static_rating="Table 3",
    ),
)
