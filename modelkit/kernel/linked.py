"""Kernels as other kernels see them: code to be linked, which is optimised and made machine code with theirs.

numba compiles whatever a compiled function calls as if Python were to call it, too: behind two wrappers, through
all of LLVM, down to machine code, and once for each integer that stands in a call. All of that is then linked
into the caller and goes through LLVM again, on every level. Here a kernel that is called by another one stays
as numba's front end leaves it; what Python calls is optimised once, with all that it calls.
"""

from __future__ import annotations

from typing import Any

from numba import extending
from numba.core import compiler, types, typing
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import Compiler, CompileResult
from numba.core.registry import CPUDispatcher


@extending.lower_cast(types.NestedArray, types.Array)
def _same_array(context: Any, builder: Any, given: Any, wanted: Any, value: Any) -> Any:
    """An array in a record as one of any length: both are the same struct, and this one counts no references."""
    return value


def _general(argument: types.Type) -> types.Type:
    """The type that a kernel takes for an argument: no code of its own for a number, or an array's length."""
    if isinstance(argument, types.NestedArray):
        return types.Array(argument.dtype, argument.ndim, "C")
    return types.unliteral(argument)


class LinkedCode(JITCodeLibrary):
    """Code of a kernel and all that it calls, for others to link; there is no machine code of it."""

    def finalize(self) -> None:
        self._raise_if_finalized()
        for library in dict.fromkeys(self._linking_libraries):
            self._reload_init.update(library._reload_init)
            self._final_module.link_in(library._get_module_for_linking(), preserve=True)
        self._finalize_dynamic_globals()
        self._finalized = True


class _Linked(Compiler):
    """numba's passes, with `LinkedCode` for what they generate."""

    def define_pipelines(self) -> Any:
        state = self.state
        state.library = LinkedCode(state.targetctx.codegen(), state.func_id.func_qualname)
        return super().define_pipelines()


class KernelDispatcher(CPUDispatcher):
    """A kernel: to Python what numba makes of a function, to other kernels its `LinkedCode`."""

    def __init__(self, *given: Any, **options: Any) -> None:
        super().__init__(*given, **options)
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
                linked = self._link(taken)
            self._linked[taken] = linked
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
