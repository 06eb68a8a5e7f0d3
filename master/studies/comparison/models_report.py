"""Variants of a scene beside each other, as lines, files and figure."""

from __future__ import annotations

import csv
from pathlib import Path

from matplotlib.figure import Figure

from ...common.files import writing_to
from ...results.figures.style import BLUE, GREY, sheet
from ..drop.first_impact import AVERAGING_TIME, forces_text
from .models import MAX_COST_PERCENT, Comparison, Price, Row

MIN_DRAWN_COST = 1e-3  # %; what a price of nothing is drawn as


def error_against_time(comparison: Comparison) -> Figure:
    """Bars of price and of time, a line for each variant, in the order of the table."""
    rows = [row for row in comparison.rows if row.price is not None]
    figure = sheet(12, 1.6 + 0.32 * len(rows))
    price, time = figure.subplots(1, 2, sharey=True)
    names = [row.title for row in rows]
    price.barh(
        names,
        [max(row.price.percent, MIN_DRAWN_COST) for row in rows if row.price],
        color=BLUE,
        left=MIN_DRAWN_COST,
    )
    price.axvline(MAX_COST_PERCENT, color=GREY, ls="--", lw=0.8)
    price.set_xscale("log")
    price.set_xlabel("largest change of the journal's forces, position over orbit, orbit [%]")
    time.barh(names, [row.ratio for row in rows if row.ratio is not None], color=GREY)
    time.axvline(1.0, color=GREY, ls="--", lw=0.8)
    time.set_xlabel("wall time over that of the scene as it is")
    price.invert_yaxis()
    for axes in (price, time):
        axes.grid(alpha=0.3, axis="x")
    figure.suptitle(f"{comparison.scene.title}: what it does not need")
    return figure


WIDTH = 12
TABLE_HEADS = (
    ("first", "contact us"),
    ("journal", "force %"),
    ("contact", "force %"),
    ("position", "um"),
    ("orbit", "%"),
    ("worst ball", "force %"),
    ("ball side", "force %"),
    ("wall/", "simulated"),
    ("time", "ratio"),
)


def report_lines(comparison: Comparison) -> list[str]:
    """What the scene does, a table of what variants change, and what may be left out."""
    return [*_about(comparison), "", *_table(comparison), "", *advice(comparison)]


def _about(comparison: Comparison) -> list[str]:
    drop = comparison.drop
    about = [comparison.scene.title]
    average = max(AVERAGING_TIME, comparison.scene.run.macro_step)
    for seat, end in drop.ends.items():
        peaks = drop.peaks[seat]
        about.append(
            f"  {seat}: first impact over at {1e3 * end:.4g} ms, journal force {peaks.force:.5g} N over "
            f"{1e6 * average:g} us, {forces_text(drop.traces[seat].momentary_until(end))}"
        )
    about.append(
        f"  first contact {1e3 * drop.first:.5g} ms, largest orbit {1e6 * drop.orbit():.4g} um up to "
        f"{1e3 * (comparison.end - drop.first):.3g} ms after it"
    )
    where = "in process" if comparison.in_process else "through FMUs"
    about.append(
        f"wall time {where}, recorded, median of {comparison.repeat}; position: as the impact ends"
    )
    about.append("other bearings have all parameters of the scene's that they know")
    return about


def _table(comparison: Comparison) -> list[str]:
    width = max(len(row.title) for row in comparison.rows) + 2
    top, below = ("".join(f"{head[i]:>{WIDTH}}" for head in TABLE_HEADS) for i in (0, 1))
    unchanged = [""] * (len(TABLE_HEADS) - 2)
    own = "".join(f"{cell:>{WIDTH}}" for cell in (*unchanged, f"{comparison.wall:.3g}", "1.00"))
    return [
        f"{'changes against the scene':<{width}}{top}",
        f"{'':<{width}}{below}",
        f"{'as it is':<{width}}{own}",
        *(f"{row.title:<{width}}{_cells(comparison, row)}" for row in comparison.rows),
    ]


def _cells(comparison: Comparison, row: Row) -> str:
    price = row.price
    if price is None or row.wall is None or row.ratio is None:
        return f"  {row.failed}"
    cells = (
        f"{1e6 * price.first:+.2f}",
        f"{100.0 * price.force:+.2f}",
        f"{100.0 * price.contact:+.2f}",
        f"{1e6 * price.position:.3g}",
        f"{100.0 * price.orbit:+.2f}",
        _percent(price.ball),
        _percent(price.side),
        f"{row.wall:.3g}",
        f"{row.ratio:.2f}",
    )
    return "".join(f"{cell:>{WIDTH}}" for cell in cells)


def _percent(change: float | None) -> str:
    return "-" if change is None else f"{100.0 * change:+.2f}"


def advice(comparison: Comparison) -> list[str]:
    """What makes the scene faster without changing it by much."""
    good = comparison.dispensable()
    if not good:
        return [f"nothing of these makes the scene faster for less than {MAX_COST_PERCENT:g} %"]
    return [
        f"for less than {MAX_COST_PERCENT:g} % of the journal's forces, position (over the orbit) and "
        "orbit, "
        "each by itself:",
        *(
            f"  {row.title}: {row.price.percent:.2g} %, {row.ratio:.2f} of the time{_inside(row.price)}"
            for row in good
            if row.price is not None
        ),
    ]


def _inside(price: Price) -> str:
    """What it does to the forces inside the bearings, as the rest of a line."""
    changes = {"worst ball": price.ball, "ball side": price.side}
    known = [f"{title} {_percent(change)} %" for title, change in changes.items() if change is not None]
    return "".join(f"; {text}" for text in known)


def write_report(comparison: Comparison, folder: Path) -> None:
    """models.csv and models.png into `folder`."""
    with writing_to(folder):
        write_table(comparison, folder / "models.csv")
        error_against_time(comparison).savefig(folder / "models.png", dpi=110)


def write_table(comparison: Comparison, path: Path) -> None:
    fields = ("first", "force", "contact", "position", "orbit", "ball", "side")
    units = ("s", "relative", "relative", "m", "relative", "relative", "relative")
    titles = [f"{name}_change_{unit}" for name, unit in zip(fields, units, strict=True)]
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(["variant", *titles, "wall_time_per_simulated_s", "wall_time_ratio", "failed"])
        writer.writerow(["as it is", *[0.0] * len(fields), comparison.wall, 1.0, ""])
        for row in comparison.rows:
            values = [None if row.price is None else getattr(row.price, name) for name in fields]
            writer.writerow([row.title, *values, row.wall, row.ratio, row.failed])
