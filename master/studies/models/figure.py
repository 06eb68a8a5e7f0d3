"""What could be left out of a scene: its price against its time."""

from __future__ import annotations

from matplotlib.figure import Figure

from touchdown.master.results.figures.style import BLUE, GREY, sheet
from touchdown.master.studies.models.compare import CLEAR, Comparison

LEAST = 1e-3  # %; what a price of nothing is drawn as


def error_against_time(comparison: Comparison) -> Figure:
    """Bars of price and of time, a line for each variant, in the order of the table."""
    rows = [row for row in comparison.rows if row.price is not None]
    figure = sheet(12, 1.6 + 0.32 * len(rows))
    price, time = figure.subplots(1, 2, sharey=True)
    names = [row.title for row in rows]
    price.barh(names, [max(row.price.percent, LEAST) for row in rows if row.price], color=BLUE, left=LEAST)
    price.axvline(CLEAR, color=GREY, ls="--", lw=0.8)
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
