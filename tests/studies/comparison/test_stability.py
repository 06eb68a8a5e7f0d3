"""Hard cases of the coupling schemes: the search, how runs are judged, the tables, the command."""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import cast

import pytest

from touchdown.command.cli import main
from touchdown.master.common.errors import FAILED, STOPPED, Ended
from touchdown.master.common.pool import INTERRUPTED, TaskOutcome
from touchdown.master.coupling.observer import RunState
from touchdown.master.coupling.simulation import open_system
from touchdown.master.coupling.system import System
from touchdown.studies.comparison import stability as stability_study
from touchdown.studies.comparison.stability import (
    FIRST_STEP,
    GROWTH_LIMIT,
    STEPS,
    VISIBLE_ERROR,
    Attempt,
    Bounds,
    Expected,
    Finding,
    Study,
    attempted,
    reference,
    search,
)
from touchdown.studies.comparison.stability_cases import bounce, cases, chosen
from touchdown.studies.comparison.stability_report import report_lines


def judged(right_up_to: float, stable_up_to: float, warned: bool = True) -> Callable[[float], Attempt]:
    """What runs would say of a scheme with these limits (s)."""

    def attempt(step: float) -> Attempt:
        error = 0.01 if step <= right_up_to else 0.5
        return Attempt(step, (1.0 + error,), error, error, warned, "" if step <= stable_up_to else "lost")

    return attempt


def limits(found: tuple[Attempt, ...]) -> tuple[float | None, float | None, float | None]:
    """Longest right, longest stable and shortest wrong macro step (s)."""
    finding = Finding("case", "scheme", found)
    return tuple(a and a.step for a in (finding.right, finding.stable, finding.wrong))  # type: ignore[return-value]


@pytest.mark.parametrize(
    ("right_up_to", "stable_up_to", "expected", "tried"),
    [
        (1.0, 1.0, (1e-3, 1e-3, None), (2e-5, 1e-3)),  # bears all
        (5e-5, 2e-4, (5e-5, 2e-4, 1e-4), (2e-5, 5e-4)),
        (2e-6, 1e-4, (2e-6, 1e-4, 5e-6), (2e-6, 2e-4)),
        (2e-6, 5e-6, (2e-6, 5e-6, 5e-6), (2e-6, 2e-5)),  # the first one tried is lost
        (0.0, 5e-5, (None, 5e-5, 1e-6), (1e-6, 1e-4)),
        (0.0, 0.0, (None, None, 1e-6), (1e-6, 2e-5)),  # bears none
    ],
)
def test_the_search_finds_both_limits(
    right_up_to: float,
    stable_up_to: float,
    expected: tuple[float | None, ...],
    tried: tuple[float, float],
) -> None:
    found = search(judged(right_up_to, stable_up_to), STEPS, FIRST_STEP)
    assert limits(found) == expected
    steps = [attempt.step for attempt in found]
    assert (steps[0], steps[-1]) == tried
    assert steps == [step for step in STEPS if tried[0] <= step <= tried[1]]  # each once, none left out


def test_a_limit_is_what_all_smaller_steps_bear() -> None:
    """One that is right by luck, beyond one that is not, does not count."""
    attempts = [judged(1.0, 1.0)(step) for step in STEPS[:5]]
    attempts[2] = judged(0.0, 0.0)(STEPS[2])
    assert limits(tuple(attempts)) == (STEPS[1], STEPS[1], STEPS[2])


def test_the_ledger_is_asked_at_the_first_step_that_is_wrong() -> None:
    def called(warned: bool, limit: float) -> bool | None:
        return Finding(
            "case", "scheme", search(judged(limit, 1.0, warned), STEPS, FIRST_STEP)
        ).ledger_warned

    assert called(True, 1e-5) is True
    assert called(False, 1e-5) is False
    assert called(False, 1.0) is None


def test_what_is_right() -> None:
    fine = Attempt(1e-5, (1.0,), VISIBLE_ERROR, 0.0, False)
    assert fine.right
    assert not replace(fine, error=1.001 * VISIBLE_ERROR).right
    assert not replace(fine, error=math.nan).right
    assert not replace(fine, broke="lost").right


