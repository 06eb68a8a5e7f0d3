"""Kernels that other kernels call: how often they are compiled, and what of it becomes machine code."""

from __future__ import annotations

import gc
import math
import subprocess
import sys
from typing import Any

import numba
import numpy as np
import pytest
from numba.core.codegen import JITCodeLibrary
from numba.core.dispatcher import Dispatcher
from numba.extending import overload

from touchdown.modelkit.kernel.linked import KernelDispatcher

RECORD = np.dtype([("short", "f8", (2,)), ("long", "f8", (5,))])


def kernel(function: Any) -> Any:
    """A kernel whose machine code is not kept."""
    return KernelDispatcher(function, targetoptions={"nopython": True, "error_model": "numpy"})


def linked(called: Any) -> list[tuple[Any, ...]]:
    """The types of arguments that a kernel was compiled for to be called by others."""
    return list(called._linked)


@kernel
def part(values: Any, which: int) -> Any:
    return values[which] + 0.5


@kernel
def negative(x: float) -> float:
    return -x


@kernel
def applied(law: Any, x: float) -> float:
    return law(x)


@kernel
def total(m: Any) -> float:
    return part(m.short, 0) + part(m.short, 1) + part(m.long, 4) + applied(negative, 3.0)


def record() -> Any:
    m = np.zeros(1, RECORD)
    m["short"], m["long"] = (1.0, 2.0), np.arange(5.0)
    return m[0]


def test_numbers_and_lengths_are_no_reason_to_compile_again() -> None:
    assert total(record()) == 1.5 + 2.5 + 4.5 - 3.0
    assert len(linked(part)) == 1
    assert str(linked(part)[0][1]) == "int64"


def test_only_what_python_calls_becomes_machine_code() -> None:
    total(record())
    assert isinstance(part, Dispatcher)
    assert len(total.overloads) == 1
    assert not part.overloads
    assert not applied.overloads
    assert part(np.array([7.0]), 0) == 7.5
    assert len(part.overloads) == 1


def test_what_is_called_is_in_the_code_that_calls_it() -> None:
    total(record())
    (compiled,) = total.overloads.values()
    outside = {f.name for f in compiled.library._final_module.functions if f.linkage.name == "external"}
    assert not [name for name in outside if "applied" in name or "negative" in name]


@pytest.mark.parametrize("first", ["kernel", "other"])
def test_code_of_others_is_compiled_as_they_ask(first: str) -> None:
    """What a kernel was compiled with does not decide how numba compiles the same call elsewhere."""

    def ratio(a, b):
        raise NotImplementedError

    @overload(ratio)
    def ratio_of(a, b):
        return lambda a, b: a / b

    @kernel
    def of_kernel(a, b):
        return ratio(a, b)

    @numba.njit
    def of_others(a, b):
        return ratio(a, b)

    def call_kernel() -> None:
        assert of_kernel(1.0, 0.0) == math.inf

    def call_others() -> None:
        with pytest.raises(ZeroDivisionError):
            of_others(1.0, 0.0)

    ask = numba.types.Function.get_call_type
    for call in (call_kernel, call_others) if first == "kernel" else (call_others, call_kernel):
        call()
    assert numba.types.Function.get_call_type is ask
    assert gc.isenabled()


def test_what_an_inlined_kernel_calls_first_is_not_inlined_for_that() -> None:
    shared = kernel(lambda x: x + 1.0)
    inlined = KernelDispatcher(lambda x: shared(x), targetoptions={"forceinline": True})
    assert kernel(lambda x: inlined(x))(1.0) == 2.0
    assert is_inlined(code_for_others(inlined))
    assert not is_inlined(code_for_others(shared))


def test_min_and_max_are_inlined(monkeypatch: pytest.MonkeyPatch) -> None:
    inlined: dict[str, bool] = {}  # before LLVM optimises, which leaves nothing of so short ones
    optimise = JITCodeLibrary._optimize_final_module

    def observed(library: Any) -> None:
        inlined.update((f.name, is_inlined(f)) for f in library._final_module.functions)
        optimise(library)

    monkeypatch.setattr(JITCodeLibrary, "_optimize_final_module", observed)
    assert kernel(lambda x: min(max(x, 0.0), 1.0))(2.0) == 1.0
    linked = {name: said for name, said in inlined.items() if name.endswith(".internal")}
    assert [said for name, said in linked.items() if "ol_min" in name] == [True]
    assert [said for name, said in linked.items() if "ol_max" in name] == [True]


def code_for_others(called: Any) -> Any:
    """LLVM's function of a kernel in the code that others link."""
    (compiled,) = called._linked.values()
    return compiled.library.get_function(compiled.fndesc.llvm_func_name)


def is_inlined(function: Any) -> bool:
    return any(b"alwaysinline" in attributes for attributes in function.attributes)


STEPPED = """
import sys
from touchdown.modelkit.kernel import front_end
if sys.argv[1] == "plain":
    front_end.NUMBA_RANGE = ((0, 1), (0, 1))
from touchdown.modelkit.kernel.machine_code import KernelCache
KernelCache.active = False
from touchdown.bearings.supports.housing import MODEL
from touchdown.modelkit.instance import Instance
instance = Instance(MODEL)
instance.memory["u"]["seat"]["fx"] = 100.0
instance.start(0.0)
for k in range(20):
    instance.step(k * 1e-4, 1e-4)
print(type(MODEL.advance).__name__, instance.words.tobytes().hex())
"""


@pytest.mark.slow
def test_where_numba_is_another_one_it_compiles_as_it_does_with_the_same_results() -> None:
    """Each way in a process of its own."""
    answers = [
        subprocess.run(
            [sys.executable, "-c", STEPPED, way], check=True, capture_output=True, text=True
        ).stdout.split()
        for way in ("plain", "linked")
    ]
    assert [answer[0] for answer in answers] == ["CPUDispatcher", "KernelDispatcher"]
    assert answers[0][1] == answers[1][1]
    assert set(answers[0][1]) != {"0"}
