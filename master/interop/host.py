"""What a program that loads the FMUs needs on this machine, and whether it is there."""

from __future__ import annotations

import shlex
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, version

from ...fmus.python.host import NEEDED
from ...fmus.python.link import (
    LinkError,
    interpreter,
    patchelf,
    shared_library,
    starts_alone,
    why_not_compiled,
)
from ...modelkit.kernel.cache_folder import user_cache, why_temporary
from ...modelkit.kernel.machine_code import about_shipped


@dataclass(frozen=True)
class Finding:
    """One thing a host needs; `good` says whether it is there."""

    name: str
    text: str
    good: bool = True

    @property
    def line(self) -> str:
        """For people."""
        return f"{self.name:<10} {'' if self.good else 'MISSING: '}{self.text}"


def examine() -> Iterator[Finding]:
    """Everything a host needs here, one after the other."""
    yield Finding("python", f"{sys.version.split()[0]}, {sys.executable}")
    yield _libpython()
    for name in NEEDED:
        yield _package(name)
    yield _compiler()
    yield Finding("kernels", about_shipped())
    yield _cache()
    yield _patchelf()


def command_line() -> str:
    """How a host without Python is started so that it loads the FMUs. Raises LinkError where it cannot."""
    python = interpreter()
    packages = shlex.quote(":".join(python.packages))
    return (
        f"LD_PRELOAD={shlex.quote(python.library)} PYTHONHOME={shlex.quote(python.prefix)} "
        f"PYTHONPATH={packages} HOST"
    )


def advice() -> str:
    """The command line for people, or why there is none."""
    try:
        return f"a host without Python: {command_line()}"
    except LinkError as error:
        return f"a host without Python cannot load the FMUs here: {error}"


def _libpython() -> Finding:
    library = shared_library()
    if library is None:
        return Finding("libpython", "no shared one; hosts without Python cannot load the FMUs", False)
    alone = "" if starts_alone(library) else "; it needs PYTHONHOME, also for FMUs made with --link-python"
    return Finding("libpython", f"{library}{alone}")


def _package(name: str) -> Finding:
    try:
        return Finding(name, version(name))
    except PackageNotFoundError:
        command = f"python3 -m pip --python {sys.executable} install {name}"
        return Finding(name, f"install it with `{command}`", False)


def _compiler() -> Finding:
    trouble = why_not_compiled()
    return Finding("compiler", trouble or "numba compiles", not trouble)


def _cache() -> Finding:
    trouble = why_temporary()
    if trouble:
        return Finding("cache", f"cannot use {trouble}; set TOUCHDOWN_CACHE to a folder of yours", False)
    return Finding("cache", f"{user_cache()}, can be written")


def _patchelf() -> Finding:
    tool = patchelf()
    return Finding("patchelf", tool or "not installed; only `touchdown build --link-python` needs it")
