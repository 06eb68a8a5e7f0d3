"""The rigid disk on a simplified caged bearing, which nothing holds from t = 0 on: a tool whose first step
has no loads runs the same drop, too. Its error is that of the journal just after the first impact."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

from drops import FREE, Fall

from cosimulated.runs import Bond, Motion, Tried
from touchdown.master.scene.scene import Scene
from touchdown.master.scene.schemes import SCHEMES

FINE = {"run.macro_step": 5e-7, "run.scheme": "interface"}


@dataclass(frozen=True)
class Drop:
    """Four of the project's own FMUs. Another tool gets them as they lead by one macro step."""

    title = "Disk falls onto a touchdown bearing, 9 ms; error of the journal at the end"
    tried = Tried(
        (6e-5, 3e-5, 1.5e-5, 5e-6), 6e-5, (1e-7, 1e-9, 1e-11), (1e-3, 1e-5, 1e-7)
    )  # parts of 9 ms
    bonds: tuple[Bond, ...] = tuple(
        ((body, f"{seat}.v{axis}", f"{seat}.f{axis}"), ("bearing", f"{port}.f{axis}", f"{port}.v{axis}"))
        for body, seat, port in (("rotor", "A", "journal"), ("housing", "seat", "housing"))
        for axis in "xy"
    )
    packed = "jacobi-lead"

    @cached_property
    def fall(self) -> Fall:
        """As other tools' tests have it."""
        return FREE["disk, free"]()

    @property
    def ways(self) -> Mapping[str, Mapping[str, object]]:
        """All schemes."""
        unstopped = {"stop_residual": 1e9}
        return {name: {"scheme": name, **unstopped} for name in SCHEMES}

    @property
    def watched(self) -> tuple[str, ...]:
        """Places and forces."""
        return tuple(self.fall.wanted)

    @cached_property
    def exact(self) -> dict[str, float]:
        """By macro steps of 0.5 us."""
        return Fall(self.fall.scene.set(FINE), self.fall.journals, self.fall.bearings).ours()[0]

    def scene(self, run: Mapping[str, object]) -> Scene:
        """The drop, to be run as [run] of a scene says."""
        return self.fall.scene.set({f"run.{key}": value for key, value in run.items()})

    def error(self, motion: Motion) -> float:
        """Of the journal, at the end."""
        if motion.ended:
            return float("inf")
        found = dict(zip(self.watched, motion.rows[-1], strict=True))
        return 1e-6 * self.fall.error(found, self.exact).journal

    def energy(self, motion: Motion) -> None:
        """The FMUs do not tell it alone."""

    def damped(self, step: float) -> None:
        """Nothing comes to rest in 9 ms."""

    def rests(self, motion: Motion) -> bool:
        """Never asked."""
        raise NotImplementedError
