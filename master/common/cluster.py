"""Tasks on the machines of a Dask cluster that is there already."""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterator, Sequence
from contextlib import contextmanager
from itertools import islice
from threading import Lock
from typing import Any, TypeVar

from .errors import Ended, TouchdownError
from .pool import TaskOutcome, collected, one_thread, tried

SCHEDULER_TIMEOUT_S = 30.0  # s, for a scheduler to answer
TASKS_PER_THREAD = 2  # tasks that a worker's thread is given at a time: one waits while one runs

Task = TypeVar("Task")
Value = TypeVar("Value")

_alone = Lock()  # of a worker's process: a run has it to itself, however many threads the worker has


def run_on_cluster(
    work: Callable[[Task], Value],
    tasks: Sequence[Task],
    address: str,
    done: Callable[[], object],
    on_outcome: Callable[[int, TaskOutcome[Value]], object],
) -> list[TaskOutcome[Value]]:
    """How each task ended, as `run_all` has it, on the workers of the Dask scheduler at `address`.

    The tasks of a worker that dies are done by others; one that several died of has DIED. Without any
    worker it waits for one. Raises TouchdownError where no scheduler answers, and where it goes away.
    """
    with _connected(address) as client:
        return collected(_outcomes(client, work, tasks), len(tasks), done, on_outcome)


def reach(address: str) -> None:
    """See that a Dask scheduler answers at `address`. Raises TouchdownError where none does."""
    with _connected(address):
        pass


@contextmanager
def _connected(address: str) -> Generator[Any]:
    """A client of the scheduler; what it was given and has not done is cancelled at the end."""
    try:
        from distributed import Client
    except ImportError:
        raise TouchdownError(
            "a Dask cluster needs the package distributed; install touchdown-cosim[dask]"
        ) from None
    try:
        client: Any = Client(address, timeout=SCHEDULER_TIMEOUT_S, set_as_default=False)
    except (OSError, ValueError) as error:
        raise TouchdownError(
            f"no Dask scheduler answers at {address}: {' '.join(str(error).split())}; "
            "give its address, such as tcp://HOST:8786"
        ) from None
    try:
        yield client
    finally:
        client.close(timeout=SCHEDULER_TIMEOUT_S)


def _outcomes(
    client: Any, work: Callable[[Any], Value], tasks: Sequence[Any]
) -> Iterator[tuple[int, TaskOutcome[Value]]]:
    """The place of every task, and how it ended, as they end."""
    from distributed import as_completed

    places = iter(range(len(tasks)))
    under_way: dict[Any, int] = {}

    def submit(place: int) -> Any:
        future = client.submit(_one_by_one, work, tasks[place], pure=False)
        under_way[future] = place
        return future

    first = max(TASKS_PER_THREAD, TASKS_PER_THREAD * sum(client.nthreads().values()))
    ended: Any = as_completed([submit(place) for place in islice(places, first)], loop=client.loop)
    for future in ended:
        place = under_way.pop(future)
        yield place, _outcome(client, future)
        for more in islice(places, 1):  # one for the one that ended
            ended.add(submit(more))


def _one_by_one(work: Callable[[Any], Value], task: Any) -> TaskOutcome[Value]:
    """Do a task in a worker."""
    with _alone, one_thread():
        return tried(work, task)


def _outcome(client: Any, future: Any) -> TaskOutcome[Any]:
    """The outcome of a task; an exception is the cluster's, since those of the task are in its outcome."""
    from distributed import KilledWorker

    if client.status != "running" or future.cancelled():
        raise TouchdownError("the Dask scheduler has gone; the same command goes on when it is back")
    error = future.exception()
    if error is None:
        return future.result()
    if isinstance(error, KilledWorker):
        return TaskOutcome(None, Ended.DIED, "the processes of several Dask workers died of it")
    what = f"a Dask worker could not do it: {type(error).__name__}: {error}"
    return TaskOutcome(None, Ended.DIED, " ".join(what.split()))
