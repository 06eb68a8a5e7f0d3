"""How often the energy alarms are false, and how often an error goes without one: random drops, seeded.

A case is a shipped scene with a random coupling scheme, macro step, stiffness of the contact, mass of the
housing, lobes of the inner ring, angle of the unbalance and lateness of the second magnetic bearing,
through the first impact. Its figures are, at every bearing, contact force and ball force of the first
impact, and the largest of both up to the end of the last bearing's first impact. What is right is a run
with macro steps of 1 us and steps of 0.5 us inside the bearings. A figure that differs by more than 1 %
from steps twice as long is not firm: it is left out, and with it a case that has none of the first impact.

An alarm, a warning or a stop, is false where all figures are within 2 % of what is right. An error is
silent where a figure is more than 5 % off and no alarm came. Errors between may warn or not. Alarms do not
end a run here, so that the figures of runs that they would have stopped are known. Runs of some
milliseconds have no verdict on a whirl to be judged.

    python benchmarks/alarms.py [--count 300] [--jobs 2] [--seeds found fresh] [--list]

The rule that alarms follow was chosen on the seeds `found`; it was not changed after `fresh` were run.
"""

from __future__ import annotations

import argparse
import math
import multiprocessing
import sys
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

import touchdown
from touchdown.master.common.errors import Ended, TouchdownError
from touchdown.master.coupling.observer import Observer, RunState
from touchdown.master.coupling.simulation import Outcome, opened, simulate
from touchdown.master.scene.scene import Scene
from touchdown.modelkit.ports import PARTING_TOLERANCE

SEED = 29
SEEDS = {"found": 0, "fresh": 10_000}  # the first seed of each set
# Error of the worst figure up to which a run is right, above which it is wrong
RIGHT_WITHIN, WRONG_ABOVE = 0.02, 0.05
FIRM_WITHIN = 0.01  # change of a reference's figure where its steps are halved
NO_STOP_RESIDUAL = 1e300  # a share that no run reaches
REFERENCE_STEPS = ((2e-6, 1e-6), (1e-6, 5e-7))  # s, of references: macro steps, and steps inside bearings
MIN_TIME_AFTER = 3e-4  # s, or
MIN_STEPS_AFTER = 2.5  # macro steps, that a run goes on after the first impact
MAX_REFERENCE_SPAN = 20e-3  # s from the last shutdown; by then all bearings have been hit
FIGURES = ("contact.peak_force", "balls.first_impact_force", "balls.peak_force")
STEPS = {  # by scheme: the shortest and the longest macro step, s
    "interface": (1e-5, 1e-3),
    "velocity": (5e-6, 2e-4),
    "hold": (1e-6, 5e-5),
    "acceleration": (1e-5, 2e-4),
}
DRAWN_SCHEMES = (
    "interface",
    "interface",
    "velocity",
    "hold",
    "acceleration",
)  # each as likely as the others
DISKS = (
    "disk-caged-detailed",
    "disk-caged-simplified",
    "disk-cageless-detailed",
    "disk-cageless-simplified",
)
ROTORS = ("rotor1-9000", "rotor1-18000-75um", "rotor2-case1")
ADAPTIVE = ("disk-caged-simplified", "rotor2-case1")  # bearings without steps of a given length inside


@dataclass(frozen=True)
class Case:
    """A scene with all that was drawn for it (SI), and the scheme and macro step (s) that are judged."""

    seed: int
    scene: Scene
    scheme: str
    macro_step: float
    settings: dict[str, float]

    @property
    def bearings(self) -> list[str]:
        """Names of the touchdown bearings."""
        return [name for name in self.scene.components if name.startswith("bearing")]

    @property
    def zero(self) -> float:
        """The first shutdown (s), from which the scene counts its duration."""
        return min(self._shutdowns)

    @property
    def latest(self) -> float:
        """When a reference ends at the latest (s)."""
        return max(self._shutdowns) + MAX_REFERENCE_SPAN

    @property
    def _shutdowns(self) -> list[float]:
        return [value for name, value in self.settings.items() if name.endswith("shutdown_time")]


def random_case(seed: int) -> Case:
    """The case of a seed, the same in every process."""
    rng = np.random.default_rng([SEED, seed])
    name = str(rng.choice(DISKS if rng.random() < 0.6 else ROTORS))
    scheme = str(rng.choice(DRAWN_SCHEMES))
    macro_step = _between(rng, *STEPS[scheme])
    scene = touchdown.load(name)
    if scheme == "interface" and rng.random() < 0.3:
        macro_step = scene.run.macro_step
    settings = _machine(rng, name, scene) | _shutdowns(rng, name, scene)
    return Case(seed, scene.set(settings), scheme, macro_step, settings)


