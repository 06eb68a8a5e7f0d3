"""What balls in space cost beside balls in the plane: right-hand sides of the same bearing, by turns.

    python benchmarks/in_space.py [--turns 41]

Both detailed cageless bearings, at contact angle 0, are carried through the first impact of the disk.
Their right-hand sides are then evaluated by turns, `TIMES` over in compiled code, on states with nine
loaded balls of 17. Printed are medians of the turns, in processor time, and that of their ratios; then the
same for a pair with a contact angle, which has twice as many balls.
"""

from __future__ import annotations

import argparse
import math
import statistics
import time as clock
from collections.abc import Callable

import numpy as np
from detailed_speed import kept, released, repeater
from right_hand_side import STRETCH, loaded

from touchdown.bearings import angular_cageless, detailed_cageless
from touchdown.bearings.rolling.micro_step import MICRO_STEP
from touchdown.modelkit.instance import Instance

LOADED, STATES, TIMES, SPAN = 9, 5, 4000, 1.3e-3  # balls, states, evaluations in a turn, s
PAIR = {"rows": 2, "contact_angle": math.radians(25.0), "outer_conformity": 1.06}
CLAMPED = {"arrangement": 1, "row_distance": 9e-3, "preload": 100.0}


class Timed:
    """A bearing's right-hand side on some of its states."""

    def __init__(self, module, states: list[np.ndarray]) -> None:
        self._repeat: Callable = repeater(module)
        self._words = states
        self._rows = np.zeros((8, module.MEMORY["q"].shape[0]))
        self.once()

    def once(self) -> float:
        """Processor time of an evaluation, the mean over all states (s)."""
        began = clock.process_time()
        for words in self._words:
            self._repeat(words, self._rows, TIMES)
        return (clock.process_time() - began) / (TIMES * len(self._words))


def landed(module) -> list[np.ndarray]:
    """States of the first impact with `LOADED` balls."""
    instance, carry = released(module), kept(module)
    seen, rows = [], np.zeros((8, len(instance.record["q"])))
    for _ in range(round(SPAN / STRETCH)):
        carry(instance.words, rows, STRETCH, MICRO_STEP, 0.0)
        if loaded(instance) == LOADED:
            seen.append(instance.words.copy())
    if not seen:
        raise SystemExit(f"no state of {module.MODEL.name} has {LOADED} loaded balls")
    return [seen[round(k)] for k in np.linspace(0, len(seen) - 1, STATES)]


def clamped() -> list[np.ndarray]:
    """A pair that stands still under its preload: all balls are loaded."""
    instance = Instance(angular_cageless.MODEL)
    p = instance.record["p"]
    for name, value in PAIR.items():
        p["balls"][name] = value
    for name, value in CLAMPED.items():
        p[name] = value
    instance.start(0.0)
    instance.step(0.0, 1e-4)
    return [instance.words.copy()]


def main(arguments: list[str] | None = None) -> int:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--turns", type=int, default=41)
    options = parser.parse_args(arguments)
    plane = Timed(detailed_cageless, landed(detailed_cageless))
    others = {
        "in space, 17 balls": Timed(angular_cageless, landed(angular_cageless)),
        "a pair, 34 balls": Timed(angular_cageless, clamped()),
    }
    turns = [(plane.once(), [one.once() for one in others.values()]) for _ in range(options.turns)]
    print(f"{'in the plane, 17 balls':<26}{1e6 * statistics.median(t for t, _ in turns):>8.2f} us")
    for k, name in enumerate(others):
        ratio = statistics.median(found[k] / flat for flat, found in turns)
        print(f"{name:<26}{1e6 * statistics.median(found[k] for _, found in turns):>8.2f} us{ratio:>8.2f}")
    return 0


if __name__ == "__main__":
    main()
