"""Variants of a scene beside each other, as lines, files and picture."""

from __future__ import annotations

from collections.abc import Iterator

from matplotlib.figure import Figure

from ...results.figures.style import BLUE, GREY, sheet
from ..drop.first_impact import AVERAGING_TIME, forces_text
from ..findings import Column, Findings, Record, number, paragraphs, table
from .engine import Row
from .models import MAX_CHANGE_PERCENT, Comparison

MIN_DRAWN_CHANGE = 1e-3  # %; what no change is drawn as
WIDTH = 12  # of the table's columns
AS_IT_IS = "as it is"

# by error: its head in two lines, factor from SI, format, unit in the file
ERROR_COLUMNS = {
    "first": (("first", "contact us"), 1e6, "+.2f", "s"),
    "force": (("journal", "force %"), 100.0, "+.2f", "relative"),
    "contact": (("contact", "force %"), 100.0, "+.2f", "relative"),
    "position": (("position", "um"), 1e6, ".3g", "m"),
    "orbit": (("orbit", "%"), 100.0, "+.2f", "relative"),
    "ball": (("worst ball", "force %"), 100.0, "+.2f", "relative"),
    "side": (("ball side", "force %"), 100.0, "+.2f", "relative"),
}


def findings(comparison: Comparison) -> Findings:
    """What the scene does, a table of what variants change, and what may be left out."""
    return Findings(
        paragraphs(_about(comparison), _table(comparison), advice(comparison)),
        tables={"models.csv": _records(comparison)},
        pictures={"models.png": lambda: error_against_time(comparison)},
        dots_per_inch=110,
    )


def error_against_time(comparison: Comparison) -> Figure:
    """Bars of change and of time, a line for each variant, in the order of the table."""
    rows = [row for row in comparison.rows if not row.failed]
    figure = sheet(12, 1.6 + 0.32 * len(rows))
    change, time = figure.subplots(1, 2, sharey=True)
    names = [row.name for row in rows]
    changes = [max(comparison.change_percent(row), MIN_DRAWN_CHANGE) for row in rows]
    change.barh(names, changes, color=BLUE, left=MIN_DRAWN_CHANGE)
    change.axvline(MAX_CHANGE_PERCENT, color=GREY, ls="--", lw=0.8)
    change.set_xscale("log")
    change.set_xlabel("largest change of the journal's forces, position over orbit, orbit [%]")
    time.barh(names, [row.ratio for row in rows if row.ratio is not None], color=GREY)
    time.axvline(1.0, color=GREY, ls="--", lw=0.8)
    time.set_xlabel("wall time over that of the scene as it is")
    change.invert_yaxis()
    for axes in (change, time):
        axes.grid(alpha=0.3, axis="x")
    figure.suptitle(f"{comparison.scene.title}: what it does not need")
    return figure


def _about(comparison: Comparison) -> Iterator[str]:
    drop = comparison.drop
    yield comparison.scene.title
    average = max(AVERAGING_TIME, comparison.scene.run.macro_step)
    for seat, end in drop.ends.items():
        yield (
            f"  {seat}: first impact over at {1e3 * end:.4g} ms, journal force "
            f"{drop.peaks[seat].force:.5g} N over {1e6 * average:g} us, "
            f"{forces_text(drop.traces[seat].momentary_until(end))}"
        )
    yield (
        f"  first contact {1e3 * drop.first:.5g} ms, largest orbit {1e6 * drop.orbit():.4g} um up to "
        f"{1e3 * (comparison.end - drop.first):.3g} ms after it"
    )
    where = "in process" if comparison.in_process else "through FMUs"
    yield f"wall time {where}, recorded, median of {comparison.repeat}; position: as the impact ends"
    yield "other bearings have all parameters of the scene's that they know"


def _table(comparison: Comparison) -> list[str]:
    own = Row(AS_IT_IS, wall=comparison.wall, ratio=1.0)
    columns = [
        Column[Row](head, lambda row, key=key: "" if row is own else _shown(row, key))
        for key, (head, *_) in ERROR_COLUMNS.items()
    ]
    columns.append(Column(("wall/", "simulated"), lambda row: number(row.wall, ".3g")))
    columns.append(Column(("time", "ratio"), lambda row: number(row.ratio, ".2f")))
    label = Column[Row](("changes against the scene", ""), lambda row: row.name)
    rows = [own, *comparison.rows]
    return table(label, columns, rows, instead=lambda row: row.failed, width=WIDTH)


def _shown(row: Row, key: str) -> str:
    _, factor, form, _ = ERROR_COLUMNS[key]
    return number(factor * row.errors[key] if key in row.errors else None, form)


def advice(comparison: Comparison) -> list[str]:
    """What makes the scene faster without changing it by much."""
    good = comparison.dispensable()
    if not good:
        return [f"nothing of these makes the scene faster for less than {MAX_CHANGE_PERCENT:g} %"]
    return [
        f"for less than {MAX_CHANGE_PERCENT:g} % of the journal's forces, position (over the orbit) and "
        "orbit, each by itself:",
        *(
            f"  {row.name}: {comparison.change_percent(row):.2g} %, {row.ratio:.2f} of the time"
            f"{_inside(row)}"
            for row in good
        ),
    ]


def _inside(row: Row) -> str:
    """What it does to the forces inside the bearings, as the rest of a line."""
    titles = {"ball": "worst ball", "side": "ball side"}
    return "".join(f"; {titles[key]} {_shown(row, key)} %" for key in titles if key in row.errors)


def _records(comparison: Comparison) -> Iterator[Record]:
    unchanged = dict.fromkeys(ERROR_COLUMNS, 0.0)
    for row in (Row(AS_IT_IS, None, unchanged, comparison.wall, ratio=1.0), *comparison.rows):
        yield {
            "variant": row.name,
            **{f"{key}_change_{unit}": row.errors.get(key) for key, (*_, unit) in ERROR_COLUMNS.items()},
            "wall_time_per_simulated_s": row.wall,
            "wall_time_ratio": row.ratio,
            "failed": row.failed,
        }
