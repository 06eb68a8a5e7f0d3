"""When a journal has settled, on swings that do what is known."""

from __future__ import annotations

import math

import numpy as np
import pytest

from touchdown.master.results.settling import (
    BEAT_PERIODS,
    EARLY,
    REST_AMPLITUDE,
    Settling,
    Trend,
    pendulum_period,
    settling,
)
from touchdown.master.results.whirl.contacts import Orbit

CLEARANCE = 3e-4  # m
PERIOD = pendulum_period(CLEARANCE)  # 35 ms
RATE = 10e3  # Hz


def swinging(end: float, degrees: np.ndarray | float, first: float = 0.008) -> Settling:
    """Of a journal that lies on its bore and swings to either side by `degrees`, until `end` (s)."""
    time = times(end)
    angle = -0.5 * math.pi + np.radians(degrees) * np.sin(2.0 * math.pi * time / PERIOD)
    orbit = Orbit(time, CLEARANCE * np.cos(angle), CLEARANCE * np.sin(angle), CLEARANCE)
    return settling(orbit, np.full(len(time), 16.0), first, None)


def times(end: float) -> np.ndarray:
    return np.arange(round(end * RATE) + 1) / RATE


def test_the_period_is_that_of_small_swings() -> None:
    assert pytest.approx(2.0 * math.pi * math.sqrt(3e-4 / 9.81)) == PERIOD


def test_a_pendulum_that_comes_to_rest() -> None:
    """Down to the band, 0.1 of the clearance above what is left, by 50 sin(0.0058 s): at 0.44 s."""
    found = swinging(1.5, 50.0 * np.exp(-5.0 * times(1.5)))
    assert found.rests
    assert found.time is not None
    known = math.log(math.radians(50.0) / math.asin(0.1)) / 5.0
    assert found.time == pytest.approx(known, abs=1.5 * PERIOD)
    assert found.words == f"settled at {found.time:.3g} s: at rest"


@pytest.mark.parametrize("degrees", [1.0, 40.0])
def test_one_that_bounces_has_not_settled(degrees: float) -> None:
    """Until 0.3 s it has contact for a tenth of the time, with ten times its weight: the weight as mean."""
    time = times(1.5)
    angle = -0.5 * math.pi + np.radians(degrees) * np.sin(2.0 * math.pi * time / PERIOD)
    orbit = Orbit(time, CLEARANCE * np.cos(angle), CLEARANCE * np.sin(angle), CLEARANCE)
    touches = np.arange(len(time)) % 10 == 0
    force = np.where(time < 0.3, 160.0 * touches, 16.0)
    found = settling(orbit, force, 0.008, None)
    assert found.time == pytest.approx(0.3, abs=(BEAT_PERIODS + 1) * PERIOD)
    assert found.rests == (degrees < 5.0)


def test_one_that_still_decays_has_not_settled() -> None:
    found = swinging(0.8, 60.0 * np.exp(-1.0 * times(0.8)))
    assert (found.time, found.trend) == (None, Trend.DECAYING)
    assert found.words == "not settled: swings, decaying"


def test_one_that_ends_within_a_swing_tells_nothing() -> None:
    early, later = (swinging(0.008 + part * PERIOD, 40.0).words for part in (0.97, 1.03))
    assert early == EARLY
    assert later.startswith("not settled: swings; whether")


def test_one_that_keeps_up_is_a_plateau() -> None:
    """It swings in wildly until 0.2 s, and keeps to 40 degrees from then on."""
    late = times(1.2) >= 0.2
    found = swinging(1.2, np.where(late, 40.0, 80.0))
    assert found.time == pytest.approx(0.2, abs=(BEAT_PERIODS + 1) * PERIOD)
    assert not found.rests
    assert found.words.endswith("swings on steadily")


def test_one_that_grows_has_not_settled() -> None:
    found = swinging(1.2, 20.0 + 30.0 * times(1.2))
    assert (found.time, found.trend) == (None, Trend.GROWING)


def test_beats_are_no_growth() -> None:
    """Two modes 29 % apart, as at the two seats of rotor I."""
    time = times(1.5)
    found = swinging(1.5, 40.0 + 15.0 * np.sin(2.0 * math.pi * 0.29 * time / PERIOD))
    assert found.time is not None
    assert found.trend is Trend.STEADY


def test_too_short_a_run_is_not_told() -> None:
    """Of a swing that keeps up, by then 11 periods; a plateau takes 16."""
    found = swinging(0.4, 40.0)
    assert (found.time, found.trend) == (None, Trend.UNTOLD)


def test_rest_is_told_sooner() -> None:
    assert swinging(0.2, 0.0).time == pytest.approx(0.008)
    assert math.sin(math.radians(5.0)) == pytest.approx(REST_AMPLITUDE, abs=1e-3)


@pytest.mark.parametrize(
    ("trend", "settles"), [(Trend.STEADY, True), (Trend.DECAYING, False), (Trend.UNTOLD, False)]
)
def test_a_whirl_settles_where_it_is_steady(trend: Trend, settles: bool) -> None:
    time = times(0.4)
    angle = 2.0 * math.pi * 80.0 * time
    orbit = Orbit(time, CLEARANCE * np.cos(angle), CLEARANCE * np.sin(angle), CLEARANCE)
    found = settling(orbit, np.full(len(time), 800.0), 0.008, trend)
    assert (found.time is not None) is settles
    assert found.whirls
