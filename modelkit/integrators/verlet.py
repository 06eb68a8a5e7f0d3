"""Leapfrog (velocity Verlet) with one evaluation a step, for light bodies on stiff, barely damped contacts.

    v_half = v + h/2 a        q' = q + h v_half        a' = a(q', v_half)        v' = v_half + h/2 a'

Undamped contacts neither gain nor lose energy in the long run. What depends on velocity is evaluated at
v_half; a friction force that a model limits to what stops the sliding within a step takes it to zero, as
an implicit step would, however steep the law.
The step is bounded from above, and by the fastest contact: h w <= `RESOLUTION`, w its angular frequency
(the method is stable up to 2).
"""

from __future__ import annotations

import math

from touchdown.modelkit.integrators.dopri import MOST_STEPS, SMALLEST_STEP
from touchdown.modelkit.kernel import inlined
from touchdown.modelkit.status import OK, STEP_UNDERFLOW, TOO_MANY_STEPS

RESOLUTION = 0.8
GROWTH = 1.25  # of the step; friction was limited for the step before


@inlined
def integrate(rhs, drift, forecast, fastest, observe, m, y, n, k, span, longest):
    """Advance y[:n] over `span` seconds in place, in steps of at most `longest` (s).

    rhs(t, y, dy, m) and observe(t, y, m) as for `dopri.integrate`. drift(x, y, v, h, m) sets each
    position in x to that in y plus h times its velocity in v. forecast(x, dy, h, m) may add h/2 dy to
    velocities in x that are evaluated at the end of the step, not in its middle, and notes h.
    fastest(m) is the largest angular frequency at the last evaluation (rad/s).
    Returns (status, number of evaluations).
    """
    t = 0.0
    status = OK
    steps = 0
    before = longest
    old, new, half, x = k[0], k[1], k[2], k[3]
    rhs(t, y, old, m)
    while t < span:
        steps += 1
        if steps > MOST_STEPS:
            status = TOO_MANY_STEPS
            break
        w = fastest(m)
        h = longest if w * longest <= RESOLUTION else RESOLUTION / w
        h = min(h, GROWTH * before)
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
            half[i] = y[i] + 0.5 * h * old[i]
            x[i] = half[i]
        drift(x, y, half, h, m)
        forecast(x, old, h, m)
        rhs(t, x, new, m)
        for i in range(n):
            y[i] = half[i] + 0.5 * h * new[i]
        drift(y, x, half, 0.0, m)
        for i in range(n):
            old[i] = new[i]
        observe(t, y, m)
    return status, steps + 1
