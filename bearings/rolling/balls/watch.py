"""The balls as a whole while the bearing runs: what they do to a race, and the largest of their loads."""

from __future__ import annotations

from typing import NamedTuple

from touchdown.bearings.contact.peaks import Largest, watch_peaks
from touchdown.modelkit.kernel import kernel


class Total(NamedTuple):
    """What all balls do to a race."""

    fx: float  # N
    fy: float
    moment: float  # N m, about its centre
    loss: float  # W, heat


@kernel
def largest(force, indentation, count, rows):
    """`Largest` (N on one of those side by side, m) of the contacts of `count` balls in `rows`.

    force, indentation: of each ball, or of those side by side (N, m).
    """
    most, depth, loaded, deepest = 0.0, 0.0, 0, 0
    for b in range(count):
        if force[b] > most:
            most, loaded = force[b], b
        if indentation[b] > depth:
            depth, deepest = indentation[b], b
    return Largest(most / rows, depth, loaded, deepest)


@kernel
def watch_balls(time, now, m):
    """Keep the peaks of the balls' forces (N) and of the rings' approach (m), after a micro-step.

    now: `Largest`, at `time` (s).
    """
    force = watch_peaks(time, now, m.o.balls, m.s.ball_peaks)
    if force > m.o.balls.first_impact_force and m.o.contact.first_time >= 0.0 and m.s.contact.over == 0.0:
        m.o.balls.first_impact_force = force
