"""A step repeated until the motion that each bond was told to come to is where it comes to.

The unknown is where the motion of all bonds ends, u; one sweep of all components gives where it comes to,
g(u). From r = g(u) - u the next is u + K r, where K is about (I - dg/du)^-1: found by sweeps from ends that
are moved a little, one after the other, and improved by every repetition (Broyden's good update).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from touchdown.master.common.errors import TouchdownError
from touchdown.master.coupling.bonds.crossing import Crossing
from touchdown.master.coupling.steppers.bonded import Bonded
from touchdown.master.coupling.steppers.checkpoint import Checkpoint, require_any_step
from touchdown.master.coupling.steppers.iterated import MOST, TINY, Iterated
from touchdown.master.coupling.system import System
from touchdown.master.scene.run_spec import RunSpec

LEAST = 1e-9  # m; ends are moved by what they are off, and at least by so much
AGAIN = MOST // 2  # repetitions after which K is found anew


class IteratedBonds(Iterated):
    """Repeats each step until the ends of all bonds stay; a velocity counts by what it moves in it."""

    def __init__(self, system: System, run: RunSpec) -> None:
        if system.attachments:
            raise TouchdownError(
                f"scheme {run.scheme.name} repeats for bearings or for bonds, not for both: with "
                f"{system.attachments[0].title} and {system.bonds[0].title} choose interface or halving"
            )
        self._bonded = Bonded(system, run)
        self._gains: np.ndarray | None = None  # K
        if self._bonded.way.held:
            raise TouchdownError(
                f"scheme {run.scheme.name} repeats steps until motion that is told ahead is right, and "
                f"{system.bonds[0].title} crosses by {self._bonded.way.name}, which tells none; choose "
                "run.bonds = contact or smooth, or scheme hold"
            )
        super().__init__(system, run)
        require_any_step(system, run.scheme.name)

    def follow(self) -> None:
        self._bonded.follow()

    @property
    def crossings(self) -> Sequence[Crossing]:
        return self._bonded.crossings

    def step(self, number: int, time: float, step: float) -> None:
        if self._bonded.ramped:
            super().step(number, time, step)
        else:  # there is no past to tell anything from
            self._bonded.step(number, time, step)

    def _checkpoint(self) -> Checkpoint:
        return Checkpoint(self.system, self._bonded)

    def _converge(self, before: Checkpoint, time: float, step: float) -> float:
        """Repeat the step from where the motion leads by itself; returns how far its end is off (m)."""
        self._steps += 1
        bonded = self._bonded
        sizes = np.array([size for c in bonded.live for size in c.sizes(step)])
        end = np.concatenate(bonded.told_ends(time, step)) * sizes

        def off_from(end: np.ndarray) -> np.ndarray:
            before.restore()
            return self._sweep(time, step, end / sizes) * sizes - end

        off = off_from(end)
        for repetition in range(1, MOST):
            change = float(np.max(np.abs(off)))
            if change <= self.run.tolerance or not np.isfinite(change):
                return change
            if self._gains is None or repetition == AGAIN:
                self._gains = _gains(off_from, end, off)
            moved = self._gains @ off
            end = end + moved
            came = off_from(end)
            self._gains, off = _improved(self._gains, moved, came - off), came
        return float(np.max(np.abs(off)))

    def _sweep(self, time: float, step: float, end: np.ndarray) -> np.ndarray:
        """The step with the motion told to end there; returns where it ended."""
        self._repeated += 1
        self._bonded.sweep(time, step, end)
        return np.concatenate([c.here for c in self._bonded.live])


def _gains(off_from: Callable[[np.ndarray], np.ndarray], end: np.ndarray, off: np.ndarray) -> np.ndarray:
    """K at `end`, where the sweep is `off` (m)."""
    size = max(float(np.max(np.abs(off))), LEAST)
    turned = np.array([(off_from(end + size * unit) - off) / size for unit in np.eye(len(end))]).T
    if not np.isfinite(turned).all():  # the step will not converge, and be divided
        return np.eye(len(end))
    return -np.linalg.pinv(turned)


def _improved(gains: np.ndarray, moved: np.ndarray, turned: np.ndarray) -> np.ndarray:
    """K such that it says what came of the last repetition: off `turned` as the ends were `moved`."""
    along = moved @ gains
    share = float(along @ turned)
    if abs(share) <= TINY:
        return gains
    return gains - np.outer(moved + gains @ turned, along) / share
