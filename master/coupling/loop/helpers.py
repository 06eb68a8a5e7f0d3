"""Threads that step some of a system's components while the run's own thread steps others."""

from __future__ import annotations

import ctypes
import os
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import suppress
from pathlib import Path

import numpy as np

from touchdown.master.coupling.loop.kernels.board import LINE, OPEN, SIZE, YIELD, help_out

THREADS = "OMP_NUM_THREADS"  # an environment variable; parallel libraries keep to it, too
QUOTA = Path("/sys/fs/cgroup/cpu.max")  # of processor time, in a container
PATIENCE = 20_000  # looks in vain, some ms, after which a helper leaves
WORD = 8  # bytes


class Helpers:
    """So many threads beside the run's own, for one system as it is laid out now."""

    def __init__(self, count: int, turns: np.ndarray) -> None:
        self._turns = turns
        room = np.zeros((SIZE + LINE) // WORD, np.int64)
        self._board = room[-room.ctypes.data % LINE // WORD :]
        self._board[OPEN // WORD] = 1
        self._board[YIELD // WORD] = _yield_address()
        self._pool = ThreadPoolExecutor(count, "touchdown-helper")
        self._helping: list[Future[None] | None] = [None] * count

    @property
    def board(self) -> int:
        """The address of the board that they look at."""
        return self._board.ctypes.data

    def call(self) -> None:
        """Call those who are not there, or left as there was nothing to do."""
        for i, helping in enumerate(self._helping):
            if helping is None or helping.done():
                self._helping[i] = self._pool.submit(help_out, self.board, self._turns, PATIENCE)

    def close(self) -> None:
        """Send them away; back when they are gone."""
        self._board[OPEN // WORD] = 0
        self._pool.shutdown()


def helpers(turns: np.ndarray) -> Helpers | None:
    """Those that the groups of `turns` can use; None where there are none."""
    most = max((row["end"] - first for first, row in enumerate(turns) if row["shared"]), default=1)
    count = min(most, threads()) - 1
    return Helpers(count, turns) if count > 0 else None


def threads() -> int:
    """How many threads a run may have."""
    given = os.environ.get(THREADS, "").partition(",")[0]
    if given.strip().isdecimal() and int(given) > 0:
        return int(given)
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    with suppress(OSError, ValueError):
        quota, period = map(float, QUOTA.read_text().split())
        cores = min(cores, int(quota / period))
    return max(cores, 1)


def _yield_address() -> int:
    """The system's function that leaves the processor to other threads."""
    library = ctypes.WinDLL("kernel32") if os.name == "nt" else ctypes.CDLL(None)  # pyright: ignore
    function = library.SwitchToThread if os.name == "nt" else library.sched_yield
    return ctypes.cast(function, ctypes.c_void_p).value or 0