@pytest.mark.parametrize(
    ("y", "vy", "breaks"),
    [(0.9, -0.9, False), (-1.1, 0.0, True), (0.0, 1.1, True), (math.nan, 0.0, True), (0.0, math.nan, True)],
)
def test_a_run_is_broken_off_beyond_its_bounds(y: float, vy: float, breaks: bool) -> None:
    names = ("x", "y", "vx", "vy")
    values = dict(zip((f"rotor.A.{name}" for name in names), (0.5, y, 0.5, vy), strict=True))
    now = RunState(cast(System, SimpleNamespace(signal=values.__getitem__)), zero=0.0, steps=1, time=0.1)
    bounds = Bounds(["rotor.A"], speed=1.0, distance=1.0)
    bounds.stepped(now)
    if breaks:
        assert now.ended is Ended.AS_WANTED
        assert re.fullmatch(r"rotor\.A is .* m off and .* m/s fast at t = 0\.1 s", now.reason)
    else:
        assert now.ended is None
        assert (bounds.farthest, bounds.fastest) == (0.9, 0.9)


def attempts_at_bounce(scheme: str, step: float = FIRST_STEP) -> Attempt:
    case = bounce()
    assert case.theory is not None
    return attempted(case, scheme, step, case.theory)


def test_the_default_bounces_as_theory_has_it() -> None:
    found = attempts_at_bounce("interface")
    assert found.right
    assert found.values == pytest.approx((0.1, 0.1 * math.sqrt(10.0 * 1e8)), rel=1e-3)
    assert not found.warned


@pytest.mark.parametrize(("scheme", "rebound"), [("hold", 1.05), ("jacobi-hold", 1.16)])
def test_motion_that_is_held_makes_energy_and_the_ledger_calls_it(scheme: str, rebound: float) -> None:
    found = attempts_at_bounce(scheme)
    assert found.values[0] / 0.1 == pytest.approx(rebound, abs=0.005)
    assert found.stable
    assert not found.right
    assert found.warned
    assert found.residual > 0.5 * (rebound**2 - 1.0) * 0.5  # of the energy scale, m v^2


def test_growth_is_not_stable() -> None:
    found = attempts_at_bounce("jacobi-hold", 5e-4)
    assert not found.stable
    assert "rotor.A" in found.broke
    assert found.error == math.inf
    assert found.values == ()


def test_a_reference_says_what_its_journal_does() -> None:
    """The case's own theory, found by a run."""
    case = bounce()
    theory, right = case.theory, reference(replace(case, theory=None))
    assert theory is not None
    assert right.values == pytest.approx(theory.values, rel=1e-5)
    assert (right.speed, right.distance) == pytest.approx((theory.speed, theory.distance), rel=1e-3)
    assert right.rate == pytest.approx(math.sqrt(1e8 / 10.0))  # rad/s, of spring and mass


@pytest.mark.parametrize("name", cases())
def test_a_case_can_be_run_and_read(name: str) -> None:
    """Every macro step divides its run, and what it judges by is there."""
    case = cases()[name]
    for step in case.steps:
        assert case.scene.run.duration / step == pytest.approx(round(case.scene.run.duration / step))
    assert case.first in case.steps
    assert case.theory is None or len(case.theory.values) == len(case.figures)
    assert case.scene.zero is None
    system = open_system(case.scene, in_process=True)
    wanted = [name for figure in case.figures for name in figure.variables]
    wanted += [f"{journal}.{v}" for journal in case.journals for v in ("x", "y", "vx", "vy")]
    wanted += case.scene.energy_scale
    for variable in wanted:
        system.value(variable)
    assert all(f"{journal}.vy" in system.position for journal in case.journals)
    system.close()


def test_cases_are_chosen_by_name() -> None:
    assert [case.name for case in chosen(["whirl", "bounce"], False)] == ["bounce", "whirl"]
    assert "drift" not in [case.name for case in chosen([], False)]
    assert "drift" in [case.name for case in chosen([], True)]
    assert [case.name for case in chosen(["drift"], False)] == ["drift"]


