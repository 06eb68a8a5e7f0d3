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
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import takewhile
from typing import Any

import numpy as np

from ...master.common.errors import Ended, TouchdownError
from ...master.common.pool import TaskOutcome, run_all
from ...master.common.progress import Progress
from ...master.components.component import POSITION
from ...master.coupling.observer import Observer, RunState
from ...master.coupling.simulation import Outcome, opened, simulate
from ...master.coupling.steppers.carried import carrying
from ...master.coupling.system import fastest_contact
from ...master.scene.schemes import DEFAULT, SCHEMES
from ..drop.running import undivided
from ..findings import Column, Record, number, table
from .engine import Alarm, Comparison, Measure, Options, Row
from .stability_cases import FIRST_STEP, Case, Expected, chosen

REFERENCE_STEP = 5e-7  # s
GROWTH_LIMIT = 1.5  # of a journal's speed or distance; of the energy, its square
VISIBLE_ERROR = 0.05
QUANTITIES = {
    "worst": Measure("error_relative", ("worst figure", "[%]"), 100.0, ".3g"),
    "energy": Measure("energy_residual_relative", ("ledger", "[1]"), 1.0, ".0e"),
}


def right(attempt: Row) -> bool:
    """Whether a run is stable and nothing is to be seen of its error."""
    return not attempt.failed and attempt.errors["worst"] <= VISIBLE_ERROR


@dataclass(frozen=True)
class Limits:
    """Results of a case and a scheme: the runs, from the smallest macro step."""

    case: str
    scheme: str
    attempts: tuple[Row, ...]  # failed: why one is not stable

    @property
    def stable(self) -> Row | None:
        """The longest macro step up to which all are stable."""
        return (None, *takewhile(lambda attempt: not attempt.failed, self.attempts))[-1]

    @property
    def right(self) -> Row | None:
        """The longest macro step up to which all are right."""
        return (None, *takewhile(right, self.attempts))[-1]

    @property
    def wrong(self) -> Row | None:
        """The shortest macro step that is not right."""
        return next((attempt for attempt in self.attempts if not right(attempt)), None)

    @property
    def silent(self) -> bool:
        """Whether the ledger had not warned in the first run that is not right."""
        return self.wrong is not None and self.wrong.ledger is Alarm.NONE


def search(attempt: Callable[[float], Row], steps: Sequence[float], first: float) -> tuple[Row, ...]:
    """Rows from the longest right step at or below `first` to the shortest above that is not stable."""
    begin = steps.index(first)
    attempts = [attempt(first)]
    for step in reversed(steps[:begin]):
        if right(attempts[0]):
            break
        attempts.insert(0, attempt(step))
    for step in steps[begin + 1 :]:
        if attempts[-1].failed:
            break
        attempts.append(attempt(step))
    return tuple(attempts)


def attempted(case: Case, scheme: str, step: float, expected: Expected) -> Row:
    """Run a case and judge it."""
    bounds = Bounds(case.journals, GROWTH_LIMIT * expected.speed, GROWTH_LIMIT * expected.distance)
    outcome, found = _run(case, scheme, step, bounds)
    read = list(zip(case.figures, found, expected.values, strict=False))
    errors = [
        abs(v - exact) / abs(exact if figure.scale is None else figure.scale) for figure, v, exact in read
    ]
    error = float(np.max(errors)) if errors else math.inf  # not a number stays it
    return Row(
        scheme,
        step,
        {"worst": error, "energy": outcome.residual},
        ledger=Alarm.NONE if outcome.warned_at is None else Alarm.WARNS,
        failed=outcome.reason,
        group=case.name,
        values={figure.title: value for figure, value, _ in read},
        remark="; ".join(f"{figure.title} {value!r} (right: {exact!r})" for figure, value, exact in read),
    )


def reference(case: Case) -> Expected:
    """The right result of a case: by theory, or by the default scheme at REFERENCE_STEP."""
    expected = case.theory
    if expected is None:
        bounds = Bounds(case.journals)
        outcome, values = _run(case, DEFAULT, REFERENCE_STEP, bounds)
        if outcome.ended is not Ended.COMPLETED:
            raise TouchdownError(f"the reference of case {case.name} stopped: {outcome.reason}")
        expected = Expected(values, bounds.fastest, bounds.farthest)
    with opened(case.scene, in_process=True) as system:
        system.initialise()
        return replace(expected, rate=fastest_contact(system)[1])


