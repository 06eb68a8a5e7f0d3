"""A rotor in bearings for Python: its damped modes and critical speeds, from springs or from a scene."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from touchdown.master.studies.rotor.held_table import RPM
from touchdown.rotor.modal.campbell import Held
from touchdown.rotor.modal.whirl import log_decrements

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import FigureBase


class InBearings:
    """Modes of a rotor in bearings at a speed (M), by their size, without those that hardly swing."""

    def __init__(self, held: Held, title: str) -> None:
        self.title, self._held = title, held
        self.roots: np.ndarray = held.whirl.roots[held.swinging]
        """Complex eigenvalues (M,), 1/s, imaginary part positive."""
        self.senses: np.ndarray = held.whirl.sense[held.swinging]
        """1 circular whirl with the spin, -1 against it, 0 in a plane (M,)."""
        self.stable: bool = held.whirl.stable
        """Whether nothing grows."""

    @property
    def speed(self) -> float:
        """Spin speed (rad/s)."""
        return self._held.speed

    @property
    def frequencies(self) -> np.ndarray:
        """Damped (M,), Hz."""
        return self._held.whirl.frequencies[self._held.swinging]

    @property
    def damping_ratios(self) -> np.ndarray:
        """Of critical damping (M,); below 0 a mode grows."""
        return self._held.whirl.damping_ratios[self._held.swinging]

    @property
    def log_decrements(self) -> np.ndarray:
        """Logarithmic decrements (M,)."""
        return log_decrements(self.roots)

    @property
    def critical_speeds(self) -> np.ndarray:
        """Damped, of all whirls up to the end of the diagram, ascending (C,), rad/s."""
        return np.array([one.speed for one in self._held.lines.crossings])

    def campbell(self, figure: FigureBase | None = None) -> list[Axes]:
        """Damped whirl frequencies [Hz] over speed [rpm], above their damping ratios [1].

        On a figure or a part of one; without, pyplot makes one. Returns its axes.
        """
        from touchdown.master.results.figures.style import drawable
        from touchdown.master.studies.rotor.held_figure import held_campbell

        return held_campbell(drawable(figure), self._held, self.title)

    def __repr__(self) -> str:
        verdict = "stable" if self.stable else "unstable"
        lowest = ", ".join(f"{f:.1f}" for f in self.frequencies[:4])
        return f"<{self.title} at {RPM * self.speed:.5g} rpm: {verdict}, {lowest} ... Hz>"


class InScene:
    """The rotor of a scene: `levitated` and `resting`, each None where nothing holds it so."""

    def __init__(
        self, levitated: InBearings | None, resting: InBearings | None, report: Callable[[], str]
    ) -> None:
        self.levitated, self.resting, self._report = levitated, resting, report

    def report(self) -> str:
        """All figures as a table, with what its bearings are."""
        return self._report()

    def __repr__(self) -> str:
        return f"<{self.levitated}, {self.resting}>"
