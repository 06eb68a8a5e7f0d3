"""numba's way from a function to LLVM code, with types found once, and code named by its sources.

Most of the time that a kernel takes to compile is numba's own, in Python; a sixth of it went into trying
dozens of candidates for the type of each sum, product and element of an array.
"""

from __future__ import annotations

import gc
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from importlib.metadata import version
from typing import Any

from numba.core import types
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import Compiler, Flags
from numba.core.compiler_lock import global_compiler_lock

from .sources import source_hash

NUMBA_RANGE = ((0, 68), (0, 68))  # the first and the last


@cache
def is_tried() -> bool:
    """Whether numba is of a version among them."""
    numbers = tuple(int(part) for part in version("numba").split(".")[:2])
    return NUMBA_RANGE[0] <= numbers <= NUMBA_RANGE[1]


_resolved: dict[tuple[types.Function, tuple[types.Type, ...]], Any] = {}


@contextmanager
def compiling() -> Iterator[None]:
    """While a kernel is compiled: types are found once, and Python looks for no garbage.

    numba tries all candidates for a signature each time. What is found depends on the options that are
    compiled with, so it is kept for kernels alone, which have the same, and code of others asks numba.
    """
    with global_compiler_lock:
        ask, collects = types.Function.get_call_type, gc.isenabled()

        def once(function: types.Function, context: Any, args: tuple[types.Type, ...], kws: Any) -> Any:
            if kws or type(function) is not types.Function:
                return ask(function, context, args, kws)
            if (function, args) not in _resolved:
                _resolved[function, args] = ask(function, context, args, kws)
            return _resolved[function, args]

        types.Function.get_call_type = once  # type: ignore[method-assign]
        gc.disable()
        try:
            yield
        finally:
            types.Function.get_call_type = ask  # type: ignore[method-assign]
            if collects:
                gc.enable()


class _NamedFlags(Flags):
    """Compiler flags whose name in machine code includes the sources of the kernel.

    Sources of several versions may be in one process, in packages that are called alike where their machine
    code was kept.
    """

    def get_mangle_string(self) -> str:
        return f"{super().get_mangle_string()}{source_hash()}"


class FrontEnd(Compiler):
    """Compiles into `code`."""

    code: type[JITCodeLibrary] = JITCodeLibrary

    def define_pipelines(self) -> Any:
        state = self.state
        state.flags = _NamedFlags(state.flags)
        state.library = self.code(state.targetctx.codegen(), state.func_id.func_qualname)
        state.library.enable_object_caching()
        return super().define_pipelines()
