"""The reference: two solutions, and the horizon up to which they agree."""

from __future__ import annotations

import numpy as np
import pytest

from touchdown.master.common.errors import TouchdownError
from touchdown.master.coupling.simulation import opened
from touchdown.master.scene.file import load_scene
from touchdown.studies.drop.impact_watch import MIN_SPAN, shortened
from touchdown.studies.drop.monolithic import Monolith, stretch_ends
from touchdown.studies.drop.reference import (
    FIRST_SOLVER,
    POSITION,
    SECOND_SOLVER,
    VELOCITY,
    Solve,
    pair,
    reference,
)
from touchdown.studies.drop.reference import SECOND_SOLVER_OF_MANY as EXPLICIT

TIMES = 1e-3 * np.arange(1, 11)
AGREED = 1e-8  # m


def solves(apart: np.ndarray) -> tuple[Solve, Solve]:
    """Two seats; the second solver is `apart` (m) off in y at the second one, and 1 m/s per m in vy."""
    motion = np.zeros((len(TIMES), 2, 4))
    motion[:, 0, 0] = TIMES
    off = motion.copy()
    off[:, 1, 1] += apart
    off[:, 1, 3] += 3.0 * apart
    return Solve(FIRST_SOLVER, motion, 1, 1.0), Solve(SECOND_SOLVER, off, 1, 1.0)


def test_the_horizon_is_where_the_solvers_part() -> None:
    """They come together again by chance: that is no agreement."""
    apart = np.full(10, 1e-9)
    apart[6], apart[7] = 5e-8, 1e-10
    found = reference(TIMES, *solves(apart), AGREED)
    assert found.horizon == pytest.approx(6e-3)
    assert not found.whole
    assert found.floor(POSITION) == pytest.approx(1e-9)
    assert found.floor(VELOCITY) == pytest.approx(3e-9)
    assert found.extent(POSITION) == pytest.approx(5e-3)
    agreed = reference(TIMES, *solves(np.full(10, 1e-9)), AGREED)
    assert agreed.horizon == pytest.approx(1e-2)
    assert agreed.whole


@pytest.mark.parametrize("first", [1.0, np.nan])
def test_solvers_that_never_agree_are_no_reference(first: float) -> None:
    apart = np.zeros(10)
    apart[0] = first
    with pytest.raises(TouchdownError, match=r"there is no reference for errors of 0\.01 um"):
        reference(TIMES, *solves(apart), AGREED)


def test_a_distance_is_the_largest_of_any_seat_and_instant() -> None:
    found = reference(TIMES, *solves(np.zeros(10)), AGREED)
    motion = found.first.motion[2:4].copy()
    motion[1, 1, :2] += (3e-6, 4e-6)
    assert found.distance(motion, np.array([2, 3]), POSITION) == pytest.approx(5e-6)
    motion[0, 0, 0] = np.nan
    assert found.distance(motion, np.array([2, 3]), POSITION) == np.inf


def test_levitation_is_shortened_by_the_same_for_all() -> None:
    scene = load_scene("rotor1-9000").set({"amb_B.shutdown_time": "25 ms"})
    with opened(shortened(scene), in_process=True) as system:
        assert system.value("amb_A.shutdown_time") == pytest.approx(MIN_SPAN)
        assert system.value("amb_B.shutdown_time") == pytest.approx(MIN_SPAN + 5e-3)
    early = scene.set({"amb_A.shutdown_time": "1 ms"})
    assert shortened(early) is early


def test_a_rotor_in_two_magnetic_bearings_is_solved_past_their_shutdown() -> None:
    """Both shut down at once, and times count from there: three times that are one, but for rounding."""
    assert stretch_ends([0.002, 0.002 - 2e-18, 0.001, 0.01], 0.001, 0.01) == [0.002 - 2e-18, 0.01]
    assert pair(load_scene("disk-caged-simplified")) == (FIRST_SOLVER, SECOND_SOLVER)
    assert pair(load_scene("rotor1-9000")) == (FIRST_SOLVER, EXPLICIT)  # many states
    one = Monolith(load_scene("rotor1-9000"))
    found = one.solve(np.array([1e-4]), ["rotor.A.vy"], 1e-6, "DOP853")
    # it goes round with its unbalance at 942 rad/s, within 5 um of the middle, and has just begun to fall
    assert abs(found.series["rotor.A.vy"][0]) < 5e-6 * 942.5 + 9.81 * 1.1e-4
