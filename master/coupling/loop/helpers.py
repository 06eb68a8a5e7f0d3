"""Threads that step some of a system's bearings while the run's own thread steps others."""

from __future__ import annotations

import ctypes
import math
import time as clock
from contextlib import suppress
from threading import Thread

import numpy as np

from ....modelkit.kernel.memory import WORD
from ...common.pool import threads
from .kernels.board import HELPED, LINE, OPEN, SIZE, YIELD, help_out

MAX_IDLE_LOOKS = 20_000  # looks in vain, some ms, after which a helper leaves
# Share of a stretch that a helper has its processor, where no other process wants that
MIN_PROCESSOR_SHARE = 0.9
MIN_JUDGED_S = 5e-4  # s that a stretch takes, at least, to tell
MAX_STRETCHES_ALONE = 64  # stretches without helpers before they are asked again


class Helpers:
    """So many threads beside the run's own, for one system in its present layout.

    On a busy machine a step may wait for a helper whose processor is taken by others, for milliseconds.
    After a stretch in which one was kept from its work they are left out: for one stretch, then two, four
    and so on, until they have their processors again.
    """

    def __init__(self, count: int, turns: np.ndarray, leave: int) -> None:
        self._turns = turns
        room = np.zeros((SIZE + LINE) // WORD, np.int64)
        self._board = room[-room.ctypes.data % LINE // WORD :]
        self._board[YIELD // WORD] = leave
        self._threads: list[Thread | None] = [None] * count
        self._failure: BaseException | None = None
        self._able, self._beside = True, False  # whether there can be threads, and are in this stretch
        self._alone = self._rests = 0  # stretches without them: those to come, and how many they were
        self._began = 0.0, 0.0  # s of wall time, and of processors by helpers

    @property
    def helped(self) -> int:
        """How many steps they took."""
        return int(self._board[HELPED // WORD])

    def call(self) -> int:
        """Have them at hand for a stretch; the address of the board that they look at, 0: of none."""
        self._beside = self._able and self._alone == 0 and self._all_there()
        self._alone = max(self._alone - 1, 0)
        self._began = clock.perf_counter(), self._spent()
        return self._board.ctypes.data if self._beside else 0

    def judge(self) -> None:
        """See after a stretch whether they had their processors. Raises what went wrong in a helper."""
        if self._failure is not None:
            raise self._failure
        took, spent = clock.perf_counter() - self._began[0], self._spent() - self._began[1]
        if self._beside and took > MIN_JUDGED_S:
            kept = spent < MIN_PROCESSOR_SHARE * took * len(self._threads)
            self._rests = min(2 * self._rests or 1, MAX_STRETCHES_ALONE) if kept else 0
            self._alone = self._rests
            if kept:
                self._board[OPEN // WORD] = 0

    def close(self) -> None:
        """Send them away; back when they are gone."""
        self._able, self._board[OPEN // WORD] = False, 0
        for thread in self._threads:
            if thread is not None and thread.is_alive():
                thread.join()

    def _all_there(self) -> bool:
        """Call those who left; whether all can be had."""
        self._board[OPEN // WORD] = 1
        for i, thread in enumerate(self._threads):
            if thread is None or not thread.is_alive():
                self._threads[i] = started = Thread(target=self._help, name="touchdown-helper", daemon=True)
                try:
                    started.start()
                except RuntimeError:  # there can be no more of them, or the interpreter is about to end
                    self._threads[i] = None
                    self._able, self._board[OPEN // WORD] = False, 0
                    return False
        return True

    def _spent(self) -> float:
        """s of processor time of all helpers; no number where the system does not tell, or one is gone."""
        try:
            threads = [t.native_id for t in self._threads if t and t.native_id]
            # Linux's clock of the processor time of a thread, by its number; one that is gone has none
            return sum(clock.clock_gettime((~thread << 3) | 6) for thread in threads)
        except (OSError, AttributeError):
            return math.nan

    def _help(self) -> None:
        try:
            help_out(self._board.ctypes.data, self._turns, MAX_IDLE_LOOKS)
        except BaseException as error:
            self._failure = error


def helpers(turns: np.ndarray) -> Helpers | None:
    """The helpers that the groups of `turns` can use; None where there are none."""
    worth = int(turns["shared"].max(initial=0))
    count = min(worth, threads()) - 1 if worth > 1 else 0
    leave = _leave_address() if count > 0 else 0
    return Helpers(count, turns, leave) if leave else None


def _leave_address() -> int:
    """The system's function that leaves the processor to others; 0 where there is none by that name."""
    with suppress(OSError, TypeError, AttributeError):
        return ctypes.cast(ctypes.CDLL(None).sched_yield, ctypes.c_void_p).value or 0
    return 0
