"""A bearing's macro step: the order in which it is taken, and the load that it hands over.

The load is handed over as mean and slope over the macro step, with the elastic modes' part beside them
(`hand_over`). With the impulse P and the first moment Q about the middle of a step of H seconds

    mean = P/H        slope = 12 Q/H^3

or, for a housing on springs, the two numbers that bring it where its copy went. Half the sum of the loads
before and after a restart times the jump of the copy is booked (`jump_work`).

A bearing names its family (`Carried`: `PLANAR`, `space.SPATIAL`) and brings four kernels, which are
compiled into the functions below:

    react(t, q, dq, m)          the `Load` (N, N m) at t (s), and in dq the derivative of what is inside
    integrate(m, work, span)    advances m.q by span (s): (micro-step to try next (s), status, evaluations);
                                the first row of work holds the state's derivative at the start
    observe(t, q, m)            keeps peaks and events, after each accepted micro-step
    report(q, m)                fills the outputs that are wanted once per macro step
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from ...modelkit import numerics
from ...modelkit.integrators import dopri
from ...modelkit.integrators.dopri import StateParts
from ...modelkit.kernel import kernel
from ...modelkit.ports import MODEL
from ...modelkit.status import BAD_INPUT, BAD_LOAD, OK
from .copies import (
    HE,
    HFVX,
    HFVY,
    HFX,
    HFY,
    HPX,
    HPY,
    HX,
    HY,
    IMPULSE_SCALE,
    JE,
    JPM,
    JPX,
    JPY,
    JQM,
    JQX,
    JQY,
    JX,
    JY,
    PARTS,
    PER_MODE,
    PX,
    PY,
    QX,
    QY,
    clear_gathered,
    copy_rates,
    take_inputs,
    take_modes,
)

# Half a period of the housing per macro step; beyond, two numbers cannot stand for its load
MAX_HALF_PERIODS = 3.0
BODY_LOAD_SIZE = 10  # numbers of the load on journal and housing; each mode has four more


class Carried(NamedTuple):
    """Kernels by which the copies of a family of bearings are carried through a macro step."""

    parts: StateParts  # of the state
    take_inputs: Any
    clear: Any
    rates: Any  # `copies.copy_rates`
    weigh_impulse: Any
    hand_over: Any
    hand_now: Any
    handed_over: Any
    hand_instead: Any
    sum_handed: Any
    sum_inputs: Any
    places: Any
    account_jump: Any
    remember: Any


@kernel
def hand_over(q, m, step):
    """Turn impulses and first moments in q into the mean (N) and slope (N/s) that the bodies take, in m.o.

    step: the macro step (s).
    """
    first = 1.0 / step
    second = 12.0 / (step * step * step)
    j = m.o.journal
    j.fx, j.fy, j.mz = first * q[JPX], first * q[JPY], first * q[JPM]
    j.dfx, j.dfy, j.dmz = second * q[JQX], second * q[JQY], second * q[JQM]
    j.work += q[JE]
    h = m.o.housing
    u = m.u.housing
    if max(step * math.sqrt(u.k_over_m), step * u.c_over_m) < MAX_HALF_PERIODS:
        response = numerics.oscillator_step(u.k_over_m, u.c_over_m, step)
        h.fx, h.dfx = numerics.load_for(response, q[HFX], q[HFVX])
        h.fy, h.dfy = numerics.load_for(response, q[HFY], q[HFVY])
    else:
        h.fx, h.fy, h.dfx, h.dfy = first * q[HPX], first * q[HPY], 0.0, 0.0
    h.work += q[HE]
    for n in range(m.s.seat.modes):
        i, z, lacking = m.s.seat.inside + PER_MODE * n, m.u.journal.mode[n], j.mode[n]
        response = numerics.oscillator_step(z.k_over_m, z.c_over_m, step)
        lacking.qx = q[i + QX] - (response.zf * j.fx + response.zg * j.dfx)
        lacking.qy = q[i + QY] - (response.zf * j.fy + response.zg * j.dfy)
        lacking.px = q[i + PX] - (response.vf * j.fx + response.vg * j.dfx)
        lacking.py = q[i + PY] - (response.vf * j.fy + response.vg * j.dfy)


@kernel
def hand_mean(m, load):
    """Put a momentary load (`Load`: N, N m) in the outputs as the mean, its slope zero."""
    j, h = m.o.journal, m.o.housing
    j.fx, j.fy, j.mz, j.dfx, j.dfy, j.dmz = load.jx, load.jy, load.jm, 0.0, 0.0, 0.0
    h.fx, h.fy, h.dfx, h.dfy = load.hx, load.hy, 0.0, 0.0


@kernel
def load_numbers(m):
    """The load as it stands in m.o, in its units: (10 + 4 modes,) on journal, housing and modes."""
    j, h = m.o.journal, m.o.housing
    load = np.empty(BODY_LOAD_SIZE + 4 * m.s.seat.modes)
    load[0], load[1], load[2], load[3], load[4], load[5] = j.fx, j.fy, j.mz, j.dfx, j.dfy, j.dmz
    load[6], load[7], load[8], load[9] = h.fx, h.fy, h.dfx, h.dfy
    for k in range(m.s.seat.modes):
        i, z = BODY_LOAD_SIZE + 4 * k, j.mode[k]
        load[i], load[i + 1], load[i + 2], load[i + 3] = z.qx, z.qy, z.px, z.py
    return load


@kernel
def put_load(m, load):
    """Put a load from `load_numbers`, (10 + 4 modes,), in the outputs."""
    j, h = m.o.journal, m.o.housing
    j.fx, j.fy, j.mz, j.dfx, j.dfy, j.dmz = load[0], load[1], load[2], load[3], load[4], load[5]
    h.fx, h.fy, h.dfx, h.dfy = load[6], load[7], load[8], load[9]
    for k in range(m.s.seat.modes):
        i, z = BODY_LOAD_SIZE + 4 * k, j.mode[k]
        z.qx, z.qy, z.px, z.py = load[i], load[i + 1], load[i + 2], load[i + 3]


@kernel
def sum_of_load(m):
    """Of all numbers handed over to journal and housing, in no unit: finite where each of them is."""
    j, h = m.o.journal, m.o.housing
    return j.fx + j.fy + j.mz + j.dfx + j.dfy + j.dmz + h.fx + h.fy + h.dfx + h.dfy + j.work + h.work


class _CopyPlaces(NamedTuple):
    """Where the copies of journal and housing are (m)."""

    jx: float
    jy: float
    hx: float
    hy: float


@kernel
def _places(q):
    """`_CopyPlaces` (m) in the state q."""
    return _CopyPlaces(q[JX], q[JY], q[HX], q[HY])


@kernel
def jump_work(m, load, before, after):
    """Work (J) missed where the restart moved the copies from `before` to `after` (`_CopyPlaces`)."""
    s = m.s.seat
    across = (s.jx + load.jx) * (after.jx - before.jx) + (s.jy + load.jy) * (after.jy - before.jy)
    m.o.journal.jump += 0.5 * across
    across = (s.hx + load.hx) * (after.hx - before.hx) + (s.hy + load.hy) * (after.hy - before.hy)
    m.o.housing.jump += 0.5 * across


@kernel
def remember_load(m, load):
    """Keep `load` (`Load`: N, N m) as the last known one."""
    s = m.s.seat
    s.jx, s.jy, s.jm, s.hx, s.hy = load.jx, load.jy, load.jm, load.hx, load.hy


@kernel
def sum_of_inputs(m):
    """Of all inputs that are in use, in no unit: finite where each of them is."""
    j = m.u.journal
    total = j.x + j.y + j.vx + j.vy + j.ax_free + j.ay_free + j.inv_m + j.omega
    total += j.alpha_free + j.inv_I + _sum_of(m.u.housing)
    for k in range(m.s.seat.modes):
        total += _sum_of(j.mode[k])
    return total


@kernel
def _sum_of(z):
    """Of all numbers of a `SprungMotion`, in no unit: finite where each of them is."""
    return z.x + z.y + z.vx + z.vy + z.ax_free + z.ay_free + z.inv_m + z.k_over_m + z.c_over_m


@kernel
def weigh_impulse(m):
    """Have micro-steps resolve the load where no copy moves under it, and so none would show its error.

    Sets the impulse's error weights, 1/(N s).
    """
    if m.p.interface.order < MODEL or m.u.journal.inv_m == 0.0:
        m.weight[JPX] = m.weight[JPY] = 1.0 / IMPULSE_SCALE


PLANAR = Carried(
    parts=PARTS,
    take_inputs=take_inputs,
    clear=clear_gathered,
    rates=copy_rates,
    weigh_impulse=weigh_impulse,
    hand_over=hand_over,
    hand_now=hand_mean,
    handed_over=load_numbers,
    hand_instead=put_load,
    sum_handed=sum_of_load,
    sum_inputs=sum_of_inputs,
    places=_places,
    account_jump=jump_work,
    remember=remember_load,
)


@kernel
def begin(carried, react, report, m):
    """First outputs, from state and inputs; the first restart compares with the load now."""
    take_modes(m)
    carried.weigh_impulse(m)
    load = react(0.0, m.q, np.zeros(m.n), m)
    carried.remember(m, load)
    report(m.q, m)


@kernel
def instant(carried, react, t, q, dq, m):
    """Derivative dq of what is inside and the load now, for a solver that holds all bodies itself.

    The motion comes from m.u; the load (N, N m) goes out as the mean in m.o, its slope zero.
    """
    carried.take_inputs(q, m)
    load = react(t, q, dq, m)
    carried.hand_now(m, load)


@kernel
def integrate(carried, rhs, observe, m, work, span):
    """Advance m.q by `span` (s) in adaptive steps of the error interface.tolerance.

    rhs(t, q, dq, m): derivative dq of the whole state; work: rows of scratch as long as the state.
    Returns (micro-step to try next (s), status, evaluations).
    """
    tolerance = m.p.interface.tolerance
    return dopri.integrate(rhs, observe, m, m.q, carried.parts, m.n, m.weight, work, span, m.h, tolerance)


@kernel
def any_time(m, since):
    """A bearing whose law does not depend on time has nothing to get ready; since: s."""


@kernel
def advance(carried, ready, react, integrate, report, words, m, work, time, step):
    """One macro step of `step` (s) from `time` (s); returns a status.

    words: the bearing's memory, which m is as a record; work: rows of scratch as long as the state.
    ready(m, since) prepares the bearing for the stretch of 2 m.half (s) that begins at m.time, `since` (s)
    after the inputs; `any_time` where there is nothing to prepare.
    """
    status = BAD_INPUT
    if math.isfinite(carried.sum_inputs(m)):
        q = m.q
        m.time = time
        m.half = 0.5 * step
        left = carried.places(q)
        carried.take_inputs(q, m)
        ready(m, 0.0)
        before = react(0.0, q, work[0], m)
        carried.account_jump(m, before, left, carried.places(q))
        carried.remember(m, before)
        carried.rates(0.0, q, work[0], m, m.half, before)
        m.h, status, evaluations = integrate(m, work, step)
        m.evaluations += evaluations
        carried.hand_over(q, m, step)
        carried.remember(m, react(step, q, work[0], m))
        report(q, m)
        if status == OK and m.p.interface.lead == 1:
            kept = words.copy()
            m.time = time + step
            ready(m, step)
            carried.clear(q, m)
            carried.rates(0.0, q, work[0], m, m.half, react(0.0, q, work[0], m))
            _, status, evaluations = integrate(m, work, step)
            carried.hand_over(q, m, step)
            ahead = carried.handed_over(m)
            for i in range(len(words)):  # a slice would bring the texts of refusals into the machine code
                words[i] = kept[i]
            m.evaluations += evaluations
            carried.hand_instead(m, ahead)
        if status == OK and not math.isfinite(carried.sum_handed(m)):
            status = BAD_LOAD
    return status
