"""Sweeps: what a second worker is worth, and one that is killed again and again.

    python benchmarks/sweeps.py workers [--drops 200]
    python benchmarks/sweeps.py kills [--drops 10000] [--kills 48]

`workers` runs a whirl map of rotor I, drops of 0.3 s, on one worker and on two, and compares the files.
`kills` runs short drops of a disk on two workers, killed with them (SIGKILL) at drawn moments and started
again, and says what the kills cost.
"""

from __future__ import annotations

import argparse
import json
import os
import random
import resource
import subprocess
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

COMMAND = (sys.executable, "-m", "touchdown")
FILES = ("sweep.nc", "sweep.csv")


def main() -> None:
    """Measure what is asked for."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("what", choices=("workers", "kills"))
    parser.add_argument("--drops", type=int)
    parser.add_argument("--kills", type=int, default=48)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="sweeps_") as folder:
        if options.what == "workers":
            workers(Path(folder), options.drops or 200)
        else:
            killed(Path(folder), options.drops or 10_000, options.kills)


def workers(folder: Path, drops: int) -> None:
    """Print wall times on one worker and on two."""
    phases = drops // 20
    command = ["sweep", "rotor1-9000", "--in-process", "--quiet", "--no-pictures", "--duration", "0.3 s"]
    command += ["--vary", "rotor.speed=6000:18000:5 rpm", "--vary", "bearing_*.friction.dynamic=0.1:0.4:4"]
    command += ["--vary", f"rotor.unbalance_angle=0:{360 - 360 // phases}:{phases} deg"]
    times = {}
    for jobs in (2, 1):
        before, processor = time.perf_counter(), processor_time()
        subprocess.run([*COMMAND, *command, "--jobs", str(jobs), "-o", folder / str(jobs)], check=True)
        times[jobs] = time.perf_counter() - before
        used = processor_time() - processor
        print(
            f"{20 * phases} drops, {jobs} at a time: {times[jobs]:.1f} s, processor {used:.1f} s",
            flush=True,
        )
    same = all((folder / "1" / name).read_bytes() == (folder / "2" / name).read_bytes() for name in FILES)
    print(f"two against one: {times[1] / times[2]:.2f} times; files equal to the byte: {same}")


def processor_time() -> float:
    """Of all processes that were started and have ended (s)."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def killed(folder: Path, drops: int, kills: int) -> None:
    """Print what a sweep took though it was killed, and that nothing is missing or there twice."""
    command = [*COMMAND, "sweep", "disk-caged-simplified", "--in-process", "--quiet", "--no-pictures"]
    command += ["--duration", "10 ms", "--random", str(drops), "--seed", "1", "-o", str(folder)]
    command += ["--range", "bearing.clearance=0.2:0.3 mm", "--range", "rotor.mass=1:2 kg"]
    source, begun = random.Random(1), time.perf_counter()
    for mark in sorted(source.sample(range(1, drops), kills)):
        running = subprocess.Popen(command, stdout=subprocess.DEVNULL, start_new_session=True)
        while running.poll() is None and count_of_lines(folder) < mark:
            time.sleep(0.05)
        time.sleep(source.uniform(0.0, 0.2))
        running.kill()  # its workers end with it
        running.wait()
    subprocess.run(command, stdout=subprocess.DEVNULL, check=True)
    counts = Counter(lines(folder))
    print(f"{drops} drops on two workers: {time.perf_counter() - begun:.0f} s")
    print(f"killed {kills} times; drops written {counts.total() - len(counts)} times more than once")
    print(f"none is missing: {len(counts) == drops}")


def count_of_lines(folder: Path) -> int:
    """Of members, without a look at them."""
    path = folder / "members.jsonl"
    return path.read_bytes().count(b"\n") if path.exists() else 0


def lines(folder: Path) -> list[int]:
    """Members with a whole line."""
    path = folder / "members.jsonl"
    whole = path.read_bytes().split(b"\n")[:-1] if path.exists() else []
    return [json.loads(line)["member"] for line in whole]


if __name__ == "__main__":
    os.environ.setdefault("TQDM_DISABLE", "1")
    main()
