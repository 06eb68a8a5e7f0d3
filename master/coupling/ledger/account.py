"""What is known of the energy that crossed one connection."""

from __future__ import annotations

from dataclasses import dataclass

from touchdown.master.coupling.connections import Attachment


@dataclass(slots=True)
class Account:
    """One connection's."""

    attachment: Attachment
    every: int = 1  # macro steps after which both sides have taken the same time
    total: float = 0.0  # sum of |r_n|, J
    made: float = 0.0  # minus the sum of r_n, J
    turned: float = 0.0  # sum of |mean force times displacement|, J
    kinetic: float = 0.0  # largest along the force, J; 0 where the body states no velocity
    unaudited: str = ""  # why, where it is not audited

    @property
    def turnover(self) -> float:
        """Energy that the motion turned over at the port (J)."""
        return self.turned + self.kinetic

    def book(self, residual: float) -> None:
        """Add a macro step's (J)."""
        self.total += abs(residual)
        self.made -= residual
