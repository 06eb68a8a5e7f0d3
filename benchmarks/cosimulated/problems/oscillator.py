"""Two masses of 1 kg on springs of 10, 100 and 1000 N/m, shot at each other with 100 m/s."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from cosimulated.problems.coupled import Coupled
from cosimulated.runs import Bond, Tried
from touchdown.validation import bodies

DAMPING = 0.01  # N s/m, where the masses are to come to rest


@dataclass(frozen=True)
class Oscillator(Coupled):
    """`damping`: of each of the three springs (N s/m)."""

    duration: float = 10.0
    damping: float = 0.0

    title = "Two masses on springs, undamped, 10 s"
    giver, taker = "s1", "s2"
    tried = Tried((1e-2, 3e-3, 1e-3), 1e-2, (1e-4, 1e-6, 1e-8), (1e2, 1e1, 1.0))

    def parts(self) -> Mapping[str, bodies.Settings]:
        """The masses."""
        return bodies.oscillator(self.damping)

    def exact(self, times: np.ndarray) -> np.ndarray:
        """By its eigenvalues."""
        return bodies.exact_oscillator(times, self.damping)

    def stored(self, states: np.ndarray) -> np.ndarray:
        """In motion and in springs."""
        return bodies.energy(states)

    def damped(self, step: float) -> Oscillator | None:
        """Over 2000 macro steps, or over 40 s."""
        return replace(self, damping=DAMPING, duration=max(2000.0 * step, 40.0))


@dataclass(frozen=True)
class PositionAlone(Oscillator):
    """The velocity does not come back."""

    title = "The same, only the position comes back"
    tried = Tried((1e-2, 1e-3), 1e-2, (1e-4, 1e-6), ())

    def wires(self) -> Sequence[object]:
        """Without the velocity."""
        return list(super().wires())[:2]

    @property
    def bonds(self) -> tuple[Bond, ...]:
        """No power is exchanged by name."""
        return ()

    def damped(self, step: float) -> None:
        """Not asked again."""


@dataclass(frozen=True)
class VelocityAlone(Oscillator):
    """The position does not come back: the giver integrates the velocity."""

    title = "The same, only the velocity comes back"
    tried = Tried((1e-2, 1e-3), 1e-2, (1e-4, 1e-6), (1e1, 1e-1))

    def parts(self) -> Mapping[str, bodies.Settings]:
        """The giver follows."""
        giver, taker = super().parts().values()
        return {self.giver: {**giver, "follows": 1.0}, self.taker: taker}

    def wires(self) -> Sequence[object]:
        """Without the position."""
        return list(super().wires())[::2]

    def damped(self, step: float) -> None:
        """Not asked again."""
