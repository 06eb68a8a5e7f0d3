"""Exhibits as files: a picture and a table each, and the page of all of them."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from ....master.common.errors import TouchdownError
from ....master.common.files import write_records, writing_to
from ....master.results.table import aligned
from ....modelkit.kernel.writing import make_folder
from ....modelkit.kernel.writing import write as write_file
from ....reports.figures.style import save
from .exhibit import Exhibit, Row, percent, shown
from .registry import ABSENT, BEYOND, ENTRIES, Entry, heading

PAGE = "reproduction.md"
PICTURES = Path("pictures", "reproduction")  # beside the page
DPI = 80
HEAD = """# The source's figures and tables

Every figure and table of O. Halminen, *Multibody models for examination of touchdown bearing systems*
(LUT, 2016) that the models here can give, beside the values that its text states; what it shows in a
picture alone has no value to compare. A number agrees where it is as near as the column "within" says, or
in the source's range: for frequencies a few percent, for stresses and what is chaotic up to 50 %. Rows of
dimensions, masses and clearances only show that the models were given the source's. What a deviation hinges
on, and what was fitted, stands beside it; [physics.md](physics.md) explains the models and the source's
errata.

This page is made by `touchdown figure all -o docs`; `touchdown figure 25` makes one of them anew. Figures
of others than this source are held against ours in [validation.md](validation.md).
"""
COLUMNS = ("quantity", "source", "here", "deviation", "within", "verdict")


def listing() -> str:
    """Which figures and tables there are, a line each."""
    lines = [f"  {entry.name:<9}{entry.title}" for entry in (*ENTRIES, *BEYOND)]
    absent = ", ".join(f"{name} ({why})" for name, why in ABSENT.items())
    return "\n".join([*lines, f"  not here: figures {absent}"])


def text(entry: Entry, exhibit: Exhibit) -> str:
    """The rows of an exhibit as a table for a terminal."""
    rows = aligned([COLUMNS, *(_cells(row) for row in exhibit.rows)], "<>>>><") if exhibit.rows else []
    lines = [*rows, *exhibit.lines, *(f"assumed: {note}" for note in exhibit.notes)]
    return "\n".join([f"{entry.heading}: {entry.title}", *(f"  {line}" for line in lines)])


def write(entry: Entry, exhibit: Exhibit, folder: Path) -> list[Path]:
    """The rows as NAME.csv, a picture as NAME.png and lines as NAME.txt in `folder`; returns the files."""
    made = [folder / f"{entry.key}.csv"]
    with writing_to(folder):
        write_records([_record(row) for row in exhibit.rows], made[0])
        if exhibit.figure is not None:
            made.append(folder / f"{entry.key}.png")
            _save(exhibit, made[-1])
        if exhibit.lines:
            made.append(folder / f"{entry.key}.txt")
            write_file(made[-1], "\n".join([*exhibit.lines, ""]))
    return made


def write_page(exhibits: Mapping[Entry, Exhibit | TouchdownError], folder: Path) -> Path:
    """The page of all `exhibits`, or of why one is missing, and its pictures; returns its path."""
    pictures = folder / PICTURES
    with writing_to(folder):
        make_folder(pictures)
        parts = [HEAD, _overview(exhibits), _absent()]
        for entry, exhibit in exhibits.items():
            parts.append(_section(entry, exhibit))
            if not isinstance(exhibit, TouchdownError) and exhibit.figure is not None:
                _save(exhibit, pictures / f"{entry.key}.png")
        write_file(folder / PAGE, "\n".join(parts))
    return folder / PAGE


def _save(exhibit: Exhibit, path: Path) -> None:
    assert exhibit.figure is not None
    save(exhibit.figure, path, DPI)


def _cells(row: Row) -> tuple[str, ...]:
    return (row.what, *map(shown, (row.source, row.ours)), percent(row.deviation), row.within, row.verdict)


def _record(row: Row) -> Mapping[str, object]:
    return dict(zip(COLUMNS, _cells(row), strict=True)) | {"deviation": row.deviation}


def _overview(exhibits: Mapping[Entry, Exhibit | TouchdownError]) -> str:
    """How many rows of each agree."""
    lines = [
        "## Overview",
        "",
        "| | what | rows | agree | differ | no value to compare |",
        "|---|---|---|---|---|---|",
    ]
    for entry, exhibit in exhibits.items():
        where = f"[{entry.heading}](#{entry.heading.lower().replace(' ', '-')})"
        if isinstance(exhibit, TouchdownError):
            lines.append(f"| {where} | {entry.title} | failed: {exhibit} | | | |")
            continue
        verdicts = [row.agrees for row in exhibit.rows]
        counts = [len(verdicts), *(verdicts.count(kind) for kind in (True, False, None))]
        lines.append(f"| {where} | {entry.title} | {' | '.join(map(str, counts))} |")
    return "\n".join([*lines, ""])


def _absent() -> str:
    """Figures that no model gives."""
    lines = [f"| {heading(name)} | {why} |" for name, why in ABSENT.items()]
    measured = "| Fig 13 a, b; two rows of Table 2 | measurements |"
    return "\n".join(
        ["Not here, since no model gives them:", "", "| | why |", "|---|---|", *lines, measured, ""]
    )


def _section(entry: Entry, exhibit: Exhibit | TouchdownError) -> str:
    lines = [f"## {entry.heading}", "", f"{entry.title[0].upper()}{entry.title[1:]}.", ""]
    if isinstance(exhibit, TouchdownError):
        return "\n".join([*lines, f"Failed: {exhibit}", ""])
    if exhibit.figure is not None:
        picture = (PICTURES / f"{entry.key}.png").as_posix()
        lines += [f"![{entry.heading}: {entry.title}]({picture})", ""]
    lines += [f"| {' | '.join(COLUMNS)} |", f"|{'---|' * len(COLUMNS)}"]
    for row in exhibit.rows:
        cells = (cell.replace("|", "\\|") for cell in _cells(row))
        lines.append(f"| {' | '.join(cells)} |")
    if exhibit.notes:
        lines += ["", "Assumed:", "", *(f"- {note}" for note in exhibit.notes)]
    return "\n".join([*lines, ""])
