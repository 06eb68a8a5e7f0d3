"""Work against precision: wall time over error, a line for each coupling scheme."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from touchdown.master.results.figures.style import BLACK, COLOURS, GREY, sheet
from touchdown.master.studies.schemes.compare import SHOWN, Comparison, Row

MARKERS = "osD^v<>ph*"


def work_precision(found: Comparison) -> Figure:
    """Four panels: journal position and velocity, peak force, ledger; labels are macro steps."""
    figure = sheet(13, 10)
    for axes, name in zip(figure.subplots(2, 2).flat, SHOWN, strict=True):
        _panel(axes, found, name)
    figure.axes[0].legend(fontsize=8)
    asked, landing = found.asked, found.landing
    figure.suptitle(
        f"{found.scene.title}: wall time against error\n"
        f"up to {1e3 * (landing.end - landing.first):.3g} ms after the first contact, "
        f"{'in process' if asked.in_process else 'through FMUs'}"
    )
    return figure


def _panel(axes: Axes, found: Comparison, name: str) -> None:
    shown = SHOWN[name]
    for i, scheme in enumerate(found.asked.schemes):
        rows = [row for row in found.rows if row.name == scheme]
        style = {"color": COLOURS[i % len(COLOURS)], "marker": MARKERS[i % len(MARKERS)]}
        _curve(axes, rows, name, scheme, **style, ls="-" if i < len(COLOURS) else "--")
    if name in ("position", "velocity"):
        _curve(axes, found.monolithic, name, "monolithic", color=BLACK, marker="x", ls="")
    floor = shown.factor * found.floors[name]
    if floor > 0.0:
        axes.axvline(floor, color=GREY, lw=0.8, ls=":")
    if name == "position":
        axes.axvline(shown.factor * found.asked.wanted, color=GREY, lw=0.8, ls="--", label="wanted")
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlabel(
        "residual of the ledger [1]" if name == "energy" else f"error of {shown.title} [{shown.unit}]"
    )
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
