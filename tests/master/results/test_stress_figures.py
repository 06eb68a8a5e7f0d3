"""Stresses of a flexible rotor in a run's figures and pictures."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest

from touchdown.master.coupling.simulation import open_system, simulate
from touchdown.master.coupling.system import System
from touchdown.master.results.final_state import Finished
from touchdown.master.results.recording import Recording
from touchdown.master.results.run import run_scene
from touchdown.master.results.summary import summarise
from touchdown.master.scene.file import load_scene
from touchdown.master.scene.scene import Scene
from touchdown.reports.figures import plot
from touchdown.reports.figures.stress import has_stress

NODES = 25
KEPT = [f"kept_{kind}_{axis}" for kind in ("bending", "shear") for axis in "xy"]
KEYS = {
    "peak_bending_stress", "peak_bending_stress_node", "peak_bending_stress_time",
    "peak_shear_stress", "peak_shear_stress_node", "peak_shear_stress_time", "kept_stress_time",
} | {f"{key}{tail}" for key in KEPT for tail in ("", "_node")}  # fmt: skip
SHUTDOWN = 1e-3  # s


def short(name: str, duration: float) -> Scene:
    """The drop of a rotor whose magnetic bearings shut down at once."""
    scene = load_scene(name).set({"run.duration": duration, "run.record_every": 1})
    for bearing in ("amb_A", "amb_B"):
        scene = scene.set({f"{bearing}.shutdown_time": SHUTDOWN})
    return scene


class Drop(NamedTuple):
    """A run whose components are still there."""

    scene: Scene
    system: System
    recording: Recording
    summary: dict[str, object]

    @property
    def finished(self) -> Finished:
        """For pictures."""
        return Finished(self.scene, self.system, self.recording)


@pytest.fixture(scope="module")
def drop(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Drop]:
    """Rotor II from its shutdown through its first impacts, at 7 ms."""
    scene = short("rotor2-case1", 0.01)
    path = tmp_path_factory.mktemp("run") / "result.h5"
    system = open_system(scene, in_process=True)
    outcome = simulate(scene, system, path)
    recording = Recording(path)
    yield Drop(scene, system, recording, summarise(scene, system, outcome, recording))
    recording.close()
    system.close()


def node(recording: Recording, variable: str) -> np.ndarray:
    """Of every node."""
    return np.array([recording.at_end(f"rotor.node[{k}].{variable}") for k in range(1, NODES + 1)])


def test_the_summary_tells_the_largest_stresses(drop: Drop) -> None:
    summary, recording = drop.summary["components"]["rotor"], drop.recording
    assert summary.keys() >= KEYS
    for kind in ("bending", "shear"):
        peaks = node(recording, f"peak_{kind}")
        history = recording[f"rotor.stress.{kind}"]  # at the ends of macro steps
        assert summary[f"peak_{kind}_stress"] == pytest.approx(peaks.max(), rel=1e-12)
        assert 1.0 <= summary[f"peak_{kind}_stress"] / history.max() < 1.01
        assert summary[f"peak_{kind}_stress_node"] == 1 + np.argmax(peaks)
        when = recording.time[np.argmax(history)]
        assert summary[f"peak_{kind}_stress_time"] == pytest.approx(when, abs=drop.scene.run.macro_step)
        assert when > drop.summary["seats"]["B"]["first_contact_time"]


def test_the_summary_tells_the_stresses_at_the_kept_instant(drop: Drop) -> None:
    stresses, recording = drop.summary["components"]["rotor"], drop.recording
    kept = recording.at_end("rotor.stress.kept_time") - SHUTDOWN
    assert stresses["kept_stress_time"] == pytest.approx(kept)
    for key in KEPT:
        values = np.abs(node(recording, key.removeprefix("kept_")))
        assert stresses[key] == pytest.approx(values.max(), rel=1e-12)
        assert stresses[f"{key}_node"] == 1 + np.argmax(values)
        assert values.max() > 0.0
    largest = np.hypot(node(recording, "bending_x"), node(recording, "bending_y"))
    assert (largest <= node(recording, "peak_bending") * (1.0 + 1e-9)).all()


def test_no_stress_was_computed() -> None:
    scene = short("rotor2-case1", 1e-3).set({"rotor.stress.active": 0})
    result = run_scene(scene, None, in_process=True)
    assert {result.summary["components"]["rotor"][key] for key in KEYS} == {None}
    assert not has_stress(result.ending, "rotor")


def test_a_rigid_rotor_has_no_stresses(tmp_path: Path) -> None:
    scene = load_scene("disk-caged-simplified").set({"run.duration": 1e-3})
    assert not run_scene(scene, tmp_path, in_process=True).summary.keys() & KEYS


def test_a_run_with_two_seats_has_all_its_pictures(drop: Drop) -> None:
    made = {name for name, _ in plot._pictures(drop.finished)}
    own = {f"{name}-bearing_{seat}" for name in ("orbit", "force", "speeds") for seat in "AB"}
    assert made == own | {"orbits", "stress", "energy"}
