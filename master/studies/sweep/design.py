"""Which settings a study varies, and the points at which it runs its scene."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import cast

from touchdown.master.common.errors import TouchdownError
from touchdown.master.common.several import several
from touchdown.master.common.units import plain
from touchdown.master.studies.sweep import sampling
from touchdown.master.studies.sweep.variation import Range, parse_range

MOST = 100_000  # points; weeks of drops

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
            said = ", ".join(f"{name} {count}" for name, count in counts.items())
            raise TouchdownError(f"settings that vary together need equally many values; there are: {said}")
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
        return cls._drawn(sampling.RANDOM, ranges, count, seed)

    @classmethod
    def latin(cls, ranges: Ranges, count: int, seed: int = 0) -> Design:
        """A Latin hypercube: each range has `count` equal parts, and a point in each of them."""
        return cls._drawn(sampling.LATIN, ranges, count, seed)

    @classmethod
    def sobol(cls, ranges: Ranges, count: int, seed: int = 0) -> Design:
        """The first `count` points, a power of 2, of a scrambled Sobol sequence."""
        return cls._drawn(sampling.SOBOL, ranges, count, seed)

    @classmethod
    def _drawn(cls, method: sampling.Method, ranges: Ranges, count: int, seed: int) -> Design:
        if not ranges:
            raise TouchdownError("a sample needs a range at least, such as rotor.speed=6000:12000 rpm")
        _refuse_too_many(count)
        spans = {name: _span(name, given) for name, given in ranges.items()}
        parts = sampling.unit_cube(method, len(spans), count, seed)
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
        values[name] = listed if isinstance(listed, range) else [plain(value) for value in several(listed)]
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
    if count > MOST:
        raise TouchdownError(
            f"a sweep of {count} members is too large, at most {MOST} are possible; vary fewer "
            "settings, or over fewer values"
        )
