"""A table of a rotor file, whose values are fetched by kind, and each mistake told in one line."""

from __future__ import annotations

from dataclasses import dataclass
from difflib import get_close_matches
from textwrap import shorten
from typing import Any

from touchdown.modelkit.model import ModelError
from touchdown.modelkit.units import UnitError, to_si, units_of

EXAMPLES = {
    "m": "12.5 mm", "Pa": "207 GPa", "kg/m3": "7830 kg/m3", "kg": "0.5 kg", "kg.m2": "0.002 kg.m2",
    "kg.m": "3 g.mm", "rad": "90 deg", "N/m": "20 MN/m", "N.s/m": "500 N.s/m",
}  # fmt: skip
LIMITS = {  # beyond them it is a slip, or too far apart to calculate with
    "m": (1e-4, 1e2), "Pa": (1e3, 1e13), "kg/m3": (1.0, 1e5), "kg": (1e-9, 1e6), "kg.m2": (1e-15, 1e7),
    "kg.m": (1e-12, 1e3), "rad": (0.0, 1e3), "N/m": (1e-3, 1e15), "N.s/m": (1e-6, 1e12),
}  # fmt: skip


class RotorFileError(ModelError):
    """A mistake in a rotor file: file, place, value and remedy in one line."""


@dataclass(frozen=True)
class Table:
    """A table of the file, and what to call it in a message."""

    file: str
    where: str
    values: dict[str, Any]

    def path(self, name: str) -> str:
        """Where the value `name` stands in the file: disc[2].node."""
        shown = name if name.isidentifier() else repr(name)
        return f"{self.where}.{shown}" if self.where else shown

    def error(self, name: str, says: str) -> RotorFileError:
        """What to raise about the value `name`, of which the beginning is shown if there is one."""
        value = f" = {shorten(repr(self.values[name]), 60)}" if name in self.values else ""
        return RotorFileError(f"{self.file}: {self.path(name)}{value} {says}")

    def only(self, *known: str) -> None:
        """Raises RotorFileError for the first field that is not known."""
        for name in self.values:
            if name not in known:
                near = get_close_matches(name, known, n=1)
                remedy = f"did you mean {near[0]}" if near else f"there are: {', '.join(known)}"
                raise RotorFileError(f"{self.file}: {self.path(name)} is not a known field; {remedy}")

    def get(self, name: str, kind: Any, meant: str, default: Any = None) -> Any:
        """A value of the given kind, described by `meant`; required unless there is a default.

        Raises RotorFileError where it is missing or of another kind.
        """
        if name not in self.values:
            if default is None:
                raise self.error(name, f"is missing; it must be {meant}")
            return default
        value = self.values[name]
        if not isinstance(value, kind) or (isinstance(value, bool) and kind is not bool):
            raise self.error(name, f"must be {meant}")
        return value

    def text(self, name: str, default: str | None = None) -> str:
        """A text. Raises RotorFileError, as all that follow."""
        return self.get(name, str, "text", default)

    def integer(self, name: str, low: int, high: int, default: int | None = None) -> int:
        """An integer from `low` to `high`."""
        meant = f"an integer from {low} to {high}"
        value = self.get(name, int, meant, default)
        if not low <= value <= high:
            raise self.error(name, f"must be {meant}")
        return value

    def number(self, name: str, low: float, below: float, default: float | None = None) -> float:
        """A number without unit, at least `low` and below `below`."""
        meant = f"a number without unit, at least {low:g} and below {below:g}"
        value = self.get(name, (int, float), meant, default)
        if not low <= value < below:
            raise self.error(name, f"must be {meant}")
        return float(value)

    def quantity(
        self,
        name: str,
        unit: str,
        default: float | None = None,
        zero: bool = False,
        negative: bool = False,
    ) -> float:
        """A value with a unit, in SI; positive unless `zero` or `negative` allow more.

        Raises RotorFileError where it has no unit or another one, and where it is beyond `LIMITS`.
        """
        meant = f"text with a unit of {unit} ({', '.join(units_of(unit))}), such as {EXAMPLES[unit]!r}"
        if name not in self.values:
            return self.get(name, str, meant, default)
        value = self.values[name]
        if not isinstance(value, str) or len(value.split()) < 2:
            raise self.error(name, f"has no unit; write {meant}")
        try:
            number = to_si(value, unit, self.path(name))
        except UnitError as error:
            raise RotorFileError(f"{self.file}: {error}; write {meant}") from None
        if (number == 0.0 and not zero) or (number < 0.0 and not negative):
            raise self.error(name, "must not be negative" if zero else "must be above 0")
        low, high = LIMITS[unit]
        if number != 0.0 and not low <= abs(number) <= high:
            raise self.error(name, f"is out of proportion; rotors have {low:g} to {high:g} {unit}")
        return number

    def node(self, name: str, nodes: int) -> int:
        """The number of one of the rotor's nodes, which count from 1 to `nodes`."""
        value = self.get(name, int, f"the number of a node, 1 to {nodes}")
        if not 1 <= value <= nodes:
            raise self.error(name, f"is not a node; the elements make nodes 1 to {nodes}")
        return value

    def table(self, name: str) -> Table:
        """A table within this one."""
        values = self.get(name, dict, f"a table [{self.path(name)}]")
        return Table(self.file, self.path(name), values)

    def tables(self, name: str, *known: str) -> list[Table]:
        """A list of tables, written [[name]]; none where there is none. They hold fields `known`."""
        meant = f"a list of tables, each written [[{name}]]"
        tables = []
        for i, values in enumerate(self.get(name, list, meant, []), 1):
            if not isinstance(values, dict):
                raise self.error(name, f"must be {meant}")
            tables.append(Table(self.file, f"{self.path(name)}[{i}]", values))
            tables[-1].only(*known)
        return tables
