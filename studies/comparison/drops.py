"""Whole drops of a scene's variants, each once, beside the drop of the unchanged scene."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace

from ...master.common.errors import Ended, TouchdownError
from ...master.common.progress import Progress
from ...master.quantities import Owner, most, named, owned, values_of
from ...master.scene.scene import Scene
from ..sweep.members import Member
from ..sweep.tasks import Running, Task, run_here, run_tasks
from .engine import Comparison, Measure, Options, Row, Variant, relative
from .models import UNCHANGED

HEADS = {  # quantities, the worst of all seats, with what is short enough above their columns
    "first_impact_contact_force": "first impact",
    "peak_contact_force": "contact",
    "peak_ball_force": "ball",
    "lowest_static_safety": "safety",
    "largest_displacement": "displaced",
    "settling_time": "settled",
}
DEVIATION = "{} deviation"  # key of a quantity's error


def _measures() -> Iterator[tuple[str, Measure]]:
    """Each quantity, and its deviation from the scene's own."""
    for key, head in HEADS.items():
        one = named(key)[0]
        title = f"{key}_{one.unit}" if one.read_in else key
        yield key, Measure(title, (head, one.read_in), one.factor, ".4g")
        yield DEVIATION.format(key), Measure(f"{key}_deviation_relative", ("", "%"), 100.0, "+.1f")


def against_own(
    kind: str, scene: Scene, variants: Iterable[Variant], options: Options, progress: Progress
) -> Comparison:
    """Run the unchanged scene, the reference, and its variants; `kind` names the comparison.

    One job runs them in this process, more in processes of their own. Raises TouchdownError where the
    unchanged scene stops; a variant that stops says so in its row. After Ctrl-C raises KeyboardInterrupt.
    """
    chosen = [Variant(UNCHANGED, scene), *variants]
    tasks = [Task(i, {}, v.scene, None, options.in_process) for i, v in enumerate(chosen, start=1)]
    progress.planned(len(tasks))
    sequential, running = options.jobs == 1, Running(options.jobs)
    members = run_here(tasks, progress.done) if sequential else run_tasks(tasks, running, progress.done)
    if any(member.ended is Ended.INTERRUPTED for member in members):
        raise KeyboardInterrupt
    reference, *others = (_of_bearings(member, scene.bushings) for member in members)
    if reference.failed:
        raise TouchdownError(f"the unchanged scene: {reference.failed}")
    rows = [_row(v.name, m, _worst(reference)) for v, m in zip(chosen, (reference, *others), strict=True)]
    where = "in process" if options.in_process else "through FMUs"
    about = (
        scene.title,
        "reference: the unchanged scene; values of the worst seat, beside them in % how far off they are",
        "after the first impact peaks are one draw of many; touchdown run --spread shows how far they part",
        f"wall time of one run, {where}, up to {options.jobs} at a time",
    )
    doubts = [f"{v.name}: {text}" for v, m in zip(chosen, members, strict=True) for text in m.warnings]
    return Comparison(
        kind, scene.title, about, rows[1:], dict(_measures()), rows[:1], reference.summary, warnings=doubts
    )


def _of_bearings(member: Member, bushings: frozenset[str]) -> Member:
    """A run without the seats of gaps."""
    seats = owned(member.summary, Owner.SEAT).items()
    seats = {name: seat for name, seat in seats if seat["bearing"] not in bushings}
    return replace(member, summary={**member.summary, "seats": seats})


def _row(name: str, member: Member, reference: Mapping[str, float]) -> Row:
    """A run against the scene's own."""
    if member.failed:
        return Row(name, failed=member.failed)
    values = _worst(member)
    errors = {
        DEVIATION.format(key): relative(values[key], reference[key]) for key in values if key in reference
    }
    verdicts = values_of(member.summary, "whirl").items()
    whirl = ", ".join(f"{seat}: {words}" for seat, words in verdicts if words)
    wall = most(member.summary, "wall_time_per_simulated_second")
    return Row(name, errors=errors, wall=wall, values=values, remark=whirl)


def _worst(member: Member) -> dict[str, float]:
    return {key: value for key in HEADS if (value := most(member.summary, key)) is not None}
