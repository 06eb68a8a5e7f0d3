"""Archives unpacked once, into folders named by their content; damaged folders are unpacked anew."""

from __future__ import annotations

import hashlib
import os
import re
import shutil
import stat
import tempfile
import zipfile
import zlib
from collections.abc import Generator
from contextlib import contextmanager
from dataclasses import dataclass
from io import BufferedReader
from pathlib import Path, PurePosixPath

from ...modelkit.kernel import cache_folder
from ...modelkit.kernel.writing import (
    PRIVATE,
    discard,
    holds_exactly,
    is_own_folder,
    make_folder,
    move,
    open_new,
    open_own,
)
from ..common.errors import TouchdownError

MAX_BYTES = 512 * 1024**2  # bytes, unpacked; VARIABLE says otherwise
VARIABLE = "TOUCHDOWN_LARGEST_FMU"
MAX_ENTRIES = 20_000  # entries
UNPORTABLE = {"\\": "backslash", ":": "colon"}  # folders, drives and streams for some, letters for others
_SIZE = re.compile(r"\s*([0-9.]+(?:e[0-9]+)?)\s*(|k|M|G|T)(i?)B?\s*")
_PIECE = 2**20  # bytes read at a time


@dataclass(frozen=True)
class Format:
    """A kind of archive."""

    name: str  # for people, with its article
    heart: str  # the file it must have
    maker: str  # what makes one


FMU = Format("an FMU", "modelDescription.xml", "`touchdown build` makes the project's own")
ARCHIVE_ERRORS = (zipfile.BadZipFile, EOFError, RuntimeError, NotImplementedError, ValueError, zlib.error)


def unpack(path: Path, cache: Path, kind: Format = FMU) -> Path:
    """Unpack an archive into a folder of `cache` named by its content; returns the folder.

    Refuses archives of another kind, entries that would leave the folder, and too large ones. Where the
    user's cache has no room, a temporary one takes its place.
    """
    with _reading(path, kind) as file:
        name = hashlib.file_digest(file, "sha256").hexdigest()[:24]
        with zipfile.ZipFile(file) as archive:
            _check_archive(path, archive)
            if kind.heart not in archive.namelist():
                raise TouchdownError(f"{path} is not {kind.name}: it has no {kind.heart}")
            try:
                if cache_folder.is_users(cache):
                    return cache_folder.made_in_cache(
                        lambda folder: _unpacked(archive, folder / name), "unpacked"
                    )
                return _unpacked(archive, cache / "unpacked" / name)
            except OSError as error:
                raise TouchdownError(f"cannot unpack {path}: {error.strerror or error}") from None


@contextmanager
def _reading(path: Path, kind: Format) -> Generator[BufferedReader]:
    """The archive's file. Raises TouchdownError where it cannot be read as one."""
    try:
        found = path.stat()
        if not stat.S_ISREG(found.st_mode):
            raise TouchdownError(f"{path} is not {kind.name}: it is not a file")
        _refuse_large(found.st_size, f"{path} has")
        with path.open("rb") as file:
            yield file
    except FileNotFoundError:
        raise TouchdownError(f"there is no file {path}; {kind.maker}") from None
    except OSError as error:
        raise TouchdownError(f"cannot read {path}: {error.strerror}") from None
    except ARCHIVE_ERRORS as error:
        raise TouchdownError(
            f"{path} is damaged or not {kind.name} ({error}); build or download it again"
        ) from None


def _unpacked(archive: zipfile.ZipFile, folder: Path) -> Path:
    """`folder` with the archive's files. Raises OSError where they cannot be written."""
    if _is_unpacked(archive, folder):
        os.utime(folder)  # it is in use
        return folder
    make_folder(folder.parent, 0o700)
    fresh = Path(tempfile.mkdtemp(prefix=".", dir=folder.parent))
    try:
        _extract(archive, fresh / "content")
        if _is_unpacked(archive, folder):
            return folder  # another process was first
        if os.path.lexists(folder):
            move(folder, fresh / "before")
        move(fresh / "content", folder)
    except OSError:
        if not _is_unpacked(archive, folder):  # or another process was first
            raise
    finally:
        discard(fresh)
    return folder


def _extract(archive: zipfile.ZipFile, folder: Path) -> None:
    """All files of an archive that was found to be harmless, for this user alone, into a new folder."""
    make_folder(folder, 0o700)
    for entry in _last_entries(archive):
        path = folder / entry.filename
        make_folder(path if entry.is_dir() else path.parent, 0o700)
        if not entry.is_dir():
            with archive.open(entry) as content, os.fdopen(open_new(path, PRIVATE), "wb") as file:
                shutil.copyfileobj(content, file)


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

    It refuses entries that lead out of the folder or to other places on other systems, links, and more
    bytes than a disk should take. An entry never unpacks
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
    _refuse_large(sum(entry.file_size for entry in entries), f"{path} would unpack to")
    if len(entries) > MAX_ENTRIES:
        raise TouchdownError(f"{path} holds {len(entries)} entries, more than {MAX_ENTRIES}; refused")


def _refuse_large(size: int, what: str) -> None:
    """Raise TouchdownError where `size` (bytes) is more than an archive may have."""
    if size > size_limit():
        raise TouchdownError(
            f"{what} {size / 1e6:.0f} MB, more than {size_limit() / 1e6:.0f} MB; refused (if it is right, "
            f'set {VARIABLE} to such as "2 GiB")'
        )


def _last_entries(archive: zipfile.ZipFile) -> list[zipfile.ZipInfo]:
    """Its files and folders; of those with the same name, the last."""
    return list({str(PurePosixPath(entry.filename)): entry for entry in archive.infolist()}.values())


def _is_unpacked(archive: zipfile.ZipFile, folder: Path) -> bool:
    """Whether `folder` has the files of the archive and no others, with its checksums, all this user's.

    Bytecode that Python left there is removed first: its source is unknown.
    """
    if not is_own_folder(folder):
        return False
    for compiled in folder.rglob("__pycache__"):
        discard(compiled)
    files = {
        str(PurePosixPath(entry.filename)): entry for entry in _last_entries(archive) if not entry.is_dir()
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
