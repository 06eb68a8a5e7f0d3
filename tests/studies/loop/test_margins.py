"""Sensitivity, crossing and delay margin of loops that are known in closed form."""

from __future__ import annotations

import cmath
import math

import numpy as np
import pytest

from touchdown.studies.loop.margins import Margins, margins, zone

MASS, STIFFNESS, DAMPING = 5.0, 2e5, 400.0
OMEGA = 2 * math.pi * np.geomspace(1.0, 1e4, 1500)


def found(amplifier: float = 0.0, delay: float = 0.0) -> Margins:
    """Of a mass on a proportional-derivative control, with an amplifier (Hz; 0: none) and a delay (s)."""

    def sensitivity(w: float) -> complex:
        s = 1j * w
        lag = 1.0 + s / (2 * math.pi * amplifier) if amplifier else 1.0
        return 1 / (1 + (STIFFNESS + DAMPING * s) / (MASS * s * s) / lag * cmath.exp(-s * delay))

    return margins(sensitivity, OMEGA, np.array([sensitivity(w) for w in OMEGA]))


@pytest.mark.parametrize(
    ("amplifier", "delay", "peak"),
    [
        (0.0, 0.0, 2.55155),
        (500.0, 0.0, 3.06280),
        (0.0, 100e-6, 2.69190),
        (0.0, 300e-6, 3.02572),
        (0.0, 600e-6, 3.72080),
        (1000.0, 150e-6, 3.04370),
    ],
)
def test_peaks(amplifier: float, delay: float, peak: float):
    assert found(amplifier, delay).peak == pytest.approx(peak, abs=6e-6)


def test_crossing_and_delay_margin():
    """|L| = 1: w^4 = ((k/m)^2 + (c w/m)^2); the phase there, over w."""
    k, c = STIFFNESS / MASS, DAMPING / MASS
    crossing = math.sqrt((c * c + math.sqrt(c**4 + 4 * k * k)) / 2)
    ideal = found()
    assert ideal.at / (2 * math.pi) == pytest.approx(33.19, abs=0.005)
    assert ideal.crossings == pytest.approx((crossing,), rel=1e-9)
    assert crossing == pytest.approx(208.15330, abs=1e-5)
    assert ideal.delay == pytest.approx(math.atan(c * crossing / k) / crossing, rel=1e-8)
    assert ideal.delay == pytest.approx(1.8951623e-3, abs=1e-9)


def test_a_loop_at_its_delay_margin_has_no_sensitivity_left():
    assert found(delay=0.999 * found().delay).peak > 500.0


def test_zones():
    assert [zone(peak) for peak in (2.99, 3.0, 3.99, 4.0, 4.99, 5.0)] == ["A", "B", "B", "C", "C", "D"]
