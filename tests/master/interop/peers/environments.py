"""Other co-simulation tools, each in an environment of its own: made from PyPI, without the project.

The environments have the kernels' packages in the versions that run here, so that machine code compiled
by one is used by all. They are kept in the project's cache.
"""

from __future__ import annotations

import ctypes
import hashlib
import json
import os
import shutil
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path

from touchdown.modelkit.kernel.cache_folder import user_cache

HERE = Path(__file__).parent
REQUIREMENTS = {  # peer: its environment; those in one go together
    "libcosim": "ssp",
    "ecos": "ssp",
    "fmpy": "ssp",
    "cofmupy": "cofmupy",
}
KERNELS = ("numpy", "scipy", "numba")


class UnavailableError(Exception):
    """A peer that cannot be had here; says why."""


INSTALLED = {"omsimulator": "ssp"}  # programs that are not on PyPI, and where their drivers run


def title(peer: str) -> str:
    """Name and version, as on PyPI."""
    lines = (HERE / f"requirements-{REQUIREMENTS[peer]}.txt").read_text(encoding="utf-8").split()
    return next(line.replace("==", " ") for line in lines if line.startswith(peer))


def interpreter(peer: str) -> Path:
    """Python of the peer's environment, made on first use. Raises UnavailableError."""
    if peer == "ecos":
        try:
            ctypes.CDLL("libtbb.so.12")
        except OSError:
            raise UnavailableError("ecos needs Debian's libtbb12") from None
    if peer in INSTALLED and shutil.which("OMSimulator") is None:
        raise UnavailableError("OMSimulator is not on the PATH")
    environment = (REQUIREMENTS | INSTALLED)[peer]
    requirements = HERE / f"requirements-{environment}.txt"
    kernels = [f"{name}=={version(name)}" for name in KERNELS]
    content = f"{sys.version} {requirements.read_text(encoding='utf-8')} {kernels}"
    digest = hashlib.sha256(content.encode()).hexdigest()[:16]
    folder = user_cache() / "peers" / f"{environment}-{digest}"
    python, complete = folder / "bin" / "python", folder / "complete"
    if not complete.is_file():
        make = [sys.executable, "-m", "venv", "--clear", "--without-pip", folder]
        pip = [sys._base_executable, "-m", "pip", "--python", python]  # this environment may have none
        for command in (make, [*pip, "install", "-q", "--no-compile", "-r", requirements, *kernels]):
            done = subprocess.run(command, capture_output=True, text=True, check=False)
            if done.returncode:
                raise UnavailableError(f"cannot install {peer} from PyPI: {done.stderr.strip()[-300:]}")
        complete.touch()
    return python


@dataclass(frozen=True)
class Found:
    """What a peer says of a package."""

    values: dict[str, float]  # SI, at the end
    wall: float  # us per macro step
    processor: float  # us per macro step, of all threads


def run(peer: str, package: Path, wanted: Sequence[str], **environment: str) -> Found:
    """The package run by the peer, which is asked for `wanted` (COMPONENT.VARIABLE).

    Raises UnavailableError where the peer cannot be had, and RuntimeError with what it said where it fails.
    """
    python = interpreter(peer)
    answer = package.with_name(f"{package.stem}-{peer}{''.join(environment)}.json")
    done = subprocess.run(
        [python, HERE / f"drive_{peer}.py", package, answer, *wanted],
        cwd=package.parent,
        env={k: v for k, v in os.environ.items() if not k.startswith("PYTHON")} | environment,
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    if done.returncode or not answer.is_file():
        raise RuntimeError(f"{peer} ended with {done.returncode}: {done.stderr.strip()[-1000:]}")
    found = json.loads(answer.read_text(encoding="utf-8"))
    return Found(found["values"], *found["spent"])
