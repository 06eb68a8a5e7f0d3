"""Leapfrog (velocity Verlet) with one evaluation a step, for light bodies on stiff, barely damped contacts.

    v_half = v + h/2 a        q' = q + h v_half        a' = a(q', v_half)        v' = v_half + h/2 a'

Undamped contacts neither gain nor lose energy in the long run (Hairer, Lubich, Wanner, Geometric Numerical
Integration, 2nd ed., section I.1.4). Between two drifts the velocities get one kick, a' over half of either
step; a' is evaluated with those before it, and a model may take what depends on velocity implicitly.

The step is bounded from above, and by the fastest contact: h w <= `RESOLUTION`, w its angular frequency
(the method is stable up to 2).
"""

from __future__ import annotations

import math

from touchdown.modelkit.integrators.control import MOST_STEPS, SMALLEST_STEP
from touchdown.modelkit.kernel import inlined
from touchdown.modelkit.status import OK, STEP_UNDERFLOW, TOO_MANY_STEPS

RESOLUTION = 0.8
GROWTH = 1.25  # of the step; a kick was to be as long as the step before


@inlined
def step_length(frequency, before, longest):
    """The next step (s) for contacts up to `frequency` (rad/s), after one of `before` (s)."""
    h = longest if frequency * longest <= RESOLUTION else RESOLUTION / frequency
    return min(h, GROWTH * before)


@inlined
def integrate(rhs, drift, forecast, fastest, observe, m, q, n, work, span, longest):
    """Advance the state q[:n] over `span` (s) in place, in steps of at most `longest` (s).

    rhs(t, q, dq, m) and observe(t, q, m) as for `dopri.integrate`. drift(trial, q, v, h, m) sets each
    position in `trial` to that in q plus h (s) times its velocity in v. forecast(trial, dq, h, kick, m) may
    add h/2 dq to velocities in `trial` that are evaluated at the end of the step, not in its middle, and
    notes how long (s) the kick will be that follows: h, but h/2 at the end of the span, as at its start.
    fastest(m) is the largest angular frequency at the last evaluation (rad/s). work: `dopri.scratch`,
    of which four rows (n,) are used; the first holds rhs at the start.
    Returns (status, number of evaluations of rhs).
    """
    t = 0.0
    status = OK
    steps = 0
    before = longest
    f, f_new = work[0], work[1]  # dq at both ends of a step
    half, trial = work[2], work[3]  # q with the velocities of the middle; trial state
    while t < span:
        steps += 1
        if steps > MOST_STEPS:
            status = TOO_MANY_STEPS
            break
        h = step_length(fastest(m), before, longest)
        if not h >= SMALLEST_STEP:  # a NaN is not
            status = STEP_UNDERFLOW
            break
        before = h
        left = span - t
        if h < left:
            h = left / math.ceil(left / h - 1e-6)  # even steps, so that none is a sliver
            t += h
        else:
            h = left
            t = span
        for i in range(n):
            half[i] = q[i] + 0.5 * h * f[i]
            trial[i] = half[i]
        drift(trial, q, half, h, m)
        forecast(trial, f, h, h if t < span else 0.5 * h, m)
        rhs(t, trial, f_new, m)
        for i in range(n):
            q[i] = half[i] + 0.5 * h * f_new[i]
        drift(q, trial, half, 0.0, m)
        for i in range(n):
            f[i] = f_new[i]
        observe(t, q, m)
    return status, steps
