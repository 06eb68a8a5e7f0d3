"""Macro steps in compiled code, as long as nothing in Python needs to see one."""

# pyright: basic

from __future__ import annotations

import math

import numpy as np

from .....modelkit.kernel.memory import call_exchange, float64_at, int32_at, int64_at
from . import kernel, kernel_without_gil
from .board import run_shared
from .loop_tables import FETCH, GET, INT, LONG, SET, STEP, TRUTH
from .port_accounts import book, worst_of
from .signal_exchange import answer, met, pull, push, step, tick_within


@kernel
def note(plan, turn, call, status):
    """Note which component failed, and at what; True."""
    plan.failed, plan.call, plan.status = turn, call, status
    return True


@kernel
def exchange(plan, turns, parts, signals, number, time):
    """One step of `plan.span` (s) from `time` (s) by all components; whether one failed.

    Group by group: inputs for all of it, then steps, then outputs of all. At once, what a component gave
    before holds until its own step ends. One that samples takes a step where its tick was sampled: in this
    macro step or, at once, in the one before.
    """
    ends = number + 1 if plan.at_once else number
    first = 0
    while first < len(turns):
        end, due = turns[first].end, 0
        for i in range(first, end):
            turn = turns[i]
            turn.time, turn.span = time, turn.every * plan.span
            turn.due = number % turn.every == 0
            if turn.period > 0.0:
                inputs_at = time - plan.span if plan.at_once else time
                turn.time, turn.span = tick_within(inputs_at, plan.span, turn.period), turn.period
                turn.due = turn.time < math.inf
            if turn.due:
                due += 1
                status = push(turn, parts, signals, number)
                if status != 0:
                    return note(plan, i, SET, status)
        board = plan.board if due > 1 and turns[first].shared > 1 else 0
        failed = advance(board, turns, first, end)
        if failed >= 0:
            return note(plan, failed, STEP, turns[failed].status)
        for i in range(first, end):
            gives = turns[i].due if turns[i].period > 0.0 else ends % turns[i].every == 0
            if gives:
                status = pull(turns[i])
                if status != 0:
                    return note(plan, i, GET, status)
        first = end
    return False


@kernel
def advance(board, turns, first, end):
    """Step those from `first` to `end` that are due; the first that failed, -1: none.

    board: the address of one on which they are shared; 0: of none.
    """
    if board:
        run_shared(board, turns, first, end)
        for i in range(first, end):
            if turns[i].due and turns[i].status != 0:
                return i
        return -1
    for i in range(first, end):
        if turns[i].due:
            turns[i].status = step(turns[i])
            if turns[i].status != 0:
                return i
    return -1


@kernel
def take(plan, turns, parts, seats, books, signals):
    """One macro step, whole or divided, each part of it booked; whether it failed."""
    begin, divided = plan.start + plan.done * plan.length, plan.parts
    if met(seats, signals, begin, plan.length):
        plan.hit += 1
        divided = max(divided, plan.impact_parts)
    plan.span = plan.length / divided
    for k in range(divided):
        if exchange(plan, turns, parts, signals, plan.done * divided + k, begin + k * plan.span):
            return True
        plan.booked += 1
        book(books, signals, plan.booked)
    plan.done += 1
    return False


@kernel
def record(plan, reads, columns, row):
    """Fill a recorded row: the time from zero (s), then all columns; whether that failed."""
    for i in range(len(reads)):
        r = reads[i]
        status = answer(call_exchange(r.call, r.of, r.references, r.count, r.into))
        if status != 0:
            return note(plan, r.turn, FETCH, status)
    row[0] = plan.start + plan.done * plan.length - plan.zero
    for i in range(len(columns)):
        address, kind = columns[i].address, columns[i].kind
        if kind == INT:
            row[1 + i] = int32_at(address, 1)[0]
        elif kind == TRUTH:
            row[1 + i] = 1.0 if int32_at(address, 1)[0] != 0 else 0.0
        elif kind == LONG:
            row[1 + i] = int64_at(address, 1)[0]
        else:
            row[1 + i] = float64_at(address, 1)[0]
    plan.row += 1
    return False


@kernel
def run(
    plan: np.ndarray,
    turns: np.ndarray,
    parts: np.ndarray,
    seats: np.ndarray,
    books: np.ndarray,
    signals: np.ndarray,
    reads: np.ndarray,
    columns: np.ndarray,
    rows: np.ndarray,
) -> bool:
    """Take the macro steps of `plan` (1,), record those that are due into `rows`; whether one failed.

    It ends early where the ledger passes the limit. The last macro step is booked, not recorded: whether
    it is to be is found by those who look at it.
    """
    p = plan[0]
    while p.done < p.until:
        if take(p, turns, parts, seats, books, signals):
            return True
        if p.done == p.until or not worst_of(books, p.fall)[1] <= p.limit:
            return False
        due = p.record_every > 0 and p.done % p.record_every == 0
        if due and record(p, reads, columns, rows[p.row]):
            return True
    return False


@kernel_without_gil
def run_beside(*arguments: np.ndarray) -> bool:
    """`run` beside helpers, which come from other threads of Python."""
    return run(*arguments)
