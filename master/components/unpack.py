"""Archives unpacked once, into folders named by their content; damaged folders are unpacked anew."""

from __future__ import annotations

import hashlib
import os
import shutil
import tempfile
import zipfile
import zlib
from pathlib import Path, PurePosixPath

from ...modelkit.archives import Format, reading
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

_PIECE = 2**20  # bytes read at a time


FMU = Format("an FMU", "modelDescription.xml", "`touchdown build` makes the project's own")


def unpack(path: Path, cache: Path, kind: Format = FMU) -> Path:
    """Unpack an archive into a folder of `cache` named by its content; returns the folder.

    Refuses archives of another kind, entries that would leave the folder, and too large ones. Where the
    user's cache has no room, a temporary one takes its place.
    """
    with reading(path, kind) as (file, archive):
        file.seek(0)
        name = hashlib.file_digest(file, "sha256").hexdigest()[:24]
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
