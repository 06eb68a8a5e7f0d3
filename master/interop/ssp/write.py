"""Writes a scene as an SSP 1.0 package: the FMUs, their parameters, and every single connection.

Connections are those the scheme lays out, between started FMUs, so that of a rotor's elastic modes only
those in use are there. Inputs carry their value at the start as start value, for tools that do not hand
constants such as `inv_m` over during initialisation; tools that connect only outputs get them as start
values alone. The project's own FMUs start from all these values by themselves, for tools that set none.
Equal scenes give equal bytes.

Annotations hold the macro step, where each tool looks for it, and the rest of the scene. OMSimulator reads
the first annotation of the system and refuses any at the root of the structure, or in its components. Its
Python interface takes the master's step from attributes, its command line from an element inside; both are
there.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import count
from pathlib import Path
from xml.etree.ElementTree import Element, SubElement, indent

from ....fmus.build import write_zip
from ....fmus.presentation.terminals import document
from ....fmus.version import VERSION
from ....modelkit.kernel.writing import make_folder
from ....modelkit.variables import Causality
from ...common.errors import TouchdownError
from ...common.units import Unit
from ...components.component import WHOLE, Component, FmiType, Setting
from ...coupling.bonds.bond import Bond
from ...coupling.connections import Connection
from ...coupling.loop.span import Span, span, time_zero
from ...coupling.simulation import opened
from ...coupling.system import System
from ...scene.run_spec import END, RunSpec
from ...scene.scene import Scene, amended
from .packing import changes, fixed, packed_fmus, start_values, texts
from .xml import MASTER_ANNOTATION, NAMESPACES, RESOURCES, SCENE_ANNOTATION, SSD_FILE, STEP_ANNOTATION

OMS_DEFAULT = "oms_ma_default"  # the master that OMSimulator gives components that name none
OMS_TOLERANCE = "0.0001"  # OMSimulator's own; a master with fixed steps ignores it


def _write_master(system: Element, step: float) -> None:
    """The macro step (s) for OMSimulator; it must be the system's first annotation."""
    annotations = SubElement(_annotation(system, MASTER_ANNOTATION), "oms:Annotations")
    attributes = {"name": OMS_DEFAULT, "method": "oms_ma", "fixedStepSize": repr(step)}
    information = SubElement(
        annotations, "oms:SimulationInformation", {**attributes, "relativeTolerance": OMS_TOLERANCE}
    )
    fixed = {"description": "oms-ma", "stepSize": repr(step), "relativeTolerance": OMS_TOLERANCE}
    SubElement(information, "oms:FixedStepMaster", fixed)


def _write_scene(
    system: Element, scene: Scene, declared: Sequence[Bond], name_of: Callable[[str], str]
) -> None:
    """Write the parts of a scene beyond its structure, and the bonds that it declares.

    name_of(name): the name of COMPONENT[.VARIABLE] in the package.
    """
    details = {
        "title": scene.title,
        "about": scene.about.strip(),
        "zero": name_of(scene.zero) if scene.zero else "",
        "energy_scale": " ".join(map(name_of, scene.energy_scale)),
        **_run(scene.run, name_of),
    }
    stated = {key: value for key, value in details.items() if value}
    note = SubElement(_annotation(system, SCENE_ANNOTATION), "touchdown:Scene", stated)
    for name, spec in scene.components.items():
        for scene_name, fmu_name in spec.names.items():
            attributes = {"component": name_of(name), "name": scene_name, "own": fmu_name}
            SubElement(note, "touchdown:Name", attributes)
        if spec.sampled:
            attributes = {"component": name_of(name), "period": repr(spec.sampled)}
            SubElement(note, "touchdown:Sampled", attributes)
        for changed in spec.own:
            SubElement(note, "touchdown:Changed", {"component": name_of(name), "name": changed})
    for gap in scene.gaps:
        attributes = {"name": gap.name, "at": name_of(gap.at)}
        sizes = ("radial", "axial", "radius")
        attributes |= {key: repr(size) for key in sizes if (size := getattr(gap, key)) is not None}
        stator = {"stator": name_of(gap.stator)} if gap.stator else {}
        SubElement(note, "touchdown:Gap", attributes | stator)
    for one in scene.requirements:
        stated = {key: value for key, value in (("of", one.of), ("clause", one.clause)) if value}
        attributes = {"kind": one.kind, "limit": repr(one.limit)} | stated
        SubElement(note, "touchdown:Requirement", attributes)
    if document := {key: value for key, value in vars(scene.document).items() if value}:
        SubElement(note, "touchdown:Document", document)
    for bond in declared:
        wires = {"force": bond.force, "position": bond.position, "velocity": bond.velocity}
        inputs = {kind: name_of(c.target_name) for kind, c in wires.items() if c}  # each has one source
        SubElement(note, "touchdown:Bond", inputs)


