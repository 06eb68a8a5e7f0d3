"""What the pictures of a run share: colours, and lines and stretches of time that can be read."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib.figure import Figure, FigureBase
from matplotlib.layout_engine import ConstrainedLayoutEngine

from touchdown.master.results.recording import Recording

BLUE, ORANGE, GREEN, PURPLE, GREY = "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#666666"
BLACK = "#000000"
COLOURS = (BLUE, ORANGE, GREEN, PURPLE, GREY)
WIDTH = 0.8  # pt, of a line
MOST_POINTS = 20_000  # drawn per line; peaks are kept
LAST = 0.05  # s, the last zoom of a run
TIME = "time from the shutdown [s]"
MARGIN = 0.1  # inch around a figure's panels, for labels at their ends


@dataclass(frozen=True)
class Curve:
    """One variable of a bearing, and how it is drawn."""

    variable: str
    label: str
    colour: str
    width: float = WIDTH


def present(recording: Recording, bearing: str, curves: tuple[Curve, ...]) -> list[Curve]:
    """Those of `curves` that the recording has for `bearing`."""
    return [c for c in curves if f"{bearing}.{c.variable}" in recording]


def beginning(time: np.ndarray) -> float:
    """Where pictures start (s): at the shutdown, or with the run where it ended before."""
    return 0.0 if time[-1] > 0.0 else float(time[0])


def zooms(time: np.ndarray, first: float) -> list[tuple[float, float]]:
    """The run from its beginning to `first`, all of it, and its end (s); none of them twice."""
    start, end = beginning(time), float(time[-1])
    spans = [(start, min(first, end)), (start, end), (max(start, end - LAST), end)]
    return list(dict.fromkeys(spans))


def thinned(x: np.ndarray, y: np.ndarray, most: int = MOST_POINTS) -> tuple[np.ndarray, np.ndarray]:
    """At most `most` points of a line (n,): each stretch's smallest and largest value."""
    if len(x) <= most:
        return x, y
    size = -(-len(x) // (most // 2))
    count = len(x) // size
    blocks = y[: count * size].reshape(count, size)
    index = np.sort(np.stack([blocks.argmin(1), blocks.argmax(1)], 1), axis=1)
    index = (index + np.arange(count)[:, None] * size).ravel()
    return x[index], y[index]


def roomy() -> ConstrainedLayoutEngine:
    """The layout of all figures: panels make room for their labels."""
    return ConstrainedLayoutEngine(w_pad=MARGIN, h_pad=0.5 * MARGIN)


def sheet(width: float = 6.4, height: float = 4.8) -> Figure:
    """An empty figure (inch) for a file: no window shows it."""
    return Figure(figsize=(width, height), layout=roomy())


def drawable(figure: FigureBase | None) -> FigureBase:
    """`figure`, or a new one of pyplot's, which a notebook or a window shows."""
    if figure is not None:
        return figure
    from matplotlib import pyplot  # looks for a display: only where one may be wanted

    return pyplot.figure(layout=roomy())


def sized(figure: FigureBase, width: float, height: float) -> FigureBase:
    """`figure` made as large as its panels want it (inch); part of another one, it stays as it is."""
    if isinstance(figure, Figure):
        figure.set_size_inches(width, height)
    return figure


def within(time: np.ndarray, span: tuple[float, float]) -> np.ndarray:
    """Which of the times lie in a span (s)."""
    return (time >= span[0]) & (time <= span[1])
