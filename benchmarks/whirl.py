"""Whirls that `touchdown whirl` predicts, against drops.

First three mounts under rotor I with its bearings out of line: frequency and forces of the backward whirl
in drops of half a second, over their last tenth, beside what is predicted at the rotor's speed there. Then
the processor time of maps over two settings of the mounts. Last mounts drawn at random: whether the drop
still whirls after 0.4 s, beside the margin.

    python benchmarks/whirl.py [--mounts 40] [--seed 11] [--side 20]
"""

from __future__ import annotations

import argparse
import math
from collections import Counter
from itertools import product
from time import process_time

import numpy as np

import touchdown
from touchdown.master.scene.scene import Scene
from touchdown.studies.rotor.whirl_prediction import (
    HERTZ,
    SURE,
    PredictedWhirl,
    machine,
    over,
    with_mounts,
)

SCENE = "rotor1-18000-225um"
ROWS: dict[str, dict[str, object]] = {
    "2.5e8 N/m, 2500 N s/m, 5 kg": {},
    "2.5e8 N/m, 10000 N s/m, 5 kg": {"housing_*.damping": 1e4},
    "2e7 N/m, 1000 N s/m, 0.5 kg": {
        "housing_*.stiffness": 2e7,
        "housing_*.damping": 1e3,
        "housing_*.mass": 0.5,
    },
}
SLIDING: dict[str, object] = {  # settings of mounts in place of the housings
    **dict.fromkeys(("housing_*.spring.xx", "housing_*.spring.yy"), 1e7),
    **dict.fromkeys(("housing_*.damper.xx", "housing_*.damper.yy"), 100.0),
    "housing_*.mass": 0.5,
    "housing_*.slide[1].stiffness": 2e7,
    "housing_*.slide[1].force": 400.0,
}
DURATION, LAST = 0.5, 0.1  # s
DROP = {"run.duration": DURATION, "run.record_every": 1, "run.stop_residual": 1e9}
RANGES = {  # of mounts drawn at random, evenly by their logarithms
    "housing_*.stiffness": (5e5, 2.5e8),
    "housing_*.damping": (100.0, 1e4),
    "housing_*.mass": (0.5, 5.0),
}
SPRINGS = "housing_*.spring.xx,housing_*.spring.yy"
MAPS: dict[str, dict[str, tuple[float, float]]] = {  # by scene: settings and their ranges
    SCENE: {"housing_*.stiffness": (5e5, 2.5e8), "housing_*.damping": (100.0, 1e4)},
    f"{SCENE}-soft": {"housing_*.slide[1].force": (20.0, 2000.0), SPRINGS: (5e6, 5e7)},
}
SEATS = ("bearing_A", "bearing_B")


def found_in(scene: Scene) -> tuple[float, float, tuple[float, ...]]:
    """Rotor's speed (rad/s), frequency of its whirl at A (Hz), mean forces (N): at the end of a drop."""
    data = touchdown.run(scene, in_process=True).data
    end = data.sel(time=slice(DURATION - LAST, None))
    x, y = (end[f"rotor.A.{k}"] - end[f"housing_A.seat.{k}"] for k in "xy")
    turned = np.unwrap(np.arctan2(np.asarray(y), np.asarray(x)))
    hertz = abs(turned[-1] - turned[0]) / HERTZ / float(end.time[-1] - end.time[0])
    forces = tuple(float(end[f"{seat}.contact.force"].mean()) for seat in SEATS)
    return float(end["rotor.A.omega"].mean()), float(hertz), forces


def predicted(scene: Scene, speed: float) -> PredictedWhirl:
    return machine(scene, abs(speed)).predicted()


def rows() -> None:
    """The table of mounts."""
    head = f"{'mount':<32}{'drop: Hz':>9}{'A, B [N]':>18}"
    print(f"{head}{'predicted: Hz':>14}{'A, B [N]':>18}{'off by':>28}")
    plain = touchdown.load(SCENE).set(DROP)
    mounts = plain.swap(housing_A="mount", housing_B="mount").set(SLIDING)
    scenes = {title: plain.set(changes) for title, changes in ROWS.items()}
    for title, scene in {**scenes, "1e7 N/m, sliding at 400 N": mounts}.items():
        speed, hertz, forces = found_in(scene)
        told = predicted(scene, speed)
        assert told.settled is not None
        pairs = zip((hertz, *forces), (told.frequency, *told.settled.force), strict=True)
        off = ", ".join(f"{100.0 * (there / drop - 1.0):+.1f} %" for drop, there in pairs)
        in_drop = f"{hertz:>9.1f}{forces[0]:>9.0f}{forces[1]:>9.0f}"
        there = f"{told.frequency:>14.1f}{told.settled.force[0]:>9.0f}{told.settled.force[1]:>9.0f}"
        print(f"{title:<32}{in_drop}{there}{off:>28}", flush=True)


def maps(side: int) -> None:
    """What maps of side x side mounts take."""
    print(f"\n{f'{side} x {side} mounts':<32}{'bearings on the rig [s]':>26}{'map [s]':>10}{'whirls':>8}")
    for name, ranges in MAPS.items():
        scene = touchdown.load(name)
        begun = process_time()
        known = machine(scene)
        measured = process_time()
        values = product(*(np.geomspace(*ends, side).tolist() for ends in ranges.values()))
        found = over(known, scene, [dict(zip(ranges, point, strict=True)) for point in values])
        spent = process_time() - measured
        whirls = sum(one.settled is not None for one in found)
        print(f"{name:<32}{measured - begun:>26.1f}{spent:>10.1f}{whirls:>8}", flush=True)


def mounts(count: int, seed: int) -> None:
    """How often drops whirl, by the margin that is predicted."""
    draw = np.random.default_rng(seed)
    scene = touchdown.load(SCENE).set({"run.duration": 0.4, "run.stop_residual": 1e9})
    known, table = machine(scene), Counter[tuple[str, bool]]()
    for _ in range(count):
        drawn = {name: math.exp(draw.uniform(*np.log(ends))) for name, ends in RANGES.items()}
        there = scene.set(drawn)
        margin = with_mounts(known, there).predicted().margin
        sure = (
            f"above {SURE:g}"
            if margin >= SURE
            else f"below 1/{SURE:g}"
            if margin <= 1 / SURE
            else "between"
        )
        summary = touchdown.run(there, in_process=True).summary
        lasts = any("still" in seat["whirl"] for seat in summary["seats"].values())
        table[sure, lasts] += 1
    print(f"\n{count} mounts drawn at random (seed {seed})")
    print("margin      whirl after 0.4 s    do not")
    for sure in (f"above {SURE:g}", "between", f"below 1/{SURE:g}"):
        print(f"{sure:<12}{table[sure, True]:>17}{table[sure, False]:>10}")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--mounts", type=int, default=40)
    parser.add_argument("--seed", type=int, default=11)
    parser.add_argument("--side", type=int, default=20, help="of the maps")
    options = parser.parse_args()
    rows()
    maps(options.side)
    mounts(options.mounts, options.seed)


if __name__ == "__main__":
    main()
