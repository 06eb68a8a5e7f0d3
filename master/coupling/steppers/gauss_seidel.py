"""Bearings first, from the bodies' state; then the bodies, under the loads just handed over."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...components.component import Component
from ...scene.run_spec import RunSpec
from ..layout import Scaling
from ..system import System
from .rates import Part, Rates
from .stepper import Stepper


class Turn(NamedTuple):
    """What a component does in a macro step: take its inputs, cut them, step, give."""

    component: Component
    places: np.ndarray  # of its inputs in the signals
    every: int  # macro steps of the run that it takes in one
    cuts: tuple[Scaling | Part, ...]  # what is done to its inputs

    def take(self, signals: np.ndarray, number: int, time: float, step: float) -> None:
        """Macro step `number` of the run, from `time` by `step` (s)."""
        self.component.inputs[:] = signals[self.places]
        for part in self.cuts:
            part.cut(self.component.inputs, number)
        self.component.push()
        self.component.step(time, self.every * step)
        self.component.pull()


class GaussSeidel(Stepper):
    """One component after another, in the system's order."""

    in_one = any_step = any_moment = True

    def __init__(self, system: System, run: RunSpec) -> None:
        super().__init__(system, run)
        self.follow()

    def follow(self) -> None:
        rates = Rates(self.system, self.run.macro_step)
        self.turns = [self._turn(name, rates) for name in self.system.order]

    def _turn(self, name: str, rates: Rates) -> Turn:
        system, intake = self.system, self.system.intakes[name]
        cuts = (*intake.scalings, *rates.parts(name))
        return Turn(system.components[name], intake.places, system.every[name], cuts)

    def step(self, number: int, time: float, step: float) -> None:
        signals = self.system.signals
        for turn in self.turns:
            if number % turn.every == 0:
                turn.take(signals, number, time, step)
