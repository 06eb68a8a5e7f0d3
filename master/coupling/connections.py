"""Connections of single variables, and of the ports of the contract.

A bearing's port on a body's port means motion one way and load the other, for the variables that both
have. A rotor's elastic modes cross with them where the scheme asks for it.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import count
from typing import NamedTuple, NoReturn, Protocol

from ...modelkit.variables import Causality
from ..common.errors import TouchdownError, one_of
from ..common.units import Scale
from ..components.component import (
    FORCE,
    LOAD,
    MODE_LOAD,
    MODE_MOTION,
    MOTION,
    MOUNTED,
    NEEDED,
    POSITION,
    REACH,
    SENSED,
    SETTABLE,
    SLOPE,
    SLOPE_OF_MODE,
    Component,
    FmiType,
    ScalarVariable,
)
from ..scene.scene import Wire
from ..scene.schemes import Scheme

CROSSING = {(kind, kind) for kind in SETTABLE} | {
    (FmiType.INTEGER, FmiType.ENUMERATION),
    (FmiType.ENUMERATION, FmiType.INTEGER),
    (FmiType.INTEGER, FmiType.REAL),
}  # types of which one can feed the other, and nothing is lost
GIVING = (Causality.OUTPUT, Causality.LOCAL, Causality.CALCULATED_PARAMETER)  # what a source may be


def full(component: str, variable: str) -> str:
    """COMPONENT.VARIABLE, as scenes and recordings name it."""
    return f"{component}.{variable}"


class _Port(NamedTuple):
    """Variables of a component that belong together: PORT.x, PORT.fx and so on."""

    component: str
    name: str

    def own(self, variable: str) -> str:
        """The component's own name of a variable of the port, such as A.x."""
        return f"{self.name}.{variable}"

    def full(self, variable: str) -> str:
        """COMPONENT.VARIABLE, such as rotor.A.x."""
        return f"{self.component}.{self.name}.{variable}"

    @property
    def title(self) -> str:
        """For people."""
        return f"{self.component}.{self.name}"


@dataclass(frozen=True)
class Connection:
    """One variable feeding another."""

    source: str  # component
    output: str
    target: str  # component
    input: str
    scale: Scale | None = None  # where given, the input is factor * output + offset

    @property
    def source_name(self) -> str:
        """COMPONENT.VARIABLE that feeds."""
        return full(self.source, self.output)

    @property
    def target_name(self) -> str:
        """COMPONENT.VARIABLE that is fed."""
        return full(self.target, self.input)


@dataclass(frozen=True)
class Attachment:
    """A bearing's port on a body's port: motion one way, load the other."""

    bearing: str
    bearing_port: str
    body: str
    body_port: str

    @property
    def bearing_end(self) -> _Port:
        """The bearing's port."""
        return _Port(self.bearing, self.bearing_port)

    @property
    def body_end(self) -> _Port:
        """The body's port."""
        return _Port(self.body, self.body_port)

    def motion(self, variable: str) -> str:
        """COMPONENT.VARIABLE of what the body gives, such as rotor.A.x."""
        return self.body_end.full(variable)

    def load(self, variable: str) -> str:
        """COMPONENT.VARIABLE of what the bearing gives, such as bearing.journal.fx."""
        return self.bearing_end.full(variable)

    @property
    def on_journal(self) -> bool:
        """Whether it is a journal that the bearing holds here, not what it is mounted in."""
        return self.bearing_port != MOUNTED

    @property
    def reach(self) -> str:
        """COMPONENT.VARIABLE of the time until the journal touches, where the bearing states it."""
        return full(self.bearing, REACH)

    @property
    def title(self) -> str:
        """For people."""
        return f"{self.bearing_end.title} on {self.body_end.title}"


class _Connected(Protocol):
    """A system, or what is known of one that has ended."""

    @property
    def connections(self) -> Sequence[Connection]:
        """The connections: which output feeds which input."""
        ...


def housing_port(system: _Connected, bearing: str) -> str | None:
    """COMPONENT.PORT that a bearing's outer ring moves with; None where it stands on the ground."""
    for c in system.connections:
        if c.target_name == full(bearing, f"{MOUNTED}.x"):
            return c.source_name.rpartition(".")[0]
    return None


def split_name(name: str, components: Mapping[str, Component]) -> tuple[Component, ScalarVariable]:
    """Component and variable of COMPONENT.VARIABLE."""
    head, _, tail = name.partition(".")
    if head not in components:
        raise TouchdownError(f"{name}: there is no component {head}; {one_of(head, components)}")
    return components[head], components[head].variable(tail)


