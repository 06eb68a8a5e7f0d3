"""Numbers of modes beside each other, as lines, files and figure."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ...common.files import write_records, writing_to
from ...results.figures.style import BLUE, GREY, ORANGE, sheet
from ..drop.first_impact import AVERAGING_TIME
from .modes import Comparison, Row, percent, stress_error

MIN_DRAWN_ERROR = 1e-4  # %, um; what an error of nothing is drawn as
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
            values = [max(one.error(row), MIN_DRAWN_ERROR) for row in rows]
            name = f"{one.label}, {basis}" if one.label else basis
            axes.plot([row.modes for row in rows], values, f"o{one.style}", color=colour, ms=4, label=name)
    for one in drawn:
        name = "all modes at this macro step" if one is drawn[0] else None
        floor = max(one.error(comparison.coupling), MIN_DRAWN_ERROR)
        axes.axhline(floor, color=GREY, ls=one.style, lw=0.8, label=name)
    axes.set_yscale("log")
    axes.set_xticks(sorted({row.modes for row in comparison.rows}))
    axes.set_title(title)
    axes.set_xlabel("modes per plane, the two rigid ones included")
    axes.set_ylabel(label)
    axes.grid(alpha=0.3)
    axes.legend(fontsize=8)


WIDTH = 10
STRESSES = ("bending", "shear")
STRESS_METHODS = ("displacement", "acceleration")  # by which stresses are found


def report_lines(comparison: Comparison) -> list[str]:
    """What the reference says, and a table of errors against it."""
    return [*_reference_lines(comparison), "", *_table(comparison)]


def _reference_lines(comparison: Comparison) -> list[str]:
    exact = comparison.reference
    about = [
        f"{comparison.scene.title}",
        f"reference: all modes of the finite elements, macro step {1e6 * exact.macro_step:g} us, "
        f"energy residual {exact.energy:.2g} of the energy lost by falling",
    ]
    for seat, (start, end) in comparison.impacts.items():
        peaks = exact.seats[seat]
        about.append(
            f"  {seat}: first impact {1e3 * start:.4g} to {1e3 * end:.4g} ms, journal force "
            f"{peaks.force:.5g} N over {1e6 * AVERAGING_TIME:g} us, contact force {peaks.contact:.5g} N, "
            f"indentation {1e6 * peaks.indentation:.4g} um"
        )
    stresses = exact.displacement
    about.append(
        f"  bending {1e-6 * stresses.bending:.5g} MPa, shear {1e-6 * stresses.shear:.5g} MPa, "
        f"up to {1e3 * (comparison.end - comparison.first):.3g} ms after the first contact"
    )
    return about


def _table(comparison: Comparison) -> list[str]:
    seats = list(comparison.impacts)
    heads = [
        *((f"journal {seat}", "force %") for seat in seats),
        *((f"contact {seat}", "force %") for seat in seats),
        ("orbit", "um"),
        *((kind, f"{way[:7]} %") for kind in STRESSES for way in ("displ.", "accel.")),
        ("highest", "Hz"),
        ("wall/", "simulated"),
    ]
    top, below = (f"{'':16}" + "".join(f"{head[i]:>{WIDTH}}" for head in heads) for i in (0, 1))
    body = [
        f"{row.modes:>5}{'  residual' if row.residual else '':<11}{_cells(comparison, row)}"
        for row in comparison.rows
    ]
    step = 1e6 * comparison.coupling.macro_step
    return [
        f"errors against it, macro step {step:g} us; stresses by mode displacement and acceleration",
        top,
        f"modes{'':11}{below[16:]}",
        *body,
        f"{'all':>5}{'  coupling':<11}{_cells(comparison, comparison.coupling)}",
    ]


def _cells(comparison: Comparison, row: Row) -> str:
    seats, exact = list(comparison.impacts), comparison.reference
    errors = [percent(row.seats[s].force, exact.seats[s].force) for s in seats]
    errors += [percent(row.seats[s].contact, exact.seats[s].contact) for s in seats]
    shown = [f"{error:+.2f}" for error in errors]
    shown.append(f"{1e6 * row.orbit:.3g}")
    shown += [
        f"{stress_error(comparison, row, kind, way):+.2f}" for kind in STRESSES for way in STRESS_METHODS
    ]
    shown.append("-" if row.frequency is None else f"{row.frequency:.0f}")
    shown.append(f"{row.wall:.3g}")
    return "".join(f"{cell:>{WIDTH}}" for cell in shown)


def write_report(comparison: Comparison, folder: Path) -> None:
    """modes.csv and modes.png into `folder`."""
    with writing_to(folder):
        write_table(comparison, folder / "modes.csv")
        errors_over_modes(comparison).savefig(folder / "modes.png", dpi=150)


def write_table(comparison: Comparison, path: Path) -> None:
    """All figures and errors of all rows, in full precision."""
    rows = [
        _record(comparison, "reference", comparison.reference),
        _record(comparison, "coupling", comparison.coupling),
    ]
    rows += [_record(comparison, "modes", row) for row in comparison.rows]
    write_records(rows, path)


def _record(comparison: Comparison, role: str, row: Row) -> Mapping[str, object]:
    cells: dict[str, object] = {
        "run": role,
        "modes": row.modes or "all",
        "residual": int(row.residual),
        "macro_step_s": row.macro_step,
    }
    for seat in comparison.impacts:
        now, exact = row.seats[seat], comparison.reference.seats[seat]
        for name, unit, factor in (("force", "N", 1.0), ("contact", "N", 1.0), ("indentation", "um", 1e6)):
            title = {"force": "journal_force", "contact": "contact_force"}.get(name, name)
            value, right = getattr(now, name), getattr(exact, name)
            cells[f"{title}_{unit}_{seat}"] = factor * value
            cells[f"{title}_error_percent_{seat}"] = percent(value, right)
    cells["orbit_error_um"] = 1e6 * row.orbit
    for kind in STRESSES:
        for way in STRESS_METHODS:
            cells[f"peak_{kind}_MPa_{way}"] = 1e-6 * getattr(getattr(row, way), kind)
            cells[f"peak_{kind}_error_percent_{way}"] = stress_error(comparison, row, kind, way)
    cells["highest_frequency_Hz"] = row.frequency
    cells["wall_time_per_simulated_s"] = row.wall
    cells["energy_residual_relative"] = row.energy
    return cells
