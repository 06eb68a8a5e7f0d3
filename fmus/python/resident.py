"""Sources of touchdown-cosim inside an FMU.

Tools unpack FMUs into ever new folders, where every start would compile the sources to bytecode again. So
they are run from one place per user, named by their content, with their bytecode beside them; the first FMU
puts them there. What is damaged there is put there anew. Where that cannot be they are run from here.
"""

import contextlib
import ctypes
import filecmp
import hashlib
import importlib.util
import py_compile
import shutil
import sys
import tempfile
from pathlib import Path

DIGESTS = "bytecode.txt"  # digest and path of all bytecode


def keep(script_globals: dict) -> None:
    """Take one reference to the globals of an FMU's script, in nobody's name.

    pythonfmu's library runs the script anew for every instance, and each time drops a reference to its
    globals that it only borrowed. This is the one it drops. Nothing in Python may hold it in its place, a
    list say: the count would be one too small beside those who really hold them, and the end of the
    interpreter, or a collection of garbage, would free them under the module that still uses them.
    """
    ctypes.pythonapi.Py_IncRef(ctypes.py_object(script_globals))


def _cache_folder(here: Path):
    """The module that knows the cache, read before the package it is of can be imported."""
    path = here / "modelkit" / "kernel" / "cache_folder.py"
    spec = importlib.util.spec_from_file_location(f"{__name__}_cache_folder", path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def _sources(folder: Path) -> list[str]:
    return sorted(str(path.relative_to(folder)) for path in folder.rglob("*.py"))


def _digest(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()


def _is_intact(here: Path, there: Path) -> bool:
    """Whether `there` has the sources of `here`, and bytecode as it was made of them."""
    names = _sources(here)
    if any(filecmp.cmpfiles(here, there, names, shallow=False)[1:]):
        return False
    try:
        lines = (there / DIGESTS).read_text(encoding="utf-8").splitlines()
        noted = {name: digest for digest, name in (line.split("  ", 1) for line in lines)}
        return len(noted) == len(names) and all(noted[n] == _digest(there / n) for n in noted)
    except (OSError, ValueError):
        return False


def _put(here: Path, there: Path) -> Path:
    """Copy the sources and compile them to bytecode; what was there before goes."""
    fresh = Path(tempfile.mkdtemp(prefix=".", dir=there.parent))
    try:
        copy = fresh / "copy"
        shutil.copytree(here, copy, ignore=shutil.ignore_patterns("__pycache__"))
        made = [_compiled(copy, name, there) for name in _sources(copy)]
        lines = [f"{_digest(copy / name)}  {name}\n" for name in made]
        (copy / DIGESTS).write_text("".join(lines), encoding="utf-8")
        if not _is_intact(here, there):  # else another process was first
            with contextlib.suppress(OSError):
                there.rename(fresh / "before")
                copy.rename(there)
    finally:
        shutil.rmtree(fresh, ignore_errors=True)
    return there


def _compiled(folder: Path, name: str, there: Path) -> str:
    """Compile the source `name` in `folder`, which is to be run from `there`; returns the bytecode's name.

    Unchecked, it is taken as it lies there, and never written again.
    """
    source = Path(name)
    target = source.parent / "__pycache__" / f"{source.stem}.{sys.implementation.cache_tag}.pyc"
    py_compile.compile(
        str(folder / source),
        cfile=str(folder / target),
        dfile=str(there / source),
        doraise=True,
        invalidation_mode=py_compile.PycInvalidationMode.UNCHECKED_HASH,
    )
    return str(target)


def _resident() -> Path:
    here = Path(__file__).resolve().parent
    try:
        cache = _cache_folder(here)
        there = cache.own_folder("sources", f"{here.name}-{sys.implementation.cache_tag}")
        if _is_intact(here, there):
            return there
        there = cache.made_in_cache(lambda folder: _put(here, folder), "sources", there.name)
        return there if _is_intact(here, there) else here
    except OSError:
        return here


__path__ = [str(_resident())]
