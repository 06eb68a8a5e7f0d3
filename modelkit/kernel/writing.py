"""The one place where the project creates, replaces and removes files and folders.

A name in a folder may be a link to a file of the user's, or of somebody else. So content goes into a new
file whose name no other has (O_EXCL) and takes its place by a rename, which replaces a link and not the
file behind it; and a file that is written in place is opened without following a link (O_NOFOLLOW).
`tests/test_writing.py` finds code that writes in another way. Standard library only: the sources in an FMU
read this file before they are a package.
"""

from __future__ import annotations

import errno
import io
import os
import shutil
import stat
import tempfile
from collections.abc import Generator, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import BinaryIO, TextIO

_NOFOLLOW: int = getattr(os, "O_NOFOLLOW", 0)  # Windows has neither links by default, nor these
_CLOEXEC: int = getattr(os, "O_CLOEXEC", 0)
_NONBLOCK: int = getattr(os, "O_NONBLOCK", 0)
_BINARY: int = getattr(os, "O_BINARY", 0)
_OTHERS = stat.S_IWGRP | stat.S_IWOTH
_PART = ".part"  # ends the name of a file that is not whole yet


PRIVATE = 0o600  # mode of a file for this user alone, with any umask


def open_new(path: Path, mode: int = 0o666) -> int:
    """Descriptor, to read and write, of a new file at `path`, where there is none. Raises OSError."""
    return os.open(path, os.O_RDWR | os.O_CREAT | os.O_EXCL | _NOFOLLOW | _CLOEXEC | _BINARY, mode)


def open_in_place(path: Path, flags: int) -> int:
    """Descriptor of a file that is written in place. Raises OSError, also where the name is a link.

    A second name (a hard link) counts as a link. flags: those of `os.open`, O_CREAT among them.
    """
    try:
        descriptor = os.open(path, flags | _NOFOLLOW | _NONBLOCK | _CLOEXEC | _BINARY, 0o666)
    except OSError as error:
        if error.errno == errno.ELOOP:
            raise _refused(path) from None
        raise
    found = os.fstat(descriptor)
    if not stat.S_ISREG(found.st_mode) or found.st_nlink > 1:
        os.close(descriptor)
        raise _refused(path)
    return descriptor


def _refused(path: Path) -> OSError:
    return OSError(errno.ELOOP, f"{path.name} is a link or no regular file; remove it", str(path))


@contextmanager
def replacing(path: Path, mode: int = 0o666) -> Generator[BinaryIO]:
    """A file, open to write; it takes the place of what is at `path` when the block ends without an error.

    This user's own file there keeps its permissions to read and write, as far as `mode` has them. Raises
    OSError.
    """
    kept = _kept_mode(path, mode)
    part = path.with_name(f".{path.name[:100]}.{os.urandom(8).hex()}{_PART}")
    descriptor = open_new(part, mode if kept is None else kept)
    try:
        with os.fdopen(descriptor, "w+b") as file:
            if kept is not None:
                os.fchmod(descriptor, kept)  # the umask may have taken some
            yield file
        os.replace(part, path)  # closed: Windows neither renames nor removes an open file
    except BaseException:
        with suppress(OSError):
            os.unlink(part)
        raise


def _kept_mode(path: Path, mode: int) -> int | None:
    """What of `mode` the file at `path` has; None where there is none, a link, or another user's."""
    try:
        found = path.lstat()
    except OSError:
        return None
    owned = hasattr(os, "geteuid") and found.st_uid == os.geteuid()  # Windows has no such modes
    return found.st_mode & mode & 0o666 if owned and stat.S_ISREG(found.st_mode) else None


@contextmanager
def replacing_text(path: Path) -> Generator[TextIO]:
    """The same as UTF-8 text, whose line ends stay as they are written."""
    with replacing(path) as file:
        text = io.TextIOWrapper(file, encoding="utf-8", newline="")
        yield text
        text.flush()
        text.detach()


@contextmanager
def replacing_by_name(path: Path) -> Generator[Path]:
    """A path in a private folder, for programs that write by name; the file there goes to `path`."""
    with tempfile.TemporaryDirectory(prefix="touchdown_", ignore_cleanup_errors=True) as folder:
        written = Path(folder) / f"made{path.suffix.lower()}"
        yield written
        with replacing(path) as file, written.open("rb") as content:
            shutil.copyfileobj(content, file)


