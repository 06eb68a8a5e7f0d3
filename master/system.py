"""A system: components loaded, parameters set, connections checked and laid out for stepping."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field

import numpy as np

from fmus.presets import preset
from master.component import Component, Variable, check_value
from master.errors import TouchdownError, one_of
from master.scene import Scene
from master.schemes import Scheme
from master.units import to_si

MOTION = (
    "x", "y", "vx", "vy", "ax_free", "ay_free", "inv_m",
    "omega", "alpha_free", "inv_I", "k_over_m", "c_over_m",
)  # fmt: skip
LOAD = ("fx", "fy", "mz")
SLOPE = ("dfx", "dfy", "dmz")
NEEDED = {"motion": ("x", "y"), "load": ("fx", "fy")}


@dataclass(frozen=True)
class Connection:
    """One variable feeding another."""

    source: str  # component
    output: str
    target: str  # component
    input: str


@dataclass(frozen=True)
class Attachment:
    """A bearing's port on a body's port: motion one way, load the other."""

    bearing: str
    bearing_port: str
    body: str
    body_port: str

    @property
    def title(self) -> str:
        """For people."""
        return f"{self.bearing}.{self.bearing_port} on {self.body}.{self.body_port}"


@dataclass
class Wiring:
    """Positions in the system's signal vector, per component."""

    take: np.ndarray  # where each of the inputs comes from
    outputs: list[str]  # names of the component's stretch


@dataclass
class System:
    """Components ready to be stepped; `signals` holds every exchanged output."""

    components: dict[str, Component]
    attachments: list[Attachment]
    connections: list[Connection]
    order: list[str]
    signals: np.ndarray
    wiring: dict[str, Wiring]
    position: dict[tuple[str, str], int]
    settings: dict[tuple[str, str], float] = field(default_factory=dict)

    def close(self) -> None:
        """Free every component."""
        for component in self.components.values():
            component.close()

    def value(self, name: str) -> float:
        """Value of COMPONENT.VARIABLE."""
        component, variable = split(name, self.components)
        return component.read([variable.name])[0]

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
        for name in bodies_first:
            self.feed(name)
            self.components[name].exit()
            self.components[name].pull()

    def feed(self, name: str) -> None:
        """Hand a component its inputs from the signals."""
        component = self.components[name]
        component.inputs[:] = self.signals[self.wiring[name].take]
        component.push()

    def _feed_constants(self) -> None:
        for c in self.connections:
            source = self.components[c.source]
            if source.variable(c.output).constant:
                self.components[c.target].set({c.input: source.read([c.output])[0]})


def split(name: str, components: dict[str, Component]) -> tuple[Component, Variable]:
    """Component and variable of COMPONENT.VARIABLE."""
    head, _, tail = name.partition(".")
    if head not in components:
        raise TouchdownError(f"{name}: there is no component {head}; {one_of(head, components)}")
    return components[head], components[head].variable(tail)


def housing_port(system: System, a: Attachment) -> str | None:
    """COMPONENT.PORT that the bearing's outer ring moves with; None where it stands in the ground."""
    for c in system.connections:
        if (c.target, c.input) == (a.bearing, "housing.x"):
            return f"{c.source}.{c.output.rpartition('.')[0]}"
    return None


def assemble(scene: Scene, scheme: Scheme, load: Callable[[str, str], Component]) -> System:
    """Load a scene's components with load(name, fmu), and wire them up."""
    components: dict[str, Component] = {}
    try:
        for name, spec in scene.components.items():
            components[name] = load(name, spec.fmu)
        settings = _apply_settings(scene, scheme, components)
        attachments = [_attachment(pair, components) for pair in scene.attach]
        connections = [c for a in attachments for c in _port_connections(a, components, scheme.slopes)] + [
            _connection(pair, components) for pair in scene.connect
        ]
        _check_connections(connections, components)
        for c in connections:
            if c.input in scene.components[c.target].set:
                raise TouchdownError(
                    f"{c.target}.{c.input} cannot be set: it is connected to {c.source}.{c.output}"
                )
        return _wire(components, attachments, connections, settings)
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
        if "interface.order" in component.variables:
            values.setdefault("interface.order", scheme.order)
        component.set(values)
        applied |= {(name, key): value for key, value in values.items()}
    return applied


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


