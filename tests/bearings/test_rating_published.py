"""Ratings against what others publish: a commercial program, the tables of the standards."""

from __future__ import annotations

import math

import pytest

from touchdown.bearings.contact.materials import Elastic
from touchdown.bearings.rating import OUTER, RatedBearing, dynamic_rating, point_contact

F_C = {0.05: 46.7, 0.16: 59.6, 0.30: 56.0}  # ISO 281 (2007), Table 2


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
