"""How long a macro step the coupling can take in hard cases.

A case is a scene, figures read at the end of its run, and what is right: from theory, or from a run at
REFERENCE_STEP with the default scheme. A run is

- stable, if it reaches its end and no journal gets faster, or farther from the origin, than GROWTH_LIMIT
  times what it does in the run that is right;
- right, if it is stable and no figure is off by more than VISIBLE_ERROR, which the eye sees in a plot.

The macro steps tried are STEPS. From the case's first one the search goes down until a run is right, and
up until one is not stable, so that every step between is tried. The ledger never stops a run here; what
counts is whether it has passed the scene's threshold of warning in the first run that is not right.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, TypeVar

import numpy as np

from ...master.common.errors import Ended, TouchdownError
from ...master.common.pool import TaskOutcome, run_all
from ...master.components.component import POSITION
from ...master.coupling.observer import Observer, RunState
from ...master.coupling.simulation import Outcome, opened, simulate
from ...master.coupling.steppers.carried import carrying
from ...master.coupling.system import fastest_contact
from ...master.scene import schemes
from ...master.scene.scene import Scene
from ..drop.running import undivided

Key = TypeVar("Key")
Value = TypeVar("Value")

STEPS = (*(float(f"{digit}e{power}") for power in (-6, -5, -4) for digit in (1, 2, 5)), 1e-3)  # s
FIRST_STEP = 2e-5  # s, where the search begins
REFERENCE_STEP = 5e-7  # s
GROWTH_LIMIT = 1.5  # of a journal's speed or distance; of the energy, its square
VISIBLE_ERROR = 0.05


@dataclass(frozen=True)
class Figure:
    """A number read at the end of a run: a variable, or the sum of several."""

    title: str
    variables: tuple[str, ...]  # COMPONENT.VARIABLE
    scale: float | None = None  # what an error is related to; None: the right value


@dataclass(frozen=True)
class Expected:
    """The expected result of a run."""

    values: tuple[float, ...]  # of the case's figures
    speed: float  # m/s, of the fastest journal at its fastest
    distance: float  # m, of a journal from the origin at its farthest
    rate: float = 0.0  # rad/s, of a journal's swing on its fastest contact


@dataclass(frozen=True)
class Case:
    """A scene that is hard on coupling schemes, and how its runs are judged."""

    name: str
    title: str
    scene: Scene  # to an end that all of `steps` divide
    figures: tuple[Figure, ...]
    journals: tuple[str, ...] = ("rotor.A",)  # ports of bodies
    theory: Expected | None = None  # None: a run at REFERENCE_STEP says what is right
    steps: tuple[float, ...] = STEPS
    first: float = FIRST_STEP  # one of them
    long: bool = False  # takes minutes


@dataclass(frozen=True)
class Attempt:
    """A run with one macro step."""

    step: float  # s
    values: tuple[float, ...]  # of the case's figures; none where the run broke off
    error: float  # the largest of a figure; infinite where the run broke off
    residual: float  # of the ledger, over the scene's energy scale
    warned: bool  # whether the ledger passed the scene's threshold
    broke: str = ""  # why the run is not stable

    @property
    def stable(self) -> bool:
        """Whether it reached its end within its bounds."""
        return not self.broke

    @property
    def right(self) -> bool:
        """Whether nothing is to be seen of its error."""
        return self.stable and self.error <= VISIBLE_ERROR


@dataclass(frozen=True)
class Finding:
    """Results of a case and a scheme: the runs, from the smallest macro step."""

    case: str
    scheme: str
    attempts: tuple[Attempt, ...]

    @property
    def stable(self) -> Attempt | None:
        """The longest macro step up to which all are stable."""
        return _last_before(self.attempts, lambda attempt: attempt.stable)

    @property
    def right(self) -> Attempt | None:
        """The longest macro step up to which all are right."""
        return _last_before(self.attempts, lambda attempt: attempt.right)

    @property
    def wrong(self) -> Attempt | None:
        """The shortest macro step that is not right."""
        return next((attempt for attempt in self.attempts if not attempt.right), None)

    @property
    def ledger_warned(self) -> bool | None:
        """Whether the ledger had warned in the first run that is not right; None: all are."""
        return None if self.wrong is None else self.wrong.warned

    def at(self, step: float) -> Attempt | None:
        """The run with a macro step (s), if there was one."""
        return next((attempt for attempt in self.attempts if attempt.step == step), None)


def _last_before(attempts: Sequence[Attempt], good: Callable[[Attempt], bool]) -> Attempt | None:
    last = None
    for attempt in attempts:
        if not good(attempt):
            break
        last = attempt
    return last


def search(
    attempt: Callable[[float], Attempt], steps: Sequence[float], first: float
) -> tuple[Attempt, ...]:
    """Attempts from the longest right step at or below `first` to the shortest above that is not stable."""
    begin = steps.index(first)
    attempts = [attempt(first)]
    for step in reversed(steps[:begin]):
        if attempts[0].right:
            break
        attempts.insert(0, attempt(step))
    for step in steps[begin + 1 :]:
        if not attempts[-1].stable:
            break
        attempts.append(attempt(step))
    return tuple(attempts)


def examine(case: Case, scheme: str, expected: Expected) -> Finding:
    """Search the macro steps of a scheme in a case."""
    return Finding(
        case.name,
        scheme,
        search(lambda step: attempted(case, scheme, step, expected), case.steps, case.first),
    )


def attempted(case: Case, scheme: str, step: float, expected: Expected) -> Attempt:
    """Run a case and judge it."""
    bounds = Bounds(case.journals, GROWTH_LIMIT * expected.speed, GROWTH_LIMIT * expected.distance)
    outcome, values = _run(case, scheme, step, bounds)
    errors = [
        abs(value - exact) / abs(exact if figure.scale is None else figure.scale)
        for figure, value, exact in zip(case.figures, values, expected.values, strict=False)
    ]
    error = float(np.max(errors)) if values else math.inf  # not a number stays it
    return Attempt(step, values, error, outcome.residual, outcome.warned_at is not None, outcome.reason)


def reference(case: Case) -> Expected:
    """The right result of a case: by theory, or by the default scheme at REFERENCE_STEP."""
    expected = case.theory
    if expected is None:
        bounds = Bounds(case.journals)
        outcome, values = _run(case, schemes.DEFAULT, REFERENCE_STEP, bounds)
        if outcome.ended is not Ended.COMPLETED:
            raise TouchdownError(f"the reference of case {case.name} stopped: {outcome.reason}")
        expected = Expected(values, bounds.fastest, bounds.farthest)
    return replace(expected, rate=_contact_rate(case))


def _contact_rate(case: Case) -> float:
    with opened(case.scene, in_process=True) as system:
        system.initialise()
        return fastest_contact(system)[1]


class Bounds(Observer):
    """Notes how fast and how far journals get, and ends a run where they get beyond what is given."""

    def __init__(
        self, journals: Sequence[str], speed: float = math.inf, distance: float = math.inf
    ) -> None:
        self.fastest = 0.0  # m/s
        self.farthest = 0.0  # m
        self._speed, self._distance = speed, distance
        self._directions = [(journal, axis) for journal in journals for axis in POSITION]

    def stepped(self, now: RunState) -> None:
        for journal, axis in self._directions:
            distance = abs(now.system.signal(f"{journal}.{axis}"))
            speed = abs(now.system.signal(f"{journal}.v{axis}"))
            if not (speed <= self._speed and distance <= self._distance):
                now.stop(
                    f"{journal} is {distance:.2g} m off and {speed:.2g} m/s fast at t = {now.time:.6g} s"
                )
                return
            self.fastest = max(self.fastest, speed)
            self.farthest = max(self.farthest, distance)


def _run(case: Case, scheme: str, step: float, bounds: Bounds) -> tuple[Outcome, tuple[float, ...]]:
    """Run a case in process: what the loop says, and the figures, none where the run broke off."""
    scene = undivided(case.scene.set({"run.scheme": scheme, "run.macro_step": step}))
    with opened(scene, in_process=True) as system:
        outcome = simulate(scene, system, observers=[bounds])
        outcome.raise_if_interrupted()
        if outcome.ended is not Ended.COMPLETED:
            return outcome, ()
        return outcome, tuple(sum(map(system.value, figure.variables)) for figure in case.figures)


@dataclass(frozen=True)
class Study:
    """All that was found."""

    cases: Sequence[Case]
    schemes: Sequence[str]
    expected: Mapping[str, Expected]  # by case
    findings: Mapping[tuple[str, str], Finding]  # by case and scheme; those that ended
    failed: Mapping[str, str]  # why, by what was to be done
    interrupted: bool = False  # whether Ctrl-C ended it

    def finding(self, case: Case, scheme: str) -> Finding | None:
        """The finding of a case and a scheme, if there is one."""
        return self.findings.get((case.name, scheme))


@dataclass(frozen=True)
class Task:
    """A case and a scheme, as they are handed to a process."""

    case: Case
    scheme: str
    expected: Expected


def study_stability(
    cases: Sequence[Case],
    schemes: Sequence[str],
    jobs: int = 2,
    done: Callable[[], object] = lambda: None,
) -> Study:
    """Examine every case with every scheme.

    done() after each reference and each finding. After Ctrl-C the study has what is there, and the rest is
    INTERRUPTED. Starts processes: see `touchdown.master.common.pool`.
    """
    expected, failed = _parted(
        [case.name for case in cases], run_all(carrying(reference), cases, jobs, done)
    )
    tasks: list[Task] = []
    if not _interrupted(failed):
        begun = [case for case in cases if case.name in expected]
        tasks = [Task(case, scheme, expected[case.name]) for case in begun for scheme in schemes]
    pairs = [(task.case.name, task.scheme) for task in tasks]
    findings, lost = _parted(pairs, run_all(carrying(_examine), tasks, jobs, done))
    failed |= {f"{case} with {scheme}": outcome for (case, scheme), outcome in lost.items()}
    why = {what: outcome.reason for what, outcome in failed.items()}
    return Study(cases, schemes, expected, findings, why, _interrupted(failed))


def _parted(
    keys: Iterable[Key], outcomes: Iterable[TaskOutcome[Value]]
) -> tuple[dict[Key, Value], dict[Key, TaskOutcome[Value]]]:
    """The values of the tasks, and the outcomes of those that have none."""
    given: dict[Key, Value] = {}
    failed: dict[Key, TaskOutcome[Value]] = {}
    for key, outcome in zip(keys, outcomes, strict=True):
        if outcome.value is None:
            failed[key] = outcome
        else:
            given[key] = outcome.value
    return given, failed


def _interrupted(failed: Mapping[str, TaskOutcome[Any]]) -> bool:
    return any(outcome.ended is Ended.INTERRUPTED for outcome in failed.values())


def size(cases: Sequence[Case], schemes: Sequence[str]) -> int:
    """How often a study calls `done`."""
    return len(cases) * (1 + len(schemes))


def _examine(task: Task) -> Finding:
    return examine(task.case, task.scheme, task.expected)
