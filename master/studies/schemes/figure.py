"""Work against precision: wall time over error, a line for each coupling scheme."""

from __future__ import annotations

import math
from collections.abc import Sequence

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from touchdown.master.results.figures.style import BLACK, COLOURS, GREY, sheet
from touchdown.master.studies.schemes.compare import SHOWN, Comparison, Row

MARKERS = "osD^v<>ph*"


def work_precision(comparison: Comparison) -> Figure:
    """Panels: journal position and velocity, peak forces, ledger; labels are macro steps."""
    quantities = comparison.quantities
    lines = math.ceil(len(quantities) / 2)
    figure = sheet(13, 5 * lines)
    panels = list(figure.subplots(lines, 2).flat)
    for axes in panels[len(quantities) :]:
        axes.set_axis_off()
    for axes, name in zip(panels, quantities, strict=False):
        _panel(axes, comparison, name)
    figure.axes[0].legend(fontsize=8)
    asked, landing = comparison.asked, comparison.landing
    figure.suptitle(
        f"{comparison.scene.title}: wall time against error\n"
        f"up to {1e3 * (landing.end - landing.first):.3g} ms after the first contact, "
        f"{'in process' if asked.in_process else 'through FMUs'}"
    )
    return figure


def _panel(axes: Axes, comparison: Comparison, name: str) -> None:
    shown = SHOWN[name]
    for i, scheme in enumerate(comparison.asked.schemes):
        rows = [row for row in comparison.rows if row.name == scheme]
        style = {"color": COLOURS[i % len(COLOURS)], "marker": MARKERS[i % len(MARKERS)]}
        _curve(axes, rows, name, scheme, **style, ls="-" if i < len(COLOURS) else "--")
    _curve(axes, comparison.monolithic, name, "monolithic", color=BLACK, marker="x", ls="")
    floor = shown.factor * comparison.floors[name]
    if floor > 0.0:
        axes.axvline(floor, color=GREY, lw=0.8, ls=":")
    if name in comparison.wanted:
        axes.axvline(shown.factor * comparison.wanted[name], color=GREY, lw=0.8, ls="--", label="wanted")
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlabel(shown.axis)
    axes.set_ylabel("wall time per simulated s [s]")
    axes.grid(alpha=0.3)


def _curve(axes: Axes, rows: Sequence[Row], name: str, label: str, **style: object) -> None:
    """What has an error above zero, and a time."""
    points = [
        (SHOWN[name].factor * row.errors[name], row.wall, row)
        for row in rows
        if row.wall is not None and 0.0 < row.errors.get(name, 0.0) < float("inf")
    ]
    if not points:
        return
    errors, walls, drawn = zip(*points, strict=True)
    axes.plot(errors, walls, lw=1.2, ms=5, label=label, **style)  # type: ignore[arg-type]
    for error, wall, row in zip(errors, walls, drawn, strict=True):
        text = row.name if row.step is None else f"{1e6 * row.step:g}"
        axes.annotate(text, (error, wall), xytext=(4, 3), textcoords="offset points", fontsize=7)
