"""Macro steps that are divided while a rotor is hit by two bearings at once.

A bearing knows in a macro step what its rotor did under the other one in the step before. Where both are
hit, the light rings between journal and balls rattle at tens of kHz, within a macro step: what one bearing
will do in the next step its last load does not tell. So these steps, some per cent of a drop, are divided.
"""

from __future__ import annotations

import math

import numpy as np

from touchdown.master.common.errors import TouchdownError
from touchdown.master.coupling.connections import Attachment
from touchdown.master.coupling.loop.kernels.impacts import SEAT, met
from touchdown.master.coupling.steppers.stepper import Stepper
from touchdown.master.scene.run_spec import RunSpec

LONG_AGO = -1.0  # s
MOST = 100_000  # parts of a macro step; seconds of work


class Impacts:
    """Tells which macro steps are to be divided, and into how many parts."""

    def __init__(self, stepper: Stepper) -> None:
        run, self._system = stepper.run, stepper.system
        able = stepper.any_moment and run.impact_step > 0.0 and self._system.divisible
        attachments = self._system.hit_together if able else ()
        self.parts = _parts(run) if attachments else 1
        if self.parts == 1:
            attachments = ()
        self.seats = np.array(list(map(self._seat, attachments)), SEAT)
        self._attachments, self._signals = attachments, self._system.signals
        self.divided = 0  # macro steps

    def _seat(self, a: Attachment) -> tuple[int, int, float, float]:
        bodies = list(self._system.components)
        return self._reach(a), bodies.index(a.body), LONG_AGO, LONG_AGO

    def _reach(self, a: Attachment) -> int:
        return self._system.position[a.reach]

    def follow(self) -> None:
        """Find the signals where they now stand, components having retired."""
        if self._signals is not self._system.signals:
            self._signals = self._system.signals
            self.seats["reach"] = list(map(self._reach, self._attachments))

    def parts_of(self, time: float, step: float) -> int:
        """Into how many parts the macro step of `step` (s) from `time` (s) is to be divided."""
        if not len(self.seats):  # nor is the kernel fetched, or compiled, for the run's first step
            return 1
        self.follow()
        if not met(self.seats, self._signals, time, step):
            return 1
        self.divided += 1
        return self.parts


def _parts(run: RunSpec) -> int:
    """Into how many a macro step is divided. Raises TouchdownError where they are too many."""
    if run.macro_step > MOST * run.impact_step:
        raise TouchdownError(
            f"run.impact_step = {run.impact_step:g} s divides a macro step of {run.macro_step:g} s into "
            f"more than {MOST} parts; take a longer one, or 0 to have none divided"
        )
    return max(1, math.ceil(run.macro_step / run.impact_step - 1e-6))
