"""What the exchange over a bond made of energy.

The taker got the work of the force that it was told along its own motion. What the giver gave along the
motion that it was told is not seen directly: at the begin of a step it is put where the taker really came
to, and its force jumps there by feedthrough, D = dF/d(motion), times what the motion told ahead had missed.
D is found from what every step shows anyway: the force under the first of two holds, which differs from the
course of the force by D times what the hold differs from the motion told.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

FORGOTTEN = 0.1  # share of what was learned that each observation takes the place of
RIDGE = 1e-6  # of the sum of squares; where position and velocity do not tell apart, it decides
NEAR = 0.1  # of the motion asked for; what was told apart by less does not reach so far


@dataclass(frozen=True)
class Feedthrough:
    """How a force follows a motion (one or two values of one size) at once, by damped least squares."""

    aa: float = 0.0  # sums of products of what was told apart, a and b, and the force's difference, f
    ab: float = 0.0
    bb: float = 0.0
    af: float = 0.0
    bf: float = 0.0

    def learned(self, apart: Sequence[float], force: float) -> Feedthrough:
        """With an observation: a motion that is `apart` from the held one would change it by `force`."""
        a, b = (*apart, 0.0)[:2]
        kept = 1.0 - FORGOTTEN
        return Feedthrough(
            kept * self.aa + a * a,
            kept * self.ab + a * b,
            kept * self.bb + b * b,
            kept * self.af + a * force,
            kept * self.bf + b * force,
        )

    def of(self, motion: Sequence[float]) -> float:
        """The force that a change of motion makes at once; towards 0 where less than NEAR of it was seen.

        Motions that are hardly apart show rounding, and what else moves the force.
        """
        a, b = (*motion, 0.0)[:2]
        ridge = RIDGE * (self.aa + self.bb) + NEAR**2 * (a * a + b * b)
        aa, bb = self.aa + ridge, self.bb + ridge
        whole = aa * bb - self.ab * self.ab
        if whole <= 0.0:
            return 0.0
        return (a * (bb * self.af - self.ab * self.bf) + b * (aa * self.bf - self.ab * self.af)) / whole


@dataclass(frozen=True)
class Audit:
    """Work so far."""

    total: float = 0.0  # J, sum of |made| over steps
    made: float = 0.0  # J, by the exchange, less what it lost
    turned: float = 0.0  # J, sum of |work| over steps
    loaded: int = 0  # steps in which work was done
    passed: float = 0.0  # J, sum of the taker's work with its sign
    lowest: float = 0.0  # J, of that sum so far
    highest: float = 0.0
    drift: float = 0.0  # J, the largest |made| so far

    @property
    def share(self) -> float:
        """How large a part of what crossed was wrong, at least as much as the larger of two measures.

        Errors of both signs add up over the work of all steps. One that always has the same sign drains
        what swings to and fro, or feeds it, while work adds up with every cycle: so the sum of errors is
        also measured by the energy that swung across, the range of the work's sum.
        """
        swung = self.highest - self.lowest
        return max(
            self.total / self.turned if self.turned > 0.0 else 0.0,
            self.drift / swung if swung > 0.0 else 0.0,
        )

    def booked(self, factor: float, taken: float, given: float) -> Audit:
        """With a step in which the taker got, and the giver gave, so much; `factor`: their unit in J."""
        made = factor * (taken - given)
        passed = self.passed + factor * taken
        return Audit(
            self.total + abs(made),
            self.made + made,
            self.turned + abs(factor * taken),
            self.loaded + (taken != 0.0),
            passed,
            min(self.lowest, passed),
            max(self.highest, passed),
            max(self.drift, abs(self.made + made)),
        )
