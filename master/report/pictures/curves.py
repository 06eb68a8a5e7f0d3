"""The curves of a chart on paper: what stands for it in print and where no script runs."""

from __future__ import annotations

from matplotlib.figure import Figure

from touchdown.master.report.facts.series import Chart
from touchdown.master.results.figures.style import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    ORANGE,
    PURPLE,
    TIME,
    beginning,
    sized,
    thinned,
    within,
)

INKS = {"blue": BLUE, "orange": ORANGE, "green": GREEN, "purple": PURPLE, "grey": GREY, "ink": BLACK}
WIDTH = 0.9  # pt
MOST = 3000  # points of a line: about two for each pixel


def curves(figure: Figure, chart: Chart) -> None:
    """All of the chart, and beside it the first impact."""
    whole = (beginning(chart.time), float(chart.time[-1]))
    spans = [whole] if chart.impact is None else [chart.impact, whole]
    ratios = [1.0] if len(spans) == 1 else [1.0, 1.8]
    panels = sized(figure, 9.4, 3.1).subplots(1, len(spans), squeeze=False, width_ratios=ratios)[0]
    for axes, span in zip(panels, spans, strict=True):
        shown = within(chart.time, span)
        for line in chart.lines:
            points = thinned(chart.time[shown], line.values[shown], MOST)
            axes.plot(*points, color=INKS[line.colour], lw=WIDTH, label=line.label)
        axes.set_xlim(*span)
        axes.set_xlabel(TIME)
        axes.grid(alpha=0.4, lw=0.5)
        axes.ticklabel_format(useOffset=False)
    panels[0].set_ylabel(chart.axis)
    if len(spans) > 1:
        panels[0].set_title("first impact")
        panels[1].set_title("whole run")
    if len(chart.lines) > 1:
        panels[-1].legend(loc="upper right", ncols=min(len(chart.lines), 3), fontsize="small")
