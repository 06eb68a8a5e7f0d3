"""Gauss's collocation of linear equations: its order, and that it is exact in energy and never unstable."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.linalg import expm

from touchdown.modelkit.integrators import gauss


def prepared(a: np.ndarray, b: np.ndarray, h: float) -> tuple[np.ndarray, np.ndarray]:
    """Matrices of the points and of the end for steps of `h` (s)."""
    n, c = b.shape
    points, end = np.zeros((3 * n, n + 2 * c)), np.zeros((n, n + 2 * c))
    gauss.prepare_steps(a, b, h, points, end)
    return points, end


def test_a_step_is_of_order_six() -> None:
    """Against the exponential: what one step leaves falls to a 128th at half of it."""
    generator = np.random.default_rng(3)
    a, b = generator.normal(size=(4, 4)), generator.normal(size=(4, 2))
    left = []
    for h in (0.4, 0.2):
        _, end = prepared(a, b, h)
        ends = end[:, 4:] @ np.array([1.0, -2.0, 0.5, 3.0]) + end[:, :4] @ np.ones(4)
        whole = np.zeros((8, 8))  # state, load, slope of the load
        whole[:4, :4], whole[:4, 4:6], whole[4:6, 6:] = a, b, np.eye(2)
        load, slope = np.array([1.0, -2.0]), np.array([0.5, 3.0])
        exact = expm(h * whole) @ np.concatenate((np.ones(4), load - 0.5 * h * slope, slope))
        left.append(np.max(np.abs(ends - exact[:4])))
    assert left[0] < 1e-4
    assert left[0] / left[1] > 90.0


@pytest.mark.parametrize("h", [0.1, 10.0, 1e4])
def test_energy_and_heat_close_at_any_step(h: float) -> None:
    """A damped oscillator: what its damper takes at the points is what its energy loses."""
    a, b = np.array([[0.0, 1.0], [-4.0, -0.3]]), np.array([[0.0], [1.0]])
    points, end = prepared(a, b, h)
    state = np.array([1.0, -0.5])
    for _ in range(20):
        at = points[:, :2] @ state
        after = end[:, :2] @ state
        heat = sum(h * w * 0.3 * at[2 * i + 1] ** 2 for i, w in enumerate(gauss.WEIGHTS))
        lost = 0.5 * (4.0 * (state[0] ** 2 - after[0] ** 2) + state[1] ** 2 - after[1] ** 2)
        assert lost == pytest.approx(heat, rel=1e-9, abs=1e-14)
        assert heat >= 0.0
        state = after
