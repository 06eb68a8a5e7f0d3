"""Control of the step's length, shared by the methods with an estimate of their error.

Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, 2nd ed., eq. (II.4.13). An error norm
is the largest |e_i| * weight_i, where a weight is one over the size at which a component matters, and a
weight of zero leaves a quadrature out of the control. Touchdown is best controlled on absolute scales:
indentations of micrometres pass through zero at every bounce.
"""

from __future__ import annotations

import math

from ..kernel import kernel

SMALLEST_STEP = 1e-15  # s; far below the fastest motion here (0.1 us)
MAX_STEPS = 1_000_000  # in one macro step; a slower advance is a failure, not patience

SAFETY = 0.9  # of the step at which the error would just be allowed
MIN_FACTOR = 0.2  # a step shrinks to no less than this share of the last one
NO_NUMBER_FACTOR = 0.1  # where the error is NaN, and says nothing about the next step


@kernel
def is_last(t, h, span):
    """Whether a step of h (s) from t (s) reaches the end of the span; 1e-6 h is not worth a step."""
    return t + h * 1.000001 >= span


@kernel
def shrunk(step, error_norm, exponent):
    """The step (s) to try after one whose error was too large, or no number."""
    return step * (
        max(MIN_FACTOR, SAFETY / error_norm**exponent) if math.isfinite(error_norm) else NO_NUMBER_FACTOR
    )


@kernel
def grown(step, error_norm, exponent, least_error, max_factor):
    """The step (s) to take after one that was accepted; an error below `least_error` counts as that."""
    return step * min(max_factor, SAFETY / max(error_norm, least_error) ** exponent)
