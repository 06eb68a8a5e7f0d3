"""How far the steps inside the bearings are off adaptive ones, over many bearings.

Random bearings (`random_bearings`, seeded) and the two of the disk scenes at twelve ball angles carry a
disk through the first millisecond of contact by their model's own macro step, once in steps of a given
length and once in adaptive steps of a tolerance of 1e-9. Errors are those of the peak forces on the worst
ball, at the side of a ball (neighbour or cage) and of the journal, of the journal's place at the end, and
the energy made over m g c, the energy of a drop through the clearance. The simplified caged bearing always
takes adaptive steps and is left out.

Counted apart are cases that are chaotic (a tolerance of 1e-8 changes the most loaded ball or side by 0.3 %,
or the place by 0.01 um), and for the side figure those where no side bears 1 N.

    python benchmarks/inner_steps.py [--models detailed_caged] [--count 40] [--steps 2e-6 1e-6]

References take most of the time; `--references FILE.json` keeps them from one run to the next. They are
told apart by the case and the stiffness of its races, not by the version of the program.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import multiprocessing
import statistics
import time as clock
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass, replace
from functools import partial
from itertools import pairwise
from pathlib import Path

import numpy as np
from random_bearings import (
    GRAVITY,
    MODULES,
    Case,
    carry,
    energy,
    landed,
    random_case,
    shipped_cases,
)

from touchdown.modelkit.model import ModelError

EXACT, CHECK = 1e-9, 1e-8  # tolerances of the reference, and of the one it is compared with
SAME_FORCE = 3e-3  # the largest change of a peak from one to the other of a case that is not chaotic
SAME_PLACE = 1e-8  # m, of the journal's place
LEAST_SIDE = 1.0  # N; a smaller peak at the balls' sides is not judged
QUANTILES = {"median": 0.5, "90 %": 0.9, "max": 1.0}
REPEAT = 3  # runs of which the fastest counts


@dataclass(frozen=True)
class Figures:
    """What a bearing did: peaks (N), the journal's place at the end (m), energy made (J), evaluations."""

    ball: float
    side: float
    journal: float
    x: float
    y: float
    made: float
    evaluations: int


@dataclass(frozen=True)
class Judged:
    """A case, its references at `EXACT` and `CHECK`, and by step its figures and time (s).

    failed: what stopped it, empty otherwise.
    """

    case: Case
    references: tuple[Figures, ...]
    stepped: tuple[Figures, ...]
    times: tuple[float, ...]
    failed: str = ""

    @property
    def chaotic(self) -> bool:
        """Whether adaptive steps differ from themselves."""
        exact, check = self.references
        sides = has_side(exact) and abs(check.side / exact.side - 1.0) > SAME_FORCE
        return sides or abs(check.ball / exact.ball - 1.0) > SAME_FORCE or apart(exact, check) > SAME_PLACE


@dataclass(frozen=True)
class Plan:
    """How cases are run: step lengths, length of the run and of a macro step (s)."""

    steps: tuple[float, ...]
    span: float
    macro_step: float


def has_side(exact: Figures) -> bool:
    """Whether a side bears enough to be judged."""
    return exact.side >= LEAST_SIDE


def apart(a: Figures, b: Figures) -> float:
    """How far the journal's places at the end lie apart (m)."""
    return float(np.hypot(a.x - b.x, a.y - b.y))


def _drop_energy(case: Case) -> float:
    """Energy of a drop through the clearance (J)."""
    return case.rotor.mass * GRAVITY * case.clearance


# By row of the table: error of a run in a case of these references; NaN: not judged.
ERRORS: dict[str, Callable[[Figures, Figures, Case], float]] = {
    "most loaded ball, %": lambda now, exact, case: 100.0 * abs(now.ball / exact.ball - 1.0),
    "side of a ball, %": lambda now, exact, case: (
        100.0 * abs(now.side / exact.side - 1.0) if has_side(exact) else np.nan
    ),
    "journal's force, %": lambda now, exact, case: 100.0 * abs(now.journal / exact.journal - 1.0),
    "journal's place, um": lambda now, exact, case: 1e6 * apart(now, exact),
    "energy made, 1e-3 m g c": lambda now, exact, case: 1e3 * abs(now.made) / _drop_energy(case),
}


