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
from functools import partial
from itertools import takewhile

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
from ..findings import Column, Record, table
from .engine import Alarm, Comparison, Options, Quantity, Row
from .stability_cases import FIRST_STEP, Case, Expected, chosen

REFERENCE_STEP = 5e-7  # s
GROWTH_LIMIT = 1.5  # of a journal's speed or distance; of the energy, its square
VISIBLE_ERROR = 0.05
QUANTITIES = {
    "worst": Quantity(("worst figure", "[%]"), 100.0, ".3g", "error_relative"),
    "energy": Quantity(("ledger", "[1]"), 1.0, ".0e", "energy_residual_relative"),
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
        return _last_before(self.attempts, lambda attempt: not attempt.failed)

    @property
    def right(self) -> Row | None:
        """The longest macro step up to which all are right."""
        return _last_before(self.attempts, right)

    @property
    def wrong(self) -> Row | None:
        """The shortest macro step that is not right."""
        return next((attempt for attempt in self.attempts if not right(attempt)), None)

    @property
    def silent(self) -> bool:
        """Whether the ledger had not warned in the first run that is not right."""
        return self.wrong is not None and self.wrong.ledger is Alarm.NONE


def _last_before(attempts: Sequence[Row], good: Callable[[Row], bool]) -> Row | None:
    return next(iter([*takewhile(good, attempts)][-1:]), None)


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
    errors, values, remarks = [], {}, []
    for figure, value, exact in zip(case.figures, found, expected.values, strict=False):
        errors.append(abs(value - exact) / abs(exact if figure.scale is None else figure.scale))
        values[figure.title] = value
        remarks.append(f"{figure.title} {value!r} (right: {exact!r})")
    error = float(np.max(errors)) if errors else math.inf  # not a number stays it
    return Row(
        scheme,
        step,
        {"worst": error, "energy": outcome.residual},
        ledger=Alarm.NONE if outcome.warned_at is None else Alarm.WARNS,
        failed=outcome.reason,
        group=case.name,
        values=values,
        remark="; ".join(remarks),
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
    expected: Mapping[str, Expected] = field(default_factory=dict)  # by case
    found: Mapping[tuple[str, str], Limits] = field(default_factory=dict)  # by case and scheme
    failed: Mapping[str, str] = field(default_factory=dict)  # why, by what was to be done


Task = tuple[Case, str, Expected]  # a case and a scheme, as they are handed to a process


def _examine(task: Task) -> Limits:
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
    by_case = dict(
        zip(
            (c.name for c in cases),
            run_all(carrying(reference), cases, options.jobs, progress.done),
            strict=True,
        )
    )
    expected = {name: outcome.value for name, outcome in by_case.items() if outcome.value is not None}
    outcomes: dict[str, TaskOutcome[Expected] | TaskOutcome[Limits]] = dict(by_case)
    found: dict[tuple[str, str], Limits] = {}
    if not any(outcome.ended is Ended.INTERRUPTED for outcome in by_case.values()):
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

    def by_case(text: Callable[[Limits], str]) -> dict[str, Callable[[str], str]]:
        """The text of each case by scheme, where they were run."""

        def cell(case: str, scheme: str) -> str:
            limits = study.found.get((case, scheme))
            return NOT_RUN if limits is None else text(limits)

        return {case.name: partial(cell, case.name) for case in study.cases}

    def by_scheme(rows: Mapping[str, Callable[[str], str]]) -> list[str]:
        columns = [Column[str]((s,), lambda row, s=s: rows[row](s)) for s in study.schemes]
        return table(Column[str](("",), str), columns, list(rows))

    def at_stable(key: str) -> dict[str, Callable[[str], str]]:
        shown = QUANTITIES[key].shown
        return by_case(lambda limits: "-" if limits.stable is None else shown(limits.stable.errors[key]))

    rows = {
        **by_case(lambda limits: _swing(limits, study.expected[limits.case])),
        "least": partial(_least, study),
        "advised": lambda scheme: f"{SCHEMES[scheme].angle_limit:g}",
    }
    return [
        f"longest macro step [us] that is right (figures within {VISIBLE_ERROR:.0%}) / stable (to the end, "
        f"no journal beyond {GROWTH_LIMIT:g} times its speed or distance)",
        f"{SILENT_MARK}: the energy ledger had not warned where the next one is not right",
        *by_scheme(
            by_case(
                lambda limits: (
                    f"{microseconds(limits.right)}/{microseconds(limits.stable)}"
                    f"{SILENT_MARK * limits.silent}"
                )
            )
        ),
        "",
        "error of the worst figure at the longest stable macro step [%]",
        *by_scheme(at_stable("worst")),
        "",
        "residual of the energy ledger there, over the case's energy scale",
        *by_scheme(at_stable("energy")),
        *_theory(study, by_scheme),
        "",
        "swing of the journal on its contact in the longest right macro step [rad]; below, the least of "
        "all cases and what a comparison of steps advises",
        *by_scheme(rows),
        "",
        *(f"{case.name:<{WIDTH}}{case.title}" for case in study.cases),
        *(f"failed: {what}: {why}" for what, why in study.failed.items()),
    ]


def microseconds(attempt: Row | None) -> str:
    """A macro step; - where there is none."""
    return "-" if attempt is None or attempt.step is None else f"{1e6 * attempt.step:g}"


def _swing(limits: Limits, expected: Expected) -> str:
    return "-" if limits.right is None else f"{expected.rate * (limits.right.step or 0.0):.2g}"


def _least(study: Study, scheme: str) -> str:
    """The smallest swing over the cases; below it, where not even the shortest step is right in one."""
    swings: list[tuple[float, str]] = []
    for limits in study.found.values():
        if limits.scheme == scheme:
            step = (limits.right or limits.attempts[0]).step or 0.0
            swings.append((study.expected[limits.case].rate * step, "" if limits.right else "<"))
    if not swings:
        return NOT_RUN
    swing, below = min(swings)
    return f"{below}{swing:.2g}"


def _theory(
    study: Study, by_scheme: Callable[[Mapping[str, Callable[[str], str]]], list[str]]
) -> Iterator[str]:
    """Figures over what theory says, at the macro step that is common."""

    def cell(case: Case, title: str, exact: float, scheme: str) -> str:
        limits = study.found.get((case.name, scheme))
        at = next((a for a in limits.attempts if a.step == FIRST_STEP), None) if limits else None
        return f"{at.values[title] / exact:.5f}" if at and at.values else "-"

    rows = {
        f"{case.name}, {figure.title}": partial(cell, case, figure.title, exact)
        for case in study.cases
        if case.theory is not None and case.first == FIRST_STEP
        for figure, exact in zip(case.figures, case.theory.values, strict=True)
    }
    if rows:
        yield ""
        yield f"over what theory says, macro step {1e6 * FIRST_STEP:g} us"
        yield from by_scheme(rows)


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
