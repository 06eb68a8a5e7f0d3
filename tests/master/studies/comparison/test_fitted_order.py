"""Orders fitted to errors over macro steps."""

from __future__ import annotations

import math

import pytest

from touchdown.master.studies.comparison.schemes import fitted_order

STEPS = (1e-6, 2e-6, 5e-6, 1e-5, 2e-5, 5e-5)


def of_order(order: float, scale: float = 1e-6) -> list[float]:
    """`scale` at 10 us."""
    return [scale * (step / 1e-5) ** order for step in STEPS]


@pytest.mark.parametrize("order", [1.0, 2.0, 3.0])
def test_a_pure_power_is_found(order: float) -> None:
    found = fitted_order(STEPS, of_order(order), 0.0, math.inf)
    assert found is not None
    assert found.value == pytest.approx(order, rel=1e-9)
    assert found.steps == STEPS


def test_errors_near_the_floor_are_left_out() -> None:
    errors = [error + 1e-8 for error in of_order(2.0)]
    found = fitted_order(STEPS, errors, 1e-8, math.inf)
    assert found is not None
    assert found.steps == STEPS[2:]  # 2.6e-7 at 5 us is the first beyond ten times the floor
    assert found.value == pytest.approx(2.0, abs=0.05)


def test_saturated_errors_are_left_out() -> None:
    errors = [min(error, 2e-6) for error in of_order(2.0)]
    found = fitted_order(STEPS, errors, 0.0, 2e-6)
    assert found is not None
    assert found.steps == STEPS[:4]
    assert found.value == pytest.approx(2.0, rel=1e-9)


def test_a_plateau_of_another_cause_is_left_out() -> None:
    """The steps inside a bearing err by 1e-7 whatever the macro step: no floor of the reference."""
    errors = [max(error, 1e-7) for error in of_order(3.0)]
    found = fitted_order(STEPS, errors, 0.0, math.inf)
    assert found is not None
    assert found.steps == STEPS[2:]
    assert found.value == pytest.approx(3.0, rel=1e-9)


def test_a_failed_run_does_not_hide_the_others() -> None:
    errors = of_order(1.0)
    errors[0], errors[5] = math.nan, math.inf
    found = fitted_order(STEPS, errors, 0.0, math.inf)
    assert found is not None
    assert found.steps == STEPS[1:5]


@pytest.mark.parametrize("errors", [[1e-6] * 6, [0.0] * 6, [1e-6, 4e-6, 0.0, 0.0, 0.0, 0.0]])
def test_too_few_steps_tell_nothing(errors: list[float]) -> None:
    assert fitted_order(STEPS, errors, 0.0, math.inf) is None


def test_the_order_of_the_steps_does_not_matter() -> None:
    there = fitted_order(STEPS, of_order(1.5), 0.0, math.inf)
    assert there == fitted_order(STEPS[::-1], of_order(1.5)[::-1], 0.0, math.inf)
