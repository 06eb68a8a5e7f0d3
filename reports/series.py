"""Curves over time for a chart that can be zoomed: few enough points, no peak lost.

Where a recording has more rows than MAX_ROWS, those of the first impact are all kept, and of the others
each stretch keeps the rows where one of the curves is largest or smallest.
"""

from __future__ import annotations

import base64
import json
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

MAX_ROWS = 16_000
IMPACT_ROWS = 5_000  # of them for the first impact
MARGIN_BEFORE_CONTACT = 0.02  # of these, before the first contact


@dataclass(frozen=True)
class Line:
    """A curve: its name, its colour (a word of the page's style), values of shape (rows,)."""

    label: str
    colour: str
    values: np.ndarray
    dot: bool = False  # a single value, at one time; nan at all others


@dataclass(frozen=True)
class Chart:
    """Curves with one unit over `time` (rows,), s from the shutdown."""

    name: str  # of its anchor
    title: str
    axis: str  # what is drawn, with its unit
    time: np.ndarray
    lines: Sequence[Line]
    impact: tuple[float, float] | None = None  # s, what the button to the first impact shows
    events: Sequence[tuple[float, str]] = ()  # s, and what happened then

    @property
    def data(self) -> str:
        """JSON for the page's script; numbers as base64 of little-endian floats."""
        values = {
            "title": self.title,
            "axis": self.axis,
            "time": packed(self.time, "<f8"),
            "lines": [
                {
                    "label": one.label,
                    "colour": one.colour,
                    "values": packed(one.values),
                    "dot": one.dot,
                }
                for one in self.lines
            ],
            "impact": self.impact,
            "events": self.events,
        }
        return json.dumps(values, separators=(",", ":")).replace("<", "\\u003c")


def packed(values: np.ndarray, kind: str = "<f4") -> str:
    """Numbers as base64, row by row."""
    return base64.b64encode(np.ascontiguousarray(values, dtype=kind).tobytes()).decode("ascii")


def chosen_rows(time: np.ndarray, columns: Sequence[np.ndarray], first: float | None) -> np.ndarray:
    """Rows (ascending) that a chart keeps of `columns`, each (rows,), over `time` (rows,), s.

    first: s, of the first contact, whose surroundings are kept whole; None: there is none.
    """
    count = len(time)
    if count <= MAX_ROWS:
        return np.arange(count)
    size = -(-2 * len(columns) * count // (MAX_ROWS - IMPACT_ROWS))
    kept = [about_impact(time, first), np.array([0, count - 1])]
    for column in columns:
        kept += _extremes(column, size)
    return np.unique(np.concatenate(kept))


def about_impact(time: np.ndarray, first: float | None) -> np.ndarray:
    """The rows about the first contact (s), all of which are kept; none where there is no contact."""
    if first is None:
        return np.arange(0)
    start = max(0, int(np.searchsorted(time, first)) - int(MARGIN_BEFORE_CONTACT * IMPACT_ROWS))
    return np.arange(start, min(start + IMPACT_ROWS, len(time)))


def _extremes(values: np.ndarray, size: int) -> list[np.ndarray]:
    """Rows of the smallest and the largest value in each stretch of `size` rows, the last one longer."""
    count = len(values) // size
    known = np.nan_to_num(values)
    blocks = known[: count * size].reshape(count, size)
    begins, tail = size * np.arange(count), (count - 1) * size
    last = np.array([tail + known[tail:].argmin(), tail + known[tail:].argmax()])
    return [begins + blocks.argmin(axis=1), begins + blocks.argmax(axis=1), last]


def at_times(time: np.ndarray, rows: np.ndarray, *values: np.ndarray) -> np.ndarray:
    """Recorded values, each (rows,), at other times (s): (len(time), len(values))."""
    return np.stack([np.interp(time, rows, column) for column in values], axis=1)


def largest_about(time: np.ndarray, rows: np.ndarray, size: np.ndarray) -> list[int]:
    """For each of `time` (s, increasing) the row about it where `size` (rows,) is largest."""
    edges = np.concatenate([[time[0]], 0.5 * (time[1:] + time[:-1]), [time[-1]]])
    first = np.minimum(np.searchsorted(rows, edges[:-1]), len(rows) - 1)
    last = np.maximum(np.searchsorted(rows, edges[1:]), first + 1)
    return [f + int(np.argmax(size[f:e])) for f, e in zip(first.tolist(), last.tolist(), strict=True)]
