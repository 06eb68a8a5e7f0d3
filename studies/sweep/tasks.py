"""Runs beside each other in processes of their own: how they run, and what comes of them."""

from __future__ import annotations

import multiprocessing
import signal
import threading
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from ...master.common.errors import Ended, TouchdownError
from ...master.common.pool import TaskOutcome, one_thread, run_all
from ...master.coupling.steppers.carried import carrying
from ...master.results.result import RECORDING
from ...master.results.run import make_ready, run_scene
from ...master.scene.scene import Scene
from ...modelkit.errors import require
from ...modelkit.kernel.writing import discard, remove_file
from .members import Member


@dataclass(frozen=True)
class Running:
    """How the runs of a study run. Raises TouchdownError for less than one job."""

    jobs: int = 2  # at a time, on this machine
    cluster: str = ""  # address of a Dask scheduler whose workers run them instead
    in_process: bool = False  # without FMUs
    keep: bool = False  # all that each run leaves, in a folder of its own
    anew: bool = False  # a sweep that the folder holds is thrown away
    earlier: Path | None = None  # folder of a run at whose end all of them start

    def __post_init__(self) -> None:
        require(self.jobs >= 1, f"a study needs at least one job, not {self.jobs}")


TWO_JOBS = Running()
HANG_S = 60.0  # s that starting, and ending after the limit, may take


@dataclass(frozen=True)
class Task:
    """A run, as handed to its process."""

    number: int  # from 1
    settings: dict[str, object]
    scene: Scene
    folder: Path | None  # None: a temporary one
    in_process: bool = False  # without FMUs
    keep: bool = False  # the recording, result.h5, in `folder`
    passing: bool = False  # nothing is kept: its folder goes
    earlier: Path | None = None  # folder of the run at whose end it starts


def run_tasks(
    tasks: Sequence[Task],
    running: Running,
    done: Callable[[], object],
    ended: Callable[[Member], object] = lambda member: None,
) -> list[Member]:
    """A member for each task; ended(member) as each ends, done() after it.

    After Ctrl-C those that have not run are INTERRUPTED, and `ended` gets them last.
    """

    def on_outcome(place: int, outcome: TaskOutcome[Member]) -> None:
        ended(_member(tasks[place], outcome))

    if tasks and not running.cluster:  # what their processes would each compile
        make_ready([task.scene for task in tasks], tasks[0].in_process)
    outcomes = run_all(carrying(_run_task), tasks, running.jobs, done, on_outcome, running.cluster)
    for place, outcome in enumerate(outcomes):
        if outcome.ended is Ended.INTERRUPTED:
            on_outcome(place, outcome)
    return [_member(task, outcome) for task, outcome in zip(tasks, outcomes, strict=True)]


def run_here(tasks: Sequence[Task], done: Callable[[], object]) -> list[Member]:
    """The same one after the other in this process, up to one that is interrupted."""
    members: list[Member] = []
    for task in tasks:
        try:
            with one_thread():
                members.append(_run_task(task))
        except TouchdownError as error:
            members.append(Member(task.number, task.settings, {}, str(error), Ended.STOPPED))
        if members[-1].ended is Ended.INTERRUPTED:
            break
        done()
    return members


def _member(task: Task, outcome: TaskOutcome[Member]) -> Member:
    reason, limit = outcome.reason, task.scene.run.time_limit
    if limit and "SIGALRM" in reason:
        reason = f"it took {HANG_S:g} s more than run.time_limit = {limit:g} s and was killed"
    return outcome.value or Member(task.number, task.settings, {}, reason, outcome.ended)


def _run_task(task: Task) -> Member:
    """Run a member; whether it completed or not, it has a summary.

    One that exceeds its scene's run.time_limit and does not even end in order is killed, where it has a
    process of its own.
    """
    begun = time.perf_counter()
    folder, limit = task.folder, task.scene.run.time_limit
    alone = multiprocessing.parent_process() and threading.current_thread() is threading.main_thread()
    alone = alone and hasattr(signal, "setitimer")  # Windows has none
    if limit and alone:
        signal.setitimer(signal.ITIMER_REAL, limit + HANG_S)
    try:
        result = run_scene(task.scene, folder, task.in_process, continue_from=task.earlier)
        result.recording.close()
    finally:
        if limit and alone:
            signal.setitimer(signal.ITIMER_REAL, 0.0)
        if folder is not None and task.passing:
            discard(folder)
    if folder is not None and not task.keep:
        remove_file(folder / RECORDING)
    seconds = time.perf_counter() - begun
    return Member(
        task.number,
        task.settings,
        result.summary,
        result.stopped_because,
        result.ended,
        seconds=seconds,
        warnings=tuple(result.warnings),
    )
