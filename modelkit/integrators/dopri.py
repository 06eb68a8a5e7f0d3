"""The integrator every model steps with: Dormand-Prince 5(4), adaptive, on absolute scales.

Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, 2nd ed., table II.5.2; names as in
scipy's `rk.py`. The last stage of a step is the first of the next one.

Quadratures are components that no derivative depends on: impulse, work, heat. They come first in the state,
and only the end of a step is found of them, not the trial values of its stages.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..kernel import inlined, kernel
from ..status import OK, STEP_UNDERFLOW, TOO_MANY_STEPS
from .control import MAX_STEPS, SMALLEST_STEP, grown, is_last, shrunk

STAGES = 7
TRIAL = STAGES  # the row of scratch behind the stages
EXPONENT = 1 / 5  # the error is of order 5 in the step
MIN_ERROR, MAX_FACTOR = 1e-8, 5.0

A21 = 1 / 5
A31, A32 = 3 / 40, 9 / 40
A41, A42, A43 = 44 / 45, -56 / 15, 32 / 9
A51, A52, A53, A54 = 19372 / 6561, -25360 / 2187, 64448 / 6561, -212 / 729
A61, A62, A63, A64, A65 = 9017 / 3168, -355 / 33, 46732 / 5247, 49 / 176, -5103 / 18656
B1, B3, B4, B5, B6 = 35 / 384, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84
E1, E3, E4, E5, E6, E7 = 71 / 57600, -71 / 16695, 71 / 1920, -17253 / 339200, 22 / 525, -1 / 40
C2, C3, C4, C5 = 1 / 5, 3 / 10, 4 / 5, 8 / 9


class StateParts(NamedTuple):
    """What a state holds; components between the two parts are not in use."""

    quadratures: int  # how many, the first ones
    first: int  # first component that is not a quadrature; the others follow


ALL_COORDINATES = StateParts(0, 0)


def scratch(size: int) -> np.ndarray:
    """Work space (8, size) for a state of up to `size` components; holds nothing between calls."""
    return np.zeros((STAGES + 1, size))


def scratch_layout(size: int) -> np.dtype:
    """`scratch` as a record: its arrays carry no reference count, which costs more than the physics."""
    return np.dtype([("rows", "f8", (STAGES + 1, size))])


@kernel
def rk_step(rhs, m, q, parts, n, K, t, h):
    """One step of h (s) from q (n,) at t (s), whose slope is K[0]; fills K[1:7] and K[TRIAL], its end."""
    trial, first = K[TRIAL], parts.first
    for i in range(first, n):
        trial[i] = q[i] + h * (A21 * K[0, i])
    rhs(t + C2 * h, trial, K[1], m)
    for i in range(first, n):
        trial[i] = q[i] + h * (A31 * K[0, i] + A32 * K[1, i])
    rhs(t + C3 * h, trial, K[2], m)
    for i in range(first, n):
        trial[i] = q[i] + h * (A41 * K[0, i] + A42 * K[1, i] + A43 * K[2, i])
    rhs(t + C4 * h, trial, K[3], m)
    for i in range(first, n):
        trial[i] = q[i] + h * (A51 * K[0, i] + A52 * K[1, i] + A53 * K[2, i] + A54 * K[3, i])
    rhs(t + C5 * h, trial, K[4], m)
    for i in range(first, n):
        trial[i] = q[i] + h * (
            A61 * K[0, i] + A62 * K[1, i] + A63 * K[2, i] + A64 * K[3, i] + A65 * K[4, i]
        )
    rhs(t + h, trial, K[5], m)
    _end_step(q, 0, parts.quadratures, K, h)
    _end_step(q, first, n, K, h)
    rhs(t + h, trial, K[6], m)


@inlined
def _end_step(q, begin, end, K, h):
    """Fill K[TRIAL, begin:end], the end of a step of h (s) from q, from the stages in K."""
    for i in range(begin, end):
        K[TRIAL, i] = q[i] + h * (B1 * K[0, i] + B3 * K[2, i] + B4 * K[3, i] + B5 * K[4, i] + B6 * K[5, i])


@inlined
def _error_norm(K, begin, end, weight, h):
    """Largest error of the components from `begin` to `end`, as `_whole_error_norm` has it."""
    errors, error_norm = K[1], 0.0  # that stage is not needed any more; two loops: the first is vector code
    for i in range(begin, end):
        e = E1 * K[0, i] + E3 * K[2, i] + E4 * K[3, i] + E5 * K[4, i] + E6 * K[5, i] + E7 * K[6, i]
        errors[i] = abs(h * e) * weight[i]
    for i in range(begin, end):
        if errors[i] > error_norm or errors[i] != errors[i]:  # nothing is larger than a NaN, so it stays
            error_norm = errors[i]
    return error_norm


@kernel
def _whole_error_norm(K, parts, n, weight, h):
    """Largest error of a step of h (s) over the scales 1 / weight (n,), from its stages K; may be a NaN."""
    error_norm, weighed = _error_norm(K, parts.first, n, weight, h), 0.0
    for i in range(parts.quadratures):
        weighed += weight[i]
    if weighed > 0.0:
        of_quadratures = _error_norm(K, 0, parts.quadratures, weight, h)
        if of_quadratures > error_norm or of_quadratures != of_quadratures:
            error_norm = of_quadratures
    return error_norm


@kernel
def integrate(rhs, observe, m, q, parts, n, weight, K, span, h, tolerance):
    """Advance the state q[:n] over `span` (s) in place; parts: `StateParts` of it.

    rhs(t, q, dq, m) fills dq, the state's time derivative; t (s) counts from the start of the span.
    observe(t, q, m) sees the state after every accepted step. weight (n,): one over the size at which a
    component matters, in units of 1 / q. K: `scratch`, (8, n) or wider; its rows are the slopes of seven
    stages and the trial state. h (s): the step to try first. tolerance: the error norm of a step.
    Returns (step to try first next time (s), status, number of evaluations of rhs).
    """
    t = 0.0
    status = OK
    steps = 0
    rhs(t, q, K[0], m)
    evaluations = 1
    while t < span:
        steps += 1
        if steps > MAX_STEPS:
            status = TOO_MANY_STEPS
            break
        last = is_last(t, h, span)
        step = span - t if last else h
        rk_step(rhs, m, q, parts, n, K, t, step)
        evaluations += STAGES - 1
        error_norm = _whole_error_norm(K, parts, n, weight, step) / tolerance
        if error_norm <= 1.0:
            t = span if last else t + step
            for i in range(n):
                q[i] = K[TRIAL, i]
                K[0, i] = K[6, i]
            observe(t, q, m)
            longer = grown(step, error_norm, EXPONENT, MIN_ERROR, MAX_FACTOR)
            # a step cut short by the end of the span says little about the next one
            h = max(h, longer) if last else longer
        else:
            h = shrunk(step, error_norm, EXPONENT)
            if h < SMALLEST_STEP:
                status = STEP_UNDERFLOW
                break
    return h, status, evaluations
