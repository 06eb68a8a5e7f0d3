"""Tables, files that are kept, and the one message for what cannot be written."""

from __future__ import annotations

import csv
import errno
import os
import tempfile
from collections.abc import Generator, Iterable, Mapping
from contextlib import contextmanager
from pathlib import Path

from ...modelkit.kernel.writing import make_folder, replacing_text
from ...modelkit.reader import text_of
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


def make_writable(folder: Path) -> None:
    """Make `folder` and see that files can be written into it. Raises TouchdownError where not."""
    with writing_to(folder):
        make_folder(folder)
        tempfile.TemporaryFile(dir=folder).close()


def write_records(records: Iterable[Mapping[str, object]], path: Path) -> None:
    """A CSV file with a row per record and a column per key, in full precision; none without records."""
    rows = list(records)
    if not rows:
        return
    with replacing_text(path) as file:
        writer = csv.DictWriter(file, list(dict.fromkeys(key for row in rows for key in row)))
        writer.writeheader()
        writer.writerows(rows)


def keep_other(path: Path, text: str, what: str) -> None:
    """Raise TouchdownError where a file is there that is not what it is to become.

    what: the thing to choose another one of.
    """
    try:
        same = not os.path.exists(path) or text_of(path) == text
    except TouchdownError:
        same = False
    if not same:
        raise TouchdownError(
            f"{path} is there already; choose another {what}, or --force (in Python, force=True)"
        )
