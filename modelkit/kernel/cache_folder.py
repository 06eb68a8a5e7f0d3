"""The folder that outlives a process: machine code, built and unpacked FMUs, their sources.

What lies there is run, so it must be this user's: made readable for nobody else, and used only where it
belongs to the user and nobody else can write. Where that cannot be had, a temporary folder takes its place,
for this process and those it starts, and one line says so. Standard library only: the sources in an FMU
read this file before they are a package.
"""

from __future__ import annotations

import atexit
import errno
import os
import shutil
import stat
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

VARIABLE = "TOUCHDOWN_CACHE"
TAG, SIGNATURE = "CACHEDIR.TAG", "Signature: 8a477f597d28d172789f06886806bc55\n"  # bford.info/cachedir
KINDS = ("machine-code", "fmus", "sources", "unpacked", "rotors", "peers")  # of what is kept
_PROBE = 4096  # bytes that must find room
_OTHERS = stat.S_IWGRP | stat.S_IWOTH
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


def put(path: Path, content: bytes) -> None:
    """Write a file of the cache in one go: another process finds all of it, or what was there before."""
    with tempfile.NamedTemporaryFile(dir=path.parent, prefix=".", delete=False) as file:
        try:
            file.write(content)
            file.flush()
            os.replace(file.name, path)
        except BaseException:
            os.unlink(file.name)
            raise


def why_temporary() -> str:
    """The fault of the requested cache where a temporary one takes its place; else ""."""
    return _temporary.get(user_cache(), "")


def is_users(root: Path) -> bool:
    """Whether `root` is what `user_cache` gave, now or before it had to be given up."""
    return root in _settled.values()


def is_cache(root: Path) -> bool:
    """Whether a folder was made to be the cache, and may be cleaned up: not one that holds other things."""
    return (root / TAG).is_file()


def is_own(found: os.stat_result) -> bool:
    """Whether a file or folder belongs to this user, and nobody else can write it."""
    if not hasattr(os, "geteuid"):  # Windows: folders of users are theirs
        return True
    return found.st_uid == os.geteuid() and not found.st_mode & _OTHERS


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
    root.mkdir(mode=0o700, parents=True, exist_ok=True)
    there = set(os.listdir(root))
    older = KINDS[0] in there and there <= set(KINDS)  # than the tag is
    if not there or older:
        (root / TAG).write_text(SIGNATURE, encoding="ascii")
    if is_cache(root):
        _make_private(root)
    _require_own(root)
    with tempfile.TemporaryFile(dir=root) as probe:
        probe.write(bytes(_PROBE))
    return root


def _entered(root: Path, parts: tuple[str, ...]) -> Path:
    if not root.is_dir():  # removed meanwhile
        _usable(root)
    folder = root
    for part in parts:
        folder = folder / part
        if not folder.is_dir():
            folder.unlink(missing_ok=True)  # a file, or a link that leads nowhere
            folder.mkdir(mode=0o700, exist_ok=True)
        _make_private(folder)
        _require_own(folder)
    if parts:
        os.utime(folder)
    return folder


def _make_private(folder: Path) -> None:
    found = folder.stat()
    if hasattr(os, "geteuid") and found.st_uid == os.geteuid() and found.st_mode & 0o077:
        folder.chmod(0o700)


def _require_own(folder: Path) -> None:
    found = folder.stat()
    if not is_own(found):
        why = "others can write it" if found.st_mode & _OTHERS else "it belongs to another user"
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


def leave() -> None:
    """Remove temporary caches: of a process that ends without its exit handlers."""
    for folder in _temporary:
        shutil.rmtree(folder, ignore_errors=True)


def _remove(folder: Path, process: int) -> None:
    if os.getpid() == process:  # not one it forked
        shutil.rmtree(folder, ignore_errors=True)
