"""What the pictures of a run share: colours, and lines and stretches of time that can be read."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine

from touchdown.master.results.recording import Recording

BLUE, ORANGE, GREEN, PURPLE, GREY = "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#666666"
BLACK = "#000000"
COLOURS = (BLUE, ORANGE, GREEN, PURPLE, GREY)
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
    width: float = 0.8


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


def line(
    axes: Axes, x: np.ndarray, y: np.ndarray, colour: str, label: str, style: str = "-", width: float = 0.8
) -> None:
    """A line of at most MOST_POINTS points that keeps each stretch's smallest and largest value."""
    if len(x) > MOST_POINTS:
        size = -(-len(x) // (MOST_POINTS // 2))
        count = len(x) // size
        blocks = y[: count * size].reshape(count, size)
        index = np.sort(np.stack([blocks.argmin(1), blocks.argmax(1)], 1), axis=1)
        index = (index + np.arange(count)[:, None] * size).ravel()
        x, y = x[index], y[index]
    axes.plot(x, y, style, color=colour, lw=width, label=label)


def sheet(width: float, height: float) -> Figure:
    """An empty figure (inch) whose panels make room for their labels."""
    layout = ConstrainedLayoutEngine(w_pad=MARGIN, h_pad=0.5 * MARGIN)
    return Figure(figsize=(width, height), layout=layout)


def within(time: np.ndarray, span: tuple[float, float]) -> np.ndarray:
    """Which of the times lie in a span (s)."""
    return (time >= span[0]) & (time <= span[1])