def _attachment(pair: tuple[str, str], components: dict[str, Component]) -> Attachment:
    parts: list[str] = []
    for end in pair:
        head, _, port = end.partition(".")
        if head not in components:
            raise TouchdownError(f"attach {end}: there is no component {head}; {one_of(head, components)}")
        parts += [head, port]
    return Attachment(*parts)


def _port_connections(
    a: Attachment, components: dict[str, Component], slopes: bool
) -> Iterable[Connection]:
    """Motion from body to bearing, load from bearing to body, for the variables both sides have."""
    ends = (
        ("motion", MOTION, a.body, a.body_port, a.bearing, a.bearing_port),
        ("load", LOAD + (SLOPE if slopes else ()), a.bearing, a.bearing_port, a.body, a.body_port),
    )
    for kind, suffixes, source, source_port, target, target_port in ends:
        for suffix in suffixes:
            output, given = f"{source_port}.{suffix}", f"{target_port}.{suffix}"
            there = output in components[source].variables and given in components[target].variables
            if there:
                yield Connection(source, output, target, given)
            elif suffix in NEEDED[kind]:
                side, missing = (
                    (source, output) if output not in components[source].variables else (target, given)
                )
                raise TouchdownError(
                    f"attach {a.title}: {components[side].origin} has no variable {missing}, "
                    f"which carries the {kind}; check the port's name or the FMU"
                )


def _connection(pair: tuple[str, str], components: dict[str, Component]) -> Connection:
    (source, output), (target, given) = (split(end, components) for end in pair)
    return Connection(source.name, output.name, target.name, given.name)


def _check_connections(connections: list[Connection], components: dict[str, Component]) -> None:
    fed: dict[tuple[str, str], Connection] = {}
    for c in connections:
        output = components[c.source].variable(c.output)
        given = components[c.target].variable(c.input)
        what = f"connection {c.source}.{c.output} to {c.target}.{c.input}"
        if output.causality not in ("output", "local", "calculatedParameter"):
            raise TouchdownError(
                f"{what}: {c.source}.{c.output} has the causality {output.causality}, not output"
            )
        if given.causality != "input":
            raise TouchdownError(
                f"{what}: {c.target}.{c.input} has the causality {given.causality}, not input"
            )
        if output.kind != "Real" or given.kind != "Real":
            raise TouchdownError(f"{what}: only Real variables can be connected")
        if output.unit and given.unit and output.unit != given.unit:
            raise TouchdownError(f"{what}: the units {output.unit} and {given.unit} differ")
        first = fed.setdefault((c.target, c.input), c)
        if first is not c:
            raise TouchdownError(
                f"{c.target}.{c.input} has two sources, {first.source}.{first.output} and "
                f"{c.source}.{c.output}; remove one"
            )


def _wire(
    components: dict[str, Component],
    attachments: list[Attachment],
    connections: list[Connection],
    settings: dict[tuple[str, str], float],
) -> System:
    outputs: dict[str, list[str]] = {name: [] for name in components}

    def want(name: str, variable: str) -> None:
        if variable not in outputs[name]:
            outputs[name].append(variable)

    live = [c for c in connections if not components[c.source].variable(c.output).constant]
    for c in live:
        want(c.source, c.output)
    for a in attachments:
        for name, port in ((a.bearing, a.bearing_port), (a.body, a.body_port)):
            for suffix in ("work", "jump"):
                if f"{port}.{suffix}" in components[name].variables:
                    want(name, f"{port}.{suffix}")
    position: dict[tuple[str, str], int] = {}
    for name, chosen in outputs.items():
        for variable in chosen:
            position[name, variable] = len(position)
    signals = np.zeros(len(position))
    wiring: dict[str, Wiring] = {}
    start = 0
    for name, component in components.items():
        mine = [c for c in live if c.target == name]
        stretch = signals[start : start + len(outputs[name])]
        start += len(outputs[name])
        component.bind([c.input for c in mine], stretch, outputs[name])
        take = np.array([position[c.source, c.output] for c in mine], dtype=np.intp)
        wiring[name] = Wiring(take, outputs[name])
    bearings = [a.bearing for a in attachments]
    order = list(dict.fromkeys(bearings)) + [name for name in components if name not in bearings]
    return System(components, attachments, connections, order, signals, wiring, position, settings)
