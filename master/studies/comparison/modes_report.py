"""Numbers of modes beside each other, as lines, files and picture."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ...results.figures.style import BLUE, GREY, ORANGE
from ..drop.first_impact import AVERAGING_TIME
from ..findings import Column, Findings, Record, number, paragraphs, table
from .modes import Comparison, Row, percent, stress_error
from .panels import label_errors, panel_grid

MIN_DRAWN_ERROR = 1e-4  # %, um; what an error of nothing is drawn as
BASES = ((False, BLUE, "modes alone"), (True, ORANGE, "with residual flexibility"))
STRESSES = ("bending", "shear")
STRESS_METHODS = {"displacement": "--", "acceleration": "-"}  # how they are drawn


def findings(comparison: Comparison) -> Findings:
    """What the reference says, and a table of errors against it."""
    return Findings(
        paragraphs(_reference_lines(comparison), _table(comparison)),
        tables={"modes.csv": _records(comparison)},
        pictures={"modes.png": lambda: errors_over_modes(comparison)},
    )


@dataclass(frozen=True)
class Line:
    """One kind of error: its name, how it is drawn, and its value for a row."""

    label: str
    style: str
    error: Callable[[Row], float]


def errors_over_modes(comparison: Comparison) -> Figure:
    """Four panels: forces, orbit, bending and shear stress; grey: all modes, the coupling's error."""
    span, step = 1e3 * (comparison.end - comparison.first), 1e6 * comparison.coupling.macro_step
    title = (
        f"{comparison.scene.title}: errors against all modes of the finite elements\n"
        f"from the first contact to {span:.3g} ms after it, macro step {step:g} µs"
    )
    figure, panels = panel_grid(4, 6.0, 4.5, title)
    forces = [
        Line("journal, averaged", "-", lambda row: _worst(comparison, row, "force")),
        Line("contact, momentary", "--", lambda row: _worst(comparison, row, "contact")),
    ]
    _panel(panels[0], comparison, forces, "peak force of the first impact, worst seat", "error [%]")
    orbit = [Line("", "-", lambda row: 1e6 * row.orbit)]
    _panel(panels[1], comparison, orbit, "journal from the reference's, worst seat", "distance [µm]")
    for axes, kind in zip(panels[2:], STRESSES, strict=True):
        stresses = [
            Line(f"mode {way}", style, lambda row, k=kind, w=way: abs(stress_error(comparison, row, k, w)))
            for way, style in STRESS_METHODS.items()
        ]
        _panel(axes, comparison, stresses, f"peak {kind} stress", "error [%]")
    return figure


def _worst(comparison: Comparison, row: Row, name: str) -> float:
    exact = comparison.reference.seats
    return max(
        abs(percent(getattr(row.seats[s], name), getattr(exact[s], name))) for s in comparison.impacts
    )


def _panel(axes: Axes, comparison: Comparison, lines: Sequence[Line], title: str, label: str) -> None:
    for residual, colour, basis in BASES:
        rows = [row for row in comparison.rows if row.residual == residual]
        for line in lines:
            values = [max(line.error(row), MIN_DRAWN_ERROR) for row in rows]
            name = f"{line.label}, {basis}" if line.label else basis
            axes.plot([row.modes for row in rows], values, f"o{line.style}", color=colour, ms=4, label=name)
    for line in lines:
        name = "all modes at this macro step" if line is lines[0] else None
        floor = max(line.error(comparison.coupling), MIN_DRAWN_ERROR)
        axes.axhline(floor, color=GREY, ls=line.style, lw=0.8, label=name)
    label_errors(axes, "modes per plane, the two rigid ones included", label)
    axes.set_xticks(sorted({row.modes for row in comparison.rows}))
    axes.set_title(title)
    axes.legend(fontsize=8)


def _reference_lines(comparison: Comparison) -> Iterator[str]:
    exact = comparison.reference
    yield comparison.scene.title
    yield (
        f"reference: all modes of the finite elements, macro step {1e6 * exact.macro_step:g} us, "
        f"energy residual {exact.energy:.2g} of the energy lost by falling"
    )
    for seat, (start, end) in comparison.impacts.items():
        peaks = exact.seats[seat]
        yield (
            f"  {seat}: first impact {1e3 * start:.4g} to {1e3 * end:.4g} ms, journal force "
            f"{peaks.force:.5g} N over {1e6 * AVERAGING_TIME:g} us, contact force {peaks.contact:.5g} N, "
            f"indentation {1e6 * peaks.indentation:.4g} um"
        )
    stresses = exact.displacement
    yield (
        f"  bending {1e-6 * stresses.bending:.5g} MPa, shear {1e-6 * stresses.shear:.5g} MPa, "
        f"up to {1e3 * (comparison.end - comparison.first):.3g} ms after the first contact"
    )


def _table(comparison: Comparison) -> list[str]:
    exact, coupling = comparison.reference, comparison.coupling
    columns = [
        Column[Row](
            (f"{title} {seat}", "force %"),
            lambda row, s=seat, f=figure: format(
                percent(getattr(row.seats[s], f), getattr(exact.seats[s], f)), "+.2f"
            ),
        )
        for title, figure in (("journal", "force"), ("contact", "contact"))
        for seat in comparison.impacts
    ]
    columns.append(Column(("orbit", "um"), lambda row: f"{1e6 * row.orbit:.3g}"))
    columns += [
        Column[Row](
            (kind, f"{short} %"),
            lambda row, k=kind, w=way: format(stress_error(comparison, row, k, w), "+.2f"),
        )
        for kind in STRESSES
        for way, short in zip(STRESS_METHODS, ("displ.", "accel."), strict=True)
    ]
    columns.append(Column(("highest", "Hz"), lambda row: number(row.frequency, ".0f")))
    columns.append(Column(("wall/", "simulated"), lambda row: f"{row.wall:.3g}"))
    label = Column[Row](
        ("", "modes"),
        lambda row: f"{row.modes or 'all':>5}{_basis(row, row is coupling):<11}",
    )
    step = 1e6 * coupling.macro_step
    return [
        f"errors against it, macro step {step:g} us; stresses by mode displacement and acceleration",
        *table(label, columns, [*comparison.rows, coupling]),
    ]


def _basis(row: Row, coupling: bool) -> str:
    return "  coupling" if coupling else "  residual" if row.residual else ""


def _records(comparison: Comparison) -> Iterator[Record]:
    """All figures and errors of all rows, in full precision."""
    yield _record(comparison, "reference", comparison.reference)
    yield _record(comparison, "coupling", comparison.coupling)
    for row in comparison.rows:
        yield _record(comparison, "modes", row)


def _record(comparison: Comparison, role: str, row: Row) -> Record:
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
