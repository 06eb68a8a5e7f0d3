"""Ratings: balance, limits, and what must not depend on how it is asked."""

from __future__ import annotations

import math
from dataclasses import asdict, replace

import numpy as np
import pytest

from touchdown.bearings import rating
from touchdown.bearings.contact.materials import (
    SILICON_NITRIDE,
    SILICON_NITRIDE_NUMBERS,
    STEEL_NUMBERS,
    effective_modulus,
)
from touchdown.bearings.rating import (
    INNER,
    OUTER,
    RatedBearing,
    bearing_capacity,
    pressure_safety,
    static_rating,
)
from touchdown.bearings.rolling.ball_set import BallSet

BEARING = RatedBearing(9, 12.7e-3, 65e-3, 0.52, 0.52)


@pytest.mark.parametrize(
    ("clearance", "angle", "rows"), [(-20e-6, 0.0, 2), (0.0, math.radians(25.0), 1), (1e-3, 0.0, 1)]
)
def test_balls_carry_the_load(clearance: float, angle: float, rows: int) -> None:
    bearing = replace(BEARING, rows=rows, contact_angle=angle)
    shared = rating.load_distribution(bearing, 8900.0, clearance)
    carried = rows * math.cos(angle) * float(shared.loads @ np.cos(shared.angles))
    assert carried == pytest.approx(8900.0, rel=1e-9)
    assert shared.loads[0] == shared.loads.max()
    if clearance < 0.0:
        assert shared.loads.min() > 0.0 or shared.deflection > -clearance
    if clearance == 1e-3:
        assert np.count_nonzero(shared.loads) == 1  # no other ball is reached
        assert shared.deflection > clearance


def test_a_contact_angle_of_a_radial_bearing_only() -> None:
    with pytest.raises(ValueError, match="contact angle of 1\\.6 rad"):
        replace(BEARING, contact_angle=1.6)
    with pytest.raises(ValueError, match="not a ball bearing"):
        replace(BEARING, diameter=70e-3)
    with pytest.raises(ValueError, match="load of 0 N"):
        rating.load_distribution(BEARING, 0.0)


def test_from_the_parameters_of_a_model() -> None:
    values = {f"balls.{name}": float(value) for name, value in asdict(BallSet()).items()}
    bearing = RatedBearing.of(values)
    assert (bearing.count, bearing.inner_groove, bearing.outer_groove) == (9, 0.52, 0.52)
    wider = RatedBearing.of(values | {"balls.outer_conformity": 1.06})
    assert (wider.inner_groove, wider.outer_groove) == (0.52, 0.53)
    law = rating.point_contact(bearing, OUTER)
    assert law.approach(100.0) == pytest.approx((100.0 / law.stiffness) ** (2.0 / 3.0))


def test_safety_by_load_and_by_pressure() -> None:
    """The most loaded ball bears five times the mean where clearance is usual, and 4200 MPa at C_0."""
    static = rating.static_rating(BEARING)
    ball = 5.0 * static / BEARING.count
    worst = max(float(rating.point_contact(BEARING, race).pressure(ball)) for race in (INNER, OUTER))
    assert worst == pytest.approx(rating.PRESSURE_LIMIT)
    assert rating.pressure_safety(worst / 2.0) == pytest.approx(8.0)
    assert rating.static_safety(static, [0.0, static / 8.0]).tolist() == [math.inf, pytest.approx(8.0)]


def test_lives_by_race_by_ring_and_by_rows() -> None:
    loads = rating.load_distribution(BEARING, 1000.0).loads
    life = rating.reference_rating_life(BEARING, 33200.0, loads)
    assert rating.reference_rating_life(BEARING, 33200.0, np.column_stack([loads, loads])) == pytest.approx(
        life
    )
    assert rating.reference_rating_life(BEARING, 33200.0, loads, turning=OUTER) < life
    pair = replace(BEARING, rows=2)  # also as two bearings, 10/9 the Weibull slope
    twice = rating.reference_rating_life(pair, 2.0**0.7 * 33200.0, loads)
    assert twice == pytest.approx(life * 2.0**-0.9)


def test_damage_of_a_drop() -> None:
    """A ring that turns once per stretch, at the loads of a bearing without clearance."""
    loads = rating.load_distribution(BEARING, 1000.0).loads
    life = rating.reference_rating_life(BEARING, 33200.0, loads)
    most = float(loads.max())
    damage = rating.drop_damage(BEARING, 33200.0, [most, 2.0 * most, 0.0], [1.0, 1.0, 5.0])
    assert damage == pytest.approx(9.0 / life)
    assert rating.drops(damage) == pytest.approx(life / 9.0)
    assert rating.drops(rating.drop_damage(BEARING, 33200.0, [0.0], [1.0])) == math.inf
    with pytest.raises(ValueError, match="1 loads and 2 numbers"):
        rating.drop_damage(BEARING, 33200.0, [1.0], [1.0, 2.0])


def test_ceramic_balls_take_a_smaller_static_load() -> None:
    """ISO 20056-2: 4600 instead of 4200 MPa, at a contact stiffer by E_tot: (4600/4200)^3 over E_tot^2."""
    hybrid = replace(BEARING, balls=SILICON_NITRIDE_NUMBERS, hybrid=True)
    softer = effective_modulus(STEEL_NUMBERS, STEEL_NUMBERS) / effective_modulus(
        SILICON_NITRIDE_NUMBERS, STEEL_NUMBERS
    )
    ratio = (4600.0 / 4200.0) ** 3 * softer**2
    assert ratio == pytest.approx(0.932, abs=1e-3)
    assert static_rating(hybrid) == pytest.approx(ratio * static_rating(BEARING), rel=1e-12)
    stated = bearing_capacity(hybrid, static=5000.0, dynamic=9000.0)  # a maker's, of steel balls
    assert stated == pytest.approx((5000.0 * ratio, 9000.0), rel=1e-12)
    assert pressure_safety(4600e6, hybrid.pressure_limit) == 1.0


def test_a_model_s_material_is_rated() -> None:
    values = {"balls.count": 9, "balls.diameter": 12.7e-3, "balls.pitch_diameter": 65e-3}
    values |= {"balls.conformity": 1.04, "balls.material": SILICON_NITRIDE, "ring.material": 0}
    found = RatedBearing.of(values)
    assert found.hybrid
    assert found.balls == SILICON_NITRIDE_NUMBERS
    assert not RatedBearing.of(values | {"ring.material": SILICON_NITRIDE}).hybrid
    # steel balls in ceramic rings dent as steel does
    turned = RatedBearing.of(values | {"balls.material": 0, "ring.material": SILICON_NITRIDE})
    assert turned.pressure_limit == 4.2e9
    assert RatedBearing.of(values | {"balls.modulus": 300e9}).balls.modulus == 300e9
