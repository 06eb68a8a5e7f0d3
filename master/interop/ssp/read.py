"""Read an SSP package as a scene: components with their bindings applied, and single connections.

Which connections make ports is found out where the system is assembled, from the names of the contract,
so that packages of other tools have an energy ledger and bearings that step first.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from touchdown.master.common.errors import TouchdownError, one_of
from touchdown.master.common.units import Scale, Unit, scaled, then
from touchdown.master.components.component import Variable
from touchdown.master.components.interface import interface
from touchdown.master.components.unpack import Format, unpack
from touchdown.master.interop.ssp import structure
from touchdown.master.interop.ssp.bindings import Value
from touchdown.master.interop.ssp.names import HEART
from touchdown.master.interop.ssp.structure import Link, Structure
from touchdown.master.scene.scene import ComponentSpec, Scene
from touchdown.master.scene.wires import Wire
from touchdown.modelkit.kernel.cache_folder import user_cache

PACKAGE = Format("an SSP package", HEART, "`touchdown ssp` makes one of a scene")


RUN_KEYS = (
    "scheme", "tolerance", "record_every", "record", "record_also", "record_arrays", "warn_residual",
    "stop_residual", "whirl_halvings", "impact_step",
)  # fmt: skip
DIGITS = 12  # of a duration found as a difference


@dataclass(frozen=True)
class Side:
    """What an FMU says of itself."""

    variables: Mapping[str, Variable]
    units: Mapping[str, Unit]

    def variable(self, name: str, where: str) -> Variable:
        """The variable called `name`."""
        if name not in self.variables:
            raise TouchdownError(f"{where}: its FMU has no variable {name}; {one_of(name, self.variables)}")
        return self.variables[name]


SCHEME_SETS = ("interface.order", "interface.lead")  # a package states them for tools without schemes


def read(path: Path) -> Scene:
    """The scene in a package (.ssp). Raises TouchdownError where it is broken or cannot be run."""
    cache = user_cache()
    folder = unpack(path, cache, PACKAGE)
    system = structure.read(folder, str(path))
    sides = {name: Side(*interface(part.path, cache)) for name, part in system.parts.items()}
    settings = _settings(system, sides, str(path))
    scene = Scene(
        name=path.stem,
        title=system.scene.get("title", system.title),
        about=system.scene.get("about", ""),
        components={name: _component(system, name, settings[name]) for name in system.parts},
        connect=tuple(
            _wire(system, link, sides, str(path)) for link in system.links if link.start and link.end
        ),
        zero=system.scene.get("zero"),
        energy_scale=tuple(system.scene.get("energy_scale", "").split()),
    )
    return _with_run(scene, system, sides, str(path))


def _component(system: Structure, name: str, settings: Mapping[str, float]) -> ComponentSpec:
    names = system.names.get(name, {})
    given = {_here(system, name, variable): value for variable, value in settings.items()}
    given = {variable: value for variable, value in given.items() if variable not in SCHEME_SETS}
    return ComponentSpec(
        str(system.parts[name].path.absolute()),
        given,
        every=system.every(name),
        names=names,
        own=tuple(changed for changed in system.changed.get(name, ()) if changed in given),
    )


def _here(system: Structure, component: str, variable: str) -> str:
    """The name by which an FMU's variable goes in the scene."""
    own = {own: here for here, own in system.names.get(component, {}).items()}
    return own.get(variable, variable)


def _with_run(scene: Scene, system: Structure, sides: Mapping[str, Side], where: str) -> Scene:
    """`scene` with how to run it, as far as the package says it."""
    settings: dict[str, object] = {f"run.{k}": system.scene[k] for k in RUN_KEYS if k in system.scene}
    if system.macro_step is not None:
        settings["run.macro_step"] = system.macro_step
    if system.stop is not None:
        zero = 0.0
        if scene.zero:
            head, _, tail = scene.zero.partition(".")
            if head not in sides:
                raise TouchdownError(f"{where}: zero = {scene.zero}: there is no component {head}")
            own = scene.components[head].names.get(tail, tail)
            start = sides[head].variable(own, f"{where}: zero").start
            zero = float(str(scene.components[head].set.get(tail, start or 0.0)))
        settings["run.duration"] = round(system.stop - zero, DIGITS)
    return scene.set(settings)


