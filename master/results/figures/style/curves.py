"""Lines and stretches of time that can be read."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from touchdown.master.results.recording import Recording

WIDTH = 0.8  # pt, of a line
MOST_POINTS = 20_000  # drawn per line; peaks are kept
LAST = 0.05  # s, the last zoom of a run
TIME = "time from the shutdown [s]"


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
    """Where pictures start (s): at the shutdown, or with the run where it began later or ended before."""
    return max(0.0, float(time[0])) if time[-1] > 0.0 else float(time[0])


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


def within(time: np.ndarray, span: tuple[float, float]) -> np.ndarray:
    """Which of the times lie in a span (s)."""
    return (time >= span[0]) & (time <= span[1])
