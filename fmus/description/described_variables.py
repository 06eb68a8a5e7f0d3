"""Variables, arrays and units, as the descriptions of FMI 2.0 and FMI 3.0 need them.

In FMI 3.0 a member of all modes, balls or nodes is one array: `journal.mode[1].x` to `journal.mode[20].x`
become `journal.mode.x` of 20. Where an array's elements lie in memory, one record apart, does not change;
its value reference is the place of the first.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from importlib.metadata import version
from itertools import zip_longest
from typing import Any
from xml.etree.ElementTree import Element, SubElement

from ...modelkit.model import Model, Slot, slots
from ...modelkit.units import DISPLAY_UNITS, display_unit, per_display
from ...modelkit.variables import Causality, Choices, Scalar, Spec, Variability
from ..version import RELEASED, VERSION

_SYMBOLS = {
    "m": {"m": 1},
    "kg": {"kg": 1},
    "s": {"s": 1},
    "rad": {"rad": 1},
    "N": {"kg": 1, "m": 1, "s": -2},
    "J": {"kg": 1, "m": 2, "s": -2},
    "W": {"kg": 1, "m": 2, "s": -3},
    "Pa": {"kg": 1, "m": -1, "s": -2},
    "A": {"A": 1},
    "V": {"kg": 1, "m": 2, "s": -3, "A": -1},
    "F": {"kg": -1, "m": -2, "s": 4, "A": 2},
    "Ohm": {"kg": 1, "m": 2, "s": -3, "A": -2},
    "T": {"kg": 1, "s": -2, "A": -1},
    "K": {"K": 1},
    "1": {},
}


def base_unit(unit: str) -> dict[str, int] | None:
    """SI exponents of a unit such as "N.s/m2"; None where it has none (N/m^n)."""
    if "^" in unit:
        return None
    exponents: dict[str, int] = {}
    sign = 1
    tokens = re.findall(r"[A-Za-z]+-?\d*|1|[/.()]", unit)
    if "".join(tokens) != unit:
        raise ValueError(f"unknown unit {unit!r}")
    for token in tokens:
        if token == "/":
            sign = -1
            continue
        if token in ".()":
            continue
        match = re.fullmatch(r"([A-Za-z]+|1)(-?\d*)", token)
        if match is None or match[1] not in _SYMBOLS:
            raise ValueError(f"unknown unit {unit!r}")
        power = int(match[2] or 1) * sign
        for symbol, count in _SYMBOLS[match[1]].items():
            exponents[symbol] = exponents.get(symbol, 0) + count * power
    return {symbol: count for symbol, count in exponents.items() if count}


def add_units(root: Element, exposed: Sequence[Slot], more: Iterable[str] = ()) -> None:
    """The units of some variables, and those that they are shown in; either version's XML."""
    definitions = SubElement(root, "UnitDefinitions")
    used = {s.variable.spec.unit for s in exposed if s.variable.spec.kind is Scalar.REAL}
    for unit in sorted(used.union(more)):
        element = SubElement(definitions, "Unit", {"name": unit})
        exponents = base_unit(unit)
        if exponents is not None:
            SubElement(element, "BaseUnit", {k: str(v) for k, v in exponents.items()})
        for shown in DISPLAY_UNITS.get(unit, ()):
            if shown != unit:
                factor = repr(per_display(unit, shown))
                SubElement(element, "DisplayUnit", {"name": shown, "factor": factor})


ARRAY_GROUPS = ("mode", "ball", "node")  # groups whose members become arrays, and elements of those again
_ELEMENT = re.compile(rf"((?:.*\.)?(?:{'|'.join(ARRAY_GROUPS)}))\[\d+\]\.(\w+)")


@dataclass(frozen=True)
class Array:
    """A variable: a scalar, or the elements of an array, which differ in their start values alone."""

    name: str
    elements: tuple[Slot, ...]
    dimension: int | None  # None: a scalar

    @property
    def first(self) -> Slot:
        """The first of the variables, for all of them."""
        return self.elements[0]

    @property
    def stride(self) -> int:
        """Words from one element to the next."""
        return self.elements[1].index - self.first.index if len(self.elements) > 1 else 0


