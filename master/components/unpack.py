"""Archives unpacked once, into folders named by their content."""

from __future__ import annotations

import hashlib
import shutil
import tempfile
import zipfile
import zlib
from dataclasses import dataclass
from pathlib import Path

from touchdown.master.common.archives import refuse_hostile
from touchdown.master.common.errors import TouchdownError


@dataclass(frozen=True)
class Format:
    """A kind of archive."""

    name: str  # for people, with its article
    heart: str  # the file it must have
    maker: str  # what makes one


FMU = Format("an FMU", "modelDescription.xml", "`touchdown build` makes the project's own")


def unpack(path: Path, cache: Path, kind: Format = FMU) -> Path:
    """Unpack an archive into a folder named by its content; returns the folder.

    Refuses what is not of that kind and entries that would leave the folder.
    """
    try:
        content = path.read_bytes()
    except FileNotFoundError:
        raise TouchdownError(f"there is no file {path}; {kind.maker}") from None
    except OSError as error:
        raise TouchdownError(f"cannot read {path}: {error.strerror}") from None
    folder = cache / "unpacked" / hashlib.sha256(content).hexdigest()[:24]
    if folder.is_dir():
        return folder
    folder.parent.mkdir(parents=True, exist_ok=True)
    fresh = Path(tempfile.mkdtemp(dir=folder.parent))
    try:
        with zipfile.ZipFile(path) as archive:
            refuse_hostile(path, archive)
            if kind.heart not in archive.namelist():
                raise TouchdownError(f"{path} is not {kind.name}: it has no {kind.heart}")
            archive.extractall(fresh)
        try:
            fresh.rename(folder)
        except OSError:
            if not folder.is_dir():  # else another process was first
                raise
    except (zipfile.BadZipFile, EOFError, RuntimeError, NotImplementedError, OSError, zlib.error) as error:
        raise TouchdownError(
            f"{path} is damaged or not {kind.name} ({error}); build or download it again"
        ) from None
    finally:
        shutil.rmtree(fresh, ignore_errors=True)
    return folder
