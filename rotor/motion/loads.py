"""What the loads at the stations, linear in time over a macro step, do to the modes and to the spin."""

from __future__ import annotations

from touchdown.modelkit.kernel import kernel
from touchdown.rotor.drag import drag


@kernel
def moment(m, since_middle):
    """Torque (N m) of all loads, `since_middle` (s) after the middle of the macro step."""
    total = 0.0
    for j in range(m.d.stations):
        load = m.u.station[j]
        total += load.mz + load.dmz * since_middle
    return total


@kernel
def spin_up(m, since_middle, spin):
    """Spin acceleration (rad/s2) by loads and drag at `spin` (rad/s), without the unbalance's reaction."""
    return (moment(m, since_middle) - drag(spin, m.p)) / m.d.inertia


@kernel
def modal_forces(m, since_middle, fx, fy):
    """Modal forces of loads and gravity into fx, fy (n,), N/kg^0.5, `since_middle` (s) after the middle."""
    for k in range(m.d.modes):
        fx[k] = 0.0
        fy[k] = -m.p.gravity * m.d.weight[k]
    for j in range(m.d.stations):
        load = m.u.station[j]
        _add(m, j, load.fx + load.dfx * since_middle, load.fy + load.dfy * since_middle, fx, fy)


@kernel
def modal_force_rates(m, dfx, dfy):
    """Their rates into dfx, dfy (n,), N/(kg^0.5 s), the same throughout the macro step."""
    for k in range(m.d.modes):
        dfx[k] = 0.0
        dfy[k] = 0.0
    for j in range(m.d.stations):
        load = m.u.station[j]
        _add(m, j, load.dfx, load.dfy, dfx, dfy)


@kernel
def _add(m, j, x, y, fx, fy):
    """Add a force (x, y) at station j, in N or N/s, to modal ones (n,)."""
    if x != 0.0 or y != 0.0:
        for k in range(m.d.modes):
            fx[k] += m.d.shape[j, k] * x
            fy[k] += m.d.shape[j, k] * y
