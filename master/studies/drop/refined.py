"""What runs are measured against where there are no equations to join: the scene's own refinement.

An FMU of others' can only be stepped. So the reference is the same drop in finer and finer macro steps, as
far as two of them agree on it; an error that all steps have in common stays unseen.
"""

from __future__ import annotations

import time as clock
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from touchdown.master.components.contract import SENSED
from touchdown.master.components.library.sources import foreign
from touchdown.master.coupling.connections import Attachment
from touchdown.master.coupling.loop.span import until
from touchdown.master.coupling.observer import Moment, Observer
from touchdown.master.coupling.simulation import opened, simulate
from touchdown.master.coupling.system import System
from touchdown.master.scene.scene import Scene
from touchdown.master.studies.drop.measured import FINE, fine
from touchdown.master.studies.drop.reference import Solve


@dataclass(frozen=True)
class Refined:
    """The drop in macro steps of `step` (s)."""

    step: float

    @property
    def title(self) -> str:
        """For people."""
        return f"its own steps of {1e6 * self.step:g} us"


REFINED = (Refined(0.5 * FINE), Refined(FINE))
"""The reference, and what it must agree with."""


def has_equations(scene: Scene) -> bool:
    """Whether all components are the project's own models, whose equations can be joined."""
    return not any(foreign(spec.fmu) for spec in scene.components.values())


def refine(scene: Scene, seats: Sequence[Attachment], times: np.ndarray, by: Refined) -> Solve:
    """Journals at `times` (s from zero), multiples of the macro step on the simulation's clock.

    Raises TouchdownError where the run stops.
    """
    finely = fine(scene, by.step)
    began = clock.perf_counter()
    with opened(finely, in_process=True) as system:
        kept = _Kept(system, seats, times, by.step)
        outcome = simulate(until(finely, system, float(times[-1])), system, observers=[kept])
    outcome.raise_if_stopped()
    wall = (clock.perf_counter() - began) / outcome.simulated
    return Solve(by, np.array(kept.motion), outcome.steps, wall)


class _Kept(Observer):
    """Keeps the journals' motion at instants."""

    def __init__(self, system: System, seats: Sequence[Attachment], times: np.ndarray, step: float) -> None:
        self.motion: list[list[np.ndarray]] = []
        self._read = [system.reader([a.motion(v) for v in SENSED]) for a in seats]
        self._times, self._half = times, 0.5 * step

    def stepped(self, now: Moment) -> None:
        kept = len(self.motion)
        if kept < len(self._times) and now.since_zero >= self._times[kept] - self._half:
            self.motion.append([read().copy() for read in self._read])
