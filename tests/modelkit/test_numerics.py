"""The damped oscillator's exact step, against a tight solver and against itself."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from touchdown.modelkit.numerics import load_for, oscillator_step

KINDS = [
    (0.0, 0.0),
    (5e7, 0.0),
    (5e7, 500.0),
    (1e10, 1e4),
    (2.5e7, 1e4),  # critically damped
    (1e8, 5e4),  # overdamped
]
H = 1e-4


def solved(k: float, c: float, start: tuple[float, float], mean: float, slope: float) -> np.ndarray:
    solution = solve_ivp(
        lambda t, s: [s[1], mean + slope * (t - H / 2) - k * s[0] - c * s[1]],
        (0.0, H), start, method="DOP853", rtol=1e-13, atol=1e-22,
    )  # fmt: skip
    return solution.y[:, -1]


@pytest.mark.parametrize(("k", "c"), KINDS)
def test_it_solves_the_equation_of_motion(k: float, c: float) -> None:
    s = oscillator_step(k, c, H)
    z, v, mean, slope = 3e-6, 0.02, 37.0, -2.5e5
    found = (
        s.zz * z + s.zv * v + s.zf * mean + s.zg * slope,
        s.vz * z + s.vv * v + s.vf * mean + s.vg * slope,
    )
    for one in ((z, 0.0, 0.0), (0.0, v, 0.0), (0.0, 0.0, mean)):  # each by itself, as well as all of them
        alone = solved(k, c, one[:2], one[2], 0.0)
        assert s.zz * one[0] + s.zv * one[1] + s.zf * one[2] == pytest.approx(alone[0], rel=1e-9, abs=1e-19)
        assert s.vz * one[0] + s.vv * one[1] + s.vf * one[2] == pytest.approx(alone[1], rel=1e-9, abs=1e-14)
    assert found == pytest.approx(solved(k, c, (z, v), mean, slope), rel=1e-9)


@pytest.mark.parametrize(("k", "c"), [(0.0, 0.0), (5e7, 500.0), (5e7, 0.0), (8e8, 2e4)])
def test_the_load_brings_a_resting_oscillator_where_it_was(k: float, c: float) -> None:
    z, v = solved(k, c, (0.0, 0.0), 37.0, -2.5e5)
    assert load_for(oscillator_step(k, c, H), z, v) == pytest.approx((37.0, -2.5e5), rel=1e-6)


def test_without_springs_the_load_is_impulse_and_first_moment() -> None:
    impulse, moment = 3e-3, 1e-9  # int F dt, int (t - t_mid) F dt
    mean, slope = load_for(oscillator_step(0.0, 0.0, 2e-5), impulse * 1e-5 - moment, impulse)
    assert mean == pytest.approx(impulse / 2e-5, rel=1e-12)
    assert slope == pytest.approx(12.0 * moment / 2e-5**3, rel=1e-9)
