"""What every sequence is: something that takes a whole system through a macro step."""

from __future__ import annotations

from abc import ABC, abstractmethod

from touchdown.master.coupling.system import System
from touchdown.master.scene.run_spec import RunSpec


class Stepper(ABC):
    """Steps an initialised system."""

    def __init__(self, system: System, run: RunSpec) -> None:
        self.system = system
        self.run = run

    @abstractmethod
    def step(self, number: int, time: float, step: float) -> None:
        """Take macro step `number` (from 0), from `time` by `step` (s).

        Raises TouchdownError where a component, or the coupling, cannot go on.
        """

    def follow(self) -> None:  # noqa: B027 - most have nothing to do
        """Components were retired: find what is used where it now stands."""

    @property
    def figures(self) -> dict[str, float]:
        """What it has to say of itself for the summary, named with units."""
        return {}
