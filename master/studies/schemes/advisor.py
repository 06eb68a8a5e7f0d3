"""Which macro step a scheme bears, told before a run.

A touchdown bearing says at which rate the journal swings on its contact: from the contact's stiffness, and
from the masses and elastic modes that the journal moves with (`contact.rate`, rad/s). A scheme bears so
many radians of that swing in a macro step (`Scheme.bears`, measured: docs/coupling.md).
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

from touchdown.master.coupling.simulation import opened
from touchdown.master.coupling.system import fastest_contact
from touchdown.master.scene.scene import Scene
from touchdown.master.scene.schemes import Scheme, scheme
from touchdown.master.scene.step_sizes import tidy

LONGEST = 1e-4  # s; what happens within a longer macro step is lost to recording and ledger


@dataclass(frozen=True)
class Advice:
    """A macro step, and why."""

    macro_step: float  # s
    reason: str


def advise(scene: Scene, names: Iterable[str] | None = None) -> dict[str, Advice]:
    """The macro step that each of the schemes `names` bears in `scene`; without names, the scene's own.

    Raises TouchdownError where the scene cannot be assembled, or no bearing states its contact's rate.
    """
    with opened(scene, in_process=True) as system:
        system.initialise()
        bearing, rate = fastest_contact(system)
    return {name: _for(scheme(name), bearing, rate) for name in names or [scene.run.scheme.name]}


def _for(chosen: Scheme, bearing: str, rate: float) -> Advice:
    return Advice(
        tidy(min(chosen.bears / rate, LONGEST)),
        f"the journal swings at {rate / (2.0 * math.pi):.3g} Hz on the contact of {bearing}, and scheme "
        f"{chosen.name} bears {chosen.bears:g} rad of that in a macro step, up to {1e6 * LONGEST:g} us",
    )
