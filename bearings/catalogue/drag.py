"""Rolling resistance of a bearing's balls, by the friction coefficient that its maker states.

SKF's simplest model (Rolling Bearings, chapter on friction, estimating the frictional moment): M = mu P d/2
with the bore d and mu of `COEFFICIENTS`, for open bearings that run lubricated at about a tenth of their
dynamic rating and at usual speeds. In the models here a ball that orbits is held back by
`rolling.resistance` times its forces on both races. A force Q between the races thus makes a moment
resistance Q (d_m - D_w)/2 on the inner ring, and both agree where

    resistance = mu d/(s (d_m - D_w))      s: sum of the balls' forces over the radial load

A dry bearing, or one that skids, has more.
"""

from __future__ import annotations

from .. import rating
from .entry import Bearing

DEEP_GROOVE, ANGULAR_CONTACT = 0.0015, 0.0020
COEFFICIENTS = {"deep groove": DEEP_GROOVE, "angular contact": ANGULAR_CONTACT}  # mu, SKF


def kind(bearing: Bearing) -> str:
    """Of a bearing, by its contact angle: a name in `COEFFICIENTS`."""
    return "angular contact" if bearing.contact_angle > 0.0 else "deep groove"


def rolling_resistance(bearing: Bearing) -> float:
    """`rolling.resistance` (force over force) that makes SKF's frictional moment under a radial load."""
    rated = bearing.rated()
    pressed = float(rating.load_distribution(rated, 1.0).loads.sum()) * rated.rows
    lever = rated.pitch_diameter - rated.diameter
    return COEFFICIENTS[kind(bearing)] * bearing.bore / (pressed * lever)
