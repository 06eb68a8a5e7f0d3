"""One running instance of a model: its memory, and what stopped it where it cannot go on."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np

from . import messages
from .integrators import dopri
from .integrators.control import MAX_STEPS
from .kernel import interpret
from .model import Model, ModelError, Slot, StepSizeError, slots
from .status import BAD_INPUT, BAD_LOAD, OK, ROW_OFF, TOO_FAST, TOO_HOT, TOO_LONG_STEP, TOO_MANY_STEPS
from .variables import Causality, Scalar, as_tuple, from_record, layout

FIRST_STEP = 1e-6  # s; the micro-step to try first


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
        self.memory["p"], self.memory["u"] = _values(model.parameters), _values(model.inputs)
        raw = self.memory.view("u1").data
        self.reals = raw.cast("d")
        self.integers = raw.cast("q")
        self.work = dopri.scratch(len(self.memory["q"][0]))
        self.slots = slots(model)
        fields: Any = model.memory.fields
        self.state = raw[: fields["d"][1]]
        self._parameters = raw[fields["p"][1] : fields["u"][1]]
        self._derived_for = b""  # the parameters m.d belongs to
        self._outdated = False  # m.d belongs to others than m.p
        self._effects = [slot for slot in self.slots if slot.variable.name in model.effects]
        self.advance = model.advance  # the kernel for the parameters that constants were derived for

    @property
    def record(self) -> Any:
        """The memory as one record."""
        return self.memory[0]

    def store(self, slot: Slot) -> memoryview[Any]:
        """The memory as numbers of a variable's kind; its value is at `slot.index`."""
        return self.reals if slot.variable.spec.kind is Scalar.REAL else self.integers

    def start(self, time: float) -> None:
        """Check the parameters, derive what follows from them, and set state and outputs at `time` (s).

        Raises ModelError where a parameter or an input is out of bounds.
        """
        self._derive()
        self._check_bounds(Causality.INPUT)
        model = self.model
        self.memory["o"], self.memory["s"] = _values(model.outputs), _values(model.hidden)
        self.memory["q"] = 0.0
        self.memory["time"] = time
        self.memory["h"] = FIRST_STEP
        self.memory["evaluations"] = 0
        self._run_once(model.start)

    def step(self, time: float, step: float) -> None:
        """Advance from `time` by `step` (s).

        Raises ModelError, naming what stopped it; StepSizeError where a smaller step may be taken.
        """
        if not step > 0.0 or not math.isfinite(step) or not math.isfinite(time):
            raise ModelError(messages.NO_STEP.format(time=time, step=step))
        if self._outdated:
            self._derive_again()
        status = self.advance(self.words, self.work, time, step)
        if status != OK:
            refused = ModelError if status in (BAD_INPUT, BAD_LOAD, ROW_OFF, TOO_HOT) else StepSizeError
            raise refused(stop_reason(self, status, time, step))

    def save(self) -> bytes:
        """A copy of the state; constants that follow from its parameters are left out."""
        return self.state.tobytes()

    def restore(self, state: bytes | memoryview) -> None:
        """Go back to what `save` returned, here or in another instance of the same model.

        Where the parameters are others than before, constants are derived again ahead of the next step.
        """
        self.state[:] = state
        self._outdated = self._parameters != self._derived_for

    def tune(self) -> None:
        """Have constants derived again ahead of the next step, as tunable parameters were set."""
        self._outdated = self._parameters != self._derived_for

    def _derive_again(self) -> None:
        """Derive for the parameters as they are now; the rest of the state stays what it is.

        A started model has more in use than `derive` knows of, such as the modes that it was told of.
        """
        kept = self.save()
        try:
            self._derive()
        finally:
            self.state[:] = kept

    def _derive(self) -> None:
        """Check the parameters, compute what follows from them. Raises ModelError where they cannot be."""
        self._check_bounds(Causality.PARAMETER)
        self._derived_for = b""
        model = self.model
        if model.tables is not None:
            self.memory["d"] = self._tabulated(model.tables)
        number = self._run_once(model.derive)
        if number:
            raise ModelError(model.problems[number - 1].format(*self.record["message_numbers"]))
        self.advance = model.advance_with(
            [s.variable.name for s in self._effects if self.integers[s.index]]
        )
        self._derived_for, self._outdated = self._parameters.tobytes(), False

    def _run_once(self, kernel: Callable[[Any], Any]) -> Any:
        """The result of a kernel that is called once in a run; Python runs it, which takes milliseconds.

        Numbers out of all proportion take the machine code: it goes on with infinities and NaNs, which are
        then found by name.
        """
        before = self.save()
        try:
            return interpret(kernel, self.words)
        except (ArithmeticError, ValueError):
            self.state[:] = before
            return kernel(self.words)

    def _tabulated(self, tables: Callable[[Any], np.ndarray]) -> np.ndarray:
        """The `tables` for the parameters. Raises ModelError where there are none."""
        parameters = from_record(self.model.parameters, self.record["p"])
        try:
            return tables(parameters)
        except (ArithmeticError, ValueError, RuntimeError) as error:
            raise ModelError(
                f"it cannot start ({error}); look for a parameter that is out of all proportion"
            ) from None

    def _check_bounds(self, causality: Causality) -> None:
        for slot in self.slots:
            if slot.causality is not causality:
                continue
            problem = slot.variable.problem(self.store(slot)[slot.index])
            if problem:
                raise ModelError(problem)


@cache
def _values(declaration: type) -> np.ndarray:
    """The values of a declaration as they stand by default (1,), as its memory is laid out."""
    return np.array([as_tuple(declaration())], layout(declaration))


def stop_reason(instance: Instance, status: int, time: float, step: float) -> str:
    """The reason why a macro step of `step` (s) from `time` (s) stopped, and the remedy."""
    if status == BAD_INPUT:
        for slot in instance.slots:
            value = instance.reals[slot.index]
            if slot.causality is Causality.INPUT and not math.isfinite(value):
                return messages.BAD_INPUT.format(name=slot.variable.name, value=value, time=time)
    if status in (BAD_LOAD, BAD_INPUT):  # finite inputs can be too large to add up
        return messages.BAD_LOAD.format(time=time)
    if status == TOO_MANY_STEPS:
        return messages.TOO_MANY_STEPS.format(most=MAX_STEPS, step=step, time=time)
    if status == TOO_LONG_STEP:
        return messages.TOO_LONG_STEP.format(step=step, time=time)
    if status == TOO_FAST:
        return messages.TOO_FAST.format(time=time, step=step, smaller=0.1 * step)
    if status in (ROW_OFF, TOO_HOT):
        return (messages.ROW_OFF if status == ROW_OFF else messages.TOO_HOT).format(time=time)
    if status < 0:
        return messages.GAVE_UP.format(time=time)
    return messages.UNRESOLVED.format(time=time, step=step)