def attachment(pair: tuple[str, str], components: Mapping[str, Component]) -> Attachment:
    """The attachment of a pair of COMPONENT.PORT, the bearing's first. Raises TouchdownError for others."""
    parts: list[str] = []
    for end in pair:
        head, _, port = end.partition(".")
        if head not in components:
            raise TouchdownError(f"attach {end}: there is no component {head}; {one_of(head, components)}")
        parts += [head, port]
    return Attachment(*parts)


@dataclass(frozen=True)
class _PortConnections:
    """From a port to another: a variable that both have can cross."""

    source: _Port
    target: _Port
    components: Mapping[str, Component]

    def connection(self, variable: str) -> Connection | None:
        """Of a variable, where both ports have it."""
        if self._lacking(variable) is not None:
            return None
        return Connection(
            self.source.component,
            self.source.own(variable),
            self.target.component,
            self.target.own(variable),
        )

    def needed(self, variable: str, what: str) -> Connection:
        """Of a variable that both must have; raises TouchdownError, about `what`, where one has not."""
        crossing = self.connection(variable)
        if crossing is not None:
            return crossing
        lacking = self._lacking(variable) or self.target
        kind = "motion" if variable in MOTION else "load"
        raise TouchdownError(
            f"{what}: {self.components[lacking.component].origin} has no variable {lacking.own(variable)}, "
            f"which carries the {kind}; check the port's name or the FMU (ports it has: "
            f"{', '.join(_ports(self.components[lacking.component])) or 'none'})"
        )

    def _lacking(self, variable: str) -> _Port | None:
        """The port that does not have a variable; the output's comes first."""
        for port in (self.source, self.target):
            if port.own(variable) not in self.components[port.component].variables:
                return port
        return None


def _ports(component: Component) -> list[str]:
    """Names before the last dot under which a component has a position."""
    known = {n for n, v in component.variables.items() if v.causality is not Causality.PARAMETER}
    names = {name.rpartition(".")[0] for name in known if "[" not in name}
    return sorted(port for port in names if all(f"{port}.{axis}" in known for axis in POSITION))


def port_connections(
    a: Attachment, components: Mapping[str, Component], scheme: Scheme
) -> Iterable[Connection]:
    """Motion from body to bearing, load from bearing to body, for the variables both sides have."""
    motion = _PortConnections(a.body_end, a.bearing_end, components)
    load = _PortConnections(a.bearing_end, a.body_end, components)
    for way, variables in ((motion, MOTION), (load, LOAD + SLOPE if scheme.slopes else LOAD)):
        for variable in variables:
            if variable in NEEDED:
                yield way.needed(variable, f"attach {a.title}")
            elif (crossing := way.connection(variable)) is not None:
                yield crossing
    if scheme.modes:
        yield from _mode_connections(motion, load)


def _mode_connections(motion: _PortConnections, load: _PortConnections) -> Iterable[Connection]:
    """The connections of all elastic modes that both sides have; their slopes where both have them."""
    for k in count(1):
        found = [motion.connection(f"mode[{k}].{variable}") for variable in MODE_MOTION]
        if any(c is None for c, v in zip(found, MODE_MOTION, strict=True) if v != SLOPE_OF_MODE):
            return
        found += [load.connection(f"mode[{k}].{variable}") for variable in MODE_LOAD]
        yield from (c for c in found if c is not None)


def hit_together(
    attachments: Iterable[Attachment], components: Mapping[str, Component]
) -> tuple[Attachment, ...]:
    """The attachments of bodies that two bearings or more can hit, and that state the time to a hit."""
    telling = [a for a in attachments if REACH in components[a.bearing].variables and a.on_journal]
    bodies = [a.body for a in telling]
    return tuple(a for a in telling if bodies.count(a.body) > 1)


def sensor_connections(pair: tuple[str, str], components: Mapping[str, Component]) -> Iterable[Connection]:
    """Motion from a body's port to a sensor, which gives no load."""
    a = attachment(pair, components)
    way = _PortConnections(a.body_end, a.bearing_end, components)
    for variable in SENSED:
        yield way.needed(variable, f"sense {a.title}")


SENSED_AXIS, SET_AXIS = r"axis\[\d+\]\.sensed", r"axis\[\d+\]\.(set|force_set)"
AXIS = "axis[{}].{}"  # a variable of an axis, counted from 1
TOLD = ("sensed", "hold")  # of an axis, to the controller
TOLD_OF_ALL = ("tick", "period")  # to the controller: samples, and the time between them
FACTOR, SPEED, TURNS = "current_factor", "speed", "journal.omega"  # N/A, rad/s; what an actuator is told
SET_POINTS = {"set": "A", "force_set": "N"}  # of an axis, in the order of an actuator's `command`; units
ASKED = (*SET_POINTS, "enable")  # of an axis, by the controller
COMMAND = "command"  # of an actuator: which of its set points acts


