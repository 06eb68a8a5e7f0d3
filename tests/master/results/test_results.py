"""What a run leaves behind."""

from __future__ import annotations

import json

import numpy as np
import pytest

from touchdown.master.results.result import Result
from touchdown.master.results.run import run_scene
from touchdown.master.results.summary import dominant_frequency
from touchdown.master.scene.file import load_scene
from touchdown.reports.figures.plot import draw_all

REQUIRED = {
    *("energy_residual_relative", "wall_time", "simulated_time", "scheme", "macro_step"),
    "components.rotor.speed_end",
    *(f"seats.A.{key}" for key in (
        "first_contact_time", "first_contact_speed", "peak_contact_force", "peak_indentation_rotor_ring",
        "peak_indentation_rings", "ring_sync_time", "pendulum_frequency", "loaded_balls_end", "whirl",
        "whirl_revolutions", "whirl_radius", "whirl_frequency", "whirl_largest_force",
        "whirl_force_phase", "most_turns_one_way",
    )),
}  # fmt: skip


@pytest.fixture(scope="module")
def result(tmp_path_factory: pytest.TempPathFactory) -> Result:
    """A short drop with everything written."""
    run = {"run.duration": 0.2, "run.macro_step": 2e-5, "run.record_every": 2}
    scene = load_scene("disk-caged-simplified").set(run)
    return run_scene(scene, tmp_path_factory.mktemp("run"), in_process=True, draw=draw_all)


def test_the_summary_has_its_figures(result: Result) -> None:
    summary = json.loads((result.folder / "summary.json").read_text(encoding="utf-8"))
    assert result.flat.keys() >= REQUIRED
    assert summary == result.summary
    assert summary["completed"] is True
    assert summary["simulated_time"] == pytest.approx(0.205)
    assert summary["energy_balance_relative"] < 1e-3
    seat = summary["seats"]["A"]
    told = [seat[f"whirl{key}"] for key in ("", "_revolutions", "_largest_force", "_episodes")]
    assert told == ["pendulum", 0.0, None, []]


def test_pictures_are_drawn(result: Result) -> None:
    assert {p.name for p in result.pictures} == {"orbit.png", "force.png", "speeds.png", "energy.png"}
    for picture in result.pictures:
        assert picture.read_bytes().startswith(b"\x89PNG")
        assert picture.stat().st_size > 10_000


@pytest.mark.parametrize("frequency", [14.3, 61.2])
def test_the_dominant_frequency_is_found(frequency: float) -> None:
    time = np.arange(0.0, 1.0, 1e-4)
    noise = np.random.default_rng(1).normal(0.0, 0.1, len(time))
    values = (
        5.0 + np.cos(2 * np.pi * frequency * time) + 0.3 * np.cos(2 * np.pi * 2 * frequency * time) + noise
    )
    assert dominant_frequency(time, values) == pytest.approx(frequency, abs=0.05)


def test_too_short_a_run_has_no_frequency() -> None:
    time = np.arange(0.0, 0.01, 1e-4)
    assert dominant_frequency(time, np.sin(time)) is None


def test_a_silent_run_has_no_frequency() -> None:
    time = np.arange(0.0, 1.0, 1e-3)
    assert dominant_frequency(time, np.zeros_like(time)) is None
