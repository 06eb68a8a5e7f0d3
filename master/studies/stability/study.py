"""All hard cases with all coupling schemes, beside each other in processes."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from touchdown.master.common.ended import Ended
from touchdown.master.common.processes import TaskOutcome, run_all
from touchdown.master.studies.stability.report import Study, write_csv
from touchdown.master.studies.stability.trials import Case, Finding, Right, examine, reference


@dataclass(frozen=True)
class Task:
    """A case and a scheme, as they are handed to a process."""

    case: Case
    scheme: str
    right: Right


def study(
    cases: Sequence[Case],
    schemes: Sequence[str],
    folder: Path,
    jobs: int = 2,
    done: Callable[[], object] = lambda: None,
) -> Study:
    """Examine every case with every scheme, and write tables and picture into `folder`.

    done() after each reference and each finding. After Ctrl-C what is there is written, and the rest is
    INTERRUPTED. Starts processes: see `touchdown.master.common.processes`.
    """
    failed: dict[str, TaskOutcome[Any]] = {}
    rights: dict[str, Right] = {}
    for case, outcome in zip(cases, run_all(reference, cases, jobs, done), strict=True):
        if outcome.value is None:
            failed[case.name] = outcome
        else:
            rights[case.name] = outcome.value
    tasks: list[Task] = []
    if not _interrupted(failed.values()):
        tasks = [
            Task(case, scheme, rights[case.name])
            for case in cases
            if case.name in rights
            for scheme in schemes
        ]
    findings: dict[tuple[str, str], Finding] = {}
    for task, outcome in zip(tasks, run_all(_examine, tasks, jobs, done), strict=True):
        if outcome.value is None:
            failed[f"{task.case.name} with {task.scheme}"] = outcome
        else:
            findings[task.case.name, task.scheme] = outcome.value
    why = {what: outcome.reason for what, outcome in failed.items()}
    found = Study(cases, schemes, rights, findings, why, _interrupted(failed.values()))
    write_csv(found, folder)
    if findings:
        from touchdown.master.studies.stability.figure import draw  # matplotlib is slow to import

        draw(found, folder / "stability.png")
    return found


def _interrupted(failed: Iterable[TaskOutcome[Any]]) -> bool:
    return any(outcome.ended is Ended.INTERRUPTED for outcome in failed)


def size(cases: Sequence[Case], schemes: Sequence[str]) -> int:
    """How often a study calls `done`."""
    return len(cases) * (1 + len(schemes))


def _examine(task: Task) -> Finding:
    return examine(task.case, task.scheme, task.right)
