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
        due = [turn for turn in self._turns if number % turn[2] == 0]
        for component, take, _, parts in due:
            component.inputs[:] = signals[take]
            for part in parts:
                part.cut(component.inputs, number)
            component.push()
        for component, _, every, _ in due:
            component.step(time, every * step)
        for component, _, every, _ in self._turns:
            if (number + 1) % every == 0:  # until its own step ends, what it gave before holds
                component.pull()
