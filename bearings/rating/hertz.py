"""A ball pressed on its race (Hertz): pressure, size of the contact, approach."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from touchdown.bearings.contact.stiffness import (
    EXACT,
    effective_modulus,
    exact_ellipse,
    race_contact_stiffness,
)
from touchdown.bearings.rating.bearing import RatedBearing


@dataclass(frozen=True)
class PointContact:
    """A contact by what a load of 1 N makes; loads are of one ball (N, of any shape)."""

    across: float  # semi-axis across the groove (m)
    along: float  # semi-axis the ball rolls along (m)
    stiffness: float  # N/m^1.5

    def semi_axes(self, load: ArrayLike) -> tuple[np.ndarray, np.ndarray]:
        """Of the ellipse across the groove and along it (m)."""
        root = np.cbrt(_pressing(load))
        return self.across * root, self.along * root

    def pressure(self, load: ArrayLike) -> np.ndarray:
        """Largest, in the middle of the ellipse (Pa)."""
        return 1.5 / (math.pi * self.across * self.along) * np.cbrt(_pressing(load))

    def load(self, pressure: ArrayLike) -> np.ndarray:
        """The load (N) with this largest pressure (Pa)."""
        return (np.asarray(pressure, float) * (math.pi * self.across * self.along) / 1.5) ** 3

    def approach(self, load: ArrayLike) -> np.ndarray:
        """Of ball and race (m)."""
        return (_pressing(load) / self.stiffness) ** (2.0 / 3.0)


def _pressing(load: ArrayLike) -> np.ndarray:
    """Loads without pull, which a contact does not bear."""
    return np.maximum(np.asarray(load, float), 0.0)


def point_contact(bearing: RatedBearing, race: str) -> PointContact:
    """The contact of a ball with the `INNER` or `OUTER` race, exact elliptic integrals.

    With kappa the ratio of the axes, E the elliptic integral of the second kind and s the sum of the four
    curvatures, the longer semi-axis is (6 kappa^2 E Q (1 - nu^2) / (pi s E_modulus))^(1/3).
    """
    b, groove, radius = bearing, bearing.groove(race), bearing.race_radius(race)
    along = 2.0 / b.diameter + 1.0 / radius
    across = 2.0 / b.diameter - 1.0 / (groove * b.diameter)
    ellipse = exact_ellipse(along / across)
    compliance = 6.0 * ellipse.second_kind / (math.pi * (along + across))
    longer = (ellipse.ellipticity**2 * compliance / effective_modulus(b.modulus, b.poisson)) ** (1.0 / 3.0)
    stiffness = race_contact_stiffness(b.diameter, radius, 2.0 * groove, b.modulus, b.poisson, EXACT)
    return PointContact(longer, longer / ellipse.ellipticity, stiffness)
