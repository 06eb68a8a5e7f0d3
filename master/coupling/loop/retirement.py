"""Components that have nothing left to do, such as a magnetic bearing that is off, are stepped no more."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Protocol

import numpy as np

from touchdown.master.components.component import Component, Kind
from touchdown.master.components.contract import LOAD, SLOPE
from touchdown.master.coupling.observer import Moment, Observer
from touchdown.master.coupling.steppers.stepper import Stepper
from touchdown.modelkit.variables import Causality

ACTIVE = "active"  # an output; 0: the component does nothing any more but for the load it still gives


class Follower(Protocol):
    """What reads the signals."""

    def retired(self, names: Sequence[str]) -> None:
        """These components are stepped no more, and what is exchanged stands elsewhere in the signals."""
        ...


class Retirement(Observer):
    """Takes idle components out of the exchange, and tells stepper and followers."""

    at_beats_only = True

    def __init__(self, stepper: Stepper, followers: Iterable[Follower]) -> None:
        self._stepper, self._followers = stepper, list(followers)
        components = stepper.system.components
        self._signs = {name: _signs_of_work(c) for name, c in components.items() if _can_rest(c)}

    def stepped(self, now: Moment) -> None:
        idle = [name for name, signs in self._signs.items() if not signs().any()]
        if not idle:
            return
        now.system.retire(idle)
        self._stepper.follow()
        for follower in self._followers:
            follower.retired(idle)
        for name in idle:
            del self._signs[name]

    def due(self, now: Moment) -> int:
        """At beats, while there is who may retire."""
        return now.next_beat if self._signs else now.steps


def _can_rest(component: Component) -> bool:
    variable = component.variables.get(ACTIVE)
    return variable is not None and (variable.causality, variable.kind) == (Causality.OUTPUT, Kind.INTEGER)


def _signs_of_work(component: Component) -> Callable[[], np.ndarray]:
    """Fetches what is all zero where a component is idle: whether it is active, and the loads it gives."""
    loads = [
        v.name
        for v in component.variables.values()
        if v.causality is Causality.OUTPUT and v.name.rpartition(".")[2] in LOAD + SLOPE
    ]
    return component.reader([ACTIVE, *loads])
