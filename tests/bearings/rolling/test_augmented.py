"""The outer ring held by a multiplier (2.18-2.28) against its rotation eliminated."""

from __future__ import annotations

import numpy as np
import pytest
from bearing_states import pressed
from scipy.integrate import solve_ivp

from touchdown.bearings.rolling.augmented import AugmentedBearing, accelerations

MODELS = ["detailed_cageless", "detailed_caged"]


def test_a_pendulum_in_cartesian_coordinates() -> None:
    """(2.23) on the textbook case: a point on a level rod, at rest, starts to fall freely."""
    found, tension = accelerations(
        np.array([2.0, 2.0]), np.array([0.0, -2.0 * 9.81]), np.array([[2.0, 0.0]]), np.array([0.0])
    )
    assert found == pytest.approx([0.0, -9.81])
    assert tension == pytest.approx([0.0])


@pytest.mark.parametrize("name", MODELS)
def test_the_count_of_coordinates_is_the_sources(name: str) -> None:
    """57 and 36 (Table 5), and the journal's three."""
    assert (
        AugmentedBearing(pressed(name, 0)).coordinates
        == {"detailed_cageless": 60, "detailed_caged": 39}[name]
    )


@pytest.mark.parametrize("name", MODELS)
@pytest.mark.parametrize(("alpha", "beta"), [(0.0, 0.0), (1e5, 1e5)])
def test_accelerations_are_those_without_the_coordinate(name: str, alpha: float, beta: float) -> None:
    """From a state that keeps the constraint both forms move every body alike."""
    instance = pressed(name, 2)
    held = AugmentedBearing(instance, alpha=alpha, beta=beta)
    reduced = AugmentedBearing(instance, eliminated=True)
    state = held.initial()
    first, second = held.rhs(0.0, state), reduced.rhs(0.0, state)
    assert np.max(np.abs(first - second)) < 1e-12 * np.max(np.abs(second))
    moment = float(instance.record["s"]["outer_moment"])
    assert abs(moment) > 1e-3  # friction does try to turn the outer ring


def test_a_violation_follows_its_own_equation() -> None:
    """C'' + 2 alpha C' + beta^2 C = 0 (2.24), whatever the contacts do."""
    alpha, beta, end = 1e5, 1e4, 1e-4
    held = AugmentedBearing(pressed("detailed_caged", 3), alpha=alpha, beta=beta)
    start = held.initial(1e-6, 1e-2)
    found = solve_ivp(held.rhs, (0.0, end), start, method="RK45", rtol=1e-8, atol=1e-12, t_eval=[end])
    position, rate = held.violation(start)
    free = solve_ivp(
        lambda _, c: [c[1], -2.0 * alpha * c[1] - beta**2 * c[0]],
        (0.0, end), [position, rate], rtol=1e-12, atol=1e-20,
    )  # fmt: skip
    assert held.violation(found.y[:, -1])[0] == pytest.approx(free.y[0, -1], rel=1e-3, abs=1e-12)
