"""Run short drops in one process, and note what numba compiled, and what was taken ready-made instead.

    python .ci/observed.py FOLDER [--in-process] DROP ...

A DROP is a scene, or SCENE+BEARING for a scene with another bearing. Results go to FOLDER/DROP, what was
observed to FOLDER/observed.json: names of kernels, and paths of files (code, FMUs and their digests).
"""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path
from typing import Any

WAYS: dict[str, list[str]] = {"fmus": [], "in process": ["--in-process"]}  # to run drops, as options
KINDS = (".nbc", ".fmu", ".sha256")
DURATION = "12 ms"  # after the shutdown; a disk lands after 8 ms


def main() -> int:
    """Run the drops; returns 1 where one of them does not complete."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--in-process", action="store_true", help="step the models without FMUs")
    parser.add_argument("drops", nargs="+", metavar="DROP")
    options = parser.parse_args()
    options.folder.mkdir(parents=True, exist_ok=True)
    loaded, compiled = set[str](), list[str]()
    sys.addaudithook(lambda event, given: _note_reading(loaded, event, given))
    _note_compiling(compiled)
    completed = [dropped(drop, options.folder, options.in_process) for drop in options.drops]
    found = {"compiled": compiled, "loaded": sorted(path for path in loaded if Path(path).is_file())}
    (options.folder / "observed.json").write_text(json.dumps(found, indent=1), "utf-8")
    return 0 if all(completed) else 1


def dropped(drop: str, folder: Path, in_process: bool) -> bool:
    """Run a drop; whether it completed."""
    import touchdown

    name, _, bearing = drop.partition("+")
    scene = touchdown.load(name).set({"run.duration": DURATION})
    if bearing:
        scene = scene.swap(bearing=bearing)
    return bool(touchdown.run(scene, folder / drop, in_process=in_process).summary["completed"])


def _note_reading(loaded: set[str], event: str, given: tuple[Any, ...]) -> None:
    if event == "open" and str(given[0]).endswith(KINDS) and str(given[1]).startswith("r"):
        loaded.add(str(given[0]))


def _note_compiling(compiled: list[str]) -> None:
    from numba.core import event

    class Compiling(event.Listener):
        def on_start(self, event: Any) -> None:
            compiled.append(event.data["dispatcher"].py_func.__qualname__)

        def on_end(self, event: Any) -> None:
            pass

    event.register("numba:compile", Compiling())


if __name__ == "__main__":
    sys.exit(main())
