"""A multisine: lines at multiples of a frequency, with phases by Schroeder, which keep its peaks low.

With `ratio` above 1 the lines are spread as on a logarithmic scale: each is the first multiple that is at
least so many times the one before. All of them repeat themselves after one period of the frequency. What
a square law makes of odd multiples is at even ones.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from ..modelkit.kernel import kernel
from ..modelkit.variables import SWITCH, choice, integer, real

ROUNDING = 1e-9  # of a line's number


@dataclass(frozen=True)
class Lines:
    """Of a multisine; a sine is one line."""

    frequency: float = real(
        20.0 * math.pi, "rad/s", "angular frequency, of which lines are multiples", above=0.0, shown="Hz"
    )
    first: int = integer(1, "multiple of the first line", minimum=1)
    count: int = integer(1, "lines", minimum=1)
    ratio: float = real(1.0, "1", "of a line to the one before, at least", minimum=1.0, needs="count > 1")
    odd: int = choice(0, SWITCH, "whether the lines after the first are odd multiples", needs="count > 1")


@kernel
def next_line(line, p):
    """The multiple that comes after `line`."""
    following = max(line + 1, math.ceil(line * p.ratio - ROUNDING))
    return following + 1 if p.odd == 1 and following % 2 == 0 else following


@kernel
def sum_of_lines(time, p):
    """Of cosines of size 1 at `time` (s) from the multisine's beginning, p: `Lines`."""
    total, line = 0.0, p.first
    for n in range(p.count):
        total += math.cos(line * p.frequency * time - math.pi * n * (n + 1) / p.count)
        line = next_line(line, p)
    return total
