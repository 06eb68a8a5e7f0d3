"""A macro step of the rotor, divided into strides.

In a stride the gyroscopic coupling turns the velocities (exactly, in the principal axes of G) for half of
it, each mode swings alone (exactly, under a load linear in time) for the whole of it, and the velocities
are turned for another half: Strang splitting, of second order in the stride. Stable for every mode,
however fast.
"""

from __future__ import annotations

import math

from touchdown.modelkit.kernel import kernel
from touchdown.rotor.drag import drag
from touchdown.rotor.motion import stress_report
from touchdown.rotor.motion.equations import accelerate
from touchdown.rotor.motion.exchange import account
from touchdown.rotor.motion.gyroscopics import add_spin_up, turn_velocities
from touchdown.rotor.motion.loads import modal_force_rates, modal_forces, moment, spin_up
from touchdown.rotor.motion.state import ANGLE, LOSS, SPIN, modal, planar, rest
from touchdown.rotor.motion.swing import LinearLoad, prepare_stride, swing
from touchdown.rotor.motion.unbalance import spin_momentum


@kernel
def advance(q, m, step, longest, work):
    """Advance the state q (N,) in place by a macro step of `step` (s), in strides of at most `longest` (s).

    work: scratch, at least seven rows of N. Stresses are looked at after every stride but the last, whose
    end the loads may yet correct.
    """
    now, tail = modal(q, m), rest(q, m)
    strides = max(1, math.ceil(step / longest - 1e-9))
    h = step / strides
    prepare_stride(m, h)
    mean, slope = planar(work[0], m), planar(work[1], m)
    start, area, spare = planar(work[2], m), planar(work[3], m), planar(work[4], m)
    load = LinearLoad(mean.x, mean.y, slope.x, slope.y)
    modal_forces(m, 0.0, load.fx, load.fy)
    modal_force_rates(m, load.dfx, load.dfy)
    # i alpha G p is all but constant over a macro step
    add_spin_up(q, m, spin_up(m, 0.0, tail[SPIN]), load.fx, load.fy)
    for k in range(m.d.modes):  # assigned by slices, this takes numba seconds to compile
        start.x[k], start.y[k], area.x[k], area.y[k] = now.px[k], now.py[k], 0.0, 0.0
    angle, swept = tail[ANGLE], 0.0
    reaction = 0.0  # spin acceleration by the unbalance's reaction, as it was in the stride before
    if m.d.unbalance.present:
        reaction = accelerate(q, m, -0.5 * step, spare.x, spare.y) - spin_up(m, -0.5 * step, tail[SPIN])
    for i in range(strides):
        since_middle = (i + 0.5) * h - 0.5 * step
        turned, reaction = _stride(q, m, since_middle, h, load, reaction, area, spare)
        swept += since_middle * turned
        if m.p.stress.active and i + 1 < strides:
            stress_report.look(q, m, since_middle + 0.5 * h, work[5:7])
    account(q, m, step, start, area, tail[ANGLE] - angle, swept)


@kernel
def _stride(q, m, since_middle, h, load, reaction, area, spare):
    """One stride of h (s) about `since_middle` (s) under a `LinearLoad`; area, spare: `Planar`.

    reaction: spin acceleration (rad/s2) by the unbalance, as it was before. Returns (the angle the rotor
    turned by (rad), that acceleration as it is now).
    """
    _, _, vx, vy = modal(q, m)
    tail = rest(q, m)
    spin = tail[SPIN]
    braking = drag(spin, m.p)
    torque = moment(m, since_middle) - braking
    alpha = torque / m.d.inertia + reaction
    middle = tail[ANGLE] + m.p.unbalance_angle + 0.5 * h * spin
    before = spin_momentum(vx, vy, m, middle)
    turn_velocities(vx, vy, 0.5 * h * spin, m, spare.x, spare.y)
    tail[LOSS] += swing(q, m, load, since_middle, h, alpha, area)
    turn_velocities(vx, vy, 0.5 * h * (spin + alpha * h), m, spare.x, spare.y)
    change = (torque * h - spin_momentum(vx, vy, m, middle) + before) / m.d.inertia
    turned = h * (spin + 0.5 * change)
    tail[LOSS] += braking * turned
    tail[ANGLE] += turned
    tail[SPIN] += change
    return turned, (change - torque * h / m.d.inertia) / h
