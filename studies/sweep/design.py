"""The points of a sweep: settings and their values, as grids, tied, listed or drawn.

People write the values of a variable as

rotor.speed=6000 rpm,9000 rpm            a list; a unit at its end is everyone's
bearing.clearance=0.2,0.25,0.3 mm
bearing.balls.first_angle=0:315:8 deg    from 0 to 315, both included, 8 values
run.scheme=hold,interface                words, where a setting is a word
a.mass,b.mass=1,2 kg                     several settings have the same value
bearing_*.friction.dynamic=0.1,0.2       so do all that match

and a range to draw from by its two ends, with the unit of both:

rotor.speed=6000:12000 rpm
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import cast

import numpy as np

from ...master.common.errors import TouchdownError, as_list
from ...master.common.units import plain
from ...modelkit.errors import require
from ...modelkit.sheets import rows

RANDOM, LATIN, SOBOL = "a random sample", "a Latin hypercube", "a Sobol sequence"  # ways to spread points


def _unit_cube(method: str, dimensions: int, count: int, seed: int) -> np.ndarray:
    """Points (count, dimensions) between 0 and 1; equal for equal seeds. Raises TouchdownError."""
    require(count >= 1, f"a sample cannot have {count} points; ask for 1 at least")
    require(seed >= 0, f"seed = {seed} must be a whole number, 0 or above")
    source = np.random.default_rng(seed)
    if method == RANDOM:
        return source.random((count, dimensions))
    from scipy.stats import qmc  # slow to import

    if method == LATIN:
        return qmc.LatinHypercube(dimensions, rng=source).random(count)
    below = 2 ** (count.bit_length() - 1)
    remedy = f"ask for a power of 2: {below} or {2 * below}"
    require(count == below, f"{count} points of a Sobol sequence are not balanced; {remedy}")
    return qmc.Sobol(dimensions, rng=source).random(count)


def read_points(path: Path) -> Design:
    """The design in the file at `path`, whose columns are called NAME or NAME [UNIT].

    Raises TouchdownError where it cannot be read, a column is not a setting, or a cell is empty.
    """
    found = rows(path, None)
    return Design.tied({name: [row.values[name] for row in found] for name in found[0].values})


MAX_VALUES = 100_000  # values of one variable; more is a slip of the pen


def parse(text: str, option: str = "--vary") -> tuple[str, tuple[str, ...]]:
    """Name and values of NAME=VALUE,VALUE... or NAME=START:STOP:COUNT, with a unit at the end."""
    what = f"{option} {text}"
    name, equals, right = (part.strip() for part in text.partition("="))
    require(equals and name, f"{what}: write NAME=VALUE,VALUE,... or NAME=START:STOP:COUNT[:log]")
    require(right, f"{what}: the list of values is empty")
    is_range = ":" in right and ".toml:" not in right  # a preset may be DEFINITION_FILE.toml:NAME
    return name, _evenly(right, what) if is_range else listed(right, what)


def parse_all(texts: Iterable[str], option: str = "--vary") -> dict[str, tuple[str, ...]]:
    """Values by name, given with `option`. Raises TouchdownError where a name comes twice."""
    variations: dict[str, tuple[str, ...]] = {}
    for text in texts:
        name, values = parse(text, option)
        require(name not in variations, f"{option} {name} is given twice; write all its values in one list")
        variations[name] = values
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
    require(all(items), f"{what}: a value is missing between the commas")
    parts = [number_and_unit(item) for item in items]
    last = parts[-1]
    if last is None or not last[1]:
        return tuple(items)
    bare = [part is not None and not part[1] for part in parts]
    return tuple(f"{item} {last[1]}" if alone else item for item, alone in zip(items, bare, strict=True))


@dataclass(frozen=True)
class _Range:
    """Values from `low` to `high`, in `unit` ("": SI)."""

    low: float
    high: float
    unit: str

    def at(self, part: float) -> str:
        """The value at a part (0 to 1) of the way, as text with its unit."""
        return _with_unit(self.low + part * (self.high - self.low), self.unit)


def _parse_range(text: str, what: str) -> _Range:
    """LOW:HIGH, with a unit at the end. `what`: for a complaint. Raises TouchdownError."""
    head, _, unit = text.strip().partition(" ")
    try:
        low, high = (float(part) for part in head.split(":"))
    except ValueError:
        raise TouchdownError(f"{what}: write LOW:HIGH, then the unit, such as 6000:12000 rpm") from None
    require(
        np.isfinite([low, high]).all() and low < high, f"{what}: LOW must be below HIGH, and both finite"
    )
    return _Range(low, high, unit.strip())


def _with_unit(number: float, unit: str) -> str:
    """As text, in twelve digits."""
    return f"{number:.12g} {unit}".strip()


LOGARITHMIC = "log"  # ends a range whose values have even ratios


def _evenly(right: str, what: str) -> tuple[str, ...]:
    head, _, unit = right.partition(" ")
    head, even, logarithmic = head.partition(f":{LOGARITHMIC}")
    parts = head.split(":")
    require(
        len(parts) == 3 and ":" not in unit and not logarithmic,
        f"{what}: write START:STOP:COUNT, then the unit, such as 0:315:8 deg; or 1:100:5:log kN/m",
    )
    try:
        start, stop, count = (float(part) for part in parts)
    except ValueError:
        raise TouchdownError(f"{what}: START, STOP and COUNT must be numbers") from None
    require(
        np.isfinite([start, stop, count]).all(), f"{what}: START, STOP and COUNT must be finite numbers"
    )
    require(
        count == int(count) and 1 <= count <= MAX_VALUES,
        f"{what}: COUNT must be a whole number from 1 to {MAX_VALUES}",
    )
    require(
        not even or min(start, stop) > 0.0,
        f"{what}: START and STOP must be above 0 for even ratios ({LOGARITHMIC})",
    )
    between = np.geomspace if even else np.linspace
    return tuple(_with_unit(value, unit.strip()) for value in between(start, stop, int(count)))


MAX_POINTS = 100_000  # points; weeks of drops

Ranges = Mapping[str, str | tuple[float, float] | _Range]


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
    """

    names: tuple[str, ...]
    points: tuple[tuple[object, ...], ...]  # values of `names`
    about: str  # how they were chosen, in words

    @classmethod
    def grid(cls, variations: Mapping[str, object]) -> Design:
        """Every combination of the values of each setting: a list, an array or a single one.

        Raises TouchdownError where there are none, or too many.
        """
        values = _values(variations)
        count = math.prod(len(levels) for levels in values.values())
        _refuse_too_many(count)
        points = tuple(itertools.product(*values.values()))
        return cls(tuple(values), points, f"{_points(count)} of a grid")

    @classmethod
    def tied(cls, columns: Mapping[str, object]) -> Design:
        """Settings that vary together: the first values of all, the second values of all, and so on.

        Raises TouchdownError where one has more values than another.
        """
        values = _values(columns)
        counts = {name: len(column) for name, column in values.items()}
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
    def _drawn(cls, method: str, ranges: Ranges, count: int, seed: int) -> Design:
        require(ranges, "a sample needs a range at least, such as rotor.speed=6000:12000 rpm")
        _refuse_too_many(count)
        spans = {name: _span(name, limits) for name, limits in ranges.items()}
        parts = _unit_cube(method, len(spans), count, seed)
        points = tuple(
            tuple(span.at(part) for span, part in zip(spans.values(), row, strict=True)) for row in parts
        )
        return cls(tuple(spans), points, f"{_points(count)} of {method}, seed {seed}")

    def point(self, number: int) -> dict[str, object]:
        """Values by setting."""
        return dict(zip(self.names, self.points[number - 1], strict=True))

    def __len__(self) -> int:
        return len(self.points)

    def __mul__(self, other: Design) -> Design:
        twice = [name for name in self.names if name in other.names]
        require(not twice, f"{', '.join(twice)} varies twice; give it once")
        _refuse_too_many(len(self.points) * len(other.points))
        points = tuple(mine + theirs for mine in self.points for theirs in other.points)
        return Design(self.names + other.names, points, f"{self.about}; {other.about}")