def _run(run: RunSpec, name_of: Callable[[str], str]) -> Mapping[str, str]:
    return {
        "scheme": run.scheme.name,
        "bonds": run.bonds,
        "tolerance": repr(run.tolerance),
        "record_every": str(run.record_every),
        "record": ",".join(map(name_of, run.record)),
        "record_also": ",".join(map(name_of, run.record_also)),
        "record_arrays": str(run.record_arrays).lower(),
        "warn_residual": repr(run.warn_residual),
        "stop_residual": repr(run.stop_residual),
        "whirl_halvings": str(run.whirl_halvings),
        "impact_step": repr(run.impact_step),
        **({} if run.until == END else {"until": run.until}),
    }


def _annotation(element: Element, kind: str) -> Element:
    """A new annotation of `element`."""
    annotations = element.find("ssd:Annotations")
    if annotations is None:
        annotations = SubElement(element, "ssd:Annotations")
    return SubElement(annotations, "ssc:Annotation", {"type": kind})


CONNECTED = (Causality.INPUT, Causality.OUTPUT, Causality.PARAMETER, Causality.CALCULATED_PARAMETER)
START_VALUES = "initialValues"  # name of every component's parameter set: tools apply sets by name


@dataclass(frozen=True)
class _Content:
    """An initialised system, and the parts of it that go into the package."""

    scene: Scene
    system: System
    connected: Sequence[Connection]
    sources: Mapping[str, str]  # by component: its FMU's place in the package
    times: Span

    def name_in_package(self, name: str) -> str:
        """The name of COMPONENT, or of COMPONENT.VARIABLE, in the package."""
        head, dot, tail = name.partition(".")
        return f"{self.names.get(head, head)}{dot}{tail}"

    @property
    def names(self) -> Mapping[str, str]:
        """Components, by their names in the scene."""
        return identifiers(self.sources)


def identifiers(names: Iterable[str]) -> dict[str, str]:
    """For each of `names` one that every tool takes: a letter, then letters, digits and underscores.

    >>> identifiers(["rotor", "amb-A", "amb_A", "2nd"])
    {'rotor': 'rotor', 'amb-A': 'amb_A_2', 'amb_A': 'amb_A', '2nd': 'x2nd'}
    """
    plain = {name: re.sub(r"\W", "_", name, flags=re.ASCII) for name in names}
    plain = {name: new if new[:1].isalpha() else f"x{new}" for name, new in plain.items()}
    taken = {name for name, new in plain.items() if name == new}
    for name, new in plain.items():
        if name != new:
            count = 1
            while (numbered := f"{new}_{count}" if count > 1 else new) in taken:
                count += 1
            taken.add(numbered)
            plain[name] = numbered
    return plain


