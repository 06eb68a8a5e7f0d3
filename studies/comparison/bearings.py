"""The same drop on other touchdown bearings: models of the project, and bearings of the catalogue.

The reference is the scene as it is. Each bearing runs once, to the scene's end: what comes after the first
impact is one draw of many, and `touchdown run --spread` shows how far such draws lie apart.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from ...fmus.recipes import models
from ...master.common.errors import Ended, TouchdownError
from ...master.common.progress import Progress
from ...master.coupling.simulation import opened
from ...master.quantities import most, named, values_of
from ...master.results.summary import touchdown_seats
from ...master.scene.scene import Scene
from ..machine.rank import candidates, seats_of
from ..sweep.members import Member
from ..sweep.tasks import Running, Task, run_tasks
from .engine import Comparison, Measure, Options, Row, Variant, relative
from .models import AS_IT_IS

HEADS = {  # quantities, the worst of all seats, with what is short enough above their columns
    "first_impact_contact_force": "first impact",
    "peak_contact_force": "contact",
    "peak_ball_force": "ball",
    "lowest_static_safety": "safety",
    "largest_displacement": "displaced",
    "settling_time": "settled",
}
DEVIATION = "{} deviation"  # key of a quantity's error


def measures() -> Iterator[tuple[str, Measure]]:
    """Each quantity, and its deviation from the scene's own."""
    for key, head in HEADS.items():
        one = named(key)[0]
        title = f"{key}_{one.unit}" if one.read_in else key
        yield key, Measure(title, (head, one.read_in), one.factor, ".4g")
        yield DEVIATION.format(key), Measure(f"{key}_deviation_relative", ("", "%"), 100.0, "+.1f")


def variants(scene: Scene, names: Sequence[str]) -> Iterator[Variant]:
    """The scene with each bearing in its touchdown seats. Raises TouchdownError where one does not fit."""
    with opened(scene, in_process=True) as system:
        seats = list(dict.fromkeys(a.bearing for a in touchdown_seats(system)))
    if not seats:
        raise TouchdownError(f"scene {scene.name} has no touchdown bearing to compare with others")
    catalogued = [name for name in names if name not in models()]
    fitting = candidates(scene, seats_of(scene)[0], catalogued, {}) if catalogued else []
    settings = {one.bearing: one.settings for one in fitting}
    for name in names:
        of = scene.set(settings[name]) if name in settings else scene.swap(**dict.fromkeys(seats, name))
        yield Variant(name, of)


def compare(scene: Scene, options: Options, progress: Progress) -> Comparison:
    """Run the scene as it is and with each bearing of the options, beside each other.

    Raises TouchdownError for a bearing that there is not or that does not fit, and where the scene itself
    stops; one that stops with a bearing says so in its row. After Ctrl-C raises KeyboardInterrupt.
    """
    chosen = [Variant(AS_IT_IS, scene), *variants(scene, options.bearings)]
    tasks = [Task(i, {}, v.scene, None, options.in_process) for i, v in enumerate(chosen, start=1)]
    progress.planned(len(tasks))
    members = run_tasks(tasks, Running(options.jobs), progress.done)
    if any(member.ended is Ended.INTERRUPTED for member in members):
        raise KeyboardInterrupt
    own = members[0]
    if own.failed:
        raise TouchdownError(f"the scene with its own bearings: {own.failed}")
    rows = [_row(v.name, m, _worst(own.summary)) for v, m in zip(chosen, members, strict=True)]
    where = "in process" if options.in_process else "through FMUs"
    about = (
        scene.title,
        "reference: the scene as it is; values of the worst seat, beside them in % how far they are off it",
        "after the first impact peaks are one draw of many; touchdown run --spread shows how far they part",
        f"wall time of one run, {where}, up to {options.jobs} at a time",
    )
    doubts = [f"{v.name}: {text}" for v, m in zip(chosen, members, strict=True) for text in m.warnings]
    return Comparison(
        "bearings", scene.title, about, rows[1:], dict(measures()), rows[:1], own.summary, warnings=doubts
    )


def _row(name: str, member: Member, own: Mapping[str, float]) -> Row:
    """A run against the scene's own."""
    if member.failed:
        return Row(name, failed=member.failed)
    values = _worst(member.summary)
    errors = {DEVIATION.format(key): relative(values[key], own[key]) for key in values if key in own}
    whirl = ", ".join(f"{seat}: {words}" for seat, words in values_of(member.summary, "whirl").items())
    wall = most(member.summary, "wall_time_per_simulated_second")
    return Row(name, errors=errors, wall=wall, values=values, remark=whirl)


def _worst(summary: Mapping[str, Any]) -> dict[str, float]:
    """The known quantities of a summary, of the worst seat."""
    return {key: value for key in HEADS if (value := most(summary, key)) is not None}
