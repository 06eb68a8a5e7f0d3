"""Write a scene as an SSP 1.0 package: the FMUs, their parameters, and every single connection.

Connections are those the scheme lays out, between started FMUs, so that of a rotor's elastic modes only
those in use are there. Inputs carry their value at t = 0 as start value, for tools that do not hand
constants such as `inv_m` over during initialisation; for those that cannot even connect them, as they are
no outputs, they are start values only. Equal scenes give equal bytes.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from xml.etree.ElementTree import Element, SubElement, indent, tostring

from touchdown.fmus.version import VERSION
from touchdown.master.common.archives import write_archive
from touchdown.master.common.errors import TouchdownError
from touchdown.master.common.units import Unit
from touchdown.master.components.component import Component, Kind
from touchdown.master.components.fmu import ArchivedFmu
from touchdown.master.coupling.connections import Connection
from touchdown.master.coupling.simulation import open_system
from touchdown.master.coupling.system import System
from touchdown.master.interop.ssp.names import (
    HEART,
    NAMESPACES,
    RESOURCES,
    SCENE_ANNOTATION,
    STEP_ANNOTATION,
)
from touchdown.master.scene.scene import Scene
from touchdown.modelkit.variables import Causality

CONNECTED = (Causality.INPUT, Causality.OUTPUT, Causality.PARAMETER, Causality.CALCULATED_PARAMETER)
START_VALUES = "initialValues"  # name of every component's parameter set: tools apply sets by name


@dataclass(frozen=True)
class Written:
    """What a package holds."""

    path: Path
    components: int
    connections: int


def write_package(scene: Scene, path: Path, outputs_only: bool = False) -> Written:
    """Write `scene` to `path` (.ssp); an older one is replaced. Raises TouchdownError where it cannot.

    With `outputs_only` constants, which are calculated parameters, are not connected.
    """
    system = open_system(scene, listening=False)
    try:
        zero = system.value(scene.zero) if scene.zero else 0.0
        system.initialise()
        files = _resources(system)
        connected = [c for c in system.connections if not (outputs_only and system.constant(c))]
        places = {name: place for name, (place, _) in files.items()}
        structure = _structure(scene, system, connected, places, zero)
        content = {place: path.read_bytes() for place, path in sorted(files.values())}
        written = Written(path, len(system.components), len(connected))
    finally:
        system.close()
    indent(structure)
    text = b'<?xml version="1.0" encoding="UTF-8"?>\n' + tostring(structure) + b"\n"
    write_archive(path, {HEART: text, **content})
    return written


def _resources(system: System) -> dict[str, tuple[str, Path]]:
    """By component: the FMU's place in the package, and its path. Equal FMUs are packed once."""
    places: dict[bytes, str] = {}
    files: dict[str, tuple[str, Path]] = {}
    for name, component in system.components.items():
        assert isinstance(component, ArchivedFmu)
        content = component.path.read_bytes()
        if content not in places:
            stem = component.path.stem
            same = [p for p in places.values() if p.startswith(f"{RESOURCES}/{stem}")]
            places[content] = f"{RESOURCES}/{stem}{f'_{len(same) + 1}' if same else ''}.fmu"
        files[name] = places[content], component.path
    return files


# -- SystemStructure.ssd -----------------------------------------------------------------------------------


def _structure(
    scene: Scene, system: System, connected: list[Connection], sources: Mapping[str, str], zero: float
) -> Element:
    used = [prefix for prefix in NAMESPACES if prefix != "ssm"]
    root = Element(
        "ssd:SystemStructureDescription",
        {f"xmlns:{prefix}": NAMESPACES[prefix] for prefix in used}
        | {"version": "1.0", "name": scene.name, "generationTool": f"touchdown-cosim {VERSION}"},
    )
    whole = SubElement(root, "ssd:System", {"name": scene.name, "description": scene.title})
    elements = SubElement(whole, "ssd:Elements")
    units = _units(system)
    for name, source in sources.items():
        element = _component(elements, system, connected, name, source, units)
        if system.every[name] > 1:
            _step_hint(element, system.every[name] * scene.run.macro_step)
    connections = SubElement(whole, "ssd:Connections")
    for c in connected:
        element = SubElement(
            connections,
            "ssd:Connection",
            {
                "startElement": c.source,
                "startConnector": system.components[c.source].own_name(c.output),
                "endElement": c.target,
                "endConnector": system.components[c.target].own_name(c.input),
                **({"suppressUnitConversion": "true"} if c.scale else {}),
            },
        )
        if c.scale:
            details = {"factor": repr(c.scale[0]), "offset": repr(c.scale[1])}
            SubElement(element, "ssc:LinearTransformation", details)
    _unit_definitions(root, units)
    _experiment(root, scene, zero)
    return root


