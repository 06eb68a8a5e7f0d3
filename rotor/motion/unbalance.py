"""The modal unbalance U, fixed in the rotor, kg^0.5 m per mode: U exp(i theta) in the fixed frame."""

from __future__ import annotations

import math

from touchdown.modelkit.kernel import kernel


@kernel
def unbalance_of(m, k, cosine, sine):
    """Unbalance (x, y) of mode k in the fixed frame, kg^0.5 m; cosine and sine of the rotor's angle."""
    own = m.d.unbalance
    ux, uy = m.p.unbalance_scale * own.x[k], m.p.unbalance_scale * own.y[k]
    return ux * cosine - uy * sine, ux * sine + uy * cosine


@kernel
def spin_momentum(vx, vy, m, angle):
    """Angular momentum (N m s) that the modal velocities (n,) give the unbalance at `angle` (rad).

    Re sum v conj(i U exp(i angle)).
    """
    if not m.d.unbalance.present:
        return 0.0
    cosine, sine = math.cos(angle), math.sin(angle)
    total = 0.0
    for k in range(m.d.modes):
        ux, uy = unbalance_of(m, k, cosine, sine)
        total += vy[k] * ux - vx[k] * uy
    return total
