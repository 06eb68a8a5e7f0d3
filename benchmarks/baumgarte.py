"""Drift of the outer ring's constraint in the augmented form, for several alpha and beta.

The detailed bearings pressed by their journal, integrated by scipy's RK45 with the rotation of the outer
ring held by a multiplier (2.23, 2.28), against the same with the rotation eliminated. `rim` is how far
the pin at the outer race has moved: from a start that keeps the constraint, and from one that violates it.

    python benchmarks/baumgarte.py [--span 0.5e-3]
"""

from __future__ import annotations

import argparse
import time as clock

import numpy as np
from scipy.integrate import solve_ivp

from touchdown.bearings import detailed_caged, detailed_cageless, seat
from touchdown.bearings.rolling.augmented import AugmentedBearing
from touchdown.modelkit.instance import Instance

PAIRS = ((0.0, 0.0), (1e2, 1e2), (1e3, 1e3), (1e4, 1e4), (1e5, 1e5), (1e4, 0.0), (0.0, 1e4), (1e6, 1e6))
VIOLATED = (1e-6, 1e-3)  # rad, rad/s


def pressed(model) -> Instance:
    """A bearing 0.4 ms after its journal's first touch."""
    instance = Instance(model)
    m = instance.memory
    m["p"]["micro_step"] = 0.0
    journal, housing = m["u"]["journal"], m["u"]["housing"]
    journal["y"], journal["vy"], journal["omega"] = -3e-4, -0.0767, 942.0
    journal["inv_m"], journal["inv_I"] = 1.0 / 1.65, 2000.0
    housing["inv_m"], housing["k_over_m"], housing["c_over_m"] = 1.0 / 5.02, 4.98e7, 498.0
    instance.start(0.0)
    instance.step(0.0, 4e-4)
    q = m["q"][0]
    for part, first in ((journal, seat.JX), (housing, seat.HX)):
        for i, key in enumerate(("x", "y", "vx", "vy")):
            part[key] = q[first + i]
    return instance


def end_of(system: AugmentedBearing, start: np.ndarray, span: float) -> tuple[np.ndarray, int, float]:
    """(State at the end, evaluations, wall time in s)."""
    began = clock.perf_counter()
    found = solve_ivp(system.rhs, (0.0, span), start, method="RK45", rtol=1e-7, atol=1e-11)
    return found.y[:, -1], found.nfev, clock.perf_counter() - began


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--span", type=float, default=5e-4, help="s")
    span = parser.parse_args().span
    print(
        f"{span * 1e3:g} ms from 0.4 ms after the first touch; violated start: {VIOLATED[0]:g} rad, ",
        end="",
    )
    print(f"{VIOLATED[1]:g} rad/s")
    for model in (detailed_cageless.MODEL, detailed_caged.MODEL):
        instance = pressed(model)
        reduced = AugmentedBearing(instance, eliminated=True)
        exact, evaluations, wall = end_of(reduced, reduced.initial(), span)
        print(f"\n{model.title}, {reduced.coordinates - 3} coordinates and the journal's")
        print(f"{'alpha [1/s]':>12}{'beta [1/s]':>12}{'rim [m]':>12}{'violated [m]':>14}", end="")
        print(f"{'bodies differ [m]':>19}{'evaluations':>13}{'wall [s]':>10}")
        print(f"{'eliminated':>24}{'-':>12}{'-':>14}{'-':>19}{evaluations:>13}{wall:>10.2f}")
        for alpha, beta in PAIRS:
            held = AugmentedBearing(instance, alpha=alpha, beta=beta)
            kept, evaluations, wall = end_of(held, held.initial(), span)
            broken = end_of(held, held.initial(*VIOLATED), span)[0]
            n = held.coordinates
            apart = float(np.max(np.abs((kept - exact)[:n].reshape(-1, 3)[:, :2])))
            rim, left = abs(held.violation(kept)[0]), abs(held.violation(broken)[0])
            print(f"{alpha:>12g}{beta:>12g}{rim:>12.1e}{left:>14.1e}{apart:>19.1e}", end="")
            print(f"{evaluations:>13}{wall:>10.2f}")


if __name__ == "__main__":
    main()
