"""Many runs of a scene that differ in some settings, beside each other in processes of their own."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from touchdown.master.common.errors import TouchdownError
from touchdown.master.common.processes import run_all
from touchdown.master.coupling.simulation import open_system
from touchdown.master.coupling.steppers.carried import carrying
from touchdown.master.results.run import make_writable, run_scene
from touchdown.master.scene.scene import Scene
from touchdown.master.studies.sweep.report import Member, write_table


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


def sweep(
    scene: Scene,
    variations: Mapping[str, Sequence[object]],
    folder: Path,
    jobs: int = 2,
    execution: Execution = Execution(),
    done: Callable[[], object] = lambda: None,
) -> list[Member]:
    """Run `scene` with every combination of the values that `variations` has for each setting.

    Writes `folder`/sweep.csv with all figures of all members, and summary.json of each into 001, 002 and
    so on; their recordings too where `execution` keeps them. Runs `jobs` at a time; done() after each.
    Raises TouchdownError where a setting cannot be; a member that fails says so and the others go on.
    After Ctrl-C those that have not run are INTERRUPTED. A script that calls it needs
    `if __name__ == "__main__":`, as all do that start processes.
    """
    check(scene, variations)
    if jobs < 1:
        raise TouchdownError(f"a sweep needs at least one job, not {jobs}")
    make_writable(folder)
    settings = [
        dict(zip(variations, values, strict=True)) for values in itertools.product(*variations.values())
    ]
    width = max(3, len(str(len(settings))))
    tasks = [
        Task(number, given, scene.set(given), folder / f"{number:0{width}}", execution)
        for number, given in enumerate(settings, start=1)
    ]
    members = run_tasks(tasks, jobs, done)
    write_table(members, folder / "sweep.csv")
    return members


def run_tasks(tasks: Sequence[Task], jobs: int, done: Callable[[], object]) -> list[Member]:
    """A member for each task, `jobs` at a time in processes of their own; those not run say why."""
    return [
        outcome.value or Member(task.number, task.settings, {}, outcome.reason, outcome.ended)
        for task, outcome in zip(tasks, run_all(carrying(_run_task), tasks, jobs, done), strict=True)
    ]


def check(scene: Scene, variations: Mapping[str, Sequence[object]]) -> None:
    """Raise TouchdownError where nothing varies, or a setting does not exist or cannot take a value."""
    if not variations:
        raise TouchdownError("nothing varies; name at least one setting")
    for name, values in variations.items():
        if not values:
            raise TouchdownError(f"{name} has no values to vary over")
    first = scene.set({name: values[0] for name, values in variations.items()})
    for name, values in variations.items():
        for value in values:
            open_system(first.set({name: value}), in_process=True).close()


def _run_task(task: Task) -> Member:
    """Run a member; whether it completed or not, it has a summary."""
    result = run_scene(task.scene, task.folder, in_process=task.execution.in_process, pictures=False)
    if not task.execution.keep:
        (task.folder / "result.h5").unlink(missing_ok=True)
    return Member(task.number, task.settings, result.summary, result.stopped_because, result.ended)


def size(variations: Mapping[str, Sequence[object]]) -> int:
    """Number of members."""
    return math.prod(len(values) for values in variations.values())
