"""All components at once, each under what the others gave in the step before.

That is how many tools couple FMUs. The load comes one macro step late, which costs an order and makes
energy, unless the bearings lead: then they hand over the load of the step to come.
"""

from __future__ import annotations

from touchdown.master.coupling.steppers.gauss_seidel import GaussSeidel


class Jacobi(GaussSeidel):
    """Inputs for all, then steps, then outputs of all."""

    def step(self, number: int, time: float, step: float) -> None:
        signals = self.system.signals
        due = [turn for turn in self._turns if number % turn.every == 0]
        for component, places, _, cuts in due:
            component.inputs[:] = signals[places]
            for part in cuts:
                part.cut(component.inputs, number)
            component.push()
        for turn in due:
            turn.component.step(time, turn.every * step)
        for turn in self._turns:
            if (number + 1) % turn.every == 0:  # until its own step ends, what it gave before holds
                turn.component.pull()
