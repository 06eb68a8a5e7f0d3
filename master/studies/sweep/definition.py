"""What a sweep was asked to do: its scene, the settings it varies, its points.

People write the values of a variable as

rotor.speed=6000 rpm,9000 rpm            a list; a unit at its end is everyone's
bearing.clearance=0.2,0.25,0.3 mm
bearing.balls.first_angle=0:315:8 deg    from 0 to 315, both included, 8 values
run.scheme=hold,interface                words, where a setting is a word
a.mass,b.mass=1,2 kg                     several settings have the same value
bearing_*.friction.dynamic=0.1,0.2       so do all that match

and a range to draw from by its two ends, with the unit of both:

rotor.speed=6000:12000 rpm

A definition is kept in the sweep's folder as sweep.json, so that the sweep can go on, be merged with
others, and be read by programs. Two sweeps are the same where all that changes a number is.
"""

from __future__ import annotations

import csv
import fnmatch
import hashlib
import itertools
import json
import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any, cast

import numpy as np

from ....fmus.version import VERSION
from ...common.errors import TouchdownError, as_list, one_of
from ...common.files import replace_text
from ...common.units import plain
from ...components.component import SETTABLE
from ...components.loading import locate
from ...coupling.assembly import checked
from ...coupling.simulation import open_system, opened
from ...coupling.system import System
from ...scene.run_spec import UNITS
from ...scene.scene import Scene


@dataclass(frozen=True)
class Method:
    """A way to spread points."""

    title: str
    draw: Callable[[int, int, np.random.Generator], np.ndarray]  # dimensions, count
    powers_of_two: bool = False  # only so many points are balanced


def _random(dimensions: int, count: int, source: np.random.Generator) -> np.ndarray:
    return source.random((count, dimensions))


def _latin(dimensions: int, count: int, source: np.random.Generator) -> np.ndarray:
    from scipy.stats import qmc  # slow to import

    return qmc.LatinHypercube(dimensions, rng=source).random(count)


def _sobol(dimensions: int, count: int, source: np.random.Generator) -> np.ndarray:
    from scipy.stats import qmc

    return qmc.Sobol(dimensions, rng=source).random(count)


RANDOM = Method("a random sample", _random)
LATIN = Method("a Latin hypercube", _latin)
SOBOL = Method("a Sobol sequence", _sobol, powers_of_two=True)


def unit_cube(method: Method, dimensions: int, count: int, seed: int) -> np.ndarray:
    """Points (count, dimensions) between 0 and 1; equal for equal seeds. Raises TouchdownError."""
    if count < 1:
        raise TouchdownError(f"a sample of {count} points is none; ask for 1 at least")
    if seed < 0:
        raise TouchdownError(f"seed = {seed} must be a whole number, 0 or above")
    if method.powers_of_two and count & (count - 1):
        below = 2 ** (count.bit_length() - 1)
        raise TouchdownError(
            f"{count} points of a Sobol sequence are not balanced; ask for a power of 2: {below} or "
            f"{2 * below}"
        )
    return method.draw(dimensions, count, np.random.default_rng(seed))


def read_points(path: Path) -> Design:
    """The design in the file at `path`, whose columns are called NAME or NAME [UNIT].

    Raises TouchdownError where it cannot be read, a column is no setting, or a cell is empty.
    """
    try:
        with path.open(newline="", encoding="utf-8-sig") as file:
            rows = [row for row in csv.reader(file) if any(cell.strip() for cell in row)]
    except (OSError, ValueError, csv.Error) as error:
        why = error.strerror if isinstance(error, OSError) else str(error)
        raise TouchdownError(f"cannot read {path}: {why}") from None
    if len(rows) < 2:
        raise TouchdownError(f"{path} has no points; write a line of settings, and a line for each point")
    columns = [_column(title, path) for title in rows[0]]
    names = [name for name, _ in columns]
    if twice := [name for name in names if names.count(name) > 1]:
        raise TouchdownError(f"{path}: {twice[0]} has two columns; give it one")
    for number, row in enumerate(rows[1:], start=1):
        if len(row) != len(columns) or not all(cell.strip() for cell in row):
            raise TouchdownError(f"{path}: point {number} must have a value in all {len(columns)} columns")
    return Design.tied(
        {
            name: [_with_unit(row[place].strip(), unit) for row in rows[1:]]
            for place, (name, unit) in enumerate(columns)
        }
    )


