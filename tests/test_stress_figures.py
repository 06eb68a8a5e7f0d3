"""Stresses of a flexible rotor in a run's figures and pictures."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from master.recording import Recording
from master.run import Result, run_scene
from master.scene import Scene, load

NODES = 25
KEPT = [f"kept_{kind}_{axis}" for kind in ("bending", "shear") for axis in "xy"]
KEYS = {
    "peak_bending_stress_MPa", "peak_bending_stress_node", "peak_bending_stress_time_s",
    "peak_shear_stress_MPa", "peak_shear_stress_node", "peak_shear_stress_time_s", "kept_stress_time_s",
} | {f"{key}_{tail}" for key in KEPT for tail in ("MPa", "node")}  # fmt: skip
SHUTDOWN = 1e-3  # s


def short(name: str, duration: float) -> Scene:
    """The drop of a rotor whose magnetic bearings shut down at once."""
    scene = load(name).with_setting("run.duration", duration).with_setting("run.record_every", 1)
    for bearing in ("amb_A", "amb_B"):
        scene = scene.with_setting(f"{bearing}.shutdown_time", SHUTDOWN)
    return scene


@pytest.fixture(scope="module")
def result(tmp_path_factory: pytest.TempPathFactory) -> Result:
    """Rotor II from its shutdown through its first impacts, at 7 ms."""
    return run_scene(short("rotor2-case1", 0.01), tmp_path_factory.mktemp("run"), in_process=True)


def node(recording: Recording, variable: str) -> np.ndarray:
    """Of every node."""
    return np.array([recording.at_end(f"rotor.node[{k}].{variable}") for k in range(1, NODES + 1)])


def test_the_summary_tells_the_largest_stresses(result: Result) -> None:
    summary = result.summary
    assert summary.keys() >= KEYS
    recording = Recording(result.folder / "result.h5")
    for kind in ("bending", "shear"):
        peaks = node(recording, f"peak_{kind}")
        history = recording[f"rotor.stress.{kind}"]
        assert summary[f"peak_{kind}_stress_MPa"] == pytest.approx(1e-6 * peaks.max(), rel=1e-12)
        assert summary[f"peak_{kind}_stress_MPa"] == pytest.approx(1e-6 * history.max(), rel=1e-12)
        assert summary[f"peak_{kind}_stress_node"] == 1 + np.argmax(peaks)
        when = recording.time[np.argmax(history)]
        assert summary[f"peak_{kind}_stress_time_s"] == pytest.approx(when, abs=1e-9)
        assert when > summary["first_contact_time_s_bearing_B"]
    recording.close()


def test_the_summary_tells_the_stresses_at_the_kept_instant(result: Result) -> None:
    recording = Recording(result.folder / "result.h5")
    kept = recording.at_end("rotor.stress.kept_time") - SHUTDOWN
    assert result.summary["kept_stress_time_s"] == pytest.approx(kept)
    for key in KEPT:
        values = np.abs(node(recording, key.removeprefix("kept_")))
        assert result.summary[f"{key}_MPa"] == pytest.approx(1e-6 * values.max(), rel=1e-12)
        assert result.summary[f"{key}_node"] == 1 + np.argmax(values)
        assert values.max() > 0.0
    largest = np.hypot(node(recording, "bending_x"), node(recording, "bending_y"))
    assert (largest <= node(recording, "peak_bending") * (1.0 + 1e-9)).all()
    recording.close()


def test_no_stress_was_computed(tmp_path: Path) -> None:
    scene = short("rotor2-case1", 1e-3).with_setting("rotor.stress.active", 0)
    result = run_scene(scene, tmp_path, in_process=True)
    assert {result.summary[key] for key in KEYS} == {None}
    assert "stress.png" not in {p.name for p in result.pictures}


def test_a_rigid_rotor_has_no_stresses(tmp_path: Path) -> None:
    scene = load("disk-caged-simplified").with_setting("run.duration", 1e-3)
    assert not run_scene(scene, tmp_path, in_process=True, pictures=False).summary.keys() & KEYS
