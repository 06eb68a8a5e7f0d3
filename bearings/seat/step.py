"""A bearing's macro step: copies set to the bodies, integrated with what is inside, the load handed over.

A bearing brings four kernels, which are compiled into the functions below:

    react(t, q, dq, m)          the `Load` (N, N m) at t (s), and in dq the derivative of what is inside
    integrate(m, work, span)    advances m.q by span (s): (micro-step to try next (s), status, evaluations);
                                the first row of work holds the state's derivative at the start
    observe(t, q, m)            keeps peaks and events, after each accepted micro-step
    report(q, m)                fills the outputs that are wanted once per macro step
"""

from __future__ import annotations

import math

import numpy as np

from touchdown.bearings.seat.copies import clear, copy_rates, take_inputs, take_modes
from touchdown.bearings.seat.layout import HX, HY, IMPULSE_SCALE, JPX, JPY, JX, JY
from touchdown.bearings.seat.load import (
    account_jump,
    hand_instead,
    hand_now,
    hand_over,
    handed_over,
    is_finite,
    remember,
)
from touchdown.modelkit.integrators import dopri
from touchdown.modelkit.kernel import kernel
from touchdown.modelkit.ports import MODEL
from touchdown.modelkit.status import BAD_INPUT, BAD_LOAD, OK


@kernel
def finite_inputs(m):
    """Whether every input that is in use is a finite number."""
    j = m.u.journal
    total = j.x + j.y + j.vx + j.vy + j.ax_free + j.ay_free + j.inv_m + j.omega
    total += j.alpha_free + j.inv_I + _sum_of(m.u.housing)
    for k in range(m.s.seat.modes):
        total += _sum_of(j.mode[k])
    return math.isfinite(total)


@kernel
def _sum_of(z):
    """Of all numbers of a `SprungMotion`, in no unit: finite where each of them is."""
    return z.x + z.y + z.vx + z.vy + z.ax_free + z.ay_free + z.inv_m + z.k_over_m + z.c_over_m


@kernel
def _weigh_impulse(m):
    """Have micro-steps resolve the load where no copy moves under it, and so none would show its error.

    Sets the impulse's error weights, 1/(N s).
    """
    if m.p.interface.order < MODEL or m.u.journal.inv_m == 0.0:
        m.weight[JPX] = m.weight[JPY] = 1.0 / IMPULSE_SCALE


@kernel
def begin(react, report, m):
    """First outputs, from state and inputs; the first restart compares with the load now."""
    take_modes(m)
    _weigh_impulse(m)
    load = react(0.0, m.q, np.zeros(m.n), m)
    remember(m, load)
    report(m.q, m)


@kernel
def instant(react, t, q, dq, m):
    """Derivative dq of what is inside and the load now, for a solver that holds all bodies itself.

    The motion comes from m.u; the load (N, N m) goes out as the mean in m.o, its slope zero.
    """
    take_inputs(q, m)
    load = react(t, q, dq, m)
    hand_now(m, load)


@kernel
def integrate(rhs, observe, m, work, span):
    """Advance m.q by `span` (s) in adaptive steps of the error interface.tolerance.

    rhs(t, q, dq, m): derivative dq of the whole state; work: rows of scratch as long as the state.
    Returns (micro-step to try next (s), status, evaluations).
    """
    tolerance = m.p.interface.tolerance
    return dopri.integrate(rhs, observe, m, m.q, m.n, m.weight, work, span, m.h, tolerance)


@kernel
def any_time(m, since):
    """A bearing whose law does not depend on time has nothing to get ready; since: s."""


@kernel
def advance(react, integrate, report, words, m, work, time, step):
    """One macro step of `step` (s) from `time` (s); returns a status.

    words: the bearing's memory, which m is as a record; work: rows of scratch as long as the state.
    """
    return advance_timed(any_time, react, integrate, report, words, m, work, time, step)


@kernel
def advance_timed(ready, react, integrate, report, words, m, work, time, step):
    """`advance` of a bearing that looks at the clock.

    ready(m, since) prepares it for the stretch of 2 m.half (s) that begins at m.time, `since` (s) after
    the inputs.
    """
    status = BAD_INPUT
    if finite_inputs(m):
        q = m.q
        m.time = time
        m.half = 0.5 * step
        jx, jy, hx, hy = q[JX], q[JY], q[HX], q[HY]
        take_inputs(q, m)
        ready(m, 0.0)
        before = react(0.0, q, work[0], m)
        account_jump(m, before, q[JX] - jx, q[JY] - jy, q[HX] - hx, q[HY] - hy)
        remember(m, before)
        copy_rates(0.0, q, work[0], m, m.half, before)
        m.h, status, evaluations = integrate(m, work, step)
        m.evaluations += evaluations
        hand_over(q, m, step)
        remember(m, react(step, q, work[0], m))
        report(q, m)
        if status == OK and m.p.interface.lead == 1:
            kept = words.copy()
            m.time = time + step
            ready(m, step)
            clear(q, m)
            copy_rates(0.0, q, work[0], m, m.half, react(0.0, q, work[0], m))
            _, status, evaluations = integrate(m, work, step)
            hand_over(q, m, step)
            ahead = handed_over(m)
            for i in range(len(words)):  # a slice would bring the texts of refusals into the machine code
                words[i] = kept[i]
            m.evaluations += evaluations
            hand_instead(m, ahead)
        if status == OK and not is_finite(m):
            status = BAD_LOAD
    return status
