"""numba's way from a function to LLVM code, without what kernels have no use for.

Most of the time that a kernel takes to compile is numba's own, in Python: over a third of its passes look
for what no kernel contains, and the type of each sum and product is found by trying dozens of candidates.
"""

from __future__ import annotations

from functools import cache
from importlib.metadata import version
from typing import Any

from numba.core import typed_passes, types, untyped_passes
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import Compiler, Flags
from numba.core.compiler_lock import global_compiler_lock
from numba.core.compiler_machinery import PassManager

from .sources import source_hash

NUMBA_RANGE = ((0, 68), (0, 68))  # the first and the last


@cache
def is_tried() -> bool:
    """Whether numba is of a version among them."""
    numbers = tuple(int(part) for part in version("numba").split(".")[:2])
    return NUMBA_RANGE[0] <= numbers <= NUMBA_RANGE[1]


# `with`, branches on constants, literally(), functions that numba inlines; checks, reports
UNUSED_PASSES = (
    untyped_passes.WithLifting,
    untyped_passes.RewriteSemanticConstants,
    untyped_passes.DeadBranchPrune,
    untyped_passes.InlineInlinables,
    untyped_passes.FindLiterallyCalls,
    untyped_passes.LiteralUnroll,
    untyped_passes.LiteralPropagationSubPipelinePass,
    typed_passes.InlineOverloads,
    typed_passes.NoPythonSupportedFeatureValidation,
    typed_passes.AnnotateTypes,
    typed_passes.DumpParforDiagnostics,
)


_resolved: dict[tuple[types.Function, tuple[types.Type, ...]], Any] = {}
_resolve = types.Function.get_call_type


def _resolve_once(function: types.Function, context: Any, args: tuple[types.Type, ...], kws: Any) -> Any:
    """The signature of a function for these types; numba itself tries all candidates each time."""
    if kws or type(function) is not types.Function:
        return _resolve(function, context, args, kws)
    if (function, args) not in _resolved:
        _resolved[function, args] = _resolve(function, context, args, kws)
    return _resolved[function, args]


if is_tried():
    types.Function.get_call_type = _resolve_once  # type: ignore[method-assign]


class _NamedFlags(Flags):
    """Compiler flags whose name in machine code includes the sources of the kernel.

    Sources of several versions may be in one process, in packages that are called alike where their machine
    code was kept.
    """

    def get_mangle_string(self) -> str:
        return f"{super().get_mangle_string()}{source_hash()}"


class _Passes(PassManager):
    """numba's passes in their order, without its events, timers and printouts.

    For these numba writes out the types of all arguments before each pass, whether or not somebody listens.
    """

    @global_compiler_lock
    def _runPass(self, index: int, pss: Any, internal_state: Any) -> None:
        pss.analysis = self._analysis
        for part in (pss.run_initialization, pss.run_pass, pss.run_finalizer):
            part(internal_state)


class FrontEnd(Compiler):
    """Compiles into `code`."""

    code: type[JITCodeLibrary] = JITCodeLibrary

    def define_pipelines(self) -> Any:
        state = self.state
        state.flags = _NamedFlags(state.flags)
        state.library = self.code(state.targetctx.codegen(), state.func_id.func_qualname)
        state.library.enable_object_caching()
        pipelines = super().define_pipelines()
        for pipeline in pipelines:
            pipeline.passes = [known for known in pipeline.passes if known[0] not in UNUSED_PASSES]
            pipeline.__class__ = _Passes
        return pipelines
