"""Threads that step bearings beside each other change nothing but the time that it takes."""

from __future__ import annotations

import os
import threading
from dataclasses import replace
from pathlib import Path

import pytest
from systems import bits, rotor_on

from touchdown.master.common.ended import Ended
from touchdown.master.coupling.loop import helpers
from touchdown.master.coupling.simulation import Outcome, opened, simulate
from touchdown.master.scene.file import load_scene
from touchdown.master.scene.scene import Scene

UNLIKE = {"wall_time": 0.0, "start_up": 0.0}  # of two equal runs


def landing(**settings: object) -> Scene:
    """Rotor I from before the shutdown, where magnetic bearings retire, to after its first impacts."""
    scene = load_scene("rotor1-9000").set({f"amb_{end}.shutdown_time": 1e-3 for end in "AB"})
    return scene.set({"run.duration": 8e-3} | {k.replace("__", "."): v for k, v in settings.items()})


def native(scene: Scene) -> Scene:
    parts = scene.components.items()
    return replace(scene, components={name: replace(spec, native=True) for name, spec in parts})


class Threads:
    """Runs scenes with a number of threads, and counts the helpers who were called."""

    def __init__(self, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        self.folder, self._patch, self.called = folder, monkeypatch, 0

    def run(self, scene: Scene, count: int, in_process: bool = True) -> tuple[Outcome, dict[str, object]]:
        self._patch.setenv(helpers.THREADS, str(count))
        call, self.called = helpers.Helpers.call, 0

        def counting(self_: helpers.Helpers) -> None:
            self.called += 1
            call(self_)

        path = self.folder / f"{count}.h5"
        with self._patch.context() as patch, opened(scene, in_process) as system:
            patch.setattr(helpers.Helpers, "call", counting)
            outcome = simulate(scene, system, path)
        assert not [t for t in threading.enumerate() if t.name.startswith("touchdown-helper")]
        return replace(outcome, **UNLIKE), bits(path)

    def compared(self, scene: Scene, in_process: bool = True) -> Outcome:
        """The outcome, once a run with helpers and one without left the same behind."""
        alone = self.run(scene, 1, in_process)
        assert not self.called
        beside = self.run(scene, 2, in_process)
        assert self.called
        assert repr(beside[0]) == repr(alone[0])
        if beside[0].ended is not Ended.COMPLETED:  # who stepped beside the one that failed did step
            for _, left in (alone, beside):
                for name in [name for name in left if name.startswith("at_end")]:
                    del left[name]
        assert beside[1] == alone[1]
        return beside[0]


@pytest.fixture
def threads(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Threads:
    return Threads(tmp_path, monkeypatch)


@pytest.mark.parametrize("scheme", ["interface", "jacobi-lead"])
def test_equal_to_the_bit(scheme: str, threads: Threads) -> None:
    outcome = threads.compared(landing(run__scheme=scheme))
    assert outcome.ended is Ended.COMPLETED


def test_bearings_of_macro_steps_of_their_own(threads: Threads) -> None:
    threads.compared(landing(run__macro_step="20 us", bearing_B__every=2))


def test_native_fmus(threads: Threads) -> None:
    threads.compared(native(landing(run__duration=4e-3)), in_process=False)


def test_who_refuses_a_step_says_why(threads: Threads) -> None:
    """By contacts that are far too stiff for steps under held loads."""
    scene = landing(run__scheme="jacobi-hold", run__macro_step=1e-4, run__impact_step=0.0)
    scene = scene.swap(bearing_A="bushing", bearing_B="bushing")
    scene = scene.set({f"bearing_{end}.contact.stiffness": 1e12 for end in "AB"})
    scene = scene.set({"run.duration": 0.1, "run.warn_residual": 1e300, "run.stop_residual": 1e300})
    outcome = threads.compared(scene)
    assert outcome.ended is Ended.STOPPED
    assert outcome.reason.startswith("component bearing_B: more than")


def test_helpers_leave_and_come_back(threads: Threads, monkeypatch: pytest.MonkeyPatch) -> None:
    """With no patience at all they are gone before each stretch."""
    monkeypatch.setattr(helpers, "PATIENCE", 0)
    threads.compared(landing(run__duration=3e-3))


def test_one_bearing_needs_no_helper(threads: Threads) -> None:
    threads.run(rotor_on("bushing", {"mass": 1.0}, duration=2e-3, macro_step=1e-5), 4)
    assert not threads.called


def test_fmus_in_python_get_no_helper(threads: Threads) -> None:
    """They need the interpreter's lock, one at a time."""
    threads.run(landing(run__duration=2e-3), 2, in_process=False)
    assert not threads.called


# -- how many ------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("given", "allowed"), [("3", 3), ("2,4", 2), ("1", 1)])
def test_the_environment_says_how_many(given: str, allowed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(helpers.THREADS, given)
    assert helpers.threads() == allowed


@pytest.mark.parametrize("given", ["", "0", "many", "-1"])
@pytest.mark.parametrize(
    ("quota", "allowed"), [("max 100000", 8), ("250000 100000", 2), ("50000 100000", 1), (None, 8)]
)
def test_else_the_machine_does(
    given: str, quota: str | None, allowed: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its processors, or what a container is given of them."""
    monkeypatch.setenv(helpers.THREADS, given)
    monkeypatch.setattr(os, "sched_getaffinity", lambda process: set(range(8)))
    monkeypatch.setattr(helpers, "QUOTA", tmp_path / "cpu.max")
    if quota is not None:
        (tmp_path / "cpu.max").write_text(quota + "\n", "utf-8")
    assert helpers.threads() == allowed
