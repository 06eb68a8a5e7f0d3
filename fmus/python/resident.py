"""Sources of touchdown-cosim inside an FMU.

Tools unpack FMUs into ever new folders, where every start would compile the sources to bytecode again. So
they are run from one place per user, named by their content, with their bytecode beside them; the first FMU
puts them there. Where a file there is damaged, is another user's or should not be there, all are put there
anew. Where that cannot be they are run from here.
"""

import contextlib
import ctypes
import filecmp
import hashlib
import importlib
import py_compile
import sys
import tempfile
from pathlib import Path
from types import ModuleType

DIGESTS = "bytecode.txt"  # digest and path of all bytecode


def keep(script_globals: dict) -> None:
    """Take one reference to the globals of an FMU's script that no object owns.

    pythonfmu's library runs the script anew for every instance, and each time drops a reference to its
    globals that it only borrowed. This is the one it drops. Nothing in Python may hold it in its place, a
    list say: the count would be one too small beside those who really hold them, and the end of the
    interpreter, or a collection of garbage, would free them under the module that still uses them.
    """
    ctypes.pythonapi.Py_IncRef(ctypes.py_object(script_globals))


def _kernel_module(name: str):
    """A module of modelkit/kernel that needs the standard library only, read before its package exists."""
    package = ModuleType(f"{__name__}_kernel")
    package.__path__ = [str(Path(__file__).resolve().parent / "modelkit" / "kernel")]
    sys.modules.setdefault(package.__name__, package)
    return importlib.import_module(f"{package.__name__}.{name}")


def _sources(folder: Path) -> list[str]:
    return sorted(path.relative_to(folder).as_posix() for path in folder.rglob("*.py"))


def _digest(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()


def _bytecode(name: str) -> str:
    """Where the bytecode of the file `name` lies; both from the sources' folder."""
    source = Path(name)
    return (source.parent / "__pycache__" / f"{source.stem}.{sys.implementation.cache_tag}.pyc").as_posix()


def _is_intact(folder: Path, there: Path) -> bool:
    """Whether `there` has the sources of `folder`, their bytecode as it was made, and nothing else."""
    names = _sources(folder)
    bytecode = set(map(_bytecode, names))
    if not _kernel_module("writing").holds_exactly(there, {*names, *bytecode, DIGESTS}):
        return False
    if any(filecmp.cmpfiles(folder, there, names, shallow=False)[1:]):
        return False
    try:
        lines = (there / DIGESTS).read_text(encoding="utf-8").splitlines()
        noted = {name: digest for digest, name in (line.split("  ", 1) for line in lines)}
        return noted.keys() == bytecode and all(noted[n] == _digest(there / n) for n in noted)
    except (OSError, ValueError):
        return False


def _put(folder: Path, there: Path) -> Path:
    """Copy the sources and compile them to bytecode; what was there before goes."""
    writing = _kernel_module("writing")
    fresh = Path(tempfile.mkdtemp(prefix=".", dir=there.parent))
    try:
        copy = fresh / "copy"
        for name in _sources(folder):
            writing.make_folder((copy / name).parent / "__pycache__", 0o700)
            writing.write(copy / name, (folder / name).read_bytes(), writing.PRIVATE)
            _compile(copy, name, there)
        lines = [f"{_digest(copy / name)}  {name}\n" for name in map(_bytecode, _sources(copy))]
        writing.write(copy / DIGESTS, "".join(lines), writing.PRIVATE)
        if not _is_intact(folder, there):  # else another process was first
            with contextlib.suppress(OSError):
                writing.move(there, fresh / "before")
                writing.move(copy, there)
    finally:
        writing.discard(fresh)
    return there


def _compile(folder: Path, name: str, there: Path) -> None:
    """Compile the file `name` in `folder`, which is to be run from `there`.

    Its bytecode is unchecked: it is taken as it lies there, and never written again.
    """
    py_compile.compile(
        str(folder / name),
        cfile=str(folder / _bytecode(name)),
        dfile=str(there / name),
        doraise=True,
        invalidation_mode=py_compile.PycInvalidationMode.UNCHECKED_HASH,
    )


def _resident() -> Path:
    folder = Path(__file__).resolve().parent
    try:
        cache = _kernel_module("cache_folder")
        there = cache.own_folder("sources", f"{folder.name}-{sys.implementation.cache_tag}")
        if _is_intact(folder, there):
            return there
        there = cache.made_in_cache(lambda copy: _put(folder, copy), "sources", there.name)
        return there if _is_intact(folder, there) else folder
    except OSError:
        return folder


__path__ = [str(_resident())]
