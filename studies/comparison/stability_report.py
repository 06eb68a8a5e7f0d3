"""The study of hard cases: stable macro steps as tables, files and chart."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from typing import TypeVar

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure
from matplotlib.image import AxesImage
from matplotlib.patches import Rectangle

from ...master.scene.schemes import SCHEMES
from ...reports.figures.style import sheet
from ..findings import Column, Findings, Record, table
from .stability import (
    FIRST_STEP,
    GROWTH_LIMIT,
    STEPS,
    VISIBLE_ERROR,
    Attempt,
    Case,
    Expected,
    Finding,
    Study,
)

COLOUR_MARGIN = 1.4  # cells' margin of the colour scale, as a factor
DARK_BELOW = 3e-5  # s; below it a cell is dark and its number white


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
        "longest macro steps [µs] of the coupling schemes; framed in red: the energy ledger had not warned "
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
            if finding.ledger_warned is False:
                corner = (j - 0.46, i - 0.44)
                axes.add_patch(Rectangle(corner, 0.92, 0.88, fill=False, edgecolor="red", lw=1.5))
    norm = LogNorm(STEPS[0] / COLOUR_MARGIN, STEPS[-1] * COLOUR_MARGIN)
    image = axes.imshow(steps, cmap="viridis", norm=norm, aspect="auto")
    axes.set_xticks(range(len(study.schemes)), list(study.schemes), rotation=40, ha="right")
    return image


SILENT_MARK = "!"  # beside a macro step that is right where the ledger was silent on the next
NOT_RUN = "?"
Row = TypeVar("Row", bound=Case | str)


def findings(study: Study) -> Findings:
    """Tables of macro steps, of errors and of what the ledger says, cases by schemes.

    stability.csv has a row per case and scheme, runs.csv one per run.
    """
    return Findings(
        report_lines(study),
        tables={
            "stability.csv": map(_summary, study.findings.values()),
            "runs.csv": _runs(study),
        },
        pictures={"stability.png": lambda: chart(study)} if study.findings else {},
    )


def report_lines(study: Study) -> list[str]:
    """The findings, and the failures."""
    return [
        f"longest macro step [us] that is right (figures within {VISIBLE_ERROR:.0%}) / stable (to the end, "
        f"no journal beyond {GROWTH_LIMIT:g} times its speed or distance)",
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


WIDTH = 15  # of names before titles


def microseconds(attempt: Attempt | None) -> str:
    """A macro step; - where there is none."""
    return "-" if attempt is None else f"{1e6 * attempt.step:g}"


def percent(error: float) -> str:
    """An error with two digits."""
    return f"{100.0 * error:.2g}" if 100.0 * error < 100.0 else f"{100.0 * error:.0f}"


def _steps(finding: Finding) -> str:
    silent = SILENT_MARK if finding.ledger_warned is False else ""
    return f"{microseconds(finding.right)}/{microseconds(finding.stable)}{silent}"


def _at_stable(finding: Finding, shown: Callable[[Attempt], str]) -> str:
    return "-" if finding.stable is None else shown(finding.stable)


def _swings(study: Study) -> list[str]:
    """The swing by case, the least of all, and what is advised."""
    by_row = {
        "least": lambda scheme: _least(study, scheme),
        "advised": lambda scheme: f"{SCHEMES[scheme].angle_limit:g}",
    }
    cell = _cell(study, lambda finding: _swing(finding, study.expected[finding.case]))

    def shown(row: Case | str, scheme: str) -> str:
        return by_row[row](scheme) if isinstance(row, str) else cell(row, scheme)

    return _by_scheme(study, [*study.cases, *by_row], shown)


def _least(study: Study, scheme: str) -> str:
    """The smallest swing over the cases; below it, where not even the shortest step is right in one."""
    swings: list[tuple[float, str]] = []
    for finding in (study.finding(case, scheme) for case in study.cases):
        if finding is not None:
            good = finding.right
            step = finding.attempts[0].step if good is None else good.step
            swings.append((study.expected[finding.case].rate * step, "<" if good is None else ""))
    if not swings:
        return NOT_RUN
    swing, below = min(swings)
    return f"{below}{swing:.2g}"


def _swing(finding: Finding, expected: Expected) -> str:
    return "-" if finding.right is None else f"{expected.rate * finding.right.step:.2g}"


def _table(study: Study, text: Callable[[Finding], str]) -> list[str]:
    """Cases by schemes."""
    return _by_scheme(study, study.cases, _cell(study, text))


def _cell(study: Study, text: Callable[[Finding], str]) -> Callable[[Case, str], str]:
    """The text of a case and a scheme, where they were run."""

    def cell(case: Case, scheme: str) -> str:
        finding = study.finding(case, scheme)
        return NOT_RUN if finding is None else text(finding)

    return cell


def _by_scheme(study: Study, rows: Sequence[Row], text: Callable[[Row, str], str]) -> list[str]:
    """A table with a column for each scheme; rows are cases, or names."""
    columns = [Column[Row]((scheme,), lambda row, s=scheme: text(row, s)) for scheme in study.schemes]
    return table(Column(("",), lambda row: row.name if isinstance(row, Case) else str(row)), columns, rows)


def _theory(study: Study) -> list[str]:
    """Figures over what theory says, at the macro step that is common."""
    rows = {
        f"{case.name}, {figure.title}": (case, i)
        for case in study.cases
        if case.theory is not None and case.first == FIRST_STEP
        for i, figure in enumerate(case.figures)
    }
    if not rows:
        return []

    def shown(row: str, scheme: str) -> str:
        case, i = rows[row]
        value = _value(study.finding(case, scheme), i)
        return "-" if value is None or case.theory is None else f"{value / case.theory.values[i]:.5f}"

    heading = f"over what theory says, macro step {1e6 * FIRST_STEP:g} us"
    return ["", heading, *_by_scheme(study, list(rows), shown)]


def _value(finding: Finding | None, place: int) -> float | None:
    """A figure at the macro step that is common, if there was a run that ended."""
    attempt = None if finding is None else finding.at(FIRST_STEP)
    return attempt.values[place] if attempt is not None and attempt.values else None


def _runs(study: Study) -> Iterator[Record]:
    for finding in study.findings.values():
        for attempt in finding.attempts:
            yield _run(study, finding, attempt)


def _summary(finding: Finding) -> Record:
    stable, right, wrong = finding.stable, finding.right, finding.wrong
    return {
        "case": finding.case,
        "scheme": finding.scheme,
        "largest_right_macro_step_s": right and right.step,
        "largest_stable_macro_step_s": stable and stable.step,
        "error_there_relative": stable and stable.error,
        "energy_residual_there_relative": stable and stable.residual,
        "first_wrong_macro_step_s": wrong and wrong.step,
        "ledger_warned_at_first_wrong": None
        if finding.ledger_warned is None
        else int(finding.ledger_warned),
    }


def _run(study: Study, finding: Finding, attempt: Attempt) -> Record:
    figures = next(case.figures for case in study.cases if case.name == finding.case)
    expected = study.expected[finding.case].values
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
            for figure, value, exact in zip(figures, values, expected, strict=True)
        ),
    }
