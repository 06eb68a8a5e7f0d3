"""How firm the quantities of a drop are: the same drop from starts that are nanometres apart.

After the first impacts rings and balls rattle, and what differs in the last digit grows until it decides
the peaks: a whole drop's largest force is one draw of many. Siblings, the same drop from starts that differ
by nanometres, show how far such draws lie apart.
"""

from __future__ import annotations

import json
import math
import statistics
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from ...master.common.errors import Ended, TouchdownError
from ...master.common.files import writing_to
from ...master.common.pool import cores
from ...master.common.progress import SILENT_PROGRESS, Progress
from ...master.common.text import aligned
from ...master.coupling.simulation import opened
from ...master.quantities import SPREAD, finite_number, summary_items
from ...master.results.folder import SUMMARY_FILE
from ...master.results.result import Result
from ...master.results.summary import touchdown_seats
from ...master.scene.scene import Scene
from ...modelkit.kernel.writing import write
from ..sweep.tasks import Running, Task, run_tasks

START_OFFSET = 1e-9  # m, of the first sibling's start from the run's; of the next ones as much more each
GOLDEN_ANGLE = math.pi * (
    3.0 - math.sqrt(5.0)
)  # rad from one sibling's direction to the next: none is alike
MIN_DRAWS = 2  # draws that have a value


def spread(
    result: Result, siblings: int, jobs: int | None = None, progress: Progress = SILENT_PROGRESS
) -> list[str]:
    """Run `siblings` of a run that is over, and add the spread of chaotic quantities to its summary.

    Its summary.json, too. jobs: at a time, each in a process of its own; None: one for each processor.
    Nothing of the siblings is kept. Returns what is to be warned of: siblings that stopped. Raises
    TouchdownError where no start can be moved, and KeyboardInterrupt after Ctrl-C.
    """
    if siblings < 1:
        raise TouchdownError(f"a spread needs one sibling at least, not {siblings}")
    tasks = list(_siblings(result.scene, siblings))
    progress.planned(len(tasks))
    members = run_tasks(tasks, Running(jobs or cores()), progress.done)
    if any(member.ended is Ended.INTERRUPTED for member in members):
        raise KeyboardInterrupt
    done = [member for member in members if not member.failed]
    result.summary[SPREAD] = {
        "siblings": len(done),
        "apart": START_OFFSET,
        "quantities": _spreads(result.summary, [member.summary for member in done]),
    }
    with writing_to(result.folder):
        write(result.folder / SUMMARY_FILE, json.dumps(result.summary, indent=2) + "\n")
    return [f"sibling {m.number} of {siblings} does not count: {m.failed}" for m in members if m.failed]


def spread_lines(summary: Mapping[str, Any]) -> Iterator[str]:
    """The command's lines on a summary's spread."""
    if SPREAD not in summary:
        return
    found = summary[SPREAD]
    how = f"the same drop, its start shifted in steps of {1e9 * found['apart']:g} nm"
    yield f"over this run and {found['siblings']} siblings ({how}):"
    rows: list[tuple[str, str]] = []
    for item in summary_items(summary):
        if values := found["quantities"].get(item.path):
            least, median, most = (item.quantity.factor * values[k] for k in ("least", "median", "most"))
            rows.append((item.head, f"{least:.5g} to {most:.5g}, median {median:.5g}"))
    yield from aligned(rows, indent="  ")


def _siblings(scene: Scene, count: int) -> Iterator[Task]:
    """In process, where that is possible: the same to the bit, and faster."""
    starts = _starts(scene)
    for k in range(1, count + 1):
        away, angle = START_OFFSET * k, GOLDEN_ANGLE * k
        moved = {"x": away * math.cos(angle), "y": away * math.sin(angle)}
        settings: dict[str, object] = {
            f"{body}.{axis}": start[axis] + moved[axis] for body, start in starts.items() for axis in moved
        }
        yield Task(k, settings, scene.set(settings), None, in_process=True)


def _starts(scene: Scene) -> dict[str, dict[str, float]]:
    """Where the bodies with touchdown seats start (m), by body. Raises TouchdownError."""
    with opened(scene, in_process=True) as system:
        bodies = dict.fromkeys(a.body for a in touchdown_seats(system))
        if not bodies:
            raise TouchdownError(f"{scene.name} has no touchdown bearing: there are no peaks to spread")
        for body in bodies:
            if not all(f"{body}.{axis}" in system for axis in "xy"):
                raise TouchdownError(
                    f"{body} has no parameters x and y, so that siblings cannot start elsewhere; "
                    "run it without a spread"
                )
        return {body: {axis: system.value(f"{body}.{axis}") for axis in "xy"} for body in bodies}


def _spreads(
    summary: Mapping[str, Any], siblings: Sequence[Mapping[str, Any]]
) -> dict[str, dict[str, float]]:
    """Of the chaotic quantities that this run and siblings have, by path; SI."""
    found: dict[str, dict[str, float]] = {}
    for item in summary_items(summary):
        drawn = [v for one in (summary, *siblings) if (v := finite_number(item.of(one))) is not None]
        if item.quantity.chaotic and len(drawn) >= MIN_DRAWS:
            median = statistics.median(drawn)
            found[item.path] = {"least": min(drawn), "median": median, "most": max(drawn)}
    return found
