"""Bearings first, from the bodies' state; then the bodies, under the loads just handed over."""

from __future__ import annotations

from master.scene import RunSpec
from master.steppers.rates import Rates
from master.steppers.stepper import Stepper
from master.system import System


class GaussSeidel(Stepper):
    """One component after another, in the system's order."""

    def __init__(self, system: System, run: RunSpec) -> None:
        super().__init__(system, run)
        self._rates = Rates(system, run.macro_step)

    def step(self, number: int, time: float, step: float) -> None:
        system = self.system
        for name in system.order:
            every = system.every[name]
            if number % every:
                continue
            system.take_inputs(name)
            self._rates.restrict(name, number)
            component = system.components[name]
            component.push()
            component.step(time, every * step)
            component.pull()

    def follow(self) -> None:
        self._rates = Rates(self.system, self.run.macro_step)
