"""Whether a whirl grows or decays, on spirals that do what is known."""

from __future__ import annotations

import math

import numpy as np
import pytest

from touchdown.master.results.settling import (
    MIN_SIZES,
    Outlook,
    Trend,
    course,
    joint_trend,
    relative_change,
    trend,
)
from touchdown.master.results.whirl.contacts import Orbit
from touchdown.master.results.whirl.verdict import classify

CLEARANCE = 3e-4  # m
RATE = 10e3  # Hz
SPIN = 900.0  # rad/s


def followed(
    turns: float, force: float = 0.0, radius: float = 0.0, jitter: float = 0.0, end: float = 0.0
) -> Outlook:
    """Of a backward whirl of 80 Hz whose force and radius grow by these rates (1/s).

    jitter: of the force from turn to turn, over itself; end: s of rest after it.
    """
    time = np.arange(round((turns / 80.0 + end) * RATE) + 1) / RATE
    turned = np.minimum(time * 80.0, turns)
    angle = -0.5 * math.pi - 2.0 * math.pi * turned
    r = CLEARANCE * (1.02 + 0.01 * np.exp(radius * time))
    chance = np.random.default_rng(3).normal(size=math.ceil(turns) + 2)[np.floor(turned).astype(int)]
    size = 300.0 * np.exp(force * time) * (1.0 + jitter * chance)
    x, y = r * np.cos(angle), r * np.sin(angle)
    pressed = -size * np.cos(angle), -size * np.sin(angle)
    whirl = classify(time, x, y, CLEARANCE, SPIN, pressed)
    return course(Orbit(time, x, y, CLEARANCE), pressed, whirl, 0.0)


@pytest.mark.parametrize(
    ("rate", "known"),
    [(1.5, Trend.GROWING), (0.0, Trend.STEADY), (0.1, Trend.STEADY), (-1.5, Trend.DECAYING)],
)
def test_a_spiral_is_told_by_its_force(rate: float, known: Trend) -> None:
    """1.5 a second is 28 % over the last 15 turns, 0.1 is 2 %, of a tolerance of 5 %."""
    found = followed(30.0, force=rate)
    assert found.trend is known
    assert found.words == f"backward whirl, at 0.375 s still whirling, {known.value}"


def test_a_spiral_is_told_by_its_radius() -> None:
    """Outwards by a third of the clearance in the last 15 turns, the force steady."""
    assert followed(30.0, radius=10.0).trend is Trend.GROWING


def test_what_scatters_is_not_told() -> None:
    found = followed(12.0, jitter=0.5)
    assert found.trend is Trend.UNTOLD
    assert found.words.endswith("at 0.15 s still whirling, whether it grows or decays cannot be told")


def test_few_turns_are_not_told() -> None:
    assert followed(MIN_SIZES - 0.5, force=-3.0).trend is Trend.UNTOLD
    assert followed(2.0 * MIN_SIZES, force=-3.0).trend is Trend.DECAYING


def test_a_whirl_that_is_over_names_its_time() -> None:
    found = followed(20.0, end=0.1)
    assert found.trend is None
    assert found.words == "transient backward whirl, 0 to 0.25 s"


def test_a_decaying_whirl_proposes_to_see_its_end() -> None:
    """w^2 r decays with the force; at 2.42 g the journal cannot keep to the circle any more."""
    found = followed(30.0, force=-1.5)
    outwards = 1.03 * CLEARANCE * (2.0 * math.pi * 80.0) ** 2
    assert found.left == pytest.approx(math.log(outwards / (2.42 * 9.81)) / 1.5, rel=0.02)
    assert found.left is not None
    assert found.duration == pytest.approx(
        1.2 * (0.375 + found.left) + 0.05, abs=0.05
    )  # rounded up to two digits
    assert followed(30.0, force=1.5).duration == 0.75  # nothing says how long: twice


def test_the_line_through_known_values() -> None:
    risen, reach = relative_change(np.array([9.0, 10.0, 11.0]))
    assert risen == pytest.approx(0.2)
    assert reach == pytest.approx(0.0, abs=1e-12)
    assert trend(np.zeros(6)) is Trend.STEADY
    assert trend(np.array([1.0, 2.0, 3.0])) is Trend.UNTOLD


@pytest.mark.parametrize(
    ("parts", "whole"),
    [
        ([Trend.STEADY, Trend.DECAYING], Trend.DECAYING),
        ([Trend.GROWING, Trend.DECAYING], Trend.UNTOLD),
        ([Trend.STEADY, Trend.UNTOLD], Trend.UNTOLD),
        ([Trend.STEADY, Trend.STEADY], Trend.STEADY),
        ([], Trend.UNTOLD),
    ],
)
def test_amplitude_and_force_are_told_together(parts: list[Trend], whole: Trend) -> None:
    assert joint_trend(parts) is whole