def designed(variations: Design | Mapping[str, object] | Iterable[Mapping[str, object]]) -> Design:
    """A design unchanged, values of settings as a grid, rows of settings as a table."""
    if isinstance(variations, Design):
        return variations
    if isinstance(variations, Mapping):
        return Design.grid(cast(Mapping[str, object], variations))
    return Design.table(variations)


def _values(settings: Mapping[str, object]) -> dict[str, Sequence[object]]:
    """Lists of plain values. Raises TouchdownError where there are none."""
    require(settings, "nothing varies; name at least one setting")
    values: dict[str, Sequence[object]] = {}
    for name, listed in settings.items():
        values[name] = listed if isinstance(listed, range) else [plain(value) for value in as_list(listed)]
        require(values[name], f"{name} has no values to vary over")
    return values


def _span(name: str, limits: str | tuple[float, float] | _Range) -> _Range:
    if isinstance(limits, _Range):
        return limits
    text = limits if isinstance(limits, str) else ":".join(str(float(end)) for end in limits)
    return _parse_range(text, f"{name} = {limits}")


def _points(count: int) -> str:
    return f"{count} point{'' if count == 1 else 's'}"


def _refuse_too_many(count: int) -> None:
    require(
        count <= MAX_POINTS,
        f"a sweep of {count} drops is too large, at most {MAX_POINTS} are possible; vary fewer "
        "settings, or over fewer values",
    )
