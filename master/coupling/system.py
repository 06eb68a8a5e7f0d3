"""A system: components loaded, parameters set, connections checked and laid out for stepping."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field

import numpy as np

from touchdown.fmus.recipes import preset
from touchdown.master.common.errors import TouchdownError
from touchdown.master.common.units import scaled, to_si
from touchdown.master.components.component import Component, check_value
from touchdown.master.coupling.connections import (
    Attachment,
    Connection,
    attachment,
    check_connections,
    connection,
    port_connections,
    recognised,
    sensor_connections,
    split,
    used_modes,
)
from touchdown.master.scene.scene import Scene
from touchdown.master.scene.schemes import Scheme


@dataclass(frozen=True)
class Scaling:
    """Scales of a component's exchanged inputs."""

    factors: np.ndarray
    offsets: np.ndarray

    def cut(self, inputs: np.ndarray, number: int = 0) -> None:
        """Apply them to `inputs`, in whatever macro step."""
        inputs *= self.factors
        inputs += self.offsets


@dataclass
class System:
    """Components ready to be stepped; `signals` holds every exchanged output."""

    components: dict[str, Component]
    attachments: list[Attachment]
    connections: list[Connection]
    settings: dict[tuple[str, str], float]
    every: dict[str, int]  # macro steps of the run that each component takes in one
    order: list[str] = field(init=False)  # bearings first
    signals: np.ndarray = field(init=False)
    position: dict[tuple[str, str], int] = field(init=False)  # of an output in the signals
    take: dict[str, np.ndarray] = field(init=False)  # where each input of a component comes from
    scales: dict[str, list[Scaling]] = field(init=False)  # of its inputs, where a component has any
    retired: set[str] = field(init=False, default_factory=set)

    def __post_init__(self) -> None:
        bearings = dict.fromkeys(a.bearing for a in self.attachments)
        self.order = [*bearings, *(name for name in self.components if name not in bearings)]
        self._lay_out()

    def close(self) -> None:
        """Free every component."""
        for component in self.components.values():
            component.close()

    def value(self, name: str) -> float:
        """Value of COMPONENT.VARIABLE."""
        component, variable = split(name, self.components)
        return component.read([variable.name])[0]

    def constant(self, c: Connection) -> bool:
        """Whether what crosses is settled once its source is initialised."""
        return self.components[c.source].variable(c.output).constant

    def initialise(self) -> None:
        """Bring all components through initialisation, exchanging until every input has its value."""
        for component in self.components.values():
            component.enter(0.0)
        bodies_first = list(reversed(self.order))
        for _ in range(2):  # bodies to bearings, and loads back
            for name in bodies_first:
                self.feed(name)
                self.components[name].pull()
        self._feed_constants()
        self.connections = used_modes(self.connections, self.components)
        self._lay_out()
        for name in bodies_first:
            self.components[name].pull()
        for name in bodies_first:
            self.feed(name)
            self.components[name].exit()
            self.components[name].pull()

    def feed(self, name: str) -> None:
        """Hand a component its inputs from the signals."""
        self.take_inputs(name)
        self.components[name].push()

    def take_inputs(self, name: str) -> None:
        """Fill a component's inputs from the signals, not yet handing them over."""
        self.components[name].inputs[:] = self.inputs_from(name, self.signals)

    def inputs_from(self, name: str, signals: np.ndarray) -> np.ndarray:
        """A component's exchanged inputs, in its own units, where `signals` are what all have given."""
        inputs = signals[self.take[name]]
        for scaling in self.scales.get(name, ()):
            scaling.cut(inputs)
        return inputs

    def inputs_of(self, name: str) -> dict[str, int]:
        """Where each exchanged input of a component stands in its `inputs`."""
        return {c.input: i for i, c in enumerate(c for c in self._live() if c.target == name)}

    def retire(self, names: Iterable[str]) -> None:
        """Stop exchanging with components that have nothing left to do; what they gave last stays."""
        for name in self.order:  # the last of what the retired gave, where it has not been taken yet
            self.feed(name)
        self.retired |= set(names)
        self.order = [name for name in self.order if name not in self.retired]
        self._lay_out()
        for name in self.order:
            self.components[name].pull()

    def _feed_constants(self) -> None:
        constant = [c for c in self.connections if self.constant(c)]
        for target in dict.fromkeys(c.target for c in constant):
            mine = [c for c in constant if c.target == target]
            values: dict[str, float] = {}
            for source in dict.fromkeys(c.source for c in mine):
                theirs = [c for c in mine if c.source == source]
                found = self.components[source].read([c.output for c in theirs])
                values |= {c.input: scaled(value, c.scale) for c, value in zip(theirs, found, strict=True)}
            self.components[target].set(values)

    def _live(self) -> list[Connection]:
        """Connections that carry something at every step."""
        return [
            c for c in self.connections if not self.constant(c) and not self.retired & {c.source, c.target}
        ]

    def _lay_out(self) -> None:
        """Give every exchanged output its place in the signals, and bind the components to them."""
        live = self._live()
        outputs: dict[str, dict[str, None]] = {name: {} for name in self.components}
        for c in live:
            outputs[c.source][c.output] = None
        for a in (a for a in self.attachments if not self.retired & {a.bearing, a.body}):
            for name, port in ((a.bearing, a.bearing_port), (a.body, a.body_port)):
                for account in (f"{port}.work", f"{port}.jump"):
                    if account in self.components[name].variables:
                        outputs[name][account] = None
        places = [(name, variable) for name, chosen in outputs.items() for variable in chosen]
        self.position = {place: i for i, place in enumerate(places)}
        self.signals = np.zeros(len(places))
        self.take, self.scales = {}, {}
        start = 0
        for name, component in self.components.items():
            mine = [c for c in live if c.target == name]
            stretch = self.signals[start : start + len(outputs[name])]
            start += len(outputs[name])
            component.bind([c.input for c in mine], stretch, list(outputs[name]))
            self.take[name] = np.array([self.position[c.source, c.output] for c in mine], dtype=np.intp)
            if any(c.scale for c in mine):
                self.scales[name] = [Scaling(*np.array([c.scale or (1.0, 0.0) for c in mine]).T)]