def write(path: Path, content: str | bytes, mode: int = 0o666) -> Path:
    """Write a file, whole or not at all, in place of what is at `path`; text as UTF-8. Raises OSError."""
    with replacing(path, mode) as file:
        file.write(content.encode() if isinstance(content, str) else content)
    return path


def unfinished(path: Path) -> Iterator[Path]:
    """Files that were to become the one at `path` when their process was killed."""
    for other in path.parent.iterdir() if path.parent.is_dir() else ():
        if other.name.startswith(f".{path.name[:100]}.") and other.name.endswith(_PART):
            yield other


def make_folder(path: Path, mode: int = 0o777) -> Path:
    """Make a folder and those above it, all of a mode; what is there stays unchanged. Raises OSError."""
    try:
        path.mkdir(mode)
    except FileNotFoundError:
        make_folder(path.parent, mode)
        path.mkdir(mode, exist_ok=True)
    except FileExistsError:
        if not path.is_dir():
            raise
    return path


def move(path: Path, target: Path) -> Path:
    """Give a file or folder another name, which replaces a file or a link of that name. Raises OSError."""
    return path.replace(target)


def remove_file(path: Path) -> None:
    """Remove a file or a link, which is not followed, where there is one. Raises OSError."""
    path.unlink(missing_ok=True)


def remove(path: Path) -> None:
    """Remove a file, a folder with all it holds, or a link, which is not followed. Raises OSError."""
    if path.is_dir() and not path.is_symlink():
        shutil.rmtree(path)
    else:
        path.unlink(missing_ok=True)


def discard(path: Path) -> None:
    """Remove what is at `path` as far as that is possible."""
    with suppress(OSError):
        remove(path)


def child_path(folder: Path, name: str) -> Path:
    """The path of `name` in a folder. Raises OSError where `name`, as it was read, leads elsewhere."""
    if name in ("", ".", "..") or "\0" in name or Path(name).name != name:
        raise OSError(errno.EINVAL, f"{name!r} cannot be the name of a file in it", str(folder))
    return folder / name


def is_own(found: os.stat_result) -> bool:
    """Whether a file or folder belongs to this user, and no other user can write it."""
    if not hasattr(os, "geteuid"):  # Windows: folders of users are theirs
        return True
    return found.st_uid == os.geteuid() and not found.st_mode & _OTHERS


def read_own(path: Path) -> bytes:
    """The content of this user's file. Raises OSError where it is a link, or others can write it."""
    with os.fdopen(open_own(path), "rb") as file:
        return file.read()


def open_own(path: Path) -> int:
    """Descriptor, to read, of this user's file. Raises OSError as `read_own` does."""
    descriptor = os.open(path, os.O_RDONLY | _NOFOLLOW | _NONBLOCK | _CLOEXEC | _BINARY)
    found = os.fstat(descriptor)
    if stat.S_ISREG(found.st_mode) and is_own(found):
        return descriptor
    os.close(descriptor)
    raise PermissionError(errno.EPERM, "it is not a file of this user's alone", str(path))


def holds_exactly(folder: Path, files: set[str]) -> bool:
    """Whether a folder has these files (paths from it, with /) and no others, all this user's alone.

    Folders on the way to them must be this user's as well; links are neither. Bytecode that Python left
    (`__pycache__`) counts unless it is asked for by name: remove it first.
    """
    found: set[str] = set()
    waiting = [("", folder)]
    try:
        while waiting:
            above, place = waiting.pop()
            if not is_own_folder(place):
                return False
            for entry in os.scandir(place):
                name = f"{above}{entry.name}"
                about = entry.stat(follow_symlinks=False)
                if stat.S_ISDIR(about.st_mode):
                    waiting.append((f"{name}/", Path(entry.path)))
                elif stat.S_ISREG(about.st_mode) and is_own(about):
                    found.add(name)
                else:
                    return False
    except OSError:
        return False
    return found == files


def is_own_folder(path: Path) -> bool:
    """Whether a folder is there, is not a link, and is this user's alone."""
    try:
        found = path.lstat()
    except OSError:
        return False
    return stat.S_ISDIR(found.st_mode) and is_own(found)
