"""What watches a run is told of every macro step, and can end the run without spoiling its recording."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from types import SimpleNamespace
from typing import cast

import h5py
import numpy as np
import pytest

from touchdown.master.common.errors import Ended, TouchdownError
from touchdown.master.coupling import simulation
from touchdown.master.coupling.observer import LOOK_INTERVAL_STEPS, EveryBeat, EveryStep, Observer, RunState
from touchdown.master.coupling.simulation import Outcome, opened, simulate
from touchdown.master.coupling.system import System
from touchdown.master.scene.file import load_scene

STEP = 2e-5  # s
STEPS = 350  # 5 ms to the shutdown and 2 ms of falling
ENOUGH = 333  # a macro step that record_every = 5 leaves out


class Diary(Observer):
    """Keeps all it is told."""

    def __init__(self) -> None:
        self.times: list[float] = []
        self.left: list[str] = []

    def stepped(self, state: RunState) -> None:
        self.times.append(state.time)

    def retired(self, names: Sequence[str]) -> None:
        self.left += names


def fallen(record_to: Path | None = None, *observers: Observer) -> Outcome:
    """2 ms of the smallest scene, the magnetic bearing already off."""
    run = {"run.duration": 2e-3, "run.macro_step": STEP, "run.record_every": 5}
    scene = load_scene("disk-caged-simplified").set(run)
    with opened(scene, in_process=True) as system:
        return simulate(scene, system, record_to, observers=observers)


def at(step: int, act: Callable[[RunState], object]) -> Observer:
    """Does something once macro step `step` is taken."""
    return EveryStep(lambda now: act(now) if now.done == step else None)


def recorded(path: Path) -> np.ndarray:
    """Numbers of the macro steps after which something was recorded."""
    with h5py.File(path) as file:
        assert all(len(column) == len(file["time"]) for column in file["rotor"].values())
        return np.round((file["time"][:] + 5e-3) / STEP).astype(int)


def fail(error: Exception) -> None:
    """As an observer may."""
    raise error


def test_each_macro_step_is_told_once() -> None:
    diary, beats = Diary(), list[int]()
    outcome = fallen(None, diary, EveryBeat(lambda now: beats.append(now.done)))
    assert outcome.ended is Ended.COMPLETED
    assert outcome.reason == ""
    assert outcome.steps == STEPS
    assert diary.times == [STEP * (k + 1) for k in range(STEPS)]
    assert beats == [*range(LOOK_INTERVAL_STEPS, STEPS, LOOK_INTERVAL_STEPS), STEPS]
    assert diary.left == ["amb"]


def test_an_observer_ends_a_run_that_has_shown_enough(tmp_path: Path) -> None:
    later = Diary()
    path = tmp_path / "result.h5"
    outcome = fallen(path, at(ENOUGH, lambda now: now.stop("seen enough")), later)
    assert (outcome.ended, outcome.reason, outcome.steps) == (Ended.AS_WANTED, "seen enough", ENOUGH)
    assert outcome.end == ENOUGH * STEP
    assert len(later.times) == ENOUGH  # the others are still told of that step
    assert list(recorded(path)) == [*range(0, ENOUGH, 5), ENOUGH]
    outcome.raise_if_stopped()


def test_an_error_of_an_observer_leaves_the_recording_whole(tmp_path: Path) -> None:
    path = tmp_path / "result.h5"
    with pytest.raises(ZeroDivisionError):
        fallen(path, at(ENOUGH, lambda _: fail(ZeroDivisionError())))
    assert list(recorded(path)) == [*range(0, ENOUGH, 5)]


def test_what_a_user_can_cause_stops_the_run_and_says_why(tmp_path: Path) -> None:
    path = tmp_path / "result.h5"
    outcome = fallen(path, at(ENOUGH, lambda _: fail(TouchdownError("the disk is full"))))
    assert (outcome.ended, outcome.reason) == (Ended.STOPPED, "the disk is full")
    assert list(recorded(path)) == [*range(0, ENOUGH, 5)]
    with pytest.raises(TouchdownError, match="the disk is full"):
        outcome.raise_if_stopped()


def test_a_moment_that_is_kept_is_recorded(tmp_path: Path) -> None:
    path = tmp_path / "result.h5"
    assert fallen(path, at(ENOUGH, RunState.keep)).ended is Ended.COMPLETED
    assert list(recorded(path)) == sorted([*range(0, STEPS + 1, 5), ENOUGH])


def test_what_is_asked_first_counts_unless_something_breaks() -> None:
    now = RunState(cast(System, None), zero=0.0, steps=1)
    now.stop("first")
    now.stop("second", Ended.STOPPED)
    assert (now.ended, now.reason) == (Ended.AS_WANTED, "first")
    now.fail("broken")
    now.fail("broken again")
    assert (now.ended, now.reason) == (Ended.STOPPED, "broken")


def test_ctrl_c_is_no_error_of_the_run() -> None:
    with pytest.raises(KeyboardInterrupt):
        Outcome(ended=Ended.INTERRUPTED, reason="interrupted").raise_if_stopped()


def test_what_the_first_step_compiles_is_no_stepping(monkeypatch: pytest.MonkeyPatch) -> None:
    """A first macro step that takes half a second is start-up; the others tell the run's speed."""
    passed = SimpleNamespace(time=0.0)  # s, by a clock that stands but for this

    def half_a_second(now: RunState) -> None:
        passed.time += 0.5

    monkeypatch.setattr(simulation, "clock", SimpleNamespace(perf_counter=lambda: passed.time))
    first = fallen(None, at(1, half_a_second))
    assert (first.start_up, first.wall_time) == (0.5, 0.0)
    second = fallen(None, at(2, half_a_second))
    assert second.wall_time == pytest.approx(0.5 * STEPS / (STEPS - 1), rel=1e-12)


def test_two_of_a_kind_keep_a_state_each(tmp_path: Path) -> None:
    class Counting(EveryStep):
        KEPT = ("number",)

        def __init__(self, number: int) -> None:
            super().__init__(lambda now: None)
            self.number = number

    state = fallen(tmp_path / "result.h5", Counting(1), Counting(2)).state
    assert state is not None
    kept = {name: found for name, found in state["holders"].items() if "Counting" in name}
    assert [*kept.values()] == [{"number": 1}, {"number": 2}]
