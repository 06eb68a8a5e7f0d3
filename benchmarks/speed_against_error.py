"""Wall time per simulated second against error, per scheme and macro step.

The first 20 ms of a drop, through FMUs, against the monolithic solution of the same equations. Error:
largest distance of the journal from the reference (um), and of the first impact's peak force (%).

    python benchmarks/speed_against_error.py [--scene disk-caged-simplified] [--repeat 3]
"""

from __future__ import annotations

import argparse
import math
import statistics
import time as clock

import numpy as np

from master.monolithic import Monolith
from master.scene import Scene, load
from master.schemes import SCHEMES
from master.simulation import open_system, simulate
from master.system import System

JOURNAL = ["rotor.A.x", "rotor.A.y"]
STEPS = (1e-6, 5e-6, 2e-5, 1e-4)
END = 0.02  # s after the shutdown; further on, impacts amplify every difference


def sampled(scene: Scene, times: np.ndarray) -> tuple[np.ndarray, float]:
    """Journal at `times` (s from zero) and the peak contact force (N), through FMUs."""
    system = open_system(scene)
    found: list[list[float]] = []
    marks = iter([*times, math.inf])
    mark = next(marks)
    zero = system.value(str(scene.zero))

    def watch(time: float, running: System) -> None:
        nonlocal mark
        if abs(time - zero - mark) < 1e-9:
            found.append([running.value(name) for name in JOURNAL])
            mark = next(marks)

    try:
        simulate(scene, system, watch=watch)
        return np.array(found), system.value("bearing.contact.peak_force")
    finally:
        system.close()


def timed(scene: Scene) -> float:
    """Wall time per simulated second, through FMUs."""
    system = open_system(scene)
    try:
        outcome = simulate(scene, system)
        return outcome.wall_time / outcome.end
    finally:
        system.close()


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--scene", default="disk-caged-simplified")
    parser.add_argument("--repeat", type=int, default=3)
    options = parser.parse_args()
    scene = load(options.scene).with_setting("run.duration", END).with_setting("run.stop_residual", 1e9)
    times = np.linspace(1e-3, END, 20)
    Monolith(scene).solve(times[:1], JOURNAL, 1e-6, "DOP853")  # compiles the kernels
    monolith = Monolith(scene)
    began = clock.perf_counter()
    solution = monolith.solve(times, JOURNAL, 1e-9, "DOP853")
    reference_cost = (clock.perf_counter() - began) / END
    exact = np.stack([solution.series[name] for name in JOURNAL], 1)
    fine = scene.with_setting("run.macro_step", 1e-6).with_setting("bearing.interface.tolerance", 1e-9)
    peak = sampled(fine, times)[1]
    print(f"{scene.name}, first {END * 1e3:g} ms, median of {options.repeat}; monolithic reference:")
    print(f"{solution.evaluations} evaluations in scipy's DOP853, {reference_cost:.0f} s per simulated s")
    print(f"{'scheme':<14}{'macro step':>12}{'journal [um]':>14}{'peak force':>12}{'wall/simulated':>16}")
    for name in SCHEMES:
        for step in STEPS:
            run = scene.with_setting("run.scheme", name).with_setting("run.macro_step", step)
            found, force = sampled(run, times)
            error = 1e6 * float(np.max(np.hypot(*(found - exact).T)))
            cost = statistics.median(timed(run) for _ in range(options.repeat))
            off = 100 * abs(force / peak - 1)
            print(f"{name:<14}{step * 1e6:>9g} us{error:>14.2g}{off:>10.2g} %{cost:>16.3g}")


if __name__ == "__main__":
    main()
