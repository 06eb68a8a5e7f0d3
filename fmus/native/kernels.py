"""A model's kernels as LLVM bitcode, free of Python and of the machine that compiled them.

numba compiles for the process it runs in: for its processor, with what it kept from other times, and behind
wrappers that speak Python. So this module runs as a program of its own, in which nothing kept is used, the
processor is a plain one, and each function's code is put aside before numba makes machine code of it, which
leaves intrinsics of the machine behind. Entries take plain pointers. They have numba's own calling
convention, which is not public (`numba.core.callconv.CPUCallConv`: status = f(&result, &exception,
arguments...)): hence `front_end.NUMBA_RANGE`, the versions it was tried with.
"""

from __future__ import annotations

import hashlib
import json
import os
import platform
import subprocess
import sys
import tempfile
from collections.abc import Mapping
from importlib import import_module
from importlib.metadata import version
from pathlib import Path
from typing import Any, cast

from ...modelkit.integrators import dopri
from ...modelkit.kernel import source_hash
from ...modelkit.kernel.cache_folder import own_folder, put_file
from ...modelkit.kernel.front_end import NUMBA_RANGE
from ...modelkit.kernel.linked import KernelDispatcher
from ...modelkit.kernel.machine_code import KernelCache, sealed, unsealed
from ...modelkit.kernel.writing import write
from ...modelkit.model import Model
from .compiler import NativeError

ENTRIES = ("derive", "start", "advance")
BARE = {"no_cpython_wrapper": True, "no_cfunc_wrapper": True}  # entries are for C alone
PREFIX = "kernel_"  # of the entries' names
# The least processor that code for this kind of machine is made for, as LLVM calls it
PROCESSOR = {"x86_64": "x86-64-v3", "AMD64": "x86-64-v3"}.get(platform.machine(), "generic")


def bitcode(model: Model) -> bytes:
    """LLVM bitcode of a model's derive, start and advance, compiled on first use and kept.

    Raises NativeError where numba is of a version that this was not tried with, or cannot compile them.
    """
    _require_numba()
    order = _order(model)
    text = json.dumps(order, sort_keys=True)
    build = hashlib.sha256(Path(__file__).read_bytes()).hexdigest()
    parts = (text, build, version("numba"), version("llvmlite"), PROCESSOR)
    key = hashlib.sha256(" ".join(parts).encode()).hexdigest()[:24]
    kept = own_folder("machine-code", source_hash()) / f"native-{key}.bc"
    code = unsealed(kept)
    if code is None:
        code = _compiled_elsewhere(model.name, text)
        put_file(kept, sealed(code))
    return code


def scratch_words(model: Model) -> int:
    """Size of the scratch that `advance` takes, in words."""
    return dopri.scratch(_state_size(model)).size


