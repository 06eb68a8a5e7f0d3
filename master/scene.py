"""A scene: components, how they are attached, and how to run them; read from TOML.

title = "..."
about = "..."
zero = "amb.shutdown_time"                     # times and the duration count from here
energy_scale = ["rotor.mass", "rotor.gravity", "bearing.clearance"]   # product, J
attach = [["bearing.journal", "rotor.A"]]      # bearing's port, body's port
sense = [["amb.sensor", "rotor.sensor"]]       # motion of a body's port only, sensor first
connect = [["rotor.A.x", "probe.x"]]           # single variables, source and target; where the target is
                                               # to be scaled, then factor and offset

[run]
duration = 5.0        # s
macro_step = 2e-5     # s

[components.rotor]
fmu = "rigid_rotor"   # a name of the project's own, or the path of an .fmu
preset = "6004"       # a bearing of the catalogue: its values, as far as the FMU has them
every = 2             # macro steps of the run that it takes in one (default: 1)
[components.rotor.set]
mass = "1.65 kg"      # a number in SI, or text with a unit
[components.rotor.names]
"A.x" = "shaft_x"     # a variable of the contract, and what this FMU calls it; or names = "FILE.toml"

A scene with extends = "SCENE" (a name, or the path of a .toml beside it) starts as that one; what it
gives takes the place of what stands there, table by table; a component that names its fmu is a new one.
"""

from __future__ import annotations

import math
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, NamedTuple

from fmus.presets import presets
from master import schemes
from master.errors import TouchdownError, one_of
from master.units import Scale, to_si

SCENES = Path(__file__).parent / "scenes"


@dataclass(frozen=True)
class ComponentSpec:
    """A component: where it comes from and what is set in it."""

    fmu: str
    set: Mapping[str, object] = field(default_factory=dict)
    preset: str | None = None  # a named set of parameters, applied first
    every: int = 1  # macro steps of the run that it takes in one
    names: Mapping[str, str] = field(default_factory=dict)
    """Variables of the contract, and what this FMU calls them."""
    inherited: Mapping[str, object] = field(default_factory=dict)
    """Settings of the component it was swapped for; those it has are applied before `set`."""


class Wire(NamedTuple):
    """A single variable feeding another, COMPONENT.VARIABLE both."""

    source: str
    target: str
    scale: Scale | None = None  # factor and offset; None: as it is, in equal units


@dataclass(frozen=True)
class RunSpec:
    """How to run."""

    duration: float = 1.0  # s, from the scene's zero
    macro_step: float = 2e-5  # s
    scheme: str = schemes.DEFAULT
    tolerance: float = 1e-10  # m, of the interface per macro step, for schemes that repeat or divide it
    record_every: int = 5  # macro steps
    record: tuple[str, ...] = ()  # beginnings of COMPONENT.VARIABLE that are recorded; none: all
    record_arrays: bool = False  # also elements of arrays, such as single balls; else only at the end
    warn_residual: float = 1e-3  # ledger over energy scale: say so
    stop_residual: float = 0.1  # ledger over energy scale: stop


RUN_UNITS = {
    "duration": "s",
    "macro_step": "s",
    "tolerance": "m",
    "record_every": "1",
    "warn_residual": "1",
    "stop_residual": "1",
}


@dataclass(frozen=True)
class Scene:
    """Everything a run needs."""

    name: str
    title: str
    components: Mapping[str, ComponentSpec]
    about: str = ""
    attach: tuple[tuple[str, str], ...] = ()
    sense: tuple[tuple[str, str], ...] = ()
    connect: tuple[Wire, ...] = ()
    zero: str | None = None
    energy_scale: tuple[str, ...] = ()
    run: RunSpec = RunSpec()
    folder: Path = Path()  # relative paths of FMUs start here

    def with_setting(self, name: str, value: object) -> Scene:
        """A copy with run.KEY or COMPONENT.VARIABLE set to `value`."""
        head, _, tail = name.partition(".")
        if not tail:
            raise TouchdownError(f"cannot set {name}; write COMPONENT.VARIABLE or run.KEY")
        if head == "run":
            return replace(self, run=_run({tail: value}, self.run))
        spec = self._component(head)
        if tail == "preset":
            changed = replace(spec, preset=_preset(value, head))
        elif tail == "every":
            changed = replace(spec, every=_whole(value, name))
        else:
            changed = replace(spec, set={**spec.set, tail: value})
        return replace(self, components={**self.components, head: changed})

    def with_settings(self, settings: Mapping[str, object]) -> Scene:
        """A copy with all of them set, as by `with_setting`, in their order."""
        scene = self
        for name, value in settings.items():
            scene = scene.with_setting(name, value)
        return scene

    def with_swap(self, name: str, fmu: str) -> Scene:
        """A copy with component `name` made of another FMU.

        It starts from its own defaults and takes over what the scene sets, as far as it has it. Names
        that the scene gives belong to the FMU that goes; `with_names` gives the new one's.
        """
        before = self._component(name)
        if fmu.endswith(".fmu"):
            fmu = str(Path(fmu).absolute())
        return replace(
            self,
            components={
                **self.components,
                name: ComponentSpec(fmu, every=before.every, inherited={**before.inherited, **before.set}),
            },
        )

    def with_names(self, name: str, path: Path) -> Scene:
        """A copy with the names of component `name` read from a TOML file."""
        spec = replace(self._component(name), names=read_names(path))
        return replace(self, components={**self.components, name: spec})

    def _component(self, name: str) -> ComponentSpec:
        try:
            return self.components[name]
        except KeyError:
            raise TouchdownError(
                f"scene {self.name} has no component {name}; {one_of(name, [*self.components, 'run'])}"
            ) from None


