"""Tasks beside each other in processes of their own, that Ctrl-C ends in order."""

from __future__ import annotations

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
from typing import Any, Generic, TypeVar

from touchdown.master.common.errors import TouchdownError

GRACE = 2.0  # s that runs have to end by themselves after Ctrl-C
INTERRUPTED = "interrupted"

Task = TypeVar("Task")
Value = TypeVar("Value")


@dataclass(frozen=True)
class Ended(Generic[Value]):
    """How a task ended: what it gave, or why it failed."""

    value: Value | None
    failed: str = ""


def run_all(
    work: Callable[[Task], Value], tasks: Sequence[Task], jobs: int, done: Callable[[], object]
) -> list[Ended[Value]]:
    """How each task ended, `jobs` at a time in processes that import `work`; done() after each.

    A task that raises has failed, and one whose process dies; the others go on. After Ctrl-C those that
    have not ended are "interrupted". A script that calls it needs `if __name__ == "__main__":`.
    """
    ended: dict[int, Ended[Value]] = {}
    jobs = max(1, min(jobs, len(tasks)))
    try:
        _run_pool(work, dict(enumerate(tasks)), jobs, ended, done)
        for place, task in enumerate(tasks):
            if place not in ended:  # a process that dies takes its pool along: which one shows alone
                _run_pool(work, {place: task}, 1, ended, done)
                if place not in ended:
                    ended[place] = Ended(None, "its process died")
                    done()
    except KeyboardInterrupt:
        pass
    return [ended.get(place, Ended(None, INTERRUPTED)) for place in range(len(tasks))]


def _run_pool(
    work: Callable[[Any], Value],
    tasks: Mapping[int, Any],
    jobs: int,
    ended: dict[int, Ended[Value]],
    done: Callable[[], object],
) -> None:
    """Run tasks and note how they ended; those of a pool that broke are left out."""
    others = set(multiprocessing.active_children())
    pool = ProcessPoolExecutor(jobs, multiprocessing.get_context("spawn"))
    waiting = list(tasks)
    running: dict[Future[Value], int] = {}
    try:
        while waiting or running:
            while waiting and len(running) < jobs:  # a queue in the pool would go on after Ctrl-C
                place = waiting.pop(0)
                with _interrupts_ignored():
                    running[pool.submit(work, tasks[place])] = place
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


def _outcome(future: Future[Value]) -> Ended[Value]:
    """What a task's process handed back; raises BrokenProcessPool where it died."""
    try:
        return Ended(future.result())
    except BrokenProcessPool:
        raise
    except Exception as error:
        what = str(error) if isinstance(error, TouchdownError) else f"{type(error).__name__}: {error}"
        return Ended(None, what)


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
