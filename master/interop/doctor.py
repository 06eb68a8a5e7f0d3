"""Needs of a host of FMUs on this machine, and whether they are met."""

from __future__ import annotations

import shlex
import signal
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

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
from ..common.errors import TouchdownError
from ..components.description import describe
from ..components.unpack import unpack
from . import trial

TIMEOUT_S = 600.0  # s; a first step compiles for a minute at most


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


# -- one FMU -----------------------------------------------------------------------------------------


def why_not(path: Path) -> str:
    """Why the FMU at `path` does not run in a process of its own; "" where it does.

    It is loaded, initialised, stepped a few times and freed, and the process ends.
    """
    with tempfile.TemporaryDirectory(prefix="touchdown_") as elsewhere:
        try:
            folder = unpack(path, Path(elsewhere))
            version = describe(path, folder).fmiVersion
            if version != "2.0":
                return f"{path} is FMI {version}; only FMI 2.0 is tried, `touchdown check` steps both"
            done = subprocess.run(
                [sys.executable, "-I", trial.__file__, str(folder)],
                cwd=elsewhere,
                capture_output=True,
                text=True,
                timeout=TIMEOUT_S,
                check=False,
            )
        except TouchdownError as error:
            return str(error)
        except subprocess.TimeoutExpired:
            return f"{path} did not end within {TIMEOUT_S:g} s"
    return _verdict(path, done)


def _verdict(path: Path, done: subprocess.CompletedProcess[str]) -> str:
    lines = done.stdout.splitlines()
    stages = [line.removeprefix(trial.STAGE) for line in lines if line.startswith(trial.STAGE)]
    stage = stages[-1] if stages else "starting"
    logged = [line.removeprefix(trial.LOG) for line in lines if line.startswith(trial.LOG)]
    if done.returncode < 0:
        return f"{path} crashed with {signal.Signals(-done.returncode).name} while {stage}"
    if done.returncode:
        told = logged or done.stderr.strip().splitlines() or [f"exit status {done.returncode}"]
        return f"{path} failed while {stage}: {told[0 if logged else -1]}"
    return "" if stage == trial.Stage.ENDING else f"{path} ended while {stage}"
