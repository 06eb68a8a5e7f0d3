"""Ways in which a file comes to harm."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path

Damage = Callable[[Path], object]


def cut(path: Path, share: float = 0.5) -> None:
    """Keep a share of it."""
    content = path.read_bytes()
    path.write_bytes(content[: int(share * len(content))])


def emptied(path: Path) -> None:
    """Nothing in it."""
    path.write_bytes(b"")


def flipped(path: Path, at: float = 0.5) -> None:
    """One bit, at a share of its length."""
    content = bytearray(path.read_bytes())
    content[int(at * len(content))] ^= 0x10
    path.write_bytes(content)


def other(path: Path) -> None:
    """Something else, of the same length."""
    path.write_bytes(bytes((7 * i * i + 13 * i) % 251 for i in range(path.stat().st_size)))


def removed(path: Path) -> None:
    """Gone, a folder with all in it."""
    if path.is_dir():
        shutil.rmtree(path)
    else:
        path.unlink()


def folder(path: Path) -> None:
    """A folder in its place, with something in it."""
    removed(path)
    path.mkdir()
    (path / "in the way").write_bytes(b"x")


def file(path: Path) -> None:
    """A file in its place."""
    removed(path)
    path.write_bytes(b"in the way")


def link(path: Path) -> None:
    """A link that leads nowhere in its place."""
    removed(path)
    path.symlink_to("/no/such/place")


OF_FILES = {one.__name__: one for one in (cut, emptied, flipped, other, removed, folder, link)}
"""Damages of a file by name."""
