"""Estimates of data that makers do not print: geometry, masses and ratings by common rules.

    pitch diameter   mean of bore and outside diameter
    ball             0.30 of their difference
    balls            deep groove: as many as an eccentric inner ring lets in, over an angle of 186 deg;
                     angular contact: spaced by 1.15 ball diameters
    grooves          0.52 (inner) and 0.53 (outer) of the ball's diameter (ISO/TS 16281)
    play             deep groove: the middle of clearance group N of ISO 5753-1; angular contact: none
    rings            steel, shoulders 0.2 ball diameters high, less their grooves; the cage as two balls
    ratings          ISO 76 and ISO 281 for this geometry

How far that is off the catalogues of makers is in `docs/bearings.md`, and in the tests: typically 10 % in
the ratings, 20 % at most; 3 % in mass. The ratio 0.30 and the angle are the round numbers of the rule that
text books give as 0.25 to 0.32 and 180 to 195 deg; they are not fitted to any one size.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import NamedTuple

from ..angular.angular_row import SINGLE, SINGLES
from ..rating import RatedBearing, dynamic_rating, static_rating
from ..rolling.ball_set import MAX_BALLS, BallSet
from ..rolling.ring import Ring
from .entry import Bearing
from .section import SHOULDER_HEIGHT, segment

DEEP_GROOVE, ANGULAR = "deep groove", "angular contact"
BALL_TO_SECTION = 0.30  # of the difference of outside diameter and bore
FILL_ANGLE = math.radians(186.0)  # by the balls of a deep groove bearing
BALL_SPACING = 1.15  # ball diameters from ball to ball, angular contact
CONTACT_ANGLE = math.radians(15.0)  # of contact
GROOVES = (0.52, 0.53)
CAGE_MASS_IN_BALLS = 2.0  # balls
STEEL_DENSITY = 7830.0  # kg/m3
NORMAL_CLEARANCE = (  # ISO 5753-1, group N: bores up to (m), radial clearance from and to (m)
    *((10e-3, 2e-6, 13e-6), (18e-3, 3e-6, 18e-6), (30e-3, 5e-6, 20e-6), (40e-3, 6e-6, 20e-6)),
    *((50e-3, 6e-6, 23e-6), (65e-3, 8e-6, 28e-6), (80e-3, 10e-6, 30e-6), (100e-3, 12e-6, 36e-6)),
    *((120e-3, 15e-6, 41e-6), (140e-3, 18e-6, 48e-6), (160e-3, 18e-6, 53e-6), (180e-3, 20e-6, 61e-6)),
    *((200e-3, 25e-6, 71e-6),),
)
BY_RULE = {  # origin of what follows from these rules
    "rows": "one",
    "row_distance": "none",
    "preload": "none",
    "pitch_diameter": "mean of bore and outside diameter",
    "ball_diameter": "0.30 of outside diameter less bore",
    "inner_groove": "ISO/TS 16281",
    "outer_groove": "ISO/TS 16281",
    "ring_mass": "steel, by its shape",
    "ring_inertia": "steel, by its shape",
    "outer_ring_mass": "steel, by its shape",
    "cage_mass": "as two balls",
    "static_rating": "ISO 76",
    "dynamic_rating": "ISO 281",
    "damping": "none",
}
BY_KIND = {
    DEEP_GROOVE: {
        "balls": "fill angle of 186 deg",
        "contact_angle": "none",
        "play": "middle of ISO 5753-1, group N",
    },
    ANGULAR: {"balls": "spaced by 1.15 diameters", "contact_angle": "15 deg", "play": "none"},
}


class Rings(NamedTuple):
    """Masses of the rings."""

    inner: float  # kg
    inertia: float  # kg m2, of the inner one
    outer: float  # kg


def filled_in(
    designation: str,
    kind: str,
    known: Mapping[str, float],
    origins: Mapping[str, str],
    arrangement: int = SINGLE,
) -> Bearing:
    """A bearing of `kind` (`DEEP_GROOVE` or `ANGULAR`) by what is `known` of it, the rest by the rules.

    known: SI, by the names of `NUMBERS`, bore, outside and width among them; origins: where these are from;
    arrangement: of `ARRANGEMENTS`, of two rows that stand half the width apart.
    """
    n = dict(known)
    n.setdefault("rows", 1)
    n.setdefault("contact_angle", CONTACT_ANGLE if kind == ANGULAR else 0.0)
    n.setdefault("pitch_diameter", 0.5 * (n["bore"] + n["outside"]))
    n.setdefault("ball_diameter", BALL_TO_SECTION * (n["outside"] - n["bore"]))
    n.setdefault("balls", _count(kind, n["ball_diameter"], n["pitch_diameter"]))
    n.setdefault("inner_groove", GROOVES[0])
    n.setdefault("outer_groove", GROOVES[1])
    n.setdefault("play", 0.0 if kind == ANGULAR else _normal_play(n["bore"]))
    n.setdefault("damping", 0.0)
    n.setdefault("row_distance", 0.0 if arrangement in SINGLES else 0.5 * n["width"])
    n.setdefault("preload", 0.0)
    rings = _rings(n)
    n.setdefault("ring_mass", rings.inner)
    n.setdefault("ring_inertia", n["ring_mass"] / rings.inner * rings.inertia)
    n.setdefault("outer_ring_mass", rings.outer)
    ball = STEEL_DENSITY * math.pi / 6.0 * n["ball_diameter"] ** 3
    n.setdefault("cage_mass", CAGE_MASS_IN_BALLS * int(n["rows"]) * ball)
    row = RatedBearing(
        count=int(n["balls"]),
        diameter=n["ball_diameter"],
        pitch_diameter=n["pitch_diameter"],
        inner_groove=n["inner_groove"],
        outer_groove=n["outer_groove"],
        contact_angle=n["contact_angle"],
    )
    n.setdefault("static_rating", static_rating(row))
    n.setdefault("dynamic_rating", dynamic_rating(row))
    bearing = _bearing(designation, n, {**BY_RULE, **BY_KIND[kind], **origins})
    return replace(bearing, arrangement=arrangement)


def _count(kind: str, ball: float, pitch: float) -> int:
    """Balls of a row, from the diameters of ball and pitch (m)."""
    touching = 2.0 * math.asin(min(1.0, ball / pitch))
    count = (
        FILL_ANGLE / touching + 1.0 if kind == DEEP_GROOVE else 2.0 * math.pi / (BALL_SPACING * touching)
    )
    return min(max(int(count), 3), MAX_BALLS)


def _normal_play(bore: float) -> float:
    """Radial play (m): half the middle of the normal clearance, that of the largest bore above all."""
    _, low, high = next(
        (row for row in NORMAL_CLEARANCE if bore <= row[0] * (1.0 + 1e-9)), NORMAL_CLEARANCE[-1]
    )
    return 0.25 * (low + high)


def _rings(n: Mapping[str, float]) -> Rings:
    """Steel between bore and shoulder, less the groove: a segment of a circle, turned about the axis."""
    ball, pitch, width = n["ball_diameter"], n["pitch_diameter"], n["width"]
    height = SHOULDER_HEIGHT * ball
    inner, outer = pitch - ball, pitch + ball  # bottoms of the grooves
    shoulders = inner + 2.0 * height, outer - 2.0 * height
    cut_inner = segment(n["inner_groove"] * ball, height) * math.pi * (inner + height)
    cut_outer = segment(n["outer_groove"] * ball, height) * math.pi * (outer - height)
    rows, disc = n["rows"], 0.25 * math.pi * width  # rows stand side by side in the width
    mass_inner = STEEL_DENSITY * (disc * (shoulders[0] ** 2 - n["bore"] ** 2) - rows * cut_inner)
    mass_outer = STEEL_DENSITY * (disc * (n["outside"] ** 2 - shoulders[1] ** 2) - rows * cut_outer)
    inertia = 0.125 * mass_inner * (n["bore"] ** 2 + shoulders[0] ** 2)
    return Rings(mass_inner, inertia, mass_outer)


def _bearing(designation: str, n: Mapping[str, float], origins: Mapping[str, str]) -> Bearing:
    balls = BallSet(
        count=int(n["balls"]),
        rows=int(n["rows"]),
        diameter=n["ball_diameter"],
        pitch_diameter=n["pitch_diameter"],
        play=n["play"],
        conformity=2.0 * n["inner_groove"],
        outer_conformity=2.0 * n["outer_groove"],
    )
    return Bearing(
        designation=designation,
        bore=n["bore"],
        outside=n["outside"],
        width=n["width"],
        balls=balls,
        ring=Ring(mass=n["ring_mass"], inertia=n["ring_inertia"]),
        caged=n["cage_mass"] > 0.0,
        outer_ring=n["outer_ring_mass"],
        cage=n["cage_mass"],
        static_rating=n["static_rating"],
        dynamic_rating=n["dynamic_rating"],
        contact_angle=n["contact_angle"],
        damping=n["damping"],
        row_distance=n["row_distance"],
        preload=n["preload"],
        origins=origins,
    )
