"""Reads an SSP package as a scene: components with their bindings applied, and single connections.

Systems inside systems become one (`flattened`), with joined names of components. Connectors of systems only
pass values on. Every value is followed from end to end, hop by hop, since each connector may have a unit of
its own, and each connection a transformation.

Which connections make ports is found out where the system is assembled, from the names of the contract,
so that packages of other tools have an energy ledger and bearings that step first.
"""

from __future__ import annotations

import math
import re
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from ....modelkit.kernel.cache_folder import user_cache
from ...common.errors import TouchdownError, one_of
from ...common.text import joined
from ...common.units import Scale, Unit, scaled, then
from ...components.component import FmiType, ScalarVariable, Setting, elements
from ...components.description import interface
from ...components.unpack import Format, unpack
from ...coupling.loop.span import time_zero
from ...coupling.recording_file import END, TIME
from ...coupling.simulation import MAX_MACRO_STEPS
from ...scene.scene import BondSpec, ComponentSpec, Scene, Wire
from . import structure
from .structure import ComponentElement, Structure, SystemElement, Value
from .xml import SSD_FILE

ElementPath = tuple[str, ...]  # names of elements, from the root system on
Place = tuple[ElementPath, str]  # an element, or a system, and one of its connectors
Way = tuple[Place, tuple["_Leg", ...]]  # its end and its parts
MAX_LEGS = 100  # parts of a way; the systems in each other that a value passes are few
MAX_COMPONENTS = 1000


@dataclass(frozen=True)
class _Leg:
    """A part of a value's way through the package."""

    unit: str | None  # of the connector that it ends at; None: it states none, or it is the last one
    convert: bool
    scale: Scale | None


@dataclass(frozen=True)
class _Link:
    """The way from a component's output to another one's input."""

    start: str
    output: str
    end: str
    input: str
    legs: Sequence[_Leg]

    @property
    def title(self) -> str:
        """For people."""
        return f"connection {self.start}.{self.output} to {self.end}.{self.input}"


@dataclass(frozen=True)
class _Bound:
    """A value, and the way to the variable that a binding gives it to."""

    component: str
    variable: str
    value: Value
    legs: Sequence[_Leg]
    given: str  # its name in the binding, with the names of the systems in front


@dataclass
class _Flat:
    """All components of a system and of those inside, and what goes between them."""

    where: str  # for people
    names: dict[ElementPath, str] = field(default_factory=dict[ElementPath, str])
    parts: dict[str, ComponentElement] = field(default_factory=dict[str, ComponentElement])
    links: list[_Link] = field(default_factory=list[_Link])
    bound: list[_Bound] = field(default_factory=list[_Bound])  # later ones override earlier ones
    surplus: dict[str, None] = field(default_factory=dict[str, None])  # values for missing elements


RESERVED = ("run", END, TIME)  # what settings and recordings have beside components


def _flattened(root: SystemElement, where: str) -> _Flat:
    """All components and connections of a system.

    Raises TouchdownError where there are no components.
    """
    flat, taken = _Flat(where), {*RESERVED}
    for path, part in _parts(root, ()):
        name = re.sub(r"^[ -]|[^\w -]", "_", "_".join(path))
        flat.names[path] = _free(name, taken)
        taken.add(flat.names[path])
        flat.parts[flat.names[path]] = part
        if len(flat.parts) > MAX_COMPONENTS:
            raise TouchdownError(f"{where} has more than {MAX_COMPONENTS} components; refused")
    if not flat.parts:
        raise TouchdownError(f"{where} has no components")
    ways = _Ways(root, flat)
    flat.links += ways.links()
    flat.bound += sorted(ways.bound(root, ()), key=lambda one: len(one.legs))  # along connections last
    return flat


def _parts(node: SystemElement, path: ElementPath) -> Iterator[tuple[ElementPath, ComponentElement]]:
    for name, part in node.parts.items():
        yield (*path, name), part
    for name, inner in node.inner.items():
        yield from _parts(inner, (*path, name))


