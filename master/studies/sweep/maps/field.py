"""What a map is drawn over: one or two settings, and the members at each of their values."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

from touchdown.master.common.errors import TouchdownError, one_of
from touchdown.master.results.whirl.unbalance import ANGLE
from touchdown.master.studies.sweep.definition import Definition
from touchdown.master.studies.sweep.journal import Member
from touchdown.master.studies.sweep.report import column as column_of

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
    if len(over) > 2:
        raise TouchdownError(f"a map over {', '.join(over)}: it has two axes; name one setting or two")


def field(
    definition: Definition, members: Sequence[Member], over: Sequence[str] = ()
) -> Field[list[Member]]:
    """Members by the settings `over` which a map is drawn, one or two.

    None named: the first two that vary, the phase of an unbalance only where nothing else does: a map
    shows what holds over phases. Members that were not run or failed are left out. Raises TouchdownError
    where a setting does not vary, or there are none.
    """
    given = {
        column.name: [definition.points[member.number - 1][place] for member in members]
        for place, column in enumerate(definition.columns)
    }
    varying = [name for name, values in given.items() if len(set(map(str, values))) > 1]
    phases = [c.name for c in definition.columns if all(name.endswith(f".{ANGLE}") for name in c.settings)]
    refuse_axes(over, varying)
    axes = list(over) or [name for name in varying if name not in phases][:2] or varying[:1]
    if not axes:
        raise TouchdownError("no setting varies; a map needs one or two that do")
    columns = [column_of(name, given[name]) for name in axes]
    spots: dict[Place, list[Member]] = {}
    for i, member in enumerate(members):
        there = spots.setdefault(tuple(values[i] for _, values in columns), [])
        if not member.failed:
            there.append(member)
    rest = [f"{len(set(map(str, given[name])))} values of {name}" for name in varying if name not in axes]
    return Field(tuple(title for title, _ in columns), spots, " and ".join(rest))
