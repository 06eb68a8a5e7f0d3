"""Macro steps in compiled code are those of the Python loop: recordings, ledgers, ends, to the last bit."""

from __future__ import annotations

import os
import signal
import threading
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from misbehaving import COMPILER, compiled, misbehaving, scene_with
from systems import UNLIKE, bits, rotor_on

from touchdown.master.common.errors import Ended
from touchdown.master.components.in_process import InProcessComponent
from touchdown.master.coupling.loop import compiled_loop as stretches
from touchdown.master.coupling.loop import division
from touchdown.master.coupling.loop.compiled_loop import PythonLoop
from touchdown.master.coupling.observer import LOOK_INTERVAL_STEPS, EveryBeat, Observer, RunState
from touchdown.master.coupling.simulation import Outcome, opened, simulate
from touchdown.master.coupling.steppers.gauss_seidel import GaussSeidel
from touchdown.master.scene.file import load_scene, parse_scene
from touchdown.master.scene.scene import Scene

Observing = Callable[[], Observer]
SCALED = {
    "components": {
        "rotor": {"fmu": "rigid_rotor", "set": {"y": "10 um"}},
        "amb": {"fmu": "amb", "every": 2},
    },
    "attach": [["amb.journal", "rotor.amb"]],
    "connect": [["rotor.A.y", "amb.sensor.y", 2.0, 1e-6], ["rotor.A.x", "amb.sensor.x"]],
    "run": {"duration": 4e-3, "macro_step": 2e-5},
}