def _free(name: str, taken: Collection[str]) -> str:
    count = 2
    free = name
    while free in taken:
        free, count = f"{name}_{count}", count + 1
    return free


class _Ways:
    """Where values go from every place."""

    def __init__(self, root: SystemElement, flat: _Flat) -> None:
        self._flat = flat
        self._hops: list[tuple[Place, Place, _Leg]] = []
        self._note(root, ())
        self._onward: dict[Place, list[tuple[Place, _Leg]]] = {}
        for start, end, leg in self._hops:
            self._onward.setdefault(start, []).append((end, leg))

    def _note(self, node: SystemElement, path: ElementPath) -> None:
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
            self._hops.append((start, end, _Leg(unit, hop.convert, hop.scale)))
        for name, inner in node.inner.items():
            self._note(inner, (*path, name))

    def _ends(self, way: Way, met: set[Place]) -> Iterator[Way]:
        """Variables of components that a value comes to on `way`, to its end and on, with the ways there.

        met: connectors of systems that it has come to; a value comes to each once. Raises TouchdownError.
        """
        ahead = [way]
        while ahead:
            place, legs = ahead.pop()
            if place[0] in self._flat.names:
                yield place, legs
                continue
            if place in met or len(legs) > MAX_LEGS:
                raise TouchdownError(
                    f"{self._flat.where}: a value comes to {'.'.join((*place[0], place[1]))} "
                    + ("by two ways" if place in met else f"over more than {MAX_LEGS} connections")
                    + "; connect its ends directly"
                )
            met.add(place)
            ahead += [(after, (*legs, leg)) for after, leg in reversed(self._onward.get(place, ()))]

    def links(self) -> Iterator[_Link]:
        """All ways from component to component, in the order in which they begin in the file."""
        names, met = self._flat.names, set[Place]()
        for (path, output), after, leg in self._hops:
            if path in names:
                for (end, taken), legs in self._ends((after, (leg,)), met):
                    yield _Link(names[path], output, names[end], taken, legs)

    def bound(self, node: SystemElement, path: ElementPath) -> Iterator[_Bound]:
        """The values that the bindings in `node` give, of systems inside and components first."""
        for name, part in node.parts.items():
            owner = self._flat.names[*path, name]
            for value in part.values:
                full_name = ".".join((*path, name, value.name))
                yield _Bound(owner, value.name, value, [_Leg(None, value.convert, value.scale)], full_name)
        for name, inner in node.inner.items():
            yield from self.bound(inner, (*path, name))
        for value in node.values:
            yield from self._bound_values(node, path, value.name, value)

    def _bound_values(
        self, node: SystemElement, path: ElementPath, name: str, value: Value
    ) -> Iterator[_Bound]:
        """A value for what `node`, at `path`, calls `name`: a connector, or each such ELEMENT.VARIABLE."""
        full_name = ".".join((*path, name))
        declared = node.connectors.get(name)
        ends = list(self._ends(((path, name), ()), set()))
        for (end, variable), legs in ends:
            first = _Leg(declared.unit if declared else None, value.convert, value.scale)
            yield _Bound(self._flat.names[end], variable, value, [first, *legs], full_name)
        if declared is not None or ends:
            return
        heads = (name[: dot.start()] for dot in re.finditer(r"\.", name))
        found = [head for head in heads if head in node.parts or head in node.inner]
        if not found:
            self._flat.surplus[full_name] = None
        for element in found:
            variable = name.removeprefix(f"{element}.")
            if element in node.parts:
                owner = self._flat.names[*path, element]
                leg = _Leg(None, value.convert, value.scale)
                yield _Bound(owner, variable, value, [leg], full_name)
            else:
                yield from self._bound_values(node.inner[element], (*path, element), variable, value)