def names() -> list[str]:
    """The scenes that come with the project."""
    return sorted(path.stem for path in SCENES.glob("*.toml"))


def load(name: str) -> Scene:
    """A scene of the project's by name, or of the user's by the path of a TOML file or an SSP package."""
    if name.endswith(".ssp"):
        from master.ssp.read import read  # it makes scenes

        return read(Path(name))
    path = SCENES / f"{name}.toml"
    if name.endswith(".toml"):
        path = Path(name)
    elif name not in names():
        raise TouchdownError(
            f"unknown scene {name}; {one_of(name, names())}, or give the path of a .toml or .ssp"
        )
    return parse(_tables(path, ()), path.stem, path.parent)


def _tables(path: Path, before: tuple[Path, ...]) -> dict[str, Any]:
    """The tables of a scene's file over those of the scene it extends; `before`: files that led here."""
    data = _toml(path, "scene")
    if "extends" not in data:
        return data
    base = str(data.pop("extends"))
    if base.endswith(".toml"):
        start = path.parent / base
    elif base in names():
        start = SCENES / f"{base}.toml"
    else:
        raise TouchdownError(f"scene {path}: extends = {base!r}: {one_of(base, names())}")
    if start.resolve() in (*before, path.resolve()):
        raise TouchdownError(f"scene {path}: extends = {base!r} leads back to itself")
    return _over(_tables(start, (*before, path.resolve())), data)


def _toml(path: Path, what: str) -> dict[str, Any]:
    try:
        return tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise TouchdownError(f"cannot read {what} {path}: {error.strerror}") from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise TouchdownError(f"{what} {path} is not valid TOML: {error}") from None


def _over(base: Mapping[str, Any], changes: Mapping[str, Any]) -> dict[str, Any]:
    """`base` with `changes` put in, nested tables likewise, unless they name another FMU."""
    found = dict(base)
    for key, value in changes.items():
        there = found.get(key)
        if isinstance(value, Mapping) and isinstance(there, Mapping) and "fmu" not in value:
            found[key] = _over(there, value)
        else:
            found[key] = value
    return found


def parse(data: Mapping[str, Any], name: str, folder: Path) -> Scene:
    """A scene from the tables of its TOML file."""
    known = ("title", "about", "zero", "energy_scale", "attach", "sense", "connect", "run", "components")
    _refuse_unknown(data, known, f"scene {name}")
    components = {}
    for key, table in _table(data.get("components"), f"scene {name}: [components]").items():
        where = f"scene {name}: [components.{key}]"
        table = _table(table, where)
        _refuse_unknown(table, ("fmu", "preset", "every", "set", "names"), where)
        if not isinstance(table.get("fmu"), str):
            raise TouchdownError(f'{where} needs fmu = "NAME" or the path of an .fmu')
        settings = _flat(_table(table.get("set", {}), where))
        preset, every = _preset(table.get("preset"), where), _whole(table.get("every", 1), f"{where} every")
        names = _names(table.get("names", {}), where, folder)
        components[key] = ComponentSpec(table["fmu"], settings, preset, every, names)
    if not components:
        raise TouchdownError(f'scene {name} has no components; add [components.NAME] with fmu = "..."')
    return Scene(
        name=name,
        title=str(data.get("title", name)),
        about=str(data.get("about", "")),
        components=components,
        attach=_pairs(data.get("attach", []), f"scene {name}: attach"),
        sense=_pairs(data.get("sense", []), f"scene {name}: sense"),
        connect=_wires(data.get("connect", []), f"scene {name}: connect"),
        zero=_reference(data["zero"], f"scene {name}: zero") if "zero" in data else None,
        energy_scale=_references(data.get("energy_scale", []), f"scene {name}: energy_scale"),
        run=_run(_table(data.get("run", {}), f"scene {name}: [run]"), RunSpec()),
        folder=folder,
    )


def _run(changes: Mapping[str, object], run: RunSpec) -> RunSpec:
    _refuse_unknown(changes, ("scheme", "record", "record_arrays", *RUN_UNITS), "[run]")
    values: dict[str, Any] = {}
    for key, value in changes.items():
        if key == "scheme":
            values[key] = schemes.scheme(str(value)).name
            continue
        if key == "record_arrays":
            values[key] = _switch(value, f"run.{key}")
            continue
        if key == "record":
            values[key] = _beginnings(value)
            continue
        number = to_si(value, RUN_UNITS[key], f"run.{key}")
        if number <= 0.0 or not math.isfinite(number):
            raise TouchdownError(f"run.{key} = {value} must be above 0")
        if key == "record_every":
            number = _whole(value, f"run.{key}")
        values[key] = number
    return replace(run, **values)


