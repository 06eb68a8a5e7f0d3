"""Coupling schemes beside each other, as lines, files and picture."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ...reports.figures.style import BLACK, COLOURS, GREY
from ..drop.first_impact import forces_text
from ..drop.reference import POSITION, Refined
from ..findings import Column, Findings, Record, label_errors, panel_grid, paragraphs, table
from .engine import WALL_TIME, Row, error_cells, error_columns
from .schemes import ERROR_QUANTITIES, MIN_FITTED_STEPS, Comparison

MARKERS = "osD^v<>ph*"
MONOLITHIC = "monolithic"
WIDTH = 12  # of the table's columns


def findings(comparison: Comparison) -> Findings:
    """The reference, a table of errors, fitted orders, and a recommendation."""
    parts = (_about(comparison), _table(comparison), _orders(comparison), advice(comparison))
    return Findings(
        paragraphs(*parts),
        tables={
            "work_precision.csv": map(_record, (*comparison.rows, *comparison.monolithic)),
            "orders.csv": _order_records(comparison),
        },
        pictures={"work_precision.png": lambda: work_precision(comparison)},
        dots_per_inch=110,
    )


def work_precision(comparison: Comparison) -> Figure:
    """Panels: journal position and velocity, peak forces, ledger; labels are macro steps."""
    options, landing = comparison.options, comparison.landing
    title = (
        f"{comparison.scene.title}: wall time against error\n"
        f"up to {1e3 * (landing.end - landing.first):.3g} ms after the first contact, "
        f"{'in process' if options.in_process else 'through FMUs'}"
    )
    quantities = comparison.quantities
    figure, panels = panel_grid(len(quantities), 6.5, 5.0, title)
    for axes, key in zip(panels, quantities, strict=True):
        _panel(axes, comparison, key)
    panels[0].legend(fontsize=8)
    return figure


def _panel(axes: Axes, comparison: Comparison, key: str) -> None:
    quantity = ERROR_QUANTITIES[key]
    for i, scheme in enumerate(comparison.options.schemes):
        rows = [row for row in comparison.rows if row.name == scheme]
        style = {"color": COLOURS[i % len(COLOURS)], "marker": MARKERS[i % len(MARKERS)]}
        _curve(axes, rows, key, scheme, **style, ls="-" if i < len(COLOURS) else "--")
    _curve(axes, comparison.monolithic, key, MONOLITHIC, color=BLACK, marker="x", ls="")
    floor = quantity.factor * comparison.floors[key]
    if floor > 0.0:
        axes.axvline(floor, color=GREY, lw=0.8, ls=":")
    if key in comparison.targets:
        axes.axvline(quantity.factor * comparison.targets[key], color=GREY, lw=0.8, ls="--", label="wanted")
    axes.set_xscale("log")
    label_errors(axes, f"error of {' '.join(quantity.head)}", "wall time per simulated s [s]")


def _curve(axes: Axes, rows: Sequence[Row], key: str, label: str, **style: object) -> None:
    """The rows that have an error above zero, and a time."""
    points = [
        (ERROR_QUANTITIES[key].factor * row.errors[key], row.wall, row)
        for row in rows
        if row.wall is not None and 0.0 < row.errors.get(key, 0.0) < float("inf")
    ]
    if not points:
        return
    errors, walls, drawn = zip(*points, strict=True)
    axes.plot(errors, walls, lw=1.2, ms=5, label=label, **style)  # type: ignore[arg-type]
    for error, wall, row in zip(errors, walls, drawn, strict=True):
        text = row.name if row.step is None else f"{1e6 * row.step:g}"
        axes.annotate(text, (error, wall), xytext=(4, 3), textcoords="offset points", fontsize=7)


def _about(comparison: Comparison) -> Iterator[str]:
    landing, exact, options = comparison.landing, comparison.exact, comparison.options
    yield comparison.scene.title
    for seat, (start, end) in landing.impacts.items():
        forces = forces_text(landing.peaks(seat))
        yield f"  {seat}: first impact {1e3 * start:.4g} to {1e3 * end:.4g} ms, {forces}"
    first, second = exact.first, exact.second
    counted = "macro steps" if isinstance(first.solver, Refined) else "evaluations"
    known = ", ".join(
        f"{ERROR_QUANTITIES[q].head[0]} {100.0 * comparison.fine[q]:.1g} %" for q in comparison.forces
    )
    until = "the end" if exact.whole else f"{1e3 * exact.horizon:.4g} ms, where they part"
    yield (
        f"compared up to {1e3 * landing.end:.4g} ms, {1e3 * (landing.end - landing.first):.3g} ms after "
        "the first contact"
    )
    yield (
        f"reference: {first.solver.title} ({first.evaluations} {counted}) and {second.solver.title} "
        f"({second.evaluations}) agree to {1e6 * exact.floor(POSITION):.1g} um up to {until}"
    )
    yield (
        f"co-simulation in fine steps is off by {1e6 * comparison.fine['position']:.1g} um; "
        f"peak forces are measured against it, known to: {known}"
    )
    yield (
        f"wall time {'in process' if options.in_process else 'through FMUs'}, median of {options.repeat}; "
        "of monolithic solvers, one run in process"
    )


def _table(comparison: Comparison) -> list[str]:
    rows = [*comparison.rows, *comparison.monolithic]
    left = max(len(row.name) for row in rows) + 2
    label = Column[Row](
        (f"{'scheme':<{left}}{'macro step':>{WIDTH}}", ""),
        lambda row: f"{row.name:<{left}}{_step(row):>{WIDTH}}",
    )
    return table(
        label,
        [*error_columns(comparison.quantities), WALL_TIME],
        rows,
        instead=lambda row: row.failed,
        behind=lambda row: f"ledger {row.ledger}" if row.ledger else "",
        width=WIDTH,
    )


def _step(row: Row) -> str:
    return MONOLITHIC if row.step is None else f"{1e6 * row.step:g} us"


def _orders(comparison: Comparison) -> list[str]:
    """By scheme; the steps used stand beside the order."""
    if len(comparison.options.steps) < MIN_FITTED_STEPS:
        return [f"an order is fitted to {MIN_FITTED_STEPS} macro steps or more"]
    columns = [
        Column[str](quantity.head[:1], lambda scheme, key=key: _order(comparison, scheme, key))
        for key, quantity in comparison.quantities.items()
    ]
    return table(Column[str](("order",), str), columns, comparison.options.schemes, width=22)


def _order(comparison: Comparison, scheme: str, quantity: str) -> str:
    order = comparison.orders(scheme)[quantity]
    if order is None:
        return "-"
    return f"{order.value:.2f} ({1e6 * order.steps[0]:g}-{1e6 * order.steps[-1]:g} us)"


def advice(comparison: Comparison) -> list[str]:
    """Scheme and macro step for the error that is wanted."""
    target = f"for {1e6 * comparison.options.target:g} um: "
    best = comparison.recommended()
    if best is None or best.step is None or best.wall is None:
        errors = [row for row in comparison.rows if row.errors]
        if not errors:
            return [f"{target}no scheme got there; try smaller --macro-steps"]
        least = min(errors, key=lambda row: row.errors["position"])
        near = f"{least.name} at {1e6 * (least.step or 0.0):g} us comes nearest"
        return [f"{target}none of these, {near}; try smaller --macro-steps or a larger --wanted"]
    text = (
        f'{target}--scheme {best.name} --macro-step "{1e6 * best.step:g} us" is '
        f"{1e6 * best.errors['position']:.2g} um off and takes {best.wall:.3g} s per simulated s"
    )
    solver = comparison.recommended_solver()
    if solver is None or solver.wall is None:
        return [text]
    return [text, f"  the fastest monolithic solver there, {solver.name}, takes {solver.wall:.3g} s"]


def _record(row: Row) -> Record:
    return {
        "scheme": row.name,
        "macro_step_s": row.step,
        **error_cells(row, ERROR_QUANTITIES),
        "wall_time_per_simulated_s": row.wall,
        "ledger": row.ledger,
        "failed": row.failed,
    }


def _order_records(comparison: Comparison) -> Iterator[Record]:
    """Fitted orders, and the steps they were fitted to."""
    for scheme in comparison.options.schemes:
        for quantity in comparison.quantities:
            order = comparison.orders(scheme)[quantity]
            yield {
                "scheme": scheme,
                "quantity": quantity,
                "order": None if order is None else order.value,
                "macro_steps_s": "" if order is None else " ".join(f"{s:g}" for s in order.steps),
            }
