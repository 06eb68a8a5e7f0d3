"""A run that is over: what it leaves in memory for figures and pictures drawn later.

A system that has ended is read for values, for its variables and connections. A `FinalState` has all of
them, and holds no FMU any more. Functions that read either take a `ReadableSystem`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol

from ..common.errors import TouchdownError
from ..components.component import READABLE, Component, ScalarVariable
from ..coupling.connections import Attachment, Connection
from ..coupling.system import System
from ..scene.scene import Scene
from .recording import Recording


class ReadableComponent(Protocol):
    """A component, or what is known of one."""

    @property
    def variables(self) -> Mapping[str, ScalarVariable]:
        """All of them, by name."""
        ...

    def read(self, names: Sequence[str]) -> list[float]:
        """Values of variables, integers as such."""
        ...


class ReadableSystem(Protocol):
    """A system that ended, or its `FinalState`."""

    @property
    def components(self) -> Mapping[str, ReadableComponent]:
        """By name."""
        ...

    @property
    def attachments(self) -> Sequence[Attachment]:
        """Bearings' ports on bodies' ports."""
        ...

    @property
    def connections(self) -> Sequence[Connection]:
        """The connections: which output feeds which input."""
        ...

    def __contains__(self, name: str) -> bool:
        """Whether there is COMPONENT.VARIABLE."""
        ...

    def value(self, name: str) -> float:
        """Value of COMPONENT.VARIABLE."""
        ...


@dataclass(frozen=True)
class FinalValues:
    """The final values of a component: all its numbers and Booleans, or none."""

    variables: Mapping[str, ScalarVariable]  # those that have a value
    values: Mapping[str, float]

    def read(self, names: Sequence[str]) -> list[float]:
        """Values of real, integer and Boolean variables, the last two as whole numbers."""
        return [self.values[name] for name in names]


@dataclass(frozen=True)
class FinalState:
    """A system as it ended."""

    components: Mapping[str, FinalValues]
    attachments: Sequence[Attachment]
    connections: Sequence[Connection]

    def __contains__(self, name: str) -> bool:
        """Whether it has the value of COMPONENT.VARIABLE."""
        component, _, variable = name.partition(".")
        return component in self.components and variable in self.components[component].values

    def value(self, name: str) -> float:
        """Value of COMPONENT.VARIABLE. Raises TouchdownError where there is none."""
        if name not in self:
            raise TouchdownError(
                f"there is no value of {name}; it is not a number, or the run did not record it"
            )
        component, _, variable = name.partition(".")
        return self.components[component].values[variable]


@dataclass(frozen=True)
class Finished:
    """A run that is over."""

    scene: Scene
    system: ReadableSystem
    recording: Recording


def final_state(system: System) -> FinalState:
    """The present state of `system`, once and for all."""
    last = {name: _last_values(component) for name, component in system.components.items()}
    return FinalState(last, tuple(system.attachments), tuple(system.connections))


def _last_values(component: Component) -> FinalValues:
    numbers = {name: v for name, v in component.variables.items() if v.kind in READABLE}
    try:
        return FinalValues(numbers, dict(zip(numbers, component.read(list(numbers)), strict=True)))
    except TouchdownError:  # one that failed may answer nothing more
        return FinalValues({}, {})
