"""The energy ledger: what crosses a connection must be the same seen from both sides.

Each side states the work of its load on its own idea of the body's motion. The bearing also states, as
`jump`, half the sum of the loads before and after times the jump of its copy at each restart. Per macro
step n the residual is

    r_n = dW_bearing(n) + dJ(n + 1) - dW_body(n)

and what is reported is the sum of all |r_n| over all connections, over the scene's energy scale (the
energy lost by falling, m g c). It is a live estimate of the coupling's error.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from touchdown.master.common.ended import Ended
from touchdown.master.components.contract import JUMP, WORK
from touchdown.master.coupling.connections import Attachment
from touchdown.master.coupling.observer import Moment, Observer
from touchdown.master.coupling.system import System
from touchdown.master.scene.run_spec import RunSpec
from touchdown.master.scene.step_sizes import shorter_step


@dataclass(slots=True)
class Entry:
    """One connection's account."""

    attachment: Attachment
    every: int = 1  # macro steps after which both sides have taken the same time
    by_bearing: float = 0.0  # J, work that the bearing last stated
    jumps: float = 0.0  # J, its jumps
    by_body: float = 0.0  # J, work that the body last stated
    pending: float = 0.0  # work difference of the last step, its jump not yet known
    total: float = 0.0  # sum of |r_n|, J
    net: float = 0.0  # sum of r_n, J


class Ledger(Observer):
    """Accounts of all connections that state work on both sides."""

    def __init__(self, system: System, scale: float) -> None:
        self.scale = scale  # J; 0: unknown, residuals are then absolute
        self.total = 0.0  # J, sum of |r_n| over all connections and steps
        self.entries = [
            Entry(a, math.lcm(system.every[a.bearing], system.every[a.body])) for a in system.attachments
        ]
        self._system = system
        self.retired(())

    def retired(self, names: Sequence[str]) -> None:
        """Find the accounts where they now stand in the system's signals; those of the retired rest."""
        position = self._system.position
        self._signals = self._system.signals
        self._live: list[Entry] = []
        places: list[int] = []
        for entry in self.entries:
            a = entry.attachment
            stated = (a.bearing_end.full(WORK), a.bearing_end.full(JUMP), a.body_end.full(WORK))
            if all(name in position for name in stated):
                self._live.append(entry)
                places += [position[name] for name in stated]
        self._places = np.array(places, dtype=np.intp)

    def stepped(self, now: Moment) -> None:
        """Book the macro step that was just taken."""
        stated = iter(self._signals[self._places].tolist())
        for entry, by_bearing, jumps, by_body in zip(self._live, stated, stated, stated, strict=True):
            if now.done % entry.every:
                continue
            residual = entry.pending + (jumps - entry.jumps)
            entry.total += abs(residual)
            self.total += abs(residual)
            entry.net += residual
            entry.pending = (by_bearing - entry.by_bearing) - (by_body - entry.by_body)
            entry.by_bearing, entry.jumps, entry.by_body = by_bearing, jumps, by_body

    @property
    def residual(self) -> float:
        """Sum of |r_n| over all connections and steps, over the energy scale (or in J without one)."""
        return self.total / self.scale if self.scale > 0.0 else self.total

    def worst(self) -> Entry | None:
        """The connection with the largest residual."""
        return max(self.entries, key=lambda entry: entry.total, default=None)


class Judge(Observer):
    """Warns, then ends the run, where the coupling makes or loses too much energy."""

    def __init__(self, ledger: Ledger, run: RunSpec) -> None:
        self.warned_at: float | None = None  # s from zero, where the ledger passed the warning threshold
        self._ledger, self._run = ledger, run
        self._limit = run.warn_residual * ledger.scale if ledger.scale > 0.0 else math.inf  # J

    def stepped(self, now: Moment) -> None:
        if self._ledger.total <= self._limit:
            return
        now.keep()  # what is not a number is over every limit
        if self._ledger.residual <= self._run.stop_residual:
            self.warned_at = now.since_zero
            self._limit = self._run.stop_residual * self._ledger.scale
        else:
            now.stop(self._verdict(now.since_zero), Ended.STOPPED)

    def _verdict(self, time: float) -> str:
        worst, residual = self._ledger.worst(), self._ledger.residual
        name = worst.attachment.title if worst else "the system"
        return (
            f"the energy ledger of {name} is off by {residual:.2g} of the energy lost by falling at "
            f"t = {time:.6g} s; {remedy(self._run, residual)}"
        )


def remedy(run: RunSpec, residual: float) -> str:
    """What to change where the ledger is off by `residual` (over the energy scale)."""
    if run.scheme.error_order == 0:
        smaller = 0.1 * run.tolerance
        return f"the tolerance of {run.tolerance:g} m is too large, try --set run.tolerance={smaller:g}"
    return (
        f"the macro step of {run.macro_step:g} s is too long for scheme {run.scheme.name}, "
        f"try --macro-step {shorter_step(run, residual):g}"
    )
