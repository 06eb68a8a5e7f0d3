"""Leapfrog (velocity Verlet) with one evaluation a step, for light bodies on stiff, barely damped contacts.

    v_half = v + h/2 a        q' = q + h v_half        a' = a(q', v_half)        v' = v_half + h/2 a'

Undamped contacts neither gain nor lose energy in the long run (Hairer, Lubich, Wanner, Geometric Numerical
Integration, 2nd ed., section I.1.4). Between two drifts the velocities get one kick, a' over half of either
step; a' is evaluated with those before it, and a model may take what depends on velocity implicitly.

The step is bounded from above, and by the fastest contact of late: h w at most `Steps.resolution`, w its
angular frequency (the method is stable up to 2). Steps that shorten as a hit is found and lengthen after it
come late at one end of the hit and in time at the other: a body that rattles undamped would gain energy at
every hit, without bound. So w fades slowly, by `FREQUENCY_DECAY` a step, and hits that follow
each other are taken in equal steps.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from ..kernel import kernel
from ..status import OK, STEP_UNDERFLOW, TOO_MANY_STEPS
from .control import MAX_STEPS, SMALLEST_STEP

MAX_OVERRUN = 2.0  # of the resolution, up to which a step keeps the length that its kick was for
FREQUENCY_DECAY = 0.999  # of the largest frequency, a step
MIN_REMAINDER = 1e-6  # of a step; what is left of a span by rounding


class Steps(NamedTuple):
    """How long a step may be."""

    longest: float  # s
    resolution: float  # rad, of the fastest contact


@kernel
def step_length(frequency, left, steps):
    """The next step (s) for contacts up to `frequency` (rad/s): even ones over what is `left` (s)."""
    slow = frequency * steps.longest <= steps.resolution  # a NaN is not
    h = steps.longest if slow else steps.resolution / frequency
    return left if h >= left else left / math.ceil(left / h - 1e-6) if h > 0.0 else 0.0


@kernel
def of_late(current, before):
    """The frequency (rad/s) that bounds the next step: that of `current`, or that of `before`, faded."""
    faded = FREQUENCY_DECAY * before
    return faded if current < faded else current  # a NaN stays


@kernel
def integrate(rhs, drift, forecast, fastest, kicked, observe, m, q, n, work, span, steps, lately):
    """Advance the state q[:n] over `span` (s) in place, in `Steps`.

    rhs(t, q, dq, m) and observe(t, q, m) as for `dopri.integrate`. drift(trial, q, v, h, m) sets each
    position in `trial` to that in q plus h (s) times its velocity in v. forecast(trial, dq, h, kick, m) may
    add h/2 dq to velocities in `trial` that are evaluated at the end of the step, not in its middle, and
    notes how long (s) the kick will be that follows: half of this step and half of the next, or less where
    a hit shortens the next. kicked(q, dq, kick, m) is told of each `kick` (s) as it was taken, under dq.
    fastest(m) is the largest angular frequency at the last evaluation (rad/s); lately: what it was when the
    span before this one ended. work: `dopri.scratch`, of which four rows (n,) are used; the first holds rhs
    at the start, and at the end. Returns (status, number of evaluations of rhs, `lately` for what follows).
    """
    t = 0.0
    status = OK
    taken = 0
    f, f_new = work[0], work[1]  # dq at both ends of a step
    half, trial = work[2], work[3]  # q with the velocities of the middle; trial state
    frequency = of_late(fastest(m), lately)
    h = step_length(frequency, span, steps)
    kicked(q, f, 0.5 * h, m)
    while t < span:
        taken += 1
        if taken > MAX_STEPS:
            status = TOO_MANY_STEPS
            break
        if not h >= SMALLEST_STEP:  # a NaN is not
            status = STEP_UNDERFLOW
            break
        left = span - t - h
        following = 0.0
        if left > MIN_REMAINDER * h:
            following = step_length(frequency, left, steps)
            t += h
        else:
            t = span
        for i in range(n):
            half[i] = q[i] + 0.5 * h * f[i]
            trial[i] = half[i]
        drift(trial, q, half, h, m)
        forecast(trial, f, h, 0.5 * (h + following), m)
        rhs(t, trial, f_new, m)
        for i in range(n):
            q[i] = half[i] + 0.5 * h * f_new[i]
        drift(q, trial, half, 0.0, m)
        f, f_new = f_new, f
        frequency = of_late(fastest(m), frequency)
        if (
            frequency * following > MAX_OVERRUN * steps.resolution
        ):  # a hit found only now needs a shorter one
            following = min(following, step_length(frequency, span - t, steps))
        kicked(q, f, 0.5 * (h + following), m)
        observe(t, q, m)
        h = following
    for i in range(n):
        work[0, i] = f[i]
    return status, taken, frequency
