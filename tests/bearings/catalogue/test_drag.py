"""Drag of balls from the friction coefficient that makers state."""

from __future__ import annotations

import pytest

from touchdown.bearings import rating
from touchdown.bearings.catalogue import bearing
from touchdown.bearings.catalogue.drag import ANGULAR_CONTACT, DEEP_GROOVE, rolling_resistance


@pytest.mark.parametrize(("name", "coefficient"), [("6904", DEEP_GROOVE), ("7014", ANGULAR_CONTACT)])
def test_the_moment_is_the_makers(name: str, coefficient: float) -> None:
    """By the power of each ball's drag: on both races, at the speed with which it orbits."""
    entry, load, speed = bearing(name), 700.0, 100.0  # N, rad/s
    rated = entry.rated()
    pitch, ball = 0.5 * rated.pitch_diameter, 0.5 * rated.diameter
    orbit = 0.5 * speed * (1.0 - ball / pitch)
    forces = rating.load_distribution(rated, load).loads
    power = rolling_resistance(entry) * 2.0 * forces.sum() * rated.rows * pitch * orbit
    assert power == pytest.approx(0.5 * coefficient * load * entry.bore * speed)


def test_it_is_of_the_size_that_is_stated() -> None:
    """Of a 6904, 0.0010; the fit to a run-down of rotor I is ten times that."""
    assert rolling_resistance(bearing("6904")) == pytest.approx(0.00104, rel=0.02)
