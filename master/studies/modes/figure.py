"""Errors over the number of modes of a flexible rotor."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from touchdown.master.results.figures.style import BLUE, GREY, ORANGE, sheet
from touchdown.master.studies.modes.compare import Comparison, Row, percent, stress_error

LEAST = 1e-4  # %, um; what an error of nothing is drawn as
BASES = ((False, BLUE, "modes alone"), (True, ORANGE, "with residual flexibility"))


@dataclass(frozen=True)
class Line:
    """One kind of error: its name, how it is drawn, and its value for a row."""

    label: str
    style: str
    error: Callable[[Row], float]


def errors_over_modes(comparison: Comparison) -> Figure:
    """Four panels: forces, orbit, bending and shear stress; grey: all modes, the coupling's error."""
    figure = sheet(12, 9)
    panels = figure.subplots(2, 2)
    forces = [
        Line("journal, averaged", "-", lambda row: _worst(comparison, row, "force")),
        Line("contact, momentary", "--", lambda row: _worst(comparison, row, "contact")),
    ]
    _draw_errors(
        panels[0, 0], comparison, forces, "peak force of the first impact, worst seat", "error [%]"
    )
    orbit = [Line("", "-", lambda row: 1e6 * row.orbit)]
    _draw_errors(
        panels[0, 1], comparison, orbit, "journal from the reference's, worst seat", "distance [µm]"
    )
    for axes, kind in zip(panels[1], ("bending", "shear"), strict=True):
        stresses = [
            Line(
                "mode displacement", "--", lambda row, k=kind: _stress(comparison, row, k, "displacement")
            ),
            Line("mode acceleration", "-", lambda row, k=kind: _stress(comparison, row, k, "acceleration")),
        ]
        _draw_errors(axes, comparison, stresses, f"peak {kind} stress", "error [%]")
    span, step = 1e3 * (comparison.end - comparison.first), 1e6 * comparison.coupling.macro_step
    figure.suptitle(
        f"{comparison.scene.title}: errors against all modes of the finite elements\n"
        f"from the first contact to {span:.3g} ms after it, macro step {step:g} µs"
    )
    return figure


def _worst(comparison: Comparison, row: Row, name: str) -> float:
    exact = comparison.reference.seats
    return max(
        abs(percent(getattr(row.seats[s], name), getattr(exact[s], name))) for s in comparison.impacts
    )


def _stress(comparison: Comparison, row: Row, kind: str, way: str) -> float:
    return abs(stress_error(comparison, row, kind, way))


def _draw_errors(axes: Axes, comparison: Comparison, drawn: list[Line], title: str, label: str) -> None:
    for residual, colour, basis in BASES:
        rows = [row for row in comparison.rows if row.residual == residual]
        for one in drawn:
            values = [max(one.error(row), LEAST) for row in rows]
            name = f"{one.label}, {basis}" if one.label else basis
            axes.plot([row.modes for row in rows], values, f"o{one.style}", color=colour, ms=4, label=name)
    for one in drawn:
        name = "all modes at this macro step" if one is drawn[0] else None
        floor = max(one.error(comparison.coupling), LEAST)
        axes.axhline(floor, color=GREY, ls=one.style, lw=0.8, label=name)
    axes.set_yscale("log")
    axes.set_xticks(sorted({row.modes for row in comparison.rows}))
    axes.set_title(title)
    axes.set_xlabel("modes per plane, the two rigid ones included")
    axes.set_ylabel(label)
    axes.grid(alpha=0.3)
    axes.legend(fontsize=8)
