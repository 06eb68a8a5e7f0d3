"""How many drops a machine survives, as a picture."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.figure import Figure, FigureBase
from matplotlib.ticker import MaxNLocator

from ...master.common.files import writing_to
from ...master.results.whirl.verdict import CONFIDENCE
from ...reports.figures.style import BLUE, save, sized
from .survival import Survival

PICTURE = "survival.png"


def write_survival(found: Survival, drops: Sequence[int], path: Path) -> None:
    """Draw it into a file."""
    figure = Figure(layout="constrained")
    draw_survival(sized(figure, 6.4, 4.2), found, drops)
    with writing_to(path):
        save(figure, path)


def draw_survival(figure: FigureBase, found: Survival, drops: Sequence[int]) -> Axes:
    """Probability [1] that the machine survives, over the number of drops, with its interval."""
    axes = figure.subplots()
    after = [found.after(n) for n in drops]
    axes.fill_between(
        drops, [s.low for s in after], [s.high for s in after], color=BLUE, alpha=0.25, lw=0.0,
        label=f"{CONFIDENCE:.0%} confidence, of {found.count} drops",
    )  # fmt: skip
    axes.plot(drops, [s.value for s in after], "o-", color=BLUE, ms=3.0)
    axes.xaxis.set_major_locator(MaxNLocator(integer=True))
    axes.set(xlabel="drops", ylabel="survived with probability [1]", ylim=(0.0, 1.05))
    axes.set_title(f"Ended by {found.limit.words()}, or used up by fatigue", fontsize="medium")
    axes.legend()
    return axes
