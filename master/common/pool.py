"""Tasks side by side in processes of their own, ended in order by Ctrl-C."""

from __future__ import annotations

import multiprocessing
import os
import signal
import sys
import time
from collections import Counter, deque
from collections.abc import Callable, Generator, Iterable, Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from multiprocessing import connection
from multiprocessing.process import BaseProcess
from pathlib import Path
from typing import Any, Generic, TypeVar

from .errors import Ended, TouchdownError
from .interrupts import interrupts_ignored
from .watched import die_with_parent, way_of

LIMIT = "OMP_NUM_THREADS"  # an environment variable; parallel libraries keep to it, too
QUOTA = Path("/sys/fs/cgroup/cpu.max")  # of processor time, in a container


def cores() -> int:
    """How many there are: those it is bound to, or all where the system does not say."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def threads() -> int:
    """How many threads a run may have."""
    given = os.environ.get(LIMIT, "").partition(",")[0]
    if given.strip().isdecimal() and int(given) > 0:
        return int(given)
    found = cores()
    with suppress(OSError, ValueError):
        quota, period = map(float, QUOTA.read_text().split())
        found = min(found, int(quota / period))
    return max(found, 1)


GRACE_S = 2.0  # s that runs have to end by themselves after Ctrl-C
MAX_TRIES = 2  # of a task whose process is killed: it may be to blame, or the machine
THREAD_LIMITS = (LIMIT, "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
"""Of linear algebra and of runs: one each, since processes share the cores, and sums have one order."""

Task = TypeVar("Task")
Value = TypeVar("Value")


@dataclass(frozen=True)
class TaskOutcome(Generic[Value]):
    """How a task ended: what it gave, or why it gave nothing."""

    value: Value | None
    ended: Ended = Ended.COMPLETED
    reason: str = ""  # why, where it did not complete


INTERRUPTED = TaskOutcome[Any](None, Ended.INTERRUPTED, Ended.INTERRUPTED.value)


def _ignore(place: int, outcome: TaskOutcome[Any]) -> None:
    pass


def run_all(
    work: Callable[[Task], Value],
    tasks: Sequence[Task],
    jobs: int,
    done: Callable[[], object],
    on_outcome: Callable[[int, TaskOutcome[Value]], object] = _ignore,
) -> list[TaskOutcome[Value]]:
    """How each task ended, `jobs` at a time in processes that import `work`.

    After each that ended, on_outcome(place of the task, how) and done(). A task that raises has STOPPED.
    One whose process is killed is tried once more and then has DIED; the others do not notice. After Ctrl-C
    those that have not ended are INTERRUPTED. The processes end with this one, however it ends. A script
    that calls it needs `if __name__ == "__main__":`.
    """
    _refuse_importing_script()
    crew = _Crew(work, tasks, max(1, min(jobs, len(tasks))))
    try:
        return collected(crew.outcomes(), len(tasks), done, on_outcome)
    finally:
        crew.dismiss()


def collected(
    outcomes: Iterable[tuple[int, TaskOutcome[Value]]],
    count: int,
    done: Callable[[], object],
    on_outcome: Callable[[int, TaskOutcome[Value]], object],
) -> list[TaskOutcome[Value]]:
    """`outcomes` of `count` tasks, with their places, in the tasks' order; each is told as it comes.

    After Ctrl-C those that were not told are INTERRUPTED.
    """
    ended: dict[int, TaskOutcome[Value]] = {}
    try:
        for place, outcome in outcomes:
            on_outcome(place, outcome)
            ended[place] = outcome  # behind it: where Ctrl-C kept it from on_outcome, it is INTERRUPTED
            done()
    except KeyboardInterrupt:
        pass
    return [ended.get(place, INTERRUPTED) for place in range(count)]


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


# -- in the processes --------------------------------------------------------------------------------


def tried(work: Callable[[Any], Value], task: Any) -> TaskOutcome[Value]:
    """The value of `work` for a task, or the reason why there is none."""
    try:
        return TaskOutcome(work(task))
    except KeyboardInterrupt:  # the task's own: its run was interrupted
        return INTERRUPTED
    except (Exception, SystemExit) as error:
        return _stopped(error)


def _stopped(error: BaseException) -> TaskOutcome[Any]:
    what = str(error) if isinstance(error, TouchdownError) else f"{type(error).__name__}: {error}"
    return TaskOutcome(None, Ended.STOPPED, what)


def _serve(work: Callable[[Any], Any], pipe: connection.Connection, parent: int) -> None:
    """Do tasks as they come through the pipe, until it is closed."""
    die_with_parent(parent)
    with suppress(EOFError, OSError):  # the other end is closed: nobody wants more
        pipe.send(None)  # this process has begun
        while True:
            try:
                outcome = tried(work, pipe.recv())
            except EOFError:
                raise
            except Exception as error:  # a task that cannot be read here
                outcome = _stopped(error)
            pipe.send(outcome)


# -- in the process that starts them -----------------------------------------------------------------


class _Worker:
    """A process, and the task that it does."""

    def __init__(self, work: Callable[[Any], Any]) -> None:
        context = multiprocessing.get_context("spawn")
        self.pipe, there = context.Pipe()
        self.place = -1  # of its task
        self.begun = False
        self.process = context.Process(target=_serve, args=(work, there, os.getpid()))
        with interrupts_ignored(), one_thread():
            self.process.start()
        there.close()

    def give(self, place: int, task: object) -> None:
        """Have it do the task at `place`."""
        self.place = place
        with suppress(OSError):  # it died: that is heard when it is waited for
            self.pipe.send(task)

    def received(self) -> TaskOutcome[Any] | None:
        """The outcome of a task; None where it had only begun. Raises EOFError where its process died."""
        try:
            if self.pipe.poll():
                outcome = self.pipe.recv()
                self.begun = True
                return outcome
        except (EOFError, OSError):
            pass
        else:
            if self.process.is_alive():
                return None
        self.process.join()
        self.pipe.close()
        raise EOFError


class _Crew(Generic[Value]):
    """Processes that do tasks."""

    def __init__(self, work: Callable[[Any], Value], tasks: Sequence[Any], jobs: int) -> None:
        self._work, self._tasks, self._jobs = work, tasks, jobs
        self._waiting = deque(range(len(tasks)))
        self._tries: Counter[int] = Counter()
        self._idle: list[_Worker] = []
        self._busy: list[_Worker] = []

    def outcomes(self) -> Iterator[tuple[int, TaskOutcome[Value]]]:
        """The place of every task, and how it ended, as they end."""
        while self._waiting or self._busy:
            while self._waiting and len(self._busy) < self._jobs:
                worker = self._idle.pop() if self._idle else _Worker(self._work)
                self._busy.append(worker)
                place = self._waiting.popleft()
                worker.give(place, self._tasks[place])
            stirred = connection.wait([s for w in self._busy for s in (w.pipe, w.process.sentinel)])
            for worker in list(self._busy):
                if worker.pipe in stirred or worker.process.sentinel in stirred:
                    yield from self._hear(worker)

    def _hear(self, worker: _Worker) -> Iterator[tuple[int, TaskOutcome[Value]]]:
        place = worker.place
        try:
            outcome = worker.received()
        except EOFError:
            self._busy.remove(worker)
            yield from self._bury(worker)
            return
        if outcome is not None:
            self._busy.remove(worker)
            self._idle.append(worker)
            yield place, outcome

    def _bury(self, worker: _Worker) -> Iterator[tuple[int, TaskOutcome[Value]]]:
        """Have the task of one that died done by another, once; none, where processes cannot begin."""
        place, code = worker.place, worker.process.exitcode or 0
        self._tries[place] += 1
        if not worker.begun and code >= 0:  # by itself, and so would all others
            why = f"its process {way_of(code)} before it began"
            lost = [place, *self._waiting]
            self._waiting.clear()
            yield from ((one, TaskOutcome(None, Ended.DIED, why)) for one in lost)
        elif self._tries[place] < MAX_TRIES:
            self._waiting.appendleft(place)
        else:
            yield place, TaskOutcome(None, Ended.DIED, f"its process {way_of(code)}, twice")

    def dismiss(self) -> None:
        """End all processes, those that are at work in order."""
        for worker in (*self._idle, *self._busy):
            worker.pipe.close()
        if self._busy:
            _end([worker.process for worker in (*self._busy, *self._idle)])
        for worker in self._idle:
            worker.process.join()


@contextmanager
def one_thread() -> Generator[None]:
    """Runs and processes started meanwhile have one thread each."""
    before = {name: os.environ.get(name) for name in THREAD_LIMITS}
    os.environ.update(dict.fromkeys(THREAD_LIMITS, "1"))
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                del os.environ[name]
            else:
                os.environ[name] = value


def _end(processes: Sequence[BaseProcess]) -> None:
    """End processes in order if they let: a Ctrl-C at a terminal has reached them too, others have not.

    A run that got it twice would break off, so those still there after GRACE_S are sent theirs.
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
    deadline = time.monotonic() + GRACE_S
    for process in processes:
        process.join(max(0.0, deadline - time.monotonic()))
