"""Tasks beside each other in processes of their own, that Ctrl-C ends in order."""

from __future__ import annotations

import multiprocessing
import os
import signal
import sys
import time
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass
from multiprocessing.process import BaseProcess
from typing import Any, Generic, TypeVar

from touchdown.master.common.ended import Ended
from touchdown.master.common.errors import TouchdownError
from touchdown.master.common.interrupts import interrupts_ignored
from touchdown.master.common.processes.orphans import die_with_parent

GRACE = 2.0  # s that runs have to end by themselves after Ctrl-C

Task = TypeVar("Task")
Value = TypeVar("Value")


@dataclass(frozen=True)
class TaskOutcome(Generic[Value]):
    """How a task ended: what it gave, or why it gave nothing."""

    value: Value | None
    ended: Ended = Ended.COMPLETED
    reason: str = ""  # why, where it did not complete


INTERRUPTED = TaskOutcome[Any](None, Ended.INTERRUPTED, Ended.INTERRUPTED.value)


def _unheard(place: int, outcome: TaskOutcome[Any]) -> None:
    pass


def run_all(
    work: Callable[[Task], Value],
    tasks: Sequence[Task],
    jobs: int,
    done: Callable[[], object],
    heard: Callable[[int, TaskOutcome[Value]], object] = _unheard,
) -> list[TaskOutcome[Value]]:
    """How each task ended, `jobs` at a time in processes that import `work`.

    After each that ended, heard(place of the task, how) and done(). A task that raises has failed, and one
    whose process dies; the others go on. After Ctrl-C those that have not ended are INTERRUPTED. The
    processes end with this one, however it ends. A script that calls it needs
    `if __name__ == "__main__":`.
    """
    _refuse_importing_script()
    ended: dict[int, TaskOutcome[Value]] = {}

    def note(place: int, outcome: TaskOutcome[Value]) -> None:
        ended[place] = outcome
        heard(place, outcome)
        done()

    left = dict(enumerate(tasks))
    try:
        while left:
            for place in _run_pool(work, left, jobs, note):  # which one it was shows alone
                if _run_pool(work, {place: left[place]}, 1, note):
                    note(place, TaskOutcome(None, Ended.STOPPED, "its process died"))
            left = {place: task for place, task in left.items() if place not in ended}
    except KeyboardInterrupt:
        pass
    return [ended.get(place, INTERRUPTED) for place in range(len(tasks))]


def _refuse_importing_script() -> None:
    """End this process with one line where it only imports the script that starts processes.

    A process that is started imports the caller's script; one without the guard would start processes
    again, which Python refuses with a page of traceback for each.
    """
    if getattr(multiprocessing.current_process(), "_inheriting", False):
        sys.exit(
            "touchdown: processes that run beside each other import the script that starts them; put what "
            'it does under if __name__ == "__main__":'
        )


def _run_pool(
    work: Callable[[Any], Value],
    tasks: Mapping[int, Any],
    jobs: int,
    note: Callable[[int, TaskOutcome[Value]], object],
) -> list[int]:
    """Run tasks and note how they ended.

    A process that dies takes its pool along: returned are those that were under way then, else nothing.
    """
    others = set(multiprocessing.active_children())
    context, jobs = multiprocessing.get_context("spawn"), max(1, min(jobs, len(tasks)))
    pool = ProcessPoolExecutor(jobs, context, die_with_parent, (os.getpid(),))
    waiting = list(tasks)
    running: dict[Future[Value], int] = {}
    begun: set[int] = set()  # and not ended
    try:
        while waiting or running:
            while waiting and len(running) < jobs:  # a queue in the pool would go on after Ctrl-C
                place = waiting.pop(0)
                begun.add(place)
                with interrupts_ignored():
                    running[pool.submit(work, tasks[place])] = place
            for future in wait(running, return_when=FIRST_COMPLETED).done:
                outcome = _outcome(future)
                place = running.pop(future)
                begun.remove(place)
                note(place, outcome)
    except BrokenProcessPool:
        pass
    except BaseException:
        pool.shutdown(wait=False, cancel_futures=True)
        _end([child for child in multiprocessing.active_children() if child not in others])
        raise
    pool.shutdown()
    return sorted(begun)


def _outcome(future: Future[Value]) -> TaskOutcome[Value]:
    """What a task's process handed back; raises BrokenProcessPool where it died."""
    try:
        return TaskOutcome(future.result())
    except BrokenProcessPool:
        raise
    except KeyboardInterrupt:  # the task's own: its run was interrupted
        return INTERRUPTED
    except Exception as error:
        what = str(error) if isinstance(error, TouchdownError) else f"{type(error).__name__}: {error}"
        return TaskOutcome(None, Ended.STOPPED, what)


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
            process.kill()  # a run would only note SIGTERM


def _join(processes: Sequence[BaseProcess]) -> None:
    deadline = time.monotonic() + GRACE
    for process in processes:
        process.join(max(0.0, deadline - time.monotonic()))
