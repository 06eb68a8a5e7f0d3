"""What is connected to what: single variables, and the ports of the contract.

A bearing's port on a body's port means motion one way and load the other, for the variables that both
have. A rotor's elastic modes cross with them where the scheme asks for it.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from itertools import count

from touchdown.master.common.errors import TouchdownError, one_of
from touchdown.master.common.units import Scale
from touchdown.master.components.component import Component, Variable
from touchdown.master.scene.scene import Wire
from touchdown.master.scene.schemes import Scheme

MOTION = (
    "x", "y", "vx", "vy", "ax_free", "ay_free", "inv_m",
    "omega", "alpha_free", "inv_I", "k_over_m", "c_over_m", "static_fx", "static_fy",
)  # fmt: skip
MODE_MOTION = ("x", "y", "vx", "vy", "ax_free", "ay_free", "inv_m", "k_over_m", "c_over_m")
MODE_LOAD = ("qx", "qy", "px", "py")
SENSED = ("x", "y", "vx", "vy")
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
    scale: Scale | None = None  # where given, the input is factor * output + offset


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


def split(name: str, components: Mapping[str, Component]) -> tuple[Component, Variable]:
    """Component and variable of COMPONENT.VARIABLE."""
    head, _, tail = name.partition(".")
    if head not in components:
        raise TouchdownError(f"{name}: there is no component {head}; {one_of(head, components)}")
    return components[head], components[head].variable(tail)


def attachment(pair: tuple[str, str], components: Mapping[str, Component]) -> Attachment:
    parts: list[str] = []
    for end in pair:
        head, _, port = end.partition(".")
        if head not in components:
            raise TouchdownError(f"attach {end}: there is no component {head}; {one_of(head, components)}")
        parts += [head, port]
    return Attachment(*parts)


def port_connections(
    a: Attachment, components: Mapping[str, Component], scheme: Scheme
) -> Iterable[Connection]:
    """Motion from body to bearing, load from bearing to body, for the variables both sides have."""
    motion = (a.body, a.body_port, a.bearing, a.bearing_port)
    load = (a.bearing, a.bearing_port, a.body, a.body_port)
    ends = (("motion", MOTION, motion), ("load", LOAD + (SLOPE if scheme.slopes else ()), load))
    for kind, suffixes, way in ends:
        for suffix in suffixes:
            found = _shared(way, suffix, components)
            if found is not None:
                yield found
            elif suffix in NEEDED[kind]:
                raise _missing(way, suffix, components, f"attach {a.title}", kind)
    if scheme.modes:
        for k in count(1):
            modes = [_shared(motion, f"mode[{k}].{suffix}", components) for suffix in MODE_MOTION]
            if None in modes:
                break
            modes += [_shared(load, f"mode[{k}].{suffix}", components) for suffix in MODE_LOAD]
            yield from (c for c in modes if c is not None)


def sensor_connections(pair: tuple[str, str], components: Mapping[str, Component]) -> Iterable[Connection]:
    """Motion from a body's port to a sensor, which gives no load."""
    a = attachment(pair, components)
    way = (a.body, a.body_port, a.bearing, a.bearing_port)
    for suffix in SENSED:
        found = _shared(way, suffix, components)
        if found is None:
            raise _missing(way, suffix, components, f"sense {a.title}", "motion")
        yield found


def _shared(
    way: tuple[str, str, str, str], suffix: str, components: Mapping[str, Component]
) -> Connection | None:
    """The connection of a variable that both ports have; way: source, its port, target, its port."""
    source, source_port, target, target_port = way
    output, given = f"{source_port}.{suffix}", f"{target_port}.{suffix}"
    there = output in components[source].variables and given in components[target].variables
    return Connection(source, output, target, given) if there else None


def _missing(
    way: tuple[str, str, str, str], suffix: str, components: Mapping[str, Component], what: str, kind: str
) -> TouchdownError:
    source, source_port, target, target_port = way
    output, given = f"{source_port}.{suffix}", f"{target_port}.{suffix}"
    lacks_output = output not in components[source].variables
    side, name = (source, output) if lacks_output else (target, given)
    return TouchdownError(
        f"{what}: {components[side].origin} has no variable {name}, which carries the {kind}; "
        "check the port's name or the FMU"
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
    (source, output), (target, given) = (split(end, components) for end in (wire.source, wire.target))
    return Connection(source.name, output.name, target.name, given.name, wire.scale)


def recognised(connections: Iterable[Connection]) -> list[Attachment]:
    """Bearings' ports on bodies' ports that the connections amount to: motion one way and load the other.

    A port is what stands before the last dot of the names; both sides call the variables the same.
    """
    ways: dict[tuple[str, str, str, str], set[str]] = {}
    for c in connections:
        output_port, _, output = c.output.rpartition(".")
        input_port, _, given = c.input.rpartition(".")
        if output == given:
            ways.setdefault((c.source, output_port, c.target, input_port), set()).add(output)
    found: list[Attachment] = []
    for way, loads in ways.items():
        bearing, bearing_port, body, body_port = way
        motions = ways.get((body, body_port, bearing, bearing_port), set())
        if loads.issuperset(NEEDED["load"]) and motions.issuperset(NEEDED["motion"]):
            found.append(Attachment(*way))
    return found


def check_connections(connections: list[Connection], components: Mapping[str, Component]) -> None:
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
        if c.scale is None and output.unit and given.unit and output.unit != given.unit:
            raise TouchdownError(
                f"{what}: the units {output.unit} and {given.unit} differ; give factor and offset"
            )
        first = fed.setdefault((c.target, c.input), c)
        if first is not c:
            raise TouchdownError(
                f"{c.target}.{c.input} has two sources, {first.source}.{first.output} and "
                f"{c.source}.{c.output}; remove one"
            )
