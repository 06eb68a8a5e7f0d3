"""modelDescription.xml, derived from a model's declarations."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from importlib.metadata import version
from itertools import zip_longest
from xml.etree.ElementTree import Element, SubElement, tostring

from touchdown.fmus.version import RELEASED, VERSION
from touchdown.modelkit.kernel import source_hash
from touchdown.modelkit.model import Model, Slot, slots
from touchdown.modelkit.units import DISPLAYED, display_unit, per_display
from touchdown.modelkit.variables import Causality, Scalar, Spec, Variability

_SYMBOLS = {
    "m": {"m": 1},
    "kg": {"kg": 1},
    "s": {"s": 1},
    "rad": {"rad": 1},
    "N": {"kg": 1, "m": 1, "s": -2},
    "J": {"kg": 1, "m": 2, "s": -2},
    "W": {"kg": 1, "m": 2, "s": -3},
    "Pa": {"kg": 1, "m": -1, "s": -2},
    "1": {},
}

CAPABILITIES = {  # of every FMU
    "canHandleVariableCommunicationStepSize": "true",
    "canInterpolateInputs": "false",
    "canBeInstantiatedOnlyOncePerProcess": "false",
    "canNotUseMemoryManagementFunctions": "true",
    "canGetAndSetFMUstate": "true",
    "canSerializeFMUstate": "true",
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


def guid(model: Model) -> str:
    """Identity of a model's FMU: equal sources, equal GUID."""
    packages = ("modelkit", "rotor", "bearings", "fmus")
    digest = hashlib.sha256(
        f"{model.name} {model.content} {VERSION} {source_hash(packages)}".encode()
    ).hexdigest()
    return f"{digest[:8]}-{digest[8:12]}-{digest[12:16]}-{digest[16:20]}-{digest[20:32]}"


@dataclass(frozen=True)
class Making:
    """How an FMU is made, and what follows from that."""

    tool: str
    guid: str
    needs_tool: bool  # in its host


def by_pythonfmu(model: Model) -> Making:
    """The making of an FMU that is Python."""
    return Making(f"touchdown-cosim {VERSION}, PythonFMU {version('pythonfmu')}", guid(model), True)


def describe(
    model: Model, identifier: str, log_categories: Mapping[str, str], making: Making | None = None
) -> Element:
    """The FMI 2.0 model description of `model`; `making`: where not by pythonfmu."""
    making = making or by_pythonfmu(model)
    root = Element("fmiModelDescription", _identity(model, making))
    needs = {"needsExecutionTool": str(making.needs_tool).lower()}
    SubElement(root, "CoSimulation", {"modelIdentifier": identifier, **needs, **CAPABILITIES})
    exposed = slots(model)
    _units(root, exposed)
    _types(root, exposed)
    categories = SubElement(root, "LogCategories")
    for name, meaning in log_categories.items():
        SubElement(categories, "Category", {"name": name, "description": meaning})
    SubElement(root, "DefaultExperiment", {"startTime": "0.0", "stopTime": "0.1", "stepSize": "2e-05"})
    variables = SubElement(root, "ModelVariables")
    for slot in exposed:
        variables.append(_variable(slot))
    _structure(root, model, exposed)
    return root


def _identity(model: Model, making: Making) -> dict[str, str]:
    """What the FMU is, and who made it with what."""
    return {
        "fmiVersion": "2.0",
        "modelName": model.title,
        "guid": making.guid,
        "description": model.about,
        "author": "touchdown-cosim",
        "license": "MIT",
        "version": VERSION,
        "generationTool": making.tool,
        "generationDateAndTime": RELEASED,
        "variableNamingConvention": "structured",
    }


def _units(root: Element, exposed: Sequence[Slot]) -> None:
    definitions = SubElement(root, "UnitDefinitions")
    for unit in sorted({s.variable.spec.unit for s in exposed if s.variable.spec.kind is Scalar.REAL}):
        element = SubElement(definitions, "Unit", {"name": unit})
        exponents = base_unit(unit)
        if exponents is not None:
            SubElement(element, "BaseUnit", {k: str(v) for k, v in exponents.items()})
        for shown in DISPLAYED.get(unit, ()):
            if shown != unit:
                factor = repr(per_display(unit, shown))
                SubElement(element, "DisplayUnit", {"name": shown, "factor": factor})


