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
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from touchdown.master.common.pool import run_all

LIMIT = 120  # s that a case may take; far above what it takes, the first of its models compiled too


@dataclass(frozen=True)
class Ran:
    """How a case ended."""

    case: int
    status: int | None  # None: it raised, was killed or stalled
    stderr: str  # or what became of it
    seconds: float = 0.0


Play = Callable[[int, Path], int]
"""Plays a case in a folder of its own; returns the status it ended with."""


def _played(play: Play, limit: int, case: int) -> Ran:
    """The case, in this process, which SIGALRM ends at the limit."""
    warnings.simplefilter("always")
    signal.alarm(limit)
    with tempfile.TemporaryFile("w+b") as spoken, open(os.devnull, "w") as nothing:
        os.dup2(nothing.fileno(), 1)
        os.dup2(spoken.fileno(), 2)
        begun = time.perf_counter()
        try:
            with tempfile.TemporaryDirectory() as folder, inside(folder):
                status = play(case, Path(folder))
        except BaseException:
            status = None
            traceback.print_exc()
        signal.alarm(0)
        sys.stderr.flush()
        spoken.seek(0)
        return Ran(case, status, spoken.read().decode("utf-8", "replace"), time.perf_counter() - begun)


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
