"""Tables of people, as spreadsheets, loggers and programs of several countries save them.

Rows stand below a header of names with units. Cells are parted by commas, semicolons or tabs, decimals by
points or commas. What has one reading is read; of what has two, a message names the line.
"""

from __future__ import annotations

import csv
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path

from .errors import TouchdownError, nearest, require
from .reader import Table, content_of
from .units import display_unit

MARKS = ",;\t"
BOOKS = ".xls", ".xlsx", ".xlsm", ".ods"
BOOKS_BEGIN = b"PK\x03\x04", b"\xd0\xcf\x11\xe0"
LONGEST_HEAD = 200  # characters that a name with its unit may have
SHOWN_HEADS = 8  # of a header that lacks a column
HEADER_LINES = 200  # at the top, among which the header is looked for
_LINE_END = re.compile(r"\r\n|\r|\n")
_HEAD = re.compile(r"(.+?)\s*(?:[\[(]\s*([^\[\]()]*?)\s*[\])]|/\s*(\S+)|\sin\s+(\S+))?")
_UMLAUTS = str.maketrans({"ä": "ae", "ö": "oe", "ü": "ue", "ß": "ss"})
_SETTING = re.compile(r"[^\W\d][^\s.]*\.\S+")
_GROUPS = "'\u2019 \u00a0\u202f"  # between thousands, besides points and commas
_NUMBER = re.compile(
    rf"([-+\u2212]?)([.,]?\d(?:[.,{_GROUPS}]?\d)*[.,]?)((?:[eEdD][-+]?\d+)?)\s*((?:[^\W\d]|[%\u00b0]).*)?"
)
_READINGS = {
    point: re.compile(rf"(\d*|[1-9]\d{{0,2}}([{other}{_GROUPS}])\d{{3}}(?:\2\d{{3}})*)(?:[{point}](\d*))?")
    for point, other in (".,", ",.")
}
Called = Callable[[str], str]  # the column of a name; "" of none


def rows(
    path: Path,
    columns: Mapping[str, str] | None,
    needed: Sequence[str] = (),
    also: Mapping[str, str] | None = None,
    others: bool = False,
) -> list[Table]:
    """The rows of a table: cells that are not empty, numbers with the unit of their column.

    columns: SI units by name, "" of text, _ for spaces; None: settings, of any name with a dot, with a unit
    or without, and no empty cell. needed: columns that there must be. also: other names of columns.
    others: columns that are not known are left out; a name that only begins as a known one is known.
    The header is the first line that names columns, with units as NAME [UNIT] or in the line below. Lines
    above it, empty ones and those that begin with # are left out. Raises TouchdownError, also where
    there is no row.
    """
    called = _caller(columns, also or {}, others)
    lines = _LINE_END.split(_text(path))
    filled = [i for i, line in enumerate(lines) if line.strip(f" {MARKS}")]
    plain = [i for i in filled if not lines[i].lstrip(' "').startswith("#")]
    require(plain, f"{path}: has no row below its header")
    header_line, mark = _header(lines, [*plain[:HEADER_LINES], *filled[:HEADER_LINES]], needed, called)
    where = f"{path}, line {header_line + 1}: "
    header = _Header(where, _cells(lines[header_line].lstrip("# "), mark, where), columns)
    header.name(called, also or (), others)
    for absent in (name for name in needed if name not in header.units):
        has = ", ".join(filter(None, header.heads[:SHOWN_HEADS]))
        raise TouchdownError(
            f"{where}there is no column {absent}; the header needs {', '.join(needed)}, and has {has}"
        )
    cells = {i + 1: _cells(lines[i], mark, f"{path}, line {i + 1}: ") for i in plain if i > header_line}
    found = [header.row(f"{path}, line {number}: ", row) for number, row in cells.items() if any(row)]
    if found and header.take_units(found[0]):
        del found[0]
    require(found, f"{path}: has no row below its header")
    header.check_units()
    point = _point(found, header.numeric, mark, columns is None)
    units = {name: header.units[name] for name in header.numeric}
    return [
        Table(row.where, {n: _in_unit(cell, point, units.get(n)) for n, cell in row.values.items()})
        for row in found
    ]