def control_connections(
    pairs: Iterable[tuple[str, str]], components: Mapping[str, Component]
) -> Iterator[Connection]:
    """Connections between controllers and the actuators that they control.

    The first actuator of a controller has its first axes, the next one those that follow. Raises
    TouchdownError where a component is missing, or has no position or no set point of an axis.
    """
    used: dict[str, int] = {}
    for controller, actuator in pairs:
        for name in (controller, actuator):
            if name not in components:
                raise TouchdownError(f"control: there is no component {name}; {one_of(name, components)}")
        loop = _Loop(components[controller], components[actuator], used.get(controller, 0))
        yield from loop.connections()
        used[controller] = loop.first + loop.axes


def speed_connections(
    pairs: Iterable[tuple[str, str]], connections: Sequence[Connection], components: Mapping[str, Component]
) -> Iterator[Connection]:
    """The rotor's speed, as its first actuator is told of it, to each controller that lacks it."""
    fed = {c.target_name for c in connections}
    for controller, actuator in {pair[0]: pair for pair in reversed([*pairs])}.values():
        if SPEED in components[controller].variables and full(controller, SPEED) not in fed:
            for c in connections:
                if (c.target, c.input) == (actuator, TURNS):
                    yield Connection(c.source, c.output, controller, SPEED)


def controlled(connections: Sequence[Connection]) -> list[tuple[str, str]]:
    """Controllers, each with an actuator that tells it where the rotor is and takes its set points."""
    sensed = dict.fromkeys((c.target, c.source) for c in connections if re.fullmatch(SENSED_AXIS, c.output))
    asking = {(c.source, c.target) for c in connections if re.fullmatch(SET_AXIS, c.input)}
    return [pair for pair in sensed if pair in asking]


COMMANDS = ("current", "force")  # words of an actuator's `COMMAND`, in the order of `SET_POINTS`


def check_command(connections: Sequence[Connection], actuator: str, command: float) -> None:
    """Raise TouchdownError where what acts in an actuator, by its `command`, is fed by nothing."""
    acts = list(SET_POINTS)[int(command)]
    fed = {c.input: c for c in connections if c.target == actuator and re.fullmatch(SET_AXIS, c.input)}
    for name, c in fed.items():
        axis, _, variable = name.rpartition(".")
        if f"{axis}.{acts}" not in fed:
            raise TouchdownError(
                f"{actuator}.{COMMAND} = {COMMANDS[int(command)]}, but {c.source} gives {c.output}, a "
                f"{COMMANDS[list(SET_POINTS).index(variable)]}; set {actuator}.{COMMAND} = "
                f"{COMMANDS[list(SET_POINTS).index(variable)]}"
            )


@dataclass(frozen=True)
class _Loop:
    """A controller and an actuator, whose axes are the controller's after its first ones."""

    controller: Component
    actuator: Component
    first: int

    @property
    def axes(self) -> int:
        """How many axes the actuator has."""
        return next(k for k in count() if AXIS.format(k + 1, "sensed") not in self.actuator.variables)

    def connections(self) -> Iterator[Connection]:
        """All of both, the needed ones included."""
        if not self.axes:
            self._refuse(self.actuator, AXIS.format(1, "sensed"))
        for sensor in range(1, self.axes + 1):
            axis = sensor + self.first
            if AXIS.format(axis, "sensed") not in self.controller.variables:
                self._refuse(self.controller, AXIS.format(axis, "sensed"))
            for variable in TOLD:
                yield from self._feedback(AXIS.format(sensor, variable), AXIS.format(axis, variable))
            yield from self._feedback(FACTOR, AXIS.format(axis, FACTOR))
            asked = [v for v in ASKED if AXIS.format(axis, v) in self.controller.variables]
            taken = [v for v in asked if AXIS.format(sensor, v) in self.actuator.variables]
            set_points = [v for v in asked if v in SET_POINTS]
            if not set_points:
                self._refuse(self.controller, AXIS.format(axis, "set"))
            if not set(set_points) & set(taken):
                self._refuse(self.actuator, AXIS.format(sensor, set_points[0]))
            for variable in taken:
                ends = AXIS.format(axis, variable), AXIS.format(sensor, variable)
                yield Connection(self.controller.name, ends[0], self.actuator.name, ends[1])
        if not self.first:  # a controller has one clock
            for variable in TOLD_OF_ALL:
                yield from self._feedback(variable, variable)

    def _feedback(self, output: str, into: str) -> Iterator[Connection]:
        """The feedback of the actuator, where both have it."""
        if output in self.actuator.variables and into in self.controller.variables:
            yield Connection(self.actuator.name, output, self.controller.name, into)

    def _refuse(self, lacking: Component, variable: str) -> NoReturn:
        raise TouchdownError(
            f"control {self.controller.name}, {self.actuator.name}: {lacking.origin} has no variable "
            f"{variable}; name what it calls it in names of [components.{lacking.name}]"
        )


