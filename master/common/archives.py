"""ZIP archives: what one from elsewhere must not hold, and one that is equal for equal content."""

from __future__ import annotations

import os
import stat
import zipfile
from collections.abc import Mapping
from pathlib import Path, PurePosixPath

from touchdown.master.common.errors import TouchdownError

LARGEST = 2 * 1024**3  # bytes, unpacked
MOST = 20_000  # entries


def refuse_hostile(path: Path, archive: zipfile.ZipFile) -> None:
    """Raise TouchdownError where unpacking `archive`, read from `path`, would do harm.

    Entries that lead out of the folder, links, and more than a disk should take. An entry never unpacks
    to more than the size it states, so the sum of these is a bound.
    """
    entries = archive.infolist()
    for entry in entries:
        name = entry.filename
        if name.startswith("/") or ".." in PurePosixPath(name).parts or ":" in name or "\\" in name:
            raise TouchdownError(f"{path} holds an entry {name!r} that leads out of its folder; refused")
        if stat.S_ISLNK(entry.external_attr >> 16):
            raise TouchdownError(f"{path} holds a link, {name!r}; refused")
    size = sum(entry.file_size for entry in entries)
    if size > LARGEST:
        raise TouchdownError(
            f"{path} would unpack to {size / 1e6:.0f} MB, more than {LARGEST / 1e6:.0f} MB; refused"
        )
    if len(entries) > MOST:
        raise TouchdownError(f"{path} holds {len(entries)} entries, more than {MOST}; refused")


def write_archive(path: Path, content: Mapping[str, bytes]) -> None:
    """Write `content`, files by name, in that order; an older archive is replaced.

    Fixed times and no compression. Raises TouchdownError where it cannot be written.
    """
    from touchdown.fmus.build import EPOCH  # imports all models, which unpacking can do without

    fresh = path.with_name(f".{path.name}.{os.getpid()}")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        try:
            with zipfile.ZipFile(fresh, "w") as archive:
                for name, data in content.items():
                    entry = zipfile.ZipInfo(name, EPOCH)
                    entry.external_attr = 0o644 << 16
                    archive.writestr(entry, data)
            fresh.replace(path)
        finally:
            fresh.unlink(missing_ok=True)
    except OSError as error:
        raise TouchdownError(
            f"cannot write {path}: {error.strerror}; choose another file with -o"
        ) from None
