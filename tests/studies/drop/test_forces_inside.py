"""Peak forces inside a bearing: which are known, and what they are measured against."""

from __future__ import annotations

import numpy as np
import pytest
from bearing_states import instance_of

from touchdown.studies.drop.impact_watch import Trace, forces_text, reported_inside
from touchdown.studies.drop.measured_drop import Landing

TIME = 1e-6 * np.arange(1, 1001)


def trace(**inside: np.ndarray) -> Trace:
    zero = np.zeros_like(TIME)
    return Trace(TIME, zero, zero, zero, zero, 0.5 + zero, zero, inside=inside)


def landing(**traces: Trace) -> Landing:
    impacts = dict.fromkeys(traces, (1e-4, 5e-4))
    return Landing(1e-4, 1e-3, 0.0, [], impacts, traces)


def test_what_a_bearing_reports() -> None:
    ball, side = {"ball": "balls.peak_force"}, {"side": "neighbours.peak_force"}
    known = {
        "bushing": {},
        "simplified_caged": ball,
        "simplified_cageless": ball | side,
        "detailed_caged": ball | {"side": "pockets.peak_force"},
    }
    for model, told in known.items():
        assert reported_inside({slot.variable.name for slot in instance_of(model).slots}) == told


def test_a_peak_is_measured_at_the_instant_it_was_read() -> None:
    """A cage that is hit harder once the journal has parted is no error of a run that reads it later."""
    side = np.where(TIME < 5.5e-4, 10.0, 20.0)
    found = landing(A=trace(ball=np.full(1000, 200.0), side=side))
    assert found.peaks("A") == {"force": 0.5, "ball": 200.0, "side": 10.0}
    errors = found.force_errors({"A": (6e-4, {"force": 0.4, "ball": 202.0, "side": 19.0})})
    assert errors == pytest.approx({"ball": 0.01, "side": 0.05})
    assert found.force_errors({"A": (5e-4, {"force": 0.5, "ball": 202.0, "side": 10.0})})["side"] == 0.0
    told = "contact force 0.5 N, most loaded ball 200 N, cage or neighbour on a ball 10 N"
    assert forces_text(found.peaks("A")) == told
    # the worst seat counts, and a graze does not
    both = landing(
        A=trace(ball=np.full(1000, 100.0), side=np.full(1000, 0.5)), B=trace(ball=np.full(1000, 50.0))
    )
    read = {
        "A": (5e-4, {"force": 0.5, "ball": 101.0, "side": 0.9}),
        "B": (5e-4, {"force": 0.5, "ball": 49.0}),
    }
    assert both.force_errors(read) == pytest.approx({"ball": 0.02})
