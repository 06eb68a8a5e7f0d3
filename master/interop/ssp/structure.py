"""SystemStructure.ssd as it stands: components, connections, bindings, experiment."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from xml.etree.ElementTree import Element

from touchdown.master.common.errors import TouchdownError, one_of
from touchdown.master.common.units import Scale, Unit
from touchdown.master.coupling.simulation import MOST_STEPS
from touchdown.master.interop.ssp import bindings, xml
from touchdown.master.interop.ssp.bindings import Value
from touchdown.master.interop.ssp.names import HEART, SCENE_ANNOTATION, STEP_ANNOTATION

FMU_TYPE = "application/x-fmu-sharedlibrary"


@dataclass(frozen=True)
class Part:
    """A component."""

    name: str
    path: Path  # of its FMU
    units: Mapping[str, str]  # that its connectors declare, by variable
    values: Sequence[Value]
    step: float | None  # s, its own macro step, where it asks for one


@dataclass(frozen=True)
class Link:
    """A connection; an end without a part is a connector of the system itself."""

    start: str | None
    output: str
    end: str | None
    input: str
    convert: bool  # between the units of its ends
    scale: Scale | None

    @property
    def title(self) -> str:
        """For people."""
        names = [f"{part}.{name}" if part else name for part, name in self.ends]
        return f"connection {names[0]} to {names[1]}"

    @property
    def ends(self) -> tuple[tuple[str | None, str], tuple[str | None, str]]:
        """Part and variable, of start and end."""
        return (self.start, self.output), (self.end, self.input)


@dataclass(frozen=True)
class Structure:
    """A system without systems inside."""

    title: str
    parts: Mapping[str, Part]
    links: Sequence[Link]
    values: Sequence[Value]  # of the system: for COMPONENT.VARIABLE, or a connector of its own
    units: Mapping[str, Unit]
    stop: float | None  # s
    macro_step: float | None  # s
    scene: Mapping[str, str]  # what a package of this project says beyond the structure
    names: Mapping[str, Mapping[str, str]]  # by component: variables of the contract, and its own
    changed: Mapping[str, Sequence[str]]  # by component: what the user set beside the scene

    def every(self, name: str) -> int:
        """How many of the system's macro steps the component `name` takes in one. Raises TouchdownError."""
        step = self.parts[name].step
        ratio = step / self.macro_step if step and self.macro_step else 1.0
        if not ratio < MOST_STEPS:
            raise TouchdownError(
                f"component {name} asks for steps of {step:g} s, {ratio:g} of the package's macro steps; "
                f"less than {MOST_STEPS:g} are possible"
            )
        return max(1, round(ratio))


def read(folder: Path, where: str) -> Structure:
    """The structure of an unpacked package. Raises TouchdownError for what cannot be run."""
    root = xml.read_xml(folder / HEART, f"{where}: {HEART}", "ssd:SystemStructureDescription")
    version = root.get("version", "")
    if not version.startswith("1."):
        raise TouchdownError(f"{where} is SSP {version or 'of no version'}; SSP 1.0 is needed")
    system = xml.child(root, "ssd:System")
    if system is None:
        raise TouchdownError(f"{where} has no System")
    stop, macro_step = _experiment(root, where)
    note = _annotation(system, SCENE_ANNOTATION, "touchdown:Scene")
    if note is None:  # older packages have it at the root
        note = _annotation(root, SCENE_ANNOTATION, "touchdown:Scene")
    parts = _parts(system, folder, where)
    return Structure(
        title=system.get("description") or root.get("name") or folder.name,
        parts=parts,
        links=_links(system, parts, where),
        values=bindings.values(system, folder, where),
        units=xml.unit_definitions(root, "ssd:Units", where),
        stop=stop,
        macro_step=macro_step,
        scene={} if note is None else dict(note.attrib),
        names=_names(note, where),
        changed=_changed(note, where),
    )


