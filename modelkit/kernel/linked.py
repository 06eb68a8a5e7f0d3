"""Kernels as other kernels see them: code to be linked, and to become machine code with theirs.

numba compiles what a compiled function calls as if Python were to call it, too: behind two wrappers,
through all of LLVM down to machine code, and once for each integer that stands in a call, for each length
of an array in a record. That is linked into the caller and goes through LLVM again, on every level. Here a
kernel that another one calls stays as numba's front end leaves it; what Python calls is optimised once,
with all that it calls.
"""

from __future__ import annotations

from typing import Any

from numba import extending
from numba.core import compiler, types
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import CompileResult
from numba.core.registry import CPUDispatcher
from numba.core.typing.templates import make_concrete_template

from .front_end import FrontEnd, compiling

COMPILER_OPTIONS = {"nopython": True, "error_model": "numpy"}  # of every kernel
REFERENCE_COUNTING_PREFIX = "NRT_"  # begins the names of functions that count references
BUILTINS = "5numba7cpython8builtins"  # in the names of functions that numba has for min and max
INLINED = "alwaysinline"


class WholeCode(JITCodeLibrary):
    """Code of a kernel that Python calls; what that calls is called from nowhere else.

    LLVM may change how that is called. So it goes by another name: code that numba compiled looks for
    functions by their names, among internal ones, too. What counts references keeps its name, by which
    numba finds pairs that cancel each other: hundreds, which would take a third of a bearing's time. A call
    of min or max would keep loops over balls from becoming vector code: a fifth of a detailed one's time.
    """

    def _optimize_final_module(self) -> None:
        for function in self._final_module.functions:
            counting = function.name.startswith(REFERENCE_COUNTING_PREFIX)
            if not function.is_declaration and function.linkage.name == "linkonce_odr" and not counting:
                function.linkage, function.name = "internal", f"{function.name}.internal"
            if not function.is_declaration and BUILTINS in function.name:
                function.add_function_attribute(INLINED)
        super()._optimize_final_module()


class LinkedCode(JITCodeLibrary):
    """Code of a kernel and of all that it calls, for others to link; no machine code is made of it."""

    def finalize(self) -> None:
        self._raise_if_finalized()
        for library in dict.fromkeys(self._linking_libraries):
            self._reload_init.update(library._reload_init)
            self._final_module.link_in(library._get_module_for_linking(), preserve=True)
        self._finalize_dynamic_globals()
        self._finalized = True


class _Whole(FrontEnd):
    code = WholeCode


class _Linked(FrontEnd):
    code = LinkedCode


class KernelDispatcher(CPUDispatcher):
    """A kernel: to Python a function in machine code, to other kernels its `LinkedCode`.

    While kernels are `interpreted`, it is to Python the function that it was made of. numba is not told
    that one is inlined: it would inline what that calls, too, where nothing else has called it before.
    """

    interpreted = False
    _compiler: Any  # numba's: holds the function and what is known of its parameters
    _compiling_counter: Any  # by which numba finds recursion

    def __init__(self, py_func: Any, locals: Any = None, targetoptions: Any = None) -> None:
        options = COMPILER_OPTIONS | (targetoptions or {})
        self._inlined = options.pop("forceinline", False)
        super().__init__(py_func, locals, options, pipeline_class=_Whole)
        self._linked: dict[tuple[types.Type, ...], CompileResult] = {}

    def compile(self, sig: Any) -> Any:
        """The compiled function for a signature, as numba's dispatcher compiles it."""
        with compiling():
            return super().compile(sig)

    def __call__(self, *args: Any, **kws: Any) -> Any:
        run = self.py_func if KernelDispatcher.interpreted else super().__call__
        return run(*args, **kws)

    def get_call_template(self, args: Any, kws: Any) -> Any:
        """The call template that numba requests where a kernel is called with arguments of these types."""
        parameters, folded = self._compiler.fold_argument_types(args, kws)
        taken = tuple(map(_general, folded))
        signature = self._linked_for(taken).signature
        name = self.py_func.__name__
        template = make_concrete_template(f"Linked({name})", key=name, signatures=[signature])
        return template, parameters, taken, {}

    def get_overload(self, sig: Any) -> Any:
        """The descriptor by which numba knows the code for arguments of these types."""
        return self._linked[tuple(sig)].fndesc

    def _linked_for(self, taken: tuple[types.Type, ...]) -> CompileResult:
        if taken not in self._linked:
            with self._compiling_counter:
                self._linked[taken] = self._link(taken)
        return self._linked[taken]

    def _link(self, taken: tuple[types.Type, ...]) -> CompileResult:
        flags: Any = compiler.Flags()
        self.targetdescr.options.parse_as_flags(flags, self.targetoptions)
        flags.no_compile = flags.no_cpython_wrapper = flags.no_cfunc_wrapper = True
        arguments = self.typingctx, self.targetctx, self.py_func, taken, None, flags, self.locals
        linked = compiler.compile_extra(*arguments, pipeline_class=_Linked)
        if self._inlined:
            linked.library.get_function(linked.fndesc.llvm_func_name).add_function_attribute(INLINED)
        self.targetctx.insert_user_function(linked.fndesc, linked.fndesc, [linked.library])
        return linked


def _general(argument: types.Type) -> types.Type:
    """The type a kernel takes for an argument: none of its own for a number, for an array's length."""
    if isinstance(argument, types.NestedArray):
        return types.Array(argument.dtype, argument.ndim, "C")
    return types.unliteral(argument)


@extending.lower_cast(types.NestedArray, types.Array)
def _same_array(context: Any, builder: Any, from_type: Any, to_type: Any, value: Any) -> Any:
    """An array in a record as one of any length: both are the same struct, and it counts no references."""
    return value
