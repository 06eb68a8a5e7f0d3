"""Scenes from TOML files, and from the values a run leaves behind.

title = "..."
about = "..."
zero = "amb.shutdown_time"                     # times and the duration count from here; or a time, "5 ms"
inclination = "90 deg"                         # of the shaft's +z end over the horizontal, for all
                                               # components that have weight; left out: as each has it
energy_scale = ["rotor.mass", "rotor.gravity", "bearing.clearance"]   # product, J
attach = [["bearing.journal", "rotor.A"]]      # bearing's port, body's port
sense = [["amb.sensor", "rotor.sensor"]]       # motion of a body's port only, sensor first
control = [["controller", "amb"]]              # a controller, and the actuator that it controls; of two
                                               # actuators the first has the controller's first axes
connect = [["rotor.A.x", "probe.x"]]           # single variables, source and target; where the target is
                                               # to be scaled, then factor and offset; also integers,
                                               # Booleans and choices, each to its own kind, not scaled
bond = [["s1.f", "s2.f"], ["s2.x", "s1.x2"]]   # a force and the motion it acts along: wires of a bond, or a
                                               # list of bonds; {force = [...], position = [...],
                                               # velocity = [...]} where units do not tell which is which

[[event]]                                      # before [run], or at the end; see `events`
time = "5 ms"         # on the simulation's clock
what = "amb: coil_off 2"  # COMPONENT: WORD, and which one, where there are several

[run]
duration = 5.0        # s, from zero, or from the start of a scene without one
start_time = 0.0      # s, where the simulation's clock begins (default: 0); a zero is a time on that clock
macro_step = 2e-5     # s

[components.rotor]
fmu = "rigid_rotor"   # a name of the project's own, or the path of an .fmu
preset = "6004"       # a bearing of the catalogue: its values, as far as the FMU has them; your own by its
                      # name in bearings.toml beside the scene, or by FILE.toml:NAME
every = 2             # macro steps of the run that it takes in one (default: 1)
sampled = "100 us"    # a controller's: it takes one step for each sample of its actuator, at the end of
                      # the macro step in which that lies; macro steps need not divide it
isolate = false       # step a third-party FMU in the master's process, unsupervised (default: true)
native = true         # one of the project's own: take its FMU that needs no Python (default: false)
settings = "FILE.toml" # what that file's [set] has for a component of this name, as `import mount` and
                      # `import foundation` write it; what [set] here or the component's own set says counts
[components.rotor.set]
mass = "1.65 kg"      # a number in SI, or text with a unit
[components.rotor.names]
"A.x" = "shaft_x"     # a variable of the contract, and what this FMU calls it; or names = "FILE.toml"

[set."bearing_*"]      # what several share: all components whose names match; or run, or one of them. What
friction.dynamic = 0.2 # [components] here, or in a scene that extends this one, says of one counts there

A scene with extends = "SCENE" (a name, or the path of a .toml beside it) starts as that one; what it
gives takes the place of what stands there, table by table; a component that names its fmu is a new one.
"""

from __future__ import annotations

import json
import os
import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import replace
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any, NamedTuple

from ..common.errors import TouchdownError, one_of
from ..common.units import to_si
from .events import GROUP, Event, events, settings_of
from .gaps import Gap, contacts, gaps, laid_over, of_rotor
from .requirements import Requirement, requirements
from .run_spec import READERS, RunSpec, with_changes
from .scene import (
    INCLINATION,
    BondSpec,
    ComponentSpec,
    Scene,
    Wire,
    bonds,
    checked_preset,
    inclination,
    wires,
)
from .tables import (
    above_zero,
    component_name,
    entries,
    flat,
    is_rotor,
    is_scene_file,
    pairs,
    reference,
    references,
    refuse_unknown,
    refuse_unusable,
    step_count,
    switch,
    table,
    unquoted,
    zero,
)
from .tables import components as controls

SCENE_FILE = "scene.toml"  # of a folder that is a machine
RECORDED_SCENE = "scene.json"  # what a run leaves
TABLES = (".csv", ".tsv", ".txt")
MAX_FILE_BYTES = 16_000_000  # bytes of a TOML file
SHIPPED_FOLDER = Path(__file__).parent / "shipped"


