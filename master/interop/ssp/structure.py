"""SystemStructure.ssd as it stands: systems with elements, connections and bindings, and the experiment."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from xml.etree.ElementTree import Element

from touchdown.master.common.errors import TouchdownError, one_of
from touchdown.master.common.units import Scale, Unit
from touchdown.master.interop.ssp import bindings, xml
from touchdown.master.interop.ssp.bindings import Value
from touchdown.master.interop.ssp.names import (
    HEART,
    MASTER_ANNOTATION,
    REALS,
    SCENE_ANNOTATION,
    STEP_ANNOTATION,
)

FMU_TYPE = "application/x-fmu-sharedlibrary"
GIVING, TAKING = ("output", "calculatedParameter"), ("input", "parameter")  # kinds of connectors


@dataclass(frozen=True)
class Connector:
    """A connector, as far as it is declared."""

    kind: str
    unit: str | None


@dataclass(frozen=True)
class Part:
    """A component."""

    path: Path  # of its FMU
    connectors: Mapping[str, Connector]
    values: Sequence[Value]
    step: float | None  # s, its own macro step, where it asks for one


End = tuple[str | None, str]  # element (None: the system itself) and connector


@dataclass(frozen=True)
class Hop:
    """A connection, from where a value comes to where it goes."""

    start: End
    end: End
    convert: bool  # between the units of its ends
    scale: Scale | None


@dataclass(frozen=True)
class Node:
    """A system, and what is in it."""

    title: str
    parts: Mapping[str, Part]
    inner: Mapping[str, Node]
    connectors: Mapping[str, Connector]
    hops: Sequence[Hop]
    values: Sequence[Value]  # for ELEMENT.VARIABLE, or a connector of its own


@dataclass(frozen=True)
class Structure:
    """All that a package says."""

    root: Node
    units: Mapping[str, Unit]
    start: float  # s
    stop: float | None  # s
    macro_step: float | None  # s
    scene: Mapping[str, str]  # what a package of this project says beyond the structure
    names: Mapping[str, Mapping[str, str]]  # by component: variables of the contract, and its own
    changed: Mapping[str, Sequence[str]]  # by component: what the user set beside the scene
    bonds: Sequence[Mapping[str, str]]  # that are declared: the inputs that take force, position, velocity


def read(folder: Path, where: str) -> Structure:
    """The structure of an unpacked package. Raises TouchdownError for what cannot be run."""
    root = xml.read_xml(folder / HEART, f"{where}: {HEART}", "ssd:SystemStructureDescription")
    version = root.get("version", "")
    if not version.startswith(("1.", "2.")):
        raise TouchdownError(f"{where} is SSP {version or 'of no version'}; SSP 1.0 or 2.0 is needed")
    system = xml.child(root, "ssd:System")
    if system is None:
        raise TouchdownError(f"{where} has no System")
    start, stop, macro_step = _experiment(root, where)
    note = _annotation(system, SCENE_ANNOTATION, "touchdown:Scene")
    if note is None:  # older packages have it at the root, others' have none
        note = _annotation(root, SCENE_ANNOTATION, "touchdown:Scene")
    if note is None:
        note = Element(xml.tag("touchdown:Scene"))
    return Structure(
        root=_node(system, folder, where, root.get("name") or folder.name),
        units=xml.unit_definitions(root, "ssd:Units", where),
        start=start,
        stop=stop,
        macro_step=macro_step or _masters_step(system, where),
        scene=dict(note.attrib),
        names=_names(note, where),
        changed=_changed(note, where),
        bonds=_bonds(note, where),
    )


def _node(system: Element, folder: Path, where: str, title: str) -> Node:
    if xml.child(system, "ssd:SignalDictionaries") is not None:
        raise TouchdownError(f"{where} has signal dictionaries, which are not supported; connect directly")
    parts: dict[str, Part] = {}
    inner: dict[str, Node] = {}
    elements = xml.child(system, "ssd:Elements")
    for element in elements if elements is not None else ():
        kind = element.tag.rpartition("}")[2]
        name = xml.required(element, "name", where)
        if name in parts or name in inner:
            raise TouchdownError(f"{where} has two elements {name}")
        if kind == "Component":
            parts[name] = _part(element, folder, f"{where}: component {name}")
        elif kind == "System":
            inner[name] = _node(element, folder, f"{where}: system {name}", name)
        else:
            raise TouchdownError(
                f"{where} holds the {kind} {name}; that kind of element is not supported, only FMUs and "
                "systems are"
            )
    connectors = _connectors(system, where)
    return Node(
        title=system.get("description") or title,
        parts=parts,
        inner=inner,
        connectors=connectors,
        hops=_hops(system, parts, inner, connectors, where),
        values=bindings.values(system, folder, where),
    )


def _part(element: Element, folder: Path, where: str) -> Part:
    kind = element.get("type", FMU_TYPE)
    if kind != FMU_TYPE:
        raise TouchdownError(f"{where}: the type {kind} is not supported, only {FMU_TYPE} is")
    if element.get("implementation", "any") == "ModelExchange":
        raise TouchdownError(f"{where} asks for model exchange; only co-simulation is supported")
    source = xml.required(element, "source", where)
    path, values = xml.inside(folder, source, where), bindings.values(element, folder, where)
    hint = _annotation(element, STEP_ANNOTATION, "osp:StepSizeHint")
    step = None if hint is None else xml.number(hint, "value", where)
    return Part(path, _connectors(element, where), values, step)


def _connectors(element: Element, where: str) -> dict[str, Connector]:
    connectors: dict[str, Connector] = {}
    for connector in xml.children(element, "ssd:Connectors/ssd:Connector"):
        reals = (xml.child(connector, f"ssc:{real}") for real in REALS)
        unit = next((real.get("unit") for real in reals if real is not None), None)
        name = xml.required(connector, "name", where)
        connectors[name] = Connector(connector.get("kind", ""), unit or None)
    return connectors


def _hops(
    system: Element,
    parts: Mapping[str, Part],
    inner: Mapping[str, Node],
    own: Mapping[str, Connector],
    where: str,
) -> list[Hop]:
    """The connections of a system, turned the way that values go: the standard leaves their order open."""
    hops: list[Hop] = []
    for element in xml.children(system, "ssd:Connections/ssd:Connection"):
        start = element.get("startElement") or None, xml.required(element, "startConnector", where)
        end = element.get("endElement") or None, xml.required(element, "endConnector", where)
        for name, _ in (start, end):
            if name is not None and name not in parts and name not in inner:
                known = [*parts, *inner]
                raise TouchdownError(
                    f"{where}: connection {titled(start)} to {titled(end)}: there is no component {name}; "
                    f"{one_of(name, known)}"
                )

        def gives(end: End) -> bool | None:
            """Whether values come from there; None where that is not declared."""
            name, connector = end
            declared = own if name is None else (parts.get(name) or inner[name]).connectors
            kind = declared[connector].kind if connector in declared else ""
            if kind not in (*GIVING, *TAKING):
                return None
            return (kind in GIVING) != (name is None)

        if gives(start) is False or gives(end) is True:
            start, end = end, start
        hops.append(
            Hop(
                start,
                end,
                convert=not xml.switch(element, "suppressUnitConversion", where),
                scale=xml.transformation(element, f"{where}: a connection"),
            )
        )
    return hops


def titled(end: End) -> str:
    """For people."""
    return ".".join(part for part in end if part is not None)


# -- steps -------------------------------------------------------------------------------------------------


def _experiment(root: Element, where: str) -> tuple[float, float | None, float | None]:
    """Start time, stop time and macro step (s), the last two as far as they are given."""
    experiment = xml.child(root, "ssd:DefaultExperiment")
    if experiment is None:
        return 0.0, None, None
    start = xml.number(experiment, "startTime", where, 0.0)
    if start < 0.0:
        raise TouchdownError(f"{where} starts at t = {start:g} s; a start below 0 s is not supported")
    stop = xml.number(experiment, "stopTime", where) if experiment.get("stopTime") else None
    if stop is not None and stop <= start:
        raise TouchdownError(f"{where} stops at t = {stop:g} s, and starts at t = {start:g} s")
    step = _annotation(experiment, STEP_ANNOTATION, "osp:Algorithm/osp:FixedStepAlgorithm")
    return start, stop, None if step is None else xml.number(step, "baseStepSize", where)


def _masters_step(system: Element, where: str) -> float | None:
    """The step (s) of OMSimulator's master, however its versions write it; of one with variable steps, its
    longest.
    """
    path = "oms:Annotations/oms:SimulationInformation"
    information = _annotation(system, MASTER_ANNOTATION, path)
    if information is None:
        return None
    fixed, variable = (xml.child(information, f"oms:{kind}StepMaster") for kind in ("Fixed", "Variable"))
    for element, key in (
        (fixed, "stepSize"),
        (information, "fixedStepSize"),
        (variable, "maximumStepSize"),
        (information, "maximumStepSize"),
    ):
        if element is not None and element.get(key):
            return xml.number(element, key, f"{where}: OMSimulator's annotation")
    return None


# -- annotations -------------------------------------------------------------------------------------------


def _annotation(element: Element, kind: str, path: str) -> Element | None:
    """What stands at `path` in the element's annotation of that type."""
    for annotation in xml.children(element, "ssd:Annotations/ssc:Annotation"):
        if annotation.get("type") == kind:
            return xml.child(annotation, path)
    return None


def _names(note: Element, where: str) -> dict[str, dict[str, str]]:
    names: dict[str, dict[str, str]] = {}
    for name in xml.children(note, "touchdown:Name"):
        component, here, own = (xml.required(name, key, where) for key in ("component", "name", "own"))
        names.setdefault(component, {})[here] = own
    return names


def _changed(note: Element, where: str) -> dict[str, list[str]]:
    changed: dict[str, list[str]] = {}
    for element in xml.children(note, "touchdown:Changed"):
        component, name = (xml.required(element, key, where) for key in ("component", "name"))
        changed.setdefault(component, []).append(name)
    return changed


def _bonds(note: Element, where: str) -> list[dict[str, str]]:
    bonds: list[dict[str, str]] = []
    for element in xml.children(note, "touchdown:Bond"):
        motion = {kind: told for kind in ("position", "velocity") if (told := element.get(kind))}
        bonds.append({"force": xml.required(element, "force", where), **motion})
        if not motion:
            raise TouchdownError(f"{where}: the Bond of {bonds[-1]['force']} has no position or velocity")
    return bonds