def _types(root: Element, exposed: Sequence[Slot]) -> None:
    """What whole numbers stand for."""
    used = {s.variable.spec.choices for s in exposed}
    if used == {None}:
        return
    definitions = SubElement(root, "TypeDefinitions")
    for choices in sorted((c for c in used if c is not None), key=lambda c: c.name):
        simple = SubElement(definitions, "SimpleType", {"name": choices.name})
        items = SubElement(simple, "Enumeration")
        for value, (word, meaning) in enumerate(zip_longest(choices.words, choices.meanings)):
            details = {"name": word, "value": str(value)}
            SubElement(items, "Item", details | ({"description": meaning} if meaning else {}))


def causality(slot: Slot) -> tuple[Causality, Variability, str | None]:
    """(causality, variability, initial) of FMI 2.0."""
    spec = slot.variable.spec
    if slot.causality is Causality.PARAMETER:
        return Causality.PARAMETER, Variability.TUNABLE if spec.tunable else Variability.FIXED, "exact"
    changes = Variability.DISCRETE if spec.kind is Scalar.INTEGER else Variability.CONTINUOUS
    if slot.causality is Causality.INPUT:
        return Causality.INPUT, changes, None
    if spec.constant:
        return Causality.CALCULATED_PARAMETER, Variability.FIXED, "calculated"
    return Causality.LOCAL if spec.local else Causality.OUTPUT, changes, "calculated"


def _variable(slot: Slot) -> Element:
    v, spec = slot.variable, slot.variable.spec
    role, variability, initial = causality(slot)
    attributes = {
        "name": v.name,
        "valueReference": str(slot.index),
        "description": spec.meaning,
        "causality": role,
        "variability": variability,
    }
    if initial:
        attributes["initial"] = initial
    scalar = Element("ScalarVariable", attributes)
    details: dict[str, str] = {}
    if spec.choices is not None:
        details["declaredType"] = spec.choices.name
    if spec.kind is Scalar.REAL:
        details["unit"] = spec.unit
        shown = spec.shown or display_unit(spec.unit, spec.nominal or v.default)
        if shown != spec.unit:
            details["displayUnit"] = shown
    low = spec.minimum if spec.minimum is not None else spec.above
    for name, value in (("min", low), ("max", spec.maximum), ("nominal", spec.nominal)):
        if value is not None:
            details[name] = repr(float(value)) if spec.kind is Scalar.REAL else str(int(value))
    if role in (Causality.PARAMETER, Causality.INPUT):
        details["start"] = repr(float(v.default)) if spec.kind is Scalar.REAL else str(v.default)
    SubElement(scalar, fmi_type(spec), details)
    return scalar


def fmi_type(spec: Spec) -> str:
    """What a variable is to FMI 2.0, which reads and sets enumerations as integers."""
    if spec.choices is not None:
        return "Enumeration"
    return "Real" if spec.kind is Scalar.REAL else "Integer"


def _structure(root: Element, model: Model, exposed: Sequence[Slot]) -> None:
    """Outputs follow from the state (a step must pass); initial unknowns from what the model names."""
    structure = SubElement(root, "ModelStructure")
    position = {slot.variable.name: i + 1 for i, slot in enumerate(exposed)}
    outputs = SubElement(structure, "Outputs")
    initial = SubElement(structure, "InitialUnknowns")
    for slot in exposed:
        role = causality(slot)[0]
        name = slot.variable.name
        index = str(position[name])
        if role is Causality.OUTPUT:
            SubElement(outputs, "Unknown", {"index": index, "dependencies": ""})
        if role in (Causality.OUTPUT, Causality.CALCULATED_PARAMETER):
            known = [str(position[source]) for source in model.starts_from.get(name, ())]
            SubElement(
                initial, "Unknown", {"index": index, "dependencies": " ".join(sorted(known, key=int))}
            )


def as_text(element: Element) -> str:
    """XML of an element, for comparisons."""
    return tostring(element, "unicode")