def _parts(system: Element, folder: Path, where: str) -> dict[str, Part]:
    if xml.child(system, "ssd:SignalDictionaries") is not None:
        raise TouchdownError(f"{where} has signal dictionaries, which are not supported; connect directly")
    parts: dict[str, Part] = {}
    elements = xml.child(system, "ssd:Elements")
    for element in elements if elements is not None else ():
        kind = element.tag.rpartition("}")[2]
        name = xml.required(element, "name", where)
        if kind != "Component":
            what = "nested systems are" if kind == "System" else "that kind of element is"
            raise TouchdownError(f"{where} holds the {kind} {name}; {what} not supported, only FMUs are")
        if name in parts:
            raise TouchdownError(f"{where} has two components {name}")
        parts[name] = _part(element, name, folder, f"{where}: component {name}")
    if not parts:
        raise TouchdownError(f"{where} has no components")
    return parts


def _part(element: Element, name: str, folder: Path, where: str) -> Part:
    if "." in name or "/" in name:
        raise TouchdownError(f"{where}: names with a dot or a slash are not supported; rename it")
    kind = element.get("type", FMU_TYPE)
    if kind != FMU_TYPE:
        raise TouchdownError(f"{where}: the type {kind} is not supported, only {FMU_TYPE} is")
    if element.get("implementation", "any") == "ModelExchange":
        raise TouchdownError(f"{where} asks for model exchange; only co-simulation is supported")
    units: dict[str, str] = {}
    for connector in xml.children(element, "ssd:Connectors/ssd:Connector"):
        real = xml.child(connector, "ssc:Real")
        unit = real.get("unit") if real is not None else None
        if unit:
            units[xml.required(connector, "name", where)] = unit
    source = xml.required(element, "source", where)
    path, values = xml.inside(folder, source, where), bindings.values(element, folder, where)
    hint = _annotation(element, STEP_ANNOTATION, "osp:StepSizeHint")
    step = None if hint is None else xml.number(hint, "value", where)
    return Part(name, path, units, values, step)


def _links(system: Element, parts: Mapping[str, Part], where: str) -> list[Link]:
    links: list[Link] = []
    for element in xml.children(system, "ssd:Connections/ssd:Connection"):
        link = Link(
            start=element.get("startElement"),
            output=xml.required(element, "startConnector", where),
            end=element.get("endElement"),
            input=xml.required(element, "endConnector", where),
            convert=not xml.switch(element, "suppressUnitConversion", where),
            scale=xml.transformation(element, f"{where}: a connection"),
        )
        for part in (link.start, link.end):
            if part is not None and part not in parts:
                raise TouchdownError(
                    f"{where}: {link.title}: there is no component {part}; {one_of(part, parts)}"
                )
        links.append(link)
    return links


def _experiment(root: Element, where: str) -> tuple[float | None, float | None]:
    """Stop time and macro step (s), as far as they are given."""
    experiment = xml.child(root, "ssd:DefaultExperiment")
    if experiment is None:
        return None, None
    start = xml.number(experiment, "startTime", where, 0.0)
    if start != 0.0:
        raise TouchdownError(f"{where} starts at t = {start:g} s; only a start at 0 is supported")
    stop = xml.number(experiment, "stopTime", where) if experiment.get("stopTime") else None
    step = _annotation(experiment, STEP_ANNOTATION, "osp:Algorithm/osp:FixedStepAlgorithm")
    return stop, None if step is None else xml.number(step, "baseStepSize", where)


def _annotation(element: Element, kind: str, path: str) -> Element | None:
    """What stands at `path` in the element's annotation of that type."""
    for annotation in xml.children(element, "ssd:Annotations/ssc:Annotation"):
        if annotation.get("type") == kind:
            return xml.child(annotation, path)
    return None


def _names(note: Element | None, where: str) -> dict[str, dict[str, str]]:
    names: dict[str, dict[str, str]] = {}
    for name in xml.children(note, "touchdown:Name") if note is not None else ():
        component, here, own = (xml.required(name, key, where) for key in ("component", "name", "own"))
        names.setdefault(component, {})[here] = own
    return names


def _changed(note: Element | None, where: str) -> dict[str, list[str]]:
    changed: dict[str, list[str]] = {}
    for element in xml.children(note, "touchdown:Changed") if note is not None else ():
        component, name = (xml.required(element, key, where) for key in ("component", "name"))
        changed.setdefault(component, []).append(name)
    return changed
