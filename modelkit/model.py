"""What a model is, and one running instance of it."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import cache
from typing import Any

import numpy as np

from touchdown.modelkit.integrators import dopri
from touchdown.modelkit.status import BAD_INPUT, BAD_LOAD, OK, TOO_MANY_STEPS
from touchdown.modelkit.variables import Nothing, Variable, as_tuple, flatten, from_record, layout


class ModelError(Exception):
    """A model cannot go on; the message names the variable, the value and the remedy."""


def same_name(name: str) -> str | None:
    """Variables are exposed by the names they are declared with."""
    return name


def no_check(parameters: Any) -> str | None:
    """Bounds of single parameters suffice."""
    return None


def memory_layout(
    parameters: type,
    inputs: type,
    outputs: type,
    state_size: int,
    derived: type = Nothing,
    hidden: type = Nothing,
) -> np.dtype:
    """Everything an instance is, as one record of 8-byte words.

    Derived constants come last: what stands before them is the state, and saving it is copying its bytes.
    """
    return np.dtype(
        [
            ("time", "f8"),
            ("half", "f8"),
            ("h", "f8"),
            ("n", "i8"),
            ("evaluations", "i8"),
            ("p", layout(parameters)),
            ("u", layout(inputs)),
            ("o", layout(outputs)),
            ("s", layout(hidden)),
            ("q", "f8", (state_size,)),
            ("weight", "f8", (state_size,)),
            ("d", layout(derived)),
        ]
    )


@dataclass(frozen=True, eq=False)
class Model:
    """A component: its declarations and its kernels. A model is equal to itself only.

    Kernels see one record `m`: parameters m.p, inputs m.u, outputs m.o, derived constants m.d, hidden
    memory m.s, the state m.q with m.n components in use, m.weight (error weights), m.time (s) at the
    beginning of the macro step, m.half (s) half its length, m.h (s) the micro-step to try next.

    What Python calls at every step takes the memory as plain words and views them as that record
    itself; handing a record over costs numba several microseconds.

    start(words)                 sets the state and the outputs from parameters and inputs
    advance(words, work, t, H)   one macro step; returns one of `modelkit.status`
    rhs(t, y, dy, m)             bodies: time derivative under the loads m.u
    publish(y, m)                bodies: outputs from the state
    instant(t, y, dy, m)         bearings: derivative of what is inside and, as mean of m.o's loads, the
                                 load at this instant under the motion m.u (for monolithic solutions)
    """

    name: str
    title: str
    about: str
    parameters: type
    inputs: type
    outputs: type
    memory: np.dtype
    start: Callable[[Any], None]
    advance: Callable[[Any, Any, float, float], int]
    weights: Callable[[Any], np.ndarray]  # parameters -> error weights, one for each component in use
    derived: type = Nothing
    hidden: type = Nothing
    derive: Callable[[Any], Any] | None = None  # parameters -> derived
    check: Callable[[Any], str | None] = no_check  # parameters -> what is wrong between them
    rhs: Callable[..., Any] | None = None
    publish: Callable[..., Any] | None = None
    instant: Callable[..., Any] | None = None
    content: str = ""  # of a model made from a file: a hash of it
    rename: Callable[[str], str | None] = same_name
    """Name by which a declared variable is exposed; None hides it (a member of a group not in use)."""
    starts_from: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    """Which parameters and inputs the first value of an output depends on (FMI InitialUnknowns).
    Names or prefixes ending in a dot; an output that is not listed starts at zero whatever is set."""


@dataclass(frozen=True)
class Slot:
    """Where a variable lives in an instance's memory, counted in 8-byte words."""

    variable: Variable
    causality: str  # "parameter", "input" or "output"
    index: int


@cache
def slots(model: Model) -> tuple[Slot, ...]:
    """All exposed variables of `model`: parameters, inputs, outputs, in memory order.

    Found once for each model: a rotor has more than a thousand.
    """
    found: list[Slot] = []
    for part, kind, causality in (
        ("p", model.parameters, "parameter"),
        ("u", model.inputs, "input"),
        ("o", model.outputs, "output"),
    ):
        fields: Any = model.memory.fields
        offset = fields[part][1] // 8
        for i, v in enumerate(flatten(kind())):
            name = model.rename(v.name)
            if name is not None:
                found.append(Slot(replace(v, name=name), causality, offset + i))
    return tuple(found)


class Instance:
    """A model with its memory. The FMU and the in-process component both drive this class.

    `state` is the part of the memory that changes, parameters included; the rest follows from them.
    """

    def __init__(self, model: Model) -> None:
        self.model = model
        self.memory = np.zeros(1, model.memory)
        self.words = self.memory.view("f8")
        self.memory["p"] = np.array([as_tuple(model.parameters())], layout(model.parameters))
        self.memory["u"] = np.array([as_tuple(model.inputs())], layout(model.inputs))
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
        self.memory["o"] = np.array([as_tuple(model.outputs())], layout(model.outputs))
        self.memory["s"] = np.array([as_tuple(model.hidden())], layout(model.hidden))
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
            raise ModelError(self._why(status, time, step))

    def save(self) -> bytes:
        """A copy of the state; constants that follow from its parameters are left out."""
        return self.state.tobytes()

    def restore(self, state: bytes | memoryview) -> None:
        """Go back to what `save` returned, here or in another instance of the same model.

        Where the parameters are others than before, constants are derived again ahead of the next step.
        """
        self.state[:] = state
        self._outdated = self._parameters != self._derived_from

    def _derive(self) -> Any:
        """Compute from the parameters what follows from them; returns them."""
        model = self.model
        parameters = from_record(model.parameters, self.memory[0]["p"])
        problem = model.check(parameters)
        if problem:
            raise ModelError(problem)
        if model.derive is not None:
            self.memory["d"] = np.array([as_tuple(model.derive(parameters))], layout(model.derived))
        self._derived_from, self._outdated = self._parameters.tobytes(), False
        return parameters

    def _check_bounds(self) -> None:
        for slot in self.slots:
            if slot.causality == "output":
                continue
            store = self.reals if slot.variable.spec.kind == "real" else self.integers
            problem = slot.variable.problem(store[slot.index])
            if problem:
                raise ModelError(problem)

    def _why(self, status: int, time: float, step: float) -> str:
        if status == BAD_INPUT:
            for slot in self.slots:
                value = self.reals[slot.index]
                if slot.causality == "input" and not math.isfinite(value):
                    return (
                        f"input {slot.variable.name} is {value} at t = {time:.9g} s; "
                        "look at the component that feeds it"
                    )
        if status == BAD_LOAD:
            return (
                f"the load at t = {time:.9g} s is not a finite number; look for an input or a parameter "
                "that is out of all proportion"
            )
        if status == TOO_MANY_STEPS:
            return (
                f"more than {dopri.MOST_STEPS} micro-steps within one macro step of {step:g} s "
                f"at t = {time:.9g} s; take a smaller macro step or a larger interface.tolerance"
            )
        return (
            f"the motion inside cannot be resolved at t = {time:.9g} s with a macro step of {step:g} s; "
            "take a smaller macro step, or look for a contact that starts with a deep overlap"
        )
