"""Temperatures of a bearing's parts, against closed forms."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.linalg import expm

from touchdown.bearings.heat import network
from touchdown.bearings.heat.warm_parts import (
    Bodies,
    clearance_change,
    play_change,
    set_conductances,
    set_inverse_capacities,
    set_surroundings,
)

# Koyo 6904 on a journal of 19.4 mm, in a housing of 0.5 kg
B6904 = Bodies(9.7e-3, 0.3e-3, 9e-3, 28.5e-3, 4.8e-3, 17, 17 * 0.4534e-3, 0, 9.5e-3, 0, 2.0)


def matrices(bodies: Bodies) -> tuple[np.ndarray, np.ndarray]:
    """One over the capacities (5,) (K/J), and conductances (5, 5) (W/K)."""
    inverse, conductances = np.zeros(5), np.zeros((5, 5))
    set_inverse_capacities(bodies, inverse)
    set_conductances(bodies, conductances)
    return inverse, conductances


def step_of(inverse: np.ndarray, conductances: np.ndarray, step: float) -> tuple[np.ndarray, np.ndarray]:
    """The matrices of a step (s): what is kept, and what is gained (K/J)."""
    kept, gained = np.zeros_like(conductances), np.zeros_like(conductances)
    network.set_step(inverse, conductances, step, kept, gained)
    return kept, gained


@pytest.mark.parametrize("step", [1e-4, 1.0, 1e3])
def test_a_step_is_the_matrix_exponential(step: float) -> None:
    inverse, conductances = matrices(B6904)
    kept, gained = step_of(inverse, conductances, step)
    whole = np.zeros((10, 10))
    whole[:5, :5] = -inverse[:, None] * conductances
    whole[:5, 5:] = np.diag(inverse) / step
    expected = expm(whole * step)
    assert kept == pytest.approx(expected[:5, :5], rel=1e-11, abs=1e-13)
    assert gained == pytest.approx(expected[:5, 5:], rel=1e-11, abs=1e-13 * inverse.max())


def test_without_a_way_out_all_heat_stays() -> None:
    inverse, conductances = matrices(B6904)
    conductances -= np.diag(conductances.sum(axis=0))
    kept, gained = step_of(inverse, conductances, 1e-3)
    warmth, heat = np.zeros(5), np.array([1.0, 2.0, 0.5, 2.0, 0.0])
    for _ in range(100):
        network.take_step(kept, gained, heat, warmth)
    assert warmth @ (1.0 / inverse) == pytest.approx(100.0 * heat.sum(), rel=1e-12)


def test_a_housing_held_fixed_stays_cold() -> None:
    inverse, conductances = matrices(B6904._replace(inv_housing_mass=0.0))
    kept, gained = step_of(inverse, conductances, 1.0)
    warmth = np.zeros(5)
    network.take_step(kept, gained, np.array([0.0, 1.0, 2.0, 1.0, 0.0]), warmth)
    assert warmth[4] == 0.0
    assert np.all(warmth[:4] > 0.0)


def test_warm_surroundings_warm_a_bearing_that_makes_no_heat() -> None:
    """Between a shaft of 30 K and surroundings of 60 K it ends in a steady state, by any step."""
    bodies = B6904._replace(shaft=2.0, fit=3.0, ambient=0.5, shaft_warmth=30.0, housing_warmth=60.0)
    inverse, conductances = matrices(bodies)
    warmth, inflow = np.ones(5), np.ones(5)
    set_surroundings(bodies, warmth, inflow)
    assert list(warmth) == [0.0, 0.0, 0.0, 0.0, 60.0]
    kept, gained = step_of(inverse, conductances, 1e6)
    network.take_step(kept, gained, 1e6 * inflow, warmth)
    passed = 0.5 * (60.0 - warmth[4])  # W, from the surroundings to the shaft
    assert [2.0 * (warmth[0] - 30.0), 3.0 * (warmth[4] - warmth[3])] == pytest.approx(
        [passed] * 2, rel=1e-6
    )
    assert 30.0 < warmth[0] < warmth[3] < 60.0


def test_a_housing_held_fixed_is_as_warm_as_it_is_set() -> None:
    bodies = B6904._replace(inv_housing_mass=0.0, ambient=5.0, housing_warmth=-20.0)
    warmth, inflow = np.zeros(5), np.zeros(5)
    set_surroundings(bodies, warmth, inflow)
    network.take_step(*step_of(*matrices(bodies), 10.0), 10.0 * inflow, warmth)
    assert warmth[4] == -20.0
    assert warmth[3] < 0.0


def test_capacities_of_a_6904() -> None:
    """Journal and balls by geometry; the outer ring is half as heavy again as the inner one."""
    inverse, _ = matrices(B6904)
    assert 1.0 / inverse == pytest.approx([9.58, 4.37, 3.55, 7.03, 230.0], rel=2e-3)


def test_gaps_follow_temperatures() -> None:
    """All alike: steel grows as a whole, but for the journal's clearance, which is no metal."""
    even = np.full(5, 100.0)
    assert play_change(B6904, even) == pytest.approx(0.0, abs=1e-15)  # closed gap
    assert clearance_change(B6904, even) == pytest.approx(11.5e-4 * 0.3e-3)
    warm = np.array([10.0, 40.0, 80.0, 20.0, 0.0])
    radii = 16.65e-3 * 20.0 - 11.85e-3 * 40.0 - 4.8e-3 * 80.0
    assert play_change(B6904, warm) == pytest.approx(11.5e-6 * radii)
    assert clearance_change(B6904, warm) == pytest.approx(11.5e-6 * (10e-3 * 40.0 - 9.7e-3 * 10.0))
