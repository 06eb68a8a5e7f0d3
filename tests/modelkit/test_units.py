"""Values as people write them."""

from __future__ import annotations

import math

import pytest

from touchdown.modelkit.errors import TouchdownError
from touchdown.modelkit.units import is_bare, to_si


@pytest.mark.parametrize(
    ("written", "unit", "value"),
    [
        ("0.25 mm", "m", 0.25e-3),
        ("250 \u00b5m", "m", 250e-6),  # the micro sign
        ("250 \u03bcm", "m", 250e-6),  # the Greek letter
        ("-1e-3 m", "m", -1e-3),
        ("9000 rpm", "rad/s", 300.0 * math.pi),
        ("2.4e9 N/m", "N/m", 2.4e9),
        ("3 N s/m", "N.s/m", 3.0),
        ("2 kg cm2", "kg.m2", 2e-4),
        ("5 N*s/mm", "N.s/m", 5e3),
        ("5 Ns/m", "N.s/m", 5.0),
        ("5 mNm", "N.m", 5e-3),
        ("5 kN/mm", "N/m", 5e6),
        ("9000 1/min", "rad/s", 300.0 * math.pi),
        ("150 Hz", "rad/s", 300.0 * math.pi),  # of a speed, or of a bandwidth
        ("0.8 kHz", "rad/s", 1600.0 * math.pi),
        ("28 Hz", "Hz", 28.0),
        (7, "1", 7.0),
    ],
)
def test_numbers_with_units(written: object, unit: str, value: float) -> None:
    assert to_si(written, unit, "x") == pytest.approx(value, rel=1e-15)


@pytest.mark.parametrize(
    ("written", "says"),
    [
        ("mm", "is not a number"),
        ("", "is not a number"),
        ("3 4 mm", "has the unit 4 mm"),
        ("3 N", "has the unit N; it is measured in m"),
        ("nan", "is not a finite number"),
        ("-inf m", "is not a finite number"),
        ("1e999 m", "is not a finite number"),
        (True, "is not a number"),
    ],
)
def test_what_is_none_is_refused_by_name(written: object, says: str) -> None:
    with pytest.raises(TouchdownError, match=r"^x = .*" + says):
        to_si(written, "m", "x")


@pytest.mark.parametrize(
    ("value", "bare"),
    [(9000, True), ("9e3", True), (None, False), ("9000 rpm", False), ("9e3rad/s", False)],
)
def test_a_number_without_a_unit_is_known(value: object, bare: bool):
    assert is_bare(value) is bare
