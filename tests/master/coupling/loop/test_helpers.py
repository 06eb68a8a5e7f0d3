"""Threads that step bearings beside each other change nothing but the time that it takes."""

from __future__ import annotations

import ctypes
import os
import threading
from dataclasses import replace
from functools import partial
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from systems import UNLIKE, bits, rotor_on

from touchdown.master.common import pool
from touchdown.master.common.errors import Ended
from touchdown.master.coupling.loop import helpers
from touchdown.master.coupling.loop.helpers import Helpers
from touchdown.master.coupling.loop.kernels import kernel_without_gil
from touchdown.master.coupling.loop.kernels.loop_tables import TURN
from touchdown.master.coupling.loop.kernels.stretch import advance
from touchdown.master.coupling.simulation import Outcome, opened, simulate
from touchdown.master.results.run import natively
from touchdown.master.scene.file import load_scene
from touchdown.master.scene.scene import Scene


def landing(**settings: object) -> Scene:
    """Rotor I from before the shutdown, where magnetic bearings retire, to after its first impacts."""
    scene = load_scene("rotor1-9000").set({f"amb_{end}.shutdown_time": 1e-3 for end in "AB"})
    return scene.set({"run.duration": 8e-3} | {k.replace("__", "."): v for k, v in settings.items()})