def _with_unit(cell: str, unit: str) -> str:
    """A number in the column's unit, unless it has its own; a word as it is."""
    parts = number_and_unit(cell)
    return f"{cell} {unit}".strip() if parts and not parts[1] else cell


def _column(title: str, path: Path) -> tuple[str, str]:
    """Name and unit of NAME or NAME [UNIT]."""
    name, _, rest = (part.strip() for part in title.partition("["))
    if "." not in name:
        raise TouchdownError(
            f"{path}: the column {title.strip()!r} is no setting; call it COMPONENT.VARIABLE [UNIT] or "
            "run.KEY [UNIT]"
        )
    return name, rest.removesuffix("]").strip()


MAX_VALUES = 100_000  # values of one variable; more is a slip of the pen


@dataclass(frozen=True)
class Variation:
    """A setting of a scene, COMPONENT.VARIABLE or run.KEY, and its values: text, with a unit if any."""

    name: str
    values: tuple[str, ...]


def parse(text: str, option: str = "--vary") -> Variation:
    """NAME=VALUE,VALUE... or NAME=START:STOP:COUNT, with a unit at the end. Raises TouchdownError."""
    what = f"{option} {text}"
    name, equals, right = (part.strip() for part in text.partition("="))
    if not equals or not name:
        raise TouchdownError(f"{what}: write NAME=VALUE,VALUE,... or NAME=START:STOP:COUNT[:log]")
    if not right:
        raise TouchdownError(f"{what}: the list of values is empty")
    is_range = ":" in right and ".toml:" not in right  # a preset may be DEFINITION_FILE.toml:NAME
    return Variation(name, _evenly(right, what) if is_range else listed(right, what))


def parse_all(texts: Iterable[str], option: str = "--vary") -> dict[str, tuple[str, ...]]:
    """Values by name, given with `option`. Raises TouchdownError where a name comes twice."""
    variations: dict[str, tuple[str, ...]] = {}
    for text in texts:
        variation = parse(text, option)
        if variation.name in variations:
            raise TouchdownError(
                f"{option} {variation.name} is given twice; write all its values in one list"
            )
        variations[variation.name] = variation.values
    return variations


def number_and_unit(value: object) -> tuple[float, str] | None:
    """Both parts of a value; None for a word."""
    head, _, unit = str(value).strip().partition(" ")
    try:
        return float(head), unit.strip()
    except ValueError:
        return None


def listed(text: str, what: str) -> tuple[str, ...]:
    """Values with commas between them; a unit at the end is everyone's. `what`: for a complaint."""
    items = [item.strip() for item in text.split(",")]
    if not all(items):
        raise TouchdownError(f"{what}: a value is missing between the commas")
    parts = [number_and_unit(item) for item in items]
    last = parts[-1]
    if last is None or not last[1]:
        return tuple(items)
    bare = [part is not None and not part[1] for part in parts]
    return tuple(f"{item} {last[1]}" if alone else item for item, alone in zip(items, bare, strict=True))


@dataclass(frozen=True)
class Range:
    """Values from `low` to `high`, in `unit` ("": SI)."""

    low: float
    high: float
    unit: str

    def at(self, part: float) -> str:
        """The value at a part (0 to 1) of the way, as text with its unit."""
        return with_unit(self.low + part * (self.high - self.low), self.unit)


def parse_range(text: str, what: str) -> Range:
    """LOW:HIGH, with a unit at the end. `what`: for a complaint. Raises TouchdownError."""
    head, _, unit = text.strip().partition(" ")
    try:
        low, high = (float(part) for part in head.split(":"))
    except ValueError:
        raise TouchdownError(f"{what}: write LOW:HIGH, then the unit, such as 6000:12000 rpm") from None
    if not np.isfinite([low, high]).all() or not low < high:
        raise TouchdownError(f"{what}: LOW must be below HIGH, and both finite")
    return Range(low, high, unit.strip())


def with_unit(number: float, unit: str) -> str:
    """As text, in twelve digits."""
    return f"{number:.12g} {unit}".strip()


LOGARITHMIC = "log"  # ends a range whose values have even ratios


