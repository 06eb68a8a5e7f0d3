"""Steps that wait to be taken by whichever thread is free.

A group of components whose steps do not hang on each other is put on a board. Who runs the stretch claims
steps from its front, helpers claim from its back, so that a component mostly stays with its thread; where
no helper is at hand, all are taken from the front, as without them.
"""

# pyright: basic

from __future__ import annotations

import numpy as np

from touchdown.master.coupling.loop.kernels import kernel, kernel_without_gil
from touchdown.master.coupling.loop.kernels.component import step
from touchdown.modelkit.kernel.atomic import add, call_plain, load, pause, replace, store

LINE = 64  # bytes that processors hand each other at a time: words apart do not get in each other's way
OPEN, CLAIMS, TAKEN, YIELD = 0, LINE, 2 * LINE, 3 * LINE
"""Places of a board's words, in bytes: whether helpers are to stay; a round's number, the first turn that
is left of it and the one after the last, in 32, 16 and 16 bits; how many turns were taken; and the address
of the function that leaves the processor to others."""
SIZE = 4 * LINE
MOST = 0xFFFF  # components of a system
ROUNDS = 0x7FFFFFFF
SPINS = 500  # looks, some us, after which a thread that waits lets others have its processor at each


@kernel
def share(board, turns, first, end):
    """Have the turns from `first` to `end` stepped by all threads; back when all were."""
    number = ((load(board + CLAIMS) >> 32) + 1) & ROUNDS
    store(board + TAKEN, 0)
    store(board + CLAIMS, number << 32 | first << 16 | end)
    i = _claim(board, True)
    while i >= 0:
        _take(board, turns[i])
        i = _claim(board, True)
    looks = 0
    while load(board + TAKEN) < end - first:
        looks = _wait(board, looks)


@kernel
def _claim(board, from_front):
    """A turn that is now this thread's alone; -1: none is left."""
    while True:
        claims = load(board + CLAIMS)
        first, end = (claims >> 16) & MOST, claims & MOST
        if first >= end:
            return -1
        left = claims + (MOST + 1) if from_front else claims - 1
        if replace(board + CLAIMS, claims, left):
            return first if from_front else end - 1


@kernel
def _take(board, turn):
    if turn.due:
        turn.status = step(turn)
    add(board + TAKEN, 1)


@kernel
def _wait(board, looks):
    """Wait a moment after so many `looks`; how many they are with the next one."""
    if looks < SPINS:
        pause()
    else:
        call_plain(load(board + YIELD))
    return looks + 1


@kernel_without_gil
def help_out(board: int, turns: np.ndarray, patience: int) -> None:
    """Take steps that are put on the `board` (an address), until it closes, or `patience` looks in vain."""
    looks = 0
    while load(board + OPEN) != 0 and looks < patience:
        i = _claim(board, False)
        if i >= 0:
            _take(board, turns[i])
            looks = 0
        else:
            looks = _wait(board, looks)
