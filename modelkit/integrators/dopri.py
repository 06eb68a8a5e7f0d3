"""The integrator every model steps with: Dormand-Prince 5(4), adaptive, on absolute scales.

Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, 2nd ed., table II.5.2. The error of
a step is the largest |e_i| * weight_i, so a weight is one over the size at which a component matters
and a weight of zero leaves a quadrature out of the control. Touchdown is best controlled on absolute
scales: indentations of micrometres pass through zero at every bounce.
"""

from __future__ import annotations

import math

import numpy as np

from touchdown.modelkit.kernel import inlined
from touchdown.modelkit.status import OK, STEP_UNDERFLOW, TOO_MANY_STEPS

STAGES = 8  # rows of scratch: seven slopes and one trial state
SMALLEST_STEP = 1e-15  # s; far below the fastest motion here (0.1 us)
MOST_STEPS = 1_000_000  # in one macro step; a slower advance is a failure, not patience

A21 = 1 / 5
A31, A32 = 3 / 40, 9 / 40
A41, A42, A43 = 44 / 45, -56 / 15, 32 / 9
A51, A52, A53, A54 = 19372 / 6561, -25360 / 2187, 64448 / 6561, -212 / 729
A61, A62, A63, A64, A65 = 9017 / 3168, -355 / 33, 46732 / 5247, 49 / 176, -5103 / 18656
B1, B3, B4, B5, B6 = 35 / 384, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84
E1, E3, E4, E5, E6, E7 = 71 / 57600, -71 / 16695, 71 / 1920, -17253 / 339200, 22 / 525, -1 / 40
C2, C3, C4, C5 = 1 / 5, 3 / 10, 4 / 5, 8 / 9


def scratch(size: int) -> np.ndarray:
    """Work space for a state of up to `size` components; holds nothing between calls."""
    return np.zeros((STAGES, size))


def scratch_layout(size: int) -> np.dtype:
    """`scratch` as a record.

    Arrays taken from a record carry no reference count. Where a right-hand side takes many slices,
    counting references costs more than the physics: `work.ravel().view(LAYOUT)[0].rows`.
    """
    return np.dtype([("rows", "f8", (STAGES, size))])


@inlined
def integrate(rhs, observe, m, y, n, weight, k, span, h, tolerance):
    """Advance y[:n] over `span` seconds in place.

    rhs(t, y, dy, m) fills dy; t counts from the start of the span. observe(t, y, m) sees the state
    after every accepted step. h is the step to try first (s).
    Returns (step to try first next time, status, number of evaluations of rhs).
    """
    t = 0.0
    status = OK
    steps = 0
    w = k[7]
    rhs(t, y, k[0], m)
    evaluations = 1
    while t < span:
        steps += 1
        if steps > MOST_STEPS:
            status = TOO_MANY_STEPS
            break
        last = t + h * 1.000001 >= span  # a remainder of less than 1e-6 h is not worth a step
        step = span - t if last else h
        for i in range(n):
            w[i] = y[i] + step * (A21 * k[0, i])
        rhs(t + C2 * step, w, k[1], m)
        for i in range(n):
            w[i] = y[i] + step * (A31 * k[0, i] + A32 * k[1, i])
        rhs(t + C3 * step, w, k[2], m)
        for i in range(n):
            w[i] = y[i] + step * (A41 * k[0, i] + A42 * k[1, i] + A43 * k[2, i])
        rhs(t + C4 * step, w, k[3], m)
        for i in range(n):
            w[i] = y[i] + step * (A51 * k[0, i] + A52 * k[1, i] + A53 * k[2, i] + A54 * k[3, i])
        rhs(t + C5 * step, w, k[4], m)
        for i in range(n):
            w[i] = y[i] + step * (
                A61 * k[0, i] + A62 * k[1, i] + A63 * k[2, i] + A64 * k[3, i] + A65 * k[4, i]
            )
        rhs(t + step, w, k[5], m)
        for i in range(n):
            w[i] = y[i] + step * (B1 * k[0, i] + B3 * k[2, i] + B4 * k[3, i] + B5 * k[4, i] + B6 * k[5, i])
        rhs(t + step, w, k[6], m)
        evaluations += 6
        error = 0.0
        for i in range(n):
            e = E1 * k[0, i] + E3 * k[2, i] + E4 * k[3, i] + E5 * k[4, i] + E6 * k[5, i] + E7 * k[6, i]
            e = abs(step * e) * weight[i]
            if e > error or e != e:  # nothing is larger than a NaN, so it stays
                error = e
        error /= tolerance
        if error <= 1.0:
            t = span if last else t + step
            for i in range(n):
                y[i] = w[i]
                k[0, i] = k[6, i]
            observe(t, y, m)
            grown = step * min(5.0, 0.9 / max(error, 1e-8) ** 0.2)
            # a step cut short by the end of the span says little about the next one
            h = max(h, grown) if last else grown
        else:
            h = step * (max(0.2, 0.9 / error**0.2) if math.isfinite(error) else 0.1)
            if h < SMALLEST_STEP:
                status = STEP_UNDERFLOW
                break
    return h, status, evaluations
