"""Memory, machine code and words shared by threads, reached by their addresses from within a kernel.

A kernel that calls others by address is compiled once for all that it calls. Two conventions are known:
that of FMI 2.0's C functions, and that of `Model.advance`, which is numba's own and left to numba.
"""

from __future__ import annotations

import platform
from collections.abc import Callable
from typing import Any

from llvmlite import ir
from numba import extending, types
from numba.core import cgutils
from numba.core.dispatcher import Dispatcher
from numba.np.arrayobj import populate_array

intrinsic: Any = extending.intrinsic  # which takes its functions' first parameter away

ADVANCE = (types.float64[::1], types.float64[:, ::1], types.float64, types.float64)


def advance_address(advance: Callable[..., Any]) -> int:
    """Where the machine code of a model's `advance` stands; 0: there is none, as before its first call."""
    if not isinstance(advance, Dispatcher):  # numba is told not to compile
        return 0
    compiled: Any = advance.overloads.get(ADVANCE)
    if compiled is None or types.unliteral(compiled.signature.return_type) != types.int64:
        return 0
    return compiled.library.get_pointer_to_function(compiled.fndesc.llvm_func_name)


def _array(item: types.Type) -> Any:
    """An intrinsic: the array of a length, or of rows and columns, whose items stand at an address."""

    @intrinsic
    def array(_: Any, address: Any, shape: Any) -> Any:
        array_type = types.Array(item, len(shape) if isinstance(shape, types.UniTuple) else 1, "C")

        def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
            sizes = cgutils.unpack_tuple(builder, arguments[1]) if array_type.ndim > 1 else [arguments[1]]
            width = context.get_abi_sizeof(context.get_data_type(item))
            strides = [context.get_constant(types.intp, width)]
            for size in reversed(sizes[1:]):
                strides.insert(0, builder.mul(size, strides[0]))
            built = context.make_array(array_type)(context, builder)
            populate_array(
                built,
                data=builder.inttoptr(arguments[0], built.data.type),
                shape=sizes,
                strides=strides,
                itemsize=width,
                meminfo=None,
            )
            return built._getvalue()

        return array_type(types.intp, shape), generate

    return array


float64_at, int64_at, int32_at = map(_array, (types.float64, types.int64, types.int32))


@intrinsic
def call_advance(_: Any, address: Any, words: Any, work: Any, time: Any, step: Any) -> Any:
    """The `advance` at an address, of its memory, its scratch, time (s) and step (s): a status.

    Where it raises an error, that is -1: who waits for it in another thread would not hear of it.
    """

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        convention = context.call_conv
        argument_types = signature.args[1:]
        kind = convention.get_function_type(types.int64, argument_types)
        code = builder.inttoptr(arguments[0], kind.as_pointer())
        status, result = convention.call_function(builder, code, types.int64, argument_types, arguments[1:])
        return builder.select(status.is_error, context.get_constant(types.int64, -1), result)

    return types.int64(types.intp, *ADVANCE), generate


@intrinsic
def call_exchange(_: Any, address: Any, component: Any, references: Any, count: Any, values: Any) -> Any:
    """The fmi2SetReal, or a function that gets, at an address, of addresses and a count: a status."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        status, word = ir.IntType(32), context.get_value_type(types.intp)
        kind = ir.FunctionType(status, [word] * 4)
        answer = builder.call(builder.inttoptr(arguments[0], kind.as_pointer()), arguments[1:])
        return builder.sext(answer, word)

    return types.intp(*[types.intp] * 5), generate


@intrinsic
def call_step(_: Any, address: Any, component: Any, time: Any, step: Any) -> Any:
    """The fmi2DoStep at an address, for good, of a component's address, time (s) and step (s): a status."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        status, word, real = ir.IntType(32), context.get_value_type(types.intp), ir.DoubleType()
        kind = ir.FunctionType(status, [word, real, real, status])
        code = builder.inttoptr(arguments[0], kind.as_pointer())
        return builder.sext(builder.call(code, [*arguments[1:], ir.Constant(status, 1)]), word)

    return types.intp(types.intp, types.intp, types.float64, types.float64), generate


@intrinsic
def call_plain(_: Any, address: Any) -> Any:
    """Call the C function at an address, which takes nothing and answers an int."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        kind = ir.FunctionType(ir.IntType(32), [])
        builder.call(builder.inttoptr(arguments[0], kind.as_pointer()), [])
        return context.get_dummy_value()

    return types.none(types.intp), generate


WORD = 8  # bytes
HINTS = {
    "x86_64": ("llvm.x86.sse2.pause", ()),
    "aarch64": ("llvm.aarch64.hint", (1,)),
    "arm64": ("llvm.aarch64.hint", (1,)),
}
"""By processor: the instruction that says that a thread waits, and what it is given."""


def _at(builder: Any, address: Any) -> Any:
    return builder.inttoptr(address, ir.IntType(8 * WORD).as_pointer())


@intrinsic
def load_word(_: Any, address: Any) -> Any:
    """The word at an address."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return builder.load_atomic(_at(builder, arguments[0]), "acquire", WORD)

    return types.intp(types.intp), generate


@intrinsic
def store(_: Any, address: Any, word: Any) -> Any:
    """Store a word at an address."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        builder.store_atomic(arguments[1], _at(builder, arguments[0]), "release", WORD)
        return context.get_dummy_value()

    return types.none(types.intp, types.intp), generate


@intrinsic
def swap(_: Any, address: Any, expected: Any, word: Any) -> Any:
    """Store a word at an address if the `expected` one still stands there; whether it did."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        found = builder.cmpxchg(_at(builder, arguments[0]), *arguments[1:], "acq_rel", "acquire")
        return builder.extract_value(found, 1)

    return types.boolean(types.intp, types.intp, types.intp), generate


@intrinsic
def add_to_word(_: Any, address: Any, number: Any) -> Any:
    """Add a number to the word at an address."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        builder.atomic_rmw("add", _at(builder, arguments[0]), arguments[1], "acq_rel")
        return context.get_dummy_value()

    return types.none(types.intp, types.intp), generate


@intrinsic
def pause(_: Any) -> Any:
    """Tell the processor that this thread waits for another."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        name, numbers = HINTS.get(platform.machine(), ("", ()))
        if name:
            integer = ir.IntType(32)
            kind = ir.FunctionType(ir.VoidType(), [integer] * len(numbers))
            hint = builder.module.declare_intrinsic(name, fnty=kind)
            builder.call(hint, [ir.Constant(integer, n) for n in numbers])
        return context.get_dummy_value()

    return types.none(), generate
