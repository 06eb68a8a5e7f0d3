"""What is measured: medians with their spread, rows of a table, and exponents of growth."""

from __future__ import annotations

import statistics
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Spread:
    """Median, least and most of what several runs gave."""

    median: float
    least: float
    most: float

    @property
    def text(self) -> str:
        """For people: three digits, and the range where there is one."""
        if self.least == self.most:
            return f"{self.median:.3g}"
        return f"{self.median:.3g} ({self.least:.3g}-{self.most:.3g})"


def spread(values: Sequence[float]) -> Spread:
    """Of at least one value."""
    return Spread(statistics.median(values), min(values), max(values))


def in_turns(ways: Mapping[str, Callable[[], float]], repeat: int) -> dict[str, Spread]:
    """Each of `ways` asked `repeat` times, in turns: a machine that slows down meanwhile slows all."""
    found: dict[str, list[float]] = {name: [] for name in ways}
    for _ in range(repeat):
        for name, measure in ways.items():
            found[name].append(measure())
    return {name: spread(values) for name, values in found.items()}


def exponent(sizes: Sequence[float], costs: Sequence[float]) -> float:
    """Of the power of `sizes` that `costs` grow with: least squares of the logarithms."""
    return float(np.polyfit(np.log(sizes), np.log(costs), 1)[0])


@dataclass(frozen=True)
class Block:
    """Rows of the table under a head of their own; the first column names what was measured."""

    title: str
    head: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]

    def lines(self) -> Iterator[str]:
        """For the screen."""
        widths = [max(map(len, column)) for column in zip(self.head, *self.rows, strict=True)]
        yield from ("", self.title)
        for row in (self.head, *self.rows):
            first, *others = (
                text.ljust(w) if not i else text.rjust(w)
                for i, (text, w) in enumerate(zip(row, widths, strict=True))
            )
            yield "  ".join([first, *others]).rstrip()