# -- values ------------------------------------------------------------------------------------------------


def _settings(system: Structure, sides: Mapping[str, Side], where: str) -> dict[str, dict[str, float]]:
    """By component: what the bindings set, in the units of its variables.

    The system's bindings are above those of its components. Start values of inputs that another
    component feeds are left out: initialisation hands them over.
    """
    settings: dict[str, dict[str, float]] = {name: {} for name in system.parts}
    fed = {(link.end, link.input) for link in system.links if link.start is not None}
    for component, value in _bound(system, where):
        if (component, value.name) not in fed:
            what = f"{where}: component {component}, {value.name}"
            settings[component][value.name] = _number(system, sides[component], value, what)
    return settings


def _bound(system: Structure, where: str) -> Iterator[tuple[str, Value]]:
    """Component and value of every binding, those that are above others after them."""
    for name, part in system.parts.items():
        yield from ((name, value) for value in part.values)
    outer = [link for link in system.links if link.start is None and link.end is not None]
    given = {value.name: value for value in system.values}
    for link in outer:
        if link.output not in given:
            raise TouchdownError(
                f"{where}: {link.title}: nothing feeds the system's connector {link.output}; bind a value "
                "to it or remove the connection"
            )
    for value in system.values:
        for link in outer:
            if link.output == value.name and link.end is not None:
                scale = then(value.scale, link.scale)
                yield link.end, replace(value, name=link.input, scale=scale)
        head, _, tail = value.name.partition(".")
        if head in system.parts:
            yield head, replace(value, name=tail)
        elif value.name not in {link.output for link in outer}:
            raise TouchdownError(
                f"{where}: a binding of the system sets {value.name}, which is neither COMPONENT.VARIABLE "
                f"nor a connector that feeds one; {one_of(head, system.parts)}"
            )


def _number(system: Structure, side: Side, value: Value, where: str) -> float:
    """A bound value in the unit of its variable."""
    variable = side.variable(value.name, where)
    first = None
    if value.convert:
        source = _unit(value.unit, (value.units or {}, system.units, side.units))
        first = _conversion(source, _unit(variable.unit, (side.units, system.units)), where)
    return scaled(value.number, then(first, value.scale))


def _wire(system: Structure, link: Link, sides: Mapping[str, Side], where: str) -> Wire:
    """A connection, with the conversion between its ends' units before its own transformation."""
    ends: list[_Named] = []
    names: list[str] = []
    for part, name in link.ends:
        assert part is not None
        side = sides[part]
        variable = side.variable(name, f"{where}: {link.title}")
        unit = system.parts[part].units.get(name) or variable.unit
        ends.append(_unit(unit, (system.units, side.units)))
        names.append(f"{part}.{_here(system, part, name)}")
    if link.convert:
        scale = then(_conversion(ends[0], ends[1], f"{where}: {link.title}"), link.scale)
    else:
        scale = link.scale or (1.0, 0.0)
    return Wire(names[0], names[1], scale)


_Named = tuple[str | None, Unit | None]  # a unit's name, and what it is where that is known


def _unit(name: str | None, definitions: Iterable[Mapping[str, Unit]]) -> _Named:
    """A unit by name, from the first of the definitions that has it."""
    known = (units[name] for units in definitions if name in units) if name else ()
    return name, next(iter(known), None)


def _conversion(source: _Named, target: _Named, where: str) -> Scale | None:
    """What turns values in the unit `source` into `target`; None where nothing does."""
    (name, unit), (wanted, other) = source, target
    if name is None or wanted is None or (name == wanted and (unit is None or other is None)):
        return None
    if unit is None or other is None:
        raise TouchdownError(
            f"{where}: cannot convert {name} to {wanted}: {name if unit is None else wanted} is not "
            "defined by SI base units"
        )
    scale = unit.to(other)
    if scale is None:
        raise TouchdownError(f"{where}: the units {name} and {wanted} do not measure the same")
    return None if scale == (1.0, 0.0) else scale
