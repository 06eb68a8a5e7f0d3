"""The linearly implicit integrator: its table, and its order with a wrong matrix."""

from __future__ import annotations

import math

import numpy as np
import pytest

from touchdown.modelkit.integrators import rosenbrock as row
from touchdown.modelkit.integrators.dopri import ALL_COORDINATES
from touchdown.modelkit.kernel import kernel


def test_the_table_is_of_order_three_with_any_matrix() -> None:
    """Conditions of a W-method of order 3 (Hairer and Wanner II, table IV.7.1 and section IV.7)."""
    b, alpha, gamma = row.WEIGHTS, row.ALPHA.sum(1), row.GAMMA.sum(1)
    third = (b @ alpha**2 - 1 / 3, b @ row.ALPHA @ alpha - 1 / 6)
    mixed = (b @ row.ALPHA @ gamma, b @ row.GAMMA @ alpha, b @ row.GAMMA @ gamma)
    for value in (b.sum() - 1.0, b @ alpha - 0.5, b @ gamma, *third, *mixed):
        assert value == pytest.approx(0.0, abs=1e-14)
    e = row.EMBEDDED
    for value in (e.sum() - 1.0, e @ alpha - 0.5, e @ gamma):
        assert value == pytest.approx(0.0, abs=1e-14)


@kernel
def _rhs(t, q, dq, m):
    dq[0] = q[1]
    dq[1] = -q[0] - m[0] * math.tanh(q[1])
    dq[2] = math.cos(t)


@kernel
def _linearise(q, j, m):
    j[1] = -m[1]


@kernel
def _solve(j, s, r, m):
    r[0] /= s
    r[1] /= s - j[1]
    r[2] /= s


@kernel
def _ignore(t, q, m):
    pass


@kernel
def _run(q, m, weight, work, span, h, tolerance):
    return row.integrate(
        _rhs, _linearise, _solve, _ignore, m, q, ALL_COORDINATES, 3, weight, work, span, h, tolerance
    )


def end(steps: int, assumed: float) -> np.ndarray:
    """State after one second in equal steps, the matrix holding `assumed` for the friction's slope."""
    q, work = np.array([1.0, 0.0, 0.0]), np.zeros((8, 3))
    for _ in range(steps):
        _run(q, np.array([0.8, assumed]), np.zeros(3), work, 1.0 / steps, 1.0, 1.0)
    return q[:2].copy()


@pytest.mark.parametrize("assumed", [0.0, 5.0])
def test_the_order_is_three_whatever_the_matrix(assumed: float) -> None:
    exact = end(4096, 0.8)
    errors = [np.max(np.abs(end(n, assumed) - exact)) for n in (16, 32, 64, 128)]
    order = np.polyfit(np.log([16, 32, 64, 128]), -np.log(errors), 1)[0]
    assert order == pytest.approx(3.0, abs=0.15)


def test_a_stiff_rate_does_not_bound_the_step() -> None:
    """1e7 per second in steps of 1e-5 s: an explicit method would need 3e-7 s."""
    q, work = np.array([0.0, 1.0, 0.0]), np.zeros((8, 3))
    rate = 1e7
    _, status, evaluations = _run(q, np.array([rate, rate]), np.ones(3), work, 1e-2, 1e-9, 1e-4)
    assert status == row.OK
    assert abs(q[1]) < 1e-4
    assert evaluations < 4000
