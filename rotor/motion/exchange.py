"""What the loads at the stations did over a macro step: their work, and their effect on single modes."""

from __future__ import annotations

from touchdown.modelkit.kernel import kernel
from touchdown.modelkit.ports import MODES
from touchdown.rotor.motion.state import ANGLE, SPIN, WORK, modal, rest
from touchdown.rotor.motion.unbalance import spin_momentum


@kernel
def account(q, m, step, start, area, turned, swept):
    """Add the work (J) of each load over a macro step of `step` (s) to the state q (N,) at its end.

    Mean times displacement, and slope times the first moment of the velocity about the middle: int s v dt
    is half the step times the sum of both ends' displacements, less the area under them. start, area:
    `Planar`, modal coordinates at the start (m kg^0.5) and their integrals over the step. Of the spin,
    displacement and first moment are `turned` (rad) and `swept` (rad s).
    """
    px, py, _, _ = modal(q, m)
    start_x, start_y = start
    area_x, area_y = area
    tail = rest(q, m)
    half = 0.5 * step
    for j in range(m.d.stations):
        u = m.u.station[j]
        if u.fx == 0.0 and u.fy == 0.0 and u.dfx == 0.0 and u.dfy == 0.0 and u.mz == 0.0 and u.dmz == 0.0:
            continue
        x, y, moment_x, moment_y = 0.0, 0.0, 0.0, 0.0
        for k in range(m.d.modes):
            shape = m.d.shape[j, k]
            x += shape * (px[k] - start_x[k])
            y += shape * (py[k] - start_y[k])
            moment_x += shape * (half * (px[k] + start_x[k]) - area_x[k])
            moment_y += shape * (half * (py[k] + start_y[k]) - area_y[k])
        work = u.fx * x + u.fy * y + u.dfx * moment_x + u.dfy * moment_y
        tail[WORK + j] += work + u.mz * turned + u.dmz * swept


@kernel
def take_mode_loads(q, m):
    """Give each mode of q (N,) what mean and slope did not say of the loads.

    Their work is the energy it brings. What they change of the unbalance's momentum is taken from the spin.
    """
    _, _, vx, vy = modal(q, m)
    tail = rest(q, m)
    angle = tail[ANGLE] + m.p.unbalance_angle
    after = spin_momentum(vx, vy, m, angle)
    for j in range(m.d.stations):
        before = after
        for k in range(m.d.modes):
            slot = int(m.d.slot[j, k])
            if slot >= 0 and not (m.d.lumped[j] > 0.0 and slot == MODES - 1):
                tail[WORK + j] += _kick(q, m, j, k, m.u.station[j].mode[slot])
        after = spin_momentum(vx, vy, m, angle)
        change = (before - after) / m.d.inertia
        tail[WORK + j] += 0.5 * change * (before + after)
        tail[SPIN] += change


@kernel
def _kick(q, m, j, k, load):
    """Move mode k by a `ModeLoad` at station j; returns the energy (J) that brings."""
    px, py, vx, vy = modal(q, m)
    shape = m.d.shape[j, k]
    x, y, u, v = shape * load.qx, shape * load.qy, shape * load.px, shape * load.py
    energy = m.d.stiffness[k] * (x * (px[k] + 0.5 * x) + y * (py[k] + 0.5 * y))
    energy += u * (vx[k] + 0.5 * u) + v * (vy[k] + 0.5 * v)
    px[k] += x
    py[k] += y
    vx[k] += u
    vy[k] += v
    return energy
