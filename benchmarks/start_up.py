"""Processor time of starting: the import, a command, a scene's first run, which compiles, and its second.

    python benchmarks/start_up.py [--scene disk-caged-simplified] [--pairs 5] [--against CHECKOUT]

Each is measured as often as there are pairs, in processes of their own, the first runs with an empty cache.
`--against` names another version's checkout, with its own `.venv`: both are measured in turns, and the last
column is the median of this one's time over the other's, pair by pair.
"""

from __future__ import annotations

import argparse
import os
import resource
import statistics
import subprocess
import sys
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path

from speeds.measured import Block, spread

Times = dict[str, list[float]]  # s of processor time, by what was started, one a pair


def starts(scene: str) -> dict[str, list[str]]:
    """Arguments of Python, by what they start, in the order in which they are measured."""
    command = ["-m", "touchdown"]
    run = [*command, "run", scene, "--in-process", "--duration", "1 ms", "--no-pictures", "-o", "run"]
    return {
        "import touchdown": ["-c", "import touchdown"],
        "touchdown scenes": [*command, "scenes"],
        f"first run of {scene}": run,
        "its second run": run,
    }


def processor_time(python: Path, arguments: Sequence[str], folder: Path) -> float:
    """What a process and those that it starts take until they end, s, with the cache in `folder`."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(
        [python, *arguments],
        cwd=folder,
        env={**os.environ, "TOUCHDOWN_CACHE": str(folder / "cache")},
        capture_output=True,
        check=True,
    )
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return (after.ru_utime - before.ru_utime) + (after.ru_stime - before.ru_stime)


def measure(pythons: Mapping[str, Path], scene: str, pairs: int) -> dict[str, Times]:
    """All starts with each of `pythons`, in turns, by its name."""
    found: dict[str, Times] = {name: {} for name in pythons}
    for pair in range(pairs):
        for name in sorted(pythons, reverse=bool(pair % 2)):  # neither is always the first
            with tempfile.TemporaryDirectory() as folder:
                for what, arguments in starts(scene).items():
                    taken = processor_time(pythons[name], arguments, Path(folder))
                    found[name].setdefault(what, []).append(taken)
    return found


def table(found: Mapping[str, Times]) -> Block:
    """A row per start, a column per version, and with two of them their ratio."""
    here, *others = found.values()
    rows: list[tuple[str, ...]] = []
    for what, times in here.items():
        cells = [spread(version[what]).text for version in found.values()]
        for other in others:
            pairs = zip(times, other[what], strict=True)
            cells.append(f"{statistics.median(a / b for a, b in pairs):.3f}")
        rows.append((what, *cells))
    title = "processor time, s: median (least-most)"
    return Block(title, ("", *found, *("ratio" for _ in others)), tuple(rows))


def main(arguments: list[str] | None = None) -> int:
    """Measure and print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--scene", default="disk-caged-simplified", help="a shipped scene, or a file")
    parser.add_argument("--pairs", type=int, default=5, help="how often each is measured")
    parser.add_argument("--against", type=Path, help="another version's checkout, with its .venv")
    options = parser.parse_args(arguments)
    pythons = {"here": Path(sys.executable)}
    if options.against:
        there = options.against.resolve() / ".venv" / "bin" / "python"
        if not there.exists():
            parser.error(f"{there} is not there: install that version into its .venv first")
        pythons["there"] = there
    for line in table(measure(pythons, options.scene, options.pairs)).lines():
        print(line)
    return 0


if __name__ == "__main__":
    sys.exit(main())
