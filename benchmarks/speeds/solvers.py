"""scipy's solvers on a scene's equations in one, without macro steps; and EXUDYN, where it is installed."""

from __future__ import annotations

import math
import time as clock

import numpy as np

from speeds.measured import Block, spread
from speeds.scenes import LANDED, landing
from touchdown.master.coupling.simulation import opened, simulate
from touchdown.master.scene.file import load_scene
from touchdown.master.scene.scene import Scene
from touchdown.studies.drop.monolithic import Monolith

SCENE = "disk-caged-simplified"
JOURNAL = ["rotor.A.x", "rotor.A.y"]
TRIED = (("RK45", 1e-6), ("DOP853", 1e-6), ("LSODA", 1e-6), ("Radau", 1e-5))
EXACT = ("DOP853", 1e-9)
EXUDYN_SPAN = 20e-3  # s
Ended = tuple[list[float], float]  # journal (m) at the end, wall time per simulated second


def block(repeat: int, quick: bool) -> Block:
    """Rows: what each takes up to just after the first impact, and how far off the journal is there."""
    scene = landing(load_scene(SCENE))
    exact, _ = solved(scene, *EXACT)
    _stepped(scene)  # compiles
    rows = [_row("this project, in process", [_stepped(scene) for _ in range(repeat)], exact)]
    for method, tolerance in TRIED[:1] if quick else TRIED:
        runs = [solved(scene, method, tolerance) for _ in range(repeat)]
        rows.append(_row(f"scipy {method}, {tolerance:g}", runs, exact))
    title = f"{SCENE}, up to {1e3 * LANDED:g} ms after the shutdown"
    return Block(title, ("solver", "journal", "s per simulated s"), tuple(rows))


def solved(scene: Scene, method: str, tolerance: float) -> Ended:
    """By one of scipy's methods."""
    system = Monolith(scene)
    began = clock.perf_counter()
    solution = system.solve(np.linspace(LANDED / 10.0, LANDED, 10), JOURNAL, tolerance, method)
    spent = clock.perf_counter() - began
    return [float(solution.series[name][-1]) for name in JOURNAL], spent / (LANDED + system.zero)


def _stepped(scene: Scene) -> Ended:
    with opened(scene, in_process=True) as system:
        outcome = simulate(scene, system)
        return [system.value(name) for name in JOURNAL], outcome.wall_time / outcome.end


def _row(name: str, runs: list[Ended], exact: list[float]) -> tuple[str, str, str]:
    return name, f"{1e6 * math.dist(runs[0][0], exact):.2g} um", spread([cost for _, cost in runs]).text


def exudyn_block() -> Block | None:
    """The detailed drop with 17 balls in EXUDYN; None where it is not installed."""
    try:
        import exudyn_drop
    except ImportError:
        return None
    found = exudyn_drop.drop("equal", exudyn_drop.Control(), EXUDYN_SPAN)
    row = (found.solver, f"{found.peak_force:.1f} N", f"{found.wall_per_second:.3g}")
    return Block("17 balls, detailed, in EXUDYN", ("solver", "peak force", "s per simulated s"), (row,))
