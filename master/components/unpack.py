"""Archives unpacked once, into folders named by their content; what is damaged there is unpacked anew."""

from __future__ import annotations

import hashlib
import os
import shutil
import stat
import tempfile
import zipfile
import zlib
from collections.abc import Generator
from contextlib import contextmanager
from dataclasses import dataclass
from io import BufferedReader
from pathlib import Path

from ...modelkit.kernel import cache_folder
from ...modelkit.kernel.writing import PRIVATE, discard, make_folder, move, open_new
from ..common.archives import is_unpacked, last_entries, refuse_hostile, refuse_large
from ..common.errors import TouchdownError


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

    Refuses what is not of that kind, entries that would leave the folder, and what is too large. Where the
    user's cache has no room, a temporary one takes its place.
    """
    with _reading(path, kind) as file:
        name = hashlib.file_digest(file, "sha256").hexdigest()[:24]
        with zipfile.ZipFile(file) as archive:
            refuse_hostile(path, archive)
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
            raise TouchdownError(f"{path} is not {kind.name}: it is no file")
        refuse_large(found.st_size, f"{path} has")
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
    if is_unpacked(archive, folder):
        os.utime(folder)  # it is in use
        return folder
    make_folder(folder.parent, 0o700)
    fresh = Path(tempfile.mkdtemp(prefix=".", dir=folder.parent))
    try:
        _extract(archive, fresh / "content")
        if is_unpacked(archive, folder):
            return folder  # another process was first
        if os.path.lexists(folder):
            move(folder, fresh / "before")
        move(fresh / "content", folder)
    except OSError:
        if not is_unpacked(archive, folder):  # or another process was first
            raise
    finally:
        discard(fresh)
    return folder


def _extract(archive: zipfile.ZipFile, folder: Path) -> None:
    """All files of an archive that was found to be harmless, for this user alone, into a new folder."""
    make_folder(folder, 0o700)
    for entry in last_entries(archive):
        path = folder / entry.filename
        make_folder(path if entry.is_dir() else path.parent, 0o700)
        if not entry.is_dir():
            with archive.open(entry) as content, os.fdopen(open_new(path, PRIVATE), "wb") as file:
                shutil.copyfileobj(content, file)
