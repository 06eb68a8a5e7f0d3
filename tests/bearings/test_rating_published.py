"""Ratings against what others publish: a commercial program, the tables of the standards."""

from __future__ import annotations

import math

import pytest

from touchdown.bearings.contact.materials import Elastic
from touchdown.bearings.rating import (
    INNER,
    OUTER,
    RatedBearing,
    dynamic_rating,
    point_contact,
    static_rating,
)

STEEL = Elastic(210e9, 0.3)
PROGRAM = RatedBearing(7, 11.5e-3, 43.5e-3, inner_groove=0.52, outer_groove=0.53, balls=STEEL, rings=STEEL)
RATING = 23400.0  # N, its C
F_0 = {  # ISO 76 (2006), Table 1, radial ball bearings, by D_w cos(alpha) / D_pw
    **dict(zip((0.01, 0.02, 0.03, 0.04, 0.05), (14.9, 15.1, 15.3, 15.5, 15.7), strict=True)),
    **dict(zip((0.06, 0.07, 0.08, 0.09, 0.10), (15.9, 16.1, 16.3, 16.5, 16.4), strict=True)),
    **dict(zip((0.12, 0.15, 0.16, 0.18, 0.20), (15.9, 15.2, 14.9, 14.4, 14.0), strict=True)),
}
F_C = {0.05: 46.7, 0.16: 59.6, 0.30: 56.0}  # ISO 281 (2007), Table 2


@pytest.mark.parametrize("gamma", F_0)
def test_static_ratings_are_those_of_iso_76(gamma: float) -> None:
    """C_0 = f_0 Z D_w^2, f_0 printed to 0.1: 4200 MPa through the whole of Hertz's theory."""
    bearing = RatedBearing(10, 10e-3, 10e-3 / gamma)
    assert static_rating(bearing) / (10 * 10.0**2) == pytest.approx(F_0[gamma], abs=0.055)


@pytest.mark.parametrize("gamma", F_C)
def test_dynamic_ratings_are_those_of_iso_281(gamma: float) -> None:
    bearing = RatedBearing(8, 10e-3, 10e-3 / gamma)
    assert dynamic_rating(bearing) == pytest.approx(1.3 * F_C[gamma] * 4.0 * 10.0**1.8)


def test_spheres_press_as_hertz_says() -> None:
    """A groove as wide as the outer race: a ball in a hollow sphere of twice its radius."""
    ball, modulus, load = 10e-3, 200e9, 50.0
    steel = Elastic(modulus, 0.3)
    bearing = RatedBearing(3, ball, ball * (1.0 + 1e-12), 1.0, 1.0, balls=steel, rings=steel)
    contact = point_contact(bearing, OUTER)
    reduced, radius = modulus / (2.0 * (1.0 - 0.3**2)), ball
    axis = (3.0 * load * radius / (4.0 * reduced)) ** (1.0 / 3.0)
    assert contact.semi_axes(load) == pytest.approx((axis, axis))
    assert float(contact.pressure(load)) == pytest.approx(1.5 * load / (math.pi * axis**2))
    assert float(contact.approach(load)) == pytest.approx(axis**2 / radius)


@pytest.mark.parametrize("race", [INNER, OUTER])
def test_load_and_pressure_are_inverse(race: str) -> None:
    contact = point_contact(PROGRAM, race)
    assert contact.load(contact.pressure(620.0)) == pytest.approx(620.0)
    across, along = contact.semi_axes(620.0)
    assert contact.pressure(620.0) == pytest.approx(1.5 * 620.0 / (math.pi * across * along))
