"""A model that starts from other values than those it was declared with.

Tools may set nothing before an FMU's first step. What such a tool is to start from must be in the FMU: in
its description, and in the memory of a new instance. Both follow from the model's declarations, so it is
these that change.
"""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import field, fields, make_dataclass, replace
from functools import partial
from typing import Any

from touchdown.modelkit.instance import Instance
from touchdown.modelkit.model import Model, slots
from touchdown.modelkit.variables import Causality, Scalar, from_record


def defaults(model: Model) -> dict[str, float]:
    """What parameters and inputs of `model` start from (SI), by name."""
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
