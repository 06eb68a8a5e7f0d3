"""SystemStructure.ssd of a package that is written."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from xml.etree.ElementTree import Element, SubElement

from touchdown.fmus.version import VERSION
from touchdown.master.common.errors import TouchdownError
from touchdown.master.common.units import Unit
from touchdown.master.components.component import WHOLE, Component, Kind
from touchdown.master.coupling.connections import Connection
from touchdown.master.coupling.loop.span import Span
from touchdown.master.coupling.system import System
from touchdown.master.interop.packing import changes, start_values
from touchdown.master.interop.ssp.annotations import write_hint, write_master, write_scene, write_steps
from touchdown.master.interop.ssp.names import NAMESPACES
from touchdown.master.scene.scene import Scene
from touchdown.master.scene.titles import amended
from touchdown.modelkit.variables import Causality

CONNECTED = (Causality.INPUT, Causality.OUTPUT, Causality.PARAMETER, Causality.CALCULATED_PARAMETER)
START_VALUES = "initialValues"  # name of every component's parameter set: tools apply sets by name


@dataclass(frozen=True)
class Content:
    """An initialised system, and what of it a package is to hold."""

    scene: Scene
    system: System
    connected: Sequence[Connection]
    sources: Mapping[str, str]  # by component: its FMU's place in the package
    times: Span

    def there(self, name: str) -> str:
        """What COMPONENT, or COMPONENT.VARIABLE, is called in the package."""
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


def structure(content: Content) -> Element:
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
        if system.every[name] > 1:
            write_hint(element, system.every[name] * scene.run.macro_step)
    _connections(whole, content)
    write_master(whole, scene.run.macro_step)
    declared = system.bonds[: len(scene.bond)]  # they come before those that units tell
    write_scene(whole, scene, declared, content.there)
    _unit_definitions(root, units)
    times = {"startTime": repr(content.times.start), "stopTime": repr(content.times.end)}
    write_steps(SubElement(root, "ssd:DefaultExperiment", times), scene.run.macro_step)
    return root


def _connections(whole: Element, content: Content) -> None:
    connections = SubElement(whole, "ssd:Connections")
    components = content.system.components
    for c in content.connected:
        ends = {
            "startElement": content.there(c.source),
            "startConnector": components[c.source].own_name(c.output),
            "endElement": content.there(c.target),
            "endConnector": components[c.target].own_name(c.input),
        }
        unconverted = {"suppressUnitConversion": "true"} if c.scale else {}
        element = SubElement(connections, "ssd:Connection", {**ends, **unconverted})
        if c.scale:
            details = {"factor": repr(c.scale[0]), "offset": repr(c.scale[1])}
            SubElement(element, "ssc:LinearTransformation", details)


def _component(elements: Element, content: Content, name: str, units: Mapping[str, Unit]) -> Element:
    """A component with the variables that are connected or set, and their values."""
    component = content.system.components[name]
    element = SubElement(
        elements,
        "ssd:Component",
        {
            "name": content.there(name),
            "source": content.sources[name],
            "type": "application/x-fmu-sharedlibrary",
            "implementation": "CoSimulation",
        },
    )
    given = [c.output for c in content.connected if c.source == name]
    taken = [c.input for c in content.connected if c.target == name]
    settings = [variable for owner, variable in content.system.settings if owner == name]
    connectors = SubElement(element, "ssd:Connectors")
    for variable in dict.fromkeys([*taken, *given, *settings]):
        _connector(connectors, component, variable, units)
    values = start_values(content.system, name)
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
    """A variable's type, and its unit where it is one of `units`.

    Enumerations are given as integers, as FMI 2.0 sets them: few tools read SSP's own.
    """
    variable = component.variable(name)
    if variable.kind in WHOLE:
        return Kind.INTEGER, {}
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
