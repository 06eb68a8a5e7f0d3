"""Whether a rotor is hit at two places at once, from what its bearings say of the contact to come."""

# pyright: basic

from __future__ import annotations

import numpy as np

from touchdown.master.coupling.loop.kernels import kernel
from touchdown.modelkit.ports import PARTED

LASTS = 2.5e-4  # s, from the touch; by then ring and journal have met hardest, and the ring's rattle fades
AHEAD = 2.0  # steps; within one, the other bearing may turn a journal to its ring

SEAT = np.dtype(
    [
        ("reach", "i8"),  # place in the signals: time (s) until its journal touches
        ("body", "i8"),  # whose journal it is
        ("near", "f8"),  # s, the last step in which the journal touched, or was about to
        ("since", "f8"),  # s, when that impact began
    ]
)


@kernel
def met(seats: np.ndarray, signals: np.ndarray, time: float, step: float) -> bool:
    """Whether two bearings hit a body in the step of `step` (s) from `time` (s), one of them newly."""
    for i in range(len(seats)):
        s = seats[i]
        if signals[s.reach] <= AHEAD * step:
            if time - s.near > PARTED:
                s.since = time
            s.near = time
    for i in range(len(seats)):
        for k in range(i):
            a, b = seats[i], seats[k]
            touching = time - min(a.near, b.near) <= PARTED
            if a.body == b.body and touching and time - max(a.since, b.since) < LASTS:
                return True
    return False
