"""SystemStructure.ssd and parameter bindings of a package, before they are applied."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path
from xml.etree.ElementTree import Element

from ....modelkit.reader import Table
from ...common.errors import TouchdownError, one_of
from ...common.units import Scale, Unit
from ...components.loading import TABLE_REMEDY
from ...scene.gaps import RotorGap, read_gaps
from ...scene.requirements import Requirement, read_requirements
from ...scene.scene import Document
from . import xml
from .xml import INTEGERS, MASTER_ANNOTATION, REALS, SCENE_ANNOTATION, SSD_FILE, STEP_ANNOTATION

SET_TYPE, MAPPING_TYPE = "application/x-ssp-parameter-set", "application/x-ssp-parameter-mapping"
BOOLEANS = {"true": 1.0, "1": 1.0, "false": 0.0, "0": 0.0}


@dataclass(frozen=True)
class Value:
    """A value in a binding."""

    name: str
    content: Sequence[float | str]  # numbers, and texts or words of enumerations: one, or those of an array
    unit: str | None = None
    units: Mapping[str, Unit] | None = None  # that the parameter set defines
    convert: bool = True  # to the unit of the variable
    scale: Scale | None = None  # on the converted value


def _binding_values(element: Element, folder: Path, where: str) -> list[Value]:
    """The values that the bindings of a component or a system give, later ones over earlier ones."""
    by_name: dict[str, Value] = {}
    for binding in xml.children(element, "ssd:ParameterBindings/ssd:ParameterBinding"):
        values = _set(binding, folder, where)
        prefix = binding.get("prefix", "")
        values = [replace(value, name=f"{prefix}{value.name}") for value in values]
        mapping = xml.first_child(binding, "ssd:ParameterMapping")
        if mapping is not None:
            values = list(_mapped(values, mapping, folder, where))
        by_name |= {value.name: value for value in values}
    return list(by_name.values())


def _set(binding: Element, folder: Path, where: str) -> list[Value]:
    where = f"{where}, parameter binding"
    content = _content(binding, "ssd:ParameterValues/ssv:ParameterSet", "ssv:ParameterSet", folder, where)
    kind = binding.get("type", SET_TYPE)
    if kind != SET_TYPE:
        raise TouchdownError(f"{where}: the type {kind} is not supported, only {SET_TYPE} is")
    if content is None:
        return []
    units = xml.unit_definitions(content, "ssv:Units", where)
    return [_value(p, units, where) for p in xml.children(content, "ssv:Parameters/ssv:Parameter")]


def _content(element: Element, inline: str, root: str, folder: Path, where: str) -> Element | None:
    """The content of an element, inline or in the file it names."""
    if element.get("sourceBase", "SSD") != "SSD":
        raise TouchdownError(f"{where}: sourceBase = {element.get('sourceBase')!r} is not supported")
    source = element.get("source")
    if not source:
        return xml.first_child(element, inline)
    return xml.read_xml(xml.inside(folder, source, where), f"{where}: {source}", root)


def _value(parameter: Element, units: Mapping[str, Unit], where: str) -> Value:
    name = xml.required(parameter, "name", where)
    where = f"{where}, {name}"
    for kind in (*REALS, *INTEGERS):
        content = xml.first_child(parameter, f"ssv:{kind}")
        if content is not None:
            parts = xml.required(content, "value", where).split()
            numbers = [xml.number_of(part, f"{where}: value") for part in parts]
            return Value(name, numbers, xml.unit_of(content), units)
    for kind in ("Enumeration", "String", "Binary"):
        content = xml.first_child(parameter, f"ssv:{kind}")
        if content is not None:
            text = content.get("value", "")
            return Value(name, [] if kind == "Binary" else [text])  # no Binary can be set
    content = xml.first_child(parameter, "ssv:Boolean")
    if content is None:
        raise TouchdownError(f"{where}: has no value of a type of SSP, such as Real or String")
    texts = xml.required(content, "value", where).split()
    if wrong := [text for text in texts if text not in BOOLEANS]:
        raise TouchdownError(f"{where}: {wrong[0]!r} is neither true nor false")
    return Value(name, [BOOLEANS[text] for text in texts])


def _mapped(values: Iterable[Value], mapping: Element, folder: Path, where: str) -> Iterable[Value]:
    """Values under the names that a mapping gives them; those it does not name are not applied.

    A mapping without entries, which some tools write for every parameter set, leaves all names unchanged.
    """
    where = f"{where}, parameter mapping"
    kind = mapping.get("type", MAPPING_TYPE)
    if kind != MAPPING_TYPE:
        raise TouchdownError(f"{where}: the type {kind} is not supported, only {MAPPING_TYPE} is")
    content = _content(mapping, "ssm:ParameterMapping", "ssm:ParameterMapping", folder, where)
    entries = xml.children(content, "ssm:MappingEntry") if content is not None else []
    if not entries:
        yield from values
    by_name = {value.name: value for value in values}
    for entry in entries:
        if entry.get("source") == "":  # an entry left empty
            continue
        source, target = xml.required(entry, "source", where), xml.required(entry, "target", where)
        if source in by_name:
            yield replace(
                by_name[source],
                name=target,
                convert=not xml.switch(entry, "suppressUnitConversion", where),
                scale=xml.transformation(entry, f"{where}, {source} to {target}"),
            )


FMU_TYPE = "application/x-fmu-sharedlibrary"
GIVING, TAKING = ("output", "calculatedParameter"), ("input", "parameter")  # kinds of connectors


@dataclass(frozen=True)
class _Connector:
    """The declared part of a connector."""

    kind: str
    unit: str | None


@dataclass(frozen=True)
class ComponentElement:
    """A component."""

    path: Path  # of its FMU
    connectors: Mapping[str, _Connector]
    values: Sequence[Value]
    step: float | None  # s, its own macro step, where it asks for one


End = tuple[str | None, str]  # element (None: the system itself) and connector


@dataclass(frozen=True)
class _Hop:
    """A connection, from the source of a value to its target."""

    start: End
    end: End
    convert: bool  # between the units of its ends
    scale: Scale | None


@dataclass(frozen=True)
class SystemElement:
    """A system, and what is in it."""

    title: str
    parts: Mapping[str, ComponentElement]
    inner: Mapping[str, SystemElement]
    connectors: Mapping[str, _Connector]
    hops: Sequence[_Hop]
    values: Sequence[Value]  # for ELEMENT.VARIABLE, or one of its connectors


@dataclass(frozen=True)
class Structure:
    """The content of SystemStructure.ssd."""

    root: SystemElement
    units: Mapping[str, Unit]
    start: float  # s
    stop: float | None  # s
    macro_step: float | None  # s
    scene: Mapping[str, str]  # what a package of this project says beyond the structure
    names: Mapping[str, Mapping[str, str]]  # by component: variables of the contract, and its own
    sampled: Mapping[str, float]  # s, by component: from one of its steps to the next
    changed: Mapping[str, Sequence[str]]  # by component: what the user set beside the scene
    bonds: Sequence[Mapping[str, str]]  # that are declared: the inputs that take force, position, velocity
    gaps: Sequence[RotorGap]
    requirements: Sequence[Requirement]
    document: Document


SSD_ROOT = "ssd:SystemStructureDescription"


def structure_file(folder: Path, variant: str, where: str) -> tuple[str, list[str]]:
    """The .ssd of a variant of an unpacked package, by its file's name or its own; the names of others.

    variant: "" is the package's default. Raises TouchdownError where there is none of that name.
    """
    files = {path.stem: path.name for path in sorted(folder.glob("*.ssd"))}
    if not variant:
        return SSD_FILE, [name for name in files if files[name] != SSD_FILE]
    by_title = dict[str, str]()
    for path in () if variant in files else map(folder.joinpath, files.values()):
        with suppress(TouchdownError):
            by_title[xml.read_xml(path, f"{where}: {path.name}", SSD_ROOT).get("name", "")] = path.name
    if variant not in by_title | files:
        raise TouchdownError(f"{where} has no variant {variant}; {one_of(variant, by_title | files)}")
    return (by_title | files)[variant], []


def read_structure(folder: Path, where: str, file: str = SSD_FILE) -> Structure:
    """The structure in a file of an unpacked package. Raises TouchdownError for what cannot be run."""
    root = xml.read_xml(folder / file, f"{where}: {file}", SSD_ROOT)
    version = root.get("version", "")
    if not version.startswith(("1.", "2.")):
        raise TouchdownError(f"{where} is SSP {version or 'of no version'}; SSP 1.0 or 2.0 is needed")
    system = xml.first_child(root, "ssd:System")
    if system is None:
        raise TouchdownError(f"{where} has no System")
    start, stop, macro_step = _experiment(root, where)
    note = _annotation(system, SCENE_ANNOTATION, "touchdown:Scene")
    if note is None:  # older packages have it at the root, packages of other tools lack it
        note = _annotation(root, SCENE_ANNOTATION, "touchdown:Scene")
    if note is None:
        note = Element(xml.tag("touchdown:Scene"))
    said = xml.first_child(note, "touchdown:Document")
    said = Element("none") if said is None else said
    return Structure(
        root=_node(system, folder, where, root.get("name") or folder.name),
        units=xml.unit_definitions(root, "ssd:Units", where),
        start=start,
        stop=stop,
        macro_step=macro_step or _masters_step(system, where),
        scene=dict(note.attrib),
        names=_names(note, where),
        sampled=_sampled(note, where),
        changed=_changed(note, where),
        bonds=_bonds(note, where),
        gaps=_gaps(note, where),
        requirements=_requirements(note, where),
        document=Table(f"{where}: Document ", dict(said.attrib)).read(Document),
    )


def _node(system: Element, folder: Path, where: str, title: str) -> SystemElement:
    if xml.first_child(system, "ssd:SignalDictionaries") is not None:
        raise TouchdownError(f"{where} has signal dictionaries, which are not supported; connect directly")
    parts: dict[str, ComponentElement] = {}
    inner: dict[str, SystemElement] = {}
    elements = xml.first_child(system, "ssd:Elements")
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
    return SystemElement(
        title=system.get("description") or title,
        parts=parts,
        inner=inner,
        connectors=connectors,
        hops=_hops(system, parts, inner, connectors, where),
        values=_binding_values(system, folder, where),
    )


def _part(element: Element, folder: Path, where: str) -> ComponentElement:
    kind = element.get("type", FMU_TYPE)
    if kind != FMU_TYPE:
        remedy = f"; {TABLE_REMEDY}" if kind == "text/csv" else ""
        raise TouchdownError(f"{where}: the type {kind} is not supported, only {FMU_TYPE} is{remedy}")
    if element.get("implementation", "any") == "ModelExchange":
        raise TouchdownError(f"{where} asks for model exchange; only co-simulation is supported")
    source = xml.required(element, "source", where)
    path, values = xml.inside(folder, source, where), _binding_values(element, folder, where)
    hint = _annotation(element, STEP_ANNOTATION, "osp:StepSizeHint")
    step = None if hint is None else xml.number_attribute(hint, "value", where)
    return ComponentElement(path, _connectors(element, where), values, step)


def _connectors(element: Element, where: str) -> dict[str, _Connector]:
    connectors: dict[str, _Connector] = {}
    for connector in xml.children(element, "ssd:Connectors/ssd:Connector"):
        reals = (xml.first_child(connector, f"ssc:{real}") for real in REALS)
        unit = next((xml.unit_of(real) for real in reals if real is not None), None)
        name = xml.required(connector, "name", where)
        connectors[name] = _Connector(connector.get("kind", ""), unit or None)
    return connectors


def _hops(
    system: Element,
    parts: Mapping[str, ComponentElement],
    inner: Mapping[str, SystemElement],
    system_connectors: Mapping[str, _Connector],
    where: str,
) -> list[_Hop]:
    """The connections of a system, turned the way that values go: the standard leaves their order open."""
    hops: list[_Hop] = []
    for element in xml.children(system, "ssd:Connections/ssd:Connection"):
        start = element.get("startElement") or None, xml.required(element, "startConnector", where)
        end = element.get("endElement") or None, xml.required(element, "endConnector", where)
        for name, _ in (start, end):
            if name is not None and name not in parts and name not in inner:
                known = [*parts, *inner]
                raise TouchdownError(
                    f"{where}: connection {_titled(start)} to {_titled(end)}: there is no component {name}"
                    f"; {one_of(name, known)}"
                )

        def gives(end: End) -> bool | None:
            """Whether values come from there; None where that is not declared."""
            name, connector = end
            declared = system_connectors if name is None else (parts.get(name) or inner[name]).connectors
            kind = declared[connector].kind if connector in declared else ""
            if kind not in (*GIVING, *TAKING):
                return None
            return (kind in GIVING) != (name is None)

        if gives(start) is False or gives(end) is True:
            start, end = end, start
        hops.append(
            _Hop(
                start,
                end,
                convert=not xml.switch(element, "suppressUnitConversion", where),
                scale=xml.transformation(element, f"{where}: a connection"),
            )
        )
    return hops


def _titled(end: End) -> str:
    """For people."""
    return ".".join(part for part in end if part is not None)


# -- steps -------------------------------------------------------------------------------------------------


def _experiment(root: Element, where: str) -> tuple[float, float | None, float | None]:
    """Start time, stop time and macro step (s), the last two None where they are missing."""
    experiment = xml.first_child(root, "ssd:DefaultExperiment")
    if experiment is None:
        return 0.0, None, None
    start = xml.number_attribute(experiment, "startTime", where, 0.0)
    if start < 0.0:
        raise TouchdownError(f"{where} starts at t = {start:g} s; a start below 0 s is not supported")
    stop = xml.number_attribute(experiment, "stopTime", where) if experiment.get("stopTime") else None
    if stop is not None and stop <= start:
        raise TouchdownError(f"{where} stops at t = {stop:g} s, and starts at t = {start:g} s")
    step = _annotation(experiment, STEP_ANNOTATION, "osp:Algorithm/osp:FixedStepAlgorithm")
    return start, stop, None if step is None else xml.number_attribute(step, "baseStepSize", where)


def _masters_step(system: Element, where: str) -> float | None:
    """The step (s) of OMSimulator's master, however its versions write it; of one with variable steps, its
    longest.
    """
    path = "oms:Annotations/oms:SimulationInformation"
    information = _annotation(system, MASTER_ANNOTATION, path)
    if information is None:
        return None
    fixed, variable = (
        xml.first_child(information, f"oms:{kind}StepMaster") for kind in ("Fixed", "Variable")
    )
    for element, key in (
        (fixed, "stepSize"),
        (information, "fixedStepSize"),
        (variable, "maximumStepSize"),
        (information, "maximumStepSize"),
    ):
        if element is not None and element.get(key):
            return xml.number_attribute(element, key, f"{where}: OMSimulator's annotation")
    return None


# -- annotations -------------------------------------------------------------------------------------------


def _annotation(element: Element, kind: str, path: str) -> Element | None:
    """The content at `path` in the element's annotation of that type."""
    for annotation in xml.children(element, "ssd:Annotations/ssc:Annotation"):
        if annotation.get("type") == kind:
            return xml.first_child(annotation, path)
    return None