def run(case: Case, plan: Plan, step: float, tolerance: float = EXACT) -> tuple[Figures, float]:
    """(Figures of `case` in steps of `step` (s), 0: adaptive ones of `tolerance`; time taken (s))."""
    instance = landed(case, tolerance, step)
    m = instance.record
    before = energy(instance, case.rotor)
    count = max(round(plan.span / plan.macro_step), 1)
    macro_step = plan.span / count
    began = clock.perf_counter()
    carry(instance, macro_step, count)
    spent = clock.perf_counter() - began
    o = m["o"]
    side = o["pockets"] if case.model.endswith("_caged") else o["neighbours"]
    peaks = (float(part["peak_force"]) for part in (o["balls"], side, o["contact"]))
    place = float(m["u"]["journal"]["x"]), float(m["u"]["journal"]["y"])
    made = energy(instance, case.rotor) - before
    return Figures(*peaks, *place, made, int(m["evaluations"])), spent


def key(case: Case, span: float) -> str:
    """By which the references of a case are kept."""
    stiffness = landed(case, EXACT, 0.0).record["o"]["stiffness"]
    races = [f"{float(stiffness[name]):.9g}" for name in ("inner", "outer", "series")]
    words = json.dumps([case.model, case.parameters, asdict(case.rotor), span, races], sort_keys=True)
    return f"{case.model} {case.seed} {hashlib.sha256(words.encode()).hexdigest()[:16]}"


def judge(work: tuple[Case, tuple[Figures, ...]], plan: Plan) -> Judged:
    """One case, with its references where they are known; of each step the fastest of `REPEAT` runs."""
    case, references = work
    try:
        references = references or tuple(run(case, plan, 0.0, e)[0] for e in (EXACT, CHECK))
        runs = [[run(case, plan, step) for step in plan.steps] for _ in range(REPEAT)]
    except ModelError as error:
        return Judged(case, references, (), (), str(error))
    times = tuple(min(row[i][1] for row in runs) for i in range(len(plan.steps)))
    return Judged(case, references, tuple(figures for figures, _ in runs[0]), times)


def judge_all(cases: list[Case], plan: Plan, jobs: int, kept: Path | None) -> Iterator[Judged]:
    """All cases in `jobs` processes; references are read from and added to the file `kept`."""
    known = json.loads(kept.read_text()) if kept and kept.exists() else {}
    keys = [key(case, plan.span) for case in cases]
    works = [
        (case, tuple(Figures(**figures) for figures in known.get(name, ())))
        for case, name in zip(cases, keys, strict=True)
    ]
    with multiprocessing.Pool(jobs) as pool:
        for name, found in zip(keys, pool.imap(partial(judge, plan=plan), works), strict=True):
            if found.references:
                known[name] = [asdict(figures) for figures in found.references]
            yield found
    if kept:
        kept.write_text(json.dumps(known, indent=1))


def errors(judged: list[Judged], row: str, step: int) -> np.ndarray:
    """Of the cases that `row` can be judged in, in steps of the plan's `step`-th length."""
    found = [ERRORS[row](one.stepped[step], one.references[0], one.case) for one in judged]
    return np.array([error for error in found if not np.isnan(error)])


def table(title: str, judged: list[Judged], steps: tuple[float, ...]) -> list[str]:
    """Lines with the quantiles of every error, by step, and how they fall from step to step."""
    failed = [one for one in judged if one.failed]
    chaotic = [one for one in judged if not one.failed and one.chaotic]
    fair = [one for one in judged if not one.failed and not one.chaotic]
    sides = sum(has_side(one.references[0]) for one in fair)
    lines = [
        f"{title}: {len(judged)} cases, {len(chaotic)} chaotic, {len(failed)} stopped, "
        f"{len(fair)} judged, {sides} of them with 1 N and more at a side"
    ]
    if not fair:
        return lines
    groups = [f"{1e6 * step:g} us" for step in steps]
    groups += [f"{1e6 * a:g} over {1e6 * b:g} us" for a, b in pairwise(steps)]
    lines.append(f"  {'':<24}" + "".join(f"{group:>27}" for group in groups))
    lines.append(f"  {'error':<24}" + "".join(f"{name:>9}" for name in QUANTILES) * len(groups))
    for row in ERRORS:
        by_step = [errors(fair, row, i) for i in range(len(steps))]
        if not len(by_step[0]):
            continue
        values = np.array([np.quantile(found, list(QUANTILES.values())) for found in by_step])
        with np.errstate(divide="ignore", invalid="ignore"):
            cells = np.concatenate([values.ravel(), (values[:-1] / values[1:]).ravel()])
        lines.append(f"  {row:<24}" + "".join(f"{cell:>9.2g}" for cell in cells))
    return [*lines, *_cost(fair, steps)]