class Threads:
    """Runs scenes with a number of threads, and counts what helpers took."""

    def __init__(self, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        self.folder, self._patch = folder, monkeypatch
        self.called = self.helped = 0

    def run(self, scene: Scene, count: int, in_process: bool = True) -> tuple[Outcome, dict[str, object]]:
        self._patch.setenv(pool.LIMIT, str(count))
        call, close, self.called, self.helped = Helpers.call, Helpers.close, 0, 0

        def counting(one: Helpers) -> int:
            self.called += 1
            return call(one)

        def closing(one: Helpers) -> None:
            close(one)
            self.helped += one.helped

        path = self.folder / f"{count}.h5"
        with self._patch.context() as patch, opened(scene, in_process) as system:
            patch.setattr(Helpers, "call", counting)
            patch.setattr(Helpers, "close", closing)
            outcome = simulate(scene, system, path)
        assert not helping()
        return replace(outcome, **UNLIKE), bits(path)

    def compared(self, scene: Scene, in_process: bool = True) -> Outcome:
        """The outcome, once a run with helpers and one without left the same behind."""
        alone, left_alone = self.run(scene, 1, in_process)
        assert not self.called
        beside, left_beside = self.run(scene, 2, in_process)
        assert self.called
        assert repr(beside) == repr(alone)
        if alone.ended is not Ended.COMPLETED:  # who stepped beside the one that failed did step
            for left in (left_alone, left_beside):
                for name in [name for name in left if name.startswith("at_end")]:
                    del left[name]
        assert left_beside == left_alone
        return beside


def helping() -> list[threading.Thread]:
    """Helpers that are there."""
    return [thread for thread in threading.enumerate() if thread.name == "touchdown-helper"]


@pytest.fixture
def threads(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Threads:
    return Threads(tmp_path, monkeypatch)


@pytest.mark.parametrize("scheme", ["interface", "jacobi-lead"])
def test_equal_to_the_bit(scheme: str, threads: Threads) -> None:
    outcome = threads.compared(landing(run__scheme=scheme))
    assert outcome.ended is Ended.COMPLETED


@pytest.mark.native
def test_native_fmus(threads: Threads) -> None:
    threads.compared(natively(landing(run__duration=4e-3)), in_process=False)


def test_who_refuses_a_step_says_why(threads: Threads) -> None:
    """By contacts that are far too stiff for steps under held loads."""
    scene = landing(run__scheme="jacobi-hold", run__macro_step=1e-4, run__impact_step=0.0)
    scene = scene.swap(bearing_A="bushing", bearing_B="bushing")
    scene = scene.set({f"bearing_{end}.contact.stiffness": 1e12 for end in "AB"})
    scene = scene.set({"run.duration": 0.1, "run.warn_residual": 1e300, "run.stop_residual": 1e300})
    outcome = threads.compared(scene)
    assert outcome.ended is Ended.STOPPED
    assert outcome.reason.startswith("component bearing_B: more than")


def test_where_there_can_be_no_more_threads_a_run_goes_on_alone(
    threads: Threads, monkeypatch: pytest.MonkeyPatch
) -> None:
    def start(thread: threading.Thread) -> None:
        raise RuntimeError("can't start new thread")

    monkeypatch.setattr(threading.Thread, "start", start)
    assert threads.compared(landing(run__duration=3e-3)).ended is Ended.COMPLETED
    assert not threads.helped


def test_what_goes_wrong_in_a_helper_is_not_lost(threads: Threads, monkeypatch: pytest.MonkeyPatch) -> None:
    def help_out(*_: object) -> None:
        raise MemoryError("of the helper")

    class AtOnce(threading.Thread):
        """Has ended before the run goes on, however busy the machine is."""

        def start(self) -> None:
            super().start()
            self.join()

    monkeypatch.setattr(helpers, "help_out", help_out)
    monkeypatch.setattr(helpers, "Thread", AtOnce)
    with pytest.raises(MemoryError, match="of the helper"):
        threads.run(landing(run__duration=3e-3), 2)


def test_who_needs_no_helper_has_none(threads: Threads) -> None:
    """One bearing; FMUs in Python, which need the interpreter's lock, one at a time."""
    threads.run(rotor_on("bushing", {"mass": 1.0}, duration=2e-3, macro_step=1e-5), 4)
    assert not threads.called
    threads.run(landing(run__duration=2e-3), 2, in_process=False)
    assert not threads.called


# -- the board -----------------------------------------------------------------------------------------


STEP = ctypes.CFUNCTYPE(
    ctypes.c_int, ctypes.c_void_p, ctypes.c_double, ctypes.c_double, ctypes.c_int
)  # an fmi2DoStep


class Group:
    """Components whose steps are the test's own; all of them are under way at once where they `meet`."""

    def __init__(self, count: int, meet: threading.Barrier | None = None) -> None:
        self.meet = meet
        self.steps: list[tuple[int, float]] = []  # which, and the time it was told
        self.by: list[set[str]] = [set() for _ in range(count)]  # who took its steps
        self._functions = [STEP(partial(self._step, i)) for i in range(count)]
        self.turns = np.zeros(count, TURN)
        self.turns["functions"], self.turns["due"], self.turns["status"] = 1, 1, 9
        self.turns["step"] = [ctypes.cast(f, ctypes.c_void_p).value for f in self._functions]

    def _step(self, which: int, component: int | None, time: float, span: float, done: int) -> int:
        if self.meet is not None:
            self.meet.wait(60.0)
        self.steps.append((which, time))
        self.by[which].add(threading.current_thread().name)
        return 0

    def round(self, board: int, time: float) -> None:
        """All of them, once, at that time."""
        self.turns["time"] = time
        assert advance_all(board, self.turns) == -1
        assert sorted(self.steps[-len(self.turns) :]) == [(i, time) for i in range(len(self.turns))]


@kernel_without_gil
def advance_all(board, turns):  # type: ignore[no-untyped-def]
    return advance(board, turns, 0, len(turns))


@pytest.mark.parametrize(("count", "threads"), [(2, 1), (5, 1), (5, 3)])
def test_each_step_is_taken_once_by_somebody(
    count: int, threads: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Whoever that is: on a busy machine helpers may take all steps or none."""
    monkeypatch.setattr(helpers, "MAX_IDLE_LOOKS", 2**60)  # none leaves before it is counted
    group = Group(count)
    crew = Helpers(threads, group.turns, helpers._leave_address())
    try:
        board = crew.call()
        assert len(helping()) == threads
        for number in range(100):
            group.round(board, float(number))
        assert len(group.steps) == 100 * count
    finally:
        crew.close()
    assert not helping()


def test_a_helper_steps_beside_the_run(monkeypatch: pytest.MonkeyPatch) -> None:
    """Two steps that are only over when both have begun: the run takes one, its helper the other."""
    monkeypatch.setattr(helpers, "MAX_IDLE_LOOKS", 2**60)  # however long the helper waits for its processor
    group = Group(2, threading.Barrier(2))
    crew = Helpers(1, group.turns, helpers._leave_address())
    try:
        board = crew.call()
        for number in range(20):
            group.round(board, float(number))
    finally:
        crew.close()
    assert crew.helped == 20  # the last is only counted after the run was let go on
    assert group.by[0] | group.by[1] == {"MainThread", "touchdown-helper"}


def test_the_first_that_fails_is_told() -> None:
    group = Group(3)
    failing = [STEP(lambda *_: 3) for _ in range(2)]
    group.turns["step"][1:] = [ctypes.cast(f, ctypes.c_void_p).value for f in failing]
    crew = Helpers(1, group.turns, helpers._leave_address())
    try:
        assert advance_all(crew.call(), group.turns) == 1
    finally:
        crew.close()
    assert group.turns["status"].tolist() == [0, 3, 3]


def test_helpers_that_do_not_have_their_processor_are_left_out(monkeypatch: pytest.MonkeyPatch) -> None:
    """For one stretch, two, four and so on, until a stretch in which they had it."""
    now = SimpleNamespace(wall=0.0, spent=0.0)
    fake = SimpleNamespace(perf_counter=lambda: now.wall, clock_gettime=lambda _: now.spent)
    monkeypatch.setattr(helpers, "clock", fake)
    crew = Helpers(1, Group(2).turns, helpers._leave_address())

    def stretch(of_processors: float) -> bool:
        beside = crew.call() != 0
        now.wall += 1e-2
        now.spent += 1e-2 * of_processors
        crew.judge()
        return beside

    try:
        asked = [stretch(0.5) for _ in range(12)]
        assert asked == [True, False, True, False, False, True, *[False] * 4, True, False]
        assert [stretch(0.5) for _ in range(7)] == [False] * 7
        assert [stretch(1.0) for _ in range(5)] == [True] * 5
        assert stretch(0.5)
        assert [stretch(0.5) for _ in range(2)] == [False, True]
    finally:
        crew.close()


# -- who gets some -------------------------------------------------------------------------------------


def test_each_bearing_but_one_is_worth_a_helper(monkeypatch: pytest.MonkeyPatch) -> None:
    """Magnetic bearings are not, nor is the rotor where all step at once."""
    monkeypatch.setenv(pool.LIMIT, "16")
    made: list[int] = []
    begin = Helpers.__init__

    def counting(crew: Helpers, count: int, *given: Any) -> None:
        made.append(count)
        begin(crew, count, *given)

    monkeypatch.setattr(Helpers, "__init__", counting)
    for scheme in ("interface", "jacobi-lead"):
        with opened(landing(run__duration=1e-3, run__scheme=scheme), in_process=True) as system:
            simulate(landing(run__duration=1e-3, run__scheme=scheme), system)
    assert set(made) == {1}


# -- how many ------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("given", "quota", "allowed"),
    [
        ("2,4", "max 100000", 2),
        ("", "max 100000", 8),
        ("0", "250000 100000", 2),
        ("many", "50000 100000", 1),
        ("-1", None, 8),
    ],
)
def test_the_environment_says_how_many_or_else_the_machine(
    given: str, quota: str | None, allowed: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its processors, or what a container is given of them."""
    monkeypatch.setenv(pool.LIMIT, given)
    monkeypatch.setattr(os, "sched_getaffinity", lambda process: set(range(8)))
    monkeypatch.setattr(pool, "QUOTA", tmp_path / "cpu.max")
    if quota is not None:
        (tmp_path / "cpu.max").write_text(quota + "\n", "utf-8")
    assert pool.threads() == allowed