PACKAGE = Format("an SSP package", SSD_FILE, "`touchdown ssp` makes one of a scene")


RUN_KEYS = (
    "scheme",
    "bonds",
    "tolerance",
    "record_every",
    "record",
    "record_also",
    "record_arrays",
    "warn_residual",
    "stop_residual",
    "whirl_halvings",
    "impact_step",
    "until",
)
DIGITS = 12  # of a duration found as a difference
MOST = 20  # values that a line names


@dataclass(frozen=True)
class _Declarations:
    """Variables and units that an FMU declares."""

    variables: Mapping[str, ScalarVariable]
    units: Mapping[str, Unit]
    step: float | None  # s, the macro step that it is made for

    def variable(self, name: str, where: str) -> ScalarVariable:
        """The variable called `name`."""
        if name not in self.variables:
            raise TouchdownError(f"{where}: its FMU has no variable {name}; {one_of(name, self.variables)}")
        return self.variables[name]


SCHEME_SETS = ("interface.order", "interface.lead")  # a package states them for tools without schemes


@dataclass(frozen=True)
class _Package:
    """A package: its declarations, and those of its FMUs."""

    structure: Structure
    flat: _Flat
    sides: Mapping[str, _Declarations]  # by component
    where: str  # for people


def read_package(path: Path, variant: str = "") -> Scene:
    """The scene in a package (.ssp), or that of one of its variants.

    Raises TouchdownError where it is broken or cannot be run, or has no such variant.
    """
    cache = user_cache()
    folder = unpack(path, cache, PACKAGE)
    file, others = structure.structure_file(folder, variant, str(path))
    described = structure.read_structure(folder, str(path), file)
    flat = _flattened(described.root, str(path))
    files = {part.path for part in flat.parts.values()}
    of_files = {file: _Declarations(*interface(file, cache)) for file in files}
    sides = {name: of_files[part.path] for name, part in flat.parts.items()}
    package = _Package(described, flat, sides, str(path))
    settings, remarks = _settings(package)
    if others:
        names = joined(others, "or", most=MOST)
        remarks.append(f"{path} has other variants, too: --variant takes {names}")
    wires = tuple(_wire(package, link) for link in flat.links)
    scene = Scene(
        name=f"{path.stem}-{Path(file).stem}" if variant else path.stem,
        title=described.scene.get("title", described.root.title),
        about=described.scene.get("about", ""),
        components={name: _component(package, name, settings[name]) for name in flat.parts},
        connect=wires,
        bond=tuple(_bond(package, declared, wires) for declared in described.bonds),
        zero=described.scene.get("zero"),
        energy_scale=tuple(described.scene.get("energy_scale", "").split()),
        gaps=tuple(described.gaps),
        requirements=tuple(described.requirements),
        document=described.document,
        remarks=tuple(remarks),
    )
    return _with_run(scene, package)


def _component(package: _Package, name: str, settings: Mapping[str, object]) -> ComponentSpec:
    described = package.structure
    values = {_scene_name(described, name, variable): value for variable, value in settings.items()}
    values = {variable: value for variable, value in values.items() if variable not in SCHEME_SETS}
    return ComponentSpec(
        str(package.flat.parts[name].path.absolute()),
        values,
        every=1 if name in described.sampled else _every(package, name),
        sampled=described.sampled.get(name, 0.0),
        names=described.names.get(name, {}),
        own=tuple(changed for changed in described.changed.get(name, ()) if changed in values),
    )


def _scene_name(described: Structure, component: str, variable: str) -> str:
    """The name by which an FMU's variable goes in the scene."""
    scene_names = {name: scene_name for scene_name, name in described.names.get(component, {}).items()}
    return scene_names.get(variable, variable)


