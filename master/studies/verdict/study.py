"""A scene at many phases of its unbalance, refined where the verdicts of neighbours differ.

A rotor that drops meets the bearing as its unbalance happens to stand, and whether it whirls is decided by
that: within windows of phases it does, outside it does not. One run is one phase and tells neither.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from touchdown.master.common.errors import TouchdownError
from touchdown.master.common.progress import UNSEEN, Progress
from touchdown.master.coupling.simulation import opened, refuse_endless
from touchdown.master.coupling.system import System
from touchdown.master.results.run import make_writable
from touchdown.master.results.summary import touchdown_seats
from touchdown.master.results.whirl.unbalance import ANGLE, unbalanced
from touchdown.master.scene.run_spec import SETTLED
from touchdown.master.scene.scene import Scene
from touchdown.master.studies.sweep.report import Member
from touchdown.master.studies.sweep.sweep import Execution, Task, run_tasks
from touchdown.master.studies.verdict.circle import Circle
from touchdown.master.studies.verdict.phases import CIRCLE, grid, refinement, turned

GRID = 12.0  # deg; windows of rotor I are 16 to 20 wide
RESOLUTION = 4.0  # deg
LEAST = 0.1  # deg; nothing turns about that exactly, and a circle has thousands of runs by then
REFERENCE = 5e-6  # s
LONGER = 4.0  # times the scene's duration, at most, so that a whirl that dies away is seen to
NEVER = 1e9  # a residual of the ledger at which no run stops: how many would have is counted


@dataclass(frozen=True)
class Plan:
    """Which phases, and with which steps."""

    spacing: float = (
        GRID  # deg, between the phases that are looked at first; narrower windows may be missed
    )
    resolution: float = RESOLUTION  # deg, to which edges are found
    macro_steps: tuple[float, ...] = ()  # s; none: the scene's own
    reference: float | None = None  # s, macro step of runs with adaptive steps inside; None: none

    def __post_init__(self) -> None:
        for name, value in (("grid", self.spacing), ("resolution", self.resolution)):
            if not LEAST <= value <= 0.5 * CIRCLE:
                meant = math.radians(value)  # what a number without a unit was
                if value < LEAST or meant > 0.5 * CIRCLE:
                    meant = GRID
                raise TouchdownError(
                    f'{name} = {value:g} deg must be from {LEAST} to 180 deg; write "{meant:g} deg"'
                )
        if self.resolution > self.spacing:
            raise TouchdownError(
                f"resolution = {self.resolution:g} deg must not be coarser than grid = {self.spacing:g} deg"
            )


@dataclass(frozen=True)
class Running:
    """How the runs of a study run."""

    jobs: int = 2
    in_process: bool = False


@dataclass(frozen=True)
class Study:
    """What a study found; the reference, where there is one, is the last of `circles`."""

    scene: Scene
    plan: Plan
    phase: float  # deg, the scene's own: the angle of the first rotor's unbalance at the start
    circles: Sequence[Circle]
    remarks: Sequence[str] = ()  # what is to be said of the scene before it runs

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
    running: Running = Running(),
    progress: Progress = UNSEEN,
) -> Study:
    """Run `scene` round the circle of its unbalance's phase, as `plan` has it.

    Each run leaves its summary.json in `folder`/STEPS/PHASE. Several unbalanced rotors are turned together.
    The energy ledger stops no run. After Ctrl-C the study has what is there, and is `interrupted`. Raises
    TouchdownError where there is nothing to turn, or nothing that a verdict could be given on. Starts
    processes: see `touchdown.master.common.processes.pool`.
    """
    if running.jobs < 1:
        raise TouchdownError(f"a study needs at least one job, not {running.jobs}")
    scene = answering(scene)
    angles, remarks = _looked_at(scene)
    own = turned(next(iter(angles.values())), 0.0)
    stepped = [_with_step(scene, step) for step in plan.macro_steps or (scene.run.macro_step,)]
    if plan.reference is not None:
        stepped.append(_adaptive(scene, plan.reference))
    make_writable(folder)
    found: list[dict[float, Member]] = [{} for _ in stepped]
    wanted = [grid(plan.spacing, own) for _ in stepped]
    while any(wanted):
        tasks = [
            (place, phase, _task(stepped[place], angles, turned(phase, -own), folder, running))
            for place, phases in enumerate(wanted)
            for phase in phases
        ]
        progress.planned(len(tasks))
        members = run_tasks([task for _, _, task in tasks], running.jobs, progress.done)
        for (place, phase, _), member in zip(tasks, members, strict=True):
            found[place][phase] = member
        circles = [Circle(s.title, dict(sorted(f.items()))) for s, f in zip(stepped, found, strict=True)]
        if any(circle.interrupted for circle in circles):
            break
        wanted = [refinement(c.verdicts, c.members, plan.resolution) for c in circles]
    return Study(scene, plan, own, circles, remarks)


def answering(scene: Scene) -> Scene:
    """`scene` until its drops settle, LONGER times its duration at most, where nobody has said how long."""
    if {"duration", "until"} & set(scene.own) or scene.run.until == SETTLED:
        return scene
    return scene.set({"run.duration": LONGER * scene.run.duration, "run.until": SETTLED})


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
    changes: dict[str, object] = {"run.macro_step": step, "run.record_every": every}
    name = f"{1e6 * step:g}us"
    return _Stepped(
        f"macro step {1e6 * step:g} us", name, scene.set({**changes, "run.stop_residual": NEVER})
    )


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
    settings = _turned(angles, by)
    where = folder / stepped.name / f"{turned(next(iter(angles.values())), by):07.3f}"
    return Task(0, settings, stepped.scene.set(settings), where, Execution(running.in_process))
