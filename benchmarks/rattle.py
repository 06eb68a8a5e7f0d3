"""Random bearings followed while their balls rattle: does a ball gain what nothing gave it?

Random bearings of each model whose balls are free (`random_bearings.py`), a third of them undamped at the
balls, from the landing on, with the default steps inside. No ball should bear much more than the journal
does at its hardest; rotor, bearing and housing should keep their energy, with the heat.

    python benchmarks/rattle.py [--count 100] [--duration 0.1]
"""

from __future__ import annotations

import argparse
from dataclasses import dataclass

import numpy as np
from random_bearings import GRAVITY, MODULES, Case, carry, energy, landed, random_case

from touchdown.bearings.rolling.micro_step import MICRO_STEP

MACRO_STEP = 1e-4  # s
TOLERANCE = 1e-6  # of adaptive steps, which are not taken here
GROWN = 3.0  # times the largest force on the journal
COLUMNS = ("model", "ball/journal", "largest", f"above {GROWN:g}", "energy made", "largest", "evals/us")


@dataclass(frozen=True)
class Rattle:
    """What a case came to."""

    force: float  # largest on a ball over the largest on the journal
    made: float  # energy, of what was turned over: m g c and all heat
    evaluations: float  # per us


def main() -> None:
    """Print a row per model: medians and the largest of all."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--count", type=int, default=100)
    parser.add_argument("--duration", type=float, default=0.1, help="s from the landing; default 0.1")
    options = parser.parse_args()
    print(f"{options.count} bearings of each model, {options.duration:g} s from the landing; medians")
    print("".join(f"{name:>14}" if k else f"{name:22}" for k, name in enumerate(COLUMNS)))
    for model in MODULES:
        found = [rattled(random_case(model, seed), options.duration) for seed in range(options.count)]
        force, made = np.array([r.force for r in found]), np.abs([r.made for r in found])
        grown = int(np.sum(~(force < GROWN)))  # a NaN has grown
        shown = f"{np.median(force):14.3g}{force.max():14.3g}{grown:14d}"
        shown += f"{np.median(made):14.2g}{made.max():14.2g}"
        print(f"{model:22}{shown}{np.median([r.evaluations for r in found]):14.3g}", flush=True)


def rattled(case: Case, duration: float) -> Rattle:
    """The case after a `duration` (s) of macro steps."""
    instance = landed(case, TOLERANCE, MICRO_STEP)
    m, before = instance.record, energy(instance, case.rotor)
    carry(instance, MACRO_STEP, round(duration / MACRO_STEP))
    o = m["o"]
    turned = case.rotor.mass * GRAVITY * case.clearance + float(o["energy"]["dissipated"])
    return Rattle(
        force=float(o["balls"]["peak_force"] / o["contact"]["peak_force"]),
        made=(energy(instance, case.rotor) - before) / turned,
        evaluations=float(m["evaluations"]) * 1e-6 / duration,
    )


if __name__ == "__main__":
    main()