def _evenly(right: str, what: str) -> tuple[str, ...]:
    head, _, unit = right.partition(" ")
    head, even, logarithmic = head.partition(f":{LOGARITHMIC}")
    parts = head.split(":")
    if len(parts) != 3 or ":" in unit or logarithmic:
        raise TouchdownError(
            f"{what}: write START:STOP:COUNT, then the unit, such as 0:315:8 deg; or 1:100:5:log kN/m"
        )
    try:
        start, stop, count = (float(part) for part in parts)
    except ValueError:
        raise TouchdownError(f"{what}: START, STOP and COUNT must be numbers") from None
    if not np.isfinite([start, stop, count]).all():
        raise TouchdownError(f"{what}: START, STOP and COUNT must be finite numbers")
    if count != int(count) or not 1 <= count <= MAX_VALUES:
        raise TouchdownError(f"{what}: COUNT must be a whole number from 1 to {MAX_VALUES}")
    if even and not min(start, stop) > 0.0:
        raise TouchdownError(f"{what}: START and STOP must be above 0 for even ratios ({LOGARITHMIC})")
    between = np.geomspace if even else np.linspace
    return tuple(with_unit(value, unit.strip()) for value in between(start, stop, int(count)))


MAX_POINTS = 100_000  # points; weeks of drops

Ranges = Mapping[str, str | tuple[float, float] | Range]


@dataclass(frozen=True)
class Design:
    """Points of a study: values of settings that are run together, numbered from 1 in their order.

    A setting is COMPONENT.VARIABLE or run.KEY, several with commas between them, or a name in which *
    stands for anything: all of them take the same value. Values are as `Scene.set` takes them. Designs
    multiply: `a * b` runs every point of `a` at every point of `b`.

    >>> phases = touchdown.Design.grid({"rotor.unbalance_angle": ["0 deg", "90 deg", "180 deg", "270 deg"]})
    >>> design = touchdown.Design.sobol({"bearing.clearance": "0.2:0.3 mm"}, 8, seed=1) * phases
    >>> len(design), design.about
    (32, '8 points of a Sobol sequence, seed 1; 4 points of a grid')
    >>> [len(design.shard(k, 3)) for k in (1, 2, 3)]
    [11, 11, 10]
    """

    names: tuple[str, ...]
    points: tuple[tuple[object, ...], ...]  # values of `names`
    about: str  # how they were chosen, in words
    part: tuple[int, int] = (1, 1)  # (2, 8): every eighth point from the second on is this design's own

    @classmethod
    def grid(cls, variations: Mapping[str, object]) -> Design:
        """Every combination of the values of each setting: a list, an array or a single one.

        Raises TouchdownError where there are none, or too many.
        """
        values = _values(variations)
        count = math.prod(len(given) for given in values.values())
        _refuse_too_many(count)
        points = tuple(itertools.product(*values.values()))
        return cls(tuple(values), points, f"{_points(count)} of a grid")

    @classmethod
    def tied(cls, columns: Mapping[str, object]) -> Design:
        """Settings that vary together: the first values of all, the second values of all, and so on.

        Raises TouchdownError where one has more values than another.
        """
        values = _values(columns)
        counts = {name: len(given) for name, given in values.items()}
        if len(set(counts.values())) > 1:
            lengths = ", ".join(f"{name} {count}" for name, count in counts.items())
            raise TouchdownError(
                f"settings that vary together need equally many values; there are: {lengths}"
            )
        points = tuple(zip(*values.values(), strict=True))
        _refuse_too_many(len(points))
        return cls(tuple(values), points, f"{_points(len(points))} of a list")

    @classmethod
    def table(cls, rows: Iterable[Mapping[str, object]]) -> Design:
        """A point per row, each of which gives the same settings. Raises TouchdownError where not."""
        listed = list(rows)
        names = tuple(listed[0]) if listed else ()
        for number, row in enumerate(listed, start=1):
            if set(row) != set(names):
                odd = ", ".join(sorted(set(row) ^ set(names)))
                raise TouchdownError(f"point {number} gives other settings than the first: {odd}")
        return cls.tied({name: [row[name] for row in listed] for name in names})

    @classmethod
    def random(cls, ranges: Ranges, count: int, seed: int = 0) -> Design:
        """`count` points drawn evenly from `ranges`: LOW:HIGH UNIT as text, or two numbers in SI."""
        return cls._drawn(RANDOM, ranges, count, seed)

    @classmethod
    def latin(cls, ranges: Ranges, count: int, seed: int = 0) -> Design:
        """A Latin hypercube: each range has `count` equal parts, and a point in each of them."""
        return cls._drawn(LATIN, ranges, count, seed)

    @classmethod
    def sobol(cls, ranges: Ranges, count: int, seed: int = 0) -> Design:
        """The first `count` points, a power of 2, of a scrambled Sobol sequence."""
        return cls._drawn(SOBOL, ranges, count, seed)

    @classmethod
    def _drawn(cls, method: Method, ranges: Ranges, count: int, seed: int) -> Design:
        if not ranges:
            raise TouchdownError("a sample needs a range at least, such as rotor.speed=6000:12000 rpm")
        _refuse_too_many(count)
        spans = {name: _span(name, given) for name, given in ranges.items()}
        parts = unit_cube(method, len(spans), count, seed)
        points = tuple(
            tuple(span.at(part) for span, part in zip(spans.values(), row, strict=True)) for row in parts
        )
        return cls(tuple(spans), points, f"{_points(count)} of {method.title}, seed {seed}")

    def shard(self, number: int, of: int) -> Design:
        """Every point whose turn it is when `of` take turns, for the one of that `number`, from 1."""
        if not 1 <= number <= of:
            numbers = f"1/{of} to {of}/{of}" if of > 0 else "K/N with N above 0"
            raise TouchdownError(f"shard {number} of {of}: write {numbers}, such as 3/8")
        if number > len(self.points):
            raise TouchdownError(f"shard {number} of {of} has no point: there are {len(self.points)}")
        return replace(self, part=(number, of))

    @property
    def numbers(self) -> range:
        """Of the points that are its own, from 1."""
        return numbers_of(self.part, len(self.points))

    def point(self, number: int) -> dict[str, object]:
        """Values by setting."""
        return dict(zip(self.names, self.points[number - 1], strict=True))

    def __len__(self) -> int:
        return len(self.numbers)

    def __mul__(self, other: Design) -> Design:
        twice = [name for name in self.names if name in other.names]
        if twice:
            raise TouchdownError(f"{twice[0]} varies twice; give it once")
        _refuse_too_many(len(self.points) * len(other.points))
        points = tuple(mine + theirs for mine in self.points for theirs in other.points)
        return Design(self.names + other.names, points, f"{self.about}; {other.about}")


