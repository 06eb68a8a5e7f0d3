"""Schemes of the caller's own, carried into processes: those start with the project's alone."""

from __future__ import annotations

import pickle
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from typing import Generic, TypeVar

from ...scene import schemes
from ...scene.schemes import Scheme
from .. import steppers

Task = TypeVar("Task")
Value = TypeVar("Value")


@dataclass(frozen=True)
class _Carrying(Generic[Task, Value]):
    """Work for other processes, which first register what was registered here, as far as they can."""

    work: Callable[[Task], Value]
    schemes: Sequence[Scheme]
    steppers: Mapping[str, bytes]  # pickled, by sequence

    def __call__(self, task: Task) -> Value:
        for sequence, pickled in self.steppers.items():
            with suppress(AttributeError, ImportError):  # a notebook's: a run that needs it says so
                steppers.register_stepper(sequence, pickle.loads(pickled))
        for scheme in self.schemes:
            schemes.register_scheme(scheme)
        return self.work(task)


def carrying(work: Callable[[Task], Value]) -> _Carrying[Task, Value]:
    """`work` with what is registered now."""
    pickled: dict[str, bytes] = {}
    for sequence, stepper in steppers.registered_steppers().items():
        with suppress(AttributeError, pickle.PicklingError):  # of a class inside a function
            pickled[sequence] = pickle.dumps(stepper)
    return _Carrying(work, schemes.registered_schemes(), pickled)
