"""Requirements of a program that loads the FMUs, and whether this machine meets them."""

from __future__ import annotations

import shlex
import sys
import sysconfig
from collections.abc import Iterator
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, version
from importlib.util import find_spec
from pathlib import Path

from ...fmus.python.host import NEEDED, why_not_compiled
from ...modelkit.kernel.cache_folder import user_cache, why_temporary


@dataclass(frozen=True)
class _Finding:
    """One thing a host needs; `good` says whether it is there."""

    name: str
    text: str
    good: bool = True

    @property
    def line(self) -> str:
        """For people."""
        return f"{self.name:<10} {'' if self.good else 'MISSING: '}{self.text}"


def examine() -> Iterator[_Finding]:
    """The findings on each requirement."""
    yield _Finding("python", f"{sys.version.split()[0]}, {sys.executable}")
    yield _libpython()
    for name in NEEDED:
        yield _package(name)
    trouble = why_not_compiled()
    yield _Finding("compiler", trouble or "numba compiles", not trouble)
    yield _cache()


def advice() -> str:
    """How a host without Python is started to load the FMUs, or why it cannot."""
    cannot = "a host without Python cannot load the FMUs here: "
    if not sys.platform.startswith("linux"):
        return f"{cannot}LD_PRELOAD needs Linux, this is {sys.platform}; use native FMUs"
    library = _shared_library()
    if library is None:
        return (
            f"{cannot}{sys.executable} has no shared libpython; install one (Debian: "
            f"libpython{sys.version_info.major}.{sys.version_info.minor}) or use a Python that has one"
        )
    specs = {name: find_spec(name) for name in NEEDED}
    origins = {name: spec.origin for name, spec in specs.items() if spec and spec.origin}
    missing = [name for name in NEEDED if name not in origins]
    if missing:
        return f"{cannot}{sys.executable} lacks {', '.join(missing)}; install it"
    packages = ":".join(dict.fromkeys(str(Path(origin).parents[1]) for origin in origins.values()))
    return (
        f"a host without Python: LD_PRELOAD={shlex.quote(str(library))} "
        f"PYTHONHOME={shlex.quote(sys.base_prefix)} PYTHONPATH={shlex.quote(packages)} HOST"
    )


def _shared_library() -> Path | None:
    """The libpython of this interpreter; None where it has no shared one."""
    name = sysconfig.get_config_var("INSTSONAME") or ""
    if ".so" not in name:
        return None
    folders = [sysconfig.get_config_var("LIBDIR"), f"{sys.base_prefix}/lib"]
    return next((Path(f) / name for f in folders if f and (Path(f) / name).is_file()), None)


def _libpython() -> _Finding:
    library = _shared_library()
    if library is None:
        return _Finding("libpython", "no shared one; hosts without Python cannot load the FMUs", False)
    return _Finding("libpython", str(library))


def _package(name: str) -> _Finding:
    try:
        return _Finding(name, version(name))
    except PackageNotFoundError:
        command = f"python3 -m pip --python {sys.executable} install {name}"
        return _Finding(name, f"install it with `{command}`", False)


def _cache() -> _Finding:
    trouble = why_temporary()
    if trouble:
        return _Finding("cache", f"cannot use {trouble}; set TOUCHDOWN_CACHE to a folder of yours", False)
    return _Finding("cache", f"{user_cache()}, can be written")
