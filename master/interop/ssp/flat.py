"""Systems inside systems, as one: components with joined names, and every value's way from end to end.

Connectors of systems are places that values pass. What a value meets on its way is kept, hop by hop, since
each connector may have a unit of its own, and each connection a transformation.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from touchdown.master.common.errors import TouchdownError, one_of
from touchdown.master.common.units import Scale
from touchdown.master.interop.ssp.bindings import Value
from touchdown.master.interop.ssp.structure import Node, Part

Path = tuple[str, ...]  # names of elements, from the root system on
Place = tuple[Path, str]  # an element, or a system, and one of its connectors
Way = tuple[Place, list["Leg"]]  # where it ends, and its parts


@dataclass(frozen=True)
class Leg:
    """A part of a value's way."""

    unit: str | None  # of the connector that it ends at; None: it states none, or it is the last one
    convert: bool
    scale: Scale | None


@dataclass(frozen=True)
class Link:
    """The way from a component's output to another one's input."""

    start: str
    output: str
    end: str
    input: str
    legs: Sequence[Leg]

    @property
    def title(self) -> str:
        """For people."""
        return f"connection {self.start}.{self.output} to {self.end}.{self.input}"


@dataclass(frozen=True)
class Bound:
    """A value, and the way to the variable that a binding gives it to."""

    component: str
    variable: str
    value: Value
    legs: Sequence[Leg]


@dataclass
class Flat:
    """All components of a system and of those inside, and what goes between them."""

    where: str  # for people
    names: dict[Path, str] = field(default_factory=dict[Path, str])
    parts: dict[str, Part] = field(default_factory=dict[str, Part])
    links: list[Link] = field(default_factory=list[Link])
    bound: list[Bound] = field(default_factory=list[Bound])  # those that are above others after them


def flattened(root: Node, where: str) -> Flat:
    """Raises TouchdownError where a binding is for nothing that is there, or there is nothing."""
    flat = Flat(where)
    for path, part in _parts(root, ()):
        flat.names[path] = _free("_".join(path).replace(".", "_").replace("/", "_"), flat.parts)
        flat.parts[flat.names[path]] = part
    if not flat.parts:
        raise TouchdownError(f"{where} has no components")
    ways = _Ways(root, flat)
    flat.links += ways.links()
    flat.bound += ways.bound(root, ())
    return flat


def _parts(node: Node, path: Path) -> Iterator[tuple[Path, Part]]:
    for name, part in node.parts.items():
        yield (*path, name), part
    for name, inner in node.inner.items():
        yield from _parts(inner, (*path, name))


def _free(name: str, taken: Mapping[str, object]) -> str:
    count = 2
    free = name
    while free in taken:
        free, count = f"{name}_{count}", count + 1
    return free


class _Ways:
    """Where values go from every place."""

    def __init__(self, root: Node, flat: Flat) -> None:
        self._flat = flat
        self._hops: list[tuple[Place, Place, Leg]] = []
        self._note(root, ())
        self._onward: dict[Place, list[tuple[Place, Leg]]] = {}
        for start, end, leg in self._hops:
            self._onward.setdefault(start, []).append((end, leg))

    def _note(self, node: Node, path: Path) -> None:
        for hop in node.hops:
            start, end = (
                (path if element is None else (*path, element), connector)
                for element, connector in (hop.start, hop.end)
            )
            element, connector = hop.end
            system = node if element is None else node.inner.get(element)
            unit = None
            if system is not None and connector in system.connectors:
                unit = system.connectors[connector].unit
            self._hops.append((start, end, Leg(unit, hop.convert, hop.scale)))
        for name, inner in node.inner.items():
            self._note(inner, (*path, name))

    def _ends(self, place: Place, seen: frozenset[Place] = frozenset()) -> Iterator[Way]:
        """Variables of components that a value at `place` comes to, with its way there."""
        for after, leg in self._onward.get(place, ()):
            if after[0] in self._flat.names:
                yield after, [leg]
            elif after not in seen:
                yield from ((end, [leg, *legs]) for end, legs in self._ends(after, seen | {after}))

    def links(self) -> Iterator[Link]:
        """All ways from component to component, in the order in which they begin in the file."""
        names = self._flat.names
        for (path, output), after, leg in self._hops:
            if path not in names:
                continue
            ends = [(after, [])] if after[0] in names else self._ends(after, frozenset({after}))
            for (end, taken), legs in ends:
                yield Link(names[path], output, names[end], taken, [leg, *legs])

    def bound(self, node: Node, path: Path) -> Iterator[Bound]:
        """What the bindings in `node` give, of systems inside and components first."""
        for name, part in node.parts.items():
            owner = self._flat.names[*path, name]
            for value in part.values:
                yield Bound(owner, value.name, value, [Leg(None, value.convert, value.scale)])
        for name, inner in node.inner.items():
            yield from self.bound(inner, (*path, name))
        for value in node.values:
            yield from self._given(node, path, value.name, value)

    def _given(self, node: Node, path: Path, name: str, value: Value) -> Iterator[Bound]:
        """A value for what `node`, at `path`, calls `name`: a connector of its own, or ELEMENT.VARIABLE."""
        declared = node.connectors.get(name)
        ends = list(self._ends((path, name)))
        for (end, variable), legs in ends:
            first = Leg(declared.unit if declared else None, value.convert, value.scale)
            yield Bound(self._flat.names[end], variable, value, [first, *legs])
        if declared is not None or ends:
            return
        own = next((e for e in (*node.parts, *node.inner) if name.startswith(f"{e}.")), None)
        if own is None:
            raise TouchdownError(
                f"{self._flat.where}: a binding of {'.'.join(path) or 'the system'} sets {value.name}, "
                "which is neither COMPONENT.VARIABLE nor a connector; "
                f"{one_of(name.partition('.')[0], [*node.parts, *node.inner])}"
            )
        variable = name.removeprefix(f"{own}.")
        if own in node.parts:
            owner = self._flat.names[*path, own]
            yield Bound(owner, variable, value, [Leg(None, value.convert, value.scale)])
        else:
            yield from self._given(node.inner[own], (*path, own), variable, value)
