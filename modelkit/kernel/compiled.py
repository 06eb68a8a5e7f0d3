"""How kernels are compiled.

A kernel's machine code holds that of the kernels it calls (`linked`), and would go on using it after they
changed. So the folder it is kept in (`machine_code`) is named by a hash over the sources of all physics
packages: any edit starts a fresh folder, and nothing stale is ever run.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Mapping
from functools import cache
from pathlib import Path
from typing import Any, TypeVar, cast

import numba
import numpy as np
from numba.core import config
from numba.core.dispatcher import Dispatcher

from .cache_folder import own_folder
from .front_end import is_tried
from .machine_code import FOLDER, KernelCache
from .sources import PHYSICS_PACKAGES, source_hash


@cache
def _by_content(record: Any) -> tuple[str, tuple[str]]:
    return type(record).__name__, (hashlib.sha256(record.name.encode()).hexdigest()[:24],)


# numba names machine code after the types it is for, and a record type after its turn in the process. Code
# kept by two processes may then bear one name for different records, and a third one that loads both, as
# for two bearings, runs the wrong one. Named after what it holds, a record has one name everywhere.
numba.types.Record.mangling_args = property(_by_content)  # type: ignore[misc, assignment]

F = TypeVar("F", bound=Callable[..., object])


def kernel(function: F) -> F:
    """Compile `function` on first call and keep the machine code for later processes.

    It may take other kernels as arguments; then it is for kernels to call, as Python's calls of it cannot
    be kept. IEEE arithmetic without reassociation (no fastmath): an FMU and the same model stepped in
    process must agree bit for bit.
    """
    return _compiled(function, PHYSICS_PACKAGES)


def kernel_of(*folders: str, nogil: bool = False) -> Callable[[F], F]:
    """`kernel` for functions that call none but those in `folders`, which stand beside `modelkit`.

    Their machine code depends on these sources alone. nogil: while Python calls one, other threads run.
    """

    def kernel(function: F) -> F:
        return _compiled(function, folders, nogil=nogil)

    return kernel


def inlined(function: F) -> F:
    """A kernel that becomes part of every kernel that calls it, at any length.

    For the bodies of loops that are to become vector code, which a call left in them would prevent.
    """
    return _compiled(function, PHYSICS_PACKAGES, forceinline=True)


def _compiled(function: F, packages: tuple[str, ...], **options: bool) -> F:
    compiled = _dispatcher(function, options)
    folder = _machine_code_folder(packages)
    if folder is not None and isinstance(compiled, Dispatcher):  # not where numba is told not to compile
        cast(Any, compiled)._cache = KernelCache(function, folder)
    return cast(F, compiled)


def _dispatcher(function: Callable[..., object], options: Mapping[str, bool]) -> object:
    """`linked`, or, with a numba that this was not tried with, what numba makes of it: the same results."""
    if cast(Any, config).DISABLE_JIT or not is_tried():
        return cast(Any, numba).njit(error_model="numpy", **options)(function)
    from .linked import KernelDispatcher

    return KernelDispatcher(function, targetoptions=options)


def interpret(function: Callable[..., Any], *args: Any) -> Any:
    """Run a kernel, and all that it calls, as Python: compiling what is called once is not worth it.

    Machine code gives the same result to the last bit, and runs instead with a numba that this was not
    tried with. Records in `args` must be `MemoryRecord`s. Raises ArithmeticError or ValueError, part of the
    way through, where IEEE arithmetic goes on with an infinity or a NaN.
    """
    if not isinstance(function, Dispatcher) or not is_tried():
        return function(*args)
    from .linked import KernelDispatcher

    KernelDispatcher.interpreted = True
    try:
        with np.errstate(all="ignore"):
            return function(*args)
    finally:
        KernelDispatcher.interpreted = False


@cache
def _machine_code_folder(packages: tuple[str, ...]) -> Path | None:
    """Where machine code of these sources is kept; None where nothing can be."""
    try:
        return own_folder(FOLDER, source_hash(packages))
    except OSError:
        return None