def numbers_of(part: tuple[int, int], count: int) -> range:
    """Of the points, from 1, that a part such as (2, 8) has of `count` points."""
    number, of = part
    return range(number, count + 1, of)


def designed(variations: Design | Mapping[str, object] | Iterable[Mapping[str, object]]) -> Design:
    """A design as it is, values of settings as a grid, rows of settings as a table."""
    if isinstance(variations, Design):
        return variations
    if isinstance(variations, Mapping):
        return Design.grid(cast(Mapping[str, object], variations))
    return Design.table(variations)


def _values(given: Mapping[str, object]) -> dict[str, Sequence[object]]:
    """Lists of plain values. Raises TouchdownError where there are none."""
    if not given:
        raise TouchdownError("nothing varies; name at least one setting")
    values: dict[str, Sequence[object]] = {}
    for name, listed in given.items():
        values[name] = listed if isinstance(listed, range) else [plain(value) for value in as_list(listed)]
        if not values[name]:
            raise TouchdownError(f"{name} has no values to vary over")
    return values


def _span(name: str, given: str | tuple[float, float] | Range) -> Range:
    if isinstance(given, Range):
        return given
    text = given if isinstance(given, str) else ":".join(str(float(end)) for end in given)
    return parse_range(text, f"{name} = {given}")


def _points(count: int) -> str:
    return f"{count} point{'' if count == 1 else 's'}"


def _refuse_too_many(count: int) -> None:
    if count > MAX_POINTS:
        raise TouchdownError(
            f"a sweep of {count} members is too large, at most {MAX_POINTS} are possible; vary fewer "
            "settings, or over fewer values"
        )


DEFINITION_FILE = "sweep.json"
IGNORED_FIELDS = ("name", "title", "about", "folder", "own")  # of a scene: they change no number
IGNORED_DEFINITION_FIELDS = ("about", "values", "changes", "run_changes")  # of a definition: the same
NEEDED_FIELDS = ("name", "title", "run", "components")  # of a scene, by what reads a sweep
COMPONENT_SETTINGS = ("preset", "every", "isolate", "native")  # said of a component, not a variable of it
MAX_DIFFERENCES = 3  # differences that are told


@dataclass(frozen=True)
class Column:
    """A setting that varies."""

    name: str  # as it was asked for
    settings: tuple[str, ...]  # all that take its value
    unit: str | None  # SI; None for words