def arrays(model: Model) -> tuple[Array, ...]:
    """All exposed variables of `model`, in the order of their first elements."""
    found: dict[str, list[Slot]] = {}
    for slot in slots(model):
        match = _ELEMENT.fullmatch(slot.variable.name)
        name = f"{match[1]}.{match[2]}" if match else slot.variable.name
        found.setdefault(name, []).append(slot)
    return tuple(_array(name, elements) for name, elements in found.items())


def element(array: str, index: tuple[int, ...]) -> str:
    """Name of an array's element: x[2], x[1,2], mode[2].x of mode.x, as in FMI 2.0; of a scalar: ()."""
    counted = f"[{','.join(map(str, index))}]" if index else ""
    group, _, member = array.rpartition(".")
    if group.rpartition(".")[2] in ARRAY_GROUPS:
        return f"{group}{counted}.{member}"
    return f"{array}{counted}"


def time_reference(model: Model) -> int:
    """Value reference of the independent variable: the place of the time in memory."""
    fields: Any = model.memory.fields
    return fields["time"][1] // 8


def _array(name: str, elements: list[Slot]) -> Array:
    scalar = elements[0].variable.name == name
    return Array(name, tuple(elements), None if scalar else len(elements))


@dataclass(frozen=True)
class Making:
    """How an FMU is made, and what follows from that."""

    tool: str
    guid: str
    needs_tool: bool  # in its host


def python_making(model: Model) -> Making:
    """The making of an FMU that is Python."""
    return Making(f"touchdown-cosim {VERSION}, PythonFMU {version('pythonfmu')}", guid(model), True)


def guid(model: Model) -> str:
    """Identity of a model's FMU: equal sources, equal GUID."""
    from ...modelkit.kernel import source_hash  # numba, which a process that hosts an FMU starts without

    packages = ("modelkit", "rotor", "bearings", "fmus")
    digest = hashlib.sha256(
        f"{model.name} {model.content} {VERSION} {source_hash(packages)}".encode()
    ).hexdigest()
    return f"{digest[:8]}-{digest[8:12]}-{digest[12:16]}-{digest[16:20]}-{digest[20:32]}"


def identity(model: Model, making: Making) -> dict[str, str]:
    """Attributes of the FMU's identity and generation, as both versions of FMI have them."""
    return {
        "modelName": model.title,
        "description": model.about,
        "author": "touchdown-cosim",
        "license": "MIT",
        "version": VERSION,
        "generationTool": making.tool,
        "generationDateAndTime": RELEASED,
        "variableNamingConvention": "structured",
    }


def add_surroundings(root: Element, log_categories: Mapping[str, str]) -> None:
    """Categories of its log, and how long and by which steps it is tried."""
    categories = SubElement(root, "LogCategories")
    for name, meaning in log_categories.items():
        SubElement(categories, "Category", {"name": name, "description": meaning})
    SubElement(root, "DefaultExperiment", {"startTime": "0.0", "stopTime": "0.1", "stepSize": "2e-05"})


STARTED_CAUSALITIES = (Causality.PARAMETER, Causality.INPUT)  # what has a start value


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


def fmi2_type(spec: Spec) -> str:
    """The type of a variable in FMI 2.0, which reads and sets enumerations as integers."""
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
            details[name] = xml_value(spec, value)
    return details


def xml_value(spec: Spec, value: float) -> str:
    """A value as a variable of this kind has it in XML."""
    return repr(float(value)) if spec.kind is Scalar.REAL else str(int(value))


def choices_of(exposed: Sequence[Slot]) -> list[Choices]:
    """The enumerations of all variables, each once, by name."""
    used = {s.variable.spec.choices for s in exposed}
    return sorted((c for c in used if c is not None), key=lambda c: c.name)


def enumeration_items(choices: Choices) -> Iterator[dict[str, str]]:
    """Attributes of an enumeration's items."""
    for value, (word, meaning) in enumerate(zip_longest(choices.words, choices.meanings)):
        yield {"name": word, "value": str(value)} | ({"description": meaning} if meaning else {})
