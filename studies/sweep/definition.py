"""The definition of a sweep: its scene, the settings it varies, its points.

A definition is kept in the sweep's folder as sweep.json, so that the sweep can go on, and be read
by programs. Two sweeps are the same where all that changes a number is.
"""

from __future__ import annotations

import fnmatch
import hashlib
import json
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, cast

from ...fmus.version import VERSION
from ...master.common.errors import TouchdownError, one_of
from ...master.components.component import SETTABLE
from ...master.components.loading import locate_fmu
from ...master.coupling.assembly import checked_value
from ...master.coupling.grades import grades
from ...master.coupling.simulation import open_system, opened
from ...master.coupling.system import System
from ...master.results.resume import STATE_FILE, Earlier
from ...master.results.summary import refuse_unknown_seats
from ...master.scene.file import restored
from ...master.scene.run_spec import UNITS
from ...master.scene.scene import Scene
from ...master.scene.tables import naming
from ...modelkit.errors import require
from ...modelkit.kernel.writing import write
from ...modelkit.reader import (
    FIGURE,
    FLAG,
    TABLE,
    TEXT,
    Kind,
    Table,
    json_of,
    key,
    listed,
    maybe,
    row,
    text_of,
)
from .design import Design

DEFINITION_FILE = "sweep.json"
# of a scene, and of a definition: they change no number
IGNORED_FIELDS = ("name", "title", "about", "document", "folder", "own")
IGNORED_DEFINITION_FIELDS = ("about", "values", "changes", "run_changes", "earlier")
VALUE = Kind(
    lambda value, name: value if isinstance(value, (str, bool)) else FIGURE.take(value, name),
    "a finite number, text or a truth value",
)
COMPONENT_SETTINGS = (
    "preset",
    "law",
    "every",
    "isolate",
    "native",
)  # said of a component, not a variable of it
MAX_DIFFERENCES = 3  # differences that are told


@dataclass(frozen=True)
class Column:
    """A setting that varies."""

    name: str = key(TEXT)  # as it was asked for
    settings: tuple[str, ...] = key(listed(naming("a setting")))  # all that take its value
    unit: str | None = key(maybe(TEXT))  # SI; None for words


@dataclass(frozen=True)
class Definition:
    """A sweep's definition."""

    columns: tuple[Column, ...]
    points: Sequence[Sequence[object]]  # as they were given, by column
    values: Sequence[Sequence[object]]  # the same in SI, or as words
    version: str = key(TEXT)
    scene: Mapping[str, Any] = key(TABLE)  # as plain values
    scheme: Mapping[str, Any] = key(TABLE)
    made_of: Mapping[str, str] = key(TABLE)  # by component: a hash over its file, or over own sources
    in_process: bool = key(FLAG)
    about: str = key(TEXT)  # how the points were chosen
    changes: tuple[str, ...] = key(listed(TEXT))  # what was set in components beside the scene, for people
    run_changes: tuple[str, ...] = key(listed(TEXT))  # the same, in [run]
    earlier: str = key(TEXT, "")  # folder of the run at whose end all points start; "": there is none

    @property
    def numbers(self) -> range:
        """Of the points, from 1."""
        return range(1, len(self.points) + 1)

    def settings(self, number: int) -> dict[str, object]:
        """Of a point: values as they were given, by the name of their column."""
        return {c.name: value for c, value in zip(self.columns, self.points[number - 1], strict=True)}

    def bare_units(self) -> list[tuple[str, str]]:
        """Name and SI unit of each setting that has a unit and whose values were given without one."""
        stated = zip(self.columns, zip(*self.points, strict=True), strict=True)
        united = [(column, values) for column, values in stated if column.unit not in (None, "", "1")]
        bare = re.compile(r"[-+.\deE]+")
        return [
            (c.name, str(c.unit)) for c, values in united if any(bare.fullmatch(str(v)) for v in values)
        ]

    @property
    def by_number(self) -> dict[int, dict[str, object]]:
        """The settings of all points."""
        return {number: self.settings(number) for number in self.numbers}

    def at(self, scene: Scene, number: int) -> Scene:
        """The scene at a point."""
        pairs = zip(self.columns, self.points[number - 1], strict=True)
        return scene.set({setting: value for column, value in pairs for setting in column.settings})

    def write(self, folder: Path) -> None:
        """Write it into `folder`. Raises OSError."""
        write(folder / DEFINITION_FILE, json.dumps(asdict(self), default=str) + "\n")


