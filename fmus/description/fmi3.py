"""The description that FMI 3.0 asks for."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from xml.etree.ElementTree import Element, SubElement

from ...modelkit.model import Model, Slot, slots
from ...modelkit.variables import Causality, Scalar
from .described_variables import (
    STARTED_CAUSALITIES,
    Array,
    Making,
    add_surroundings,
    add_units,
    arrays,
    causality,
    choices_of,
    enumeration_items,
    identity,
    roles,
    time_reference,
    values,
    xml_value,
)

CAPABILITIES = {  # of every FMU
    "canHandleVariableCommunicationStepSize": "true",
    "canGetAndSetFMUState": "true",
    "canSerializeFMUState": "true",
}


def describe_fmi3(
    model: Model, identifier: str, log_categories: Mapping[str, str], making: Making
) -> Element:
    """The FMI 3.0 model description of `model`, made as `making` says."""
    attributes = {"fmiVersion": "3.0", "instantiationToken": making.guid}
    root = Element("fmiModelDescription", attributes | identity(model, making))
    needs = {"needsExecutionTool": str(making.needs_tool).lower()}
    SubElement(root, "CoSimulation", {"modelIdentifier": identifier, **needs, **CAPABILITIES})
    exposed = slots(model)
    add_units(root, exposed, more=(_TIME["unit"],))
    _add_types(root, exposed)
    add_surroundings(root, log_categories)
    found = arrays(model)
    variables = SubElement(root, "ModelVariables")
    SubElement(variables, "Float64", {**_TIME, "valueReference": str(time_reference(model))})
    for array in found:
        variables.append(_variable(array))
    _add_structure(root, model, found)
    return root


_TIME = {
    "name": "time",
    "description": "simulated time",
    "causality": "independent",
    "variability": "continuous",
    "unit": "s",
}


def _add_types(root: Element, exposed: Sequence[Slot]) -> None:
    """Add the types of enumerations."""
    used = choices_of(exposed)
    if not used:
        return
    definitions = SubElement(root, "TypeDefinitions")
    for choices in used:
        enumeration = SubElement(definitions, "EnumerationType", {"name": choices.name})
        for item in enumeration_items(choices):
            SubElement(enumeration, "Item", item)


def _variable(array: Array) -> Element:
    spec, named = array.first.variable.spec, {"name": array.name, "valueReference": str(array.first.index)}
    attributes = named | roles(array.first) | values(array.first)
    if causality(array.first)[0] in STARTED_CAUSALITIES:
        attributes["start"] = " ".join(xml_value(spec, slot.variable.default) for slot in array.elements)
    number = "Float64" if spec.kind is Scalar.REAL else "Int64"  # of all whole numbers
    element = Element("Enumeration" if spec.choices is not None else number, attributes)
    if array.dimension is not None:
        SubElement(element, "Dimension", {"start": str(array.dimension)})
    return element


def _add_structure(root: Element, model: Model, found: Sequence[Array]) -> None:
    """Outputs follow from the state (a step must pass); initial unknowns from what the model names."""
    structure = SubElement(root, "ModelStructure")
    reference = {slot.variable.name: array.first.index for array in found for slot in array.elements}
    roles = [(array, causality(array.first)[0]) for array in found]
    for array, role in roles:
        if role is Causality.OUTPUT:
            attributes = {"valueReference": str(array.first.index), "dependencies": ""}
            SubElement(structure, "Output", attributes)
    for array, role in roles:
        if role in (Causality.OUTPUT, Causality.CALCULATED_PARAMETER):
            sources = (model.starts_from.get(slot.variable.name, ()) for slot in array.elements)
            known = sorted({reference[name] for names in sources for name in names})
            attributes = {
                "valueReference": str(array.first.index),
                "dependencies": " ".join(map(str, known)),
            }
            SubElement(structure, "InitialUnknown", attributes)
