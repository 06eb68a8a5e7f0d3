"""Multisines that an actuator adds to its readings, its control currents, and the force on the journal."""

from __future__ import annotations

import math

import numpy as np
import pytest

from touchdown.bearings.magnetic import amb_actuator
from touchdown.modelkit.excitation import Lines, next_line, sum_of_lines
from touchdown.modelkit.instance import Instance
from touchdown.modelkit.kernel import interpret

STEP, BASE = 1e-4, 2 * math.pi * 50.0
FEW = {"lines__frequency": BASE, "lines__first": 2, "lines__count": 4, "lines__ratio": 1.7}
NUMBERS = np.array([2, 4, 7, 12])  # each the first multiple at least 1.7 times the one before


def wave(time: float) -> float:
    """Of lines `NUMBERS`, by the definition of Schroeder's phases."""
    n = np.arange(4)
    return float(np.cos(NUMBERS * BASE * time - math.pi * n * (n + 1) / 4).sum())


def excited(**inject: float) -> Instance:
    """An actuator that holds a journal still, with an injection."""
    one = Instance(amb_actuator.MODEL)
    for name, value in {**FEW, **inject}.items():
        place = one.record["p"]["inject"]
        *path, last = name.split("__")
        for part in path:
            place = place[part]
        place[last] = value
    one.start(0.0)
    return one


def test_lines_are_spread_as_their_ratio_says():
    lines = Lines(frequency=BASE, first=2, count=4, ratio=1.7)
    found = [2]
    while len(found) < 4:
        found.append(interpret(next_line, found[-1], lines))
    assert found == NUMBERS.tolist()
    assert interpret(sum_of_lines, 3.3e-3, lines) == pytest.approx(wave(3.3e-3), abs=1e-12)


def test_readings_and_control_currents_have_the_lines_by_tick():
    """The second axis has none; a current acts as the command that it is added to, from the tick on."""
    one = excited(sensed=2e-6, set=0.3, axis=1)
    out, acting = one.record["o"], one.record["s"]["axis"]
    for k in range(12):
        one.step(k * STEP / 2, STEP / 2)
        tick = k // 2
        assert out["injected"] == pytest.approx(wave(tick * STEP), abs=1e-12)
        assert out["axis"][0]["sensed"] == pytest.approx(2e-6 * wave(tick * STEP), abs=1e-18)
        if tick:
            assert acting[0]["set"] == pytest.approx(0.3 * wave(tick * STEP), abs=1e-12)
        assert (out["axis"][1]["sensed"], acting[1]["set"]) == (0.0, 0.0)


def test_a_force_has_the_lines_at_every_time_and_does_not_react_on_the_stator():
    """Mean over a macro step: the integral of its cosines. It begins at 0.12 ms."""
    one, n = excited(force=3.0, axis=2, begin=1.2e-4), np.arange(4)
    out = one.record["o"]

    def integral(time: float) -> float:
        phases = NUMBERS * BASE * max(time - 1.2e-4, 0.0) - math.pi * n * (n + 1) / 4
        return float((np.sin(phases) / (NUMBERS * BASE)).sum())

    for k in range(6):
        one.step(k * STEP, STEP)
        mean = 3.0 * (integral((k + 1) * STEP) - integral(k * STEP)) / STEP
        along = math.cos(math.pi / 4)
        assert out["journal"]["fx"] == pytest.approx(-along * mean, abs=1e-6)
        assert out["journal"]["fy"] == pytest.approx(along * mean, abs=1e-6)
        assert (out["housing"]["fx"], out["housing"]["fy"]) == pytest.approx((0.0, 0.0), abs=1e-9)