class Bounds(Observer):
    """Notes how fast and how far journals get, and ends a run where they get beyond what is given."""

    def __init__(
        self, journals: Sequence[str], speed: float = math.inf, distance: float = math.inf
    ) -> None:
        self.fastest = 0.0  # m/s
        self.farthest = 0.0  # m
        self._speed, self._distance = speed, distance
        self._directions = [(journal, axis) for journal in journals for axis in POSITION]

    def stepped(self, state: RunState) -> None:
        for journal, axis in self._directions:
            distance = abs(state.system.signal(f"{journal}.{axis}"))
            speed = abs(state.system.signal(f"{journal}.v{axis}"))
            if not (speed <= self._speed and distance <= self._distance):
                state.stop(
                    f"{journal} is {distance:.2g} m off and {speed:.2g} m/s fast at t = {state.time:.6g} s"
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
    expected: Mapping[str, Expected] = field(default_factory=dict)  # by case
    found: Mapping[tuple[str, str], Limits] = field(default_factory=dict)  # by case and scheme
    failed: Mapping[str, str] = field(default_factory=dict)  # why, by what was to be done


def _examine(task: tuple[Case, str, Expected]) -> Limits:
    """The limits of a case and a scheme."""
    case, scheme, expected = task
    attempts = search(lambda step: attempted(case, scheme, step, expected), case.steps, case.first)
    return Limits(case.name, scheme, attempts)


def compare(scene: None, options: Options, progress: Progress) -> Comparison:
    """Examine every case of the options with every scheme.

    After Ctrl-C the comparison has what is there, and is `interrupted`. Starts processes: see
    `touchdown.master.common.pool`.
    """
    cases, schemes = chosen(options.cases), options.schemes
    progress.planned(len(cases) * (1 + len(schemes)))
    right_ones = run_all(carrying(reference), cases, options.jobs, progress.done)
    outcomes: dict[str, TaskOutcome[Any]] = {c.name: one for c, one in zip(cases, right_ones, strict=True)}
    expected = {name: outcome.value for name, outcome in outcomes.items() if outcome.value is not None}
    found: dict[tuple[str, str], Limits] = {}
    if not any(outcome.ended is Ended.INTERRUPTED for outcome in right_ones):
        tasks = [(c, s, expected[c.name]) for c in cases if c.name in expected for s in schemes]
        searched = run_all(carrying(_examine), tasks, options.jobs, progress.done)
        for (case, scheme, _), outcome in zip(tasks, searched, strict=True):
            outcomes[f"{case.name} with {scheme}"] = outcome
            if outcome.value is not None:
                found[case.name, scheme] = outcome.value
    failed = {what: outcome.reason for what, outcome in outcomes.items() if outcome.value is None}
    study = Study(cases, schemes, expected, found, failed)
    return Comparison(
        "stability",
        "longest macro steps of the coupling schemes",
        report_lines(study),
        [attempt for limits in found.values() for attempt in limits.attempts],
        QUANTITIES,
        reference=study,
        tabulated=False,
        tables={"limits.csv": [_record(limits) for limits in found.values()]},
        incomplete=f"{len(failed)} searches failed, see the end of the table" if failed else "",
        interrupted=any(outcome.ended is Ended.INTERRUPTED for outcome in outcomes.values()),
    )


SILENT_MARK = "!"  # beside a macro step that is right where the ledger was silent on the next
NOT_RUN = "?"
WIDTH = 15  # of names before titles


def report_lines(study: Study) -> list[str]:
    """Tables of macro steps, of errors and of what the ledger says, cases by schemes; and the failures."""

    def by_case(text: Callable[[Limits], str]) -> dict[str, list[str]]:
        """The text of each case by scheme, where they were run."""
        found = {c.name: [study.found.get((c.name, s)) for s in study.schemes] for c in study.cases}
        return {name: [text(one) if one else NOT_RUN for one in row] for name, row in found.items()}

    def at_stable(key: str) -> list[str]:
        shown = QUANTITIES[key].shown
        return _grid(study, by_case(lambda limits: shown(limits.stable and limits.stable.errors[key])))

    swings = {
        **by_case(lambda limits: number(_swing(study, limits, limits.right), ".2g")),
        "least": [_least(study, scheme) for scheme in study.schemes],
        "advised": [f"{SCHEMES[scheme].angle_limit:g}" for scheme in study.schemes],
    }
    return [
        f"longest macro step [us] that is right (figures within {VISIBLE_ERROR:.0%}) / stable (to the end, "
        f"no journal beyond {GROWTH_LIMIT:g} times its speed or distance)",
        f"{SILENT_MARK}: the energy ledger had not warned where the next one is not right",
        *_grid(study, by_case(_longest)),
        "",
        "error of the worst figure at the longest stable macro step [%]",
        *at_stable("worst"),
        "",
        "residual of the energy ledger there, over the case's energy scale",
        *at_stable("energy"),
        *_theory(study),
        "",
        "swing of the journal on its contact in the longest right macro step [rad]; below, the least of "
        "all cases and what a comparison of steps advises",
        *_grid(study, swings),
        "",
        *(f"{case.name:<{WIDTH}}{case.title}" for case in study.cases),
        *(f"failed: {what}: {why}" for what, why in study.failed.items()),
    ]


def _grid(study: Study, rows: Mapping[str, Sequence[str]]) -> list[str]:
    """A table with a column for each scheme."""
    columns = [Column[str]((s,), lambda row, i=i: rows[row][i]) for i, s in enumerate(study.schemes)]
    return table(Column[str](("",), str), columns, list(rows))


def _longest(limits: Limits) -> str:
    """The longest right and stable macro steps (us); - where there is none."""
    right, stable = (number(a and 1e6 * (a.step or 0.0), "g") for a in (limits.right, limits.stable))
    return f"{right}/{stable}{SILENT_MARK * limits.silent}"


def _swing(study: Study, limits: Limits, attempt: Row | None) -> float | None:
    """Of the journal on its contact in a macro step (rad)."""
    return attempt and study.expected[limits.case].rate * (attempt.step or 0.0)


def _least(study: Study, scheme: str) -> str:
    """The smallest swing over the cases; below it, where not even the shortest step is right in one."""
    swings = [
        (_swing(study, limits, limits.right or limits.attempts[0]), "" if limits.right else "<")
        for limits in study.found.values()
        if limits.scheme == scheme
    ]
    swing, below = min(swings, default=(None, ""))
    return NOT_RUN if swing is None else f"{below}{swing:.2g}"


def _theory(study: Study) -> Iterator[str]:
    """Figures over what theory says, at the macro step that is common."""

    def cell(case: Case, title: str, exact: float, scheme: str) -> str:
        limits = study.found.get((case.name, scheme))
        attempt = next((a for a in limits.attempts if a.step == FIRST_STEP), None) if limits else None
        return f"{attempt.values[title] / exact:.5f}" if attempt and attempt.values else "-"

    rows = {
        f"{case.name}, {figure.title}": [cell(case, figure.title, exact, s) for s in study.schemes]
        for case in study.cases
        if case.theory is not None and case.first == FIRST_STEP
        for figure, exact in zip(case.figures, case.theory.values, strict=True)
    }
    if rows:
        yield ""
        yield f"over what theory says, macro step {1e6 * FIRST_STEP:g} us"
        yield from _grid(study, rows)


def _record(limits: Limits) -> Record:
    stable, good, wrong = limits.stable, limits.right, limits.wrong
    return {
        "case": limits.case,
        "scheme": limits.scheme,
        "largest_right_macro_step_s": good and good.step,
        "largest_stable_macro_step_s": stable and stable.step,
        "error_there_relative": stable and stable.errors["worst"],
        "energy_residual_there_relative": stable and stable.errors["energy"],
        "first_wrong_macro_step_s": wrong and wrong.step,
        "ledger_warned_at_first_wrong": None if wrong is None else int(not limits.silent),
    }
