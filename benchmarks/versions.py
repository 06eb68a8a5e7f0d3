"""What versions of the project cost: starting, compiling, and a simulated second of drops.

    python benchmarks/versions.py [--against CHECKOUT ...] [--pairs 3] [--only starts|drops]
                                  [--scene disk-caged-simplified] [--drops disk-caged-simplified=0.2,...]

Starts: processor time (s) of the import, a command, a scene's first run, which compiles into an empty
cache, and its second. Drops: wall time per simulated second in process, warm, and how far the first
impact's peak contact force is off that of the first version named. Each is measured as often as there are
pairs, in processes of their own. `--against` names other versions' checkouts, each with its own `.venv`:
all are measured in turns, and a ratio is the median of this one's time over the other's, pair by pair.
Processor time is what busy cores leave alone; wall time wants an idle machine.
"""

from __future__ import annotations

import argparse
import json
import os
import resource
import statistics
import subprocess
import sys
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path

from speeds.measured import Block, spread

Times = dict[str, list[float]]  # s, by what was measured, one a pair
DROPS = {  # scene: simulated seconds
    "disk-caged-simplified": 0.5,
    "disk-cageless-simplified": 0.5,
    "disk-cageless-detailed": 0.5,
    "disk-caged-detailed": 0.5,
    "rotor1-9000": 0.2,
    "rotor2-case1": 0.3,
}
DROP = """
import json, sys, touchdown
scene, seconds = touchdown.load(sys.argv[1]), float(sys.argv[2])
touchdown.run(scene.set({"run.duration": 0.002}), in_process=True)
told = touchdown.run(scene.set({"run.duration": seconds}), in_process=True).summary
if "seats" in told:
    cost = told["wall_time_per_simulated_second"]
    peaks = [seat["first_impact_contact_force"] for seat in told["seats"].values()]
else:  # a version with flat summaries
    cost = told["wall_time_per_simulated_s"]
    peaks = [told.get(f"first_impact_contact_force_N{of}") for of in ("", "_bearing_A", "_bearing_B")]
print(json.dumps([cost, max(peak or 0.0 for peak in peaks)]))
"""


def starts(scene: str) -> dict[str, list[str]]:
    """Arguments of Python, by what they start, in the order in which they are measured."""
    command = ["-m", "touchdown"]
    run = [*command, "run", scene, "--in-process", "--duration", "9 ms", "--no-pictures", "-o", "run"]
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


def measure_starts(pythons: Mapping[str, Path], scene: str, pairs: int) -> dict[str, Times]:
    """All starts with each of `pythons`, in turns, by its name."""
    found: dict[str, Times] = {name: {} for name in pythons}
    for pair in range(pairs):
        for name in sorted(pythons, reverse=bool(pair % 2)):  # neither is always the first
            with tempfile.TemporaryDirectory() as folder:
                for what, arguments in starts(scene).items():
                    taken = processor_time(pythons[name], arguments, Path(folder))
                    found[name].setdefault(what, []).append(taken)
    return found


def measure_drops(pythons: Mapping[str, Path], drops: Mapping[str, float], pairs: int) -> dict[str, Times]:
    """Wall time per simulated second of each drop with each of `pythons`; prints errors of impacts."""
    found: dict[str, Times] = {name: {} for name in pythons}
    for scene, seconds in drops.items():
        peaks: dict[str, float] = {}
        for pair in range(pairs):
            for name in sorted(pythons, reverse=bool(pair % 2)):
                call = [pythons[name], "-c", DROP, scene, str(seconds)]
                said = subprocess.run(call, capture_output=True, check=True, text=True).stdout
                taken, peaks[name] = json.loads(said.splitlines()[-1])
                found[name].setdefault(scene, []).append(taken)
        first = peaks[next(iter(pythons))]
        off = ", ".join(f"{name} {peak / first - 1.0:+.1e}" for name, peak in peaks.items() if peak > 0.0)
        print(f"{scene}: first impact {first:.6g} N; off that: {off}")
    return found


def table(found: Mapping[str, Times], title: str) -> Block:
    """A row per measurement, a column per version, and with several the ratios to the first."""
    here, *others = found.values()
    rows: list[tuple[str, ...]] = []
    for what, times in here.items():
        cells = [spread(version[what]).text for version in found.values()]
        for other in others:
            pairs = zip(times, other[what], strict=True)
            cells.append(f"{statistics.median(a / b for a, b in pairs):.3f}")
        rows.append((what, *cells))
    ratios = [f"over {name}" for name in list(found)[1:]]
    return Block(title, ("", *found, *ratios), tuple(rows))


def main(arguments: list[str] | None = None) -> int:
    """Measure and print the tables."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--scene", default="disk-caged-simplified", help="a shipped scene, to start")
    parser.add_argument("--pairs", type=int, default=3, help="how often each is measured")
    parser.add_argument("--only", choices=("starts", "drops"), help="these alone")
    parser.add_argument("--drops", help="SCENE=SECONDS, by commas; else those of the documentation")
    parser.add_argument(
        "--against", type=Path, nargs="*", default=[], help="checkouts, each with its .venv"
    )
    options = parser.parse_args(arguments)
    pythons = {"here": Path(sys.executable)}
    for checkout in options.against:
        there = checkout.resolve() / ".venv" / "bin" / "python"
        if not there.exists():
            parser.error(f"{there} is not there: install that version into its .venv first")
        pythons[checkout.resolve().name] = there
    drops = DROPS
    if options.drops:
        drops = {one.partition("=")[0]: float(one.partition("=")[2]) for one in options.drops.split(",")}
    blocks: list[Block] = []
    if options.only != "drops":
        found = measure_starts(pythons, options.scene, options.pairs)
        blocks.append(table(found, "processor time, s: median (least-most)"))
    if options.only != "starts":
        found = measure_drops(pythons, drops, options.pairs)
        blocks.append(table(found, "wall time per simulated second, s: median (least-most)"))
    for block in blocks:
        for line in block.lines():
            print(line)
    return 0


if __name__ == "__main__":
    sys.exit(main())
