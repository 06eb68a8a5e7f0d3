"""FMUs and packages as the archives that they are: what is in them, and copies that say something else."""

from __future__ import annotations

import zipfile
from collections.abc import Mapping
from pathlib import Path


def entries_of(path: Path) -> dict[str, bytes]:
    """All entries by name."""
    with zipfile.ZipFile(path) as source:
        return {name: source.read(name) for name in source.namelist()}


def archive(path: Path, entries: Mapping[str, bytes | str]) -> Path:
    """An archive of these entries, whatever their names."""
    with zipfile.ZipFile(path, "w") as target:
        for name, content in entries.items():
            target.writestr(name, content)
    return path


def saying(source: Path, to: Path, old: str, new: str, entry: str = "modelDescription.xml") -> Path:
    """A copy whose entry has another text in place of `old`, which must be there."""
    entries = entries_of(source)
    text = entries[entry].decode()
    assert old in text
    return archive(to, {**entries, entry: text.replace(old, new).encode()})