def assemble(scene: Scene, scheme: Scheme, load: Callable[[str, str], Component]) -> System:
    """Load a scene's components with load(name, fmu), and wire them up."""
    components: dict[str, Component] = {}
    try:
        for name, spec in scene.components.items():
            components[name] = load(name, spec.fmu)
            components[name].rename(spec.names)
        settings = _apply_settings(scene, scheme, components)
        attached = [attachment(pair, components) for pair in scene.attach]
        connections = [c for a in attached for c in port_connections(a, components, scheme)]
        connections += [c for pair in scene.sense for c in sensor_connections(pair, components)]
        connections += [connection(wire, components) for wire in scene.connect]
        check_connections(connections, components)
        for c in connections:
            if c.input in scene.components[c.target].set:
                raise TouchdownError(
                    f"{c.target}.{c.input} cannot be set: it is connected to {c.source}.{c.output}"
                )
        every = {name: spec.every for name, spec in scene.components.items()}
        found = recognised(connections)
        if scheme.lead:
            _require_lead(found, components)
        return System(components, found, connections, settings, every)
    except BaseException:
        for component in components.values():
            component.close()
        raise


def _apply_settings(
    scene: Scene, scheme: Scheme, components: dict[str, Component]
) -> dict[tuple[str, str], float]:
    applied: dict[tuple[str, str], float] = {}
    for name, component in components.items():
        spec = scene.components[name]
        optional: dict[str, object] = {**(preset(spec.preset) if spec.preset else {}), **spec.inherited}
        given = {key: value for key, value in optional.items() if key in component.variables}
        values = {key: _checked(component, key, value) for key, value in {**given, **spec.set}.items()}
        for key, value in (("interface.order", scheme.order), ("interface.lead", int(scheme.lead))):
            if key in spec.set:
                raise TouchdownError(f"{name}.{key} follows from the scheme; set run.scheme instead")
            if key in component.variables:
                values[key] = value
        component.set(values)
        applied |= {(name, key): value for key, value in values.items()}
    return applied


def _require_lead(attachments: Iterable[Attachment], components: dict[str, Component]) -> None:
    for a in attachments:
        bearing = components[a.bearing]
        if "interface.lead" not in bearing.variables:
            raise TouchdownError(
                f"{a.bearing} ({bearing.origin}) cannot lead: it has no parameter interface.lead; choose a "
                "scheme that steps bearings first"
            )


def _checked(component: Component, name: str, given: object) -> float:
    """A setting's value in SI, if the component can take it."""
    variable = component.variable(name)
    if not variable.settable:
        raise TouchdownError(
            f"{component.name}.{name} has the causality {variable.causality} and cannot be set"
        )
    value = to_si(given, variable.unit, f"{component.name}.{name}")
    check_value(component, variable, value)
    return value
