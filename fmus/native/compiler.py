"""The compiler that makes a library of C and bitcode, and the machines it can build for."""

from __future__ import annotations

import os
import platform
import re
import shutil
import signal
import subprocess
import sys
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from ...modelkit.kernel.writing import child_path, write


class NativeError(Exception):
    """A native FMU cannot be built here; the message says why and what to do."""


@dataclass(frozen=True)
class Target:
    """A processor and a system: what LLVM and the compiler call them, and where FMI keeps the library."""

    name: str
    triple: str  # LLVM's
    processor: str  # the least that code is made for
    zig: str  # zig's triple; for Linux with the oldest glibc that will do
    folder: str  # in binaries/, of FMI 2.0
    folder_3: str  # of FMI 3.0
    suffix: str

    @property
    def checked(self) -> bool:
        """Whether the library looks at the processor before it is used: older ones lack instructions."""
        return self.processor == _V3


_LINUX, _WINDOWS = "x86_64-unknown-linux-gnu", "x86_64-pc-windows-gnu"
_V2, _V3 = "x86-64-v2", "x86-64-v3"  # of 2009 and of 2013: detailed bearings take 1.3 times as long on v2
_ALL = (
    Target("linux-x86_64", _LINUX, _V3, "x86_64-linux-gnu.2.17", "linux64", "x86_64-linux", ".so"),
    Target("linux-x86_64-v2", _LINUX, _V2, "x86_64-linux-gnu.2.17", "linux64", "x86_64-linux", ".so"),
    Target(
        "linux-aarch64",
        *(
            "aarch64-unknown-linux-gnu",
            "generic",
            "aarch64-linux-gnu.2.17",
            "aarch64-linux",
            "aarch64-linux",
            ".so",
        ),
    ),
    Target("windows-x86_64", _WINDOWS, _V3, "x86_64-windows-gnu", "win64", "x86_64-windows", ".dll"),
    Target("windows-x86_64-v2", _WINDOWS, _V2, "x86_64-windows-gnu", "win64", "x86_64-windows", ".dll"),
    Target(
        *("macos-arm64", "arm64-apple-macosx11.0.0", "apple-m1", "aarch64-macos.11.0"),
        *("darwin64", "aarch64-darwin", ".dylib"),
    ),
)
TARGETS = {target.name: target for target in _ALL}
_SYSTEMS = {"linux": "linux", "win32": "windows", "darwin": "macos"}
_PROCESSORS = {"AMD64": "x86_64", "arm64": "arm64" if sys.platform == "darwin" else "aarch64"}


def host_target() -> Target | None:
    """The machine this runs on; None where native FMUs are not built for its kind."""
    machine = platform.machine()
    system = _SYSTEMS.get(sys.platform, sys.platform)
    return TARGETS.get(f"{system}-{_PROCESSORS.get(machine, machine)}")


def _least() -> Target | None:
    """The target for the machine this runs on: the plainer one where its processor is older."""
    host = host_target()
    if host is None or not host.checked:
        return host
    from llvmlite.binding import get_host_cpu_features  # slow to import

    has = get_host_cpu_features()
    return (
        host if all(has.get(feature) for feature in ("avx2", "fma", "bmi2")) else TARGETS[f"{host.name}-v2"]
    )


def chosen_targets(names: Sequence[str]) -> tuple[Target, ...]:
    """Targets by name, each once; none: this machine. Raises NativeError for an unknown name."""
    known = ", ".join(TARGETS)
    for name in names:
        if name not in TARGETS:
            raise NativeError(f"there is no target {name}; there are {known}")
    host = _least()
    if names:
        found = tuple(TARGETS[name] for name in dict.fromkeys(names))
        _require_apart(found)
        return found
    if host is None:
        raise NativeError(
            f"native FMUs for this machine ({sys.platform}, {platform.machine()}) are not built; choose a "
            f"--target of {known}"
        )
    return (host,)


def _require_apart(targets: tuple[Target, ...]) -> None:
    """Raise NativeError for two that FMI keeps in one place."""
    by_folder: dict[str, Target] = {}
    for target in targets:
        other = by_folder.setdefault(target.folder, target)
        if other != target:
            raise NativeError(f"{other.name} and {target.name} have one place in an FMU; choose one")


def library_folders(targets: tuple[Target, ...]) -> dict[str, Target]:
    """Folders in binaries/, and whose library lies there, in FMUs of FMI 2.0.

    Hosts on 64-bit ARM look where FMI 2.0 has 64-bit Linux: there it lies, too, where nothing else does.
    """
    found = {target.folder: target for target in targets}
    arm = TARGETS["linux-aarch64"]
    if arm in targets:
        found.setdefault("linux64", arm)
    return found


def places_3(targets: tuple[Target, ...]) -> dict[str, Target]:
    """The same in FMUs of FMI 3.0, which names processor and system."""
    return {target.folder_3: target for target in targets}


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
            write(place / "kernels.o", machine_code(code, target))
        for name in COMMON:
            write(place / name, (SOURCE / name).read_bytes())
        for name, text in sources.items():
            write(child_path(place, name), text)
        file = f"{identifier}{target.suffix}"
        units = sorted(path.name for path in place.glob("*.[co]"))
        checks = ["-DCHECK_X86_64_V3"] if target.checked and code is not None else []
        _run([*command(target), *FLAGS, *checks, *units, "-o", file, *_LINKING[target.suffix]], place)
        return (place / file).read_bytes()


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
    host = host_target()
    local = host is not None and target.zig == host.zig
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
        lines = done.stderr.splitlines()
        telling = [text for text in lines if _TELLING.search(text)] or lines
        raise NativeError(f"{Path(line[0]).name} failed: {telling[0] if telling else done.returncode}")
