"""A scene at many phases of its unbalance: which windows of phases whirl, and how much of the circle.

A rotor that drops meets the bearing as its unbalance happens to stand, and whether it whirls is decided by
that: within windows of phases it does, outside it does not. A single run is one phase and tells neither. So
a study starts from even phases and adds others between neighbours of different verdicts.

Phases are in degrees, from 0 to below 360, and the circle closes: from 350 on to 2 it is 12 degrees.
Between two neighbours of different verdicts lies an edge, known to within the gap between them. Neighbours
of equal verdicts are taken to have nothing between them: what is narrower than the grid may be missed.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...master.common.errors import Ended, TouchdownError
from ...master.common.files import make_writable
from ...master.common.progress import SILENT_PROGRESS, Progress
from ...master.coupling.simulation import opened, refuse_endless
from ...master.coupling.system import System
from ...master.quantities import most
from ...master.results.summary import touchdown_seats
from ...master.results.whirl.evidence import ANGLE, unbalanced
from ...master.results.whirl.verdict import (
    TOO_COARSE,
    Share,
    clopper_pearson,
    recorded_too_coarsely,
    worst_whirl,
)
from ...master.scene.run_spec import SETTLED
from ...master.scene.scene import Scene
from ..drop.running import unstopped
from ..sweep.definition import define
from ..sweep.design import Design
from ..sweep.members import Member
from ..sweep.tasks import TWO_JOBS, Running, Task, run_tasks

if TYPE_CHECKING:
    import xarray


@dataclass(frozen=True)
class Circle:
    """One choice of steps, and its runs by phase (deg)."""

    title: str  # such as "macro step 40 us"
    members: Mapping[float, Member]

    @cached_property
    def verdicts(self) -> Verdicts:
        """Of the runs that came to their end: how the rotor whirls, in words, or "" where it does not."""
        return {
            phase: worst_whirl(m.summary)
            for phase, m in self.members.items()
            if not m.failed and not recorded_too_coarsely(m.summary)
        }

    @property
    def failed(self) -> dict[float, str]:
        """Why runs gave no verdict, those left out where they were interrupted."""
        return {
            phase: m.failed or TOO_COARSE
            for phase, m in self.members.items()
            if (m.failed and m.ended is not Ended.INTERRUPTED) or recorded_too_coarsely(m.summary)
        }

    @property
    def interrupted(self) -> bool:
        """Whether Ctrl-C kept some from running."""
        return any(m.ended is Ended.INTERRUPTED for m in self.members.values())

    def over_the_limit(self, limit: float) -> int:
        """How many runs have a ledger whose residual is beyond `limit` of what a connection turned over."""
        residuals = (m.summary.get("energy_residual_of_turnover") for m in self.members.values())
        return sum(r is not None and r > limit for r in residuals)

    def largest_force(self) -> float | None:
        """The largest contact force of all runs and seats (N); None where no bearing reports it."""
        forces = self.forces("peak_contact_force")
        return forces[1] if forces else None

    def forces(self, key: str) -> tuple[float, float] | None:
        """The least and the largest over all runs of a force (N), of all bearings the largest."""
        found = [force for m in self.members.values() if (force := most(m.summary, key)) is not None]
        return (min(found), max(found)) if found else None


CIRCLE = 360.0  # deg
DIGITS = 9  # of a phase in degrees: bisection meets the same phase from either side

Verdicts = Mapping[float, str]  # by phase (deg): how it whirls, in words; "" where it does not


class Edge(NamedTuple):
    """Where the verdict changes: somewhere between two phases (deg) that were looked at."""

    low: float
    high: float

    @property
    def middle(self) -> float:
        """Most likely place (deg)."""
        return turned(self.low, 0.5 * self.gap)

    @property
    def gap(self) -> float:
        """The width to which the edge is known (deg)."""
        return onwards(self.low, self.high)


@dataclass(frozen=True)
class Window:
    """Phases that whirl, from one edge to another; both None where all of the circle does."""

    begin: Edge | None
    end: Edge | None
    phases: tuple[float, ...]  # looked at within it (deg), strays left out

    @property
    def width(self) -> float:
        """From middle to middle of its edges (deg)."""
        if self.begin is None or self.end is None:
            return CIRCLE
        return onwards(self.begin.middle, self.end.middle)


def turned(phase: float, by: float) -> float:
    """A phase (deg) turned on."""
    return round((phase + by) % CIRCLE, DIGITS) % CIRCLE


def onwards(begin: float, end: float) -> float:
    """From one phase on to another (deg), 0 to below 360."""
    return turned(end, -begin)


def distance(one: float, other: float) -> float:
    """Between two phases, the shorter way round (deg)."""
    return min(onwards(one, other), onwards(other, one))


def grid(spacing: float, through: float) -> list[float]:
    """Phases evenly round the circle, at most `spacing` apart (deg), the first of them `through`."""
    count = math.ceil(CIRCLE / spacing - 1e-9)
    return [turned(through, i * CIRCLE / count) for i in range(count)]


def refinement(verdicts: Verdicts, tried: Collection[float], resolution: float) -> list[float]:
    """Phases to look at next: midway between neighbours that differ and are more than `resolution` apart.

    `tried` has the phases that were looked at, also those whose runs gave no verdict. Empty where nothing
    is left to do.
    """
    phases = sorted(verdicts)
    middles = [
        turned(low, 0.5 * onwards(low, high))
        for low, high in zip(phases, phases[1:] + phases[:1], strict=True)
        if verdicts[low] != verdicts[high] and onwards(low, high) > resolution
    ]
    return [phase for phase in middles if phase not in tried]


def strays(verdicts: Verdicts) -> list[float]:
    """Phases (deg) alone with their answer, to whirl or not: two or more on either side have the other.

    Where verdicts change from one phase to the next all along, no phase is a stray.
    """
    runs = _runs({phase: bool(words) for phase, words in verdicts.items()})
    if len(runs) < 2:
        return []
    alone = [
        run[0]
        for i, run in enumerate(runs)
        if len(run) == 1 and len(runs[i - 1]) > 1 and len(runs[(i + 1) % len(runs)]) > 1
    ]
    return sorted(alone)


def windows(verdicts: Verdicts) -> list[Window]:
    """The windows of phases that whirl, in their order; strays do not make or part them."""
    set_aside = strays(verdicts)
    whirls = {phase: bool(words) for phase, words in verdicts.items() if phase not in set_aside}
    runs = _runs(whirls)
    if len(runs) == 1:
        return [Window(None, None, tuple(runs[0]))] if whirls[runs[0][0]] else []
    found = [
        Window(Edge(runs[i - 1][-1], run[0]), Edge(run[-1], runs[(i + 1) % len(runs)][0]), tuple(run))
        for i, run in enumerate(runs)
        if whirls[run[0]]
    ]
    return sorted(found, key=lambda window: window.begin.middle if window.begin else 0.0)


def edges(verdicts: Verdicts) -> list[Edge]:
    """The edges of all windows, in the order of the windows."""
    return [edge for window in windows(verdicts) for edge in (window.begin, window.end) if edge]


def whirling_share(verdicts: Verdicts) -> Share:
    """Part of all phases that whirl: each that was looked at stands for half the way to its neighbours.

    The interval is that of Clopper and Pearson for as many independent phases as weigh the same (Korn and
    Graubard, Survey Methodology 24, 1998): phases of a refined edge lie close together and count for less.
    It says what so many phases drawn at random would leave open; that they are spread evenly makes the
    share better than that. Raises ValueError without any verdict.
    """
    if not verdicts:
        raise ValueError("no verdicts, no share")
    weights = {phase: 0.5 * (before + after) / CIRCLE for phase, before, after in gaps(verdicts)}
    value = sum(weight for phase, weight in weights.items() if verdicts[phase])
    count = 1.0 / sum(weight**2 for weight in weights.values())
    everything, nothing = all(verdicts.values()), not any(verdicts.values())
    return clopper_pearson(count if everything else 0.0 if nothing else count * value, count)


def furthest(found: Iterable[Edge], known: Sequence[Edge]) -> float | None:
    """The largest distance (deg) from an edge to the nearest of those `known`; None without edges."""
    nearest = [min(distance(edge.middle, other.middle) for other in known) for edge in found if known]
    return max(nearest, default=None)


def gaps(verdicts: Verdicts) -> Iterator[tuple[float, float, float]]:
    """Each phase, and how far it is to the one before it and to the one behind (deg)."""
    phases = sorted(verdicts)
    for i, phase in enumerate(phases):
        before, after = phases[i - 1], phases[(i + 1) % len(phases)]
        yield phase, onwards(before, phase) or CIRCLE, onwards(phase, after) or CIRCLE


def _runs(whirls: Mapping[float, bool]) -> list[list[float]]:
    """Phases in a row that have the same answer, round the circle; the first may begin before 0."""
    rows = [list(row) for _, row in itertools.groupby(sorted(whirls), key=lambda phase: whirls[phase])]
    if len(rows) > 1 and whirls[rows[0][0]] == whirls[rows[-1][0]]:
        rows[0] = rows.pop() + rows[0]
    return rows


PHASE_GRID = 12.0  # deg; windows of rotor I are 16 to 20 wide
RESOLUTION = 4.0  # deg
MIN_RESOLUTION = 0.1  # deg; nothing turns about that exactly, and a circle has thousands of runs by then
REFERENCE_STEP = 5e-6  # s
MAX_LONGER = 4.0  # times the scene's duration, at most, so that a whirl that dies away is seen to


@dataclass(frozen=True)
class Plan:
    """Which phases, and with which steps."""

    spacing: float = PHASE_GRID  # deg, between the first phases; narrower windows may be missed
    resolution: float = RESOLUTION  # deg, to which edges are found
    macro_steps: tuple[float, ...] = ()  # s; none: the scene's own
    reference: float | None = None  # s, macro step of runs with adaptive steps inside; None: none

    def __post_init__(self) -> None:
        for name, value in (("grid", self.spacing), ("resolution", self.resolution)):
            if not MIN_RESOLUTION <= value <= 0.5 * CIRCLE:
                meant = math.radians(value)  # what a number without a unit was
                if value < MIN_RESOLUTION or meant > 0.5 * CIRCLE:
                    meant = PHASE_GRID
                raise TouchdownError(
                    f"{name} = {value:g} deg must be from {MIN_RESOLUTION} to 180 deg; "
                    f'write "{meant:g} deg"'
                )
        if self.resolution > self.spacing:
            raise TouchdownError(
                f"resolution = {self.resolution:g} deg must not be coarser than grid = {self.spacing:g} deg"
            )


@dataclass(frozen=True)
class Study:
    """Results of a study; the reference, where there is one, is the last of `circles`."""

    scene: Scene
    plan: Plan
    phase: float  # deg, the scene's own: the angle of the first rotor's unbalance at the start
    circles: Sequence[Circle]
    remarks: Sequence[str] = ()  # warnings about the scene as it starts
    in_process: bool = False

    @cached_property
    def data(self) -> xarray.Dataset:
        """All runs over the dimension `member`, as a sweep has them: settings and all quantities in SI.

        `steps` says which circle a run is of. Raises ValueError where nothing was run.
        """
        from ..sweep.sweep_dataset import MEMBER, dataset

        runs = [(circle.title, m) for circle in self.circles for m in circle.members.values()]
        if not runs:
            raise ValueError("nothing was run, there are no data")
        design = Design.table([m.settings for _, m in runs])
        members = [replace(m, number=number) for number, (_, m) in enumerate(runs, start=1)]
        found = dataset(define(self.scene, design, self.in_process), members)
        return found.assign(steps=(MEMBER, np.array([title for title, _ in runs], dtype=object)))

    @property
    def reference(self) -> Circle | None:
        """The circle with adaptive steps inside the bearings."""
        return None if self.plan.reference is None else self.circles[-1]

    @property
    def interrupted(self) -> bool:
        """Whether Ctrl-C kept some runs from running."""
        return any(circle.interrupted for circle in self.circles)


@dataclass(frozen=True)
class _Stepped:
    """The scene with one choice of steps."""

    title: str
    name: str  # of its folder
    scene: Scene


def study_verdict(
    scene: Scene,
    plan: Plan,
    folder: Path,
    running: Running = TWO_JOBS,
    progress: Progress = SILENT_PROGRESS,
) -> Study:
    """Run `scene` round the circle of its unbalance's phase, as `plan` has it.

    Each run leaves its summary.json in `folder`/STEPS/PHASE. Several unbalanced rotors are turned together.
    The energy ledger stops no run. After Ctrl-C the study has what is there, and is `interrupted`. Raises
    TouchdownError where there is nothing to turn, or nothing that a verdict could be given on. Starts
    processes: see `touchdown.master.common.pool`.
    """
    scene = answering(scene)
    angles, remarks = _looked_at(scene)
    own_phase = turned(next(iter(angles.values())), 0.0)
    stepped = [_with_step(scene, step) for step in plan.macro_steps or (scene.run.macro_step,)]
    if plan.reference is not None:
        stepped.append(_adaptive(scene, plan.reference))
    make_writable(folder)
    found: list[dict[float, Member]] = [{} for _ in stepped]
    pending = [grid(plan.spacing, own_phase) for _ in stepped]
    while any(pending):
        tasks = [
            (place, phase, _task(stepped[place], angles, turned(phase, -own_phase), folder, running))
            for place, phases in enumerate(pending)
            for phase in phases
        ]
        progress.planned(len(tasks))
        members = run_tasks([task for _, _, task in tasks], running, progress.done)
        for (place, phase, _), member in zip(tasks, members, strict=True):
            found[place][phase] = member
        circles = [Circle(s.title, dict(sorted(f.items()))) for s, f in zip(stepped, found, strict=True)]
        if any(circle.interrupted for circle in circles):
            break
        pending = [refinement(c.verdicts, c.members, plan.resolution) for c in circles]
    return Study(scene, plan, own_phase, circles, remarks, running.in_process)


def answering(scene: Scene) -> Scene:
    """`scene` until its drops settle, at most MAX_LONGER times its duration, where no one has set one."""
    if {"duration", "until"} & set(scene.own) or scene.run.until == SETTLED:
        return scene
    return scene.set({"run.duration": MAX_LONGER * scene.run.duration, "run.until": SETTLED})


def _looked_at(scene: Scene) -> tuple[dict[str, float], Sequence[str]]:
    """The angle (deg) of every unbalanced rotor, and what is to be said of the scene.

    Raises TouchdownError where a study makes no sense.
    """
    with opened(scene, in_process=True) as system:
        if not any(f"{a.bearing}.clearance" in system for a in touchdown_seats(system)):
            raise TouchdownError(
                f"{scene.name} has no touchdown bearing that states its clearance: no verdict can be given"
            )
        angles = {name: math.degrees(system.value(f"{name}.{ANGLE}")) for name in unbalanced(system)}
        before = _start(system)
    if angles:
        with opened(scene.set(_turned(angles, 0.25 * CIRCLE)), in_process=True) as system:
            if not np.array_equal(before, _start(system)):
                return angles, system.remarks
    raise TouchdownError(
        f"{scene.name} has no rotor with an unbalance: nothing to turn; give it one, such as "
        f'--set "rotor.eccentricity=1 um" or an [[unbalance]] in the rotor\'s file'
    )


def _start(system: System) -> np.ndarray:
    """All that is exchanged at the start."""
    system.initialise()
    return system.signals.copy()


def _turned(angles: Mapping[str, float], by: float) -> dict[str, object]:
    """Settings that turn all rotors by an angle (deg)."""
    return {f"{name}.{ANGLE}": f"{turned(angle, by):.12g} deg" for name, angle in angles.items()}


def _with_step(scene: Scene, step: float) -> _Stepped:
    """At a macro step (s), recorded as often as the scene is, so that verdicts are told from the same."""
    refuse_endless(scene.run.duration, step)
    every = max(1, round(scene.run.record_every * scene.run.macro_step / step))
    scene = unstopped(scene.set({"run.macro_step": step, "run.record_every": every}))  # it is counted
    return _Stepped(f"macro step {1e6 * step:g} us", f"{1e6 * step:g}us", scene)


def _adaptive(scene: Scene, step: float) -> _Stepped:
    """The same, with adaptive steps in all bearings that have a choice."""
    fixed = _with_step(scene, step)
    with opened(scene, in_process=True) as system:
        names = [f"{a.bearing}.micro_step" for a in touchdown_seats(system)]
        settings = {name: 0.0 for name in names if name in system}
    title = f"{fixed.title}, adaptive steps inside the bearings"
    return _Stepped(title, f"{fixed.name}-adaptive", fixed.scene.set(settings))


def _task(
    stepped: _Stepped, angles: Mapping[str, float], by: float, folder: Path, running: Running
) -> Task:
    """A run with all rotors turned by an angle (deg)."""
    settings = {"run.macro_step": stepped.scene.run.macro_step, **_turned(angles, by)}
    where = folder / stepped.name / f"{turned(next(iter(angles.values())), by):07.3f}"
    return Task(0, settings, stepped.scene.set(settings), where, running.in_process)