def _every(package: _Package, name: str) -> int:
    """How many of the system's macro steps the component `name` takes in one. Raises TouchdownError."""
    step, macro_step = package.flat.parts[name].step, package.structure.macro_step
    ratio = step / macro_step if step and macro_step else 1.0
    if not ratio < MAX_MACRO_STEPS:
        raise TouchdownError(
            f"component {name} asks for steps of {step:g} s, {ratio:g} of the package's macro steps; "
            f"less than {MAX_MACRO_STEPS:g} are possible"
        )
    return max(1, round(ratio))


def _with_run(scene: Scene, package: _Package) -> Scene:
    """`scene` with the run settings of the package."""
    described, sides = package.structure, package.sides
    settings: dict[str, object] = {f"run.{k}": described.scene[k] for k in RUN_KEYS if k in described.scene}
    proposed = [side.step for side in sides.values() if side.step]
    if described.macro_step is not None or proposed:
        settings["run.macro_step"] = described.macro_step or min(proposed)
    if described.start:
        settings["run.start_time"] = described.start
    if described.stop is not None:
        zero = time_zero(scene, _Starts(scene, package))
        origin = described.start if zero is None else zero
        settings["run.duration"] = round(described.stop - origin, DIGITS)
    return scene.set(settings)


@dataclass(frozen=True)
class _Starts:
    """The values that the components of a package start from."""

    scene: Scene
    package: _Package

    def value(self, name: str) -> float:
        """Of COMPONENT.VARIABLE; 0 where its FMU states none."""
        head, _, tail = name.partition(".")
        where = f"{self.package.where}: zero"
        if name not in self:
            raise TouchdownError(f"{where} = {name}: there is no component {head}")
        spec = self.scene.components[head]
        start = self.package.sides[head].variable(spec.names.get(tail, tail), where).start
        return float(str(spec.set.get(tail, start or 0.0)))

    def __contains__(self, name: str) -> bool:
        return name.partition(".")[0] in self.package.sides


# -- values ------------------------------------------------------------------------------------------------


def _settings(package: _Package) -> tuple[dict[str, dict[str, Setting]], list[str]]:
    """By component: what the bindings set, in the units of its variables; lines on what they do not set.

    The table of docs/systems.md says who may be set, and who wins. Start values of inputs that another
    component feeds are left out: initialisation hands them over.
    """
    settings: dict[str, dict[str, Setting]] = {name: {} for name in package.flat.parts}
    fed = {(link.end, link.input) for link in package.flat.links}
    by: dict[tuple[str, str], _Bound] = {}  # what has set a variable so far
    surplus, overridden, fitting = dict(package.flat.surplus), dict[str, None](), set[str]()
    for bound in package.flat.bound:
        side = package.sides[bound.component]
        single = bound.variable in side.variables
        names = [bound.variable] if single else elements(side.variables, bound.variable)
        known = [side.variables[name] for name in names]
        if not known or not all(variable.settable or variable.structural for variable in known):
            surplus[bound.given] = None
            continue
        fitting.add(bound.given)
        what = f"{package.where}: component {bound.component}, {bound.variable}"
        if len(known) != len(bound.value.content):
            raise TouchdownError(f"{what} takes {len(known)} values; {len(bound.value.content)} are given")
        for variable, content in zip(known, bound.value.content, strict=True):
            place = bound.component, variable.name
            if place in fed:
                continue
            if place in by and len(by[place].legs) < len(bound.legs):
                overridden[by[place].given] = None
            by[place] = bound
            value = _setting(package, bound, variable, content, what)
            if not (variable.structural and value == variable.start):  # a size that is stated again
                settings[bound.component][variable.name] = value
    lines = (
        ("that fit nothing that can be set are ignored", [n for n in surplus if n not in fitting]),
        ("are overridden by what comes along connections", list(overridden)),
    )
    return settings, [
        f"{package.where}: values {what} ({len(names)}): {joined(names, most=MOST)}"
        for what, names in lines
        if names
    ]


