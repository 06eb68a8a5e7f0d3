"""Build a wheel for this platform that carries the machine code of the models, and the FMUs that run it.

    python .ci/build_wheel.py [-o dist] [DROP ...]

The code is compiled for a plain processor (`modelkit/kernel/machine_code.py`). Which is needed is found by
trying: short drops are run, through FMUs and in process, until nothing is compiled any more, and what they
take from the cache then goes into the wheel. Without DROPs (`observed.py`) they cover all models. Needs the
project and hatchling installed; code that the cache holds from other times is taken from there.
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
import subprocess
import sys
import tempfile
from importlib.metadata import distribution, version
from pathlib import Path
from typing import Any

from numba.core.registry import cpu_target
from observed import WAYS

import touchdown
from touchdown.fmus import recipes
from touchdown.modelkit.kernel.cache_folder import user_cache
from touchdown.modelkit.kernel.machine_code import MADE_FOR, made_for, plain_processor, plainer

ROOT = Path(__file__).resolve().parents[1]
ANY_BEARING = "disk-caged-simplified"  # the scene for bearings that no scene has
PASSES = 3


def main() -> int:
    """Compile, build, and say which wheel."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("-o", "--output", type=Path, default=ROOT / "dist")
    parser.add_argument(
        "drops", nargs="*", metavar="DROP", help="default: as many as it takes for all models"
    )
    options = parser.parse_args()
    codegen: Any = cpu_target.target_context.codegen  # type: ignore[attr-defined]
    if plainer(codegen().magic_tuple()) is None:
        sys.exit(f"the code is for {plain_processor()}, which has more instructions than this processor")
    with tempfile.TemporaryDirectory(prefix="touchdown_") as folder:
        content = Path(folder) / "shipped"
        count = gather(taken(options.drops or all_models(), Path(folder)), content)
        print(f"{count} files, {size(content) / 1e6:.1f} MB")
        wheel(content, options.output)
    return 0


def all_models() -> list[str]:
    """Drops in which every FMU of the project is stepped."""
    missing = set(recipes.names())
    drops: list[str] = []
    for name in touchdown.scenes():
        used = {component.fmu for component in touchdown.load(name).components.values()}
        if used & missing:
            drops.append(name)
        missing -= used
    return [*drops, *(f"{ANY_BEARING}+{bearing}" for bearing in sorted(missing))]


def taken(drops: list[str], folder: Path) -> set[Path]:
    """Files of the cache that the drops take, made where they were not there."""
    waiting, found = dict(WAYS), set[Path]()
    for number in range(PASSES):
        running = {way: _started(drops, how, folder / f"{way} {number}") for way, how in waiting.items()}
        for way, process in running.items():
            if process.wait():
                sys.exit(f"the drops failed: {' '.join(map(str, process.args))}")
            seen = json.loads((folder / f"{way} {number}" / "observed.json").read_text("utf-8"))
            compiled, loaded = seen["compiled"], seen["loaded"]
            print(f"{way}: {len(compiled)} kernels compiled, {len(loaded)} files taken", flush=True)
            if not compiled:
                del waiting[way]
                found |= {Path(path) for path in loaded}
        if not waiting:
            return found
    sys.exit(f"some kernels are compiled anew in each of {PASSES} passes: {', '.join(waiting)}")


def _started(drops: list[str], how: list[str], folder: Path) -> subprocess.Popen[bytes]:
    """The drops, begun in a process that compiles for a plain processor."""
    compiling = {"NUMBA_CPU_NAME": plain_processor(), "NUMBA_CPU_FEATURES": ""}
    # with two threads what helpers take is there, on whatever machine
    environment = {**os.environ, **compiling, "OMP_NUM_THREADS": "2"}
    command = [sys.executable, str(ROOT / ".ci" / "observed.py"), str(folder), *how, *drops]
    return subprocess.Popen(command, env=environment)


def gather(files: set[Path], into: Path) -> int:
    """Copy files of the cache to where an installation has them; returns how many."""
    for path in files:
        target = into / path.relative_to(user_cache())
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(path, target)
    (into / "machine-code" / MADE_FOR).write_text(made_for(version("numba")) + "\n", "utf-8")
    return len(files)


def size(folder: Path) -> int:
    """Bytes of the files in a folder."""
    return sum(path.stat().st_size for path in folder.rglob("*") if path.is_file())


def wheel(content: Path, into: Path) -> None:
    """Build it with what lies in `content`."""
    environment = {**os.environ, "TOUCHDOWN_SHIPPED": str(content), "TOUCHDOWN_WHEEL_TAG": tag()}
    command = [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(into.resolve())]
    subprocess.run(command, cwd=ROOT, env=environment, check=True)


def tag() -> str:
    """Python and platform of the wheel: those of numba's, which the code was made by and runs with."""
    lines = (distribution("numba").read_text("WHEEL") or "").splitlines()
    return next(line.split()[1] for line in lines if line.startswith("Tag:"))


if __name__ == "__main__":
    sys.exit(main())
