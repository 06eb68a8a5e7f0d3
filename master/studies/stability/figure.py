"""Macro steps that schemes bear in hard cases, as a chart of colours."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure
from matplotlib.image import AxesImage
from matplotlib.patches import Rectangle

from touchdown.master.common.errors import TouchdownError
from touchdown.master.results.figures.style import sheet
from touchdown.master.studies.stability.report import Study, microseconds
from touchdown.master.studies.stability.trials import GROWTH, STEPS, VISIBLE, Attempt, Finding

HALF = 1.4  # cells' margin of the colour scale, as a factor
DARK = 3e-5  # s; below it a cell is dark and its number white


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
    panels[0].set_title(f"right: no figure off by more than {VISIBLE:.0%}")
    image = _panel(panels[1], study, lambda finding: finding.stable)
    panels[1].set_title(f"stable: no journal beyond {GROWTH:g} times its speed or distance")
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
            pale = attempt is not None and attempt.step >= DARK
            axes.text(
                j, i, microseconds(attempt), ha="center", va="center", fontsize=8,
                color="black" if pale or attempt is None else "white",
            )  # fmt: skip
            if finding.called is False:
                axes.add_patch(_frame(i, j))
    norm = LogNorm(STEPS[0] / HALF, STEPS[-1] * HALF)
    image = axes.imshow(steps, cmap="viridis", norm=norm, aspect="auto")
    axes.set_xticks(range(len(study.schemes)), list(study.schemes), rotation=40, ha="right")
    return image


def _frame(row: int, column: int) -> Rectangle:
    return Rectangle((column - 0.46, row - 0.44), 0.92, 0.88, fill=False, edgecolor="red", lw=1.5)
