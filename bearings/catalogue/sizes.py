"""The common sizes: boundary dimensions of ISO 15, all else by the rules of `estimate`."""

from __future__ import annotations

from functools import cache

from touchdown.bearings.catalogue.bearing import Bearing
from touchdown.bearings.catalogue.estimate import ANGULAR, DEEP_GROOVE, filled_in

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
    "719": (ANGULAR, "19"),
    "70": (ANGULAR, "10"),
    "72": (ANGULAR, "02"),
}
ORIGINS: dict[str, str] = dict.fromkeys(("bore", "outside", "width"), "ISO 15")


def designations() -> list[str]:
    """All sizes of `SERIES`."""
    return [f"{begins}{code:02d}" for begins in SERIES for code in range(len(BORES))]


@cache
def size(designation: str) -> Bearing:
    """The bearing of one of the `designations`."""
    begins, code = designation[:-2], int(designation[-2:])
    kind, series = SERIES[begins]
    outside, width = (1e-3 * float(number) for number in DIMENSIONS[series].split()[code].split("x"))
    dimensions = {"bore": 1e-3 * BORES[code], "outside": outside, "width": width}
    return filled_in(designation, kind, dimensions, ORIGINS)
