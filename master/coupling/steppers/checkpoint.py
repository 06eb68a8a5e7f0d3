"""A whole system's state, to go back to."""

from __future__ import annotations

from types import TracebackType

import numpy as np

from touchdown.master.common.errors import TouchdownError
from touchdown.master.coupling.steppers.stepper import Stepper
from touchdown.master.coupling.system import System


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
        """What the components last gave."""
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


def require_any_step(system: System, scheme: str) -> None:
    """Raise TouchdownError where a component takes steps of one length only."""
    for name, component in system.components.items():
        if not component.any_step:
            raise TouchdownError(
                f"scheme {scheme} divides steps, and {name} ({component.origin}) says that it takes steps "
                "of one length only; choose interface, or another FMU"
            )
