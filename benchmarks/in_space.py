"""What balls in space cost beside balls in the plane: right-hand sides of the same bearing, by turns.

    python benchmarks/in_space.py [--turns 41]

Detailed bearings, at contact angle 0, are carried through the first impact of the disk. Their right-hand
sides are then evaluated by turns, `TIMES` over in compiled code: without a cage on states with nine loaded
balls of 17, with one on states with three of nine. Printed are medians of the turns, in processor time, and
that of their ratios; then the same for pairs with a contact angle, which have twice as many balls.
"""

from __future__ import annotations

import argparse
import math
import statistics
import time as clock
from collections.abc import Callable
from types import ModuleType
from typing import NamedTuple

import numpy as np
from detailed_speed import kept, released, repeater
from right_hand_side import STRETCH, loaded

from touchdown.bearings import angular_caged, angular_cageless, detailed_caged, detailed_cageless
from touchdown.bearings.rolling.micro_step import MICRO_STEP
from touchdown.modelkit.instance import Instance

STATES, TIMES, SPAN = 5, 4000, 1.3e-3  # states, evaluations in a turn, s
PAIR = {"rows": 2, "contact_angle": math.radians(25.0), "outer_conformity": 1.06, "play": 0.0}
CLAMPED = {"arrangement": 1, "row_distance": 9e-3, "preload": 100.0}


class Timed:
    """A bearing's right-hand side on some of its states."""

    def __init__(self, module: ModuleType, states: list[np.ndarray]) -> None:
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


class Kind(NamedTuple):
    """A bearing in the plane, the same in space, and how many loaded balls their states have."""

    plane: ModuleType
    space: ModuleType
    loaded: int


KINDS = (Kind(detailed_cageless, angular_cageless, 9), Kind(detailed_caged, angular_caged, 3))


def landed(module: ModuleType, balls: int) -> list[np.ndarray]:
    """States of the first impact with so many loaded balls."""
    instance, carry = released(module), kept(module)
    seen, rows = [], np.zeros((8, len(instance.record["q"])))
    for _ in range(round(SPAN / STRETCH)):
        carry(instance.words, rows, STRETCH, MICRO_STEP, 0.0)
        if loaded(instance) == balls:
            seen.append(instance.words.copy())
    if not seen:
        raise SystemExit(f"no state of {module.MODEL.name} has {balls} loaded balls")
    return [seen[round(k)] for k in np.linspace(0, len(seen) - 1, STATES)]


def clamped(module: ModuleType) -> list[np.ndarray]:
    """A pair that stands still under its preload: all balls are loaded."""
    instance = Instance(module.MODEL)
    p = instance.record["p"]
    for name, value in PAIR.items():
        p["balls"][name] = value
    for name, value in CLAMPED.items():
        p[name] = value
    instance.start(0.0)
    instance.step(0.0, 1e-4)
    return [instance.words.copy()]


def compare(kind: Kind, turns: int) -> None:
    """Time a bearing in the plane and in space by turns, and print how long they take."""
    count = int(Instance(kind.plane.MODEL).record["p"]["balls"]["count"])
    plane = Timed(kind.plane, landed(kind.plane, kind.loaded))
    others = {
        f"in space, {count} balls": Timed(kind.space, landed(kind.space, kind.loaded)),
        f"a pair, {2 * count} balls": Timed(kind.space, clamped(kind.space)),
    }
    timed = [(plane.once(), [one.once() for one in others.values()]) for _ in range(turns)]
    print(kind.space.MODEL.name)
    print(
        f"  in the plane, {count} balls".ljust(28)
        + f"{1e6 * statistics.median(t for t, _ in timed):>6.2f} us"
    )
    for k, name in enumerate(others):
        ratio = statistics.median(found[k] / flat for flat, found in timed)
        took = statistics.median(found[k] for _, found in timed)
        print(f"  {name}".ljust(28) + f"{1e6 * took:>6.2f} us{ratio:>8.2f}")


def main(arguments: list[str] | None = None) -> int:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--turns", type=int, default=41)
    options = parser.parse_args(arguments)
    for kind in KINDS:
        compare(kind, options.turns)
    return 0


if __name__ == "__main__":
    main()
