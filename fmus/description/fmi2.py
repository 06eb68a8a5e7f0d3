"""The description that FMI 2.0 asks for."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from xml.etree.ElementTree import Element, SubElement

from ...modelkit.model import Model, Slot, slots
from ...modelkit.variables import Causality
from .described_variables import (
    STARTED_CAUSALITIES,
    Making,
    add_surroundings,
    add_units,
    causality,
    choices_of,
    enumeration_items,
    fmi2_type,
    identity,
    python_making,
    roles,
    values,
    xml_value,
)

CAPABILITIES = {  # of every FMU
    "canHandleVariableCommunicationStepSize": "true",
    "canInterpolateInputs": "false",
    "canBeInstantiatedOnlyOncePerProcess": "false",
    "canNotUseMemoryManagementFunctions": "true",
    "canGetAndSetFMUstate": "true",
    "canSerializeFMUstate": "true",
}


def describe_fmi2(
    model: Model, identifier: str, log_categories: Mapping[str, str], making: Making | None = None
) -> Element:
    """The FMI 2.0 model description of `model`; `making`: where not by pythonfmu."""
    making = making or python_making(model)
    attributes = {"fmiVersion": "2.0", "guid": making.guid}
    root = Element("fmiModelDescription", attributes | identity(model, making))
    needs = {"needsExecutionTool": str(making.needs_tool).lower()}
    SubElement(root, "CoSimulation", {"modelIdentifier": identifier, **needs, **CAPABILITIES})
    exposed = slots(model)
    add_units(root, exposed)
    _add_types(root, exposed)
    add_surroundings(root, log_categories)
    variables = SubElement(root, "ModelVariables")
    for slot in exposed:
        variables.append(_variable(slot))
    _add_structure(root, model, exposed)
    return root


def _add_types(root: Element, exposed: Sequence[Slot]) -> None:
    """Add the types of enumerations."""
    used = choices_of(exposed)
    if not used:
        return
    definitions = SubElement(root, "TypeDefinitions")
    for choices in used:
        simple = SubElement(definitions, "SimpleType", {"name": choices.name})
        enumeration = SubElement(simple, "Enumeration")
        for item in enumeration_items(choices):
            SubElement(enumeration, "Item", item)


def _variable(slot: Slot) -> Element:
    named = {"name": slot.variable.name, "valueReference": str(slot.index)}
    scalar = Element("ScalarVariable", named | roles(slot))
    spec, details = slot.variable.spec, values(slot)
    if causality(slot)[0] in STARTED_CAUSALITIES:
        details["start"] = xml_value(spec, slot.variable.default)
    SubElement(scalar, fmi2_type(spec), details)
    return scalar


def _add_structure(root: Element, model: Model, exposed: Sequence[Slot]) -> None:
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
