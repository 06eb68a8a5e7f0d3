"""Archives that are read: what they may hold, how large they may be, and what is said of damaged ones."""

from __future__ import annotations

import os
import re
import stat
import struct
import tokenize
import zipfile
import zlib
from collections.abc import Generator
from contextlib import contextmanager
from dataclasses import dataclass
from io import BufferedReader
from pathlib import Path, PurePosixPath
from typing import Any

from .errors import TouchdownError

MAX_BYTES = 512 * 1024**2  # bytes, unpacked; VARIABLE says otherwise
VARIABLE = "TOUCHDOWN_LARGEST_FMU"
MAX_ENTRIES = 20_000  # entries
UNPORTABLE = {"\\": "backslash", ":": "colon"}  # folders, drives and streams for some, letters for others
_SIZE = re.compile(r"\s*([0-9.]+(?:e[0-9]+)?)\s*(|k|M|G|T)(i?)B?\s*")
DAMAGE = (
    *(zipfile.BadZipFile, zlib.error, EOFError, struct.error),
    *(
        RuntimeError,
        NotImplementedError,
        ValueError,
        OverflowError,
        tokenize.TokenError,
    ),  # the last: numpy's
)


@dataclass(frozen=True)
class Format:
    """A kind of archive."""

    name: str  # for people, with its article
    heart: str  # the file it must have
    maker: str  # what makes one
    remedy: str = "build or download it again"


ARCHIVE = ".npz"
NUMPY = Format(
    "an archive of NumPy", "", "numpy.savez makes one", "write it by numpy.savez, of numbers and texts"
)


@contextmanager
def reading(path: Path, kind: Format) -> Generator[tuple[BufferedReader, zipfile.ZipFile]]:
    """An archive's file, and the archive, which was found to be harmless.

    Raises TouchdownError where it cannot be read as one, also within the block.
    """
    try:
        found = path.stat()
        if not stat.S_ISREG(found.st_mode):
            raise TouchdownError(f"{path} is not {kind.name}: it is not a file")
        refuse_large(found.st_size, f"{path} has")
        with path.open("rb") as file, zipfile.ZipFile(file) as archive:
            _check_archive(path, archive)
            yield file, archive
    except FileNotFoundError:
        raise TouchdownError(f"there is no file {path}; {kind.maker}") from None
    except OSError as error:
        raise TouchdownError(f"cannot read {path}: {error.strerror or error}") from None
    except DAMAGE as error:
        raise TouchdownError(f"{path} is damaged or not {kind.name} ({error}); {kind.remedy}") from None


def size_limit() -> int:
    """How many bytes an archive may unpack to. Raises TouchdownError for a setting that is not a size."""
    asked = os.environ.get(VARIABLE)
    if not asked:
        return MAX_BYTES
    found = _SIZE.fullmatch(asked)
    try:
        number, prefix, binary = found.groups() if found else ("", "", "")
        return int(float(number) * (1024 if binary else 1000) ** " kMGT".index(prefix or " "))
    except (ValueError, OverflowError):
        raise TouchdownError(f"{VARIABLE} = {asked} is not a size; write such as 2 GiB or 800 MB") from None


def _check_archive(path: Path, archive: zipfile.ZipFile) -> None:
    """Raise TouchdownError where unpacking `archive`, read from `path`, would do harm.

    Entries that lead out of the folder or not to the same place everywhere, links, and more than a disk
    should take. An entry never unpacks to more than the size it states, so the sum of these is a bound, in
    memory only for the two methods that FMI and NumPy use.
    """
    entries = archive.infolist()
    for entry in entries:
        name = entry.filename
        if name.startswith("/") or ".." in PurePosixPath(name).parts:
            raise TouchdownError(f"{path} holds an entry {name!r} that leads out of its folder; refused")
        if unportable := next((mark for mark in UNPORTABLE if mark in name), None):
            raise TouchdownError(
                f"{path} holds an entry {name!r} with a {UNPORTABLE[unportable]}, which is another file on "
                "each system; refused (pack it anew, with / between folders)"
            )
        if stat.S_ISLNK(entry.external_attr >> 16):
            raise TouchdownError(f"{path} holds a link, {name!r}; refused")
        if entry.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
            raise TouchdownError(f"{path} holds {name!r} packed by another method than deflate; refused")
    refuse_large(sum(entry.file_size for entry in entries), f"{path} would unpack to")
    if len(entries) > MAX_ENTRIES:
        raise TouchdownError(f"{path} holds {len(entries)} entries, more than {MAX_ENTRIES}; refused")


def refuse_large(size: int, what: str) -> None:
    """Raise TouchdownError where `size` (bytes) is more than an archive may have."""
    if size > size_limit():
        raise TouchdownError(
            f"{what} {size / 1e6:.0f} MB, more than {size_limit() / 1e6:.0f} MB; refused (if it is right, "
            f'set {VARIABLE} to such as "2 GiB")'
        )


def read_archive(path: Path) -> dict[str, Any]:
    """The arrays of a NumPy archive by name. Raises TouchdownError."""
    import numpy as np  # deferred: packages are unpacked without it

    with reading(path, NUMPY) as (file, _):
        file.seek(0)
        try:
            with np.load(file, allow_pickle=False) as archive:
                return {name: archive[name] for name in archive.files}
        except (
            TypeError,
            AttributeError,
            KeyError,
            MemoryError,
        ) as error:  # of heads of no array
            raise ValueError(error) from None
