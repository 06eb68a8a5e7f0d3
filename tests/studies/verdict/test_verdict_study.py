"""Verdicts over the phase of the unbalance: what is run, what is reported, the command."""

from __future__ import annotations

import csv
import json
import math
from collections.abc import Callable, Sequence
from pathlib import Path

import pytest

from touchdown.command.cli import main
from touchdown.master.common.errors import Ended, TouchdownError
from touchdown.master.common.progress import Progress
from touchdown.master.results.whirl.verdict import TOO_COARSE, worst_whirl
from touchdown.master.scene.file import load_scene
from touchdown.master.scene.scene import Scene
from touchdown.studies.rotor.supports import balanced
from touchdown.studies.sweep.members import Member
from touchdown.studies.sweep.tasks import Running, Task
from touchdown.studies.verdict import study as verdict_study
from touchdown.studies.verdict.study import (
    Circle,
    Plan,
    Window,
    edges,
    study_verdict,
    windows,
)
from touchdown.studies.verdict.verdict_report import findings, report_lines, whirls_in_words
from touchdown.validation.dissertation import whirl_shares
from touchdown.validation.dissertation.drop_cache import Drops

DISK = "disk-caged-simplified"
ECCENTRIC = {"rotor.eccentricity": "5 um", "run.duration": "10 ms"}
WHIRL = "backward whirl, still so at the end"


def summary(words: str, turns: float, force: float = 100.0, residual: float = 1e-6) -> dict[str, object]:
    """Of a run whose seat A does so, while B swings."""
    first = {"peak_contact_force": force, "first_impact_contact_force": 700.0, **seat(words, turns)}
    second = {"peak_contact_force": 50.0, "first_impact_contact_force": 650.0, **seat("pendulum", 0.0)}
    return {"seats": {"A": first, "B": second}, "energy_residual_of_turnover": residual}


def seat(words: str | None, turns: float | None) -> dict[str, object]:
    """The verdict on a seat."""
    return {"whirl": words, "whirl_revolutions": turns, "whirl_trend": None}


def seats(*verdicts: tuple[str | None, float | None]) -> dict[str, object]:
    """A summary of seats with no more than their verdicts."""
    return {"seats": {name: seat(*one) for name, one in zip("AB", verdicts, strict=False)}}


def angle(task: Task) -> float:
    """The phase (deg) that a task sets."""
    return float(str(task.settings["rotor.unbalance_angle"]).removesuffix(" deg"))


def pretended(
    monkeypatch: pytest.MonkeyPatch, whirls: Callable[[float, float], bool], failing: Sequence[float] = ()
) -> list[Task]:
    """Runs that whirl by a rule of phase (deg) and macro step (s); returns those asked for."""
    asked: list[Task] = []

    def run(task: Task) -> Member:
        if angle(task) in failing:
            return Member(0, task.settings, {}, "it broke", Ended.STOPPED)
        whirl = whirls(angle(task), task.scene.run.macro_step)
        told = summary(WHIRL, 20.0, 12e3, residual=0.5) if whirl else summary("pendulum", 0.0)
        return Member(0, task.settings, told)

    def run_tasks(tasks: Sequence[Task], running: Running, done: Callable[[], object]) -> list[Member]:
        asked.extend(tasks)
        for _ in tasks:
            done()
        return [run(task) for task in tasks]

    monkeypatch.setattr(verdict_study, "run_tasks", run_tasks)
    return asked


@pytest.fixture(scope="module")
def scene() -> Scene:
    return load_scene("rotor1-9000").set({"rotor.unbalance_angle": "2 deg"})


def test_a_study_refines_edges_at_every_step(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, scene: Scene
) -> None:
    """The window begins 10 degrees later with the longer step; the reference has adaptive bearings."""
    asked = pretended(monkeypatch, lambda phase, step: (10.0 if step > 3e-5 else 0.0) < phase < 50.0)
    planned, done = [], []
    progress = Progress(planned.append, lambda: done.append(1))
    study = study_verdict(scene, Plan(12.0, 4.0, (20e-6, 40e-6), 5e-6), tmp_path, progress=progress)
    assert study.phase == pytest.approx(2.0)
    assert [c.title for c in study.circles] == [
        "macro step 20 us",
        "macro step 40 us",
        "macro step 5 us, adaptive steps inside the bearings",
    ]
    for circle, begin in zip(study.circles, (0.0, 10.0, 0.0), strict=True):
        first, last = edges(circle.verdicts)
        assert first.gap <= 4.0 >= last.gap
        assert first.middle == pytest.approx(begin, abs=2.0) or first.middle > 358.0
        assert last.middle == pytest.approx(50.0, abs=2.0)
        assert len(circle.members) == 30 + 4
    assert sum(planned) == len(done) == 102
    assert len({task.folder for task in asked}) == 102
    for task in asked:
        adaptive = task.scene.run.macro_step == 5e-6
        assert (task.scene.components["bearing_A"].set.get("micro_step") == 0.0) == adaptive
        recorded = task.scene.run.record_every * task.scene.run.macro_step
        assert recorded == pytest.approx(scene.run.record_every * scene.run.macro_step)
    text = "\n".join(report_lines(study))
    assert "2 edges against the reference's 2, at most 9 deg off; outliers 0 of 34 against 0 of 34" in text
    assert "largest contact force, first impact: 700 N to 700 N over the phases" in text
    assert "largest contact force, whole drop: " in text
    assert " to 12.0 kN over the phases" in text
    passed = "the energy ledger passed 0.2 of a connection's turnover"
    assert f"of them {passed}, at which a run of the scene stops" in text
    own = "phase 2 deg, the scene's own, with macro step"
    assert f"{own} 20 us: backward whirl, still so at the end, near an edge, at 0.5 (359 to 2) deg" in text
    assert f"{own} 40 us: no whirl, near an edge, at 9.5 (8 to 11) deg" in text


