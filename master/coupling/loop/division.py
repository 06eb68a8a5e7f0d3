"""Macro steps that are divided: two bearings hit at once, or a whirl that makes energy.

A bearing knows in a macro step what its rotor did under the other one in the step before. Where both are
hit, the light rings between journal and balls rattle at tens of kHz, within a macro step: what one bearing
will do in the next step its last load does not tell. So these steps, some per cent of a drop, are divided.

In a whirl the journal is pressed hard against its ring all the time, and turns over in milliseconds what a
drop turns over once. What the coupling makes of that grows with a power of the macro step, the order of the
scheme, so halving it a few times takes it away. A landing turns over up to 5 m g c within `WINDOW_S`;
more than `WHIRL_TURNOVER` is a whirl.
"""

from __future__ import annotations

import math

import numpy as np

from ...common.errors import TouchdownError
from ...scene.run_spec import RunSpec
from ..connections import Attachment
from ..ledger.accounts import Ledger
from ..observer import Observer, RunState
from ..snapshot import Kept
from ..steppers.stepper import Stepper
from .kernels.signal_exchange import SEAT, met

NO_CONTACT_TIME = -1.0  # s
MAX_PARTS = 100_000  # parts of a macro step; seconds of work


class ImpactSubsteps(Kept):
    """Tells which macro steps are to be divided, and into how many parts."""

    KEPT = ("divided", "seats")

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
        return self._reach(a), bodies.index(a.body), NO_CONTACT_TIME, NO_CONTACT_TIME

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
    if run.macro_step > MAX_PARTS * run.impact_step:
        raise TouchdownError(
            f"run.impact_step = {run.impact_step:g} s divides a macro step of {run.macro_step:g} s into "
            f"more than {MAX_PARTS} parts; take a longer one, or 0 to have none divided"
        )
    return max(1, math.ceil(run.macro_step / run.impact_step - 1e-6))


WINDOW_S = 5e-3  # s, over which is looked back
WHIRL_TURNOVER = 8.0  # m g c, turned over in a window
WHIRL_END_TURNOVER = 4.0  # m g c; where less is turned over the whirl has ended
TARGET_ENERGY_MADE = 1e-4  # energy made in a window, over what was turned over


class WhirlStepControl(Observer):
    """Halves the macro steps, window by window, until a whirl makes little energy; whole ones after it."""

    KEPT = ("halvings", "_taken", "_last_step", "_since", "_turned", "_made")

    def __init__(self, ledger: Ledger, stepper: Stepper) -> None:
        run, system = stepper.run, stepper.system
        able = stepper.any_step and ledger.fall > 0.0 and system.divisible
        self.halvings = 0  # of the macro step to come
        self._most = run.whirl_halvings if able else 0
        self._order = max(run.scheme.error_order, 1)
        self.ledger, self._step = ledger, run.macro_step
        self._taken = [0] * (run.whirl_halvings + 1)  # divided macro steps, by halvings
        self._last_step = 0  # the last macro step it knows of
        self._start = self._since = system.start  # s, the run's begin, and the window's
        self._turned = self._made = 0.0  # J, at the window's begin

    def stepped(self, state: RunState) -> None:
        if self._most == 0:
            return
        self._count(state)
        if state.time - self._since >= WINDOW_S:
            self._look_back(state.time)

    def due(self, state: RunState) -> int:
        """At the end of the window."""
        if self._most == 0:
            return state.steps
        done = max(state.done + 1, int((self._since - self._start + WINDOW_S) / self._step) - 1)
        while self._start + done * self._step - self._since < WINDOW_S:
            done += 1
        return done

    def _count(self, state: RunState) -> None:
        """Count the macro steps taken since it was told last, all alike."""
        if self.halvings:
            self._taken[self.halvings] += state.done - self._last_step
        self._last_step = state.done

    def _look_back(self, time: float) -> None:
        ledger = self.ledger
        turned, energy_made = ledger.turned - self._turned, abs(ledger.made - self._made)
        self._since, self._turned, self._made = time, ledger.turned, ledger.made
        if turned < WHIRL_END_TURNOVER * ledger.fall:
            self.halvings = 0
        elif turned > WHIRL_TURNOVER * ledger.fall and energy_made > TARGET_ENERGY_MADE * turned:
            more = math.ceil(math.log2(energy_made / (TARGET_ENERGY_MADE * turned)) / self._order)
            self.halvings = min(self.halvings + more, self._most)

    def times(self, state: RunState) -> dict[float, float]:
        """How long (s) the run took which shorter step (s), up to now."""
        self._count(state)
        return {
            self._step / 2**halvings: taken * self._step
            for halvings, taken in enumerate(self._taken)
            if taken
        }
