"""Macro steps one by one."""

from __future__ import annotations

from touchdown.master.coupling.ledger import Ledger, Shortening
from touchdown.master.coupling.loop.impacts import Impacts
from touchdown.master.coupling.observer import Moment
from touchdown.master.coupling.steppers.stepper import Stepper


class MacroSteps:
    """Macro steps, whole or divided, each part of them booked."""

    def __init__(self, coupling: Stepper, ledger: Ledger, shortening: Shortening) -> None:
        self.coupling, self.ledger = coupling, ledger
        self.length = coupling.run.macro_step  # s
        self.booked = 0  # steps, with the parts of those divided
        self.impacts = Impacts(coupling)
        self._shortening = shortening

    @property
    def parts(self) -> int:
        """Into how many the next macro step is divided, impacts apart."""
        return 2**self._shortening.halvings

    def take(self, now: Moment) -> None:
        """Take one, and move on to its end. Raises TouchdownError where a component cannot go on."""
        number, begin = now.done, now.start + now.done * self.length
        parts = max(self.parts, self.impacts.parts_of(begin, self.length))
        part = self.length / parts
        for k in range(parts):
            self.coupling.step(number * parts + k, begin + k * part, part)
            self.booked += 1
            self.ledger.book(self.booked, part)
        now.move(number + 1, self.length)