def used_modes(connections: Iterable[Connection], components: Mapping[str, Component]) -> list[Connection]:
    """`connections` without those of modes that the body does not have (inv_m = 0), once it is started."""
    kept = list(connections)
    gains = [c for c in kept if c.input.endswith("].inv_m")]
    absent: set[tuple[str, str]] = set()
    for source in dict.fromkeys(c.source for c in gains):
        theirs = [c for c in gains if c.source == source]
        for c, gain in zip(theirs, components[source].read([c.output for c in theirs]), strict=True):
            if gain == 0.0:
                absent.add((c.source, c.output.rpartition(".")[0]))
                absent.add((c.target, c.input.rpartition(".")[0]))

    def used(component: str, variable: str) -> bool:
        return (component, variable.rpartition(".")[0]) not in absent

    return [c for c in kept if used(c.source, c.output) and used(c.target, c.input)]


def connection(wire: Wire, components: Mapping[str, Component]) -> Connection:
    """Of a single wire; raises TouchdownError where one of its ends is not there."""
    (source, output), (target, into) = (split_name(end, components) for end in (wire.source, wire.target))
    return Connection(source.name, output.name, target.name, into.name, wire.scale)


def recognised(connections: Iterable[Connection], components: Mapping[str, Component]) -> list[Attachment]:
    """Bearings' ports on bodies' ports that the connections amount to: motion one way and load the other.

    A port is what stands before the last dot of the names; both sides call the variables the same.
    """
    crossing: dict[tuple[_Port, _Port], set[str]] = {}
    for c in connections:
        output_port, _, output = c.output.rpartition(".")
        input_port, _, into = c.input.rpartition(".")
        if output == into and components[c.source].variable(c.output).kind is FmiType.REAL:
            ends = _Port(c.source, output_port), _Port(c.target, input_port)
            crossing.setdefault(ends, set()).add(output)
    return [
        Attachment(*bearing, *body)
        for (bearing, body), loads in crossing.items()
        if loads.issuperset(FORCE) and crossing.get((body, bearing), set()).issuperset(POSITION)
    ]


def check_connections(connections: Iterable[Connection], components: Mapping[str, Component]) -> None:
    """Raise TouchdownError where one cannot be: causality, type, unit, or an input with two sources."""
    fed: dict[str, Connection] = {}
    for c in connections:
        _check_connection(
            c, components[c.source].variable(c.output), components[c.target].variable(c.input)
        )
        first = fed.setdefault(c.target_name, c)
        if first is not c:
            both = f"{c.target_name} has two sources, {first.source_name} and {c.source_name}"
            remedy = "remove one"
            if c.input.rpartition(".")[2] in FORCE and first.source != c.source:
                remedy += (
                    "; for two bearings side by side take one with balls.rows = 2, or a rotor with a seat "
                    "(a station of its file) for each"
                )
            raise TouchdownError(f"{both}; {remedy}")


def _check_connection(c: Connection, output: ScalarVariable, into: ScalarVariable) -> None:
    what = f"connection {c.source_name} to {c.target_name}"
    if output.causality not in GIVING:
        raise TouchdownError(f"{what}: {c.source_name} has the causality {output.causality}, not output")
    if into.causality is not Causality.INPUT:
        raise TouchdownError(f"{what}: {c.target_name} has the causality {into.causality}, not input")
    if (output.kind, into.kind) not in CROSSING:
        raise TouchdownError(
            f"{what}: {_types(output, into)}; types must be the same, and Real, Integer, Boolean or "
            "Enumeration (an Integer may feed a Real or an Enumeration, and an Enumeration an Integer)"
        )
    if output.kind is not FmiType.REAL or into.kind is not FmiType.REAL:
        if c.scale is not None:
            raise TouchdownError(
                f"{what}: only what is Real can be scaled, and {_types(output, into)}; leave factor and "
                "offset out"
            )
        return
    if c.scale is None and output.unit and into.unit and output.unit != into.unit:
        raise TouchdownError(
            f"{what}: the units {output.unit} and {into.unit} differ; give factor and offset"
        )


def require_real(connections: Iterable[Connection], components: Mapping[str, Component], what: str) -> None:
    """Raise TouchdownError where one is not of Real variables, as `what` (for people) must be."""
    for c in connections:
        output, into = components[c.source].variable(c.output), components[c.target].variable(c.input)
        if (output.kind, into.kind) != (FmiType.REAL, FmiType.REAL):
            where = f"connection {c.source_name} to {c.target_name}"
            raise TouchdownError(f"{where}: {what} is Real, and {_types(output, into)}")


def _types(output: ScalarVariable, into: ScalarVariable) -> str:
    return f"it leads from the type {output.kind} to {into.kind}"
