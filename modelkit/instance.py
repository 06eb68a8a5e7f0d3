"""One running instance of a model: its memory, and what stopped it where it cannot go on."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from touchdown.modelkit.integrators import dopri
from touchdown.modelkit.integrators.control import MOST_STEPS
from touchdown.modelkit.model import Model, ModelError, slots
from touchdown.modelkit.status import BAD_INPUT, BAD_LOAD, OK, TOO_MANY_STEPS
from touchdown.modelkit.variables import Causality, Scalar, as_tuple, from_record, layout


class Instance:
    """A model with its memory. The FMU and the in-process component both drive this class.

    `memory` (1,) is the record that kernels see (`Model`); `words`, `reals` and `integers` are views of its
    8-byte words, which `slots` count. `state` is the part of it that changes, parameters included; the
    rest follows from them.
    """

    def __init__(self, model: Model) -> None:
        self.model = model
        self.memory = np.zeros(1, model.memory)
        self.words = self.memory.view("f8")
        self._put("p", model.parameters())
        self._put("u", model.inputs())
        raw = self.memory.view("u1").data
        self.reals = raw.cast("d")
        self.integers = raw.cast("q")
        self.work = dopri.scratch(len(self.memory["q"][0]))
        self.slots = slots(model)
        fields: Any = model.memory.fields
        self.state = raw[: fields["d"][1]]
        self._parameters = raw[fields["p"][1] : fields["u"][1]]
        self._derived_from = b""  # the parameters m.d belongs to
        self._outdated = False  # m.d belongs to others than m.p

    @property
    def record(self) -> Any:
        """The memory as one record."""
        return self.memory[0]

    def start(self, time: float) -> None:
        """Check the parameters, derive what follows from them, and set state and outputs at `time` (s).

        Raises ModelError where a parameter or an input is out of bounds.
        """
        self._check_bounds()
        model, parameters = self.model, self._derive()
        self._put("o", model.outputs())
        self._put("s", model.hidden())
        self.memory["q"] = 0.0
        weights = model.weights(parameters)
        self.memory["n"] = len(weights)
        self.memory["weight"] = 0.0
        self.memory["weight"][0, : len(weights)] = weights
        self.memory["time"] = time
        self.memory["h"] = 1e-6
        self.memory["evaluations"] = 0
        model.start(self.words)

    def step(self, time: float, step: float) -> None:
        """Advance from `time` by `step` (s). Raises ModelError, naming what stopped it."""
        if not step > 0.0 or not math.isfinite(step) or not math.isfinite(time):
            raise ModelError(f"cannot step from t = {time} s by {step} s; the step must be positive")
        if self._outdated:
            self._derive()
        status = self.model.advance(self.words, self.work, time, step)
        if status != OK:
            raise ModelError(explanation(self, status, time, step))

    def save(self) -> bytes:
        """A copy of the state; constants that follow from its parameters are left out."""
        return self.state.tobytes()

    def restore(self, state: bytes | memoryview) -> None:
        """Go back to what `save` returned, here or in another instance of the same model.

        Where the parameters are others than before, constants are derived again ahead of the next step.
        """
        self.state[:] = state
        self._outdated = self._parameters != self._derived_from

    def _put(self, part: str, values: Any) -> None:
        """Write a declaration's values into the part of the memory that is laid out for them."""
        self.memory[part] = np.array([as_tuple(values)], layout(type(values)))

    def _derive(self) -> Any:
        """Compute from the parameters what follows from them; returns them."""
        model = self.model
        parameters = from_record(model.parameters, self.memory[0]["p"])
        problem = model.check(parameters)
        if problem:
            raise ModelError(problem)
        if model.derive is not None:
            self._put("d", model.derive(parameters))
        self._derived_from, self._outdated = self._parameters.tobytes(), False
        return parameters

    def _check_bounds(self) -> None:
        for slot in self.slots:
            if slot.causality is Causality.OUTPUT:
                continue
            store = self.reals if slot.variable.spec.kind is Scalar.REAL else self.integers
            problem = slot.variable.problem(store[slot.index])
            if problem:
                raise ModelError(problem)


def explanation(instance: Instance, status: int, time: float, step: float) -> str:
    """What stopped a macro step of `step` (s) from `time` (s), and what to do about it."""
    if status == BAD_INPUT:
        for slot in instance.slots:
            value = instance.reals[slot.index]
            if slot.causality is Causality.INPUT and not math.isfinite(value):
                return (
                    f"input {slot.variable.name} is {value} at t = {time:.9g} s; "
                    "look at the component that feeds it"
                )
    if status in (BAD_LOAD, BAD_INPUT):  # finite inputs can be too large to add up
        return (
            f"the load at t = {time:.9g} s is not a finite number; look for an input or a parameter "
            "that is out of all proportion"
        )
    if status == TOO_MANY_STEPS:
        return (
            f"more than {MOST_STEPS} micro-steps within one macro step of {step:g} s "
            f"at t = {time:.9g} s; take a smaller macro step or a larger interface.tolerance"
        )
    return (
        f"the motion inside cannot be resolved at t = {time:.9g} s with a macro step of {step:g} s; "
        "take a smaller macro step, or look for a contact that starts with a deep overlap"
    )
