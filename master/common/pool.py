"""Tasks side by side, in processes of this machine or on a Dask cluster."""

from __future__ import annotations

import ctypes
import logging
import multiprocessing
import os
import signal
import subprocess
import sys
import time
from collections import deque
from collections.abc import Callable, Generator, Sequence
from concurrent.futures import (
    FIRST_COMPLETED,
    BrokenExecutor,
    CancelledError,
    Executor,
    Future,
    ProcessPoolExecutor,
    wait,
)
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from threading import Lock
from typing import Any, Generic, TypeVar

from .errors import Ended, TouchdownError
from .interrupts import ENDING_SIGNALS, interrupts_ignored

LIMIT = "OMP_NUM_THREADS"  # an environment variable; parallel libraries keep to it, too
QUOTA = Path("/sys/fs/cgroup/cpu.max")  # of processor time, in a container
THREAD_LIMITS = (LIMIT, "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
"""Of linear algebra and of runs: one each, since processes share the cores, and sums have one order."""
GRACE_S = 2.0  # s that runs have to end by themselves after Ctrl-C
SCHEDULER_TIMEOUT_S = 30.0  # s, for a Dask scheduler to answer
TASKS_PER_THREAD = 2  # tasks that a Dask worker's thread is given at a time: one waits while one runs
SCRIPT_NAME = "slavemodule.txt"  # in the resources of an FMU by pythonfmu: which script it runs
SET_DEATH_SIGNAL = 1  # PR_SET_PDEATHSIG of prctl(2)

Task = TypeVar("Task")
Value = TypeVar("Value")


def cores() -> int:
    """How many there are: those it is bound to, or all where the system does not say."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def threads() -> int:
    """How many threads a run may have."""
    limit = os.environ.get(LIMIT, "").partition(",")[0]
    if limit.strip().isdecimal() and int(limit) > 0:
        return int(limit)
    found = cores()
    with suppress(OSError, ValueError):
        quota, period = map(float, QUOTA.read_text().split())
        found = min(found, int(quota / period))
    return max(found, 1)


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


def start_module(module: str, *arguments: object, **options: Any) -> subprocess.Popen[Any]:
    """Start a process that runs a module as a script; options are those of Popen.

    It imports from where this one does, but for what FMUs have added: one of pythonfmu puts its resources
    first, in which there is a pythonfmu of its version, and none of the libraries that building another
    FMU takes.
    """
    path = [folder for folder in sys.path if not os.path.isfile(os.path.join(folder, SCRIPT_NAME))]
    start = f"import runpy, sys; sys.path[:] = {path!r}; runpy.run_module({module!r}, run_name='__main__')"
    return subprocess.Popen([sys.executable, "-c", start, *map(str, arguments)], **options)


def die_with_parent(parent: int) -> None:
    """Have the kernel end this process as soon as process `parent`, which started it, is gone."""
    if sys.platform.startswith("linux"):
        ctypes.CDLL(None).prctl(SET_DEATH_SIGNAL, signal.SIGKILL, 0, 0, 0)
        if os.getppid() != parent:  # it was gone before the kernel was asked
            os._exit(1)


def ending_of(code: int) -> str:
    """How a process ended, by its exit code, negative for a signal: what it did, or what was done to it."""
    if code >= 0:
        return f"ended with status {code}"
    reported = -code in (*ENDING_SIGNALS, signal.SIGKILL)
    return f"{'was ended by' if reported else 'crashed with'} {signal.Signals(-code).name}"


# -- tasks -------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class TaskOutcome(Generic[Value]):
    """How a task ended: what it gave, or why it gave nothing."""

    value: Value | None
    ended: Ended = Ended.COMPLETED
    reason: str = ""  # why, where it did not complete


INTERRUPTED = TaskOutcome[Any](None, Ended.INTERRUPTED, Ended.INTERRUPTED.value)


def run_all(
    work: Callable[[Task], Value],
    tasks: Sequence[Task],
    jobs: int,
    done: Callable[[], object],
    on_outcome: Callable[[int, TaskOutcome[Value]], object] = lambda place, outcome: None,
    cluster: str = "",
) -> list[TaskOutcome[Value]]:
    """How each task ended, `jobs` at a time in processes that import `work`, or on a Dask `cluster`.

    After each that ended, on_outcome(place of the task, how) and done(). A task that raises has STOPPED.
    Those under way when a process dies run again, one at a time; one whose process then dies has DIED. A
    cluster has other workers do the tasks of one that died; one that several died of has DIED. After Ctrl-C
    those that have not ended are INTERRUPTED. The processes end with this one, however it ends. A script
    that calls it needs `if __name__ == "__main__":`. Raises TouchdownError where processes cannot begin,
    where no Dask scheduler answers at the address `cluster`, and where it goes away.
    """
    _refuse_importing_script()
    ended: dict[int, TaskOutcome[Value]] = {}

    def tell(place: int, outcome: TaskOutcome[Value]) -> None:
        on_outcome(place, outcome)
        ended[place] = outcome  # behind it: where Ctrl-C kept it from on_outcome, it is INTERRUPTED
        done()

    waiting, again = deque(range(len(tasks))), deque[int]()
    with suppress(KeyboardInterrupt):
        while waiting or again:
            alone = bool(again)
            with executor(1 if alone else min(jobs, len(tasks)), cluster) as (pool, at_a_time):
                if alone and not ended:
                    _refuse_what_cannot_begin(pool)
                lost = _until_broken(pool, at_a_time, work, tasks, again if alone else waiting, tell)
            if not alone:
                again.extend(lost)
            for place in lost if alone else ():
                how = ending_of(pool.exit_code) if isinstance(pool, _ProcessPool) else "died"
                tell(place, TaskOutcome(None, Ended.DIED, f"its process {how} while it ran alone"))
    return [ended.get(place, INTERRUPTED) for place in range(len(tasks))]


def _refuse_importing_script() -> None:
    """End this process with one line where it only imports the script that starts processes.

    A process that is started imports the caller's script; one without the guard would start processes
    again, which Python refuses with a page of traceback for each.
    """
    if getattr(multiprocessing.current_process(), "_inheriting", False):
        sys.stderr.write(  # in one write: the others say so at the same time
            "touchdown: processes that run beside each other import the script that starts them; put what "
            'it does under if __name__ == "__main__":\n'
        )
        sys.exit(1)


def _refuse_what_cannot_begin(pool: Executor) -> None:
    try:
        pool.submit(os.getpid).result()
    except BrokenExecutor:
        raise TouchdownError("processes that are started here end before they begin") from None


def _until_broken(
    pool: Executor,
    at_a_time: int,
    work: Callable[[Task], Value],
    tasks: Sequence[Task],
    places: deque[int],
    tell: Callable[[int, TaskOutcome[Value]], object],
) -> list[int]:
    """Do the tasks at `places`, and return those under way when a process died; `places` keeps the rest."""
    under_way: dict[Future[TaskOutcome[Value]], int] = {}
    lost: list[int] = []
    broken = False
    while under_way or (places and not broken):
        while places and not broken and len(under_way) < at_a_time:
            try:
                future = pool.submit(_do, work, tasks[places[0]])
            except BrokenExecutor:
                broken = True
            else:
                under_way[future] = places.popleft()
        for future in wait(under_way, return_when=FIRST_COMPLETED).done:
            place = under_way.pop(future)
            try:
                outcome = future.result()
            except BrokenExecutor:
                broken = True
                lost.append(place)
            except CancelledError:
                raise TouchdownError(
                    "the Dask scheduler has gone; the same command goes on when it is back"
                ) from None
            except Exception as error:  # of the cluster or of pickling: those of a task are in its outcome
                outcome = TaskOutcome[Any](None, Ended.DIED, f"it could not be done: {_in_words(error)}")
                tell(place, outcome)
            else:
                tell(place, outcome)
    return lost


_alone = Lock()  # of a Dask worker's process: a run has it to itself, however many threads the worker has


def _do(work: Callable[[Any], Value], task: Any) -> TaskOutcome[Value]:
    """In a process: the value of `work` for a task, or the reason why there is none."""
    try:
        with _alone, one_thread():
            return TaskOutcome(work(task))
    except KeyboardInterrupt:  # the task's own: its run was interrupted
        return INTERRUPTED
    except (Exception, SystemExit) as error:
        return TaskOutcome(None, Ended.STOPPED, _in_words(error))


def _in_words(error: BaseException) -> str:
    said = str(error) if isinstance(error, TouchdownError) else f"{type(error).__name__}: {error}"
    return " ".join(said.split())


# -- executors ---------------------------------------------------------------------------------------


@contextmanager
def executor(jobs: int, cluster: str = "") -> Generator[tuple[Executor, int]]:
    """An executor of `jobs` processes, or of the Dask `cluster`, and how many tasks to give it at a time.

    Leaving the context by an exception, Ctrl-C too, ends what is under way. Raises TouchdownError where no
    Dask scheduler answers at the address `cluster`.
    """
    if not cluster:
        with _ProcessPool(max(1, jobs)) as pool:
            yield pool, max(1, jobs)
        return
    try:
        from distributed import Client
    except ImportError:
        raise TouchdownError(
            "a Dask cluster needs the package distributed; install touchdown-cosim[dask]"
        ) from None
    logging.getLogger("distributed").setLevel(logging.CRITICAL)  # what it would log is said here
    try:
        client: Any = Client(cluster, timeout=SCHEDULER_TIMEOUT_S, set_as_default=False)
    except (OSError, ValueError) as error:
        raise TouchdownError(
            f"no Dask scheduler answers at {cluster}: {_in_words(error)}; give its address, such as "
            "tcp://HOST:8786"
        ) from None
    try:
        workers = sum(client.nthreads().values())
        yield client.get_executor(pure=False), max(1, workers) * TASKS_PER_THREAD
    finally:
        client.close(timeout=SCHEDULER_TIMEOUT_S)  # what it was given and has not done is cancelled


class _ProcessPool(ProcessPoolExecutor):
    """Processes of one numerical thread each, which end with this one.

    They ignore Ctrl-C, but for their runs, which note it and end in order.
    """

    def __init__(self, jobs: int) -> None:
        super().__init__(jobs, multiprocessing.get_context("spawn"), die_with_parent, (os.getpid(),))
        self.exit_code = 0  # of a process that died, once the pool is closed

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        """As every executor does; processes are started here."""
        with interrupts_ignored(), one_thread():
            return super().submit(fn, *args, **kwargs)

    def __exit__(self, kind: type[BaseException] | None, *_: object) -> None:
        processes = list(self._processes.values())
        try:
            if kind is not None:
                self.shutdown(wait=False, cancel_futures=True)
                for process in processes:
                    if process.is_alive() and process.pid is not None:
                        with suppress(ProcessLookupError):  # it has just ended
                            os.kill(process.pid, signal.SIGINT)
                deadline = time.monotonic() + GRACE_S
                for process in processes:
                    process.join(max(0.0, deadline - time.monotonic()))
            elif not self._broken:
                self.shutdown()
        finally:
            for process in processes:  # Python sends those of a broken pool SIGTERM, which a run only notes
                process.kill()
            self.shutdown()
        self.exit_code = next((process.exitcode for process in processes if process.exitcode), 0)
