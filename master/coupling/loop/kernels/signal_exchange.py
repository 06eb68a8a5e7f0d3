"""A component's macro step in compiled code: take inputs, step, give outputs."""

from __future__ import annotations

import math

import numpy as np

from .....modelkit.kernel.memory import call_advance, call_exchange, call_step, float64_at, int64_at
from .....modelkit.ports import PARTING_TOLERANCE
from . import kernel
from .loop_tables import NOT_FINITE

# pyright: basic

ROUNDING = 1e-12  # s; a tick so near the end of a macro step lies at the beginning of the next


@kernel
def tick_within(time: float, step: float, period: float) -> float:
    """The first multiple of `period` (s) from `time` (s) on, within `step` (s); infinite: there is none."""
    tick = math.ceil((time - ROUNDING) / period) * period
    return tick if tick < time + step - ROUNDING else math.inf


@kernel
def scale(inputs: np.ndarray, factors: np.ndarray, offsets: np.ndarray) -> None:
    """Bring `inputs` (n,), in place, to the component's own units."""
    for i in range(len(inputs)):
        inputs[i] *= factors[i]
        inputs[i] += offsets[i]


@kernel
def cut(
    inputs: np.ndarray,
    means: np.ndarray,
    slopes: np.ndarray,
    last: np.ndarray,
    bearing: int,
    body: int,
    step: float,
    number: int,
) -> None:
    """Leave in a body's `inputs` what of a bearing's load acts in the step that begins with `number`.

    means, slopes, last: places in the inputs, as in `Part`; bearing, body: macro steps of `step` (s) that
    each takes in one.
    """
    begins = number % bearing
    middle = (begins + 0.5 * (body - bearing)) * step  # from that of the bearing's step
    for i in range(len(slopes)):
        inputs[means[i]] += inputs[slopes[i]] * middle
    if begins + body < bearing:
        for i in range(len(last)):
            inputs[last[i]] = 0.0


# pyright: basic


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
    places = int64_at(turn.given, turn.gives)
    for i in range(turn.gives):
        outputs[i] = words[places[i]]
    return 0


@kernel
def answer(status):
    """0 where a component that answered so can go on."""
    return 0 if 0 <= status <= WARNING else status


# pyright: basic


# S, from the touch; by then ring and journal have met hardest, and the ring's rattle fades
IMPACT_S = 2.5e-4
LOOK_AHEAD_STEPS = 2.0  # steps; within one, the other bearing may turn a journal to its ring

SEAT = np.dtype(
    [
        ("reach", "i8"),  # place in the signals: time (s) until its journal touches
        ("body", "i8"),  # whose journal it is
        ("near", "f8"),  # s, the last step in which the journal touched, or was about to
        ("since", "f8"),  # s, when that impact began
    ]
)


@kernel
def met(seats: np.ndarray, signals: np.ndarray, time: float, step: float) -> bool:
    """Whether two bearings hit a body in the step of `step` (s) from `time` (s), one of them newly."""
    for i in range(len(seats)):
        s = seats[i]
        if signals[s.reach] <= LOOK_AHEAD_STEPS * step:
            if time - s.near > PARTING_TOLERANCE:
                s.since = time
            s.near = time
    for i in range(len(seats)):
        for k in range(i):
            a, b = seats[i], seats[k]
            touching = time - min(a.near, b.near) <= PARTING_TOLERANCE
            if a.body == b.body and touching and time - max(a.since, b.since) < IMPACT_S:
                return True
    return False
