"""Advice on the macro step of each coupling scheme before a run.

A touchdown bearing states at which rate the journal swings on its contact, from the contact's stiffness and
from the masses and elastic modes that the journal moves with (`contact.rate`, rad/s). A scheme takes so
many radians of that swing in a macro step (`Scheme.angle_limit`, measured: docs/coupling.md).
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

from ...master.common.progress import Progress
from ...master.coupling.simulation import opened
from ...master.coupling.system import fastest_contact
from ...master.scene.run_spec import round_down_125
from ...master.scene.scene import Scene
from ...master.scene.schemes import scheme
from .engine import Comparison, Measure, Options, Row

LONGEST_MACRO_STEP = 1e-4  # s; what happens within a longer macro step is lost to recording and ledger
LIMIT = Measure("angle_limit_rad", ("swing in it", "rad"), 1.0, "g")


@dataclass(frozen=True)
class _Advice:
    """A macro step, and why."""

    macro_step: float  # s
    reason: str


def advise(scene: Scene, names: Iterable[str] | None = None) -> dict[str, _Advice]:
    """The macro step that each of the schemes `names` can take in `scene`; without names, the scene's own.

    Raises TouchdownError where the scene cannot be assembled, or no bearing states its contact's rate.
    """
    with opened(scene, in_process=True) as system:
        system.initialise()
        bearing, rate = fastest_contact(system)
    advice = {}
    for chosen in map(scheme, names or [scene.run.scheme.name]):
        advice[chosen.name] = _Advice(
            round_down_125(min(chosen.angle_limit / rate, LONGEST_MACRO_STEP)),
            f"the journal swings at {rate / (2.0 * math.pi):.3g} Hz on the contact of {bearing}, and "
            f"scheme {chosen.name} takes {chosen.angle_limit:g} rad of that in a macro step, "
            f"up to {1e6 * LONGEST_MACRO_STEP:g} us",
        )
    return advice


def compare(scene: Scene, options: Options, progress: Progress) -> Comparison:
    """The advised macro step of each scheme; nothing runs."""
    own_scheme = scene.run.scheme.name
    advice = advise(scene, dict.fromkeys([*options.schemes, own_scheme]))
    about = (
        f"{scene.name}: {advice[own_scheme].reason}",
        f"The scene takes {1e6 * scene.run.macro_step:g} us. With the advised steps, peaks of the first "
        "impact are",
        "within about 1 %; the energy ledger of a run shows what longer steps do.",
    )
    rows = [
        Row(one.name, advice[one.name].macro_step, values={"limit": one.angle_limit}, remark=one.title)
        for one in map(scheme, options.schemes)
    ]
    return Comparison("steps", scene.title, about, rows, {"limit": LIMIT}, row_is="scheme")
