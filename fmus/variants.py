"""Models made from another one: with connectors for fewer modes, or with other start values.

A seat has room for twenty elastic modes, each with a connector for everything that the contract names.
Where fewer are in use the others are in the way, most of all where connections are drawn by hand. So a
model can be made for rotors of some number of modes: that number is its start value, and its seats have
connectors for no more (`with_modes`).

Some tools may set nothing before an FMU's first step. Start values for such a tool must be in the FMU: in
its description, and in the memory of a new instance. Both follow from the model's declarations, so it is
these that change (`starting_from`).
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import field, fields, make_dataclass, replace
from functools import partial
from typing import Any

from ..modelkit.errors import TouchdownError
from ..modelkit.instance import Instance
from ..modelkit.model import Model, ModelError, slots
from ..modelkit.ports import MODES
from ..modelkit.variables import Causality, Scalar, from_record

ALL = 0  # modes of the finite elements
RIGID = 2  # per plane
_MASS = re.compile(r"\.mode\[(\d+)\]\.inv_m$")
_MODE = re.compile(r"(?:^|\.)mode\[(\d+)\]")


def with_modes(model: Model, count: int, listed: int) -> Model:
    """`model` for rotors of `count` modes per plane, the two rigid ones included; `ALL`: it stays.

    A rotor starts with so many, and where they are the rigid ones with nothing else. Seats tell of `listed`
    elastic modes (`modes_listed`). Where a variable lies in memory, its value reference, does not change.
    """
    if count == ALL:
        return model
    defined = defaults(model)
    starts = {n: value for n, value in _starts(count).items() if n in defined and defined[n] != value}
    started = starting_from(model, starts) if starts else model
    rename = partial(_exposed, model.rename, listed)
    return replace(started, rename=rename, content=f"{started.content}_modes{count}_{listed}")


def modes_listed(count: int, rotors: Iterable[Model] = ()) -> int:
    """How many elastic modes and residual vectors seats have to tell of with `count` modes per plane.

    That is two less, and a vector for each seat that has one: of two seats where no rotor is given, else as
    many as the rotors have. Raises ModelError, which names it, where one does not start with so many.
    """
    if count in (ALL, RIGID):
        return 0
    return max((_in_use(with_modes(rotor, count, MODES)) for rotor in rotors), default=count)


def _in_use(rotor: Model) -> int:
    """The last elastic mode that a seat of a rotor carries, as it starts."""
    instance = Instance(rotor)
    try:
        instance.start(0.0)
    except TouchdownError as error:
        raise ModelError(f"{rotor.name}: {error}") from None
    found = ((_MASS.search(slot.variable.name), slot) for slot in instance.slots)
    return max((int(m[1]) for m, slot in found if m and instance.reals[slot.index]), default=0)


def _starts(count: int) -> Mapping[str, float]:
    """The start values of a rotor of `count` modes."""
    return {"modes": count} | ({"residual": 0} if count == RIGID else {})


def _exposed(rename: Callable[[str], str | None], listed: int, name: str) -> str | None:
    """The name that `rename` gives a declared variable; None for modes beyond the first `listed`."""
    mode = _MODE.search(name)
    return None if mode and int(mode[1]) > listed else rename(name)


def refusal(model: Model, parameters: Mapping[str, int]) -> str:
    """Why a model does not start with these whole parameters, as far as it has them, or ""."""
    instance = Instance(model)
    for slot in instance.slots:
        if slot.variable.name in parameters:
            instance.integers[slot.index] = parameters[slot.variable.name]
    try:
        instance.start(0.0)
    except TouchdownError as error:
        return str(error)
    return ""


def defaults(model: Model) -> dict[str, float]:
    """The start values of parameters and inputs of `model` (SI), by name."""
    return {
        slot.variable.name: slot.variable.default
        for slot in slots(model)
        if slot.causality is not Causality.OUTPUT
    }


def starting_from(model: Model, values: Mapping[str, float]) -> Model:
    """`model` with `values` (SI, by name) as defaults of parameters and inputs; others stay.

    Its FMU is another one: its GUID, and states that only it takes back. Raises KeyError for a name that is
    neither a parameter nor an input.
    """
    begun = Instance(model)
    settable = {s.variable.name: s for s in begun.slots if s.causality is not Causality.OUTPUT}
    for name, value in values.items():
        slot = settable[name]
        kind = float if slot.variable.spec.kind is Scalar.REAL else int
        begun.store(slot)[slot.index] = kind(value)
    digest = hashlib.sha256(repr(sorted(values.items())).encode()).hexdigest()[:16]
    return replace(
        model,
        parameters=_declared_anew(model.parameters, begun.record["p"]),
        inputs=_declared_anew(model.inputs, begun.record["u"]),
        content=f"{model.content}_{digest}",
    )


def _declared_anew(kind: type, record: Any) -> type:
    """The declaration `kind` with the values of `record` as its defaults."""
    values = from_record(kind, record)
    declared = [
        (f.name, f.type, field(default_factory=partial(getattr, values, f.name), metadata=f.metadata))
        for f in fields(kind)
    ]
    return make_dataclass(kind.__name__, declared, bases=(kind,), frozen=True)