def _caller(columns: Mapping[str, str] | None, also: Mapping[str, str], others: bool) -> Called:
    """What tells the column of a name."""

    def called(name: str) -> str:
        if columns is None:
            return name if _SETTING.fullmatch(name) else ""
        plain = re.sub(r"[\s_-]+", "_", name.lower().translate(_UMLAUTS))
        begun = [known for known in (*columns, *also) if others and plain.startswith(f"{known}_")]
        found = next((known for known in (plain, *begun) if known in columns or known in also), "")
        return also.get(found, found)

    return called


@dataclass(frozen=True)
class _Header:
    """The line that names columns: places and units of those that are known, by name."""

    where: str
    heads: Sequence[str]
    known: Mapping[str, str] | None
    places: dict[str, int] = field(default_factory=dict[str, int])
    units: dict[str, str] = field(default_factory=dict[str, str])

    def name(self, called: Called, also: Iterable[str], others: bool) -> None:
        """Find the columns; `also`: other names of them. Raises TouchdownError."""
        for i, head in enumerate(self.heads):
            said, unit = _head(head)
            name = called(said)
            if head and not name and not others:
                near = nearest(said.lower().translate(_UMLAUTS), [*(self.known or ()), *also])
                columns = f"columns are {', '.join(self.known or ['settings, such as rotor.speed'])}"
                remedy = "; ".join(filter(None, (near, columns)))
                raise TouchdownError(f"{self.where}the column {head!r} is not known; {remedy}")
            require(name not in self.places, f"{self.where}there are two columns {name}; leave one")
            if name:
                self.places[name], self.units[name] = i, unit

    @property
    def numeric(self) -> list[str]:
        """Columns of numbers; of settings all, which may be words."""
        return [name for name in self.places if self.known is None or self.known[name]]

    def row(self, where: str, cells: Sequence[str]) -> Table:
        """Cells that are not empty, by column. Raises TouchdownError where there are more than columns."""
        wide = max(i + 1 for i, head in enumerate(self.heads) if head)
        require(
            not any(cells[wide:]),
            f"{where}has {len(cells)} cells, the header {wide}; part cells by semicolons where numbers "
            "have commas",
        )
        values = {name: cells[i] for name, i in self.places.items() if i < len(cells) and cells[i]}
        for name in self.places if self.known is None else ():
            require(name in values, f"{where}{name} is missing")
        return Table(where, values)

    def take_units(self, row: Table) -> bool:
        """Whether a row has units in place of numbers, which are then those of the columns."""
        texts = {name: str(row.values[name]) for name in self.numeric if name in row.values}
        if self.known is None or not texts or any(_NUMBER.match(text) for text in texts.values()):
            return False
        for name, text in texts.items():
            unit = _unit(text.strip("[]()"))
            row.require(
                self.units[name] in ("", unit), name, f"is not a number, nor the unit {self.units[name]}"
            )
            self.units[name] = unit
        return True

    def check_units(self) -> None:
        """Raise TouchdownError for a column of numbers without a unit."""
        for name, unit in (self.known or {}).items():
            require(
                name not in self.units or unit in ("", "1") or self.units[name],
                f"{self.where}{name} has no unit; write it as {name} [{display_unit(unit, 0.1)}]",
            )


def _text(path: Path) -> str:
    """Of a file in UTF-8, UTF-16 or Windows-1252. Raises TouchdownError."""
    content = content_of(path, str(path))
    require(
        path.suffix.lower() not in BOOKS and not content.startswith(BOOKS_BEGIN),
        f"{path} is a workbook of a spreadsheet program; save its sheet as CSV",
    )
    encodings = ["utf-8-sig", "cp1252"]
    if content[:2] in (b"\xff\xfe", b"\xfe\xff"):
        encodings = ["utf-16"]
    elif b"\0" in content[:2]:
        encodings = ["utf-16-be" if content[:1] == b"\0" else "utf-16-le"]
    for encoding in encodings:
        with suppress(UnicodeDecodeError):
            return content.decode(encoding)
    raise TouchdownError(f"{path} is not text in UTF-8, UTF-16 or Windows-1252; save it as CSV in UTF-8")