def _machine(rng: np.random.Generator, name: str, scene: Scene) -> dict[str, float]:
    """Contact, housing and lobes, each now and then other than the scene has it."""
    settings: dict[str, float] = {}
    bearings = [part for part in scene.components if part.startswith("bearing")]
    if rng.random() < 0.4:
        stiffness = _between(rng, 1.0, 100.0) * (1.2e9 if name.startswith("rotor2") else 2.4e9)
        settings |= {f"{bearing}.contact.stiffness": stiffness for bearing in bearings}
    if rng.random() < 0.4:
        mass = _between(rng, 0.01, 5.0)
        settings |= {f"{part}.mass": mass for part in scene.components if part.startswith("housing")}
    if name.endswith("-detailed") and rng.random() < 0.5:
        settings["bearing.inner_profile.lobes"] = float(rng.integers(2, 10))
        settings["bearing.inner_profile.amplitude"] = _between(rng, 1e-7, 5e-6)
    return settings


def _shutdowns(rng: np.random.Generator, name: str, scene: Scene) -> dict[str, float]:
    """When magnetic bearings shut down, a rotor's second one late now and then; the unbalance's angle."""
    shutdown = 2e-3 if name in DISKS else 6e-3
    magnets = [part for part in scene.components if part.startswith("amb")]
    settings = {f"{magnet}.shutdown_time": shutdown for magnet in magnets}
    if len(magnets) > 1:
        settings["rotor.unbalance_angle"] = rng.uniform(0.0, 2.0 * math.pi)
        if rng.random() < 0.4:
            settings[f"{magnets[1]}.shutdown_time"] = shutdown + _between(rng, 1e-4, 3e-3)
    return settings


def _between(rng: np.random.Generator, low: float, high: float) -> float:
    """A number whose logarithm is uniform."""
    return float(np.exp(rng.uniform(np.log(low), np.log(high))))


class FirstImpacts(Observer):
    """Notes when the first impact is over at each bearing (s), and ends the run after the last."""

    at_beats_only: ClassVar[bool] = True

    def __init__(self, bearings: Sequence[str]) -> None:
        self.over: dict[str, float] = {}  # by bearing
        self._touching: dict[str, float] = {}
        self._bearings = bearings

    def stepped(self, state: RunState) -> None:
        for bearing in self._bearings:
            since = self._touching.get(bearing)
            touched = since is None and state.system.value(f"{bearing}.contact.peak_force") > 0.0
            if touched or state.system.value(f"{bearing}.contact.force") > 0.0:
                self._touching[bearing] = state.time
            elif since is not None and state.time - since > PARTING_TOLERANCE:
                self.over.setdefault(bearing, state.time - 0.5 * PARTING_TOLERANCE)
        if len(self.over) == len(self._bearings):
            state.stop("all first impacts are over")


class Figures(Observer):
    """Reads each bearing's figures at the end of the macro step in which given times (s) lie."""

    def __init__(self, over: dict[str, float]) -> None:
        self._times = {bearing: [time, max(over.values())] for bearing, time in over.items()}
        self.read: dict[tuple[str, int], list[float]] = {}

    def stepped(self, state: RunState) -> None:
        for bearing, times in self._times.items():
            for k, time in enumerate(times):
                if (bearing, k) not in self.read and state.time >= time:
                    self.read[bearing, k] = [state.system.value(f"{bearing}.{name}") for name in FIGURES]

    def due(self, now: RunState) -> int:
        """The step in which the next time lies; all up to it may be taken in compiled code."""
        if now.done == 0:
            return 1
        step = (now.time - now.start) / now.done
        left = [
            time
            for bearing, times in self._times.items()
            for k, time in enumerate(times)
            if (bearing, k) not in self.read
        ]
        return max(now.done + 1, math.ceil((min(left) - now.start) / step)) if left else now.steps

    @property
    def values(self) -> np.ndarray:
        """By bearing: first impact's contact and ball force, then the largest of the run (N)."""
        rows = [
            [*self.read[bearing, 0][:2], self.read[bearing, 1][0], self.read[bearing, 1][2]]
            for bearing in self._times
        ]
        return np.array(rows)


def carried(
    case: Case, scheme: str, step: float, end: float, observer: Observer, inside: float = 0.0
) -> Outcome:
    """Run a case to `end` (s); inside: length of the steps inside bearings (s), 0: as the scene has it."""
    settings: dict[str, object] = {
        "run.scheme": scheme,
        "run.macro_step": step,
        "run.stop_residual": NO_STOP_RESIDUAL,
    }
    if inside:
        settings["run.impact_step"] = 0.0
        if case.scene.name not in ADAPTIVE:
            settings |= {f"{bearing}.micro_step": inside for bearing in case.bearings}
    settings["run.duration"] = math.ceil(end / step) * step - case.zero
    scene = case.scene.set(settings)
    with opened(scene, in_process=True) as system:
        outcome = simulate(scene, system, observers=[observer])
    outcome.raise_if_interrupted()
    return outcome


