"""Runs that end once they have settled, and drops beside each other: short real ones."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from touchdown.master.common.errors import Ended, TouchdownError
from touchdown.master.results.result import Result
from touchdown.master.results.run import run_scene
from touchdown.master.scene.file import load_scene
from touchdown.master.scene.scene import Scene
from touchdown.studies.drop.spread import spread, spread_lines
from touchdown.studies.verdict.study import answering

STOPPED_AT = 0.05  # s, while A whirls from 0.007 to 0.063 s
COLUMNS = ("time", "rotor.A.x", "bearing_A.contact.force", "bearing_B.contact.peak_force")


def out_of_line(**run: object) -> Scene:
    """Rotor I at 9000 rpm, bearings out of line by 450 um: A whirls for a while, and swings on."""
    scene = load_scene("rotor1-9000-225um").set({"run.macro_step": 4e-5})
    return scene.set({f"run.{key}": value for key, value in run.items()})


def ran(scene: Scene) -> Result:
    return run_scene(scene, None, in_process=True)


@pytest.fixture(scope="module")
def settled() -> Result:
    return ran(out_of_line(duration=3.0, until="settled"))


def test_it_ends_once_it_has_settled(settled: Result) -> None:
    summary = settled.summary
    assert settled.ended is Ended.COMPLETED
    assert settled.warnings == []
    assert 0.07 < summary["settling_time"] < summary["end_time"] < 2.0
    assert summary["proposed_duration"] is None
    assert summary["seats"]["A"]["whirl"].startswith("transient backward whirl, ")


def test_a_run_that_stops_before_names_its_time(settled: Result) -> None:
    """And is the same up to there, to the bit."""
    short = ran(out_of_line(duration=STOPPED_AT))
    assert short.summary["seats"]["A"]["whirl"].startswith("backward whirl, at 0.05 s still whirling, ")
    assert short.summary["settling_time"] is None
    assert short.summary["proposed_duration"] > STOPPED_AT
    assert short.summary["seats"]["A"]["pendulum_frequency"] is None
    for name in COLUMNS[1:]:
        values = short.recording[name]
        np.testing.assert_array_equal(values[:-1], settled.recording[name][: len(values) - 1])


def test_the_duration_is_the_most() -> None:
    run = ran(load_scene("disk-caged-simplified").set({"run.duration": 0.1, "run.until": "settled"}))
    assert run.summary["end_time"] == pytest.approx(0.1)
    (warning,) = run.warnings
    assert "not settled" in warning
    assert "run.duration = 0.1 s" in warning


def test_what_cannot_settle_is_refused() -> None:
    scene = load_scene("disk-caged-simplified")
    with pytest.raises(TouchdownError, match=r"run\.until = 'setled' is not known; did you mean settled"):
        scene.set({"run.until": "setled"})


def test_a_study_chooses_a_duration_that_answers() -> None:
    scene = load_scene("disk-caged-simplified")
    chosen = answering(scene).run
    assert (chosen.until, chosen.duration) == ("settled", 4.0 * scene.run.duration)
    mine = scene.set({"run.duration": 0.1})
    assert answering(mine) is mine


def test_first_impacts_are_firm_where_whole_drops_are_not(tmp_path: Path) -> None:
    """Starts 1 and 2 nm away: first impacts differ by less than 0.1 %, peaks at A by more than 1 %."""
    scene = load_scene("rotor1-9000").set({"run.duration": 0.022})
    run = run_scene(scene, tmp_path, in_process=True)
    assert spread(run, 2, jobs=1) == []
    found = json.loads((tmp_path / "summary.json").read_text(encoding="utf-8"))["spread"]
    assert found["siblings"] == 2
    first, whole = (found["quantities"][f"seats.A.{key}_contact_force"] for key in ("first_impact", "peak"))
    assert 1.0 <= first["most"] / first["least"] < 1.001
    assert whole["most"] / whole["least"] > 1.01
    assert whole["least"] <= run.summary["seats"]["A"]["peak_contact_force"] <= whole["most"]
    lines = list(spread_lines(run.summary))
    assert lines[0] == "over this run and 2 siblings (the same drop, its start shifted in steps of 1 nm):"
    assert any("largest contact force, A" in line and "median" in line for line in lines)


def test_a_spread_needs_siblings() -> None:
    run = ran(load_scene("disk-caged-simplified").set({"run.duration": 0.01}))
    with pytest.raises(TouchdownError, match="one sibling at least, not 0"):
        spread(run, 0)
