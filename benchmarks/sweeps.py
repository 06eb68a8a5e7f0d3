"""Sweeps: what a second worker is worth, and shards that are killed again and again.

    python benchmarks/sweeps.py workers [--drops 200]
    python benchmarks/sweeps.py shards [--drops 10000] [--kills 12]

`workers` runs a whirl map of rotor I, drops of 0.3 s, on one worker and on two, and compares the files.
`shards` runs short drops of a disk as four shards, two at a time, each of them killed (SIGKILL, with its
workers) at drawn moments and started again; merges them, and says what the kills cost.
"""

from __future__ import annotations

import argparse
import json
import os
import random
import resource
import shutil
import subprocess
import sys
import tempfile
import time
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

COMMAND = (sys.executable, "-m", "touchdown")
SHARDS = 4
FILES = ("sweep.nc", "sweep.csv")


def main() -> None:
    """Measure what is asked for."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("what", choices=("workers", "shards"))
    parser.add_argument("--drops", type=int)
    parser.add_argument("--kills", type=int, default=12, help="of each shard")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="sweeps_") as folder:
        if options.what == "workers":
            workers(Path(folder), options.drops or 200)
        else:
            shards(Path(folder), options.drops or 10_000, options.kills)


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


def shards(folder: Path, drops: int, kills: int) -> None:
    """Print what four shards took though they were killed, and that nothing is missing or there twice."""
    command = ["sweep", "disk-caged-simplified", "--in-process", "--quiet", "--no-pictures"]
    command += ["--duration", "10 ms", "--jobs", "1", "--random", str(drops), "--seed", "1"]
    command += ["--range", "bearing.clearance=0.2:0.3 mm", "--range", "rotor.mass=1:2 kg"]
    begun = time.perf_counter()
    with ThreadPoolExecutor(2) as pool:
        numbers = range(1, SHARDS + 1)
        twice = list(pool.map(lambda k: shard(command, folder / str(k), k, drops, kills), numbers))
    took = time.perf_counter() - begun
    parts = [str(folder / str(k)) for k in numbers]
    subprocess.run([*COMMAND, "merge", *parts, "-o", folder / "all", "--no-pictures"], check=True)
    found = lines(folder / "all")
    print(f"{drops} drops over {SHARDS} shards, two at a time: {took:.0f} s")
    print(f"killed {SHARDS * kills} times; drops written {sum(twice)} times more than once")
    print(f"members: {len(found)}, each once: {set(Counter(found).values()) == {1}}")


def shard(command: list[str], folder: Path, number: int, drops: int, kills: int) -> int:
    """Run a shard to its end, killed `kills` times on the way; how many drops have more than one line."""
    source = random.Random(number)
    marks = sorted(source.sample(range(1, drops // SHARDS), kills))
    asked = [*COMMAND, *command, "--shard", f"{number}/{SHARDS}", "-o", str(folder)]
    quiet = {"stdout": subprocess.DEVNULL, "start_new_session": True}
    for mark in marks:
        running = subprocess.Popen(asked, **quiet)
        while running.poll() is None and count_of_lines(folder) < mark:
            time.sleep(0.05)
        time.sleep(source.uniform(0.0, 0.2))
        running.kill()  # its workers end with it
        running.wait()
    subprocess.run(asked, stdout=subprocess.DEVNULL, check=True)
    shutil.rmtree(folder / ".under-way", ignore_errors=True)
    return sum(count - 1 for count in Counter(lines(folder)).values())


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
