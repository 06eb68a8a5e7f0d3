"""The same drop on other touchdown bearings: models of the project, and bearings of the catalogue."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from ...fmus.model_names import models
from ...master.common.errors import TouchdownError
from ...master.common.progress import Progress
from ...master.coupling.simulation import opened
from ...master.results.summary import touchdown_seats
from ...master.scene.scene import Scene
from ..machine.rank import candidates, seats_of
from .drops import against_own
from .engine import Comparison, Options, Variant


def variants(scene: Scene, names: Sequence[str]) -> Iterator[Variant]:
    """The scene with each bearing in its touchdown seats. Raises TouchdownError where one does not fit."""
    with opened(scene, in_process=True) as system:
        seats = dict.fromkeys(a.bearing for a in touchdown_seats(system) if a.bearing not in scene.bushings)
    if not seats:
        raise TouchdownError(f"scene {scene.name} has no touchdown bearing to compare with others")
    catalogued = [name for name in names if name not in models()]
    fitting = candidates(scene, seats_of(scene)[0], catalogued, {}) if catalogued else []
    settings = {one.bearing: one.settings for one in fitting}
    for name in names:
        variant = (
            scene.set(settings[name]) if name in settings else scene.swap(**dict.fromkeys(seats, name))
        )
        yield Variant(name, variant)


def compare(scene: Scene, options: Options, progress: Progress) -> Comparison:
    """The unchanged scene and the scene with each bearing of the options, as `against_own` runs them.

    Raises TouchdownError for a bearing that there is not or that does not fit.
    """
    return against_own("bearings", scene, variants(scene, options.bearings), options, progress)
