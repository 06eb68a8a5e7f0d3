"""The interface of every stepper, and the state it goes back to."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from types import TracebackType
from typing import ClassVar

import numpy as np

from ...common.errors import TouchdownError
from ...quantities import Quantity
from ...scene.run_spec import RunSpec
from ..bonds.exchange import BondExchange
from ..snapshot import Kept
from ..system import System


class Checkpoint:
    """The state of all components that are stepped, and what they last gave; free it after use.

    With a stepper, what that knows of the past as well.
    Raises TouchdownError where a component cannot save its state, or fails to.
    """

    def __init__(self, system: System, stepper: Stepper | None = None) -> None:
        self._system, self._stepper = system, stepper
        self._memory = stepper.memory() if stepper else None
        self._signals = system.signals.copy()
        self._states: dict[str, object] = {}
        try:
            for name in system.order:
                self._states[name] = system.components[name].save()
        except TouchdownError:
            self._release()
            raise

    def restore(self) -> None:
        """Take the system back; may be called again."""
        for name, state in self._states.items():
            self._system.components[name].restore(state)
        self._system.signals[:] = self._signals
        if self._stepper:
            self._stepper.recall(self._memory)

    @property
    def signals(self) -> np.ndarray:
        """The latest outputs of the components."""
        return self._signals

    def __enter__(self) -> Checkpoint:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._release()

    def _release(self) -> None:
        for name, state in self._states.items():
            self._system.components[name].release(state)


def require_states(system: System, scheme: str) -> None:
    """Raise TouchdownError where a component cannot be taken back, or takes macro steps of its own."""
    for name, component in system.components.items():
        if not component.can_save:
            raise TouchdownError(
                f"scheme {scheme} takes components back in time, and {name} ({component.origin}) "
                "cannot save its state; choose another scheme, or another FMU"
            )
        if system.every[name] != 1:
            raise TouchdownError(
                f"scheme {scheme} steps all components alike; remove {name}.every = {system.every[name]}"
            )
        if name in system.periods:
            raise TouchdownError(f"scheme {scheme} steps all components alike; remove {name}.sampled")


def require_any_step(system: System, scheme: str) -> None:
    """Raise TouchdownError where a component takes steps of one length only."""
    for name, component in system.components.items():
        if not component.any_step:
            raise TouchdownError(
                f"scheme {scheme} divides steps, and {name} ({component.origin}) says that it takes steps "
                "of one length only; choose interface, or another FMU"
            )


class Stepper(Kept, ABC):
    """Steps an initialised system: a sequence of calls to its components.

    One of your own is a subclass of this, or of one of the project's; `register_scheme` gives it a name.

    >>> from touchdown.master.coupling.steppers.gauss_seidel import GaussSeidel
    >>> class Counting(GaussSeidel):
    ...     quantities = (touchdown.Quantity.of_scheme("steps_counted", "steps counted"),)
    ...     count = 0
    ...     def step(self, number, time, step):
    ...         super().step(number, time, step)
    ...         self.count += 1
    ...     @property
    ...     def figures(self):
    ...         return {"steps_counted": self.count}
    >>> scheme = touchdown.Scheme(
    ...     name="counting", title="interface, steps counted", order=3, slopes=True, modes=True,
    ...     error_order=3, angle_limit=1.0, sequence="counting",
    ... )
    >>> touchdown.register_scheme(scheme, Counting)
    >>> scene = touchdown.load("disk-caged-simplified").set({"run.duration": "1 ms"})
    >>> touchdown.run(scene.set({"run.scheme": "counting"}), in_process=True).summary["steps_counted"]
    60
    """

    in_one: ClassVar[bool] = False  # whether each component takes a macro step once, and in one
    any_step: ClassVar[bool] = False  # whether its steps may be of another length than those before
    quantities: ClassVar[tuple[Quantity, ...]] = ()  # what it tells that `master.quantities` has not yet
    any_moment: ClassVar[bool] = False  # whether they may be so without being told ahead (`expect`)

    def __init__(self, system: System, run: RunSpec) -> None:
        self.system = system
        self.run = run

    @abstractmethod
    def step(self, number: int, time: float, step: float) -> None:
        """Take macro step `number` (from 0), from `time` by `step` (s).

        Raises TouchdownError where a component, or the coupling, cannot go on. One of your own calls, for
        each name in self.system.order, self.system.feed(name), then step(time, step) and pull() of
        self.system.components[name]; or it extends a step of the project's, such as GaussSeidel's.
        """
        raise NotImplementedError(f"{type(self).__name__} must say how it steps")

    def expect(self, step: float) -> None:
        """The steps to come are of `step` (s)."""

    def follow(self) -> None:
        """Components were retired: find what is used where it now stands."""

    @property
    def crossings(self) -> Sequence[BondExchange]:
        """The bonds that it steps as such."""
        return ()

    def memory(self) -> object:
        """The memory of steps that are over, for `recall`; None: nothing."""
        return None

    def recall(self, memory: object) -> None:
        """Go back to what it knew."""

    @property
    def figures(self) -> dict[str, float]:
        """The run's quantities that it tells, by their keys, for the summary."""
        return {}
