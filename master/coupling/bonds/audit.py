"""What the exchange over a bond made of energy.

The taker got the work of the force that it was told along its own motion. What the giver gave along the motion
that it was told is not seen directly: at the begin of a step it is put where the taker really came to, and
its force jumps there by feedthrough, D = dF/d(motion), times what the motion told ahead had missed. D is
found from what every step shows anyway: the force under the first of two holds, which differs from the course
of the force by D times what the hold differs from the motion told.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import product, repeat

import numpy as np

FORGOTTEN = 0.1  # share of what was learned that each observation takes the place of
RIDGE = 1e-6  # of the sum of squares; where position and velocity do not tell apart, it decides


@dataclass(frozen=True)
class Audit:
    """Work so far, and what is known of the feedthrough."""

    total: float = 0.0  # J, sum of |made| over steps
    made: float = 0.0  # J, by the exchange, less what it lost
    turned: float = 0.0  # J, sum of |work| over steps
    loaded: int = 0  # steps in which work was done
    squares: tuple[float, ...] = ()  # of what was told apart, a matrix row by row
    products: tuple[float, ...] = ()  # of that and the force's difference

    def booked(self, factor: float, taken: float, given: float) -> Audit:
        """With a step in which the taker got, and the giver gave, so much; `factor`: their unit in J."""
        made = factor * (taken - given)
        return replace(
            self,
            total=self.total + abs(made),
            made=self.made + made,
            turned=self.turned + abs(factor * taken),
            loaded=self.loaded + (taken != 0.0),
        )

    def learned(self, apart: Sequence[float], force: float) -> Audit:
        """With an observation: a motion `apart` from the held one would have changed the force by `force`."""
        kept = 1.0 - FORGOTTEN if self.squares else 0.0
        squares = tuple(
            kept * before + a * b
            for before, (a, b) in zip(self.squares or repeat(0.0), product(apart, repeat=2), strict=False)
        )
        before = zip(self.products or repeat(0.0), apart, strict=False)
        return replace(self, squares=squares, products=tuple(kept * p + force * a for p, a in before))

    def feedthrough(self, motion: Sequence[float]) -> float:
        """The force that a change of motion makes at once."""
        count = len(motion)
        squares = np.array(self.squares).reshape(count, count)
        size = np.trace(squares)
        if size <= 0.0:
            return 0.0
        gains = np.linalg.solve(squares + RIDGE * size * np.eye(count), np.array(self.products))
        return float(gains @ np.array(motion))
