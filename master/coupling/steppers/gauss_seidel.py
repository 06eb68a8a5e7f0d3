"""Bearings first, from the bodies' state; then the bodies, under the loads just handed over."""

from __future__ import annotations

from touchdown.master.coupling.steppers.rates import Rates
from touchdown.master.coupling.steppers.stepper import Stepper
from touchdown.master.coupling.system import System
from touchdown.master.scene.run_spec import RunSpec


class GaussSeidel(Stepper):
    """One component after another, in the system's order."""

    def __init__(self, system: System, run: RunSpec) -> None:
        super().__init__(system, run)
        self.follow()

    def follow(self) -> None:
        system = self.system
        rates = Rates(system, self.run.macro_step)
        self._turns = [
            (
                system.components[name],
                system.take[name],
                system.every[name],
                [*system.scales.get(name, ()), *rates.parts(name)],
            )
            for name in system.order
        ]

    def step(self, number: int, time: float, step: float) -> None:
        signals = self.system.signals
        for component, take, every, parts in self._turns:
            if number % every:
                continue
            component.inputs[:] = signals[take]
            for part in parts:
                part.cut(component.inputs, number)
            component.push()
            component.step(time, every * step)
            component.pull()
