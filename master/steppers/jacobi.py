"""All components at once, each under what the others gave in the step before.

That is how many tools couple FMUs. The load comes one macro step late, which costs an order and makes
energy, unless the bearings lead: then they hand over the load of the step to come.
"""

from __future__ import annotations

from master.scene import RunSpec
from master.steppers.rates import Rates
from master.steppers.stepper import Stepper
from master.system import System


class Jacobi(Stepper):
    """Inputs for all, then steps, then outputs of all."""

    def __init__(self, system: System, run: RunSpec) -> None:
        super().__init__(system, run)
        self._rates = Rates(system, run.macro_step)

    def step(self, number: int, time: float, step: float) -> None:
        system = self.system
        due = [name for name in system.order if number % system.every[name] == 0]
        for name in due:
            system.take_inputs(name)
            self._rates.restrict(name, number)
            system.components[name].push()
        for name in due:
            system.components[name].step(time, system.every[name] * step)
        for name in due:
            system.components[name].pull()

    def follow(self) -> None:
        self._rates = Rates(self.system, self.run.macro_step)
