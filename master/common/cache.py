"""The cache: its contents, and its clean-up by age and size.

What goes is made again when it is missed, so nothing is lost but time. What else stands in the
folder, of another kind than the cache's own, is left alone, always.
"""

from __future__ import annotations

import os
import time
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from ...modelkit.kernel.cache_folder import KINDS, TAG, is_cache, user_cache
from ...modelkit.kernel.writing import remove as remove_path

MAX_AGE_DAYS = 30.0  # days without use after which an entry goes
MAX_BYTES = 2 * 1024**3  # bytes, of all entries
IN_USE_DAYS = 1.0  # days within which an entry is taken to be in use
LOOK_INTERVAL_S = 3600.0  # s between two looks at the whole cache, unasked
DAY = 86400.0  # s
DESCRIPTIONS = {  # of the kinds, for people
    "machine-code": "compiled kernels, by version",
    "fmus": "the project's own FMUs, by version",
    "sources": "what these run, by version",
    "unpacked": "unpacked FMUs and SSP packages",
    "rotors": "rotor files of rotors made in Python",
    "peers": "environments of tests with other tools",
}
# Scenes name the files of the first, the others are not of the command
PERMANENT_KINDS = "rotors", "peers"


@dataclass(frozen=True)
class Entry:
    """Something that is kept as a whole, and goes as a whole."""

    path: Path
    kind: str
    size: int  # bytes
    used: float  # when last, s since the epoch


def cache_entries(root: Path) -> list[Entry]:
    """All that the cache at `root` holds."""
    return [
        Entry(path, kind, _size(path), path.lstat().st_mtime)
        for kind in KINDS
        if (folder := root / kind).is_dir() and not folder.is_symlink()
        for path in sorted(folder.iterdir())
    ]


def _size(path: Path) -> int:
    """Bytes of a file, or of all files in a folder, links not followed."""
    if path.is_symlink() or not path.is_dir():
        return path.lstat().st_size
    total = 0
    for folder, _, names in os.walk(path):
        for name in names:
            try:
                total += os.lstat(os.path.join(folder, name)).st_size
            except OSError:  # gone meanwhile
                continue
    return total


def rebuildable(held: Iterable[Entry]) -> list[Entry]:
    """Of `held`, all but PERMANENT_KINDS."""
    return [entry for entry in held if entry.kind not in PERMANENT_KINDS]


def stale(
    held: Iterable[Entry], moment: float, age: float = MAX_AGE_DAYS, limit: float = MAX_BYTES
) -> list[Entry]:
    """Of `held`, what was not used for `age` (days), and the longest unused above `limit` (bytes) in all.

    For the size nothing goes that was used within IN_USE_DAYS days: other processes may be at it. What a
    process left unfinished goes after as long.
    """
    oldest_first = sorted(rebuildable(held), key=lambda entry: entry.used)
    total = sum(entry.size for entry in oldest_first)
    found: list[Entry] = []
    for entry in oldest_first:
        days = (moment - entry.used) / DAY
        unfinished = entry.path.name.startswith(".")
        if days > age or (days > IN_USE_DAYS and (unfinished or total > limit)):
            found.append(entry)
            total -= entry.size
    return found


def remove_entries(chosen: Iterable[Entry]) -> int:
    """Remove entries; returns the bytes that are free now. Raises OSError for what cannot be removed."""
    freed = 0
    for entry in chosen:
        remove_path(entry.path)
        freed += entry.size
    return freed


def remove_stale() -> None:
    """Remove what is stale, quietly and once in a while."""
    try:
        root, moment = user_cache(), time.time()
        if is_cache(root) and moment - (root / TAG).stat().st_mtime > LOOK_INTERVAL_S:
            os.utime(root / TAG)
            remove_entries(stale(cache_entries(root), moment))
    except OSError:  # another process is at it
        return
