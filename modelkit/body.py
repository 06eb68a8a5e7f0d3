"""A macro step of a body: something that takes a load (mean and slope) and gives its motion."""

from __future__ import annotations

import math

import numpy as np

from .integrators import dopri
from .kernel import kernel
from .status import BAD_INPUT, BAD_LOAD, OK

TOLERANCE = 1e-9  # of the body's scales; its motion within a macro step is nearly polynomial


@kernel
def nothing_to_watch(t, q, m):
    """Nothing happens inside a body's step, at t (s) in state q (n,), that its end does not show."""


@kernel
def finite(m):
    """Whether every component of the state m.q[: m.n] is a finite number."""
    return math.isfinite(np.sum(m.q[: m.n]))


@kernel
def advance(rhs, publish, m, work, time, step, load):
    """One macro step of `step` (s) from `time` (s); returns one of `modelkit.status`.

    rhs(t, q, dq, m) and publish(q, m) as in `modelkit.model.Model`, work: `dopri.scratch`. `load` is the
    sum of all inputs, by which one that is not finite is noticed.
    """
    status = BAD_INPUT
    if math.isfinite(load):
        m.time = time
        m.half = 0.5 * step
        m.h, status, evaluations = dopri.integrate(
            rhs, nothing_to_watch, m, m.q, dopri.ALL_COORDINATES, m.n, m.weight, work, step, m.h, TOLERANCE
        )
        m.evaluations += evaluations
        publish(m.q, m)
        if status == OK and not finite(m):
            status = BAD_LOAD
    return status