def _whole(value: object, name: str) -> int:
    """A number of macro steps."""
    number = to_si(value, "1", name)
    if number < 1.0 or number != int(number):
        raise TouchdownError(f"{name} = {value} must be a whole number of macro steps")
    return int(number)


def _beginnings(value: object) -> tuple[str, ...]:
    """Of recorded variables: a list of text, or text with commas."""
    parts = value.split(",") if isinstance(value, str) else value
    if not isinstance(parts, list) or not all(isinstance(part, str) and part.strip() for part in parts):
        raise TouchdownError(
            f'run.record = {value!r} must be a list such as ["rotor.A", "bearing.contact"]'
        )
    return tuple(part.strip() for part in parts)


def _switch(value: object, name: str) -> bool:
    known = {"true": True, "1": True, "false": False, "0": False}
    try:
        return known[str(value).lower()]
    except KeyError:
        raise TouchdownError(f"{name} = {value} must be true or false") from None


def _preset(name: object, where: str) -> str | None:
    if name is not None and name not in presets():
        raise TouchdownError(f"{where}: there is no preset {name}; {one_of(str(name), presets())}")
    return None if name is None else str(name)


def _flat(table: Mapping[str, Any], prefix: str = "") -> dict[str, object]:
    """Nested tables as dotted names: [set.friction] static = 0.2 is friction.static."""
    found: dict[str, object] = {}
    for key, value in table.items():
        if isinstance(value, Mapping):
            found |= _flat(value, f"{prefix}{key}.")
        else:
            found[f"{prefix}{key}"] = value
    return found


def _table(value: object, where: str) -> Mapping[str, Any]:
    if not isinstance(value, Mapping):
        raise TouchdownError(f"{where} must be a table")
    return value


def _pairs(value: object, where: str) -> tuple[tuple[str, str], ...]:
    if not isinstance(value, list) or not all(
        isinstance(p, list) and len(p) == 2 and all(isinstance(s, str) and "." in s for s in p)
        for p in value
    ):
        raise TouchdownError(f'{where} must be a list of pairs such as ["bearing.journal", "rotor.A"]')
    return tuple((p[0], p[1]) for p in value)


def _wires(value: object, where: str) -> tuple[Wire, ...]:
    """Pairs, some with factor and offset."""
    if not isinstance(value, list) or not all(isinstance(wire, list) for wire in value):
        raise TouchdownError(f'{where} must be a list such as [["rotor.A.x", "probe.x"]]')
    found: list[Wire] = []
    for wire in value:
        ((source, target),) = _pairs([wire[:2]], where)
        scale = None
        if len(wire) > 2:
            if len(wire) != 4:
                raise TouchdownError(f"{where}: {wire}: after source and target, give factor and offset")
            what = f"{where}: {source} to {target}"
            scale = to_si(wire[2], "1", f"{what}, factor"), to_si(wire[3], None, f"{what}, offset")
        found.append(Wire(source, target, scale))
    return tuple(found)


def _names(value: object, where: str, folder: Path) -> dict[str, str]:
    """Of a component's variables: a table, or the path of a TOML file."""
    if isinstance(value, str):
        return read_names(folder / value)
    return _checked_names(_table(value, f"{where}.names"), f"{where}: names")


def read_names(path: Path) -> dict[str, str]:
    """Names of an FMU's variables from a TOML file: "journal.x" = "shaft_x". Raises TouchdownError."""
    return _checked_names(_toml(path, "names"), f"names in {path}")


def _checked_names(table: Mapping[str, Any], where: str) -> dict[str, str]:
    names = _flat(table)
    for name, own in names.items():
        if not isinstance(own, str):
            raise TouchdownError(f'{where}: {name} = {own!r}; write such as "journal.x" = "shaft_x"')
    twice = [own for own in names.values() if list(names.values()).count(own) > 1]
    if twice:
        raise TouchdownError(f"{where}: {twice[0]} is given twice")
    return {name: str(own) for name, own in names.items()}


def _reference(value: object, where: str) -> str:
    if not isinstance(value, str) or not all(value.partition(".")):
        raise TouchdownError(f'{where} = {value!r} must name a variable, such as "amb.shutdown_time"')
    return value


def _references(value: object, where: str) -> tuple[str, ...]:
    if not isinstance(value, list):
        raise TouchdownError(f'{where} = {value!r} must be a list of variables, such as ["rotor.mass"]')
    return tuple(_reference(item, where) for item in value)


def _refuse_unknown(table: Mapping[str, Any], known: tuple[str, ...], where: str) -> None:
    for key in table:
        if key not in known:
            raise TouchdownError(f"{where} has an unknown key {key}; {one_of(key, known)}")