@dataclass(frozen=True)
class Definition:
    """What is asked."""

    version: str
    scene: Mapping[str, Any]  # as plain values
    scheme: Mapping[str, Any]
    made_of: Mapping[str, str]  # by component: a hash over its file, or the project's own sources
    in_process: bool
    about: str  # how the points were chosen
    columns: tuple[Column, ...]
    points: Sequence[Sequence[object]]  # as they were given, by column
    values: Sequence[Sequence[object]]  # the same in SI, or as words
    part: tuple[int, int]  # (2, 8): it runs every eighth point from the second on
    changes: tuple[str, ...]  # what was set in components beside the scene, for people
    run_changes: tuple[str, ...]  # the same, in [run]

    @property
    def numbers(self) -> range:
        """Of the points that it runs, from 1."""
        return numbers_of(self.part, len(self.points))

    @property
    def unsharded(self) -> Definition:
        """The same, that runs all points."""
        return replace(self, part=(1, 1))

    def settings(self, number: int) -> dict[str, object]:
        """Of a point: values as they were given, by the name of their column."""
        return {c.name: value for c, value in zip(self.columns, self.points[number - 1], strict=True)}

    @property
    def by_number(self) -> dict[int, dict[str, object]]:
        """The settings of all points, whoever runs them."""
        return {number: self.settings(number) for number in self.unsharded.numbers}

    def at(self, scene: Scene, number: int) -> Scene:
        """The scene at a point."""
        given = zip(self.columns, self.points[number - 1], strict=True)
        return scene.set({setting: value for column, value in given for setting in column.settings})

    def write(self, folder: Path) -> None:
        """Write it into `folder`. Raises OSError."""
        replace_text(folder / DEFINITION_FILE, json.dumps(asdict(self), default=str) + "\n")


def define(scene: Scene, design: Design, in_process: bool) -> Definition:
    """A sweep of `scene`. Raises TouchdownError where a setting cannot be, or cannot take a value."""
    targets = _targets(scene, design)
    at_first = zip(targets, design.points[0], strict=True)
    first = scene.set({setting: value for settings, value in at_first for setting in settings})
    with opened(first, in_process=True) as system:
        columns = [
            Column(name, settings, _unit(system, settings[0]))
            for name, settings in zip(design.names, targets, strict=True)
        ]
        values = _si_points(first, system, columns, design)
        changes = scene.changes(lambda component, key: system.components[component].variable(key).unit)
    plain = json.loads(json.dumps(scene.resolved(), default=str))
    return Definition(
        version=VERSION,
        scene=plain,
        scheme=asdict(scene.run.scheme),
        made_of=origins(scene) | _varied_catalogues(scene, columns, design),
        in_process=in_process,
        about=design.about,
        columns=tuple(columns),
        points=design.points,
        values=values,
        part=design.part,
        changes=tuple(changes),
        run_changes=tuple(scene.run_changes()),
    )


def origins(scene: Scene) -> dict[str, str]:
    """By component: a hash over what it is made of, files' content or the project's own sources."""
    found: dict[str, str] = {}
    for name, spec in scene.components.items():
        source = locate(spec.fmu, scene.folder)
        found[name] = _content(source) if isinstance(source, Path) else source.content
        found[name] += "".join(_own_catalogue(scene, spec.preset).values())
    return found


def _varied_catalogues(scene: Scene, columns: Sequence[Column], design: Design) -> dict[str, str]:
    """By file: a hash over each catalogue of the user's own that a preset varies over."""
    found: dict[str, str] = {}
    for place, column in enumerate(columns):
        component, _, variable = column.settings[0].partition(".")
        if variable == "preset":
            for value in dict.fromkeys(str(point[place]) for point in design.points):
                varied = scene.set({f"{component}.preset": value}).components[component]
                found |= _own_catalogue(scene, varied.preset)
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
    """The SI unit of a setting; None for one that is no number."""
    component, _, variable = setting.partition(".")
    if component == "run":
        return UNITS.get(variable)
    found = system.components[component].variables.get(variable)
    return None if found is None else found.unit or "1"


def _si_points(
    first: Scene, system: System, columns: Sequence[Column], design: Design
) -> list[tuple[object, ...]]:
    """All points in SI. Raises TouchdownError for a value that a setting cannot take."""
    known: dict[tuple[str, str], object] = {}

    def value(column: Column, given: object) -> object:
        key = (column.name, repr(given))
        if key not in known:
            taken = [_si_value(first, system, setting, given) for setting in column.settings]
            known[key] = taken[0]
        return known[key]

    return [tuple(value(c, given) for c, given in zip(columns, p, strict=True)) for p in design.points]


