"""The members of a sweep by one or two of its settings, and the frame of a picture over them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

from matplotlib.axes import Axes

from ...master.common.errors import TouchdownError, one_of
from ...master.common.text import joined
from ...master.results.whirl.evidence import ANGLE
from ...modelkit.errors import require
from .definition import Definition
from .members import Member
from .report import column as column_of

Place = tuple[Any, ...]  # values of the axes: numbers in the unit of their labels, or words
Value = TypeVar("Value")


@dataclass(frozen=True)
class Field(Generic[Value]):
    """Something at places: members, or what comes of them."""

    labels: tuple[str, ...]  # of the axes, with their units
    spots: dict[Place, Value]
    together: str  # what else varies, in words, or ""

    def along(self, axis: int) -> list[Any]:
        """The values on an axis, numbers in their order, words in that of the members."""
        values = list(dict.fromkeys(place[axis] for place in self.spots))
        numbers = [value for value in values if isinstance(value, float)]
        return list(sorted(numbers)) if len(numbers) == len(values) else values

    @property
    def is_grid(self) -> bool:
        """Whether every value of one axis stands beside every one of the other."""
        counts = [len(self.along(axis)) for axis in range(len(self.labels))]
        return len(counts) == 2 and len(self.spots) == counts[0] * counts[1] > max(counts)


def refuse_axes(over: Sequence[str], varying: Sequence[str]) -> None:
    """Raise TouchdownError where a map cannot be drawn `over` these settings; none may be named."""
    for name in over:
        if name not in varying:
            raise TouchdownError(f"a map over {name}: it does not vary; {one_of(name, varying)}")
    require(len(over) <= 2, f"a map over {', '.join(over)}: it has two axes; name one setting or two")


def field(
    definition: Definition, members: Sequence[Member], over: Sequence[str] = ()
) -> Field[list[Member]]:
    """Members by the settings `over` which a map is drawn, one or two.

    None named: the first two that vary, the phase of an unbalance only where nothing else does: a map
    shows what holds over phases. Members that were not run or failed are left out. Raises TouchdownError
    where a setting does not vary, or there are none.
    """
    settings = {
        column.name: [definition.points[member.number - 1][place] for member in members]
        for place, column in enumerate(definition.columns)
    }
    varying = [name for name, values in settings.items() if len(set(map(str, values))) > 1]
    phases = [c.name for c in definition.columns if all(name.endswith(f".{ANGLE}") for name in c.settings)]
    refuse_axes(over, varying)
    axes = list(over) or [name for name in varying if name not in phases][:2] or varying[:1]
    require(axes, "no setting varies; a map needs one or two that do")
    columns = [column_of(name, settings[name]) for name in axes]
    spots: dict[Place, list[Member]] = {}
    for i, member in enumerate(members):
        there = spots.setdefault(tuple(values[i] for _, values in columns), [])
        if not member.failed:
            there.append(member)
    rest = [
        f"{len(set(map(str, settings[name])))} values of {name}" for name in varying if name not in axes
    ]
    return Field(tuple(title for title, _ in columns), spots, joined(rest))


MAX_TICKS = 12
MAX_LABELLED_CELLS = 100  # cells with their numbers in words


def cells(axes: Axes, field: Field[Value]) -> Iterator[tuple[int, int, Value]]:
    """Column, row and what is there, for each cell of a grid, whose ticks tell the settings' values."""
    xs, ys = field.along(0), field.along(1)
    axes.set_xlim(-0.5, len(xs) - 0.5)
    axes.set_ylim(-0.5, len(ys) - 0.5)
    axes.set_xticks(*_ticks(xs))
    axes.set_yticks(*_ticks(ys))
    for x, at_x in enumerate(xs):
        for y, at_y in enumerate(ys):
            yield x, y, field.spots[(at_x, at_y)]


def _ticks(values: Sequence[object]) -> tuple[list[int], list[str]]:
    """Places and labels, thinned where they would not fit."""
    every = -(-len(values) // MAX_TICKS)
    places = list(range(0, len(values), every))
    labels = [f"{values[i]:.6g}" if isinstance(values[i], float) else str(values[i]) for i in places]
    return places, labels


def labelled(axes: Axes, field: Field[Any]) -> None:
    """The settings along the axes."""
    axes.set_xlabel(field.labels[0])
    if len(field.labels) == 2:
        axes.set_ylabel(field.labels[1])