def _header(
    lines: Sequence[str], candidates: Sequence[int], needed: Sequence[str], called: Called
) -> tuple[int, str]:
    """Which line is the header, and what parts its cells: that with all needed columns, or most known."""
    first = candidates[0]
    best = (0, first, max(MARKS[::-1], key=lines[first].count))
    for i in candidates:
        for mark in sorted(MARKS, key=lines[i].count, reverse=True):
            with suppress(TouchdownError):
                heads = [_head(cell)[0] for cell in _cells(lines[i].lstrip("# "), mark, "") if cell]
                names = [called(head) for head in heads]
                if heads and all(names if not needed else (name in names for name in needed)):
                    return i, mark
                best = max(best, (len({*names} - {""}), i, mark), key=lambda one: one[0])
    return best[1:]


def _cells(line: str, mark: str, where: str) -> list[str]:
    """The cells of a line, which is a row of its own: no quotation mark opens what lies below it."""
    try:
        found = csv.reader([line], delimiter=mark, strict=True, skipinitialspace=True)
        return [cell.strip() for row in found for cell in row]
    except csv.Error as error:
        raise TouchdownError(f"{where}a cell in quotation marks must end with one ({error})") from None


def _head(cell: str) -> tuple[str, str]:
    """Name and unit of a column."""
    cell = " ".join(cell.split())
    match = _HEAD.fullmatch(cell) if len(cell) <= LONGEST_HEAD else None
    return (match[1], _unit(match[2] or match[3] or match[4] or "")) if match else ("", "")


def _unit(text: str) -> str:
    return "" if text in ("-", "1") else text


def _point(found: Sequence[Table], numeric: Sequence[str], mark: str, words: bool) -> str:
    """What parts decimals in a table, by numbers that leave no doubt. Raises TouchdownError."""
    sure: dict[str, str] = {}
    doubtful = ""
    for row, name in ((row, name) for row in found for name in numeric if name in row.values):
        match = _NUMBER.fullmatch(row.values[name])
        if not match:
            continue
        said = f"{row.name(name)} = {row.values[name]!r}"
        by = {point: _read(match[2], point) for point in _READINGS}
        require(any(by.values()) or words, f"{said} cannot be read as a number")
        if by["."] == by[","]:
            continue
        if match[3] and len(marks := {c for c in match[2] if c in _READINGS}) == 1:
            sure.setdefault(marks.pop(), said)  # no mark between thousands stands before an exponent
            continue
        if all(by.values()):
            if mark != "," or "," in match[2]:
                doubtful = doubtful or f"{said} may be {by['.']} or {by[',']}"
        else:
            sure.setdefault("." if by["."] else ",", said)
    if len(sure) > 1:
        raise TouchdownError(
            f"{sure[',']} has a decimal comma, {sure['.']} a decimal point; use one of them"
        )
    require(
        sure or not doubtful,
        f"{doubtful}; write numbers without marks between thousands, and one with other than 3 decimals",
    )
    return next(iter(sure), ".")


def _read(digits: str, point: str) -> str:
    """Digits with a decimal point and no other mark; "" of what is not a number with such a `point`."""
    match = _READINGS[point].fullmatch(digits)
    if not match:
        return ""
    whole = re.sub(r"\D", "", match[1])
    return whole if match[3] is None else f"{whole or 0}.{match[3]}"


def _in_unit(cell: str, point: str, unit: str | None) -> str:
    """A number with its own unit, or that of its column; other text unchanged, and all without `unit`."""
    match = None if unit is None else _NUMBER.fullmatch(cell)
    number = _read(match[2], point) if match else ""
    if not match or not number:
        return cell
    sign = match[1].replace("\u2212", "-")
    return f"{sign}{number}{match[3].upper().replace('D', 'E')} {match[4] or unit}".strip()
