"""The one decorator behind every compiled kernel.

numba keeps machine code per source file, so a file that inlines a piece of another one would go on
using the old piece after that one changed. Here the cache folder is named by a hash over the sources
of all physics packages: any edit starts a fresh folder, and nothing stale is ever run.
"""

from __future__ import annotations

import hashlib
import os
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any, TypeVar, cast

import numba


@cache
def _by_content(record: Any) -> tuple[str, tuple[str]]:
    return type(record).__name__, (hashlib.sha256(record.name.encode()).hexdigest()[:24],)


# numba names machine code after the types it is for, and a record type after its turn in the process. Code
# kept by two processes may then bear one name for different records, and a third one that loads both, as
# for two bearings, runs the wrong one. Named after what it holds, a record has one name everywhere.
numba.types.Record.mangling_args = property(_by_content)  # type: ignore[misc, assignment]

PHYSICS_PACKAGES = ("modelkit", "rotor", "bearings")

F = TypeVar("F", bound=Callable[..., object])


def user_cache() -> Path:
    """Folder for machine code, built and unpacked FMUs (``TOUCHDOWN_CACHE`` overrides it)."""
    root = os.environ.get("TOUCHDOWN_CACHE")
    if root:
        return Path(root)
    base = os.environ.get("XDG_CACHE_HOME") or os.path.join(os.path.expanduser("~"), ".cache")
    return Path(base) / "touchdown-cosim"


@cache
def source_hash(packages: tuple[str, ...] = PHYSICS_PACKAGES) -> str:
    """Hash (16 hex digits) over the Python sources of `packages`, which stand beside this one."""
    root = Path(__file__).resolve().parents[1]
    digest = hashlib.sha256()
    for package in packages:
        for path in sorted((root / package).rglob("*.py")):
            digest.update(path.relative_to(root).as_posix().encode())
            digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


def kernel(function: F) -> F:
    """Compile `function` on first call and keep the machine code for later processes.

    IEEE arithmetic without reassociation (no fastmath): an FMU and the same model stepped in process
    must agree bit for bit.
    """
    return _compiled(function, forceinline=False)


def woven(function: F) -> F:
    """A kernel that becomes part of every kernel that calls it, whatever its length.

    For the bodies of loops that are to become vector code, which a call left in them would prevent.
    """
    return _compiled(function, forceinline=True)


def _compiled(function: F, forceinline: bool) -> F:
    before = numba.config.CACHE_DIR  # type: ignore[attr-defined]
    numba.config.CACHE_DIR = _machine_code_folder()  # type: ignore[attr-defined]
    try:
        return cast(F, numba.njit(cache=True, error_model="numpy", forceinline=forceinline)(function))
    finally:
        numba.config.CACHE_DIR = before  # type: ignore[attr-defined]


@cache
def _machine_code_folder() -> str:
    """The cache folder, or "" (numba's own choice, beside the source) where none can be written."""
    folder = user_cache() / "machine-code" / source_hash()
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError:
        return ""
    return str(folder) if os.access(folder, os.W_OK) else ""


def inlined(function: F) -> F:
    """Compile `function` into each caller, so that it may take other kernels as arguments.

    numba cannot cache a kernel that was handed another one as a value; inlined, the argument is a
    name known at compile time, and the caller is cached as usual. Right also for a piece of one kernel
    that stands apart to be read: a kernel of its own is compiled again for every kernel above it.
    """
    return cast(F, numba.njit(inline="always", error_model="numpy")(function))
