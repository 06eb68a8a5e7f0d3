"""Points of a study from a CSV file: a column per setting, a row per point."""

from __future__ import annotations

import csv
from pathlib import Path

from touchdown.master.common.errors import TouchdownError
from touchdown.master.studies.sweep.design import Design
from touchdown.master.studies.sweep.variation import number_and_unit


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
            name: [_value(row[place].strip(), unit) for row in rows[1:]]
            for place, (name, unit) in enumerate(columns)
        }
    )


def _value(cell: str, unit: str) -> str:
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
