"""Rotor I on two bearings: error at 9 ms, and what a second costs through seven FMUs.

The error is the journals' distance from the monolithic solution 9 ms after the shutdown (first impacts at
7.8 ms). The cost is that of the scene itself over one second, after a first run that compiles, with and
without recording; medians.

    python benchmarks/rotor_speed.py [--repeat 3] [--duration 1]
"""

from __future__ import annotations

import argparse
import statistics
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np

from touchdown.master.coupling.simulation import open_system, simulate
from touchdown.master.coupling.system import System
from touchdown.master.scene.file import load_scene
from touchdown.master.scene.scene import Scene
from touchdown.studies.drop.monolithic import Monolith

AT = 9e-3  # s after the shutdown
LEVITATED = 2e-3  # s, of the runs whose error is measured
JOURNALS = ["rotor.A.x", "rotor.A.y", "rotor.B.x", "rotor.B.y"]
SCENES = ("rotor1-9000", "rotor1-measured-9000", "rotor1-detailed")
STEPS = (1e-5, 2e-5, 4e-5)


def short(scene: Scene) -> Scene:
    """The drop up to the instant where the error is measured."""
    for name in ("amb_A", "amb_B"):
        scene = scene.set({f"{name}.shutdown_time": LEVITATED})
    return scene.set({"run.duration": AT, "run.stop_residual": 1e9})


def reference(scene: Scene) -> np.ndarray:
    """Both journals (m) by scipy's DOP853 on the same equations."""
    times = np.linspace(AT / 9.0, AT, 9)
    solution = Monolith(scene).solve(times, JOURNALS, 1e-9, "DOP853")
    return np.array([solution.series[name][-1] for name in JOURNALS])


@contextmanager
def opened(scene: Scene, in_process: bool) -> Iterator[System]:
    """The scene's system, freed at the end."""
    system = open_system(scene, in_process)
    try:
        yield system
    finally:
        system.close()


def error(scene: Scene, exact: np.ndarray) -> float:
    """Largest distance of a journal from the reference at the end (um), in process: the same to the bit."""
    with opened(scene, in_process=True) as system:
        simulate(scene, system)
        off = np.array([system.value(name) for name in JOURNALS]) - exact
    return 1e6 * float(max(np.hypot(off[0], off[1]), np.hypot(off[2], off[3])))


def cost(scene: Scene, in_process: bool, record: bool) -> float:
    """Wall time per simulated second."""
    with tempfile.TemporaryDirectory() as folder, opened(scene, in_process) as system:
        outcome = simulate(scene, system, Path(folder) / "result.h5" if record else None)
        return outcome.wall_time / outcome.end


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--repeat", type=int, default=3)
    parser.add_argument("--duration", type=float, default=1.0)
    options = parser.parse_args()
    print(f"{'':<22}{'':>12}{'error at':>11}{'wall time over simulated time':>36}")
    print(f"{'scene':<22}{'macro step':>12}{'9 ms [um]':>11}{'FMUs':>9}{'recorded':>12}{'in process':>15}")
    for name in SCENES:
        scene = load_scene(name)
        cost(scene.set({"run.duration": 0.01}), False, True)  # compiles
        exact = reference(short(scene))
        for step in STEPS:
            run = scene.set({"run.macro_step": step})
            off = error(short(run), exact)
            run = run.set({"run.duration": options.duration, "run.stop_residual": 1e9})
            kinds = ((False, False), (False, True), (True, False))
            spent = [statistics.median(cost(run, *k) for _ in range(options.repeat)) for k in kinds]
            costs = f"{spent[0]:>9.2f}{spent[1]:>12.2f}{spent[2]:>15.2f}"
            print(f"{name:<22}{1e6 * step:>9g} us{off:>11.3f}{costs}", flush=True)


if __name__ == "__main__":
    main()