def _component(
    elements: Element,
    system: System,
    connected: list[Connection],
    name: str,
    source: str,
    units: Mapping[str, Unit],
) -> Element:
    """A component with the variables that are connected or set, and their values."""
    component = system.components[name]
    element = SubElement(
        elements,
        "ssd:Component",
        {
            "name": name,
            "source": source,
            "type": "application/x-fmu-sharedlibrary",
            "implementation": "CoSimulation",
        },
    )
    given = [c.output for c in connected if c.source == name]
    taken = [c.input for c in connected if c.target == name]
    starts = [c.input for c in system.connections if c.target == name]
    settings = {variable: value for (owner, variable), value in system.settings.items() if owner == name}
    connectors = SubElement(element, "ssd:Connectors")
    for variable in dict.fromkeys([*taken, *given, *settings]):
        _connector(connectors, component, variable, units)
    values = {**settings, **dict(zip(starts, component.read(starts), strict=True))}
    if values:
        _parameters(element, component, values, units)
    return element


def _parameters(
    element: Element, component: Component, values: Mapping[str, float], units: Mapping[str, Unit]
) -> None:
    """A binding of the element with a set of `values` (SI) by variable."""
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
        number = repr(float(value)) if kind is Kind.REAL else str(int(value))
        SubElement(parameter, f"ssv:{kind}", {"value": number, **details})


def _step_hint(element: Element, step: float) -> None:
    """The macro step (s) of a component that takes several of the system's in one."""
    annotations = SubElement(element, "ssd:Annotations")
    annotation = SubElement(annotations, "ssc:Annotation", {"type": STEP_ANNOTATION})
    SubElement(annotation, "osp:StepSizeHint", {"value": repr(step)})


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


def _type(component: Component, name: str, units: Mapping[str, Unit]) -> tuple[Kind, dict[str, str]]:
    """A variable's type, and its unit where it is one of `units`."""
    variable = component.variable(name)
    unit = variable.unit or ""
    known = variable.kind is Kind.REAL and unit in units and component.units.get(unit) == units[unit]
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


def _experiment(root: Element, scene: Scene, zero: float) -> None:
    """Start, stop and macro step for every tool, and what only a scene knows."""
    run = scene.run
    experiment = SubElement(
        root, "ssd:DefaultExperiment", {"startTime": "0.0", "stopTime": repr(zero + run.duration)}
    )
    annotations = SubElement(experiment, "ssd:Annotations")
    annotation = SubElement(annotations, "ssc:Annotation", {"type": STEP_ANNOTATION})
    algorithm = SubElement(annotation, "osp:Algorithm")
    SubElement(algorithm, "osp:FixedStepAlgorithm", {"baseStepSize": repr(run.macro_step)})
    details = {
        "about": scene.about.strip(),
        "zero": scene.zero or "",
        "energy_scale": " ".join(scene.energy_scale),
        "scheme": run.scheme.name,
        "tolerance": repr(run.tolerance),
        "record_every": str(run.record_every),
        "record": ",".join(run.record),
        "record_also": ",".join(run.record_also),
        "record_arrays": str(run.record_arrays).lower(),
        "warn_residual": repr(run.warn_residual),
        "stop_residual": repr(run.stop_residual),
        "whirl_halvings": str(run.whirl_halvings),
    }
    annotation = SubElement(
        SubElement(root, "ssd:Annotations"), "ssc:Annotation", {"type": SCENE_ANNOTATION}
    )
    note = SubElement(
        annotation, "touchdown:Scene", {key: value for key, value in details.items() if value}
    )
    for name, spec in scene.components.items():
        for here, own in spec.names.items():
            SubElement(note, "touchdown:Name", {"component": name, "name": here, "own": own})
