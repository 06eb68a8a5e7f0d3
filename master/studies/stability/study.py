"""All hard cases with all coupling schemes, beside each other in processes."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

from touchdown.master.common.ended import Ended
from touchdown.master.common.processes.pool import TaskOutcome, run_all
from touchdown.master.coupling.steppers.carried import carrying
from touchdown.master.studies.stability.report import Study, write_tables
from touchdown.master.studies.stability.trials import Case, Finding, Right, examine, reference

Key = TypeVar("Key")
Value = TypeVar("Value")


@dataclass(frozen=True)
class Task:
    """A case and a scheme, as they are handed to a process."""

    case: Case
    scheme: str
    right: Right


def study_stability(
    cases: Sequence[Case],
    schemes: Sequence[str],
    folder: Path,
    jobs: int = 2,
    done: Callable[[], object] = lambda: None,
) -> Study:
    """Examine every case with every scheme, and write tables and picture into `folder`.

    done() after each reference and each finding. After Ctrl-C what is there is written, and the rest is
    INTERRUPTED. Starts processes: see `touchdown.master.common.processes.pool`.
    """
    rights, failed = _parted([case.name for case in cases], run_all(carrying(reference), cases, jobs, done))
    tasks: list[Task] = []
    if not _interrupted(failed):
        begun = [case for case in cases if case.name in rights]
        tasks = [Task(case, scheme, rights[case.name]) for case in begun for scheme in schemes]
    pairs = [(task.case.name, task.scheme) for task in tasks]
    findings, lost = _parted(pairs, run_all(carrying(_examine), tasks, jobs, done))
    failed |= {f"{case} with {scheme}": outcome for (case, scheme), outcome in lost.items()}
    why = {what: outcome.reason for what, outcome in failed.items()}
    study = Study(cases, schemes, rights, findings, why, _interrupted(failed))
    write_tables(study, folder)
    if findings:
        from touchdown.master.studies.stability.figure import draw_chart  # matplotlib is slow to import

        draw_chart(study, folder / "stability.png")
    return study


def _parted(
    keys: Iterable[Key], outcomes: Iterable[TaskOutcome[Value]]
) -> tuple[dict[Key, Value], dict[Key, TaskOutcome[Value]]]:
    """What the tasks gave, and how those ended that gave nothing."""
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
    return examine(task.case, task.scheme, task.right)
