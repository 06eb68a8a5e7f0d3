"""What drives a whirl, told from the phase of the contact force: evidence beside the orbit.

The bearing presses the journal inwards, and friction turns that force out of the normal. On a journal that
spins, sliding friction points against the spin: it drives a backward whirl and brakes a forward one, which
something else has to keep up, an unbalance for one. Where the journal rolls on the bore, nothing does.
"""

from __future__ import annotations

import math

import numpy as np

from touchdown.master.results.whirl.contacts import PRESSES, Orbit
from touchdown.master.results.whirl.turning import Direction
from touchdown.master.results.whirl.verdict import Episode


def force_phase(
    orbit: Orbit, force: tuple[np.ndarray, np.ndarray], episode: Episode, spin: float
) -> float | None:
    """Angle (rad) by which the force on the journal leads the inward normal, in the sense of the whirl.

    Above 0 it drives the whirl, below 0 it brakes it; atan of the coefficient of friction, at most, where
    friction is all there is. Forces are summed over the whirl, so that large ones count for more. force:
    all that the bearing presses with (N), friction included, x and y, each (rows,); spin as for
    `classify`. The normal is that of a bore about the orbit's own middle, which may stand off the
    bearing's. None where nothing presses.
    """
    part = (orbit.time >= episode.start) & (orbit.time <= episode.end)
    size = np.hypot(*force)
    part &= np.isfinite(orbit.radius) & np.isfinite(size)
    part[part] = size[part] > PRESSES * np.max(size[part], initial=0.0)
    if not part.any():
        return None
    x, y, fx, fy = orbit.x[part], orbit.y[part], force[0][part], force[1][part]
    x, y = (values - 0.5 * (np.min(values) + np.max(values)) for values in (x, y))
    away = np.maximum(np.hypot(x, y), 1e-300)
    inwards = -float(np.sum((fx * x + fy * y) / away))
    counter_clockwise = float(np.sum((fy * x - fx * y) / away))
    forward = episode.direction is Direction.FORWARD
    sense = 1.0 if forward == (spin >= 0.0) else -1.0
    return math.atan2(sense * counter_clockwise, inwards)
