"""What the problems on FMUs of validation/body.c share."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar

import numpy as np

from cosimulated.runs import Bond, Motion, Tried
from touchdown.master.scene.scene import Scene
from touchdown.validation import bodies

UNSTOPPED = {"stop_residual": 1e9}  # what makes energy is to be seen


@dataclass(frozen=True)
class Coupled(ABC):
    """Two bodies, one of which gives force. Errors are told at the time that the FMUs have lived."""

    fmu: Path
    duration: float  # s

    title: ClassVar[str]
    giver: ClassVar[str]
    taker: ClassVar[str]
    tried: ClassVar[Tried]
    packed: ClassVar[str] = "jacobi-hold"
    ways: ClassVar[Mapping[str, Mapping[str, object]]] = {
        "hold": {"scheme": "hold", **UNSTOPPED},
        "jacobi-hold": {"scheme": "jacobi-hold", **UNSTOPPED},
        "smooth": {"bonds": "smooth", **UNSTOPPED},
        "contact": {"bonds": "contact", **UNSTOPPED},
        "iterated": {"scheme": "iterated"},
        "halving": {"scheme": "halving"},
    }

    @property
    def watched(self) -> tuple[str, ...]:
        """Motion of both, and the time."""
        motion = (f"{name}.{what}" for name in (self.giver, self.taker) for what in "xv")
        return (*motion, f"{self.giver}.elapsed")

    @property
    def bonds(self) -> tuple[Bond, ...]:
        """The one there is."""
        return (((self.taker, "v", "f_in"), (self.giver, "f", "v2")),)

    @abstractmethod
    def parts(self) -> Mapping[str, bodies.Settings]:
        """The bodies."""

    @abstractmethod
    def exact(self, times: np.ndarray) -> np.ndarray:
        """(x, v) of giver and taker at `times` (s), a row each."""

    @abstractmethod
    def stored(self, states: np.ndarray) -> np.ndarray:
        """Energy (J) of such rows."""

    def scene(self, run: Mapping[str, object]) -> Scene:
        """The system, to be run as [run] of a scene says."""
        return bodies.scene(self.fmu, self.parts(), self.wires(), run={"duration": self.duration, **run})

    def wires(self) -> Sequence[object]:
        """Force there, motion back."""
        a, b = self.giver, self.taker
        return [f"{a}.f", f"{b}.f_in"], [f"{b}.x", f"{a}.x2"], [f"{b}.v", f"{a}.v2"]

    def error(self, motion: Motion) -> float:
        """Of the positions."""
        if motion.ended:
            return float("inf")
        off = motion.rows[:, :4] - self.exact(motion.rows[:, 4])
        return float(np.max(np.abs(off[:, ::2])))

    def energy(self, motion: Motion) -> float | None:
        """What there is at the end beyond what there should be, over what there was."""
        start, end = self.exact(np.array([0.0, motion.rows[-1, 4]]))
        full, due, found = self.stored(np.array([start, end, motion.rows[-1, :4]]))
        return float((found - due) / full)

    def damped(self, step: float) -> Coupled | None:
        """None where nothing damps it."""
        return None

    def rests(self, motion: Motion) -> bool:
        """Whether the energy is less in the run's second half than in its first."""
        first, second = np.array_split(self.stored(motion.rows[:, :4]), 2)
        if motion.ended or not np.all(np.isfinite(second)):
            return False
        return float(np.max(second)) < float(np.max(first))
