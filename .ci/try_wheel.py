"""Try an installed wheel with machine code as its user does: in a fresh environment, without a cache.

    python .ci/try_wheel.py PYTHON_OF_THAT_ENVIRONMENT DROP ...

Nothing may be compiled in the drops (`observed.py`), through FMUs or in process, and each must leave the
recording that this environment makes of it with code compiled for this processor, to the last bit.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import h5py
import numpy as np
from observed import WAYS

OBSERVED = Path(__file__).with_name("observed.py")
LEFT_OUT = ("TOUCHDOWN_CACHE", "PYTHONPATH", "XDG_CACHE_HOME", "MPLCONFIGDIR")  # would help, of this one


def main() -> int:
    """Run, compare; returns 1 where something was compiled or differs."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("python", help="the interpreter of the environment that has the wheel")
    parser.add_argument("drops", nargs="+", metavar="DROP")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="touchdown_") as name:
        folder = Path(name)
        users = {key: value for key, value in os.environ.items() if key not in LEFT_OUT}
        users["HOME"] = str(folder)
        wrong: list[str] = []
        for way, how in WAYS.items():
            observe(options.python, folder / way, [*how, *options.drops], users)
            compiled = json.loads((folder / way / "observed.json").read_text("utf-8"))["compiled"]
            print(f"{way}: {len(compiled)} kernels compiled", flush=True)
            wrong += [f"{way}: {kernel} was compiled" for kernel in compiled]
        observe(sys.executable, folder / "here", ["--in-process", *options.drops], dict(os.environ))
        for drop in options.drops:
            wrong += [f"{drop}, {way}: {what}" for way in WAYS for what in others(folder, way, drop)]
    print("\n".join(wrong) or "all recordings equal to those of code compiled here")
    return 1 if wrong else 0


def observe(python: str, folder: Path, arguments: list[str], environment: dict[str, str]) -> None:
    """Run drops into a folder, in a process of `python`."""
    command = [python, str(OBSERVED), str(folder), *arguments]
    subprocess.run(command, cwd=folder.parent, env=environment, check=True)


def others(folder: Path, way: str, drop: str) -> list[str]:
    """Channels of a drop that are not as they were recorded here."""
    with (
        h5py.File(folder / way / drop / "result.h5") as one,
        h5py.File(folder / "here" / drop / "result.h5") as other,
    ):
        channels, expected = (_channels(file) for file in (one, other))
        if channels.keys() != expected.keys():
            return ["other channels"]
        return [name for name in channels if channels[name].tobytes() != expected[name].tobytes()]


def _channels(file: h5py.File) -> dict[str, np.ndarray]:
    found: dict[str, np.ndarray] = {}
    file.visititems(
        lambda name, item: found.update({name: item[()]}) if isinstance(item, h5py.Dataset) else None
    )
    return found


if __name__ == "__main__":
    sys.exit(main())