def shipped() -> dict[str, Path]:
    """Files of the scenes that come with the project, by name."""
    return {path.stem: path for path in sorted(SHIPPED_FOLDER.rglob("*.toml"), key=lambda path: path.stem)}


def load_scene(name: str) -> Scene:
    """A scene of the project's by name, or of the user's by the path of a TOML file.

    A folder stands for the scene.toml in it, which goes by the folder's name.
    """
    path = locate(name)
    own = path.resolve().parent.name if path.name == SCENE_FILE else path.stem
    return parse(tables(path), own, path.parent)


def locate(name: str) -> Path:
    """The file of a scene of the project's by name, or of the user's by path. Raises TouchdownError."""
    if name.endswith(".toml"):
        return Path(name)
    if name not in shipped() and os.path.isfile(Path(name) / SCENE_FILE):
        return Path(name) / SCENE_FILE
    if name in shipped():
        return shipped()[name]
    raise TouchdownError(
        _mistaken(Path(name))
        or f"unknown scene {name}; {one_of(name, shipped())}, or give the path of a .toml or .ssp"
    )


def _mistaken(path: Path) -> str:
    """The kind of file at a path that is no scene's, and its use; "" where nothing is known of it."""
    if path.suffix.lower() in TABLES and os.path.isfile(path):
        return (
            f"{path} is a table, no scene; `touchdown import rotor {path}` makes a rotor's file of it, and "
            "`touchdown new` a machine with that"
        )
    if os.path.isfile(path / RECORDED_SCENE):
        return f"{path} is what a run left; give {path / RECORDED_SCENE}, the scene as it was run"
    return ""


def is_scene(name: str) -> bool:
    """Whether a name or path, which could be a rotor's as well, is of a scene, sound or not."""
    if name.endswith(".ssp"):
        return True
    if name.endswith(".json"):
        return _may_be_left(Path(name))
    if not name.endswith(".toml"):
        return name in shipped() or os.path.isfile(Path(name) / SCENE_FILE)
    return is_scene_file(Path(name))


def _may_be_left(path: Path) -> bool:
    """Whether a JSON file is, or may have been, what a run left: not where it has no components."""
    try:
        return "components" in json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError, TypeError, RecursionError):
        return True


def parse(data: Mapping[str, Any], name: str, folder: Path) -> Scene:
    """A scene from the tables of its TOML file, as `tables` gives them."""
    known = (
        "title",
        "about",
        "zero",
        INCLINATION,
        "energy_scale",
        "attach",
        "sense",
        "control",
        "event",
        "connect",
        "bond",
        "gap",
        "requirements",
        "run",
        "components",
        "set",
    )
    refuse_unknown(data, known, f"scene {name}")
    given = table(data.get("components"), f"scene {name}: [components]")
    around = gaps(laid_over(_around_rotors(given, folder), data.get("gap", [])), f"scene {name}: gap")
    touching, touched = contacts(around)
    components = {
        component_name(key, f"scene {name}"): _component(
            key, part, f"scene {name}: [components.{key}]", folder
        )
        for key, part in {**touching, **given}.items()
    }
    if not given:
        raise TouchdownError(f'scene {name} has no components; add [components.NAME] with fmu = "..."')
    components = _with_events(components, events(data.get("event", []), f"scene {name}: event"), name)
    scene = Scene(
        name=name,
        title=str(data.get("title", name)),
        about=str(data.get("about", "")),
        components=components,
        attach=(*pairs(data.get("attach", []), f"scene {name}: attach"), *touched),
        sense=pairs(data.get("sense", []), f"scene {name}: sense"),
        control=controls(data.get("control", []), f"scene {name}: control"),
        connect=wires(data.get("connect", []), f"scene {name}: connect"),
        bond=bonds(data.get("bond", []), f"scene {name}: bond"),
        zero=zero(data["zero"], f"scene {name}: zero") if "zero" in data else None,
        energy_scale=references(data.get("energy_scale", []), f"scene {name}: energy_scale"),
        run=with_changes(RunSpec(), table(data.get("run", {}), f"scene {name}: [run]")),
        folder=folder,
        gaps=around,
        requirements=requirements(data.get("requirements", {}), f"scene {name}: [requirements]"),
        inclination=inclination(data[INCLINATION], f"scene {name}") if INCLINATION in data else None,
    )
    if not scene.gaps and any(one.kind == "least_gap" for one in scene.requirements):
        raise TouchdownError(
            f"scene {name}: [requirements] least_gap has no gap to look at; add [[gap]] with name, at "
            "and radial"
        )
    return _with_shared(scene, data.get("set", ()))


