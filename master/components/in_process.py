"""A component stepped in process: the FMU's model without the FMU.

It drives the same instance class as the FMU's slave through the same calls, so both agree bit for bit.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

import numpy as np

from ...fmus.description.described_variables import causality, fmi2_type, guid
from ...modelkit.instance import Instance, stop_reason
from ...modelkit.kernel.memory import advance_address
from ...modelkit.model import Model, Slot
from ..common.errors import TouchdownError
from .component import WHOLE, Call, Component, FmiType, InMemory, ScalarVariable, Setting


def _variable(slot: Slot) -> ScalarVariable:
    spec = slot.variable.spec
    role, variability, _ = causality(slot)
    return ScalarVariable(
        name=slot.variable.name,
        reference=slot.index,
        kind=FmiType(fmi2_type(spec)),
        causality=role,
        variability=variability,
        unit=spec.unit,
        minimum=spec.minimum if spec.minimum is not None else spec.above,
        maximum=spec.maximum,
        start=slot.variable.default,
        description=spec.meaning,
        choices={} if spec.choices is None else {w: i for i, w in enumerate(spec.choices.words)},
    )


class _Words(NamedTuple):
    """Values of one type."""

    store: np.ndarray  # the instance's memory, seen as that type
    references: np.ndarray  # in it
    places: np.ndarray  # where the values go, or come from


class InProcessComponent(Component):
    """A model of the project, stepped without the FMI in between."""

    def __init__(self, name: str, model: Model) -> None:
        self.instance = Instance(model)
        variables = [_variable(slot) for slot in self.instance.slots]
        super().__init__(name, f"{model.name}, in process", {v.name: v for v in variables})
        self.model = model
        self._words = self.instance.words
        self._initialising = False
        self._start_time = 0.0
        self._taken: Sequence[_Words] = ()  # what it takes, where some is not Real
        self._given: Sequence[_Words] = ()

    def second(self) -> InProcessComponent:
        second = InProcessComponent(f"{self.name} (witness)", self.instance.model)
        second.rename(self._own)
        return second

    def set(self, values: Mapping[str, Setting]) -> None:
        for name, value in values.items():
            v = self.variable(name)
            assert not isinstance(value, str)
            if v.kind is FmiType.REAL:
                self.instance.reals[v.reference] = value
            else:
                self.instance.integers[v.reference] = int(value)

    def bind(self, inputs: Sequence[str], outputs: np.ndarray, names: Sequence[str]) -> None:
        self.inputs = np.zeros(len(inputs))
        self.outputs = outputs
        self._in = np.array([self.variable(n).reference for n in inputs], dtype=np.intp)
        self._out = np.array([self.variable(n).reference for n in names], dtype=np.intp)
        self._taken, self._given = self._typed(inputs), self._typed(names)

    def enter(self, start_time: float, stop_time: float | None = None) -> None:
        self._initialising = True
        self._start_time = start_time

    def exit(self) -> None:
        self._start()
        self._initialising = False

    def push(self) -> None:
        self._words[self._in] = self.inputs
        for store, references, places in self._taken:
            store[references] = self.inputs[places]

    def pull(self) -> None:
        if self._initialising:
            self._start()
        self.outputs[:] = self._words[self._out]
        for store, references, places in self._given:
            self.outputs[places] = store[references]

    def step(self, time: float, step: float) -> None:
        try:
            self.instance.step(time, step)
        except TouchdownError as error:
            raise TouchdownError(f"component {self.name}: {error}") from None

    def by_address(self) -> InMemory | None:
        """None before the first step, which has `advance` compiled and constants derived.

        What it exchanges is Real.
        """
        if self._taken or self._given:
            return None
        address = advance_address(self.instance.advance)
        return InMemory(address, self._words, self.instance.work, self._in, self._out) if address else None

    def refuse(self, call: Call, status: int, time: float, step: float) -> None:
        raise TouchdownError(f"component {self.name}: {stop_reason(self.instance, status, time, step)}")

    def reader(self, names: Sequence[str]) -> Callable[[], np.ndarray]:
        values, fetches = np.zeros(len(names)), self._by_type(names)

        def fetch() -> np.ndarray:
            if self._initialising:
                self._start()
            for store, references, places in fetches:
                values[places] = store[references]
            return values

        return fetch

    def _by_type(self, names: Sequence[str]) -> list[_Words]:
        """Where the variables called `names` stand in the memory, type by type."""
        variables = [self.variable(n) for n in names]
        found: list[_Words] = []
        for kinds, store in (((FmiType.REAL,), self._words), (WHOLE, self._words.view("i8"))):
            places = np.array([i for i, v in enumerate(variables) if v.kind in kinds], dtype=np.intp)
            references = np.array([variables[int(i)].reference for i in places], dtype=np.intp)
            if len(places):
                found.append(_Words(store, references, places))
        return found

    def _typed(self, names: Sequence[str]) -> list[_Words]:
        """`_by_type` of variables of which some are not Real; where all are, none is needed."""
        mixed = any(self.variable(n).kind is not FmiType.REAL for n in names)
        return self._by_type(names) if mixed else []

    def save(self) -> object:
        return self.instance.save()

    def restore(self, state: object) -> None:
        assert isinstance(state, bytes)
        self.instance.restore(state)

    can_serialise = True

    def to_bytes(self) -> bytes:
        return guid(self.instance.model).encode() + self.instance.save()

    def from_bytes(self, state: bytes, tuned: Mapping[str, Setting]) -> None:
        identity = guid(self.instance.model).encode()
        if not state.startswith(identity) or len(state) != len(identity) + len(self.instance.state):
            raise TouchdownError(f"component {self.name}: its state is of another model or version")
        self.instance.restore(state[len(identity) :])
        self.set(tuned)
        self.instance.tune()

    def close(self) -> str:
        """Nothing to free."""
        return ""

    def _start(self) -> None:
        try:
            self.instance.start(self._start_time)
        except TouchdownError as error:
            raise TouchdownError(f"component {self.name}: {error}") from None
