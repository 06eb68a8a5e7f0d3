"""Many runs of a scene that differ in some settings, beside each other in processes of their own."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from touchdown.master.common.ended import Ended
from touchdown.master.common.errors import TouchdownError
from touchdown.master.common.files import writing_to
from touchdown.master.common.processes.pool import TaskOutcome, run_all
from touchdown.master.coupling.assembly import checked
from touchdown.master.coupling.simulation import open_system, opened
from touchdown.master.coupling.steppers.carried import carrying
from touchdown.master.coupling.system import System
from touchdown.master.results.folder import claimed
from touchdown.master.results.result import RECORDING
from touchdown.master.results.run import run_scene
from touchdown.master.scene.scene import Scene
from touchdown.master.studies.sweep import kept
from touchdown.master.studies.sweep.report import Member, write_table

MOST = 10_000  # members; a week of drops


@dataclass(frozen=True)
class Execution:
    """How members run, and what is kept of them."""

    in_process: bool = False  # without FMUs
    keep: bool = False  # the recording, result.h5


@dataclass(frozen=True)
class Task:
    """One run of a sweep, as it is handed to its process."""

    number: int  # from 1
    settings: Mapping[str, object]
    scene: Scene
    folder: Path
    execution: Execution
    identity: str = ""  # by which it is recognised once it is finished; "": never


def sweep(
    scene: Scene,
    variations: Mapping[str, Sequence[object]],
    folder: Path,
    jobs: int = 2,
    execution: Execution = Execution(),
    done: Callable[[], object] = lambda: None,
) -> list[Member]:
    """Run `scene` with every combination of the values that `variations` has for each setting.

    Writes summary.json of each member into 001, 002 and so on of `folder`, their recordings too where
    `execution` keeps them, and after each member sweep.csv with all figures of all that ended. Members that
    `folder` has already, finished by the same version with equal scenes, are `kept`, not run again. Runs
    `jobs` at a time; done() after each. Raises TouchdownError where a setting cannot be, or the members are
    more than MOST; a member that fails says so and the others go on. After Ctrl-C those that have not run
    are INTERRUPTED. One sweep at a time has the folder. A script that calls it needs
    `if __name__ == "__main__":`, as all do that start processes.
    """
    check(scene, variations)
    if jobs < 1:
        raise TouchdownError(f"a sweep needs at least one job, not {jobs}")
    with claimed(folder):
        return _run(_tasks(scene, variations, folder, execution), folder / "sweep.csv", jobs, done)


def _run(tasks: Sequence[Task], table: Path, jobs: int, done: Callable[[], object]) -> list[Member]:
    """A member for each task, those that are there already not run; the table is written after each."""
    with writing_to(table.parent):
        kept.settle(table.parent, {task.identity: task.folder for task in tasks})
    members = _already(tasks, done)

    def heard(member: Member) -> None:
        members[member.number] = member
        write_table([members[number] for number in sorted(members)], table)

    for member in run_tasks([task for task in tasks if task.number not in members], jobs, done, heard):
        members[member.number] = member
    ordered = [members[task.number] for task in tasks]
    write_table(ordered, table)
    return ordered


def _tasks(
    scene: Scene, variations: Mapping[str, Sequence[object]], folder: Path, execution: Execution
) -> list[Task]:
    """A task for every combination, in order."""
    combinations = itertools.product(*variations.values())
    settings = [dict(zip(variations, values, strict=True)) for values in combinations]
    width = max(3, len(str(len(settings))))
    made_of = kept.origins(scene)
    tasks: list[Task] = []
    for number, given in enumerate(settings, start=1):
        varied = scene.set(given)
        own = kept.identity(varied, made_of, execution.in_process)
        tasks.append(Task(number, given, varied, folder / f"{number:0{width}}", execution, own))
    return tasks


def _already(tasks: Sequence[Task], done: Callable[[], object]) -> dict[int, Member]:
    """Members that are there, finished, by number; done() for each."""
    members: dict[int, Member] = {}
    for task in tasks:
        summary = kept.finished(task.folder, task.identity, task.execution.keep)
        if summary is not None:
            members[task.number] = Member(task.number, task.settings, summary, kept=True)
            done()
    return members


def run_tasks(
    tasks: Sequence[Task],
    jobs: int,
    done: Callable[[], object],
    heard: Callable[[Member], object] = lambda member: None,
) -> list[Member]:
    """A member for each task, `jobs` at a time in processes of their own; those not run say why.

    heard(member) and done() after each that ended.
    """

    def tell(place: int, outcome: TaskOutcome[Member]) -> None:
        heard(_member(tasks[place], outcome))

    outcomes = run_all(carrying(_run_task), tasks, jobs, done, tell)
    return [_member(task, outcome) for task, outcome in zip(tasks, outcomes, strict=True)]


def _member(task: Task, outcome: TaskOutcome[Member]) -> Member:
    return outcome.value or Member(task.number, task.settings, {}, outcome.reason, outcome.ended)


def check(scene: Scene, variations: Mapping[str, Sequence[object]]) -> None:
    """Raise TouchdownError where nothing varies, members are too many, or a setting cannot take a value."""
    if not variations:
        raise TouchdownError("nothing varies; name at least one setting")
    for name, values in variations.items():
        if not values:
            raise TouchdownError(f"{name} has no values to vary over")
    if size(variations) > MOST:
        raise TouchdownError(
            f"a sweep of {size(variations)} members is too large, at most {MOST} are possible; vary fewer "
            "settings, or over fewer values"
        )
    first = scene.set({name: values[0] for name, values in variations.items()})
    with opened(first, in_process=True) as system:
        for name, values in variations.items():
            for value in values:
                _check_value(first, name, value, system)


def _check_value(first: Scene, name: str, value: object, system: System) -> None:
    """Raise TouchdownError where a setting cannot take a value; `system` is that of the `first` member."""
    varied = first.set({name: value})
    component, _, variable = name.partition(".")
    if name == "run.scheme" or variable in ("preset", "every"):  # these change what is connected, or more
        open_system(varied, in_process=True).close()
    elif component in system.components:
        checked(system.components[component], variable, value)


def _run_task(task: Task) -> Member:
    """Run a member; whether it completed or not, it has a summary."""
    result = run_scene(task.scene, task.folder, in_process=task.execution.in_process, pictures=False)
    if not task.execution.keep:
        (task.folder / RECORDING).unlink(missing_ok=True)
    if task.identity and result.ended is Ended.COMPLETED:
        with writing_to(task.folder):
            kept.finish(task.folder, task.identity)
    return Member(task.number, task.settings, result.summary, result.stopped_because, result.ended)


def size(variations: Mapping[str, Sequence[object]]) -> int:
    """Number of members."""
    return math.prod(len(values) for values in variations.values())