def define(scene: Scene, design: Design, in_process: bool, earlier: Earlier | None = None) -> Definition:
    """A sweep of `scene`, all from the end of an `earlier` run.

    Raises TouchdownError where a setting cannot be, cannot take a value, or stays what it was there.
    """
    targets = _targets(scene, design)
    at_first = zip(targets, design.points[0], strict=True)
    first = scene.set({setting: value for settings, value in at_first for setting in settings})
    with opened(first, in_process=True) as system:
        refuse_unknown_seats(scene, system)
        columns = [
            Column(name, settings, _unit(system, settings[0]))
            for name, settings in zip(design.names, targets, strict=True)
        ]
        _refuse_graded(first, columns)
        values = _si_points(first, system, columns, design)
        if earlier:
            _refuse_fixed(scene, columns, design, system, earlier)
        changes = scene.changes(lambda component, key: system.components[component].variable(key).unit)
    plain = json.loads(json.dumps(scene.resolved(), default=str))
    state = {STATE_FILE: _content(earlier.folder / STATE_FILE)} if earlier else {}
    return Definition(
        version=VERSION,
        scene=plain,
        scheme=asdict(scene.run.scheme),
        made_of=_origins(scene) | _varied_catalogues(scene, columns, design) | state,
        in_process=in_process,
        about=design.about,
        columns=tuple(columns),
        points=design.points,
        values=values,
        changes=tuple(changes),
        run_changes=tuple(scene.run_changes()),
        earlier=str(earlier.folder) if earlier else "",
    )


def _refuse_graded(scene: Scene, columns: Sequence[Column]) -> None:
    """Raise TouchdownError where a rotor's speed varies, and with it what a grade of balance permits."""
    for setting in (one for column in columns for one in column.settings):
        name, _, variable = setting.partition(".")
        graded = grades(scene.components[name]) if variable == "speed" else {}
        for unbalance, grade in graded.items():
            raise TouchdownError(
                f"{setting} varies, and with it what {name}.{unbalance} = 'G{grade:g}' permits: every drop "
                "would be of another rotor; set it as a number"
            )


def _refuse_fixed(
    scene: Scene, columns: Sequence[Column], design: Design, system: System, earlier: Earlier
) -> None:
    """Raise TouchdownError where a point has what a run that goes on from `earlier` cannot change."""
    nowhere = earlier.folder / "another"
    for point in design.points:
        pairs = zip(columns, point, strict=True)
        settings = {setting: value for column, value in pairs for setting in column.settings}
        earlier.resumed(scene.set(settings), system, nowhere)


def _origins(scene: Scene) -> dict[str, str]:
    """By component: a hash over what it is made of, files' content or the project's own sources."""
    found: dict[str, str] = {}
    for name, spec in scene.components.items():
        source = locate_fmu(spec.fmu, scene.folder)
        found[name] = _content(source) if isinstance(source, Path) else source.content
        found[name] += "".join(_own_catalogue(scene, spec.preset).values())
    return found


def _varied_catalogues(scene: Scene, columns: Sequence[Column], design: Design) -> dict[str, str]:
    """By file: a hash over each of the user's own that a preset or a controller's law varies over."""
    found: dict[str, str] = {}
    for place, column in enumerate(columns):
        component, _, variable = column.settings[0].partition(".")
        if variable in ("preset", "law"):
            for value in dict.fromkeys(str(point[place]) for point in design.points):
                varied = scene.set({f"{component}.{variable}": value}).components[component]
                found |= _own_catalogue(scene, varied.preset)
                found |= {value: _content(Path(varied.fmu))} if variable == "law" else {}
    return found


def _own_catalogue(scene: Scene, preset: str | None) -> dict[str, str]:
    """By name, a hash over the user's own catalogue that a preset is from; nothing of another one."""
    file, _, _ = (preset or "").rpartition(":")
    return {Path(file).name: _content(scene.folder / file)} if file else {}


def _content(path: Path) -> str:
    return hashlib.sha256(path.read_bytes() if path.is_file() else b"").hexdigest()


# -- names and values --------------------------------------------------------------------------------


def _targets(scene: Scene, design: Design) -> list[tuple[str, ...]]:
    """By column: the settings that its name means. Raises TouchdownError where it means none."""
    targets: list[tuple[str, ...]] = []
    for name in design.names:
        settings = [one for part in name.split(",") for one in _matching(scene, part.strip())]
        targets.append(tuple(dict.fromkeys(settings)))
    every = [setting for settings in targets for setting in settings]
    if twice := [setting for setting in every if every.count(setting) > 1]:
        raise TouchdownError(f"{twice[0]} varies twice; give it once")
    return targets


def _matching(scene: Scene, name: str) -> list[str]:
    """The settings that a name with * or ? means; another name means itself."""
    component, _, variable = name.partition(".")
    if not any(sign in variable for sign in "*?"):
        return scene.matching_settings(name)
    components = scene.matching(component)
    known = [full for full in _settable(scene) if full.partition(".")[0] in components]
    found = fnmatch.filter(known, name)
    if not found:
        raise TouchdownError(f"no component has a setting {name}; {one_of(name, known)}")
    return found


def _settable(scene: Scene) -> list[str]:
    """All numbers of all components that can be set."""
    with opened(scene, in_process=True) as system:
        return [
            f"{name}.{variable.name}"
            for name, component in system.components.items()
            for variable in component.variables.values()
            if variable.settable and variable.kind in SETTABLE
        ]


def _unit(system: System, setting: str) -> str | None:
    """The SI unit of a setting; None for one that is not a number."""
    component, _, variable = setting.partition(".")
    if component == "run":
        return UNITS.get(variable)
    found = system.components[component].variables.get(variable)
    return None if found is None or found.kind not in SETTABLE else found.unit or "1"


