"""One look for all pictures, and figures to draw them on."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from matplotlib import rc_context
from matplotlib.figure import Figure, FigureBase
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.rcsetup import cycler
from matplotlib.text import Text

from touchdown.master.results.figures.style.palette import BLACK, COLOURS, WHITE

MARGIN = 0.1  # inch around a figure's panels, for labels at their ends
EDGE, FAINT = "#808080", "#dddddd"
LOOK: dict[Any, Any] = {
    "figure.facecolor": WHITE,
    "savefig.facecolor": "auto",
    "axes.facecolor": WHITE,
    "axes.edgecolor": EDGE,
    "axes.labelcolor": BLACK,
    "axes.linewidth": 0.8,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.titlesize": "medium",
    "axes.prop_cycle": cycler(color=COLOURS),
    "figure.titlesize": "large",
    "font.size": 10.0,
    "grid.color": FAINT,
    "grid.linewidth": 0.5,
    "legend.fontsize": "small",
    "legend.frameon": True,
    "legend.framealpha": 0.85,
    "legend.edgecolor": "none",
    "legend.facecolor": WHITE,
    "text.color": BLACK,
    "xtick.color": EDGE,
    "ytick.color": EDGE,
    "xtick.labelcolor": BLACK,
    "ytick.labelcolor": BLACK,
}


@contextmanager
def styled() -> Iterator[None]:
    """Figures and axes made meanwhile have the look of the project's pictures, not the user's own."""
    with rc_context(LOOK):
        yield


def roomy() -> ConstrainedLayoutEngine:
    """The layout of all figures: panels make room for their labels."""
    return ConstrainedLayoutEngine(w_pad=MARGIN, h_pad=0.5 * MARGIN)


class Sheet(Figure):
    """A figure whose title is the user's words: a dollar sign in it begins no formula."""

    def suptitle(self, t: str, **kwargs: Any) -> Text:
        return super().suptitle(t, **{"parse_math": False, **kwargs})


def sheet(width: float = 6.4, height: float = 4.8) -> Figure:
    """An empty figure (inch) for a file: no window shows it."""
    return Sheet(figsize=(width, height), layout=roomy())


def drawable(figure: FigureBase | None) -> FigureBase:
    """`figure`, or a new one of pyplot's, which a notebook or a window shows."""
    if figure is not None:
        return figure
    from matplotlib import pyplot  # looks for a display: only where one may be wanted

    return pyplot.figure(FigureClass=Sheet, layout=roomy())


def sized(figure: FigureBase, width: float, height: float) -> FigureBase:
    """`figure` made as large as its panels want it (inch); part of another one, it stays as it is."""
    if isinstance(figure, Figure):
        figure.set_size_inches(width, height)
    return figure
