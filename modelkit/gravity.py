"""Gravity on a machine whose shaft may be inclined.

The frame turns with the machine: z stays along the shaft, x stays horizontal. With the inclination i of +z
over the horizontal gravity is the vector g (0, -cos i, -sin i).
"""

from __future__ import annotations

import math

from .kernel import kernel

INCLINATION = "of the shaft's +z end over the horizontal; 90 deg stands upright"
# Rounding of cos(90 deg), which is 6e-17: a shaft that stands upright has no gravity across it at all
UPRIGHT = 1e-15


@kernel
def gravity_across(gravity, inclination):
    """The part (m/s2) of `gravity` (m/s2) towards -y of a shaft at an `inclination` (rad)."""
    cosine = math.cos(inclination)
    return gravity * cosine if abs(cosine) > UPRIGHT else 0.0


@kernel
def gravity_along(gravity, inclination):
    """The part (m/s2) of `gravity` (m/s2) towards +z of a shaft at an `inclination` (rad); 0 if it lies."""
    return -gravity * math.sin(inclination) if inclination != 0.0 else 0.0
