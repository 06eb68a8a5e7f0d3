"""Steps that wait to be taken by whichever thread is free.

A group of components whose steps do not depend on each other is put on a board. Who runs the stretch claims
steps from its front, helpers claim from its back, so that a component mostly stays with its thread; where
no helper is at hand, all are taken from the front, as without them.
"""

# pyright: basic

from __future__ import annotations

import numpy as np

from .....modelkit.kernel.memory import add_to_word, call_plain, load_word, pause, store, swap
from . import kernel, kernel_without_gil
from .signal_exchange import step

LINE = 64  # bytes that processors hand each other at a time: words apart do not get in each other's way
OPEN, LEFT, TAKEN, HELPED, YIELD = 0, LINE, 2 * LINE, 3 * LINE, 4 * LINE
"""Places of a board's words, in bytes: whether helpers are to stay; the first turn that is left of the
group and the one after the last, 32 bits each; how many of the group were taken; how many helpers took in
all; and the address of the function that leaves the processor to others, as no kept code could hold it."""
SIZE = 5 * LINE
HALF = 32  # bits
SPINS = 500  # looks, some us, after which a thread that waits lets others have its processor at each


@kernel
def run_shared(board, turns, first, end):
    """Have the turns from `first` to `end` stepped by all threads; back when all were."""
    store(board + TAKEN, 0)
    store(board + LEFT, first << HALF | end)
    i = _claim(board, True)
    while i >= 0:
        _take(board, turns[i])
        i = _claim(board, True)
    looks = 0
    while load_word(board + TAKEN) < end - first:
        looks = _wait(board, looks)


@kernel
def _claim(board, from_front):
    """A turn that is now this thread's alone; -1: none is left.

    It is of the group that is there now, whichever was when the word was read: same word, same claim.
    """
    while True:
        left = load_word(board + LEFT)
        first, end = left >> HALF, left & ((1 << HALF) - 1)
        if first >= end:
            return -1
        if from_front and swap(board + LEFT, left, (first + 1) << HALF | end):
            return first
        if not from_front and swap(board + LEFT, left, first << HALF | (end - 1)):
            return end - 1


@kernel
def _take(board, turn):
    if turn.due:
        turn.status = step(turn)
    add_to_word(board + TAKEN, 1)


@kernel
def _wait(board, looks):
    """Wait a moment after so many `looks`; how many they are with the next one."""
    if looks < SPINS:
        pause()
    else:
        call_plain(load_word(board + YIELD))
    return looks + 1


@kernel_without_gil
def help_out(board: int, turns: np.ndarray, patience: int) -> None:
    """Take steps that are put on the `board` (an address), until it closes, or `patience` looks in vain."""
    looks = 0
    while load_word(board + OPEN) != 0 and looks < patience:
        i = _claim(board, False)
        if i >= 0:
            _take(board, turns[i])
            add_to_word(board + HELPED, 1)
            looks = 0
        else:
            looks = _wait(board, looks)
