"""What it costs the master to take a native FMU through a macro step, beyond its fmi2DoStep.

Housings stand in a row, each under the motion of the one before, four numbers in and four out. What a macro
step costs more with so many more of them is what each costs; from that goes the time of its fmi2DoStep,
called again and again from compiled code. Once with macro steps in compiled code, once in the Python loop.

    python benchmarks/native_crossing.py [--pairs 7]
"""

from __future__ import annotations

import argparse
import itertools
import statistics
import time as clock
from pathlib import Path
from unittest.mock import patch

import numba

from touchdown.master.components.component import ByFunctions
from touchdown.master.coupling.loop import compiled_loop as stretches
from touchdown.master.coupling.simulation import opened, simulate
from touchdown.master.scene.file import parse_scene
from touchdown.master.scene.scene import Scene
from touchdown.modelkit.kernel.memory import call_step

FEW, MANY = 2, 18
CROSSING = (("x", "fx"), ("y", "fy"), ("vx", "dfx"), ("vy", "dfy"))
MACRO_STEP = 1e-4  # s
STEPS = {True: 20_000, False: 2_000}  # by whether they are taken in compiled code


def row(housings: int, steps: int) -> Scene:
    """So many housings, each driven by the one before."""
    names = [f"h{i}" for i in range(housings)]
    told = {
        "components": {name: {"fmu": "housing", "native": True} for name in names},
        "connect": [
            [f"{giver}.seat.{given}", f"{taker}.seat.{taken}", 1.0, 0.0]
            for giver, taker in itertools.pairwise(names)
            for given, taken in CROSSING
        ],
        "run": {"duration": steps * MACRO_STEP, "macro_step": MACRO_STEP},
    }
    return parse_scene(told, "housings", Path())


def per_step(housings: int, compiled: bool) -> float:
    """us per macro step, nothing recorded."""
    known = stretches.PARALLEL_SEQUENCES if compiled else {}
    with (
        patch.object(stretches, "PARALLEL_SEQUENCES", known),
        opened(row(housings, STEPS[compiled])) as system,
    ):
        outcome = simulate(scene=row(housings, STEPS[compiled]), system=system)
    return 1e6 * outcome.wall_time / outcome.steps


@numba.njit
def _again(address: int, component: int, step: float, first: int, end: int) -> int:
    worst = 0
    for i in range(first, end):
        worst = max(worst, call_step(address, component, i * step, step))
    return worst


def do_step() -> float:
    """us of a housing's fmi2DoStep."""
    with opened(row(FEW, 1)) as system:
        system.initialise()
        entry = system.components["h0"].by_address()
        assert isinstance(entry, ByFunctions)
        _again(entry.do_step, entry.component, MACRO_STEP, 0, 1)
        began = clock.perf_counter()
        worst = _again(entry.do_step, entry.component, MACRO_STEP, 1, 1 + STEPS[True])
        assert worst == 0
        return 1e6 * (clock.perf_counter() - began) / STEPS[True]


def crossing(compiled: bool) -> float:
    """us per FMU and macro step beyond its fmi2DoStep."""
    more = per_step(MANY, compiled) - per_step(FEW, compiled)
    return more / (MANY - FEW) - do_step()


def main() -> None:
    """Print both."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--pairs", type=int, default=7)
    pairs = parser.parse_args().pairs
    print(f"a native FMU's fmi2DoStep: {statistics.median(do_step() for _ in range(pairs)):.3f} us;")
    for compiled, title in ((True, "macro steps in compiled code"), (False, "macro steps in Python")):
        crossing(compiled)
        found = sorted(crossing(compiled) for _ in range(pairs))
        print(f"{title}: {statistics.median(found):.3f} us beyond it ({found[0]:.3f}-{found[-1]:.3f})")


if __name__ == "__main__":
    main()