def _names(note: Element, where: str) -> dict[str, dict[str, str]]:
    names: dict[str, dict[str, str]] = {}
    for name in xml.children(note, "touchdown:Name"):
        component, scene_name, fmu_name = (
            xml.required(name, key, where) for key in ("component", "name", "own")
        )
        names.setdefault(component, {})[scene_name] = fmu_name
    return names


def _sampled(note: Element, where: str) -> dict[str, float]:
    return {
        xml.required(element, "component", where): xml.number_attribute(element, "period", where)
        for element in xml.children(note, "touchdown:Sampled")
    }


def _changed(note: Element, where: str) -> dict[str, list[str]]:
    changed: dict[str, list[str]] = {}
    for element in xml.children(note, "touchdown:Changed"):
        component, name = (xml.required(element, key, where) for key in ("component", "name"))
        changed.setdefault(component, []).append(name)
    return changed


def _bonds(note: Element, where: str) -> list[dict[str, str]]:
    bonds: list[dict[str, str]] = []
    for element in xml.children(note, "touchdown:Bond"):
        motion = {kind: named for kind in ("position", "velocity") if (named := element.get(kind))}
        bonds.append({"force": xml.required(element, "force", where), **motion})
        if not motion:
            raise TouchdownError(f"{where}: the Bond of {bonds[-1]['force']} has no position or velocity")
    return bonds


def _gaps(note: Element, where: str) -> tuple[RotorGap, ...]:
    attributes = [
        _attributes(element, ("radial", "axial", "radius"), where)
        for element in xml.children(note, "touchdown:Gap")
    ]
    return read_gaps(Table(f"{where}: ", {"gap": attributes}).tables("gap"))


def _requirements(note: Element, where: str) -> tuple[Requirement, ...]:
    tables: dict[str, dict[str, object]] = {}
    for one in xml.children(note, "touchdown:Requirement"):
        limit = xml.number_attribute(one, "limit", f"{where}: Requirement")
        stated = {"limit": limit, "clause": one.get("clause", "")}
        kind, of = xml.required(one, "kind", where), one.get("of")
        tables.setdefault(kind, {}).update({of: stated} if of else stated)
    return read_requirements(Table(f"{where}: Requirement ", tables))


def _attributes(element: Element, numbers: Sequence[str], where: str) -> dict[str, object]:
    """The attributes of an element, some of them numbers."""
    attributes: dict[str, object] = dict(element.attrib)
    return attributes | {
        key: xml.number_attribute(element, key, where) for key in numbers if key in attributes
    }
