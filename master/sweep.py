"""Many runs of a scene that differ in some settings, beside each other in processes of their own."""

from __future__ import annotations

import itertools
import math
import multiprocessing
import os
import signal
import threading
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from dataclasses import dataclass
from multiprocessing.process import BaseProcess
from pathlib import Path

from master.errors import TouchdownError
from master.run import make_writable, run_scene
from master.scene import Scene
from master.simulation import open_system
from master.sweep_report import Member, write_csv

GRACE = 2.0  # s that runs have to end by themselves after Ctrl-C
INTERRUPTED = "interrupted"


@dataclass(frozen=True)
class Task:
    """One run of a sweep, as it is handed to its process."""

    scene: Scene
    folder: Path
    in_process: bool
    keep: bool


Ended = tuple[dict[str, object], str]  # summary, and why the run failed or ""


def sweep(
    scene: Scene,
    variations: Mapping[str, Sequence[object]],
    folder: Path,
    jobs: int = 2,
    in_process: bool = False,
    keep: bool = False,
    done: Callable[[], object] = lambda: None,
) -> list[Member]:
    """Run `scene` with every combination of the values that `variations` has for each setting.

    Writes `folder`/sweep.csv with all figures of all members, and summary.json of each into 001, 002 and
    so on; their recordings too if `keep`. Runs `jobs` at a time; done() after each. Raises TouchdownError
    where a setting cannot be; a member that fails says so and the others go on. After Ctrl-C those that
    have not run are "interrupted". A script that calls it needs `if __name__ == "__main__":`, as all do
    that start processes.
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
        Task(scene.with_settings(given), folder / f"{number:0{width}}", in_process, keep)
        for number, given in enumerate(settings, start=1)
    ]
    ended = _run_all(tasks, min(jobs, len(tasks)), done)
    members = [
        Member(number, given, *ended.get(number - 1, ({}, INTERRUPTED)))
        for number, given in enumerate(settings, start=1)
    ]
    write_csv(members, folder / "sweep.csv")
    return members


def check(scene: Scene, variations: Mapping[str, Sequence[object]]) -> None:
    """Raise TouchdownError where nothing varies, or a setting does not exist or cannot take a value."""
    if not variations:
        raise TouchdownError("nothing varies; name at least one setting")
    for name, values in variations.items():
        if not values:
            raise TouchdownError(f"{name} has no values to vary over")
    first = scene.with_settings({name: values[0] for name, values in variations.items()})
    for name, values in variations.items():
        for value in values:
            open_system(first.with_setting(name, value), in_process=True).close()


def _run_all(tasks: Sequence[Task], jobs: int, done: Callable[[], object]) -> dict[int, Ended]:
    """How each task ended, by its place; Ctrl-C leaves the rest out."""
    ended: dict[int, Ended] = {}
    try:
        _run_pool(dict(enumerate(tasks)), jobs, ended, done)
        for place, task in enumerate(tasks):
            if place not in ended:  # a process that dies takes its pool along: which one shows alone
                _run_pool({place: task}, 1, ended, done)
                if place not in ended:
                    ended[place] = ({}, "its process died")
                    done()
    except KeyboardInterrupt:
        pass
    return ended


def _run_pool(
    tasks: Mapping[int, Task], jobs: int, ended: dict[int, Ended], done: Callable[[], object]
) -> None:
    """Run tasks and note how they ended; those of a pool that broke are left out."""
    others = set(multiprocessing.active_children())
    pool = ProcessPoolExecutor(jobs, multiprocessing.get_context("spawn"))
    waiting = list(tasks)
    running: dict[Future[Ended], int] = {}
    try:
        while waiting or running:
            while waiting and len(running) < jobs:  # a queue in the pool would go on after Ctrl-C
                place = waiting.pop(0)
                with _interrupts_ignored():
                    running[pool.submit(_run_task, tasks[place])] = place
            for future in wait(running, return_when=FIRST_COMPLETED).done:
                ended[running.pop(future)] = _outcome(future)
                done()
    except BrokenProcessPool:
        pass
    except BaseException:
        pool.shutdown(wait=False, cancel_futures=True)
        _end([child for child in multiprocessing.active_children() if child not in others])
        raise
    pool.shutdown()


def _outcome(future: Future[Ended]) -> Ended:
    """What a run's process handed back; raises BrokenProcessPool where it died."""
    try:
        return future.result()
    except BrokenProcessPool:
        raise
    except Exception as error:
        return {}, str(error) if isinstance(error, TouchdownError) else f"{type(error).__name__}: {error}"


def _run_task(task: Task) -> Ended:
    result = run_scene(task.scene, task.folder, in_process=task.in_process, pictures=False)
    if not task.keep:
        (task.folder / "result.h5").unlink(missing_ok=True)
    return result.summary, result.stopped_because


@contextmanager
def _interrupts_ignored() -> Iterator[None]:
    """Processes started meanwhile ignore Ctrl-C, but for their runs, which note it and end in order."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)


def _end(processes: Sequence[BaseProcess]) -> None:
    """End processes in order if they let: a Ctrl-C at a terminal has reached them too, others have not.

    A run that got it twice would break off, so those still there after GRACE are sent theirs.
    """
    try:
        _join(processes)
        for process in processes:
            if process.is_alive() and process.pid is not None:
                os.kill(process.pid, signal.SIGINT)
        _join(processes)
    finally:
        for process in processes:
            process.terminate()


def _join(processes: Sequence[BaseProcess]) -> None:
    deadline = time.monotonic() + GRACE
    for process in processes:
        process.join(max(0.0, deadline - time.monotonic()))


def size(variations: Mapping[str, Sequence[object]]) -> int:
    """Number of members."""
    return math.prod(len(values) for values in variations.values())
