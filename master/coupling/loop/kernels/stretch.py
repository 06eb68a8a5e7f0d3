"""Macro steps in compiled code, as long as nothing in Python needs to see one."""

# pyright: basic

from __future__ import annotations

import math

import numpy as np

from touchdown.master.coupling.loop.kernels import kernel
from touchdown.master.coupling.loop.kernels.books import book, worst_of
from touchdown.master.coupling.loop.kernels.exchange import cut, scale
from touchdown.master.coupling.loop.kernels.impacts import met
from touchdown.master.coupling.loop.kernels.tables import (
    FETCH,
    GET,
    INT,
    LONG,
    NOT_FINITE,
    SET,
    STEP,
    TRUTH,
)
from touchdown.modelkit.kernel.address import (
    call_advance,
    call_exchange,
    call_step,
    float64_at,
    int32_at,
    int64_at,
)

WARNING = 1  # of FMI's answers, the last that lets a component go on


@kernel
def push(turn, parts, signals, number):
    """Hand a component its inputs for the step that begins with macro step `number`; a status."""
    inputs = float64_at(turn.inputs, turn.takes)
    places = int64_at(turn.places, turn.takes)
    for i in range(turn.takes):
        inputs[i] = signals[places[i]]
    if turn.factors:
        factors = float64_at(turn.factors, turn.takes)
        scale(inputs, factors, float64_at(turn.offsets, turn.takes))
    for i in range(turn.first_part, turn.end_part):
        part = parts[i]
        means = int64_at(part.means, part.slope_count)
        slopes = int64_at(part.slopes, part.slope_count)
        last = int64_at(part.last, part.last_count)
        cut(inputs, means, slopes, last, part.bearing, part.body, part.step, number)
    if turn.functions:
        return _answer(call_exchange(turn.set_real, turn.of, turn.taken, turn.takes, turn.inputs))
    words = float64_at(turn.of, turn.words)
    taken = int64_at(turn.taken, turn.takes)
    for i in range(turn.takes):
        words[taken[i]] = inputs[i]
    return 0


@kernel
def step(turn, time, span):
    """Advance a component from `time` by `span` (s); a status."""
    turn.time, turn.span = time, span
    if turn.functions:
        return _answer(call_step(turn.step, turn.of, time, span))
    words = float64_at(turn.of, turn.words)
    work = float64_at(turn.work, (turn.rows, turn.columns))
    return call_advance(turn.step, words, work, time, span)


@kernel
def pull(turn):
    """Fetch what a component gives; a status."""
    outputs = float64_at(turn.outputs, turn.gives)
    if turn.functions:
        status = _answer(call_exchange(turn.get_real, turn.of, turn.given, turn.gives, turn.outputs))
        if turn.finite and status == 0:
            for i in range(turn.gives):
                if not math.isfinite(outputs[i]):
                    status = NOT_FINITE
        return status
    words = float64_at(turn.of, turn.words)
    given = int64_at(turn.given, turn.gives)
    for i in range(turn.gives):
        outputs[i] = words[given[i]]
    return 0


@kernel
def _answer(status):
    """0 where a component that answered so can go on."""
    return 0 if status <= WARNING else status


@kernel
def note(plan, turn, call, status):
    """Note which component failed, and at what; True."""
    plan.failed, plan.call, plan.status = turn, call, status
    return True


@kernel
def exchange(plan, turns, parts, signals, number, time):
    """One step of `plan.span` (s) from `time` (s) by all components; whether one failed.

    At once, all of them make one group: inputs for all, then steps, then outputs of all. In turn, each is a
    group of its own. At once, what a component gave before holds until its own step ends.
    """
    size = len(turns) if plan.at_once else 1
    ends = number + 1 if plan.at_once else number
    for first in range(0, len(turns), size):
        for i in range(first, first + size):
            if number % turns[i].every == 0:
                status = push(turns[i], parts, signals, number)
                if status != 0:
                    return note(plan, i, SET, status)
        for i in range(first, first + size):
            if number % turns[i].every == 0:
                status = step(turns[i], time, turns[i].every * plan.span)
                if status != 0:
                    return note(plan, i, STEP, status)
        for i in range(first, first + size):
            if ends % turns[i].every == 0:
                status = pull(turns[i])
                if status != 0:
                    return note(plan, i, GET, status)
    return False


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
        status = _answer(call_exchange(r.call, r.of, r.references, r.count, r.into))
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