def _si_value(first: Scene, system: System, setting: str, given: object) -> object:
    """A value in SI, or as a word; `system` is that of the `first` point."""
    varied = first.set({setting: given})
    component, _, variable = setting.partition(".")
    if setting == "run.scheme" or variable in ("preset", "every"):  # what is connected may change
        open_system(varied, in_process=True).close()
    if component == "run":
        taken = getattr(varied.run, variable)
        return float(taken) if variable in UNITS else str(getattr(taken, "name", taken))
    if variable in COMPONENT_SETTINGS:
        return str(given)
    return float(checked(system.components[component], variable, given))


# -- read back ---------------------------------------------------------------------------------------


def read_definition(folder: Path) -> Definition:
    """What the sweep in `folder` was asked. Raises TouchdownError where there is none that can be read."""
    path = folder / DEFINITION_FILE
    try:
        given = json.loads(path.read_text(encoding="utf-8"))
        columns = [Column(c["name"], tuple(c["settings"]), c["unit"]) for c in given.pop("columns")]
        if absent := [key for key in NEEDED_FIELDS if key not in given["scene"]]:
            raise KeyError(absent[0])
        lists = {key: tuple(given[key]) for key in ("part", "changes", "run_changes")}
        return Definition(**{**given, **lists, "columns": tuple(columns)})
    except FileNotFoundError:
        raise TouchdownError(f"there is no sweep in {folder}: it has no {DEFINITION_FILE}") from None
    except OSError as error:
        raise TouchdownError(f"cannot read {path}: {error.strerror}") from None
    except (ValueError, TypeError, KeyError):
        raise TouchdownError(
            f"{path} cannot be read; it is of another version, or damaged. Take another folder"
        ) from None


def differences(there: Definition, here: Definition) -> list[str]:
    """What differs between two sweeps that are not the same, in words; empty where they are."""
    one, other = _compared(there), _compared(here)
    if len(there.points) != len(here.points):  # told by their number
        del one["point"], other["point"]
    lines = list(_differences(one, other, ""))
    return (
        lines
        if len(lines) <= MAX_DIFFERENCES
        else [*lines[:MAX_DIFFERENCES], f"and {len(lines) - MAX_DIFFERENCES} more"]
    )


def refuse_other(folder: Path, there: Definition, here: Definition) -> None:
    """Raise TouchdownError where the sweep in `folder` is another one than is asked for."""
    found = differences(there, here)
    if found:
        raise TouchdownError(
            f"{folder} holds another sweep: {'; '.join(found)}. Choose another folder with -o, or start "
            "anew with --anew"
        )


def _compared(definition: Definition) -> dict[str, Any]:
    """All of it that changes a number, as JSON has it."""
    plain = cast(dict[str, Any], json.loads(json.dumps(asdict(definition), default=str)))
    scene, columns = plain.pop("scene"), plain.pop("columns")
    for told in IGNORED_DEFINITION_FIELDS:
        del plain[told]
    points, part = plain.pop("points"), plain.pop("part")
    for component in scene["components"].values():
        del component["own"]  # where a value was given changes no number
    names = [column["name"] for column in columns]
    return {
        **plain,
        **{key: value for key, value in scene.items() if key not in IGNORED_FIELDS},
        "varied": ", ".join(names),
        "settings": {column["name"]: ", ".join(column["settings"]) for column in columns},
        "shard": "/".join(map(str, part)),
        "number of points": len(points),
        "point": {str(i): dict(zip(names, row, strict=True)) for i, row in enumerate(points, start=1)},
    }


def _differences(there: Any, here: Any, where: str) -> Iterator[str]:
    if isinstance(there, dict) and isinstance(here, dict):
        for key in dict.fromkeys((*there, *here)):
            deeper = _differences(there.get(key), here.get(key), f"{where}.{key}" if where else key)
            yield from deeper
    elif there != here:
        yield _difference(where, there, here)


def _difference(where: str, there: object, here: object) -> str:
    if where.startswith("made_of."):
        return f"what {where.partition('.')[2]} is made of has changed"
    name = where.removeprefix("components.").replace(".set.", ".", 1)
    if name.startswith("point."):
        _, number, name = name.split(".", 2)
        name = f"{name} of point {number}"
    return f"{name} is {_or_not_set(there)} there and {_or_not_set(here)} here"


def _or_not_set(value: object) -> object:
    return "not set" if value is None else value
