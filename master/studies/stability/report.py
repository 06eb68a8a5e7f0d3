"""What the search for stable macro steps found: as tables, and as files."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from touchdown.master.common.files import write_records, writing_to
from touchdown.master.scene.schemes import SCHEMES
from touchdown.master.studies.stability.trials import FIRST, GROWTH, VISIBLE, Attempt, Case, Finding, Right

SILENT = "!"  # beside a macro step that is right where the ledger was silent on the next
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
        f"longest macro step [us] that is right (figures within {VISIBLE:.0%}) / stable (to the end, no "
        f"journal beyond {GROWTH:g} times its speed or distance)",
        f"{SILENT}: the energy ledger had not warned where the next one is not right",
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
    silent = SILENT if finding.called is False else ""
    return f"{microseconds(finding.right)}/{microseconds(finding.stable)}{silent}"


def _at_stable(finding: Finding, shown: Callable[[Attempt], str]) -> str:
    return "-" if finding.stable is None else shown(finding.stable)


def _swings(study: Study) -> list[str]:
    least = ["least", *(_least(study, scheme) for scheme in study.schemes)]
    advised = ["advised", *(f"{SCHEMES[scheme].bears:g}" for scheme in study.schemes)]
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
        if case.theory is None or case.first != FIRST:
            continue
        findings = [study.finding(case, scheme) for scheme in study.schemes]
        for i, (figure, exact) in enumerate(zip(case.figures, case.theory.values, strict=True)):
            shown = [
                "-" if (value := _value(one, i)) is None else f"{value / exact:.5f}" for one in findings
            ]
            rows.append([f"{case.name}, {figure.title}", *shown])
    if len(rows) == 1:
        return []
    return ["", f"over what theory says, macro step {1e6 * FIRST:g} us", *_aligned(rows)]


def _value(finding: Finding | None, place: int) -> float | None:
    """A figure at the macro step that is common, if there was a run that ended."""
    attempt = None if finding is None else finding.at(FIRST)
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
