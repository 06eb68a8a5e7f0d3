"""Memory that the master and the process of an FMU share: requests, replies and values.

Words that the two sides write lie on cache lines of their own. Values follow them; one request at a time is
under way, and each side reads them only when the other has posted.
"""

from __future__ import annotations

import mmap
from enum import IntEnum

import numpy as np

LINE = 8  # words of a cache line


class Word(IntEnum):
    """Where the words are."""

    REQUEST = 0  # number of the last request
    REPLY = LINE  # number of the last reply
    MASTER_SLEEPS = 2 * LINE  # and must be woken
    HOST_SLEEPS = 3 * LINE
    WHAT = 4 * LINE  # is asked for: an `Ask`
    ARGUMENT = WHAT + 1  # a number
    PUSHED = WHAT + 2  # whether the inputs are to be handed over before
    SPIN = WHAT + 3  # us that the host spins before it sleeps
    TIME = WHAT + 4  # s, of the step, a float
    STEP = WHAT + 5  # s, its length, a float
    AT = 5 * LINE  # what the FMU is at: an index into `touchdown.master.components.fmu.CALLS`
    FAILED = AT + 1  # whether the request did
    VALUES = 6 * LINE  # behind the words


class Ask(IntEnum):
    """What the host can be asked for."""

    CALL = 0  # a method of its own by name, with arguments: slow
    PULL = 1
    STEP = 2  # and fetch the outputs
    FETCH = 3  # what the reader of that number reads
    SAVE = 4  # the state, under a number
    RESTORE = 5
    RELEASE = 6


class Board:
    """The shared memory of an FMU with so many variables."""

    def __init__(self, handle: int, variables: int) -> None:
        memory = mmap.mmap(handle, board_size(variables))
        self.words = memoryview(memory).cast("q")
        self.floats = memoryview(memory).cast("d")
        values = np.frombuffer(memory, dtype="f8")[Word.VALUES :].reshape(3, -1)
        self.inputs, self.outputs, self.read = values


def board_size(variables: int) -> int:
    """Bytes of a board."""
    return 8 * (Word.VALUES + 3 * max(variables, 1))