def _around_rotors(components: Mapping[str, Any], folder: Path) -> list[object]:
    """The gaps that rotors' files have."""
    found: list[object] = []
    for name, part in components.items():
        fmu = (entries(part) or {}).get("fmu")
        path = folder / fmu if isinstance(fmu, str) and fmu.endswith(".toml") else None
        if path is not None and os.path.isfile(path):
            found += of_rotor(name, _toml(path, "rotor").get("gap"))
    return found


def _with_events(
    components: Mapping[str, ComponentSpec], found: tuple[Event, ...], name: str
) -> dict[str, ComponentSpec]:
    """`components` with the events as their settings. Raises TouchdownError where one has its own."""
    for number, event in enumerate(found, start=1):
        here = f"scene {name}: event {number}"
        if event.component not in components:
            raise TouchdownError(
                f"{here}: there is no component {event.component}; {one_of(event.component, components)}"
            )
        own = [key for key in components[event.component].set if key.startswith(f"{GROUP}[")]
        if own:
            raise TouchdownError(
                f"{here}: {event.component} is set {own[0]}, too; give all its events as [[event]]"
            )
    return {
        key: replace(spec, set={**spec.set, **settings_of(found, key)}) for key, spec in components.items()
    }


class _Shared(NamedTuple):
    """The settings of a file's [set], and what is said of single components more exactly."""

    settings: Mapping[str, object]
    exact: frozenset[str]  # by [components] of the same file, or of one that extends it


def _shared(data: Mapping[str, Any], where: str) -> _Shared:
    return _Shared(flat(table(data.get("set", {}), f"{where}: [set]")), _exact(data))


def _exact(data: Mapping[str, Any]) -> frozenset[str]:
    """COMPONENT.NAME of all that [components] sets, run.KEY of all that [run] does."""
    parts = {name: entries(part) or {} for name, part in (entries(data.get("components")) or {}).items()}
    of_parts = {
        f"{name}.{setting}"
        for name, part in parts.items()
        for setting in (*part, *flat(entries(part.get("set")) or {}))
    }
    return frozenset(of_parts | {f"run.{key}" for key in entries(data.get("run")) or {}})


def _with_shared(scene: Scene, layers: Sequence[_Shared]) -> Scene:
    """A scene with the settings of its files' [set], which are the scene's, not made beside it."""
    there = scene
    for layer in layers:
        for name, value in layer.settings.items():
            general = [setting for setting in scene.matching_settings(name) if setting not in layer.exact]
            there = there.set(dict.fromkeys(general, value))
    components = {name: replace(spec, own=()) for name, spec in there.components.items()}
    return replace(there, components=components, own=scene.own)


def _component(name: str, value: object, where: str, folder: Path) -> ComponentSpec:
    """A table of [components]."""
    given = table(value, where)
    known = ("fmu", "preset", "every", "sampled", "isolate", "native", "settings", "set", "names")
    refuse_unknown(given, known, where)
    if not isinstance(given.get("fmu"), str):
        raise TouchdownError(f'{where} needs fmu = "NAME" or the path of an .fmu')
    of_file = _settings_for(name, given["settings"], where, folder) if "settings" in given else {}
    settings = of_file | flat(table(given.get("set", {}), where))
    preset = checked_preset(given.get("preset"), where, folder)
    every = step_count(given.get("every", 1), f"{where} every")
    sampled = above_zero(given["sampled"], "s", f"{where} sampled") if "sampled" in given else 0.0
    if sampled and "every" in given:
        raise TouchdownError(f"{where} has every and sampled; give one of them")
    names = _names(given.get("names", {}), where, folder)
    isolate = switch(given.get("isolate", True), f"{where} isolate")
    native = switch(given.get("native", False), f"{where} native")
    return ComponentSpec(
        given["fmu"], settings, preset, every, names, isolate=isolate, native=native, sampled=sampled
    )


def read_names(path: Path) -> dict[str, str]:
    """Names of an FMU's variables from a TOML file: "journal.x" = "shaft_x". Raises TouchdownError."""
    return _checked_names(_toml(path, "names"), f"names in {path}")