def _cost(judged: list[Judged], steps: tuple[float, ...]) -> list[str]:
    """Evaluations, and time over that of the first step, the median over the cases."""
    parts = []
    for i, step in enumerate(steps):
        count = statistics.median(one.stepped[i].evaluations for one in judged)
        ratio = statistics.median(one.times[i] / one.times[0] for one in judged)
        parts.append(f"{1e6 * step:g} us: {count:g} evaluations, {ratio:.2f} times the time")
    return ["  cost of the run, median: " + "; ".join(parts)]


def worst(judged: list[Judged], count: int) -> list[str]:
    """Lines on the cases furthest off in the plan's first step, by figure; then what these are made of."""
    fair = [one for one in judged if not one.failed and not one.chaotic]
    lines, shown = [], {one.case.seed: one for one in judged if not one.failed and one.chaotic}
    if shown:
        lines.append(f"  chaotic: seeds {', '.join(map(str, shown))}")
    for row, error in ERRORS.items():
        found = [(error(one.stepped[0], one.references[0], one.case), one) for one in fair]
        ranked = sorted(((e, one) for e, one in found if not np.isnan(e)), key=lambda pair: -pair[0])
        seeds = ", ".join(f"{one.case.seed} ({e:.3g})" for e, one in ranked[:count])
        lines.append(f"  furthest off in {row}: seeds {seeds}")
        shown |= {one.case.seed: one for _, one in ranked[:count]}
    lines += [f"  seed {seed}: {_described(shown[seed])}" for seed in sorted(shown)]
    return lines + [f"  stopped: seed {one.case.seed}: {one.failed}" for one in judged if one.failed]


def _described(one: Judged) -> str:
    """Peaks of the reference, parameters and rotor of a case, SI."""
    exact = one.references[0]
    parameters = ", ".join(f"{name}={value:.4g}" for name, value in one.case.parameters.items())
    rotor = ", ".join(f"{name}={value:.4g}" for name, value in asdict(one.case.rotor).items())
    peaks = f"ball {exact.ball:.1f} N, side {exact.side:.2f} N, journal {exact.journal:.1f} N"
    return f"{peaks}; {parameters}; {rotor}"


def with_dashpots(case: Case, model: str, damping: float) -> Case:
    """The case with a linear damping (N s/m) between the balls, or the balls and the cage."""
    side = "ball" if model.endswith("cageless") else "cage"
    added = {f"{side}_contact.viscous": damping} if damping else {}
    return replace(case, parameters=case.parameters | added)


def report(model: str, count: int, plan: Plan, options: argparse.Namespace) -> list[str]:
    """Lines on a model: its random bearings, then the shipped one."""
    run(random_case(model, 0), Plan(plan.steps, 1e-5, 1e-5), plan.steps[0])  # compiles, for all processes
    lines = []
    for title, found in (
        ("random bearings", [random_case(model, seed) for seed in range(count)]),
        ("the disk scene's, twelve ball angles", shipped_cases(model)),
    ):
        cases = [with_dashpots(case, model, options.dashpot) for case in found]
        judged = list(judge_all(cases, plan, options.jobs, options.references))
        lines += table(f"{model}, {title}", judged, plan.steps)
        if options.list_worst:
            lines += worst(judged, options.list_worst)
    return lines


def main() -> None:
    """Print all tables."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--models", nargs="+", choices=MODULES, default=list(MODULES))
    parser.add_argument("--count", type=int, default=100, help="random bearings of each model")
    parser.add_argument("--steps", nargs="+", type=float, default=[2e-6, 1e-6], help="s")
    parser.add_argument("--span", type=float, default=1e-3, help="s, from first touch on")
    parser.add_argument("--macro-step", type=float, help="s; the whole span where left out")
    parser.add_argument("--jobs", type=int, default=1, help="processes")
    parser.add_argument("--references", type=Path, metavar="FILE.json", help="kept adaptive steps")
    parser.add_argument("--dashpot", type=float, default=0.0, help="N s/m, between balls or with the cage")
    parser.add_argument("--list-worst", type=int, default=0, metavar="N", help="cases furthest off")
    options = parser.parse_args()
    plan = Plan(tuple(options.steps), options.span, options.macro_step or options.span)
    for model in options.models:
        print("\n".join(report(model, options.count, plan, options)), flush=True)


if __name__ == "__main__":
    main()
