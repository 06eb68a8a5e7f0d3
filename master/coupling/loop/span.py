"""When a run begins and ends, and which components are stepped no more."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from ....modelkit.variables import Causality
from ...common.errors import TouchdownError
from ...components.component import LOAD, SLOPE, Component, FmiType
from ...scene.run_spec import RunSpec
from ...scene.scene import Scene
from ...scene.tables import time_of
from ..observer import Observer, RunState
from ..steppers.stepper import Stepper

TIME_RESOLUTION = 1e-3  # of a macro step, that times must tell apart


class Values(Protocol):
    """A reader of variables."""

    def value(self, name: str) -> float:
        """Value of COMPONENT.VARIABLE."""
        ...

    def __contains__(self, name: str) -> bool:
        """Whether there is COMPONENT.VARIABLE."""
        ...


@dataclass(frozen=True)
class Span:
    """The times of a run, s on the simulation's clock."""

    start: float
    end: float
    zero: float  # what its times count from: the scene's zero, or that of the clock
    origin: float  # what its duration counts from: the scene's zero, or the start

    @property
    def length(self) -> float:
        """How long it is (s)."""
        return self.end - self.start


def span(run: RunSpec, zero: float | None, impacts: bool = False) -> Span:
    """The times of `run`; `zero`: s on the simulation's clock, None where the scene names none.

    impacts: whether macro steps may be divided in impacts. Raises TouchdownError where it would end before
    it starts, or times are too large for its macro steps, or for parts of them.
    """
    start = run.start_time
    origin = start if zero is None else zero
    end = origin + run.duration
    if end <= start:
        raise TouchdownError(
            f"run.start_time = {start:g} s is not before the run's end at t = {end:g} s: run.duration = "
            f"{run.duration:g} s counts from the scene's zero at t = {origin:g} s; set that later"
        )
    _refuse_lost(start, run, impacts)
    return Span(start, end, 0.0 if zero is None else zero, origin)


def _refuse_lost(start: float, run: RunSpec, impacts: bool) -> None:
    """Raise TouchdownError where times as late as `start` (s) do not tell steps apart, or parts of them."""
    parts = run.impact_step if impacts and run.impact_step > 0.0 else math.inf
    for length, what, remedy in (
        (run.macro_step, "macro steps of", "take longer steps"),
        (parts, "parts of macro steps, of run.impact_step =", "take a longer one, or 0 to divide none"),
    ):
        if math.ulp(start) > TIME_RESOLUTION * length:
            raise TouchdownError(
                f"run.start_time = {start:g} s is too late: beside it {what} {length:g} s are lost in "
                f"rounding; start earlier, or {remedy}"
            )


def steps_in(length: float, step: float) -> int:
    """How many macro steps of `step` cover `length` (both s)."""
    return math.ceil(length / step - 1e-6)


def time_zero(scene: Scene, system: Values) -> float | None:
    """The scene's zero (s, simulation's clock); None where it has none, or one that went in a swap."""
    if scene.zero is None or removed_by_swap(scene, scene.zero, system):
        return None
    time = time_of(scene.zero)
    if time is not None:
        return time
    zero = system.value(scene.zero)
    if not math.isfinite(zero):
        raise TouchdownError(f"zero = {scene.zero} is {zero:g}; it must be a time")
    return zero


def zero_of(scene: Scene, system: Values) -> float:
    """The zero of all times (s, on the simulation's clock): that of the scene, or that of the clock."""
    zero = time_zero(scene, system)
    return 0.0 if zero is None else zero


def origin_of(scene: Scene, system: Values) -> float:
    """The time from which a run's duration counts, among its other times (s): 0 where a zero is named."""
    return scene.run.start_time if time_zero(scene, system) is None else 0.0


def until(scene: Scene, system: Values, time: float) -> Scene:
    """A copy of `scene` that ends at `time`, in s from what its times count from."""
    return scene.set({"run.duration": time - origin_of(scene, system)})


def brief(scene: Scene, system: Values, steps: int) -> Scene:
    """A copy of `scene` that ends `steps` macro steps after its start, or after a zero that is later."""
    zero = time_zero(scene, system)
    before = 0.0 if zero is None else max(scene.run.start_time - zero, 0.0)
    return scene.set({"run.duration": before + steps * scene.run.macro_step})


def removed_by_swap(scene: Scene, name: str, system: Values) -> bool:
    """Whether COMPONENT.VARIABLE is not there because another FMU was put in for that component."""
    spec = scene.components.get(name.partition(".")[0])
    return spec is not None and bool(spec.instead_of) and name not in system


ACTIVE = "active"  # an output; 0: the component does nothing any more but for the load it still gives


class _Follower(Protocol):
    """A reader of the signals."""

    def retired(self, names: Sequence[str]) -> None:
        """These components are stepped no more, and what is exchanged stands elsewhere in the signals."""
        ...


class IdleRemover(Observer):
    """Takes idle components out of the exchange, and tells stepper and followers."""

    at_beats_only = True

    def __init__(self, stepper: Stepper, followers: Iterable[_Follower]) -> None:
        self._stepper, self._followers = stepper, list(followers)
        components = stepper.system.components
        self._signs = {name: _signs_of_work(c) for name, c in components.items() if _can_rest(c)}

    def stepped(self, state: RunState) -> None:
        idle = [name for name, signs in self._signs.items() if not signs().any()]
        if idle:
            self.take_out(idle)

    def take_out(self, idle: Sequence[str]) -> None:
        """Take these components out."""
        self._stepper.system.retire(idle)
        self._stepper.follow()
        for follower in self._followers:
            follower.retired(idle)
        for name in idle:
            del self._signs[name]

    def due(self, state: RunState) -> int:
        """At beats, while there is who may retire."""
        return state.next_beat if self._signs else state.steps


def _can_rest(component: Component) -> bool:
    variable = component.variables.get(ACTIVE)
    whole_output = Causality.OUTPUT, FmiType.INTEGER
    return variable is not None and (variable.causality, variable.kind) == whole_output


def _signs_of_work(component: Component) -> Callable[[], np.ndarray]:
    """Fetches what is all zero where a component is idle: whether it is active, and the loads it gives."""
    loads = [
        v.name
        for v in component.variables.values()
        if v.causality is Causality.OUTPUT and v.name.rpartition(".")[2] in LOAD + SLOPE
    ]
    return component.reader([ACTIVE, *loads])