def tables(path: Path, before: tuple[Path, ...] = ()) -> dict[str, Any]:
    """The tables of a scene's file over those of the scene it extends; `before`: files that led here.

    Their [set] are a list, that of the first file first.
    """
    data = _toml(path, "scene")
    if is_rotor(data):
        raise TouchdownError(
            f"{path} is a rotor's file, no scene; `touchdown rotor {path}` describes it, and `touchdown "
            f"new FOLDER --rotor {path} --bearings NAME` makes a machine with a scene of it"
        )
    data["set"] = [_shared(data, f"scene {path}")]
    if "extends" not in data:
        return data
    base = str(data.pop("extends"))
    if base.endswith(".toml"):
        start = path.parent / base
    elif base in shipped():
        start = shipped()[base]
    else:
        raise TouchdownError(f"scene {path}: extends = {base!r}: {one_of(base, shipped())}")
    if start.resolve() in (*before, path.resolve()):
        raise TouchdownError(f"scene {path}: extends = {base!r} leads back to itself")
    under = tables(start, (*before, path.resolve()))
    exact = _exact(data)
    layers = [layer._replace(exact=layer.exact | exact) for layer in under["set"]]
    return _over(under, data) | {"set": [*layers, *data["set"]]}


def read_settings(path: Path) -> dict[str, object]:
    """Settings by name from the [set] of a TOML file. Raises TouchdownError."""
    data = _toml(path, "settings")
    refuse_unknown(data, ("title", "set"), f"settings {path}")
    found = flat(table(data.get("set", {}), f"settings {path}: [set]"))
    if not found:
        raise TouchdownError(f'settings {path} set nothing; add such as [set."housing_*"]')
    return found


def _settings_for(name: str, file: object, where: str, folder: Path) -> dict[str, object]:
    """The [set] of a file for the component `name`. Raises TouchdownError where it has nothing."""
    if not isinstance(file, str):
        raise TouchdownError(f'{where} settings = {file!r}; write the path of a file, "FILE.toml"')
    found: dict[str, object] = {}
    for setting, value in read_settings(folder / file).items():
        component, _, variable = setting.partition(".")
        if variable and fnmatchcase(name, component):
            found[variable] = value
    if not found:
        raise TouchdownError(f"{where}: settings {folder / file} say nothing of {name}")
    return found


def _toml(path: Path, what: str) -> dict[str, Any]:
    """The tables of a TOML file. Raises TouchdownError, as all that follows."""
    where = f"{what} {path}"
    try:
        with path.open("rb") as file:
            content = file.read(MAX_FILE_BYTES + 1)
    except OSError as error:
        raise TouchdownError(f"cannot read {where}: {error.strerror}") from None
    except ValueError as error:  # of a path that no file can have
        raise TouchdownError(f"cannot read {what} {str(path)!r}: {error}") from None
    if len(content) > MAX_FILE_BYTES:
        raise TouchdownError(
            f"{where} is larger than {MAX_FILE_BYTES / 1e6:.0f} MB; it must be something else"
        )
    try:
        text = content.decode("utf-8-sig")  # some editors begin files with a mark
    except ValueError as error:
        raise TouchdownError(f"{where} is not valid TOML: {error}") from None
    try:
        data = tomllib.loads(text)
    except RecursionError:
        raise TouchdownError(f"{where} is not valid TOML: its values lie too deep in each other") from None
    except ValueError as error:  # of TOML's syntax, of an integer with thousands of digits
        raise TouchdownError(f"{where} is not valid TOML: {error}{unquoted(error, text)}") from None
    refuse_unusable(data, where)
    return data


def _over(base: Mapping[str, Any], changes: Mapping[str, Any]) -> dict[str, Any]:
    """`base` with `changes` put in, nested tables likewise, unless they name another FMU."""
    merged = dict(base)
    for key, value in changes.items():
        there, given = entries(merged.get(key)), entries(value)
        if key == "gap" and key in merged:
            merged[key] = laid_over(merged[key], value)
        elif there is None or given is None or "fmu" in given:
            merged[key] = value
        else:
            merged[key] = _over(there, given)
    return merged


def _names(value: object, where: str, folder: Path) -> dict[str, str]:
    """Of a component's variables: a table, or the path of a TOML file."""
    if isinstance(value, str):
        return read_names(folder / value)
    return _checked_names(table(value, f"{where}.names"), f"{where}: names")