def _order(model: Model) -> dict[str, Any]:
    """The order to compile: kernels by the names of their entries, and the sizes of their arguments."""
    kernels = {name: getattr(model, name) for name in ENTRIES}
    missing = [name for name, kernel in kernels.items() if kernel is None]
    if missing:
        raise NativeError(f"{model.name} has no kernel {', '.join(missing)}; without it Python is needed")
    named = {name: f"{kernel.__module__}:{kernel.__name__}" for name, kernel in kernels.items()}
    return {"kernels": named, "words": model.memory.itemsize // 8, "state": _state_size(model)}


def _state_size(model: Model) -> int:
    fields: Any = model.memory.fields
    return fields["q"][0].shape[0]


def _require_numba() -> None:
    found = version("numba")
    numbers = tuple(int(part) for part in found.split(".")[:2])
    first, last = (".".join(map(str, limit)) for limit in NUMBA_RANGE)
    if not NUMBA_RANGE[0] <= numbers <= NUMBA_RANGE[1]:
        tried = first if first == last else f"{first} to {last}"
        raise NativeError(
            f"native FMUs are built with numba {tried}, this is {found}; "
            f"python3 -m pip --python {sys.executable} install 'numba=={last}.*' brings one"
        )


def _compiled_elsewhere(name: str, order: str) -> bytes:
    """Compile in a process of its own."""
    with tempfile.TemporaryDirectory(prefix="touchdown_") as folder:
        target = Path(folder) / "kernels.bc"
        done = run_apart(str(target), order)
        if done.returncode or not target.is_file():
            lines = done.stderr.strip().splitlines() or [f"exit status {done.returncode}"]
            raise NativeError(f"the kernels of {name} cannot be compiled: {lines[-1]}")
        return target.read_bytes()


def run_apart(*arguments: str) -> subprocess.CompletedProcess[str]:
    """Run this module as a program, which is told the processor before it imports numba.

    What lies in the current folder is not imported (-P).
    """
    environment = {
        **{name: value for name, value in os.environ.items() if not name.startswith("NUMBA_")},
        "NUMBA_CPU_NAME": PROCESSOR,
        "NUMBA_CPU_FEATURES": "",
        "PYTHONHASHSEED": "0",  # equal sources, equal code
        "PYTHONPATH": os.pathsep.join(path for path in sys.path if path),
    }
    command = [sys.executable, "-P", "-m", __name__, *arguments]
    return subprocess.run(command, capture_output=True, text=True, env=environment, check=False)


# -- in the process of its own -----------------------------------------------------------------------


def compile_entries(order: Mapping[str, Any]) -> bytes:
    """Compile what `_order` says; bitcode that defines kernel_derive, kernel_start and kernel_advance.

    For a process that runs no kernels: numba's code generation is changed in all of it.
    """
    _put_code_aside()
    _forget_addresses()
    KernelCache.active = False
    whole = None
    for name, place in order["kernels"].items():
        module, _, function = place.partition(":")
        kernel = getattr(import_module(module), function)
        part = _compiled_entry(name, kernel, order["words"], order["state"])
        if whole is None:
            whole = part
        else:
            whole.link_in(part)
    assert whole is not None
    _drop_unused(whole)
    whole.verify()
    left = [
        f.name
        for f in whole.functions
        if f.is_declaration and f.name.startswith(("llvm.x86", "llvm.aarch64", "Py"))
    ]
    if left:
        raise NativeError(f"they need {', '.join(left)}")
    return whole.as_bitcode()


def _put_code_aside() -> None:
    """Have numba keep each function's optimised code as it was before machine code was made of it."""
    from numba.core.codegen import CPUCodeLibrary

    finalize = CPUCodeLibrary._finalize_final_module

    def keeping(library: Any) -> None:
        clean = library._final_module.clone()
        for function in clean.functions:
            if not function.is_declaration and function.linkage.name == "external":
                function.linkage = "linkonce_odr"
        library._shared_module = clean  # what callers link
        finalize(library)

    cast(Any, CPUCodeLibrary)._finalize_final_module = keeping


def _forget_addresses() -> None:
    """Have no address of this process in the code: a kernel that is an argument is known by its type alone.

    numba names that type after the place of the function in memory, and hands over the place, unused.
    """
    from llvmlite.ir import Constant
    from numba.core import types
    from numba.core.cpu import CPUContext

    def named(kernel: KernelDispatcher) -> str:
        return f"{kernel.py_func.__module__}.{kernel.py_func.__qualname__}"

    def nowhere(context: Any, builder: Any, address: int, info: str) -> Any:
        return Constant(context.get_value_type(types.voidptr), None)

    cast(Any, KernelDispatcher).__repr__ = named
    cast(Any, CPUContext).add_dynamic_addr = nowhere


def _compiled_entry(name: str, kernel: Any, words: int, state: int) -> Any:
    """LLVM module with one kernel behind an entry of plain pointers; all else in it is internal."""
    import numba
    from numba import types

    rows = dopri.STAGES + 1

    def on_words(memory):  # type: ignore[no-untyped-def]
        return kernel(carray(memory, (words,)))

    def on_words_and_scratch(memory, scratch, time, step):  # type: ignore[no-untyped-def]
        return kernel(carray(memory, (words,)), carray(scratch, (rows, state)), time, step)

    pointer, real = types.CPointer(types.float64), types.float64
    stepping = name == "advance"
    signature = (pointer, pointer, real, real) if stepping else (pointer,)
    carray = cast(Any, numba).carray
    entry = KernelDispatcher(on_words_and_scratch if stepping else on_words, targetoptions=BARE)
    entry.compile(signature)
    compiled = entry.overloads[signature]
    module = compiled.library._get_module_for_linking()
    for defined in [*module.functions, *module.global_variables]:
        if not defined.is_declaration:
            defined.linkage = "internal"
    first = module.get_function(compiled.fndesc.mangled_name)
    first.linkage, first.visibility, first.name = "external", "hidden", f"{PREFIX}{name}"
    return module


def _drop_unused(module: Any) -> None:
    """Remove what no entry needs."""
    from llvmlite import binding as llvm

    machine = llvm.Target.from_default_triple().create_target_machine()
    builder = llvm.create_pass_builder(machine, llvm.create_pipeline_tuning_options(speed_level=3))
    passes = llvm.create_new_module_pass_manager()
    passes.add_global_dead_code_eliminate_pass()
    passes.run(module, builder)


if __name__ == "__main__":
    write(Path(sys.argv[1]), compile_entries(json.loads(sys.argv[2])))
