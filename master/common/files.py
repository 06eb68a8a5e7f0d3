"""Files that commands leave: tables, and the one message for a folder that cannot be written."""

from __future__ import annotations

import csv
from collections.abc import Generator, Iterable, Mapping
from contextlib import contextmanager
from pathlib import Path

from touchdown.master.common.errors import TouchdownError


@contextmanager
def writing_to(folder: Path) -> Generator[None]:
    """Raise TouchdownError where something cannot be written into `folder`."""
    try:
        yield
    except OSError as error:
        raise TouchdownError(
            f"cannot write to {folder}: {error.strerror}; choose another folder with -o"
        ) from None


def write_records(records: Iterable[Mapping[str, object]], path: Path) -> None:
    """A CSV file with a row per record and a column per key, in full precision; none without records."""
    rows = list(records)
    if not rows:
        return
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, list(dict.fromkeys(key for row in rows for key in row)))
        writer.writeheader()
        writer.writerows(rows)
