"""What a simulated second costs, and at which error: one run, one table, one picture.

    python benchmarks/speed.py [--repeat 5] [--duration 0.2] [--quick] [-o runs/speed]

Every shipped scene, by its kernels alone, in process, through native FMUs and through FMUs in Python; other
solvers; how the cost grows with balls, modes, seats, simulated time, macro step and recorded channels; a
command's start with an empty cache and a full one, its memory, and the sizes of FMUs. What is compared is
measured in turns; figures are medians, with the least and the most. Other co-simulation tools are measured
by `peers.py`, the steps inside the bearings by `inner_steps.py` and `detailed_speed.py`. Native FMUs take
part where there is a compiler, EXUDYN where it is installed.
"""

from __future__ import annotations

import argparse
import shutil
import sys
from collections.abc import Iterator
from importlib.util import find_spec
from pathlib import Path

from speeds import growth, scenes, solvers, start_up
from speeds.measured import Block
from speeds.picture import draw

from touchdown.master.scene.file import load_scene, shipped_scenes

STARTED = "disk-caged-simplified"


def main(arguments: list[str] | None = None) -> int:
    """Print the table block by block, draw the picture."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--scenes", help="only these, by commas")
    parser.add_argument("--repeat", type=int, default=5)
    parser.add_argument("--duration", type=float, default=0.2, help="s from the shutdown; default 0.2")
    parser.add_argument("--quick", action="store_true", help="a moment of everything: does it still run?")
    parser.add_argument("-o", "--output", type=Path, default=Path("runs/speed"))
    options = parser.parse_args(arguments)
    if options.quick:
        options.repeat, options.duration = 1, 2e-3
        options.scenes = options.scenes or STARTED
    options.output.mkdir(parents=True, exist_ok=True)
    with (options.output / "speed.txt").open("w", encoding="utf-8") as file:
        for block in measured(options):
            for line in block.lines():
                print(line, flush=True)
                print(line, file=file)
    print(f"\ntable and picture in {options.output}")
    return 0


def measured(options: argparse.Namespace) -> Iterator[Block]:
    """The table's blocks as they are measured; the picture is drawn at the end."""
    native = not options.quick and (shutil.which("cc") or find_spec("ziglang")) is not None
    chosen = options.scenes.split(",") if options.scenes else sorted(shipped_scenes())
    costs = [scenes.cost(load_scene(name), options.duration, options.repeat, native) for name in chosen]
    yield scenes.block(costs, native)
    yield solvers.block(options.repeat, options.quick)
    exudyn = solvers.exudyn_block()
    if exudyn is not None:
        yield exudyn
    grown = growth.all_of(options.duration, options.repeat, options.quick)
    yield growth.block(grown)
    yield start_up.block(STARTED, options.repeat, native, cold=not options.quick)
    yield start_up.sizes(native)
    draw(costs, grown, options.output / "speed.png")


if __name__ == "__main__":
    sys.exit(main())
