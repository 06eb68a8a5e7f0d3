"""Bearings with a designation: Tables 1 and 3 of Halminen (2016), and the common sizes of ISO 15.

Filled in, because Halminen (2016) does not give them: masses and inertias of the inner rings, masses of the
outer rings (catalogue mass less the other parts), static load ratings of the small bearings, dynamic ones
by ISO 281, the cage as heavy as two balls. Corrected: the pitch diameter of the 6904, printed as 26.1 mm,
which cannot hold 17 balls of 4.8 mm; 28.5 mm is the mean of bore and outside diameter. Read: the 5 um of
Table 1 as radial play, which reproduces Table 7; the clearances of Table 3 as printed, on
diameter. Stiffness of the races is that of Halminen (2016), with the fits for the elliptic integrals.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache, partial

from ...modelkit.kernel import interpret
from ...modelkit.variables import as_record
from ..contact.laws import PRINTED
from ..rating import dynamic_rating
from ..rolling.ball_set import BallSet, ball_mass
from ..rolling.ring import Ring
from .entry import NUMBERS, Bearing
from .estimate import ANGULAR, DEEP_GROOVE, filled_in

GIVEN = ("bore", "outside", "width", "balls", "rows", "ball_diameter", "pitch_diameter", "play")
GROOVES = ("inner_groove", "outer_groove")
_GROOVES_OF_1 = dict.fromkeys(GROOVES, "as in Table 3")

_balls = partial(BallSet, hertz=PRINTED)
_open = partial(Bearing, cage=0.0, dynamic_rating=0.0)  # what `_complete` fills in


def _complete(bearing: Bearing, table: str, **others: str) -> Bearing:
    """With cage and dynamic rating, and origins of numbers: the `table` of Halminen (2016), or `others`."""
    row = replace(bearing.rated(), rows=1)
    origins = dict.fromkeys(NUMBERS, "filled in") | dict.fromkeys((*GIVEN, *GROOVES), table)
    origins |= {"cage_mass": "as two balls", "dynamic_rating": "ISO 281", "contact_angle": "not stated"}
    b = bearing.balls
    return replace(
        bearing,
        cage=2.0 * interpret(ball_mass, as_record(b)),
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


BORES = (10, 12, 15, 17, *range(20, 101, 5))  # mm, of the codes 00, 01, ... 20
DIMENSIONS = {  # dimension series of ISO 15: outside diameter x width in mm, by bore
    "18": "19x5 21x5 24x5 26x5 32x7 37x7 42x7 47x7 52x7 58x7 65x7 72x9 78x10 85x10 90x10 95x10 100x10 "
    "110x13 115x13 120x13 125x13",
    "19": "22x6 24x6 28x7 30x7 37x9 42x9 47x9 55x10 62x12 68x12 72x12 80x13 85x13 90x13 100x16 105x16 "
    "110x16 120x18 125x18 130x18 140x20",
    "10": "26x8 28x8 32x9 35x10 42x12 47x12 55x13 62x14 68x15 75x16 80x16 90x18 95x18 100x18 110x20 "
    "115x20 125x22 130x22 140x24 145x24 150x24",
    "02": "30x9 32x10 35x11 40x12 47x14 52x15 62x16 72x17 80x18 85x19 90x20 100x21 110x22 120x23 125x24 "
    "130x25 140x26 150x28 160x30 170x32 180x34",
    "03": "35x11 37x12 42x13 47x14 52x15 62x17 72x19 80x21 90x23 100x25 110x27 120x29 130x31 140x33 "
    "150x35 160x37 170x39 180x41 190x43 200x45 215x47",
}
SERIES = {  # what designations begin with: kind and dimension series
    "618": (DEEP_GROOVE, "18"),
    "619": (DEEP_GROOVE, "19"),
    "60": (DEEP_GROOVE, "10"),
    "62": (DEEP_GROOVE, "02"),
    "63": (DEEP_GROOVE, "03"),
    "718": (ANGULAR, "18"),
    "719": (ANGULAR, "19"),
    "70": (ANGULAR, "10"),
    "72": (ANGULAR, "02"),
}
ALSO_CALLED = {"68": "618", "69": "619", "79": "719"}  # thin sections, by JIS B 1513: 6907 is the 61907
ORIGINS: dict[str, str] = dict.fromkeys(("bore", "outside", "width"), "ISO 15")


def designations() -> list[str]:
    """All sizes of `SERIES`."""
    return [f"{begins}{code:02d}" for begins in SERIES for code in range(len(BORES))]


def usual(designation: str) -> str:
    """A designation of JIS as ISO has it; others as they are."""
    begins, code = designation[:-2], designation[-2:]
    return f"{ALSO_CALLED[begins]}{code}" if begins in ALSO_CALLED else designation


@cache
def size(designation: str, contact_angle: float | None = None) -> Bearing | None:
    """The bearing of one of the `designations`; None where it has no contact angle, and one is asked for.

    contact_angle: rad, of angular contact; None: 15 degrees.
    """
    begins, code = designation[:-2], int(designation[-2:])
    kind, series = SERIES[begins]
    outside, width = (1e-3 * float(number) for number in DIMENSIONS[series].split()[code].split("x"))
    dimensions = {"bore": 1e-3 * BORES[code], "outside": outside, "width": width}
    if contact_angle is None:
        return filled_in(designation, kind, dimensions, ORIGINS)
    if kind != ANGULAR:
        return None
    angle = {"contact_angle": contact_angle}
    return filled_in(designation, kind, dimensions | angle, ORIGINS | {"contact_angle": "designation"})
