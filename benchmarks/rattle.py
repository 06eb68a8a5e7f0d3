"""Random bearings followed for seconds while their balls rattle: is energy made of nothing?

Bearings of each model whose balls are free, from the landing on, with the default steps inside. Two sets
(`random_bearings.py`): `random`, within what is built, a third of them undamped at the balls; `fast`, at
60 000 rpm with ceramic balls of any size and weight, undamped everywhere.

By bearing: the largest force on a ball over the largest on the journal so far; how that grows over windows
of a tenth of the duration, from the second one on (a factor per second, fitted to the logarithms); energy
that rotor, bearing and housing gained at any time, heat counted, over what was turned over (m g c and all
heat); what contacts withheld to be passive, over the same; and heat that was taken back.

    python benchmarks/rattle.py [--set fast] [--count 100] [--duration 5] [--jobs 2]
"""

from __future__ import annotations

import argparse
import multiprocessing
from dataclasses import dataclass
from functools import partial

import numpy as np
from random_bearings import GRAVITY, MODULES, Case, continue_from, energy, fast_case, landed, random_case

from touchdown.bearings.rolling.micro_step import MICRO_STEP
from touchdown.modelkit.model import ModelError

MACRO_STEP = 1e-4  # s
TOLERANCE = 1e-6  # of adaptive steps, which are not taken here
WINDOWS = 10
SETS = {"random": random_case, "fast": fast_case}
MOST_FORCE = 3.0  # largest on a ball over the largest on the journal
COLUMNS = (
    *("ball/journal", "largest", f"above {MOST_FORCE:g}", "growth, 1/s", "largest"),
    *("made", "largest", "withheld", "largest", "taken back", "evals/us"),
)


@dataclass(frozen=True)
class Rattle:
    """What a case came to; energies over what was turned over."""

    seed: int
    force: float = np.nan  # largest on a ball over the largest on the journal
    ball: float = np.nan  # N, the former
    growth: float = np.nan  # factor per second of the largest force on a ball over that
    made: float = np.nan
    withheld: float = np.nan
    taken_back: float = np.nan
    evaluations: float = np.nan  # per us
    stopped: str = ""


def main() -> None:
    """Print a row per model: medians and the largest of all."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--models", nargs="+", choices=MODULES, default=list(MODULES))
    parser.add_argument("--set", choices=SETS, default="random", dest="cases")
    parser.add_argument("--count", type=int, default=100)
    parser.add_argument("--duration", type=float, default=1.0, help="s from the landing; default 1")
    parser.add_argument("--step", type=float, default=MICRO_STEP, help="s inside; default as shipped")
    parser.add_argument("--jobs", type=int, default=1, help="processes")
    parser.add_argument("--list-worst", type=int, default=0, metavar="N", help="seeds furthest off")
    options = parser.parse_args()
    print(f"{options.count} {options.cases} bearings of each model, {options.duration:g} s; medians")
    print(f"{'':20}" + "".join(f"{name:>13}" for name in COLUMNS))
    for model in options.models:
        run = partial(rattled, model, options.cases, options.duration, options.step)
        rattled(model, options.cases, MACRO_STEP, options.step, 0)  # compiles, for all processes
        with multiprocessing.Pool(options.jobs) as pool:
            found = pool.map(run, range(options.count), chunksize=1)
        print(row(model, found), flush=True)
        for line in worst(found, options.list_worst):
            print(line)


def rattled(model: str, cases: str, duration: float, step: float, seed: int) -> Rattle:
    """The bearing of a `seed` over a `duration` (s), in steps inside of at most `step` (s)."""
    case = SETS[cases](model, seed)
    instance = landed(case, TOLERANCE, step)
    try:
        return _followed(case, instance, max(round(duration / MACRO_STEP), WINDOWS))
    except ModelError as error:
        return Rattle(seed, stopped=str(error))


def _followed(case: Case, instance, steps: int) -> Rattle:
    m, before = instance.record, energy(instance, case.rotor)
    o, heat, taken_back, made = m["o"], 0.0, 0.0, 0.0
    peaks, journal = np.zeros(WINDOWS), np.zeros(WINDOWS)
    lost = case.rotor.mass * GRAVITY * case.clearance
    per_window = steps // WINDOWS
    for k in range(per_window * WINDOWS):
        window = k // per_window
        if k % per_window == 0:
            o["balls"]["peak_force"] = 0.0
        instance.step(k * MACRO_STEP, MACRO_STEP)
        continue_from(instance)
        now = float(o["energy"]["dissipated"])
        taken_back += max(heat - now, 0.0)
        heat = now
        made = max(made, (energy(instance, case.rotor) - before) / (lost + heat))
        peaks[window] = float(o["balls"]["peak_force"])
        journal[window] = float(o["contact"]["peak_force"])
    return Rattle(
        seed=case.seed,
        force=float(np.max(peaks / journal)),
        ball=float(np.max(peaks)),
        growth=_growth(peaks / journal, per_window * MACRO_STEP),
        made=made,
        withheld=float(m["s"]["withheld"]) / (lost + heat),
        taken_back=taken_back / (lost + heat),
        evaluations=float(m["evaluations"]) * 1e-6 / (per_window * WINDOWS * MACRO_STEP),
    )


def _growth(peaks: np.ndarray, window: float) -> float:
    """Factor per second by which `peaks` (n,) of windows of that length (s) grow, the first left out."""
    kept = np.maximum(peaks[1:], 1e-9)
    return float(np.exp(np.polyfit(window * np.arange(len(kept)), np.log(kept), 1)[0]))


def row(model: str, found: list[Rattle]) -> str:
    """A line of the table."""
    kept = [r for r in found if not r.stopped]

    def of(name: str) -> np.ndarray:
        return np.array([getattr(r, name) for r in kept])

    force = of("force")
    cells = f"{np.median(force):13.3g}{force.max():13.3g}{int(np.sum(~(force < MOST_FORCE))):13d}"
    for name in ("growth", "made", "withheld"):
        cells += f"{np.median(of(name)):13.2g}{of(name).max():13.2g}"
    cells += f"{of('taken_back').max():13.2g}{np.median(of('evaluations')):13.3g}"
    return f"{model:20}{cells}   {len(found) - len(kept)} stopped"


def worst(found: list[Rattle], count: int) -> list[str]:
    """Lines on the `count` seeds furthest off by each figure, and on all that stopped."""
    kept = [r for r in found if not r.stopped]
    lines = [f"  stopped: seed {r.seed}: {r.stopped}" for r in found if r.stopped]
    for name in ("force", "growth", "made", "withheld"):
        ranked = sorted(kept, key=lambda r: -getattr(r, name))[:count]
        shown = ", ".join(f"{r.seed} ({getattr(r, name):.3g}; {r.ball:.0f} N)" for r in ranked)
        if shown:
            lines.append(f"  {name}: seeds {shown}")
    return lines


if __name__ == "__main__":
    main()
