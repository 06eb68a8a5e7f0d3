"""What brakes the spin of any rotor: a constant torque and one in proportion to the spin speed."""

from __future__ import annotations

import math

from touchdown.modelkit.kernel import kernel

DRAG_SPEED = 0.1  # rad/s; below it the constant torque fades, so that it cannot reverse the spin


@kernel
def drag(spin, p):
    """Torque (N m) against the spin (rad/s); p: parameters `drag` (N m) and `viscous_drag` (N m s/rad)."""
    return p.drag * math.tanh(spin / DRAG_SPEED) + p.viscous_drag * spin
