"""The study of hard cases: stable macro steps as tables, files and chart."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure
from matplotlib.image import AxesImage
from matplotlib.patches import Rectangle

from ...common.errors import Ended, TouchdownError
from ...common.files import write_records, writing_to
from ...common.pool import TaskOutcome, run_all
from ...coupling.steppers.carried import carrying
from ...results.figures.style import sheet
from ...scene.schemes import SCHEMES
from .stability import (
    FIRST_STEP,
    GROWTH_LIMIT,
    STEPS,
    VISIBLE_ERROR,
    Attempt,
    Case,
    Finding,
    Right,
    examine,
    reference,
)

COLOUR_MARGIN = 1.4  # cells' margin of the colour scale, as a factor
DARK_BELOW = 3e-5  # s; below it a cell is dark and its number white


def draw_chart(study: Study, path: Path) -> None:
    """Save the chart. Raises TouchdownError where it cannot be written."""
    try:
        chart(study).savefig(path, dpi=150)
    except OSError as error:
        raise TouchdownError(
            f"cannot write {path}: {error.strerror}; choose another folder with -o"
        ) from None


def chart(study: Study) -> Figure:
    """Two panels, cases by schemes: longest macro steps that are right, and that are stable."""
    wide, high = len(study.schemes), len(study.cases)
    figure = sheet(5 + 1.3 * wide, 2.2 + 0.42 * high)
    panels = figure.subplots(1, 2, sharey=True, squeeze=False)[0]
    _panel(panels[0], study, lambda finding: finding.right)
    panels[0].set_title(f"right: no figure off by more than {VISIBLE_ERROR:.0%}")
    image = _panel(panels[1], study, lambda finding: finding.stable)
    panels[1].set_title(f"stable: no journal beyond {GROWTH_LIMIT:g} times its speed or distance")
    panels[0].set_yticks(range(high), [case.title for case in study.cases])
    bar = figure.colorbar(image, ax=list(panels), fraction=0.03, pad=0.01)
    bar.set_label("longest macro step [s]")
    figure.suptitle(
        "macro steps [µs] that coupling schemes bear; framed in red: the energy ledger had not warned "
        "where the next step is not right"
    )
    return figure


def _panel(axes: Axes, study: Study, pick: Callable[[Finding], Attempt | None]) -> AxesImage:
    steps = np.full((len(study.cases), len(study.schemes)), np.nan)
    for i, case in enumerate(study.cases):
        for j, scheme in enumerate(study.schemes):
            finding = study.finding(case, scheme)
            if finding is None:
                continue
            attempt = pick(finding)
            steps[i, j] = np.nan if attempt is None else attempt.step
            pale = attempt is not None and attempt.step >= DARK_BELOW
            axes.text(
                j, i, microseconds(attempt), ha="center", va="center", fontsize=8,
                color="black" if pale or attempt is None else "white",
            )  # fmt: skip
            if finding.called is False:
                axes.add_patch(_frame(i, j))
    norm = LogNorm(STEPS[0] / COLOUR_MARGIN, STEPS[-1] * COLOUR_MARGIN)
    image = axes.imshow(steps, cmap="viridis", norm=norm, aspect="auto")
    axes.set_xticks(range(len(study.schemes)), list(study.schemes), rotation=40, ha="right")
    return image


def _frame(row: int, column: int) -> Rectangle:
    return Rectangle((column - 0.46, row - 0.44), 0.92, 0.88, fill=False, edgecolor="red", lw=1.5)


SILENT_MARK = "!"  # beside a macro step that is right where the ledger was silent on the next
NOT_RUN = "?"
WIDTH = 15  # of names before titles


@dataclass(frozen=True)
class Study:
    """All that was found."""

    cases: Sequence[Case]
    schemes: Sequence[str]
    rights: Mapping[str, Right]  # by case
    findings: Mapping[tuple[str, str], Finding]  # by case and scheme; those that ended
    failed: Mapping[str, str]  # why, by what was to be done
    interrupted: bool = False  # whether Ctrl-C ended it

    def finding(self, case: Case, scheme: str) -> Finding | None:
        """What was found of a case and a scheme, if it was."""
        return self.findings.get((case.name, scheme))


def report_lines(study: Study) -> list[str]:
    """Tables of macro steps, of errors and of what the ledger says, cases by schemes."""
    return [
        f"longest macro step [us] that is right (figures within {VISIBLE_ERROR:.0%}) / stable (to the "
        "end, no "
        f"journal beyond {GROWTH_LIMIT:g} times its speed or distance)",
        f"{SILENT_MARK}: the energy ledger had not warned where the next one is not right",
        *_table(study, _steps),
        "",
        "error of the worst figure at the longest stable macro step [%]",
        *_table(study, lambda finding: _at_stable(finding, lambda attempt: percent(attempt.error))),
        "",
        "residual of the energy ledger there, over the case's energy scale",
        *_table(study, lambda finding: _at_stable(finding, lambda attempt: f"{attempt.residual:.0e}")),
        *_theory(study),
        "",
        "swing of the journal on its contact in the longest right macro step [rad]; below, the least of "
        "all cases and what touchdown advise takes",
        *_swings(study),
        "",
        *(f"{case.name:<{WIDTH}}{case.title}" for case in study.cases),
        *(f"failed: {what}: {why}" for what, why in study.failed.items()),
    ]


def microseconds(attempt: Attempt | None) -> str:
    """A macro step; - where there is none."""
    return "-" if attempt is None else f"{1e6 * attempt.step:g}"


def percent(error: float) -> str:
    """An error with two digits."""
    return f"{100.0 * error:.2g}" if 100.0 * error < 100.0 else f"{100.0 * error:.0f}"


def _steps(finding: Finding) -> str:
    silent = SILENT_MARK if finding.called is False else ""
    return f"{microseconds(finding.right)}/{microseconds(finding.stable)}{silent}"


def _at_stable(finding: Finding, shown: Callable[[Attempt], str]) -> str:
    return "-" if finding.stable is None else shown(finding.stable)


def _swings(study: Study) -> list[str]:
    least = ["least", *(_least(study, scheme) for scheme in study.schemes)]
    advised = ["advised", *(f"{SCHEMES[scheme].angle_limit:g}" for scheme in study.schemes)]
    return _table(study, lambda finding: _swing(finding, study.rights[finding.case]), [least, advised])


def _least(study: Study, scheme: str) -> str:
    """The smallest swing over the cases; below it, where not even the shortest step is right in one."""
    swings: list[tuple[float, str]] = []
    for finding in (study.finding(case, scheme) for case in study.cases):
        if finding is not None:
            good = finding.right
            step = finding.attempts[0].step if good is None else good.step
            swings.append((study.rights[finding.case].rate * step, "<" if good is None else ""))
    if not swings:
        return NOT_RUN
    swing, below = min(swings)
    return f"{below}{swing:.2g}"


def _swing(finding: Finding, right: Right) -> str:
    return "-" if finding.right is None else f"{right.rate * finding.right.step:.2g}"


def _table(study: Study, cell: Callable[[Finding], str], last: Sequence[Sequence[str]] = ()) -> list[str]:
    """Cases by schemes; `last`: rows below them."""
    rows: list[Sequence[str]] = [["", *study.schemes]]
    for case in study.cases:
        findings = [study.finding(case, scheme) for scheme in study.schemes]
        rows.append([case.name, *(NOT_RUN if one is None else cell(one) for one in findings)])
    return _aligned([*rows, *last])


def _aligned(rows: Sequence[Sequence[str]]) -> list[str]:
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    return [
        "  ".join(
            [f"{row[0]:<{widths[0]}}"]
            + [f"{text:>{width}}" for text, width in zip(row[1:], widths[1:], strict=True)]
        )
        for row in rows
    ]


def _theory(study: Study) -> list[str]:
    """Figures over what theory says, at the macro step that is common."""
    rows = [["", *study.schemes]]
    for case in study.cases:
        if case.theory is None or case.first != FIRST_STEP:
            continue
        findings = [study.finding(case, scheme) for scheme in study.schemes]
        for i, (figure, exact) in enumerate(zip(case.figures, case.theory.values, strict=True)):
            shown = [
                "-" if (value := _value(one, i)) is None else f"{value / exact:.5f}" for one in findings
            ]
            rows.append([f"{case.name}, {figure.title}", *shown])
    if len(rows) == 1:
        return []
    return ["", f"over what theory says, macro step {1e6 * FIRST_STEP:g} us", *_aligned(rows)]


def _value(finding: Finding | None, place: int) -> float | None:
    """A figure at the macro step that is common, if there was a run that ended."""
    attempt = None if finding is None else finding.at(FIRST_STEP)
    return attempt.values[place] if attempt is not None and attempt.values else None


def write_tables(study: Study, folder: Path) -> None:
    """stability.csv: a row per case and scheme; runs.csv: one per run. Full precision."""
    with writing_to(folder):
        write_records((_summary(finding) for finding in study.findings.values()), folder / "stability.csv")
        runs = (
            _run(study, finding, attempt)
            for finding in study.findings.values()
            for attempt in finding.attempts
        )
        write_records(runs, folder / "runs.csv")


def _summary(finding: Finding) -> Mapping[str, object]:
    stable, right, wrong = finding.stable, finding.right, finding.wrong
    return {
        "case": finding.case,
        "scheme": finding.scheme,
        "largest_right_macro_step_s": right and right.step,
        "largest_stable_macro_step_s": stable and stable.step,
        "error_there_relative": stable and stable.error,
        "energy_residual_there_relative": stable and stable.residual,
        "first_wrong_macro_step_s": wrong and wrong.step,
        "ledger_warned_at_first_wrong": None if finding.called is None else int(finding.called),
    }


def _run(study: Study, finding: Finding, attempt: Attempt) -> Mapping[str, object]:
    figures = next(case.figures for case in study.cases if case.name == finding.case)
    right = study.rights[finding.case].values
    values = attempt.values or (math.nan,) * len(figures)
    return {
        "case": finding.case,
        "scheme": finding.scheme,
        "macro_step_s": attempt.step,
        "stable": int(attempt.stable),
        "right": int(attempt.right),
        "error_relative": attempt.error,
        "energy_residual_relative": attempt.residual,
        "ledger_warned": int(attempt.warned),
        "broke_off": attempt.broke,
        "figures": "; ".join(
            f"{figure.title} {value!r} (right: {exact!r})"
            for figure, value, exact in zip(figures, values, right, strict=True)
        ),
    }


Key = TypeVar("Key")
Value = TypeVar("Value")


@dataclass(frozen=True)
class Task:
    """A case and a scheme, as they are handed to a process."""

    case: Case
    scheme: str
    right: Right


def study_stability(
    cases: Sequence[Case],
    schemes: Sequence[str],
    folder: Path,
    jobs: int = 2,
    done: Callable[[], object] = lambda: None,
) -> Study:
    """Examine every case with every scheme, and write tables and picture into `folder`.

    done() after each reference and each finding. After Ctrl-C what is there is written, and the rest is
    INTERRUPTED. Starts processes: see `touchdown.master.common.pool`.
    """
    rights, failed = _parted([case.name for case in cases], run_all(carrying(reference), cases, jobs, done))
    tasks: list[Task] = []
    if not _interrupted(failed):
        begun = [case for case in cases if case.name in rights]
        tasks = [Task(case, scheme, rights[case.name]) for case in begun for scheme in schemes]
    pairs = [(task.case.name, task.scheme) for task in tasks]
    findings, lost = _parted(pairs, run_all(carrying(_examine), tasks, jobs, done))
    failed |= {f"{case} with {scheme}": outcome for (case, scheme), outcome in lost.items()}
    why = {what: outcome.reason for what, outcome in failed.items()}
    study = Study(cases, schemes, rights, findings, why, _interrupted(failed))
    write_tables(study, folder)
    if findings:
        draw_chart(study, folder / "stability.png")
    return study


def _parted(
    keys: Iterable[Key], outcomes: Iterable[TaskOutcome[Value]]
) -> tuple[dict[Key, Value], dict[Key, TaskOutcome[Value]]]:
    """What the tasks gave, and how those ended that gave nothing."""
    given: dict[Key, Value] = {}
    failed: dict[Key, TaskOutcome[Value]] = {}
    for key, outcome in zip(keys, outcomes, strict=True):
        if outcome.value is None:
            failed[key] = outcome
        else:
            given[key] = outcome.value
    return given, failed


def _interrupted(failed: Mapping[str, TaskOutcome[Any]]) -> bool:
    return any(outcome.ended is Ended.INTERRUPTED for outcome in failed.values())


def size(cases: Sequence[Case], schemes: Sequence[str]) -> int:
    """How often a study calls `done`."""
    return len(cases) * (1 + len(schemes))


def _examine(task: Task) -> Finding:
    return examine(task.case, task.scheme, task.right)
