"""The gyroscopic coupling of the modes by the modal polar matrix G (n, n), polar inertia per length.

v' = i Omega G v turns the velocities v of the principal axes of G: with G = Q diag(g) Q^T, those of
Q^T v by the angles g_k int Omega dt.
"""

from __future__ import annotations

import math

from touchdown.modelkit.kernel import kernel
from touchdown.rotor.motion.state import modal


@kernel
def polar_product(m, k, x, y):
    """Component k of G x and of G y, x and y (n,); in their unit."""
    gx, gy = 0.0, 0.0
    for i in range(m.d.modes):
        gx += m.d.gyroscopic.polar[k, i] * x[i]
        gy += m.d.gyroscopic.polar[k, i] * y[i]
    return gx, gy


@kernel
def turn_velocities(vx, vy, angle, m, spare_x, spare_y):
    """v <- exp(i angle G) v in place, v (n,) in any unit, angle (rad) that of the rotor; spare: (n,)."""
    n, axes = m.d.modes, m.d.gyroscopic.turn
    for k in range(n):
        along_x, along_y = 0.0, 0.0  # the principal axis
        for i in range(n):
            along_x += axes[k, i] * vx[i]
            along_y += axes[k, i] * vy[i]
        turned = angle * m.d.gyroscopic.principal[k]
        cosine, sine = math.cos(turned), math.sin(turned)
        spare_x[k] = along_x * cosine - along_y * sine
        spare_y[k] = along_x * sine + along_y * cosine
    for i in range(n):
        vx[i], vy[i] = 0.0, 0.0
    for k in range(n):
        for i in range(n):
            vx[i] += axes[k, i] * spare_x[k]
            vy[i] += axes[k, i] * spare_y[k]


@kernel
def add_spin_up(q, m, alpha, fx, fy):
    """Add i alpha G p to modal forces fx, fy (n,), N/kg^0.5; alpha: spin acceleration (rad/s2)."""
    px, py, _, _ = modal(q, m)
    for k in range(m.d.modes):
        gx, gy = polar_product(m, k, px, py)
        fx[k] -= alpha * gy
        fy[k] += alpha * gx
