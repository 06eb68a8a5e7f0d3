"""Scenes from TOML files (docs/scene-file.md), and from the values a run leaves behind."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import fields, replace
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any, NamedTuple

from ...modelkit.errors import require
from ...modelkit.reader import (
    LIST,
    TABLE,
    TEXT,
    Kind,
    Table,
    json_of,
    kinds,
    listed,
    number,
    text_of,
    toml_of,
)
from ..common.errors import TouchdownError, one_of
from ..quantities import Owner
from .events import GROUP, settings_at_times, settings_of
from .gaps import RotorGap, contacts_of, laid_over, of_rotor, read_gaps
from .requirements import Requirement, read_requirements, refuse_unknown
from .run_spec import RunSpec, with_changes
from .scene import INCLINATION, BondSpec, ComponentSpec, Document, Scene, Wire, checked_preset
from .tables import NAMED, ROTOR_TABLES, as_table, dotted_keys, is_scene_file, is_table, naming

OTHERS = (
    "title",
    "event",
    "gap",
    "requirements",
    "document",
    "run",
    "components",
    "set",
)  # read apart
SCENE_FILE = "scene.toml"  # of a folder that is a machine
RECORDED_SCENE = "scene.json"  # what a run leaves
TABLES = (".csv", ".tsv", ".txt")
MAX_LAYERS = 30  # scenes that extend each other
MAX_FILE_BYTES = 16_000_000  # bytes of a TOML file
SHIPPED_FOLDER = Path(__file__).parent / "shipped"


def shipped_scenes() -> dict[str, Path]:
    """Files of the scenes that come with the project, by name."""
    return {path.stem: path for path in sorted(SHIPPED_FOLDER.rglob("*.toml"), key=lambda path: path.stem)}


def load_scene(name: str) -> Scene:
    """A scene of the project's by name, or of the user's by the path of a TOML file.

    A folder stands for the scene.toml in it, which goes by the folder's name.
    """
    path = locate_scene(name)
    scene_name = Path(os.path.realpath(path)).parent.name if path.name == SCENE_FILE else path.stem
    return parse_scene(merged_tables(path), scene_name, path.parent)


def locate_scene(name: str) -> Path:
    """The file of a scene of the project's by name, or of the user's by path. Raises TouchdownError."""
    if name.endswith(".toml"):
        return Path(name)
    if name not in shipped_scenes() and os.path.isfile(Path(name) / SCENE_FILE):
        return Path(name) / SCENE_FILE
    if name in shipped_scenes():
        return shipped_scenes()[name]
    raise TouchdownError(
        _mistaken(Path(name))
        or f"unknown scene {name}; {one_of(name, shipped_scenes())}, or give the path of a .toml or .ssp"
    )


def _mistaken(path: Path) -> str:
    """The kind of file at a path that is not a scene's, and its use; "" for an unknown kind."""
    if path.suffix.lower() in TABLES and os.path.isfile(path):
        return (
            f"{path} is a table, not a scene; `touchdown import rotor {path}` makes a rotor's file of it, "
            "and `touchdown new` a machine with that"
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
        return name in shipped_scenes() or os.path.isfile(Path(name) / SCENE_FILE)
    return is_scene_file(Path(name))


def _may_be_left(path: Path) -> bool:
    """Whether a JSON file is, or may have been, what a run left: not where it has no components."""
    try:
        return "components" in json_of(text_of(path), str(path))
    except TouchdownError:
        return True


def parse_scene(data: Mapping[str, Any], name: str, folder: Path) -> Scene:
    """A scene from the tables of its TOML file, as `merged_tables` gives them."""
    top = Table(f"scene {name}: ", data)
    written = top.table("components")
    around = read_gaps(
        Table(
            top.where, {"gap": laid_over(_around_rotors(written.values, folder), data.get("gap", []))}
        ).tables("gap")
    )
    touching, touched = contacts_of(around)
    parts = Table(written.where, {**touching, **written.values})
    for key in parts.values:
        NAMED.read(key, f"scene {name}: the name of a component")
    components = {key: _component(parts.table(key), key, folder) for key in parts.values}
    require(written.values, f'scene {name} has no components; add [components.NAME] with fmu = "..."')
    scene = top.read(
        Scene,
        *OTHERS,
        name=name,
        title=top.get("title", TEXT, name),
        components=_with_events(components, top),
        run=with_changes(RunSpec(), top.table("run").values, top.where),
        folder=folder,
        gaps=around,
        requirements=read_requirements(top.table("requirements")),
        document=top.table("document").read(Document),
    )
    scene = replace(scene, attach=(*scene.attach, *touched))
    require(
        scene.gaps or not any(one.kind == "least_gap" for one in scene.requirements),
        f"scene {name}: requirements.least_gap has no gap to look at; add a [[gap]]",
    )
    refuse_unknown(scene.requirements, Owner.GAP, [gap.name for gap in scene.gaps])
    return _with_shared(scene, data.get("set", ()))


def _around_rotors(components: Mapping[str, Any], folder: Path) -> list[object]:
    """The gaps that rotors' files have."""
    found: list[object] = []
    for name, part in components.items():
        fmu = as_table(part).get("fmu")
        path = folder / fmu if isinstance(fmu, str) and fmu.endswith(".toml") else None
        if path is not None and os.path.isfile(path):
            found += of_rotor(name, _toml(path, "rotor").get("gap"))
    return found


def _with_events(components: Mapping[str, ComponentSpec], top: Table) -> dict[str, ComponentSpec]:
    """`components` with the events as their settings. Raises TouchdownError where one has its own."""
    event_tables = top.tables("event")
    found = settings_at_times(event_tables)
    for t, event in zip(event_tables, found, strict=True):
        if event.component not in components:
            there = one_of(event.component, components)
            raise t.error("what", f"names a component that is not there, {event.component}; {there}")
        fixed = [key for key in components[event.component].set if key.startswith(f"{GROUP}[")]
        t.require(
            not fixed, "what", f"is of {event.component}, which is set {fixed}, too; give all as [[event]]"
        )
    return {
        key: replace(spec, set={**spec.set, **settings_of(found, key)}) for key, spec in components.items()
    }


class _Shared(NamedTuple):
    """The settings of a file's [set], and what is said of single components more exactly."""

    settings: Mapping[str, object]
    exact: frozenset[str]  # by [components] of the same file, or of one that extends it


def _exact(data: Mapping[str, Any]) -> frozenset[str]:
    """COMPONENT.NAME of all that [components] sets, run.KEY of all that [run] does."""
    of_parts = {
        f"{name}.{setting}"
        for name, part in as_table(data.get("components")).items()
        for setting in (*as_table(part), *dotted_keys(as_table(as_table(part).get("set"))))
    }
    return frozenset(of_parts | {f"run.{key}" for key in as_table(data.get("run"))})


def _with_shared(scene: Scene, layers: Sequence[_Shared]) -> Scene:
    """A scene with the settings of its files' [set], which are the scene's, not made beside it."""
    there = scene
    for layer in layers:
        for name, value in layer.settings.items():
            general = [setting for setting in scene.matching_settings(name) if setting not in layer.exact]
            there = there.set(dict.fromkeys(general, value))
    components = {name: replace(spec, own=()) for name, spec in there.components.items()}
    return replace(there, components=components, own=scene.own)


def _component(t: Table, name: str, folder: Path) -> ComponentSpec:
    """A table of [components]."""
    file = t.get("settings", TEXT, None)
    names = t.values.get("names", {})
    spec = t.read(
        ComponentSpec,
        *("preset", "settings", "set", "names"),
        set=(_settings_for(name, folder / file, t) if file is not None else {})
        | dotted_keys(t.table("set").values),
        preset=checked_preset(t.values.get("preset"), t.where[:-1], folder),
        names=read_names(folder / names) if isinstance(names, str) else _checked_names(t.table("names")),
    )
    t.require(
        not spec.sampled or "every" not in t.values, "sampled", "stands beside every; give one of them"
    )
    return spec


def read_names(path: Path) -> dict[str, str]:
    """Names of an FMU's variables from a TOML file: "journal.x" = "shaft_x". Raises TouchdownError."""
    return _checked_names(Table(f"names in {path}: ", _toml(path, "names")))


def merged_tables(path: Path, before: tuple[str, ...] = ()) -> dict[str, Any]:
    """The tables of a scene's file over those of the scene it extends; `before`: files that led here.

    Their [set] are a list, that of the first file first.
    """
    data = _toml(path, "scene")
    require(
        "components" in data or not any(key in data for key in ROTOR_TABLES),
        f"{path} is a rotor's file, not a scene; `touchdown rotor {path}` describes it, and `touchdown "
        f"new FOLDER --rotor {path} --bearings NAME` makes a machine with a scene of it",
    )
    settings = dotted_keys(Table(f"scene {path}: ", data).table("set").values)
    data["set"] = [_Shared(settings, _exact(data))]
    if "extends" not in data:
        return data
    base = str(data.pop("extends"))
    if base.endswith(".toml"):
        start = path.parent / base
    elif base in shipped_scenes():
        start = shipped_scenes()[base]
    else:
        raise TouchdownError(f"scene {path}: extends = {base!r}: {one_of(base, shipped_scenes())}")
    require(
        os.path.realpath(start) not in (*before, os.path.realpath(path)),
        f"scene {path}: extends = {base!r} leads back to itself",
    )
    require(
        len(before) < MAX_LAYERS, f"scene {path} is the last of more than {MAX_LAYERS} that extend others"
    )
    under = merged_tables(start, (*before, os.path.realpath(path)))
    exact = _exact(data)
    layers = [layer._replace(exact=layer.exact | exact) for layer in under["set"]]
    return _over(under, data) | {"set": [*layers, *data["set"]]}


def read_settings(path: Path) -> dict[str, object]:
    """Settings by name from the [set] of a TOML file. Raises TouchdownError."""
    top = Table(f"settings {path}: ", _toml(path, "settings"))
    top.only(("title", "set"))
    if not (found := dotted_keys(top.table("set").values)):
        raise TouchdownError(f'settings {path} set nothing; add such as [set."housing_*"]')
    return found


def _settings_for(name: str, path: Path, t: Table) -> dict[str, object]:
    """The [set] of a file for the component `name`. Raises TouchdownError where it has nothing."""
    found: dict[str, object] = {}
    for setting, value in read_settings(path).items():
        component, _, variable = setting.partition(".")
        if variable and fnmatchcase(name, component):
            found[variable] = value
    t.require(found, "settings", f"says nothing of {name}")
    return found


def _toml(path: Path, what: str) -> dict[str, Any]:
    """The tables of a TOML file. Raises TouchdownError, as all that follows."""
    return toml_of(text_of(path, what, MAX_FILE_BYTES), f"{what} {path}")


def _over(base: Mapping[str, Any], changes: Mapping[str, Any]) -> dict[str, Any]:
    """`base` with `changes` put in, nested tables likewise, unless they name another FMU."""
    merged = dict(base)
    for key, value in changes.items():
        there = merged.get(key)
        if key == "gap" and key in merged:
            merged[key] = laid_over(there, value)
        elif not is_table(there) or not is_table(value) or "fmu" in value:
            merged[key] = value
        else:
            merged[key] = _over(there, value)
    return merged


def _checked_names(t: Table) -> dict[str, str]:
    """Of a component's variables: those of the contract, and what its FMU calls them."""
    table = Table(t.where, dotted_keys(t.values))
    names = {
        name: table.get(name, Kind(TEXT.take, 'text, such as "journal.x" = "shaft_x"'))
        for name in table.values
    }
    for name in names:
        table.require(list(names.values()).count(names[name]) <= 1, name, "is given twice")
    return names


def read_resolved(path: Path) -> Scene:
    """The scene in a scene.json. Raises TouchdownError where it is missing or cannot be read as one."""
    try:
        values = json_of(text_of(path, "scene"), f"scene {path}")
        return restored(values)
    except TouchdownError as error:
        where = "" if str(path) in str(error) else f"scene {path}: "
        raise TouchdownError(f"{where}{error}") from None
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        what = f"{type(error).__name__}: {error}"
        raise TouchdownError(f"scene {path} is not as a run leaves it ({what}); give a .toml") from None


LATER = (
    "control",
    "document",
    INCLINATION,
    "gaps",
    "remarks",
    "requirements",
    "sampled",
)  # keys that may be missing


def restored(values: Mapping[str, Any]) -> Scene:
    """The scene whose `resolved()` gives `values`, lists taken as tuples and paths as text.

    Raises TouchdownError, KeyError or TypeError where they are not such values.
    """
    top = _complete(Table("", values), Scene)
    require(
        all(is_table(gap) for gap in top.get("gaps", LIST, ())),
        "an earlier version left it; run the scene again",
    )
    set_by_user = tuple(values["own"])
    Table("own.", dict.fromkeys(set_by_user)).only((*kinds(RunSpec),))
    stated = {key: v for key, v in values.items() if v is not None or key not in ("zero", INCLINATION)}
    components = top.table("components")
    return Table("", stated).read(
        Scene,
        *("components", "name", "title", "own", "run", "folder", "gaps", "requirements", "document"),
        name=top.get("name", TEXT),
        title=top.get("title", TEXT),
        components={name: _restored_component(components.table(name)) for name in components.values},
        connect=top.get("connect", listed(LEFT_WIRE)),
        bond=top.get("bond", listed(LEFT_BOND)),
        own=set_by_user,
        run=with_changes(RunSpec(), top.get("run", TABLE)),
        folder=Path(values["folder"]),
        gaps=tuple(_whole(gap).read(RotorGap) for gap in top.tables("gaps")),
        requirements=tuple(Requirement(*one) for one in values.get("requirements", ())),
        document=top.table("document").read(Document),
    )


def _whole(t: Table) -> Table:
    """A table that a run left, without the keys that nothing was given for."""
    return Table(t.where, {key: value for key, value in t.values.items() if value is not None})


def _complete(t: Table, declared: type) -> Table:
    """A table that a run left. Raises TouchdownError where it lacks a key: no default is what was run.

    Keys that runs of earlier versions did not know may be missing.
    """
    for one in fields(declared):
        known = one.name in t.values or one.name in LATER
        t.require(known, one.name, "is missing; a run leaves all keys")
    return t


def _restored_component(t: Table) -> ComponentSpec:
    set_by_user, settings = tuple(_complete(t, ComponentSpec).values["own"]), t.get("set", TABLE)
    Table(f"{t.where}own.", dict.fromkeys(set_by_user)).only((*settings, "preset"))
    names = t.table("names")
    return t.read(
        ComponentSpec,
        *("set", "preset", "names", "inherited", "instead_of", "own"),
        set=settings,
        preset=None if t.values["preset"] is None else t.get("preset", TEXT),
        names={name: names.get(name, TEXT) for name in names.values},
        inherited=t.get("inherited", TABLE),
        instead_of=t.get("instead_of", TEXT),
        sampled=t.get("sampled", number("s", minimum=0.0), 0.0),
        own=set_by_user,
    )


def _wire(value: Any, name: str) -> Wire:
    source, target, scale = LIST.take(value, name)
    ends = (naming().read(source, name), naming().read(target, name))
    if scale is None:
        return Wire(*ends)
    factor, offset = (number().read(one, name) for one in LIST.take(scale, name))
    return Wire(*ends, (factor, offset))


def _bond(value: Any, name: str) -> BondSpec:
    force, position, velocity, motion = LIST.take(value, name)
    place, speed = (None if one is None else LEFT_WIRE.read(one, name) for one in (position, velocity))
    return BondSpec(LEFT_WIRE.read(force, name), place, speed, listed(LEFT_WIRE).read(motion, name))


LEFT_WIRE = Kind(_wire, "source, target, and null or factor and offset")
LEFT_BOND = Kind(_bond, "the wires of force, position and velocity, and a list of others")
