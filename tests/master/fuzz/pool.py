"""Cases played in a pool of processes that survives them: crashes and stalls are findings."""

from __future__ import annotations

import multiprocessing
import os
import sys
import tempfile
import time
import traceback
import warnings
from collections.abc import Callable, Generator, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from multiprocessing.connection import Connection
from pathlib import Path

WINK = 0.01  # s that an answer is waited for
LIMIT = 120.0  # s that a case may take; far above what it takes, the first of its models compiled too


@dataclass(frozen=True)
class Ran:
    """How a case ended."""

    case: int
    status: int | None  # None: it raised, was killed or stalled
    stderr: str  # or what became of it
    seconds: float = 0.0


Play = Callable[[int, Path], int]
"""Plays a case in a folder of its own; returns the status it ended with."""


def _work(play: Play, pipe: Connection) -> None:
    """Say that it is there, then play the cases that come through the pipe, while there are any."""
    pipe.send(None)
    warnings.simplefilter("always")
    with tempfile.TemporaryFile("w+b") as spoken, open(os.devnull, "w") as nothing:
        os.dup2(nothing.fileno(), 1)
        os.dup2(spoken.fileno(), 2)
        while (case := pipe.recv()) is not None:
            spoken.seek(0)
            spoken.truncate()
            begun = time.perf_counter()
            try:
                with tempfile.TemporaryDirectory() as folder, inside(folder):
                    status = play(case, Path(folder))
            except BaseException:
                status = None
                traceback.print_exc()
            sys.stderr.flush()
            spoken.seek(0)
            said = spoken.read().decode("utf-8", "replace")
            pipe.send(Ran(case, status, said, time.perf_counter() - begun))


@contextmanager
def inside(folder: str) -> Generator[None]:
    """With `folder` as the present one."""
    before = Path.cwd()
    os.chdir(folder)
    try:
        yield
    finally:
        os.chdir(before)


class _Worker:
    """A process of the pool, and the case that it is at."""

    def __init__(self, play: Play) -> None:
        context = multiprocessing.get_context("spawn")
        self._pipe, theirs = context.Pipe()
        self._process = context.Process(target=_work, args=(play, theirs), daemon=True)
        self._process.start()
        theirs.close()
        self.case: int | None = None  # None: it has nothing to do
        self.lost = False  # whether it is gone, or does not answer
        self._started = False
        self._since = 0.0

    def take(self, cases: Iterator[int]) -> None:
        """Begin the next of the cases, if any, once the process is there: no limit counts before."""
        if not self._started:
            self._pipe.recv()
            self._started = True
        self.case, self._since = next(cases, None), time.monotonic()
        if self.case is not None:
            self._pipe.send(self.case)

    def ended(self, limit: float) -> Ran | None:
        """How its case ended; None where it has not."""
        assert self.case is not None
        if self._pipe.poll(WINK):
            try:
                return self._pipe.recv()
            except (EOFError, ConnectionError):
                self._process.join()
                said = f"its process ended with status {self._process.exitcode}"
        elif time.monotonic() - self._since >= limit:
            said = f"it stalled: more than {limit:g} s"
        else:
            return None
        self.lost = True
        return Ran(self.case, None, said)

    def end(self) -> None:
        """By itself where it has nothing to do, else whatever it does."""
        if self.case is None:
            self._pipe.send(None)
            self._process.join(LIMIT)
        self._process.kill()
        self._process.join()
        self._pipe.close()


def run_cases(play: Play, cases: Iterable[int], jobs: int = 2, limit: float = LIMIT) -> Iterator[Ran]:
    """How each case ended, `jobs` at a time; a process that dies or stalls is replaced by another."""
    left = iter(cases)
    workers = [_Worker(play) for _ in range(jobs)]
    try:
        for worker in workers:
            worker.take(left)
        while busy := [worker for worker in workers if worker.case is not None]:
            for worker in busy:
                ran = worker.ended(limit)
                if ran is None:
                    continue
                yield ran
                if worker.lost:
                    worker.end()
                    workers[workers.index(worker)] = worker = _Worker(play)
                worker.take(left)
    finally:
        for worker in workers:
            worker.end()