def _structure(content: _Content) -> Element:
    """The root element."""
    scene, system = content.scene, content.system
    names, units = identifiers([scene.name]), _units(system)
    used = [prefix for prefix in NAMESPACES if prefix != "ssm"]
    root = Element(
        "ssd:SystemStructureDescription",
        {f"xmlns:{prefix}": NAMESPACES[prefix] for prefix in used}
        | {"version": "1.0", "name": names[scene.name], "generationTool": f"touchdown-cosim {VERSION}"},
    )
    described = {
        "name": names[scene.name],
        "description": amended(scene.title, changes(scene, system)),
    }
    whole = SubElement(root, "ssd:System", described)
    elements = SubElement(whole, "ssd:Elements")
    for name in content.sources:
        element = _component(elements, content, name, units)
        if system.every[name] > 1 or name in system.periods:
            step = scene.components[name].step(scene.run.macro_step)
            SubElement(_annotation(element, STEP_ANNOTATION), "osp:StepSizeHint", {"value": repr(step)})
    _connections(whole, content)
    _write_master(whole, scene.run.macro_step)
    declared = system.bonds[: len(scene.bond)]  # they come before those that units tell
    _write_scene(whole, scene, declared, content.name_in_package)
    _unit_definitions(root, units)
    times = {"startTime": repr(content.times.start), "stopTime": repr(content.times.end)}
    experiment = SubElement(root, "ssd:DefaultExperiment", times)
    algorithm = SubElement(_annotation(experiment, STEP_ANNOTATION), "osp:Algorithm")  # for libcosim
    SubElement(algorithm, "osp:FixedStepAlgorithm", {"baseStepSize": repr(scene.run.macro_step)})
    return root


def _connections(whole: Element, content: _Content) -> None:
    connections = SubElement(whole, "ssd:Connections")
    components = content.system.components
    for c in content.connected:
        ends = {
            "startElement": content.name_in_package(c.source),
            "startConnector": components[c.source].own_name(c.output),
            "endElement": content.name_in_package(c.target),
            "endConnector": components[c.target].own_name(c.input),
        }
        unconverted = {"suppressUnitConversion": "true"} if c.scale else {}
        element = SubElement(connections, "ssd:Connection", {**ends, **unconverted})
        if c.scale:
            details = {"factor": repr(c.scale[0]), "offset": repr(c.scale[1])}
            SubElement(element, "ssc:LinearTransformation", details)


def _component(elements: Element, content: _Content, name: str, units: Mapping[str, Unit]) -> Element:
    """A component with the variables that are connected or set, and their values."""
    component = content.system.components[name]
    element = SubElement(
        elements,
        "ssd:Component",
        {
            "name": content.name_in_package(name),
            "source": content.sources[name],
            "type": "application/x-fmu-sharedlibrary",
            "implementation": "CoSimulation",
        },
    )
    outputs = [c.output for c in content.connected if c.source == name]
    inputs = [c.input for c in content.connected if c.target == name]
    values = {**start_values(content.system, name), **texts(content.system, name)}
    settings = [variable for variable in values if component.variable(variable).causality in CONNECTED]
    connectors = SubElement(element, "ssd:Connectors")
    for variable in dict.fromkeys([*inputs, *outputs, *settings]):
        _connector(connectors, component, variable, units)
    if values:
        _parameters(element, component, values, units)
    return element


def _parameters(
    element: Element, component: Component, values: Mapping[str, Setting], units: Mapping[str, Unit]
) -> None:
    """A binding of the element with a set of `values` (SI, or text) by variable."""
    binding = SubElement(SubElement(element, "ssd:ParameterBindings"), "ssd:ParameterBinding")
    parameter_set = SubElement(
        SubElement(binding, "ssd:ParameterValues"),
        "ssv:ParameterSet",
        {"version": "1.0", "name": START_VALUES},
    )
    parameters = SubElement(parameter_set, "ssv:Parameters")
    for variable, value in values.items():
        parameter = SubElement(parameters, "ssv:Parameter", {"name": component.own_name(variable)})
        kind, details = _type(component, variable, units)
        whole = kind is not FmiType.REAL
        written = value if isinstance(value, str) else str(int(value)) if whole else repr(float(value))
        SubElement(parameter, f"ssv:{kind}", {"value": written, **details})


