"""The matrix of linearly implicit steps of a row of balls, against finite differences."""

from __future__ import annotations

import numpy as np
from bearing_states import state_in_contact

from touchdown.bearings.rolling import ring
from touchdown.bearings.rolling.ring import BALLS
from touchdown.bearings.rolling.row import linearise, solve_linearised


def test_the_arrow_solver_solves_what_finite_differences_give() -> None:
    instance = state_in_contact("simplified_cageless", 1)
    m, n = instance.record, int(instance.record["n"])
    balls = [BALLS + b + 17 * k for b in range(17) for k in (1, 2)]
    index = [ring.RW, *balls]
    q = m["q"][:n].copy()

    def rates(state: np.ndarray) -> np.ndarray:
        dq = np.zeros(n)
        instance.model.instant(0.0, state.copy(), dq, instance.words)
        return dq[index]

    jacobian = np.zeros((35, 35))
    for column, i in enumerate(index):
        shift = np.zeros(n)
        shift[i] = 1e-4 * max(1.0, abs(q[i]))
        jacobian[:, column] = (rates(q + shift) - rates(q - shift)) / (2.0 * shift[i])
    rates(q)
    stiff, right = np.zeros(n), np.random.default_rng(0).normal(size=n)
    linearise(q, stiff, m)
    found = right.copy()
    solve_linearised(stiff, 2e5, found, m)
    exact = np.linalg.solve(2e5 * np.eye(35) - jacobian, right[index])
    np.testing.assert_allclose(found[index], exact, atol=5e-3 * np.max(np.abs(exact)))
    others = [i for i in range(n) if i not in index]
    np.testing.assert_allclose(found[others], right[others] / 2e5)