def _si_points(
    first: Scene, system: System, columns: Sequence[Column], design: Design
) -> list[tuple[object, ...]]:
    """All points in SI. Raises TouchdownError for a value that a setting cannot take."""
    known: dict[tuple[str, str], object] = {}

    def value(column: Column, stated: object) -> object:
        key = (column.name, repr(stated))
        if key not in known:
            taken = [_si_value(first, system, setting, stated) for setting in column.settings]
            known[key] = taken[0]
        return known[key]

    return [tuple(value(c, stated) for c, stated in zip(columns, p, strict=True)) for p in design.points]


def _si_value(first: Scene, system: System, setting: str, stated: object) -> object:
    """A value in SI, or as a word; `system` is that of the `first` point."""
    varied = first.set({setting: stated})
    component, _, variable = setting.partition(".")
    if setting == "run.scheme" or variable in ("preset", "law", "every"):  # what is connected may change
        open_system(varied, in_process=True).close()
    if component == "run":
        taken = getattr(varied.run, variable)
        return float(taken) if variable in UNITS else str(getattr(taken, "name", taken))
    if variable in COMPONENT_SETTINGS:
        return str(stated)
    return checked_value(system.components[component], variable, stated)


# -- read back ---------------------------------------------------------------------------------------


def read_definition(folder: Path) -> Definition:
    """The definition of the sweep in `folder`. Raises TouchdownError where none can be read."""
    path = folder / DEFINITION_FILE
    if not path.exists():
        raise TouchdownError(f"there is no sweep in {folder}: it has no {DEFINITION_FILE}")
    top = Table("", json_of(text_of(path), str(path)))
    try:
        restored(top.get("scene", TABLE))
        columns = tuple(one.read(Column) for one in top.tables("columns"))
        points = listed(row(*[VALUE] * len(columns)))
        more = {name: top.get(name, points) for name in ("points", "values")}
        read = top.read(Definition, "columns", *more, columns=columns, **more)
        require(all(column.settings for column in columns), "a column sets nothing")
        require(len(read.points) == len(read.values), "there are more points than values of them, or less")
        return read
    except (TouchdownError, ValueError, TypeError, KeyError) as error:
        raise TouchdownError(
            f"{path} cannot be read; it is of another version, or damaged ({error}). Take another folder"
        ) from None


def differences(kept: Definition, asked: Definition) -> list[str]:
    """The differences between two sweeps, in words; empty where they are the same."""
    one, other = _compared(kept), _compared(asked)
    if len(kept.points) != len(asked.points):  # told by their number
        del one["point"], other["point"]
    lines = list(_differences(one, other, ""))
    return (
        lines
        if len(lines) <= MAX_DIFFERENCES
        else [*lines[:MAX_DIFFERENCES], f"and {len(lines) - MAX_DIFFERENCES} more"]
    )


def refuse_other(folder: Path, kept: Definition, asked: Definition) -> None:
    """Raise TouchdownError where the sweep in `folder` is another one than is asked for."""
    found = differences(kept, asked)
    require(
        not found,
        f"{folder} holds another sweep: {'; '.join(found)}. Choose another folder with -o, or start "
        "anew with --anew",
    )


def _compared(definition: Definition) -> dict[str, Any]:
    """All of it that changes a number, as JSON has it."""
    plain = cast(dict[str, Any], json.loads(json.dumps(asdict(definition), default=str)))
    scene, columns = plain.pop("scene"), plain.pop("columns")
    for ignored in IGNORED_DEFINITION_FIELDS:
        del plain[ignored]
    points = plain.pop("points")
    for limit in ("time_limit", "call_timeout"):  # they change no number
        scene["run"].pop(limit, None)
    for component in scene["components"].values():
        del component["own"]  # where a value was given changes no number
    names = [column["name"] for column in columns]
    return {
        **plain,
        **{key: value for key, value in scene.items() if key not in IGNORED_FIELDS},
        "varied": ", ".join(names),
        "settings": {column["name"]: ", ".join(column["settings"]) for column in columns},
        "number of points": len(points),
        "point": {str(i): dict(zip(names, row, strict=True)) for i, row in enumerate(points, start=1)},
    }


def _differences(kept: Any, asked: Any, where: str) -> Iterator[str]:
    if isinstance(kept, dict) and isinstance(asked, dict):
        for key in dict.fromkeys((*kept, *asked)):
            deeper = _differences(kept.get(key), asked.get(key), f"{where}.{key}" if where else key)
            yield from deeper
    elif kept != asked:
        yield _difference(where, kept, asked)


def _difference(where: str, kept: object, asked: object) -> str:
    if where.startswith("made_of."):
        return f"what {where.partition('.')[2]} is made of has changed"
    name = where.removeprefix("components.").replace(".set.", ".", 1)
    if name.startswith("point."):
        _, number, name = name.split(".", 2)
        name = f"{name} of point {number}"
    return f"{name} is {_or_not_set(kept)} there and {_or_not_set(asked)} here"


def _or_not_set(value: object) -> object:
    return "not set" if value is None else value
