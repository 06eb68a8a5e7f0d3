"""What a component does in a macro step: take its inputs, step, give."""

# pyright: basic

from __future__ import annotations

import math

from touchdown.master.coupling.loop.kernels import kernel
from touchdown.master.coupling.loop.kernels.exchange import cut, scale
from touchdown.master.coupling.loop.kernels.tables import NOT_FINITE
from touchdown.modelkit.kernel.address import (
    call_advance,
    call_exchange,
    call_step,
    float64_at,
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
        return answer(call_exchange(turn.set_real, turn.of, turn.taken, turn.takes, turn.inputs))
    words = float64_at(turn.of, turn.words)
    taken = int64_at(turn.taken, turn.takes)
    for i in range(turn.takes):
        words[taken[i]] = inputs[i]
    return 0


@kernel
def step(turn):
    """Advance a component from its time by its span; a status."""
    if turn.functions:
        return answer(call_step(turn.step, turn.of, turn.time, turn.span))
    words = float64_at(turn.of, turn.words)
    work = float64_at(turn.work, (turn.rows, turn.columns))
    return call_advance(turn.step, words, work, turn.time, turn.span)


@kernel
def pull(turn):
    """Fetch what a component gives; a status."""
    outputs = float64_at(turn.outputs, turn.gives)
    if turn.functions:
        status = answer(call_exchange(turn.get_real, turn.of, turn.given, turn.gives, turn.outputs))
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
def answer(status):
    """0 where a component that answered so can go on."""
    return 0 if status <= WARNING else status
