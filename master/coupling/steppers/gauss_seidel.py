"""Bearings first, from the bodies' state; then the bodies, under the loads just handed over."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ...components.component import Component
from ...scene.run_spec import RunSpec
from ..loop.kernels.signal_exchange import tick_within
from ..signal_layout import Scaling
from ..system import System
from .rates import Rates, StepPart
from .stepper import Stepper


class StepTurn(NamedTuple):
    """A component's part of a macro step: take its inputs, cut them, step, give."""

    component: Component
    places: np.ndarray  # of its inputs in the signals
    every: int  # macro steps of the run that it takes in one
    cuts: tuple[Scaling | StepPart, ...]  # what is done to its inputs
    period: float = 0.0  # s, of one that samples: it takes one step from each of its ticks

    def begins(self, number: int, time: float, step: float, inputs_at: float) -> float:
        """When (s) its step begins that it takes in macro step `number`, from `time` by `step` (s).

        Infinite: it takes none. inputs_at: when (s) the macro step began whose samples it is given.
        """
        if self.period > 0.0:
            return tick_within(inputs_at, step, self.period)
        return time if number % self.every == 0 else math.inf

    def feed(self, signals: np.ndarray, number: int) -> None:
        """Hand it its inputs for macro step `number` of the run."""
        self.component.inputs[:] = signals[self.places]
        for part in self.cuts:
            part.cut(self.component.inputs, number)
        self.component.push()

    def step(self, begin: float, step: float) -> None:
        """Its step from `begin` (s), with macro steps of `step` (s)."""
        self.component.step(begin, self.period or self.every * step)

    def take(self, signals: np.ndarray, number: int, time: float, step: float) -> None:
        """Macro step `number` of the run, from `time` by `step` (s), as far as it takes one."""
        begin = self.begins(number, time, step, time)
        if begin < math.inf:
            self.feed(signals, number)
            self.step(begin, step)
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

    def _turn(self, name: str, rates: Rates) -> StepTurn:
        system, intake = self.system, self.system.input_maps[name]
        cuts = (*intake.scalings, *rates.parts(name))
        period = system.periods.get(name, 0.0)
        return StepTurn(system.components[name], intake.places, system.every[name], cuts, period)

    def step(self, number: int, time: float, step: float) -> None:
        signals = self.system.signals
        for turn in self.turns:
            turn.take(signals, number, time, step)
