"""The folder that outlives a process: machine code, built and unpacked FMUs, their sources.

What lies there is run, so it must be this user's: made readable for this user alone, and used only where it
belongs to the user and no other user can write it. A folder that was open to others is not closed and then
trusted: no mode is ever changed. Where that cannot be had, a temporary folder takes its place, for this
process and those it starts, and one line says so. Standard library only: the sources in an FMU read this
file before they are a package.
"""

from __future__ import annotations

import atexit
import errno
import os
import sys
import tempfile
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

from .writing import PRIVATE, discard, is_own, make_folder, open_new, remove_file, write

VARIABLE = "TOUCHDOWN_CACHE"
TAG, SIGNATURE = "CACHEDIR.TAG", "Signature: 8a477f597d28d172789f06886806bc55\n"  # bford.info/cachedir
KINDS = ("machine-code", "fmus", "sources", "unpacked", "rotors", "peers")  # of what is kept
_PROBE = 4096  # bytes that must find room
_NO_ROOM = {errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EROFS, errno.EACCES, errno.EPERM, errno.EIO}

_settled: dict[str | None, Path] = {}  # by what was asked for
_temporary: dict[Path, str] = {}  # and what is wrong with the one in whose place it is


def user_cache() -> Path:
    """The cache's folder: ``TOUCHDOWN_CACHE``, or touchdown-cosim in the user's folder of caches.

    It is made where it is missing. Raises OSError where not even a temporary one can be had.
    """
    asked = os.environ.get(VARIABLE) or None
    if asked not in _settled:
        try:
            _settled[asked] = _usable(_cache_root(asked))
        except OSError as error:
            _retreat(asked, error)
    return _settled[os.environ.get(VARIABLE) or None]


def own_folder(*parts: str) -> Path:
    """A folder in the cache, made where it is missing; it belongs to the user, and is marked as used."""
    try:
        return _entered(user_cache(), parts)
    except OSError as error:
        _retreat(os.environ.get(VARIABLE) or None, error)
        return _entered(user_cache(), parts)


def made_in_cache(make: Callable[[Path], Path], *parts: str) -> Path:
    """The result of `make` in a folder of the cache, or of a temporary cache where there is no room.

    Raises OSError where there is none there, either, and what else `make` meets.
    """
    try:
        return make(own_folder(*parts))
    except OSError as error:
        if error.errno not in _NO_ROOM:
            raise
        _retreat(os.environ.get(VARIABLE) or None, error)
        return make(own_folder(*parts))


def put_file(path: Path, content: bytes) -> None:
    """Write a file of the cache in one go: another process finds all of it, or what was there before."""
    write(path, content, PRIVATE)


def why_temporary() -> str:
    """The fault of the requested cache where a temporary one takes its place; else ""."""
    return _temporary.get(user_cache(), "")


def is_users(root: Path) -> bool:
    """Whether `root` is what `user_cache` gave, now or before it had to be given up."""
    return root in _settled.values()


def is_cache(root: Path) -> bool:
    """Whether a folder was made to be the cache, and may be cleaned up: not one that holds other things."""
    return (root / TAG).is_file()


def _cache_root(asked: str | None) -> Path:
    """Where the cache is to be. Raises OSError where nothing says so."""
    if asked:
        return Path(asked).absolute()
    base = os.environ.get("XDG_CACHE_HOME", "")
    if not os.path.isabs(base) and os.environ.get("HOME") != "":
        base = os.path.join(os.path.expanduser("~"), ".cache")
    if not os.path.isabs(base):
        raise OSError("nothing says where: HOME is not set")
    return Path(base) / "touchdown-cosim"


def _usable(root: Path) -> Path:
    """`root`, made and found fit for use. Raises OSError where it is not."""
    make_folder(root, 0o700)
    _require_own(root)
    there = set(os.listdir(root))
    older = KINDS[0] in there and there <= set(KINDS)  # than the tag is
    if not there or older:
        with suppress(FileExistsError), os.fdopen(open_new(root / TAG, PRIVATE), "wb") as tag:
            tag.write(SIGNATURE.encode("ascii"))
    with tempfile.TemporaryFile(dir=root) as probe:
        probe.write(bytes(_PROBE))
    return root


def _entered(root: Path, parts: tuple[str, ...]) -> Path:
    if not root.is_dir():  # removed meanwhile
        _usable(root)
    folder = root
    for part in parts:
        folder = folder / part
        if folder.is_symlink() or not folder.is_dir():
            with suppress(IsADirectoryError):  # another process has just made it
                remove_file(folder)  # a file, or a link, wherever it leads
            make_folder(folder, 0o700)
        _require_own(folder)
    if parts:
        os.utime(folder)
    return folder


def _require_own(folder: Path) -> None:
    found = folder.stat()
    if not is_own(found):
        others = found.st_uid == os.geteuid()
        why = (
            "others can write it; remove it, or chmod -R go-w it"
            if others
            else "it belongs to another user"
        )
        raise PermissionError(errno.EPERM, why, str(folder))


def _retreat(asked: str | None, error: OSError) -> None:
    """Put a temporary folder in the cache's place, and say so. Raises `error` where one is already."""
    if asked is not None and Path(asked) in _temporary:
        raise error
    where = f"{error.filename or asked or ''} ({error.strerror or error})".strip()
    folder = Path(tempfile.mkdtemp(prefix="touchdown_cache_"))
    _settled[str(folder)] = folder
    _temporary[folder] = where
    os.environ[VARIABLE] = str(folder)  # processes started from here share it
    atexit.register(_remove, folder, os.getpid())
    if sys.stderr is not None:
        sys.stderr.write(
            f"touchdown: warning: cannot use the cache {where}; a temporary one takes its place, "
            f"so compiling starts anew; set {VARIABLE} to a folder of yours\n"
        )


def _remove(folder: Path, process: int) -> None:
    if os.getpid() == process:  # not one it forked
        discard(folder)
