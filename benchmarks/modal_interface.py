"""Rotor I on two caged bearings: what the default scheme errs in the first impacts.

Journals against the monolithic solution 9 ms after the shutdown, and peak contact forces against macro
steps of 1 us; in process.

    python benchmarks/modal_interface.py
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from rotor_speed import JOURNALS, opened, reference

from touchdown.master.coupling.simulation import simulate
from touchdown.master.scene.scene import Scene

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests" / "support"))
from systems import dropped  # the drop that the tests make

MODES = (5, 20)
STEPS = (5e-6, 2e-5, 4e-5, 1e-4)
FINE = 1e-6  # s


def ended(scene: Scene, step: float) -> tuple[np.ndarray, np.ndarray]:
    """Both journals (m) at the end, and both peak contact forces (N)."""
    scene = scene.set({"run.macro_step": step})
    with opened(scene, in_process=True) as system:
        simulate(scene, system)
        peaks = [system.value(f"bearing_{end}.contact.peak_force") for end in "AB"]
        return np.array([system.value(name) for name in JOURNALS]), np.array(peaks)


def main() -> None:
    """Print the table."""
    print(f"{'modes':>5}{'macro step':>12}{'journal [um]':>14}{'peak A [%]':>12}{'peak B [%]':>12}")
    for modes in MODES:
        scene = dropped(modes)
        exact, peaks = reference(scene), ended(scene, FINE)[1]
        for step in STEPS:
            found, force = ended(scene, step)
            off = 1e6 * np.max(np.hypot(*(found - exact).reshape(2, 2).T))
            errors = "".join(f"{100.0 * (f / p - 1.0):>12.3f}" for f, p in zip(force, peaks, strict=True))
            print(f"{modes:>5}{1e6 * step:>9g} us{off:>14.4f}{errors}", flush=True)


if __name__ == "__main__":
    main()
