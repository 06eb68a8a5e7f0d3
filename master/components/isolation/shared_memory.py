"""Memory that the master and the process of an FMU share, and how they take turns.

Words that the two sides write lie on separate cache lines. Values follow them; one request at a time is
under way, and each side reads them only when the other has posted.

The two processes hand the turn to each other by numbers in shared memory, and by a wake-up call. A process
that sleeps takes tens of microseconds to wake, one that polls sees its turn in less than one. So the side
that waits polls for a while before it sleeps, where there are cores for it.
"""

from __future__ import annotations

import mmap
import platform
import select
import socket
import subprocess
import time
from contextlib import suppress
from enum import IntEnum

import numpy as np

CACHE_LINE_WORDS = 8  # words of a cache line


class Word(IntEnum):
    """Where the words are."""

    REQUEST = 0  # number of the last request
    REPLY = CACHE_LINE_WORDS  # number of the last reply
    MASTER_SLEEPS = 2 * CACHE_LINE_WORDS  # and must be woken
    HOST_SLEEPS = 3 * CACHE_LINE_WORDS
    WHAT = 4 * CACHE_LINE_WORDS  # is asked for: an `Ask`
    ARGUMENT = WHAT + 1  # a number
    PUSHED = WHAT + 2  # whether the inputs are to be handed over before
    SPIN = WHAT + 3  # us that the host spins before it sleeps
    TIME = WHAT + 4  # s, of the step, a float
    STEP = WHAT + 5  # s, its length, a float
    FAILED = 5 * CACHE_LINE_WORDS  # whether the request did
    AT = FAILED + 1  # the call that the FMU is at, in words up to VALUES: its name
    VALUES = 6 * CACHE_LINE_WORDS  # behind the words


class Ask(IntEnum):
    """Requests to the host."""

    CALL = 0  # a method of the host by name, with arguments: slow
    PULL = 1
    STEP = 2  # and fetch the outputs
    FETCH = 3  # the values of the reader with that number
    SAVE = 4  # the state, under a number
    RESTORE = 5
    RELEASE = 6


class Board:
    """The shared memory of an FMU with so many variables."""

    def __init__(self, handle: int, variables: int) -> None:
        memory = mmap.mmap(handle, board_size(variables))
        self.words = memoryview(memory).cast("q")
        self.floats = memoryview(memory).cast("d")
        self.call_bytes = memoryview(memory)[8 * Word.AT : 8 * Word.VALUES]
        if not self.call:
            self.call_bytes[:] = padded("loading its library")
        values = np.frombuffer(memory, dtype="f8")[Word.VALUES :].reshape(3, -1)
        self.inputs, self.outputs, self.read = values

    @property
    def call(self) -> str:
        """Name of the call that the FMU is at."""
        return bytes(self.call_bytes).decode().strip("\0 ")


def padded(name: str) -> bytes:
    """The name of a call as bytes of a board."""
    return name.encode().ljust(8 * (Word.VALUES - Word.AT))


def board_size(variables: int) -> int:
    """Bytes of a board."""
    return 8 * (Word.VALUES + 3 * max(variables, 1))


SPIN_S = 3e-4  # s to look before sleeping
MAX_SKIPPED_SPINS = 512  # waits that begin without looking, after looking has failed repeatedly
CUT_OFF = 120  # exit status of a process that finds its side of the crossing closed
WAKE_INTERVAL_S = 0.05  # s; a wake-up call that crossed with falling asleep is lost
STORES_ARE_ORDERED = platform.machine() in (
    "x86_64",
    "AMD64",
)  # other processors may show numbers before values


class GoneError(Exception):
    """The other side has ended."""


class CrossingSide:
    """One side of a crossing: it posts, and waits until the other side has."""

    def __init__(
        self, board: Board, calls: socket.socket, other: subprocess.Popen[bytes] | None = None
    ) -> None:
        """other: on the master's side the host's process, whose children may hold its end of `calls`."""
        self._words, self._calls, self._other = board.words, calls, other
        mine, theirs = (Word.REQUEST, Word.REPLY), (Word.MASTER_SLEEPS, Word.HOST_SLEEPS)
        self._posts, self._awaits = mine if other else mine[::-1]
        self._sleep, self._they_sleep = theirs if other else theirs[::-1]
        self._words[self._sleep] = 1
        self._awaited = 1
        self._pass_over = 0  # waits before it looks again
        self._passed_over = 1  # the last time that looking failed
        self._poll = select.poll()
        self._poll.register(calls, select.POLLIN)

    def post(self) -> None:
        """Hand the turn to the other side."""
        self._words[self._posts] += 1
        if self._words[self._they_sleep]:
            with suppress(OSError):  # `wait` notices that the other side is gone
                self._calls.send(b"\0")

    def wait(self, spin: float, limit: float) -> None:
        """Wait for the turn, looking for `spin` and for `limit` (s) in all.

        Raises GoneError where the other side is gone, TimeoutError where it does not post.
        """
        may_spin = STORES_ARE_ORDERED and spin > 0.0
        self._pass_over = max(self._pass_over - may_spin, 0)
        if not (may_spin and not self._pass_over and self._spin(spin)):
            self._doze(limit)
        self._awaited += 1

    def _spin(self, spin: float) -> bool:
        words, place, awaited = self._words, self._awaits, self._awaited
        deadline = time.perf_counter() + spin
        while words[place] != awaited and time.perf_counter() < deadline:
            pass
        if time.perf_counter() < deadline:
            self._passed_over = 1
        else:  # the other side is slow, or the processors are busy: then looking only takes time from it
            self._passed_over = self._pass_over = min(2 * self._passed_over, MAX_SKIPPED_SPINS)
        return words[place] == awaited

    def _doze(self, limit: float) -> None:
        words, place, awaited = self._words, self._awaits, self._awaited
        deadline = time.monotonic() + limit
        words[self._sleep] = 1
        while words[place] != awaited:
            left = deadline - time.monotonic()
            if left <= 0.0:
                raise TimeoutError
            called = self._poll.poll(1e3 * min(left, WAKE_INTERVAL_S))
            ended = not self._called() if called else self._other and self._other.poll() is not None
            if ended and words[place] != awaited:
                raise GoneError
        words[self._sleep] = int(not STORES_ARE_ORDERED)

    def _called(self) -> bytes:
        try:
            return self._calls.recv(64)
        except ConnectionResetError:
            return b""
