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

from fmus.recipes import Recipe
from fmus.sources import write_package, write_script
from modelkit.kernel import user_cache

EPOCH = (1980, 1, 1, 0, 0, 0)  # zip's own; the time of the build is no content


def build(recipe: Recipe, folder: Path) -> Path:
    """Build an FMU into `folder` as NAME.fmu; returns its path. An older one is replaced."""
    folder.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix="touchdown_") as temporary:
        script = write_script(recipe.script, recipe.module, Path(temporary))
        package = write_package(Path(temporary))
        with _untouched_interpreter(recipe.module):
            raw = FmuBuilder.build_FMU(script, dest=Path(temporary), project_files=[package])
        fresh = folder / f".{recipe.name}.{os.getpid()}.fmu"
        _normalise(Path(raw), fresh)
    return fresh.replace(folder / f"{recipe.name}.fmu")


def cached(recipe: Recipe) -> Path:
    """The FMU of a recipe and the present sources, built on first use."""
    folder = user_cache() / "fmus" / recipe.content
    path = folder / f"{recipe.name}.fmu"
    return path if path.is_file() else build(recipe, folder)


@contextmanager
def _untouched_interpreter(module: str) -> Iterator[None]:
    """Take back what pythonfmu's builder leaves in the interpreter: search path and script module."""
    path = list(sys.path)
    try:
        yield
    finally:
        sys.path[:] = path
        sys.modules.pop(module, None)


def _normalise(raw: Path, target: Path) -> None:
    """Rewrite an archive with sorted names, fixed times and no compression."""
    with zipfile.ZipFile(raw) as source, zipfile.ZipFile(target, "w") as archive:
        for name in sorted(source.namelist()):
            entry = zipfile.ZipInfo(name, EPOCH)
            entry.external_attr = 0o644 << 16
            archive.writestr(entry, source.read(name))
