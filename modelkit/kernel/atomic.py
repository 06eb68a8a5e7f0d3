"""Words that threads share: what one wrote before it stored a word, another finds that has loaded it."""

from __future__ import annotations

import platform
from typing import Any

from llvmlite import ir
from numba import types

from touchdown.modelkit.kernel.address import intrinsic

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
def load(_: Any, address: Any) -> Any:
    """The word at an address."""

    def generate(context: Any, builder: Any, signature: Any, given: Any) -> Any:
        return builder.load_atomic(_at(builder, given[0]), "acquire", WORD)

    return types.intp(types.intp), generate


@intrinsic
def store(_: Any, address: Any, word: Any) -> Any:
    """Store a word at an address."""

    def generate(context: Any, builder: Any, signature: Any, given: Any) -> Any:
        builder.store_atomic(given[1], _at(builder, given[0]), "release", WORD)
        return context.get_dummy_value()

    return types.none(types.intp, types.intp), generate


@intrinsic
def swap(_: Any, address: Any, expected: Any, word: Any) -> Any:
    """Store a word at an address if the `expected` one still stands there; whether it did."""

    def generate(context: Any, builder: Any, signature: Any, given: Any) -> Any:
        found = builder.cmpxchg(_at(builder, given[0]), given[1], given[2], "acq_rel", "acquire")
        return builder.extract_value(found, 1)

    return types.boolean(types.intp, types.intp, types.intp), generate


@intrinsic
def add(_: Any, address: Any, number: Any) -> Any:
    """Add a number to the word at an address."""

    def generate(context: Any, builder: Any, signature: Any, given: Any) -> Any:
        builder.atomic_rmw("add", _at(builder, given[0]), given[1], "acq_rel")
        return context.get_dummy_value()

    return types.none(types.intp, types.intp), generate


@intrinsic
def pause(_: Any) -> Any:
    """Tell the processor that this thread waits for another."""

    def generate(context: Any, builder: Any, signature: Any, given: Any) -> Any:
        name, numbers = HINTS.get(platform.machine(), ("", ()))
        if name:
            integer = ir.IntType(32)
            kind = ir.FunctionType(ir.VoidType(), [integer] * len(numbers))
            hint = builder.module.declare_intrinsic(name, fnty=kind)
            builder.call(hint, [ir.Constant(integer, n) for n in numbers])
        return context.get_dummy_value()

    return types.none(), generate
