"""What turns C and bitcode into a library: LLVM, and the system's compiler or zig's."""

from __future__ import annotations

import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
from collections.abc import Mapping
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from touchdown.fmus.native.targets import NativeError, Target, here

SOURCE = Path(__file__).parent / "source"
COMMON = ("instance.h", "model.h", "numba.c")  # of all libraries; the face is one more
FLAGS = ("-std=c11", "-O2", "-fPIC", "-fvisibility=hidden", "-ffp-contract=off", "-Wall", "-Wextra")
_LINKING = {
    ".so": ("-shared", "-Wl,-z,defs", "-Wl,--gc-sections", "-Wl,--build-id=none", "-s", "-lm"),
    ".dll": ("-shared", "-s", "-D__USE_MINGW_ANSI_STDIO=1"),
    ".dylib": ("-dynamiclib", "-Wl,-s"),
}


_TELLING = re.compile(
    r"undefined (reference|symbol)|multiple definition|duplicate symbol|\berror:"
)  # a line of a compiler or a linker


def library(code: bytes | None, sources: Mapping[str, str], target: Target, identifier: str) -> bytes:
    """The shared library of a model for `target`, from its kernels' bitcode, if any, and sources by name.

    Raises NativeError where there is no compiler for it, or it fails.
    """
    with tempfile.TemporaryDirectory(prefix="touchdown_") as folder:
        place = Path(folder)
        if code is not None:
            (place / "kernels.o").write_bytes(machine_code(code, target))
        for name in COMMON:
            shutil.copy(SOURCE / name, place)
        for name, text in sources.items():
            (place / name).write_text(text, encoding="utf-8")
        made = f"{identifier}{target.suffix}"
        units = sorted(path.name for path in place.glob("*.[co]"))
        checks = ["-DCHECK_X86_64_V3"] if target.checked and code is not None else []
        _run([*command(target), *FLAGS, *checks, *units, "-o", made, *_LINKING[target.suffix]], place)
        return (place / made).read_bytes()


def machine_code(code: bytes, target: Target) -> bytes:
    """A relocatable object for `target` from LLVM bitcode."""
    llvm = _llvm()
    module = llvm.parse_bitcode(code)
    machine = llvm.Target.from_triple(target.triple).create_target_machine(
        cpu=target.processor, opt=3, reloc="pic", codemodel="default"
    )
    module.triple, module.data_layout = target.triple, str(machine.target_data)
    return machine.emit_object(module)


def command(target: Target) -> list[str]:
    """How the compiler for `target` is called: zig's where it is installed, else the system's.

    zig's links against an old glibc, so that the library runs on old systems. Raises NativeError where
    neither will do.
    """
    zig = _zig()
    if zig is not None:
        return [zig, "cc", "-target", target.zig]
    system = shutil.which("cc") or shutil.which("gcc") or shutil.which("clang")
    own = here()
    local = own is not None and target.zig == own.zig
    if local and system is not None:
        return [system]
    what = "a C compiler, the system's cc or zig's" if local else "zig's compiler"
    install = f"python3 -m pip --python {sys.executable} install ziglang"
    raise NativeError(f"{target.name} needs {what}; {install} brings zig's")


def _zig() -> str | None:
    """Path of the zig that comes as a package; None where it is not installed."""
    spec = find_spec("ziglang")
    if spec is None or spec.origin is None:
        return None
    path = Path(spec.origin).parent / ("zig.exe" if sys.platform == "win32" else "zig")
    return str(path) if path.is_file() else None


@cache
def _llvm() -> Any:
    """llvmlite's binding, ready for all processors."""
    from llvmlite import binding

    binding.initialize_all_targets()
    binding.initialize_all_asmprinters()
    return binding


def _run(line: list[str], folder: Path) -> None:
    done = subprocess.run(
        line, cwd=folder, capture_output=True, text=True, check=False, env={**os.environ, "LC_ALL": "C"}
    )
    if done.returncode == -signal.SIGINT:  # it goes to all of the terminal's processes
        raise KeyboardInterrupt
    if done.returncode:
        said = done.stderr.splitlines()
        telling = [text for text in said if _TELLING.search(text)] or said
        raise NativeError(f"{Path(line[0]).name} failed: {telling[0] if telling else done.returncode}")
