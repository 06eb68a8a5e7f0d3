"""Build FMUs with pythonfmu: self-contained, and equal to the byte for equal sources."""

from __future__ import annotations

import hashlib
import sys
import tempfile
import zipfile
import zlib
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from importlib.metadata import version
from pathlib import Path

import pythonfmu
from pythonfmu import FmuBuilder

from ..modelkit.kernel.cache_folder import made_in_cache, put_file, user_cache
from ..modelkit.kernel.writing import is_own_folder, make_folder, read_own, remove, replacing
from .description.described_variables import scalars
from .presentation import terminals
from .presentation.documentation import page
from .presentation.icon import icon
from .python.library import with_categories, with_errors
from .python.packed_sources import write_host, write_script, write_sources
from .recipes import Recipe

EPOCH = (1980, 1, 1, 0, 0, 0)  # zip's own; the time of the build is not content
SEAL = "resources/touchdown-cosim.txt"  # a digest of all else in an FMU


def build_fmu(recipe: Recipe, folder: Path) -> Path:
    """Build an FMU into `folder` as NAME.fmu; returns its path. An older one is replaced."""
    entries = _entries(recipe)
    entries["documentation/index.html"] = page(recipe).encode()
    entries["model.png"] = icon(recipe.model)
    entries |= terminals.terminal_entries(recipe.model, scalars(recipe.model))
    for name in [name for name in entries if name.startswith("binaries/linux64/")]:
        entries[name] = with_categories(with_errors(entries[name]))
    return write_fmu(entries, folder, recipe.name)


def cached_fmu(recipe: Recipe) -> Path:
    """The FMU of a recipe and the present sources; built on first use, and where it is damaged.

    Raises OSError where it cannot be written, not even into a temporary folder.
    """
    return kept_sound(recipe.name, recipe.content, lambda folder: build_fmu(recipe, folder))


def kept_sound(name: str, content: str, make: Callable[[Path], object]) -> Path:
    """NAME.fmu for `content` in the cache, made there by `make` where it is not as it was."""
    return made_in_cache(lambda folder: _sound(name, folder, make), "fmus", content)


def is_sound(name: str, content: str) -> bool:
    """Whether `kept_sound` finds NAME.fmu for `content` whole, and need not make it."""
    return _is_kept(user_cache() / "fmus" / content, name)


def _sound(name: str, folder: Path, make: Callable[[Path], object]) -> Path:
    """The FMU in `folder` if it is as it was built, else a new one; its digest lies beside it."""
    path, noted = folder / f"{name}.fmu", folder / f"{name}.sha256"
    if not _is_kept(folder, name):
        for damaged in (path, noted):
            if damaged.is_dir() and not damaged.is_symlink():
                remove(damaged)
        make(folder)
        put_file(path, path.read_bytes())  # for this user alone, with any umask
        put_file(noted, _line(path.name, path.read_bytes()))
    return path


def _is_kept(folder: Path, name: str) -> bool:
    """Whether NAME.fmu in a folder of the cache is this user's alone, and as it was built."""
    path = folder / f"{name}.fmu"
    try:
        return is_own_folder(folder) and read_own(path.with_suffix(".sha256")) == _line(
            path.name, read_own(path)
        )
    except OSError:
        return False


def _line(name: str, content: bytes) -> bytes:
    """Digest and name of a file, as `sha256sum` writes them and checks them."""
    return f"{hashlib.sha256(content).hexdigest()}  {name}\n".encode("ascii")


def _entries(recipe: Recipe) -> dict[str, bytes]:
    """The contents that pythonfmu makes of a recipe, by name."""
    with tempfile.TemporaryDirectory(prefix="touchdown_") as temporary:
        script = write_script(recipe.script, recipe.module, Path(temporary))
        parts = [write_sources(Path(temporary)), write_host(Path(temporary))]
        with _untouched_interpreter(recipe.module):
            raw = FmuBuilder.build_FMU(script, dest=Path(temporary), project_files=parts)
        with zipfile.ZipFile(raw) as archive:
            entries = {name: archive.read(name) for name in archive.namelist()}
    if not any(name.startswith("binaries/") for name in entries):
        raise OSError(f"the pythonfmu in {Path(pythonfmu.__file__).parent} has no libraries for FMUs")
    return entries


@contextmanager
def _untouched_interpreter(module: str) -> Iterator[None]:
    """Take back what pythonfmu's builder leaves in the interpreter: search path and script module."""
    path = list(sys.path)
    try:
        yield
    finally:
        sys.path[:] = path
        sys.modules.pop(module, None)


def write_fmu(entries: Mapping[str, bytes], folder: Path, name: str, sealed: bool = True) -> Path:
    """Write NAME.fmu into `folder` with sorted entries; an older one is replaced.

    sealed: the project's own code alone is in it.
    """
    make_folder(folder)
    seal = {SEAL: _seal({entry: zlib.crc32(data) for entry, data in entries.items()})} if sealed else {}
    content = dict(sorted({**entries, **seal}.items()))
    return write_zip(folder / f"{name}.fmu", content, zipfile.ZIP_DEFLATED)


def is_sealed(path: Path) -> bool:
    """Whether the FMU at `path` is one of the project's, by the present pythonfmu where one made it.

    A mark against accidents: nothing keeps others from making it.
    """
    with zipfile.ZipFile(path) as archive:
        checksums = {entry.filename: entry.CRC for entry in archive.infolist()}
        return checksums.pop(SEAL, None) is not None and archive.read(SEAL) == _seal(checksums)


def _seal(checksums: Mapping[str, int]) -> bytes:
    by_pythonfmu = any(entry.endswith("slavemodule.txt") for entry in checksums)
    sealed = repr((version("pythonfmu") if by_pythonfmu else "", sorted(checksums.items())))
    return f"{hashlib.sha256(sealed.encode()).hexdigest()}\n".encode()


def write_zip(path: Path, content: Mapping[str, bytes], compression: int = zipfile.ZIP_STORED) -> Path:
    """Write a ZIP archive of files by name, in that order and with fixed times; returns its path."""
    with replacing(path) as file, zipfile.ZipFile(file, "w") as archive:
        for name, data in content.items():
            entry = zipfile.ZipInfo(name, EPOCH)
            entry.external_attr = 0o644 << 16
            entry.compress_type = compression
            archive.writestr(entry, data)
    return path
