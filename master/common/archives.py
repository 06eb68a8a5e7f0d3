"""ZIP archives: what one from elsewhere must not hold, and one that is equal for equal content."""

from __future__ import annotations

import os
import re
import stat
import zipfile
import zlib
from collections.abc import Mapping
from pathlib import Path, PurePosixPath

from ...modelkit.kernel.writing import discard, holds_exactly, is_own_folder, make_folder, open_own
from .errors import TouchdownError

MAX_BYTES = 512 * 1024**2  # bytes, unpacked; VARIABLE says otherwise
VARIABLE = "TOUCHDOWN_LARGEST_FMU"
MAX_ENTRIES = 20_000  # entries
UNPORTABLE = {"\\": "backslash", ":": "colon"}  # folders, drives and streams for some, letters for others
_SIZE = re.compile(r"\s*([0-9.]+(?:e[0-9]+)?)\s*(|k|M|G|T)(i?)B?\s*")
_PIECE = 2**20  # bytes read at a time


def largest() -> int:
    """How many bytes an archive may unpack to. Raises TouchdownError for a setting that is no size."""
    asked = os.environ.get(VARIABLE)
    if not asked:
        return MAX_BYTES
    found = _SIZE.fullmatch(asked)
    try:
        number, prefix, binary = found.groups() if found else ("", "", "")
        return int(float(number) * (1024 if binary else 1000) ** " kMGT".index(prefix or " "))
    except (ValueError, OverflowError):
        raise TouchdownError(f"{VARIABLE} = {asked} is no size; write such as 2 GiB or 800 MB") from None


def refuse_hostile(path: Path, archive: zipfile.ZipFile) -> None:
    """Raise TouchdownError where unpacking `archive`, read from `path`, would do harm.

    Entries that lead out of the folder or not to the same place everywhere, links, and more than a disk
    should take. An entry never unpacks
    to more than the size it states, so the sum of these is a bound.
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
    refuse_large(sum(entry.file_size for entry in entries), f"{path} would unpack to")
    if len(entries) > MAX_ENTRIES:
        raise TouchdownError(f"{path} holds {len(entries)} entries, more than {MAX_ENTRIES}; refused")


def refuse_large(size: int, what: str) -> None:
    """Raise TouchdownError where `size` (bytes) is more than an archive may have."""
    if size > largest():
        raise TouchdownError(
            f"{what} {size / 1e6:.0f} MB, more than {largest() / 1e6:.0f} MB; refused (if that is right, "
            f'set {VARIABLE} to such as "2 GiB")'
        )


def last_entries(archive: zipfile.ZipFile) -> list[zipfile.ZipInfo]:
    """Its files and folders; of those with the same name, the last."""
    return list({str(PurePosixPath(entry.filename)): entry for entry in archive.infolist()}.values())


def is_unpacked(archive: zipfile.ZipFile, folder: Path) -> bool:
    """Whether `folder` has the files of the archive and no others, with its checksums, all this user's.

    Bytecode that Python left there is removed first: nothing says what it was made of.
    """
    if not is_own_folder(folder):
        return False
    for compiled in folder.rglob("__pycache__"):
        discard(compiled)
    files = {
        str(PurePosixPath(entry.filename)): entry for entry in last_entries(archive) if not entry.is_dir()
    }
    return holds_exactly(folder, set(files)) and all(_matches(folder / n, e) for n, e in files.items())


def _matches(path: Path, entry: zipfile.ZipInfo) -> bool:
    found = 0
    try:
        with os.fdopen(open_own(path), "rb") as file:
            if os.fstat(file.fileno()).st_size != entry.file_size:
                return False
            while piece := file.read(_PIECE):
                found = zlib.crc32(piece, found)
    except OSError:
        return False
    return found == entry.CRC


def write_archive(path: Path, content: Mapping[str, bytes]) -> None:
    """Write `content`, files by name, in that order; an older archive is replaced.

    Fixed times and no compression. Raises TouchdownError where it cannot be written.
    """
    from ...fmus.build import write_zip  # imports all models, which unpacking can do without

    try:
        make_folder(path.parent)
        write_zip(path, content)
    except OSError as error:
        raise TouchdownError(
            f"cannot write {path}: {error.strerror}; choose another file with -o"
        ) from None
