"""Sources of touchdown-cosim inside an FMU.

Compiled kernels are cached by the path of their source, and tools unpack FMUs into ever new folders.
So these sources are run from one place per user, named by their content; the first FMU puts them
there, and everyone after it starts with the machine code in the cache. Where that place cannot be
written they are run from where they are.
"""

import contextlib
import filecmp
import os
import shutil
import tempfile
from pathlib import Path

HELD: list = []  # globals of FMU scripts, see there


def _user_cache() -> Path:
    root = os.environ.get("TOUCHDOWN_CACHE")
    if root:
        return Path(root)
    base = os.environ.get("XDG_CACHE_HOME") or os.path.join(os.path.expanduser("~"), ".cache")
    return Path(base) / "touchdown-cosim"


def _same(here: Path, there: Path) -> bool:
    names = [str(path.relative_to(here)) for path in here.rglob("*.py")]
    return not any(filecmp.cmpfiles(here, there, names, shallow=False)[1:])


def _resident() -> Path:
    here = Path(__file__).resolve().parent
    there = _user_cache() / "sources" / here.name
    try:
        if not there.is_dir():
            there.parent.mkdir(parents=True, exist_ok=True)
            fresh = Path(tempfile.mkdtemp(dir=there.parent))
            shutil.copytree(here, fresh / here.name, ignore=shutil.ignore_patterns("__pycache__"))
            with contextlib.suppress(OSError):  # another process may be first
                (fresh / here.name).rename(there)
            shutil.rmtree(fresh, ignore_errors=True)
        return there if _same(here, there) else here
    except OSError:
        return here


__path__ = [str(_resident())]