class Both:
    """Runs a scene in compiled stretches and in the Python loop."""

    def __init__(self, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        self.folder, self._patch = folder, monkeypatch
        self.stepped = 0  # macro steps that the last run took one by one
        self.listening = True  # whether the master hears contact in bearings that report none: step by step
        take = PythonLoop.take

        def counting(steps: PythonLoop, now: RunState) -> None:
            self.stepped += 1
            take(steps, now)

        monkeypatch.setattr(PythonLoop, "take", counting)

    def run(
        self, scene: Scene, path: Path, observing: Observing | None = None, in_process: bool = True
    ) -> Outcome:
        self.stepped = 0
        with opened(scene, in_process, listening=self.listening) as system:
            observers = [observing()] if observing else []
            outcome = simulate(scene, system, path, observers=observers)
        return replace(outcome, **UNLIKE)

    def compared(
        self, scene: Scene, observing: Observing | None = None, in_process: bool = True
    ) -> Outcome:
        """The outcome, once everything that both leave behind was found equal."""
        paths = self.folder / "compiled.h5", self.folder / "python.h5"
        found = self.run(scene, paths[0], observing, in_process)
        assert self.stepped == 1  # the first, which compiles
        with self._patch.context() as patch:
            patch.setattr(stretches, "PARALLEL_SEQUENCES", {})
            wanted = self.run(scene, paths[1], observing, in_process)
        assert self.stepped in (wanted.steps, wanted.steps + 1)  # one may fail
        assert repr(found) == repr(wanted)
        assert bits(paths[0]) == bits(paths[1])
        return found


@pytest.fixture
def both(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Both:
    return Both(tmp_path, monkeypatch)


def disk(**settings: object) -> Scene:
    """The disk from before the shutdown, where the magnetic bearing retires, to after the first impact."""
    scene = load_scene("disk-caged-simplified").set({"amb.shutdown_time": 1e-3, "run.duration": 9e-3})
    return scene.set({"run.macro_step": 2e-5} | {k.replace("__", "."): v for k, v in settings.items()})


# -- what is taken in compiled code --------------------------------------------------------------------


@pytest.mark.parametrize("scheme", ["interface", "hold", "jacobi-lead"])
def test_schemes(scheme: str, both: Both) -> None:
    assert both.compared(disk(run__scheme=scheme)).steps > 3 * LOOK_INTERVAL_STEPS


@pytest.mark.parametrize("scheme", ["interface", "jacobi-interface"])
def test_macro_steps_of_their_own_from_another_start(scheme: str, both: Both) -> None:
    """By a start and steps that no binary number is: every time is rounded."""
    start = 1000.0 / 7.0
    scene = disk(run__scheme=scheme, run__start_time=start, amb__shutdown_time=start + 1e-3)
    assert both.compared(scene.set({"bearing.every": 4})).start == start


def test_scaled_connections(both: Both) -> None:
    both.compared(parse_scene(SCALED, "scaled", both.folder))


def test_all_that_can_be_recorded_after_every_step(both: Both) -> None:
    """Integers too; and more rows than are held at once."""
    scene = disk(run__record_every=1, run__record_arrays=True, run__duration=3e-3)
    both.compared(scene)


@pytest.mark.parametrize("scheme", ["interface", "jacobi-lead"])
def test_macro_steps_that_are_halved(scheme: str, both: Both, monkeypatch: pytest.MonkeyPatch) -> None:
    """As in a whirl, by thresholds that a landing passes."""
    limits = {"WINDOW_S": 1e-3, "WHIRL_TURNOVER": 1e-3, "WHIRL_END_TURNOVER": 0.0}
    for name, value in (limits | {"TARGET_ENERGY_MADE": 1e-12}).items():
        monkeypatch.setattr(division, name, value)
    assert both.compared(disk(run__scheme=scheme)).shorter_steps


def test_seven_components_of_which_two_retire_divided_in_impacts(both: Both) -> None:
    scene = load_scene("rotor1-9000").set({"run.duration": 8e-3, "run.impact_step": 5e-6})
    scene = scene.set({f"amb_{end}.shutdown_time": 1e-3 for end in "AB"})
    assert both.compared(scene).divided_in_impacts > 0


# -- how a run ends ------------------------------------------------------------------------------------


def test_a_ledger_that_warns_then_stops(both: Both) -> None:
    limits = {"run__warn_residual": 1e-3, "run__stop_residual": 0.05}
    outcome = both.compared(disk(run__scheme="hold", run__macro_step=1e-4, **limits))
    assert outcome.warned_at is not None
    assert outcome.ended is Ended.STOPPED
    assert "energy error of the coupling" in outcome.reason


def test_a_model_that_cannot_go_on(both: Both) -> None:
    def spoil(now: RunState) -> None:
        rotor = now.system.components["rotor"]
        assert isinstance(rotor, InProcessComponent)
        if now.done == LOOK_INTERVAL_STEPS:
            rotor.instance.record["q"][0] = np.nan

    outcome = both.compared(disk(), lambda: EveryBeat(spoil))
    assert outcome.ended is Ended.STOPPED
    assert outcome.reason.startswith("component rotor: the load at t = 0.00128 s is not a finite number")


def test_ctrl_c(both: Both) -> None:
    """Noted between two stretches, and the recording is whole."""

    def interrupt(now: RunState) -> None:
        if now.done == 2 * LOOK_INTERVAL_STEPS:
            os.kill(os.getpid(), signal.SIGINT)

    outcome = both.compared(disk(), lambda: EveryBeat(interrupt))
    assert (outcome.ended, outcome.steps) == (Ended.INTERRUPTED, 2 * LOOK_INTERVAL_STEPS)


def test_ctrl_c_within_a_stretch(both: Both) -> None:
    """The run ends with the stretch at hand, long before its time."""
    hand = threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT))

    class Begun(Observer):
        at_beats_only = True

        def stepped(self, state: RunState) -> None:
            if state.done == LOOK_INTERVAL_STEPS:
                hand.start()

        def due(self, state: RunState) -> int:
            return LOOK_INTERVAL_STEPS if state.done < LOOK_INTERVAL_STEPS else state.steps

    scene = disk(run__duration=200.0, run__record_every=1000)
    outcome = both.run(scene, both.folder / "broken-off.h5", Begun)
    assert outcome.ended is Ended.INTERRUPTED
    assert LOOK_INTERVAL_STEPS < outcome.steps < 0.1 * 200.0 / 2e-5
    assert both.stepped == 1


