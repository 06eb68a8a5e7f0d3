"""Where a recording's first impact ends."""

from __future__ import annotations

import numpy as np
import pytest

from touchdown.master.results.first_impact import free_row, latest, over_after


def force(*impacts: tuple[float, float], apart: float = 1e-4, end: float = 0.03) -> tuple[np.ndarray, ...]:
    """Times and forces of impacts from one time to another (s)."""
    time = np.arange(round(end / apart) + 1) * apart
    pressed = [(time >= begin) & (time <= over) for begin, over in impacts]
    return time, np.where(np.any(pressed, axis=0), 100.0, 0.0)


def test_it_ends_where_the_journal_parts() -> None:
    time, pressed = force((0.0080, 0.0088), (0.0150, 0.0160))
    row = over_after(time, pressed, 0.00795)
    assert row is not None
    assert time[row] == pytest.approx(0.0089)


def test_a_rattle_does_not_end_it() -> None:
    """Parted for 0.1 ms, half of what ends an impact."""
    time, pressed = force((0.0080, 0.0083), (0.0085, 0.0088), (0.0150, 0.0160))
    row = over_after(time, pressed, 0.00795)
    assert row is not None
    assert time[row] == pytest.approx(0.0089)


def test_one_between_two_rows() -> None:
    time, pressed = force((0.0150, 0.0160), apart=5e-4)
    row = over_after(time, pressed, 0.00810)
    assert row is not None
    assert time[row] == pytest.approx(0.0085)


def test_one_that_never_parts_lasts() -> None:
    time, pressed = force((0.0080, 1.0))
    assert over_after(time, pressed, 0.008) == len(time) - 1


def test_rows_far_apart_tell_nothing() -> None:
    time, pressed = force((0.008, 0.012), apart=2e-3)
    assert over_after(time, pressed, 0.008) is None


def test_the_row_lies_before_the_next_impact() -> None:
    """It begins 0.25 ms after the first has ended, as `over` knows."""
    time, pressed = force((0.0080, 0.0088), (0.00905, 0.0105))
    row = free_row(time, pressed, 0.00901)
    assert row is not None
    assert 0.0088 < time[row] < 0.00905
    coarse, pressed = force((0.0080, 0.0088), (0.0105, 0.0115), apart=5e-4)
    assert free_row(coarse, pressed, 0.00901) == 18  # at 9 ms
    assert free_row(coarse, pressed, 0.00931) == 19  # none since 9.11 ms; still free at 9.5 ms
    assert free_row(coarse, np.ones(len(coarse)), 0.00931) is None


def test_of_several_seats_it_is_the_latest() -> None:
    assert latest([3, 7]) == 7
    assert latest([3, None]) is None
    assert latest([]) is None