def test_a_run_that_fails_has_no_verdict_and_is_told(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, scene: Scene
) -> None:
    pretended(monkeypatch, lambda phase, step: 100.0 < phase < 200.0, failing=(2.0, 98.0))
    study = study_verdict(scene.set({"rotor.speed": 9000}), Plan(), tmp_path)
    assert [remark.partition(" rpm")[0] for remark in study.remarks] == ["rotor.speed = 85944"]
    (circle,) = study.circles
    assert circle.failed == {2.0: "it broke", 98.0: "it broke"}
    assert len(windows(circle.verdicts)) == 1
    text = "\n".join(report_lines(study))
    assert "98 deg failed: it broke" in text
    assert "in 9 of them the energy ledger" in text
    assert "the scene's own" not in text


def test_the_scenes_own_phase_far_from_edges_and_as_a_stray(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, scene: Scene
) -> None:
    pretended(monkeypatch, lambda phase, step: 100.0 < phase < 200.0)
    far = "\n".join(report_lines(study_verdict(scene, Plan(), tmp_path)))
    assert "40 us: no whirl, 97.5 deg from the nearest edge" in far
    pretended(monkeypatch, lambda phase, step: phase == 2.0)
    alone = "\n".join(report_lines(study_verdict(scene, Plan(), tmp_path)))
    assert "outliers, alone among the others: 2 deg (backward whirl, still so at the end)" in alone
    assert "40 us: backward whirl, still so at the end, an outlier, alone among the others" in alone


def test_after_an_interrupt_what_is_there_is_told(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, scene: Scene
) -> None:
    def interrupted(tasks: Sequence[Task], running: Running, done: Callable[[], object]) -> list[Member]:
        stopped = Member(0, {}, {}, "interrupted", Ended.INTERRUPTED)
        ran = [Member(0, task.settings, summary(WHIRL, 9.0)) for task in tasks[:10]]
        return ran + [stopped] * (len(tasks) - 10)

    monkeypatch.setattr(verdict_study, "run_tasks", interrupted)
    study = study_verdict(scene, Plan(), tmp_path)
    assert study.interrupted
    assert len(study.circles[0].verdicts) == 10
    assert study.circles[0].failed == {}
    findings(study).write(tmp_path)
    assert json.loads((tmp_path / "verdict.json").read_text())["interrupted"] is True


def test_tables_have_every_run(monkeypatch: pytest.MonkeyPatch, tmp_path: Path, scene: Scene) -> None:
    pretended(monkeypatch, lambda phase, step: 100.0 < phase < 200.0)
    study = study_verdict(scene, Plan(30.0, 10.0), tmp_path)
    findings(study).write(tmp_path)
    with (tmp_path / "phases.csv").open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert [float(row["phase [deg]"]) for row in rows] == sorted(study.circles[0].members)
    assert {row["verdict"] for row in rows} == {WHIRL, "no whirl"}
    assert {row["largest_contact_force [N]"] for row in rows} == {"12000.0", "100.0"}
    assert {row["seats.B.first_impact_contact_force [N]"] for row in rows} == {"650.0"}
    plain = json.loads((tmp_path / "verdict.json").read_text())
    (window,) = plain["circles"][0]["windows_deg"]
    assert window["begin"][0] < 100.0 < window["begin"][1]
    assert window["width"] == pytest.approx(100.0, abs=10.0)
    assert 0.0 < plain["circles"][0]["share"]["low"] < 100.0 / 360.0
    assert (tmp_path / "verdict.png").stat().st_size > 10_000
    assert list(study.data["steps"].values) == ["macro step 40 us"] * len(rows)
    assert study.data["rotor.unbalance_angle"].values == pytest.approx(
        [math.radians(float(row["phase [deg]"])) for row in rows]
    )
    assert study.data["run.macro_step"].values == pytest.approx(4e-5)


@pytest.mark.parametrize(
    ("told", "words"),
    [
        (summary(WHIRL, 20.0), WHIRL),
        (summary("pendulum", 0.0), ""),
        (summary("no whirl, short of one turn: 0.9 turn backward", 0.0), ""),
        (seats(("transient forward whirl", 2.0), (WHIRL, 1.5)), WHIRL),
        (seats((WHIRL, 2.0), ("transient forward whirl", 9.0)), WHIRL),
        (seats((None, None)), ""),
        ({}, ""),
    ],
)
def test_the_verdict_of_a_run_is_that_of_the_seat_that_whirls(told: dict[str, object], words: str) -> None:
    assert worst_whirl(told) == words


