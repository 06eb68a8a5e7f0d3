"""Schemes of the caller's own, carried into processes: those start with the project's alone."""

from __future__ import annotations

import pickle
import sys
from collections.abc import Callable
from dataclasses import dataclass
from typing import Generic, TypeVar

from touchdown.master.common.errors import TouchdownError
from touchdown.master.coupling import steppers
from touchdown.master.coupling.steppers.stepper import Stepper
from touchdown.master.scene import schemes

Task = TypeVar("Task")
Value = TypeVar("Value")


@dataclass(frozen=True)
class Carrying(Generic[Task, Value]):
    """Work for other processes, which first register what was registered here."""

    work: Callable[[Task], Value]
    registered: bytes  # pickled schemes and steppers: those that cannot be had there fail with the task

    def __call__(self, task: Task) -> Value:
        sequences, own = pickle.loads(self.registered)
        for sequence, stepper in sequences.items():
            steppers.register(sequence, stepper)
        for scheme in own:
            schemes.register(scheme)
        return self.work(task)


def carrying(work: Callable[[Task], Value]) -> Carrying[Task, Value]:
    """`work` with what is registered now. Raises TouchdownError for a stepper no other process can have."""
    own = steppers.registered()
    for stepper in own.values():
        _require_importable(stepper)
    return Carrying(work, pickle.dumps((own, schemes.registered())))


def _require_importable(stepper: type[Stepper]) -> None:
    main = sys.modules["__main__"]
    typed = stepper.__module__ == "__main__" and not hasattr(main, "__file__")  # in a notebook, a shell
    if typed or "<locals>" in stepper.__qualname__:
        raise TouchdownError(
            f"other processes cannot import the stepper {stepper.__qualname__}; put it at the top of a "
            "module of its own, and import it from there"
        )
