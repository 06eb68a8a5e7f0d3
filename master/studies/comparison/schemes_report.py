"""Coupling schemes beside each other, as lines, files and figure."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ...common.files import write_records, writing_to
from ...results.figures.style import BLACK, COLOURS, GREY, sheet
from ..drop.first_impact import forces_text
from ..drop.reference import POSITION, Refined
from .schemes import ERROR_COLUMNS, Comparison, Row

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
    shown = ERROR_COLUMNS[name]
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
        (ERROR_COLUMNS[name].factor * row.errors[name], row.wall, row)
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


MONOLITHIC = "monolithic"


def report_lines(comparison: Comparison) -> list[str]:
    """What it is measured against, a table of errors, fitted orders, and what to take."""
    return [*_about(comparison), "", *_table(comparison), "", *_orders(comparison), "", *advice(comparison)]


def _about(comparison: Comparison) -> list[str]:
    landing, exact, asked = comparison.landing, comparison.exact, comparison.asked
    about = [comparison.scene.title]
    for seat, (start, end) in landing.impacts.items():
        about.append(
            f"  {seat}: first impact {1e3 * start:.4g} to {1e3 * end:.4g} ms, "
            f"{forces_text(landing.peaks(seat))}"
        )
    first, second = exact.first, exact.second
    counted = "macro steps" if isinstance(first.solver, Refined) else "evaluations"
    known = ", ".join(
        f"{ERROR_COLUMNS[q].title} {100.0 * comparison.fine[q]:.1g} %" for q in comparison.forces
    )
    until = "the end" if exact.whole else f"{1e3 * exact.horizon:.4g} ms, where they part"
    about += [
        f"compared up to {1e3 * landing.end:.4g} ms, {1e3 * (landing.end - landing.first):.3g} ms after "
        "the first contact",
        f"reference: {first.solver.title} ({first.evaluations} {counted}) and {second.solver.title} "
        f"({second.evaluations}) agree to {1e6 * exact.floor(POSITION):.1g} um up to {until}",
        f"co-simulation in fine steps is off by {1e6 * comparison.fine['position']:.1g} um; "
        f"peak forces are measured against it, known to: {known}",
        f"wall time {'in process' if asked.in_process else 'through FMUs'}, median of {asked.repeat}; "
        "of monolithic solvers, one run in process",
    ]
    return about


def _table(comparison: Comparison) -> list[str]:
    rows = [*comparison.rows, *comparison.monolithic]
    width = max(len(row.name) for row in rows) + 2
    quantities = comparison.quantities
    heads = [ERROR_COLUMNS[q].title for q in quantities]
    units = [f"[{ERROR_COLUMNS[q].unit}]" for q in quantities]
    top = f"{'scheme':<{width}}{'macro step':>12}" + "".join(f"{h:>12}" for h in (*heads, "wall/"))
    below = f"{'':<{width}}{'':>12}" + "".join(f"{u:>12}" for u in (*units, "simulated"))
    return [top, below, *(f"{row.name:<{width}}{_cells(row, quantities)}".rstrip() for row in rows)]


def _cells(row: Row, quantities: Sequence[str]) -> str:
    step = MONOLITHIC if row.step is None else f"{1e6 * row.step:g} us"
    if row.failed:
        return f"{step:>12}  {row.failed}"
    errors = "".join(f"{_shown(row, name):>12}" for name in quantities)
    wall = "-" if row.wall is None else f"{row.wall:.3g}"
    return f"{step:>12}{errors}{wall:>12}" + (f"  ledger {row.ledger}" if row.ledger else "")


def _shown(row: Row, name: str) -> str:
    error = row.errors.get(name)
    return "-" if error is None else f"{ERROR_COLUMNS[name].factor * error:.2g}"


def _orders(comparison: Comparison) -> list[str]:
    """By scheme; the steps used stand beside the order."""
    width = max(len(name) for name in comparison.asked.schemes) + 2
    quantities = comparison.quantities
    head = f"{'order':<{width}}" + "".join(f"{ERROR_COLUMNS[q].title:>22}" for q in quantities)
    body = [
        f"{name:<{width}}" + "".join(f"{_order(comparison, name, q):>22}" for q in quantities)
        for name in comparison.asked.schemes
    ]
    return [head, *body]


def _order(comparison: Comparison, scheme: str, quantity: str) -> str:
    order = comparison.orders(scheme)[quantity]
    if order is None:
        return "-"
    return f"{order.value:.2f} ({1e6 * order.steps[0]:g}-{1e6 * order.steps[-1]:g} us)"


def advice(comparison: Comparison) -> list[str]:
    """Scheme and macro step for the wanted error."""
    wanted = f"for {1e6 * comparison.asked.wanted:g} um: "
    best = comparison.recommended()
    if best is None or best.step is None or best.wall is None:
        errors = [row for row in comparison.rows if row.errors]
        if not errors:
            return [f"{wanted}no scheme got there; try smaller --macro-steps"]
        least = min(errors, key=lambda row: row.errors["position"])
        near = f"{least.name} at {1e6 * (least.step or 0.0):g} us comes nearest"
        return [f"{wanted}none of these, {near}; try smaller --macro-steps or a larger --wanted"]
    text = (
        f'{wanted}--scheme {best.name} --macro-step "{1e6 * best.step:g} us" is '
        f"{1e6 * best.errors['position']:.2g} um off and takes {best.wall:.3g} s per simulated s"
    )
    solver = comparison.recommended_solver()
    if solver is None or solver.wall is None:
        return [text]
    return [text, f"  the fastest monolithic solver there, {solver.name}, takes {solver.wall:.3g} s"]


def write_report(comparison: Comparison, folder: Path) -> None:
    """work_precision.csv, orders.csv and work_precision.png into `folder`."""
    with writing_to(folder):
        write_table(comparison, folder / "work_precision.csv")
        write_orders(comparison, folder / "orders.csv")
        work_precision(comparison).savefig(folder / "work_precision.png", dpi=110)


def write_table(comparison: Comparison, path: Path) -> None:
    """All rows, errors in SI and in full precision."""
    units = dict.fromkeys(ERROR_COLUMNS, "relative") | {"position": "m", "velocity": "m_s"}
    records: list[Mapping[str, object]] = [
        {
            "scheme": row.name,
            "macro_step_s": row.step,
            **{f"{name}_error_{unit}": row.errors.get(name) for name, unit in units.items()},
            "wall_time_per_simulated_s": row.wall,
            "ledger": row.ledger,
            "failed": row.failed,
        }
        for row in (*comparison.rows, *comparison.monolithic)
    ]
    write_records(records, path)


def write_orders(comparison: Comparison, path: Path) -> None:
    """Fitted orders, and the steps they were fitted to."""
    records: list[Mapping[str, object]] = []
    for scheme in comparison.asked.schemes:
        for quantity in comparison.quantities:
            order = comparison.orders(scheme)[quantity]
            records.append(
                {
                    "scheme": scheme,
                    "quantity": quantity,
                    "order": None if order is None else order.value,
                    "macro_steps_s": "" if order is None else " ".join(f"{s:g}" for s in order.steps),
                }
            )
    write_records(records, path)