def _connector(connectors: Element, component: Component, name: str, units: Mapping[str, Unit]) -> None:
    causality = component.variable(name).causality
    if causality not in CONNECTED:
        raise TouchdownError(
            f"{component.name}.{name} has the causality {causality}, and SSP connects outputs only; "
            "take it out of the scene's connect"
        )
    element = SubElement(connectors, "ssd:Connector", {"name": component.own_name(name), "kind": causality})
    kind, details = _type(component, name, units)
    SubElement(element, f"ssc:{kind}", details)


def _type(component: Component, name: str, units: Mapping[str, Unit]) -> tuple[FmiType, dict[str, str]]:
    """A variable's type, and its unit where it is one of `units`.

    Enumerations are given as integers, as FMI 2.0 sets them: few tools read SSP's own.
    """
    variable = component.variable(name)
    if variable.kind in WHOLE:
        return FmiType.INTEGER, {}
    unit = variable.unit or ""
    known = variable.kind is FmiType.REAL and unit in units and component.units.get(unit) == units[unit]
    return variable.kind, {"unit": unit} if known else {}


def _units(system: System) -> dict[str, Unit]:
    """Units by name that the FMUs define; where two differ, the first."""
    units: dict[str, Unit] = {}
    for component in system.components.values():
        for name, unit in component.units.items():
            units.setdefault(name, unit)
    return dict(sorted(units.items()))


def _unit_definitions(root: Element, units: Mapping[str, Unit]) -> None:
    if not units:
        return
    definitions = SubElement(root, "ssd:Units")
    for name, unit in units.items():
        element = SubElement(definitions, "ssc:Unit", {"name": name})
        details = {symbol: str(exponent) for symbol, exponent in unit.exponents.items()}
        if unit.factor != 1.0:
            details["factor"] = repr(unit.factor)
        if unit.offset != 0.0:
            details["offset"] = repr(unit.offset)
        SubElement(element, "ssc:BaseUnit", details)


@dataclass(frozen=True)
class _Written:
    """The contents of a package."""

    path: Path
    components: int
    connections: int
    fixed: tuple[str, ...]  # components whose FMUs do not start from the package's values


def write_ssp(
    scene: Scene,
    path: Path,
    outputs_only: bool = False,
    native: bool = False,
    targets: Sequence[str] = (),
) -> _Written:
    """Write `scene` to `path` (.ssp); an older one is replaced. Raises TouchdownError where it cannot.

    With `outputs_only` constants, which are calculated parameters, are not connected; with `native` all of
    the project's own FMUs are native, for the machines named in `targets` (none: this one).
    """
    if targets and not native:
        raise TouchdownError("--target is for native FMUs; add --native")
    with opened(scene, listening=False) as system:
        times = span(scene.run, time_zero(scene, system))
        system.initialise()
        places = _places(packed_fmus(scene, system, native, targets))
        connected = [c for c in system.connections if not (outputs_only and system.constant(c))]
        sources = {name: place for name, (place, _) in places.items()}
        root = _structure(_Content(scene, system, connected, sources, times))
        fmus = dict(sorted(places.values()))
        written = _Written(path, len(sources), len(connected), tuple(fixed(scene, system)))
    indent(root)
    try:
        make_folder(path.parent)
        write_zip(path, {SSD_FILE: document(root), **fmus})
    except OSError as error:
        raise TouchdownError(
            f"cannot write {path}: {error.strerror}; choose another file with -o"
        ) from None
    return written


def _places(paths: Mapping[str, Path]) -> dict[str, tuple[str, bytes]]:
    """By component: its FMU's place in the package, and the FMU. Equal FMUs are packed once."""
    contents = {name: path.read_bytes() for name, path in paths.items()}
    places: dict[bytes, str] = {}
    for component, path in paths.items():
        content = contents[component]
        names = (f"{RESOURCES}/{path.stem}{f'_{n}' if n > 1 else ''}.fmu" for n in count(1))
        if content not in places:
            places[content] = next(name for name in names if name not in places.values())
    return {name: (places[content], content) for name, content in contents.items()}