def test_what_an_observer_keeps_and_ends(both: Both) -> None:
    """At a beat that `record_every` leaves out."""

    def keep(now: RunState) -> None:
        now.keep()
        if now.done == 3 * LOOK_INTERVAL_STEPS:
            now.stop("seen enough")

    outcome = both.compared(disk(run__record_every=5), lambda: EveryBeat(keep))
    assert (outcome.reason, outcome.steps) == ("seen enough", 3 * LOOK_INTERVAL_STEPS)


# -- FMUs -----------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def library(tmp_path_factory: pytest.TempPathFactory) -> Path:
    if COMPILER is None:
        pytest.skip("there is no C compiler (cc, gcc)")
    return compiled(tmp_path_factory.mktemp("misbehaving"))


@pytest.mark.parametrize(
    ("deed", "said"),
    [
        ("nothing", ""),
        ("error", "it answered 'error' and gave no reason (while stepping from t = 4e-05 s)"),
        ("nan", "its FMU gives journal.fy = nan at t = 6e-05 s"),
    ],
)
def test_an_fmu_whose_code_is_its_own(deed: str, said: str, library: Path, both: Both) -> None:
    scene = load_scene(str(scene_with(misbehaving(library, "step", deed)))).set({"bearing.isolate": False})
    both.listening = False
    outcome = both.compared(scene)
    assert outcome.reason == (said and f"component bearing: {said}")
    assert outcome.steps == (2 if said else 100)


def test_fmus_of_pythonfmu(both: Both) -> None:
    """Their Python runs within compiled code, which holds the interpreter's lock."""
    both.compared(disk(run__duration=4e-3), in_process=False)


def test_who_refuses_a_step_says_why(both: Both) -> None:
    """A contact that is far too stiff for steps under held loads: it gives up within the step from 1 ms."""
    run = {"duration": 0.1, "macro_step": 1e-4, "scheme": "jacobi-hold", "record_every": 1}
    scene = rotor_on("bushing", {"mass": 1.0, "vy": -1.0}, {"contact.stiffness": 1e12}, **run)
    scene = scene.set({"run.warn_residual": 1e300, "run.stop_residual": 1e300})
    outcome = both.compared(scene)
    assert outcome.reason.startswith("component bearing: ")
    assert "at t = 0.001" in outcome.reason


# -- what is not ---------------------------------------------------------------------------------------


def test_a_sequence_of_ones_own_is_kept(both: Both, monkeypatch: pytest.MonkeyPatch) -> None:
    """One that steps otherwise is taken as it says; one that only counts at the end is not in the way."""

    class Otherwise(GaussSeidel):
        def step(self, number: int, time: float, step: float) -> None:
            super().step(number, time, step)

    scene = rotor_on("bushing", {"mass": 1.0}, duration=1e-3, macro_step=1e-5)
    for kind, stepped in ((GaussSeidel, 1), (Otherwise, 100)):
        monkeypatch.setattr("touchdown.master.coupling.simulation.stepper", kind)
        both.run(scene, both.folder / "r.h5")
        assert both.stepped == stepped


def test_a_method_that_was_replaced_is_called(both: Both) -> None:
    """Of one component, or of its kind."""

    class Late(InProcessComponent):
        def step(self, time: float, step: float) -> None:
            calls.append(time)
            super().step(time, step)

    calls: list[float] = []
    scene = rotor_on("bushing", {"mass": 1.0}, duration=1e-3, macro_step=1e-5)
    for replaced in (False, True):
        with opened(scene, in_process=True) as system:
            rotor = system.components["rotor"]
            assert isinstance(rotor, InProcessComponent)
            if replaced:
                rotor.step = lambda time, step, own=rotor.step: (calls.append(time), own(time, step))[1]
            else:
                rotor.__class__ = Late
            simulate(scene, system)
        assert len(calls) == 100 * (1 + replaced)
