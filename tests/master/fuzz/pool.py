"""Cases played in processes that may die of them: crashes and stalls are findings."""

from __future__ import annotations

import os
import signal
import sys
import tempfile
import time
import traceback
import warnings
from collections.abc import Callable, Generator, Iterable
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from touchdown.master.common.pool import run_all

LIMIT = 120  # s of processor time that a case may take, the first of its models compiled too
STALL = 5  # times that on the clock, however busy the machine is


@dataclass(frozen=True)
class Ran:
    """How a case ended."""

    case: int
    status: int | None  # None: it raised, was killed or stalled
    stderr: str  # or what became of it
    seconds: float = 0.0  # of processor time
    memory: float = 0.0  # bytes, the most that its process held beyond what it held before


Play = Callable[[int, Path], int]
"""Plays a case in a folder of its own; returns the status it ended with."""


def _played(play: Play, limit: int, case: int) -> Ran:
    """The case, in this process, which SIGPROF or SIGALRM ends at a limit."""
    warnings.simplefilter("always")
    signal.setitimer(signal.ITIMER_PROF, limit)
    signal.alarm(STALL * limit)
    with tempfile.TemporaryFile("w+b") as spoken, open(os.devnull, "w") as nothing:
        os.dup2(nothing.fileno(), 1)
        os.dup2(spoken.fileno(), 2)
        begun = time.process_time()
        with suppress(OSError):
            Path("/proc/self/clear_refs").write_text("5")  # the most so far is that of now
        before = _most_memory()
        try:
            with tempfile.TemporaryDirectory() as folder, inside(folder):
                status = play(case, Path(folder))
        except BaseException:
            status = None
            traceback.print_exc()
        signal.alarm(0)
        signal.setitimer(signal.ITIMER_PROF, 0)
        sys.stderr.flush()
        spoken.seek(0)
        said = spoken.read().decode("utf-8", "replace")
        return Ran(case, status, said, time.process_time() - begun, _most_memory() - before)


def _most_memory() -> float:
    """Bytes that this process held at most; 0 where the system does not say."""
    with suppress(OSError):
        for line in Path("/proc/self/status").read_text().splitlines():
            if line.startswith("VmHWM:"):
                return 1024.0 * float(line.split()[1])
    return 0.0


@contextmanager
def inside(folder: str) -> Generator[None]:
    """With `folder` as the present one."""
    before = Path.cwd()
    os.chdir(folder)
    try:
        yield
    finally:
        os.chdir(before)


def run_cases(play: Play, cases: Iterable[int], jobs: int = 2, limit: int = LIMIT) -> list[Ran]:
    """How each case ended, `jobs` at a time; one whose process dies or stalls is played again, alone."""
    numbers = list(cases)
    ended = run_all(partial(_played, play, limit), numbers, jobs, lambda: None)
    return [one.value or Ran(case, None, one.reason) for case, one in zip(numbers, ended, strict=True)]
