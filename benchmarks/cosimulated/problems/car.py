"""A quarter car: 400 and 40 kg, 15 000 N/m and 1000 N s/m between them, 150 000 N/m to a road that rises
by 0.1 m at t = 0."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from cosimulated.problems.coupled import Coupled
from cosimulated.runs import Motion, Tried
from touchdown.validation import bodies

RISE = 0.1  # m


@dataclass(frozen=True)
class Car(Coupled):
    """The chassis gives force, the wheel takes it."""

    duration: float = 2.0

    title = "Quarter car over a step of 0.1 m, 2 s"
    giver, taker = "chassis", "wheel"
    tried = Tried(
        (8e-3, 4e-3, 2e-3, 1e-3, 5e-4, 2e-4), 8e-3, (1e-5, 1e-7, 1e-9), (1.0, 0.1, 1e-2, 1e-3, 1e-4)
    )

    def parts(self) -> Mapping[str, bodies.Settings]:
        """Chassis and wheel."""
        return bodies.CAR

    def exact(self, times: np.ndarray) -> np.ndarray:
        """By its eigenvalues."""
        return bodies.exact_car(times)

    def stored(self, states: np.ndarray) -> np.ndarray:
        """In motion and in springs, over what it comes to."""
        chassis, chassis_v, wheel, wheel_v = states.T
        moving = 400.0 * chassis_v**2 + 40.0 * wheel_v**2
        return 0.5 * (moving + 15000.0 * (chassis - wheel) ** 2 + 150000.0 * (wheel - RISE) ** 2)

    def energy(self, motion: Motion) -> float:
        """The largest difference there is on the way: at the end nothing is left."""
        full, *due = self.stored(self.exact(np.append(0.0, motion.rows[:, 4])))
        change = (self.stored(motion.rows[:, :4]) - due) / full
        return float(change[np.argmax(np.abs(change))])