def _setting(
    package: _Package, bound: _Bound, variable: ScalarVariable, content: Setting, what: str
) -> Setting:
    """A value in the unit of its variable; of Strings text, of enumerations also words."""
    if isinstance(content, str):
        if not variable.choices and variable.kind is not FmiType.STRING:
            raise TouchdownError(f"{what} = {content!r} is text, and the variable is a {variable.kind}")
        return content
    if not math.isfinite(content):
        raise TouchdownError(f"{what} = {content} is not a finite number")
    side, units = package.sides[bound.component], package.structure.units
    start = _unit(bound.value.unit, (bound.value.units or {}, units, side.units))
    end = _unit(variable.unit, (side.units, units))
    return scaled(content, _along(start, bound.legs, end, package, what, variable.relative))


def _wire(package: _Package, link: _Link) -> Wire:
    """A connection, with the conversions between units on its way, and its transformations."""
    ends: list[_Named] = []
    names: list[str] = []
    relative = False
    real = True  # other types have no unit
    where = f"{package.where}: {link.title}"
    for part, name in ((link.start, link.output), (link.end, link.input)):
        side, connectors = package.sides[part], package.flat.parts[part].connectors
        variable = side.variable(name, where)
        declared = connectors[name].unit if name in connectors else None
        ends.append(_unit(declared or variable.unit, (package.structure.units, side.units)))
        real, relative = real and variable.kind is FmiType.REAL, relative or variable.relative
        names.append(f"{part}.{_scene_name(package.structure, part, name)}")
    if not real:
        ends = [(None, None), (None, None)]
    scale = _along(ends[0], link.legs, ends[1], package, where, relative)
    if real and not all(leg.convert for leg in link.legs):
        scale = scale or (1.0, 0.0)  # values cross unchanged in all units
    return Wire(names[0], names[1], scale)


def _bond(package: _Package, declared: Mapping[str, str], wires: Iterable[Wire]) -> BondSpec:
    """A bond that is declared, of the connections to the inputs that it names."""
    by_input = {wire.target: wire for wire in wires}
    for name in declared.values():
        if name not in by_input:
            raise TouchdownError(f"{package.where}: a Bond names {name}, to which nothing is connected")
    found = {kind: by_input[name] for kind, name in declared.items()}
    return BondSpec(found["force"], found.get("position"), found.get("velocity"))


def _along(
    start: _Named, legs: Sequence[_Leg], end: _Named, package: _Package, where: str, relative: bool
) -> Scale | None:
    """The scale of a value over its whole way: each leg converts it, and then transforms it.

    relative: of a difference.
    """
    scale: Scale | None = None
    unit = start
    for leg in legs:
        next_unit = end if leg is legs[-1] else _unit(leg.unit, (package.structure.units,))
        if leg.convert:
            scale = then(scale, _conversion(unit, next_unit, where, relative))
        unit = unit if next_unit[0] is None else next_unit
        scale = then(scale, leg.scale)
    return scale


_Named = tuple[str | None, Unit | None]  # a unit's name, and its definition where that is known


def _unit(name: str | None, definitions: Iterable[Mapping[str, Unit]]) -> _Named:
    """A unit by name, from the first of the definitions that has it."""
    known = (units[name] for units in definitions if name in units) if name else ()
    return name, next(iter(known), None)


def _conversion(source: _Named, target: _Named, where: str, relative: bool) -> Scale | None:
    """The conversion of values in the unit `source` into `target`; None where there is none."""
    (name, unit), (other_name, other) = source, target
    if name is None or other_name is None or (name == other_name and (unit is None or other is None)):
        return None
    if unit is None or other is None:
        raise TouchdownError(
            f"{where}: cannot convert {name} to {other_name}: {name if unit is None else other_name} is "
            "not defined by SI base units"
        )
    scale = unit.to(other, relative)
    if scale is None:
        raise TouchdownError(f"{where}: the units {name} and {other_name} do not measure the same")
    return None if scale == (1.0, 0.0) else scale
