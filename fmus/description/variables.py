"""Variables as either version of FMI describes them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import zip_longest

from touchdown.modelkit.model import Model, Slot, slots
from touchdown.modelkit.units import display_unit
from touchdown.modelkit.variables import Causality, Choices, Scalar, Spec, Variability

SET = (Causality.PARAMETER, Causality.INPUT)  # what has a start value


def scalars(model: Model) -> dict[str, Slot]:
    """The variables of FMI 2.0 by name."""
    return {slot.variable.name: slot for slot in slots(model)}


def causality(slot: Slot) -> tuple[Causality, Variability, str | None]:
    """(causality, variability, initial) of FMI."""
    spec = slot.variable.spec
    if slot.causality is Causality.PARAMETER:
        return Causality.PARAMETER, Variability.TUNABLE if spec.tunable else Variability.FIXED, "exact"
    changes = Variability.DISCRETE if spec.kind is Scalar.INTEGER else Variability.CONTINUOUS
    if slot.causality is Causality.INPUT:
        return Causality.INPUT, changes, None
    if spec.constant:
        return Causality.CALCULATED_PARAMETER, Variability.FIXED, "calculated"
    return Causality.LOCAL if spec.local else Causality.OUTPUT, changes, "calculated"


def fmi_type(spec: Spec) -> str:
    """What a variable is to FMI 2.0, which reads and sets enumerations as integers."""
    if spec.choices is not None:
        return "Enumeration"
    return "Real" if spec.kind is Scalar.REAL else "Integer"


def roles(slot: Slot) -> dict[str, str]:
    """Attributes that say what a variable is for."""
    role, variability, initial = causality(slot)
    attributes = {
        "description": slot.variable.spec.meaning,
        "causality": role,
        "variability": variability,
    }
    return attributes | ({"initial": initial} if initial else {})


def values(slot: Slot) -> dict[str, str]:
    """Attributes of its values: type, unit, bounds; not its start."""
    spec = slot.variable.spec
    details: dict[str, str] = {}
    if spec.choices is not None:
        details["declaredType"] = spec.choices.name
    if spec.kind is Scalar.REAL:
        details["unit"] = spec.unit
        shown = spec.shown or display_unit(spec.unit, spec.nominal or slot.variable.default)
        if shown != spec.unit:
            details["displayUnit"] = shown
    low = spec.minimum if spec.minimum is not None else spec.above
    for name, value in (("min", low), ("max", spec.maximum), ("nominal", spec.nominal)):
        if value is not None:
            details[name] = written(spec, value)
    return details


def written(spec: Spec, value: float) -> str:
    """A value as a variable of this kind has it in XML."""
    return repr(float(value)) if spec.kind is Scalar.REAL else str(int(value))


def choices_of(exposed: Sequence[Slot]) -> list[Choices]:
    """What whole numbers stand for, of all variables, each once, by name."""
    used = {s.variable.spec.choices for s in exposed}
    return sorted((c for c in used if c is not None), key=lambda c: c.name)


def items(choices: Choices) -> Iterator[dict[str, str]]:
    """Attributes of an enumeration's items."""
    for value, (word, meaning) in enumerate(zip_longest(choices.words, choices.meanings)):
        yield {"name": word, "value": str(value)} | ({"description": meaning} if meaning else {})
