"""Growth by spin against the equation of the spinning disc, solved in small steps, and its limits."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from touchdown.bearings.catalogue import bearing
from touchdown.bearings.catalogue.spinning import spun

RPM = math.pi / 30.0


def test_bearings_by_name() -> None:
    """The 6904 at 18 000 rpm: 0.1792 um at the bore; with the square of the speed."""
    slow, fast = (spun(bearing("6904"), rpm * RPM) for rpm in (18000.0, 125000.0))
    assert 1e6 * slow.bore == pytest.approx(0.1792, abs=5e-5)
    assert slow.surface == pytest.approx(11.85e-3 * 18000.0 * RPM)
    assert fast.bore == pytest.approx(slow.bore * (125.0 / 18.0) ** 2)


def test_growth_is_judged_by_what_it_takes() -> None:
    """Play, or where there is none the indentation by preload, or by the weight that lies on the balls.

    The pair's race grows by 5.53 um, and its preload presses balls in by 1.6 um.
    """
    speed = 32000.0 * RPM
    pair = spun(bearing("71909 DB"), speed)
    assert 1e6 * pair.race == pytest.approx(5.53, abs=0.01)
    assert pair.judged_by[0] == pair.preload > 0.0
    assert pair.matters
    twice = replace(bearing("71909 DB"), preload=2.0 * bearing("71909 DB").preload)
    assert spun(twice, speed).preload == pytest.approx(pair.preload * 2.0 ** (2.0 / 3.0))
    assert spun(bearing("71909 DB"), 0.15 * speed).matters  # 8 % of it, 12 % of the preload
    assert not spun(bearing("71909 DB"), 0.12 * speed).matters  # 5 % of it, 8 % of the preload
    single, heavier = (spun(bearing("71909 AC"), speed, weight) for weight in (100.0, 800.0))
    assert heavier.weight == pytest.approx(4.0 * single.weight)
    assert single.judged_by[0] == single.weight
    with_play = spun(bearing("6014"), 2000.0 * RPM, 100.0)
    assert with_play.judged_by[0] == with_play.play > 0.0
    assert not with_play.matters
