"""Build FMUs with pythonfmu: self-contained, and equal to the byte for equal sources."""

from __future__ import annotations

import os
import sys
import tempfile
import zipfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from pythonfmu import FmuBuilder

from fmus.sources import ROOT, package_name, script_name, write_package, write_script
from modelkit.kernel import user_cache

EPOCH = (1980, 1, 1, 0, 0, 0)  # zip's own; the time of the build is no content


def names() -> list[str]:
    """FMUs of the project."""
    scripts = (ROOT / "fmus" / "scripts").glob("*.py")
    return sorted(path.stem for path in scripts if path.stem != "__init__")


def build(name: str, folder: Path) -> Path:
    """Build FMU `name` into `folder` as name.fmu; returns its path. An older one is replaced."""
    folder.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix="touchdown_") as temporary:
        script = write_script(name, Path(temporary))
        package = write_package(Path(temporary))
        with _untouched_interpreter():
            raw = FmuBuilder.build_FMU(script, dest=Path(temporary), project_files=[package])
        fresh = folder / f".{name}.{os.getpid()}.fmu"
        _normalise(Path(raw), fresh)
    return fresh.replace(folder / f"{name}.fmu")


def cached(name: str) -> Path:
    """FMU `name` of the present sources, built on first use."""
    folder = user_cache() / "fmus" / package_name()
    path = folder / f"{name}.fmu"
    return path if path.is_file() else build(name, folder)


@contextmanager
def _untouched_interpreter() -> Iterator[None]:
    """Take back what pythonfmu's builder leaves in the interpreter: search path and script module."""
    path = list(sys.path)
    modules = set(sys.modules)
    try:
        yield
    finally:
        sys.path[:] = path
        for name in set(sys.modules) - modules:
            if any(name == script_name(n) for n in names()):
                del sys.modules[name]


def _normalise(raw: Path, target: Path) -> None:
    """Rewrite an archive with sorted names, fixed times and no compression."""
    with zipfile.ZipFile(raw) as source, zipfile.ZipFile(target, "w") as archive:
        for name in sorted(source.namelist()):
            entry = zipfile.ZipInfo(name, EPOCH)
            entry.external_attr = 0o644 << 16
            archive.writestr(entry, source.read(name))
