"""The loops of a scene over the speed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...coupling.simulation import opened
from ...scene.scene import Scene
from .loops import Loops, loops_of
from .margins import Margins, margins

SHARES = (0.0, 0.5, 1.0, 1.5)  # of the scene's speed
CLEARANCE = "clearance"  # m, a parameter of touchdown bearings


@dataclass(frozen=True)
class AtSpeed:
    """All loops at one speed."""

    speed: float  # rad/s
    omega: np.ndarray  # (n,), rad/s
    values: np.ndarray  # (n, axes), S
    margins: tuple[Margins, ...]  # by axis
    poles: np.ndarray  # 1/s, the slowest to fade first


@dataclass(frozen=True)
class Found:
    """The loops of a scene over the speed."""

    scene: Scene
    loops: Loops
    speeds: tuple[AtSpeed, ...]
    clearance: float  # m, the smallest of the touchdown bearings; 0: unknown

    @property
    def own(self) -> AtSpeed:
        """At the scene's speed."""
        return min(self.speeds, key=lambda one: abs(one.speed - self.loops.speed))


def loops_in(scene: Scene, speeds: Sequence[float] = ()) -> Found:
    """The loops of `scene` at its own speed and at `speeds` (rad/s; none: `SHARES` of its own).

    Raises TouchdownError where the scene has no magnetic bearing whose loop is known, or no rotor with it.
    """
    loops = loops_of(scene)
    asked = speeds or [share * loops.speed for share in SHARES]
    wanted = sorted({*asked, loops.speed})
    with opened(scene, in_process=True, listening=False) as system:
        named = {f"{a.bearing}.{CLEARANCE}" for a in system.attachments if a.on_journal}
        found = [system.value(name) for name in named if name in system]
    return Found(scene, loops, tuple(_at(loops, speed) for speed in wanted), min(found, default=0.0))


def _at(loops: Loops, speed: float) -> AtSpeed:
    omega = loops.lines
    values = np.array([np.diag(loops.sensitivity(w, speed)) for w in omega])

    def of(axis: int) -> Margins:
        return margins(lambda w: complex(loops.sensitivity(w, speed)[axis, axis]), omega, values[:, axis])

    poles: np.ndarray = loops.poles(speed)
    return AtSpeed(
        speed,
        omega,
        values,
        tuple(of(axis) for axis in range(len(loops.names))),
        poles[np.argsort(-np.real(poles), kind="stable")],
    )
