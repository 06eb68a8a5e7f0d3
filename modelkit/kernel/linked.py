"""Kernels as other kernels see them: code to be linked, which is optimised and made machine code with theirs.

numba compiles whatever a compiled function calls as if Python were to call it, too: behind two wrappers, through
all of LLVM, down to machine code, and once for each integer that stands in a call and each length of an array
in a record. All of that is then linked into the caller and goes through LLVM again, on every level. Here a
kernel that is called by another one stays as numba's front end leaves it; what Python calls is optimised once,
with all that it calls.
"""

from __future__ import annotations

from typing import Any

from numba import extending
from numba.core import compiler, types, typing, typed_passes, untyped_passes
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import Compiler, CompileResult
from numba.core.registry import CPUDispatcher
from numba.core.utils import OPERATORS_TO_BUILTINS

NOT_FOR_KERNELS = (  # passes for what no kernel has: closures, `with`, literally(), inlining by numba; and reports
    untyped_passes.WithLifting,
    untyped_passes.InlineClosureLikes,
    untyped_passes.RewriteSemanticConstants,
    untyped_passes.DeadBranchPrune,
    untyped_passes.MakeFunctionToJitFunction,
    untyped_passes.InlineInlinables,
    untyped_passes.FindLiterallyCalls,
    untyped_passes.LiteralUnroll,
    untyped_passes.LiteralPropagationSubPipelinePass,
    typed_passes.InlineOverloads,
    typed_passes.NoPythonSupportedFeatureValidation,
    typed_passes.AnnotateTypes,
    typed_passes.DumpParforDiagnostics,
)


class WholeCode(JITCodeLibrary):
    """Code of a kernel that Python calls: what it calls is known to be called from here alone."""

    def _optimize_final_module(self) -> None:
        for function in self._final_module.functions:
            if not function.is_declaration and function.linkage.name == "linkonce_odr":
                function.linkage = "internal"
        super()._optimize_final_module()


class LinkedCode(JITCodeLibrary):
    """Code of a kernel and all that it calls, for others to link; there is no machine code of it."""

    def finalize(self) -> None:
        self._raise_if_finalized()
        for library in dict.fromkeys(self._linking_libraries):
            self._reload_init.update(library._reload_init)
            self._final_module.link_in(library._get_module_for_linking(), preserve=True)
        self._finalize_dynamic_globals()
        self._finalized = True


class _Typing:
    """numba's typing context, asked once what an operator makes of numbers of certain types."""

    def __init__(self, context: Any) -> None:
        self._context = context
        self._known: dict[Any, Any] = {}

    def __getattr__(self, name: str) -> Any:
        return getattr(self._context, name)

    def resolve_function_type(self, function: Any, args: tuple[types.Type, ...], kws: Any) -> Any:
        """The signature of `function` for arguments of these types."""
        operation = function.typing_key if isinstance(function, types.Function) else None
        if operation not in OPERATORS_TO_BUILTINS or not all(map(_is_number, args)):
            return self._context.resolve_function_type(function, args, kws)
        if (operation, args) not in self._known:
            self._known[operation, args] = self._context.resolve_function_type(function, args, kws)
        return self._known[operation, args]


def _is_number(kind: types.Type) -> bool:
    return type(kind) in (types.Float, types.Integer, types.IntegerLiteral, types.Boolean)


_TYPING = _Typing(CPUDispatcher.targetdescr.typing_context)


class _Whole(Compiler):
    """numba's passes but for some, with `WholeCode` for what they generate."""

    code: type[JITCodeLibrary] = WholeCode

    def define_pipelines(self) -> Any:
        state = self.state
        state.typingctx = _TYPING
        state.library = self.code(state.targetctx.codegen(), state.func_id.func_qualname)
        state.library.enable_object_caching()
        pipelines = super().define_pipelines()
        for pipeline in pipelines:
            pipeline.passes = [known for known in pipeline.passes if known[0] not in NOT_FOR_KERNELS]
        return pipelines


class _Linked(_Whole):
    """The same with `LinkedCode`."""

    code = LinkedCode


class KernelDispatcher(CPUDispatcher):
    """A kernel: to Python a function in machine code, to other kernels its `LinkedCode`."""

    def __init__(self, py_func: Any, locals: Any = None, targetoptions: Any = None) -> None:
        super().__init__(py_func, locals, targetoptions, pipeline_class=_Whole)
        self._linked: dict[tuple[types.Type, ...], CompileResult] = {}

    def get_call_template(self, args: Any, kws: Any) -> Any:
        """What numba asks for where a kernel is called with arguments of these types."""
        parameters, folded = self._compiler.fold_argument_types(args, kws)
        taken = tuple(map(_general, folded))
        linked = self._linked_for(taken)
        name = self.py_func.__name__
        template = typing.make_concrete_template(f"Linked({name})", key=name, signatures=[linked.signature])
        return template, parameters, taken, {}

    def get_overload(self, sig: Any) -> Any:
        """What numba knows the code for these types by."""
        return self._linked[tuple(sig)].fndesc

    def _linked_for(self, taken: tuple[types.Type, ...]) -> CompileResult:
        linked = self._linked.get(taken)
        if linked is None:
            with self._compiling_counter:
                linked = self._linked[taken] = self._link(taken)
        return linked

    def _link(self, taken: tuple[types.Type, ...]) -> CompileResult:
        flags = compiler.Flags()
        self.targetdescr.options.parse_as_flags(flags, self.targetoptions)
        flags.no_compile = flags.no_cpython_wrapper = flags.no_cfunc_wrapper = True
        linked = compiler.compile_extra(
            self.typingctx, self.targetctx, self.py_func, taken, None, flags, self.locals, pipeline_class=_Linked
        )
        self.targetctx.insert_user_function(linked.fndesc, linked.fndesc, [linked.library])
        return linked


def _general(argument: types.Type) -> types.Type:
    """The type that a kernel takes for an argument: no code of its own for a number, or an array's length."""
    if isinstance(argument, types.NestedArray):
        return types.Array(argument.dtype, argument.ndim, "C")
    return types.unliteral(argument)


@extending.lower_cast(types.NestedArray, types.Array)
def _same_array(context: Any, builder: Any, given: Any, wanted: Any, value: Any) -> Any:
    """An array in a record as one of any length: both are the same struct, and this one counts no references."""
    return value