def test_tables_show_limits_and_where_the_ledger_was_silent() -> None:
    case = bounce()
    found = {
        (case.name, "hold"): Finding(
            case.name, "hold", search(judged(1e-5, 5e-5, False), STEPS, FIRST_STEP)
        ),
        (case.name, "interface"): Finding(
            case.name, "interface", search(judged(1.0, 1.0), STEPS, FIRST_STEP)
        ),
    }
    right = Expected((1.0,), 1.0, 1.0, rate=1e4)
    schemes = ("hold", "interface", "velocity")
    text = report_lines(
        Study([replace(case, theory=None)], schemes, {case.name: right}, found, {"it": "why"})
    )
    rows = [line.split() for line in text if line.startswith(case.name)]
    assert rows[0] == ["bounce", "10/50!", "1000/1000", "?"]
    assert rows[1] == ["bounce", "50", "1", "?"]  # %
    assert rows[2] == ["bounce", "5e-01", "1e-02", "?"]
    assert rows[3] == ["bounce", "0.1", "10", "?"]  # rad
    assert text[-1] == "failed: it: why"


def command(folder: Path, *arguments: str) -> int:
    return main(["stability", "--quiet", "-o", str(folder), *arguments])


@pytest.mark.slow
def test_the_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert command(tmp_path, "--cases", "bounce", "--schemes", "interface,hold") == 0
    out = capsys.readouterr().out
    assert next(line.split() for line in out.splitlines() if line.startswith("bounce  ")) == [
        "bounce", "1000/1000", "10/100",
    ]  # fmt: skip
    with (tmp_path / "stability.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert [row["scheme"] for row in rows] == ["interface", "hold"]
    assert [float(row["largest_right_macro_step_s"]) for row in rows] == [1e-3, 1e-5]
    assert [row["ledger_warned_at_first_wrong"] for row in rows] == ["", "1"]
    with (tmp_path / "runs.csv").open(newline="") as file:
        runs = list(csv.DictReader(file))
    assert [float(run["macro_step_s"]) for run in runs if run["scheme"] == "interface"] == list(STEPS[4:])
    assert runs[0]["figures"].startswith("rebound speed 0.0999")
    assert (tmp_path / "stability.png").stat().st_size > 10_000


def test_what_is_done_stays_after_ctrl_c(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def one_then_ctrl_c(work: object, tasks: list[object], *_: object) -> list[TaskOutcome[object]]:
        done = [TaskOutcome(cast(Callable[[object], object], work)(task)) for task in tasks[:1]]
        return [*done, *(INTERRUPTED for _ in tasks[1:])]

    monkeypatch.setattr(stability_study, "run_all", one_then_ctrl_c)
    assert command(tmp_path, "--cases", "bounce", "--schemes", "interface,hold") == 130
    captured = capsys.readouterr()
    assert captured.err == "touchdown: interrupted\n"
    assert "failed: bounce with hold: interrupted" in captured.out
    assert len((tmp_path / "stability.csv").read_text().splitlines()) == 2
    assert (tmp_path / "stability.png").exists()


def test_a_case_without_reference_fails_alone(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(
        stability_study,
        "run_all",
        lambda work, tasks, *_: [TaskOutcome(None, Ended.STOPPED, "broke") for _ in tasks],
    )
    assert command(tmp_path, "--cases", "bounce", "--schemes", "interface") == STOPPED
    assert "failed: bounce: broke" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("arguments", "named"),
    [
        (("--cases", "bounces"), "there is no case bounces; did you mean bounce"),
        (("--cases", "bounce,"), "--cases bounce,: a name is missing between the commas"),
        (("--schemes", "hold,interfaces"), "unknown scheme interfaces"),
        (("--jobs", "0"), "--jobs 0 must be a whole number above 0"),
    ],
)
def test_what_cannot_be_is_refused(
    arguments: tuple[str, ...], named: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert command(tmp_path, *arguments) == FAILED
    assert named in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


def test_bounds_are_a_factor_of_what_is_right() -> None:
    """A journal as fast as GROWTH allows is stable; a little more is not."""
    case = bounce()
    assert case.theory is not None
    speed = attempts_at_bounce("jacobi-hold").values[0]
    for factor, stable in ((0.99, False), (1.01, True)):
        given = replace(case.theory, speed=max(0.1, factor * speed) / GROWTH_LIMIT)
        assert attempted(case, "jacobi-hold", FIRST_STEP, given).stable is stable
