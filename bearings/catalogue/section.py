"""The section of an inner ring: from the bore to shoulders beside grooves of a circle's arc."""

from __future__ import annotations

import math

SHOULDER_HEIGHT = 0.2  # above the groove's bottom, over ball diameter


def segment(radius: float, height: float) -> float:
    """Area (m2) of a circle's segment of this height."""
    rest = radius - height
    return radius**2 * math.acos(rest / radius) - rest * math.sqrt(radius**2 - rest**2)


def centroid_depth(bore: float, width: float, rows: int, ball: float, pitch: float, groove: float) -> float:
    """Distance (m) from the bore to the centroid of the section.

    bore, ball, pitch: diameters (m); width: m; groove: radius of the grooves over the ball's diameter.
    """
    radius, height = groove * ball, SHOULDER_HEIGHT * ball
    shoulder = 0.5 * (pitch - ball) + height - 0.5 * bore  # from the bore
    cut = rows * segment(radius, height)
    half_chord = math.sqrt(radius**2 - (radius - height) ** 2)
    cut_at = shoulder - height + radius - 2.0 * half_chord**3 / (3.0 * segment(radius, height))
    area = width * shoulder
    return (0.5 * shoulder * area - cut_at * cut) / (area - cut)