def _checked_names(table: Mapping[str, Any], where: str) -> dict[str, str]:
    names = flat(table)
    for name, own in names.items():
        if not isinstance(own, str):
            raise TouchdownError(f'{where}: {name} = {own!r}; write such as "journal.x" = "shaft_x"')
    twice = [own for own in names.values() if list(names.values()).count(own) > 1]
    if twice:
        raise TouchdownError(f"{where}: {twice[0]} is given twice")
    return {name: str(own) for name, own in names.items()}


def read_resolved(path: Path) -> Scene:
    """The scene in a scene.json. Raises TouchdownError where it cannot be read, or is none."""
    try:
        return restored(json.loads(path.read_text(encoding="utf-8")))
    except TouchdownError as error:
        raise TouchdownError(f"scene {path}: {error}") from None
    except OSError as error:
        raise TouchdownError(f"cannot read scene {path}: {error.strerror}") from None
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        what = f"{type(error).__name__}: {error}"
        raise TouchdownError(f"scene {path} is not as a run leaves it ({what}); give a .toml") from None


def restored(values: Mapping[str, Any]) -> Scene:
    """The scene whose `resolved()` gives `values`, lists taken as tuples and paths as text.

    Raises TouchdownError, KeyError or TypeError where they are not such values.
    """
    parts = dict(values)
    given = table(parts["components"], "components")
    own = tuple(parts["own"])
    refuse_unknown(dict.fromkeys(own), tuple(READERS), "own")
    parts |= {
        **{key: _text(parts[key], key) for key in ("name", "title", "about")},
        "components": {
            name: _restored_component(part, f"components.{name}") for name, part in given.items()
        },
        "attach": pairs(parts["attach"], "attach"),
        "sense": pairs(parts["sense"], "sense"),
        "control": controls(parts.get("control", ()), "control"),
        "connect": tuple(_wire(wire) for wire in parts["connect"]),
        "bond": tuple(_bond(*bond) for bond in parts["bond"]),
        "zero": None if parts["zero"] is None else zero(parts["zero"], "zero"),
        "energy_scale": references(parts["energy_scale"], "energy_scale"),
        "own": own,
        INCLINATION: None
        if parts.get(INCLINATION) is None
        else inclination(parts[INCLINATION], "the machine"),
        "run": with_changes(RunSpec(), table(parts["run"], "run")),
        "folder": Path(parts["folder"]),
        "gaps": tuple(Gap(*gap) for gap in parts.get("gaps", ())),
        "requirements": tuple(Requirement(*one) for one in parts.get("requirements", ())),
    }
    return Scene(**parts)


def _restored_component(values: object, where: str) -> ComponentSpec:
    parts = dict(table(values, where))
    settings, own = table(parts["set"], f"{where}.set"), tuple(parts["own"])
    refuse_unknown(dict.fromkeys(own), (*settings, "preset"), f"{where}.own")
    names = table(parts["names"], f"{where}.names")
    parts |= {
        **{key: _text(parts[key], f"{where}.{key}") for key in ("fmu", "instead_of")},
        "set": settings,
        "preset": None if parts["preset"] is None else _text(parts["preset"], f"{where}.preset"),
        "every": step_count(parts["every"], f"{where}.every"),
        "sampled": to_si(parts.get("sampled", 0.0), "s", f"{where}.sampled"),
        "names": {name: _text(own_name, f"{where}.names.{name}") for name, own_name in names.items()},
        "inherited": table(parts["inherited"], f"{where}.inherited"),
        **{key: switch(parts[key], f"{where}.{key}") for key in ("isolate", "native")},
        "own": own,
    }
    return ComponentSpec(**parts)


def _text(value: object, where: str) -> str:
    if not isinstance(value, str):
        raise TouchdownError(f"{where} = {value!r} must be text")
    return value


def _wire(wire: Sequence[Any]) -> Wire:
    source, target, scale = wire
    return Wire(reference(source, "wire"), reference(target, "wire"), scale and (scale[0], scale[1]))


def _bond(force: Any, position: Any, velocity: Any, motion: Sequence[Any]) -> BondSpec:
    return BondSpec(
        _wire(force),
        position and _wire(position),
        velocity and _wire(velocity),
        tuple(_wire(wire) for wire in motion),
    )
