"""Numbers with their units, shares, enumerations and tables as text."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

from ...modelkit.units import display_unit, per_display

RPM = per_display("rad/s", "rpm")  # of one rad/s
HZ = 1.0 / (2.0 * math.pi)  # of one rad/s
MM, UM = (per_display("m", unit) for unit in ("mm", "um"))  # of one metre
IN_HERTZ = ("bandwidth",)  # variables in rad/s that are no speeds


def percent(part: float, digits: int = 3) -> str:
    """A part of one in per cent, without powers of ten.

    >>> percent(0.123456), percent(16.4055), percent(0.123456, 2)
    ('12.3 %', '1640 %', '12 %')
    """
    return f"{float(f'{100.0 * part:.{digits}g}'):g} %"


def display_value(name: str, value: float) -> tuple[float, str]:
    """The variable `name` (rad/s) in the unit that people use: a speed in rpm, a bandwidth in Hz.

    >>> display_value("rotor.speed", 10.0 * math.pi), display_value("amb.bandwidth", 10.0 * math.pi)
    ((300.0, 'rpm'), (5.0, 'Hz'))
    """
    return (HZ * value, "Hz") if name.endswith(IN_HERTZ) else (60.0 * HZ * value, "rpm")


def variable_unit(name: str, unit: str, size: float) -> str:
    """The unit in which people read values of about `size` of a variable, in the SI unit `unit`.

    >>> variable_unit("amb.bandwidth", "rad/s", 6e3), variable_unit("rotor.speed", "rad/s", 6e3)
    ('Hz', 'rpm')
    """
    return "Hz" if unit == "rad/s" and name.endswith(IN_HERTZ) else display_unit(unit, size)


def as_given(value: object, unit: str | None, name: str = "") -> str:
    """The setting `name` as it was given, with its unit; text may have one in it.

    >>> as_given(20000, "rad/s", "rotor.speed"), as_given(12566, "rad/s", "amb.bandwidth")
    ('20000 rad/s (190986 rpm)', '12566 rad/s (1999.94 Hz)')
    >>> as_given("0.3 mm", "m"), as_given("0.15", "1")
    ('0.3 mm', '0.15')
    """
    try:
        number = float(str(value))
    except ValueError:
        return str(value)
    turns, per = display_value(name, number)
    beside = f" ({turns:.6g} {per})" if unit == "rad/s" and number else ""
    return f"{number:g}" + (f" {unit}" if unit not in (None, "", "1") else "") + beside


def joined(words: Iterable[str], last: str = "and", most: int | None = None) -> str:
    """An enumeration; of more than `most` words the first, and how many more there are.

    >>> joined("a"), joined("ab"), joined("abc", "or"), joined("abcde", most=2)
    ('a', 'a and b', 'a, b or c', 'a, b and 3 more')
    """
    found = list(words)
    if most is not None and len(found) > most:
        found[most:] = [f"{len(found) - most} more"]
    return f" {last} ".join(filter(None, (", ".join(found[:-1]), *found[-1:])))


def aligned(rows: Iterable[Sequence[str]], sides: str = "<", indent: str = "") -> list[str]:
    """Rows of cells as lines; sides: < or > for each column, left or right, the last for all others.

    Where a row has fewer cells than others, its last one runs over the columns that are left.

    >>> aligned([("seat", "force", "Hz"), ("A", "1 N", "20"), ("B", "not touched")], "<>", "  ")
    ['  seat  force  Hz', '  A       1 N  20', '  B     not touched']
    """
    cells = list(rows)
    most = max(map(len, cells), default=0)
    parts = [(row, ()) if len(row) == most else (row[:-1], row[-1:]) for row in cells]
    widths = [max(len(row[k]) for row, _ in parts if k < len(row)) for k in range(most)]
    forms = [f"{side}{width}" for side, width in zip(sides.ljust(most, sides[-1]), widths, strict=False)]
    lines = ("  ".join([*map(format, row, forms), *over]) for row, over in parts)
    return [f"{indent}{line}".rstrip() for line in lines]


def markdown(head: Sequence[str], rows: Iterable[Sequence[str]]) -> list[str]:
    """A table of Markdown as lines.

    >>> markdown(("key", "value"), [("kind", "a|b")])
    ['| key | value |', '| --- | --- |', '| kind | a\\\\|b |']
    """
    table = (head, ("---",) * len(head), *rows)
    return ["| " + " | ".join(cell.replace("|", "\\|") for cell in row) + " |" for row in table]