@dataclass(frozen=True)
class Judged:
    """A case: error of the worst firm figure, and what was said of it; unfirm: why it is not judged."""

    case: Case
    error: float = math.nan
    said: str = ""
    unfirm: str = ""

    @property
    def right(self) -> bool:
        """Whether all figures are right."""
        return self.error <= RIGHT_WITHIN

    @property
    def wrong(self) -> bool:
        """Whether a figure is wrong."""
        return not self.unfirm and not self.error <= WRONG_ABOVE


def judge(seed: int) -> Judged:
    """Run the case of a seed and its references."""
    case = random_case(seed)
    impacts = FirstImpacts(case.bearings)
    carried(case, "interface", REFERENCE_STEPS[0][0], case.latest, impacts, REFERENCE_STEPS[0][1])
    if len(impacts.over) < len(case.bearings):
        return Judged(case, unfirm="a first impact did not end")
    last = max(impacts.over.values())
    exact: list[np.ndarray] = []
    for step, inside in REFERENCE_STEPS:
        found = Figures(impacts.over)
        carried(case, "interface", step, last + MIN_TIME_AFTER, found, inside)
        exact.append(found.values)
    firm = np.abs(exact[0] / exact[1] - 1.0) <= FIRM_WITHIN
    if not firm[:, :2].all():
        return Judged(case, unfirm="its figures depend on the reference's steps")
    found = Figures(impacts.over)
    end = last + max(MIN_TIME_AFTER, MIN_STEPS_AFTER * case.macro_step)
    try:
        outcome = carried(case, case.scheme, case.macro_step, end, found)
    except TouchdownError as error:
        return Judged(case, math.inf, str(error))
    if outcome.ended is not Ended.COMPLETED:
        return Judged(case, math.inf, outcome.reason)
    errors = np.abs(found.values / exact[1] - 1.0)
    return Judged(case, float(np.max(errors[firm])), outcome.warning)


def table(name: str, judged: Sequence[Judged]) -> str:
    """Cases by what is right and what was said."""
    fair = [one for one in judged if not one.unfirm]
    right, wrong = [one for one in fair if one.right], [one for one in fair if one.wrong]
    false = sum(bool(one.said) for one in right)
    silent = sum(not one.said for one in wrong)
    unfirm = Counter(one.unfirm for one in judged if one.unfirm)
    rows = [
        f"seeds {name}: {len(judged)} cases, {len(fair)} judged"
        + "".join(f"; {count} not: {why}" for why, count in unfirm.items()),
        f"  {'':<36}{'cases':>7}{'alarm':>7}{'none':>7}",
    ]
    between = [one for one in fair if not one.right and not one.wrong]
    for title, ones in (("right, up to 2 %", right), ("between", between), ("wrong, above 5 %", wrong)):
        alarms = sum(bool(one.said) for one in ones)
        rows.append(f"  {title:<36}{len(ones):>7}{alarms:>7}{len(ones) - alarms:>7}")
    for title, count, ones in (("false alarms", false, right), ("silent errors", silent, wrong)):
        rows.append(
            f"  {title}: {count}, {100.0 * count / max(len(fair), 1):.1f} % of the cases judged, "
            f"{100.0 * count / max(len(ones), 1):.1f} % of the {'right' if ones is right else 'wrong'} ones"
        )
    return "\n".join(rows)


def described(one: Judged) -> str:
    """A line on a case, SI."""
    case = one.case
    drawn = ", ".join(f"{name}={value:.4g}" for name, value in case.settings.items())
    said = one.said[:100] or "no alarm"
    return (
        f"  seed {case.seed}: {case.scene.name}, {case.scheme} {case.macro_step:.3g} s, "
        f"error {100.0 * one.error:.2g} %; {said}; {drawn}"
    )


def main() -> None:
    """Print a table for each set of seeds."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--count", type=int, default=300, help="cases of each set")
    parser.add_argument("--jobs", type=int, default=1, help="processes")
    parser.add_argument("--seeds", nargs="+", choices=SEEDS, default=list(SEEDS))
    parser.add_argument("--list", action="store_true", help="false alarms and silent errors one by one")
    options = parser.parse_args()
    with multiprocessing.Pool(options.jobs) as pool:
        for name in options.seeds:
            judged: list[Judged] = []
            for one in pool.imap(judge, range(SEEDS[name], SEEDS[name] + options.count)):
                judged.append(one)
                print(f"\r{len(judged)} of {options.count}", end="", file=sys.stderr, flush=True)
            print(f"\n{table(name, judged)}", flush=True)
            if options.list:
                faults = [one for one in judged if (one.right and one.said) or (one.wrong and not one.said)]
                print("\n".join(map(described, faults)), flush=True)


if __name__ == "__main__":
    main()