def test_what_a_circle_makes_of_its_runs() -> None:
    members = {0.0: Member(1, {}, summary(TOO_COARSE, 0.0)), 90.0: Member(2, {}, summary("pendulum", 0.0))}
    circle = Circle("made", members)
    assert circle.verdicts == {90.0: ""}
    assert circle.failed == {0.0: "cannot tell: sampled too coarsely"}
    members = {0.0: Member(1, {}, summary(WHIRL, 2.0, 300.0, 0.2)), 90.0: Member(2, {}, summary("", 0.0))}
    circle = Circle("made", members)
    assert circle.largest_force() == 300.0
    assert [circle.over_the_limit(limit) for limit in (1e-9, 0.1, 1.0)] == [2, 1, 0]
    silent = {"seats": {"A": {"peak_contact_force": None}}}
    assert Circle("made", {0.0: Member(1, {}, silent)}).largest_force() is None


def test_nothing_to_turn(tmp_path: Path) -> None:
    """Of a shaft without any unbalance it shows only in that turning it changes nothing."""
    whole, file = load_scene("rotor1-9000"), tmp_path / "balanced.toml"
    text = (Path(verdict_study.__file__).parents[2] / "rotor/data/rotor_I.toml").read_text()
    file.write_text(text.partition("[[unbalance]]")[0] + "[stations]" + text.partition("[stations]")[2])
    shaft = whole.swap(rotor=str(file))
    for scene in (load_scene(DISK), whole.set({"rotor.unbalance_scale": 0}), shaft):
        with pytest.raises(TouchdownError, match="no rotor with an unbalance: nothing to turn"):
            study_verdict(scene, Plan(), tmp_path / "out")
    assert not (tmp_path / "out").exists()
    balance = [balanced(scene, ["rotor"]) for scene in (shaft, whole, load_scene(DISK))]
    assert balance == [True, False, False]  # the last is rigid


@pytest.mark.slow
def test_the_command_on_a_disk_that_settles(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    """Whole, with its processes: short drops of an eccentric disk."""
    settings = [part for name, value in ECCENTRIC.items() for part in ("--set", f"{name}={value}")]
    options = ("--grid", "120 deg", "--in-process", "--quiet")
    assert main(["verdict", DISK, *settings, *options, "-o", str(tmp_path)]) == 0
    shown = capsys.readouterr().out
    assert "macro step 100 us: 3 runs" in shown
    assert "no window whirls" in shown
    assert "share of phases that whirl: 0 %; 0 % to 70.8 % with 95% confidence" in shown
    assert (
        "phase 0 deg, the scene's own, with macro step 100 us: no whirl, and no edge between the phases run"
        in shown
    )
    summaries = sorted(tmp_path.glob("100us/*/summary.json"))
    assert [path.parent.name for path in summaries] == ["000.000", "120.000", "240.000"]
    forces = {json.loads(path.read_text())["seats"]["A"]["peak_contact_force"] for path in summaries}
    assert len(forces) == 3  # turning it does something


@pytest.mark.parametrize(
    ("kinds", "said"),
    [
        ("SS", "2 x S whirl"),
        ("SST", "0 to 10 S whirl, 20 to 20 T whirl"),
        ("TSST", "0 to 0 T whirl, 10 to 20 S whirl, 30 to 30 T whirl"),
        ("STSTSS", "4 x S whirl, 2 x T whirl"),
    ],
)
def test_the_ways_a_window_whirls(kinds: str, said: str) -> None:
    verdicts = {10.0 * i: f"{kind} whirl" for i, kind in enumerate(kinds)}
    assert whirls_in_words(verdicts, Window(None, None, tuple(verdicts))) == said


@pytest.mark.slow
def test_fig_14_is_counted_over_phases_that_resolve_windows(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    pretended(monkeypatch, lambda phase, step: 90.0 < phase < 180.0)
    monkeypatch.setattr(whirl_shares, "PLAN", Plan(30.0, 10.0))
    monkeypatch.setattr(whirl_shares, "SPEEDS", whirl_shares.SPEEDS[:1])
    monkeypatch.setattr(whirl_shares, "stress_readings", lambda _, members: [f"{members} phases"])
    found = whirl_shares.rotors(Drops(tmp_path, 1, members=4))
    assert len(found.rows) == len(whirl_shares.SPEEDS) * len(whirl_shares.SOURCE)
    first, last = found.rows[0], found.rows[-1]
    assert first.quantity.startswith("9000 rpm, bearings off by -+0 um")
    assert first.conclusion.startswith("differs: so at ")
    assert "22.9 %; " in str(first.ours)  # 90 of 360 deg, edges to within 7.5
    assert "12.0 kN" in str(last.ours)
    assert str(last.ours).endswith(f"6 x {WHIRL}")
    assert found.lines[-1] == "4 phases"
