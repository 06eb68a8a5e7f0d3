"""What is done with each attribute that the model description of an FMU can have.

`ATTRIBUTES` has every attribute of the schemas of FMI 2.0 and 3.0 by its name, or as ELEMENT.name where the
element decides. A test walks the schemas: none is missing, and none is invented. `touchdown check` says
which attributes of an FMU are ignored.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from enum import StrEnum
from typing import NamedTuple
from xml.etree.ElementTree import Element


class Use(StrEnum):
    """What is done with an attribute."""

    USED = "used"
    CHECKED = "checked"  # while the FMU runs, or by `touchdown check`
    IGNORED = "ignored"  # though it says something of how the FMU can be stepped
    TEXT = "text"  # for people and tools that edit models


class Attribute(NamedTuple):
    """What is done with an attribute, and for what."""

    use: Use
    says: str


def _table(use: Use, entries: Mapping[str, str]) -> dict[str, Attribute]:
    return {name: Attribute(use, says) for names, says in entries.items() for name in names.split()}


ATTRIBUTES: Mapping[str, Attribute] = {
    **_table(
        Use.USED,
        {
            "fmiVersion": "2.0 and 3.x for co-simulation are run",
            "guid instantiationToken": "handed to the FMU, which compares it",
            "modelIdentifier": "name of the library",
            "generationTool": "FMUs by pythonfmu run in this interpreter",
            "name valueReference": "how a variable is found",
            "causality": "what can be set, connected and recorded",
            "variability": "parameters are handed over once; outputs of third-party FMUs at every step",
            "initial": "what can be set before the start",
            "start Start.value": "value where nothing sets another, and size of a dimension",
            "min max": "a value that is set lies between them",
            "unit factor offset kg m s A K mol cd rad": "conversion on connections and of settings",
            "relativeQuantity": "a difference is converted without the offset of its unit",
            "declaredType": "unit, choices and relativeQuantity of its variables",
            "Item.value": "number of a choice",
            "Dimension.valueReference": "size of an array: start value of a structural parameter",
            "stepSize fixedInternalStepSize": "macro step where a package has none; else compared",
            "stopTime": "`check` steps no further; a run hands over its own",
            "canGetAndSetFMUstate canGetAndSetFMUState": "whether a step can be repeated",
            "canSerializeFMUstate canSerializeFMUState": "whether a run can go on later",
            "canHandleVariableCommunicationStepSize": "whether a step can be divided",
            "description": "shown beside the variable",
            "canNotUseMemoryManagementFunctions": "every FMU is handed C's own functions, to use or not",
        },
    ),
    **_table(
        Use.CHECKED,
        {
            "canBeInstantiatedOnlyOncePerProcess": "each instance has a process of its own, or is refused",
            "needsExecutionTool": "named by `check`, and where the FMU does not load",
            "mightReturnEarlyFromDoStep": "a step that ends early ends the run with its time",
            "clocks intervalVariability": "a connection to a clocked variable is refused",
        },
    ),
    **_table(
        Use.IGNORED,
        {
            "canInterpolateInputs maxOutputDerivativeOrder": "inputs are held during a step",
            "recommendedIntermediateInputSmoothness": "inputs are held during a step",
            "canRunAsynchronuously": "a step that is pending is an error",
            "hasEventMode providesEvaluateDiscreteStates": "event mode is not entered",
            "providesIntermediateUpdate intermediateUpdate": "steps are not interrupted",
            "canReturnEarlyAfterIntermediateUpdate": "steps are not interrupted",
            "providesDirectionalDerivative providesDirectionalDerivatives": "found by differences",
            "providesAdjointDerivatives providesPerElementDependencies": "found by differences",
            "canHandleMultipleSetPerTimeInstant": "inputs are set once a step, more often before the start",
            "canBeDeactivated priority supportsFraction resolution": "clocks do not tick",
            "intervalDecimal shiftDecimal intervalCounter shiftCounter": "clocks do not tick",
            "startTime tolerance": "the scene decides on the start; FMUs keep their own tolerance",
            "maxSize mimeType": "binary variables are not exchanged",
        },
    ),
    **_table(
        Use.TEXT,
        {
            "modelName author version copyright license generationDateAndTime variableNamingConvention": "",
            "quantity displayUnit DisplayUnit.factor DisplayUnit.offset inverse nominal unbounded type": "",
            "completedIntegratorStepNotNeeded needsCompletedIntegratorStep": "for model exchange",
            "numberOfEventIndicators derivative reinit previous": "for model exchange",
            "index dependencies dependenciesKind": "loops are found by trying the FMU",
            "Category.name Tool.name File.name SourceFile.name SourceFileSet.name": "",
            "language compiler compilerOptions platform optional value external": "of sources",
            "variableName memberName variableKind matchingRule terminalKind": "ports are found by names",
            "inStreamMemberName outStreamMemberName inStreamVariableName outStreamVariableName": "",
            "defaultConnectionColor defaultConnectionStrokeSize x1 y1 x2 y2 iconBaseName": "icons",
            "suggestedScalingFactorTo_mm": "icons",
            "fmi-ls-name fmi-ls-version fmi-ls-description": "layered standards",
        },
    ),
}


COMBINATIONS = {  # causalities that FMI allows, by variability
    "constant": ("output", "local"),
    **dict.fromkeys(
        ("fixed", "tunable"), ("parameter", "calculatedParameter", "structuralParameter", "local")
    ),
    "discrete": ("input", "output", "local"),
    "continuous": ("input", "output", "local", "independent"),
}
INITIAL = {  # where a variable of a combination that FMI does not have states none
    "parameter": "exact",
    "structuralParameter": "exact",
    "input": "exact",
}


def mend(root: Element) -> list[str]:
    """Change a model description that tools write, and FMI does not allow, into one that can be read.

    Returns a line for each change. What it cannot mend is left to the reader's own message.
    """
    variables = list(root.iterfind("ModelVariables/*"))
    types = {kind.get("name") for kind in root.iterfind("TypeDefinitions/*")}
    third = root.get("fmiVersion", "").startswith("3.")
    changes: list[str] = []
    for variable in variables:
        name, causality = variable.get("name"), variable.get("causality", "local")
        content = variable if third else next((c for c in variable if c.tag != "Annotations"), variable)
        declared = content.get("declaredType")
        if declared is not None and declared not in types:
            del content.attrib["declaredType"]
            changes.append(f"variable {name} has the declaredType {declared}, which is not defined")
        variability = variable.get("variability", "" if third else "continuous")
        allowed = COMBINATIONS.get(variability)
        if allowed is not None and causality not in allowed and variable.get("initial") is None:
            variable.set("initial", INITIAL.get(causality, "calculated"))
            changes.append(
                f"variable {name} has the causality {causality} with the variability {variability}, which "
                "FMI does not allow"
            )
    numbers = {str(number) for number in range(1, len(variables) + 1)}
    for group in () if third else root.iterfind("ModelStructure/*"):
        for unknown in list(group):
            named = f"{unknown.get('index')} {unknown.get('dependencies', '')}".split()
            if not numbers.issuperset(named):
                group.remove(unknown)
                changes.append(f"ModelStructure/{group.tag} names a variable that is not there")
    return changes


def treatment(element: str, attribute: str) -> Attribute | None:
    """What is done with an attribute of an element; None where FMI does not know it."""
    return ATTRIBUTES.get(f"{element}.{attribute}") or ATTRIBUTES.get(attribute)


def ignored(root: Element) -> Iterator[str]:
    """The attributes of a model description that are set and ignored, each once with the reason."""
    reasons: dict[str, str] = {}

    def look(element: Element) -> None:
        for name, value in element.attrib.items():
            known = treatment(element.tag, name)
            if known and known.use is Use.IGNORED and not _harmless(name, value):
                reasons.setdefault(name, known.says)
        for inner in element:
            if inner.tag not in ("VendorAnnotations", "Annotations"):
                look(inner)

    look(root)
    return (f"{name} is ignored: {says}" for name, says in reasons.items())


def _harmless(name: str, value: str) -> bool:
    """Whether an attribute takes nothing from an FMU where it is ignored: most permit something."""
    if name == "canHandleMultipleSetPerTimeInstant":
        return value in ("true", "1")
    return value in ("false", "") or not value.strip("0.")
