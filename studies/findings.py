"""Findings of a study: lines for the console, and tables, texts and pictures for its folder."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Generic, TypeVar

from matplotlib.figure import Figure

from ..master.common.files import write_records, writing_to
from ..master.common.text import aligned
from ..modelkit.kernel.writing import child_path, write
from ..reports.figures.style import save

Row = TypeVar("Row")
GAP = 2  # between columns

Record = Mapping[str, object]


@dataclass(frozen=True)
class Findings:
    """The report of a study."""

    lines: Sequence[str]
    tables: Mapping[str, Iterable[Record]] = field(default_factory=dict[str, Iterable[Record]])  # by file
    texts: Mapping[str, str] = field(default_factory=dict[str, str])  # by file
    pictures: Mapping[str, Callable[[], Figure]] = field(default_factory=dict[str, Callable[[], Figure]])
    dots_per_inch: int = 150  # of the pictures

    def write(self, folder: Path) -> None:
        """All files into `folder`. Raises TouchdownError where they cannot be written."""
        with writing_to(folder):
            for name, records in self.tables.items():
                write_records(records, child_path(folder, name))
            for name, text in self.texts.items():
                write(child_path(folder, name), text)
            for name, draw in self.pictures.items():
                save(draw(), child_path(folder, name), self.dots_per_inch)


@dataclass(frozen=True)
class Column(Generic[Row]):
    """A column of a table for people: its head, in one line or more, and the text of a row's cell."""

    head: tuple[str, ...]
    cell: Callable[[Row], str]


def paragraphs(*parts: Iterable[str]) -> list[str]:
    """Lines of all parts, with an empty one between them."""
    lines: list[str] = []
    for part in parts:
        lines += ["", *part] if lines else part
    return lines


def number(value: float | None, form: str) -> str:
    """A number in a format; - where there is none."""
    return "-" if value is None else format(value, form)


def table(
    label: Column[Row],
    columns: Sequence[Column[Row]],
    rows: Sequence[Row],
    *,
    instead: Callable[[Row], str] = lambda row: "",
    behind: Callable[[Row], str] = lambda row: "",
    width: int = 0,
) -> list[str]:
    """Lines of a table: labels on the left, columns to the right, at least `width` wide.

    instead: what a row has in place of cells, such as why it failed; behind: what stands after them.
    """
    lines = [
        [head, *(c.head[i].rjust(width - GAP) for c in columns), ""] for i, head in enumerate(label.head)
    ]
    for row in rows:
        failed = instead(row)
        cells = [failed] if failed else [*(c.cell(row) for c in columns), behind(row)]
        lines.append([label.cell(row), *cells])
    return aligned(lines, "<" + ">" * len(columns) + "<")
