"""Files that commands leave, whole or not at all; tables; the one message for what cannot be written."""

from __future__ import annotations

import csv
import errno
import os
from collections.abc import Generator, Iterable, Mapping
from contextlib import contextmanager
from pathlib import Path

from .errors import TouchdownError

NO_ROOM = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)


@contextmanager
def writing_to(folder: Path) -> Generator[None]:
    """Raise TouchdownError where something cannot be written into `folder`."""
    if "\0" in str(folder):
        raise TouchdownError(f"no folder can be called {str(folder)!r}; choose another with -o")
    try:
        yield
    except OSError as error:
        raise TouchdownError(
            f"cannot write to {folder}: {error.strerror}; choose another folder with -o"
        ) from None


@contextmanager
def replacing(path: Path) -> Generator[Path]:
    """Where to write a file that takes the place of the one at `path` when it is whole."""
    there = path.resolve()  # a link stays, and leads to the new file
    part = partial(there)
    try:
        yield part
        os.replace(part, there)
    finally:
        part.unlink(missing_ok=True)


def partial(path: Path) -> Path:
    """Where a file is made before it takes its place at `path`."""
    return path.with_name(f".{path.name}.part")


def replace_text(path: Path, text: str) -> None:
    """Write a file that is there whole or as it was before. Raises OSError."""
    with replacing(path) as part:
        part.write_text(text, encoding="utf-8")


def write_records(records: Iterable[Mapping[str, object]], path: Path) -> None:
    """A CSV file with a row per record and a column per key, in full precision; none without records."""
    rows = list(records)
    if not rows:
        return
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, list(dict.fromkeys(key for row in rows for key in row)))
        writer.writeheader()
        writer.writerows(rows)


def keep_other(path: Path, text: str, what: str) -> None:
    """Raise TouchdownError where a file is there that is not what it is to become.

    what: the thing to choose another one of.
    """
    try:
        same = not os.path.exists(path) or path.read_text(encoding="utf-8") == text
    except (OSError, UnicodeDecodeError):
        same = False
    if not same:
        raise TouchdownError(
            f"{path} is there already; choose another {what}, or --force (in Python, force=True)"
        )
