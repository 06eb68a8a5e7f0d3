"""All components at once, each under what the others gave in the step before.

That is how many tools couple FMUs. The load comes one macro step late, which costs an order and makes
energy, unless the bearings lead: then they hand over the load of the step to come.
"""

from __future__ import annotations

import math

from ...scene.run_spec import RunSpec
from ..system import System
from .gauss_seidel import GaussSeidel
from .rates import parts_of


class Jacobi(GaussSeidel):
    """Inputs for all, then steps, then outputs of all."""

    any_moment = False  # loads were given for steps as long as the last
    KEPT = ("_expected",)

    def __init__(self, system: System, run: RunSpec) -> None:
        super().__init__(system, run)
        self._expected = run.macro_step  # s, the step for which leading bearings gave their load

    def expect(self, step: float) -> None:
        if self.run.scheme.lead and step != self._expected:
            self._shift_loads(0.5 * (step - self._expected))
            self._expected = step

    def step(self, number: int, time: float, step: float) -> None:
        signals = self.system.signals
        self.expect(step)
        begins = [(turn, turn.begins(number, time, step, time - step)) for turn in self.turns]
        due = [(turn, begin) for turn, begin in begins if begin < math.inf]
        for turn, _ in due:
            turn.feed(signals, number)
        for turn, begin in due:
            turn.step(begin, step)
        for turn, begin in begins:  # until its own step ends, what it gave before holds
            if begin < math.inf if turn.period else (number + 1) % turn.every == 0:
                turn.component.pull()

    def _shift_loads(self, later: float) -> None:
        """Take the middle of loads that were given ahead `later` (s), as the step changes its length.

        What mean and slope leave open of a mode's motion belongs to the other length, and is left out.
        """
        system, signals = self.system, self.system.signals
        for body in system.order:
            places = system.input_maps[body].places
            for part in parts_of(system, body):
                signals[places[part.means[: len(part.slopes)]]] += signals[places[part.slopes]] * later
                signals[places[part.last]] = 0.0
