"""`touchdown compare` of each kind: what it prints and writes."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import cast

import pytest
from commands import records

from touchdown.command.cli import main
from touchdown.master.common.errors import STOPPED, Ended
from touchdown.master.common.pool import INTERRUPTED, TaskOutcome
from touchdown.master.scene.schemes import SCHEMES
from touchdown.studies.comparison import models, schemes, stability
from touchdown.studies.comparison.stability_cases import STEPS
from touchdown.studies.drop.reference import FIRST_SOLVER, SECOND_SOLVER_OF_MANY

DISK = "disk-caged-simplified"
BOUNCE = ("--of", "stability", "--cases", "bounce", "--schemes", "interface,hold")


def compare(folder: Path, *arguments: str) -> int:
    return main(["compare", *arguments, "--quiet", "-o", str(folder)])


def test_schemes(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(schemes, "pair", lambda scene: (FIRST_SOLVER, SECOND_SOLVER_OF_MANY))
    asked = ("--schemes", "hold,interface", "--macro-steps", "20,40,100 us", "--repeat", "1")
    assert compare(tmp_path, DISK, *asked, "--duration", "1 ms") == 0
    shown = capsys.readouterr().out
    assert "1 ms after the first contact" in shown
    assert "through FMUs" in shown
    rows = records(tmp_path / "schemes.csv")
    assert [float(r["macro_step_s"]) for r in rows[:3]] == pytest.approx([2e-5, 4e-5, 1e-4])
    assert {r["variant"] for r in rows} >= {"hold", "interface", "DOP853 1e-09"}
    assert all(float(r["wall_time_per_simulated_s"]) > 0.0 for r in rows)
    assert len(records(tmp_path / "orders.csv")) == 10
    assert (tmp_path / "schemes.png").stat().st_size > 10_000


def test_models(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    every = models.variants
    monkeypatch.setattr(models, "variants", lambda scene: every(scene)[:2])
    asked = ("--of", "models", "--repeat", "1", "--duration", "2 ms", "--set", "run.macro_step=20 us")
    assert compare(tmp_path, DISK, *asked) == 0
    shown = capsys.readouterr().out
    assert "largest orbit" in shown
    assert "macro step of 40 us" in shown
    rows = records(tmp_path / "models.csv")
    assert [r["variant"] for r in rows] == ["macro step of 10 us", "macro step of 40 us", "unchanged"]
    assert float(rows[2]["wall_time_per_simulated_s"]) > 0.0
    assert abs(float(rows[1]["force_change_relative"])) < 0.01
    assert (tmp_path / "models.png").stat().st_size > 10_000


def test_steps(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert compare(tmp_path, DISK, "--of", "steps") == 0
    shown = capsys.readouterr()
    assert "with" not in shown.err
    assert any(line.startswith("scheme ") for line in shown.out.splitlines())
    rows = records(tmp_path / "steps.csv")
    assert [row["variant"] for row in rows] == list(SCHEMES)
    assert [float(row["angle_limit_rad"]) for row in rows] == [s.angle_limit for s in SCHEMES.values()]
    assert all(1e-9 < float(row["macro_step_s"]) <= 1e-4 for row in rows)


@pytest.mark.slow
def test_stability(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert compare(tmp_path, *BOUNCE) == 0
    out = capsys.readouterr().out
    bounce = next(line.split() for line in out.splitlines() if line.startswith("bounce  "))
    assert bounce == ["bounce", "1000/1000", "10/100"]
    rows = records(tmp_path / "limits.csv")
    assert [row["scheme"] for row in rows] == ["interface", "hold"]
    assert [float(row["largest_right_macro_step_s"]) for row in rows] == [1e-3, 1e-5]
    assert [row["ledger_warned_at_first_wrong"] for row in rows] == ["", "1"]
    runs = records(tmp_path / "stability.csv")
    assert [float(run["macro_step_s"]) for run in runs if run["variant"] == "interface"] == list(STEPS[4:])
    assert runs[0]["remark"].startswith("rebound speed 0.0999")


def test_what_is_done_stays_after_ctrl_c(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def one_then_ctrl_c(work: object, tasks: list[object], *_: object) -> list[TaskOutcome[object]]:
        done = [TaskOutcome(cast(Callable[[object], object], work)(task)) for task in tasks[:1]]
        return [*done, *(INTERRUPTED for _ in tasks[1:])]

    monkeypatch.setattr(stability, "run_all", one_then_ctrl_c)
    assert compare(tmp_path, *BOUNCE) == 130
    captured = capsys.readouterr()
    assert captured.err == "touchdown: interrupted\n"
    assert "failed: bounce with hold: interrupted" in captured.out
    assert len(records(tmp_path / "limits.csv")) == 1


def test_a_case_without_reference_fails_alone(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    broke = TaskOutcome(None, Ended.STOPPED, "broke")
    monkeypatch.setattr(stability, "run_all", lambda work, tasks, *_: [broke for _ in tasks])
    assert compare(tmp_path, *BOUNCE) == STOPPED
    captured = capsys.readouterr()
    assert "failed: bounce: broke" in captured.out
    assert captured.err == "touchdown: 1 searches failed, see the end of the table\n"
