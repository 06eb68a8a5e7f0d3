"""Steps taken whole and in two halves: where they differ by more than the tolerance, they are divided.

The difference of where the bodies end is the estimate of the coupling's error over the step, and what is
kept is the finer result. A macro step starts with the division that the one before needed.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...common.errors import TouchdownError
from ...components.component import POSITION
from ...scene.run_spec import RunSpec
from ..bonds.exchange import BondExchange
from ..snapshot import Saved
from ..system import System
from .bonded import Bonded
from .gauss_seidel import GaussSeidel
from .stepper import Checkpoint, Stepper, require_any_step, require_states

MAX_HALVINGS = 12  # halvings of a macro step
DOUBLING_SHARE = (
    1.0 / 32.0
)  # of the tolerance; below it twice the step will do (third order, with a margin)


class Halving(Stepper):
    """Takes every step twice, and divides it where that is needed."""

    KEPT = ("_level", "_deepest", "_error")

    def __init__(self, system: System, run: RunSpec) -> None:
        super().__init__(system, run)
        require_states(system, run.scheme.name)
        if system.bonds:
            require_any_step(system, run.scheme.name)
        self._inner = Bonded(system, run) if system.bonds else GaussSeidel(system, run)
        self._level = 0  # halvings at the end of the last macro step
        self._deepest = 0
        self._error = 0.0  # m, largest estimate of what was kept
        self.follow()

    def follow(self) -> None:
        self._inner.follow()
        self._places, self._rates = _watched(self.system)

    def step(self, number: int, time: float, step: float) -> None:
        parts = 2**self._level
        deepest, worst = self._level, 0.0
        for part in range(parts):
            level, error = self._advance(time + part * step / parts, step / parts, self._level)
            deepest, worst = max(deepest, level), max(worst, error)
        self._error = max(self._error, worst)
        self._deepest = max(self._deepest, deepest)
        easy = deepest > 0 and worst < DOUBLING_SHARE * self.run.tolerance
        self._level = deepest - 1 if easy else deepest

    def _advance(self, time: float, step: float, level: int) -> tuple[int, float]:
        """Take a step, divided as needed: (halvings of the macro step, largest error estimate in m)."""
        with Checkpoint(self.system, self._inner) as before:
            self._inner.step(0, time, step)
            whole = self.system.signals[self._places]
            before.restore()
            self._inner.step(0, time, 0.5 * step)
            self._inner.step(0, time + 0.5 * step, 0.5 * step)
            apart = np.abs(self.system.signals[self._places] - whole)
            error = float(np.max(np.where(self._rates, step, 1.0) * apart, initial=0.0))
            if error <= self.run.tolerance:
                return level, error
            if level == MAX_HALVINGS:
                raise TouchdownError(
                    f"steps of {step:g} s and its half still differ by {error:.2g} m at t = {time:.9g} s; "
                    f"take a larger run.tolerance than {self.run.tolerance:g} m, or a smaller macro step"
                )
            before.restore()
        first = self._advance(time, 0.5 * step, level + 1)
        second = self._advance(time + 0.5 * step, 0.5 * step, level + 1)
        return max(first[0], second[0]), max(first[1], second[1])

    def save(self) -> Saved:
        return super().save() | {"inner": self._inner.save()}

    def load(self, saved: Saved) -> None:
        super().load(saved)
        self._inner.load(saved["inner"])

    @property
    def crossings(self) -> Sequence[BondExchange]:
        return self._inner.crossings

    @property
    def figures(self) -> dict[str, float]:
        return {
            "shortest_macro_step": self.run.macro_step / 2**self._deepest,
            "largest_step_error": self._error,
        }


def _watched(system: System) -> tuple[np.ndarray, np.ndarray]:
    """Where the bodies' motion at bearings and bonds stands in the signals, and which of it is velocity."""
    seats = {a.motion(axis): False for a in system.attachments for axis in POSITION}
    bonds = {c.source_name: c is b.velocity for b in system.bonds for c in b.motion}
    kinds = {system.position[n]: rate for n, rate in {**seats, **bonds}.items() if n in system.position}
    places = sorted(kinds)
    return np.array(places, dtype=np.intp), np.array([kinds[place] for place in places], dtype=bool)
