"""The reference of a comparison: the monolithic solution, or the scene's own refinement.

A third-party FMU can only be stepped. So the reference is the same drop in finer and finer macro steps, as
far as two of them agree on it; an error that all steps have in common stays unseen.

After some impacts every difference is amplified beyond any use, that of two exact solvers too. So the
motion is compared point by point only up to the horizon, the last instant up to which both agree.
"""

from __future__ import annotations

import time as clock
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...master.common.errors import TouchdownError
from ...master.components.component import SENSED
from ...master.components.loading import foreign
from ...master.coupling.connections import Attachment
from ...master.coupling.loop.span import until
from ...master.coupling.observer import Observer, RunState
from ...master.coupling.simulation import opened, simulate
from ...master.coupling.system import System
from ...master.scene.scene import Scene
from .measured_drop import FINE_STEP, fine
from .monolithic import Monolith


@dataclass(frozen=True)
class Refined:
    """The drop in macro steps of `step` (s)."""

    step: float

    @property
    def title(self) -> str:
        """For people."""
        return f"its own steps of {1e6 * self.step:g} us"


REFINED = (Refined(0.5 * FINE_STEP), Refined(FINE_STEP))
"""The reference, and what it must agree with."""


def has_equations(scene: Scene) -> bool:
    """Whether all components are the project's own models, whose equations can be joined.

    A sampled controller has none.
    """
    return not scene.control and not any(foreign(spec.fmu) for spec in scene.components.values())


def refine(scene: Scene, seats: Sequence[Attachment], times: np.ndarray, by: Refined) -> Solve:
    """Journals at `times` (s from zero), multiples of the macro step on the simulation's clock.

    Raises TouchdownError where the run stops.
    """
    finely = fine(scene, by.step)
    began = clock.perf_counter()
    with opened(finely, in_process=True) as system:
        kept = _Kept(system, seats, times, by.step)
        outcome = simulate(until(finely, system, float(times[-1])), system, observers=[kept])
    outcome.raise_if_stopped()
    wall = (clock.perf_counter() - began) / outcome.simulated
    return Solve(by, np.array(kept.motion), outcome.steps, wall)


class _Kept(Observer):
    """Keeps the journals' motion at instants."""

    def __init__(self, system: System, seats: Sequence[Attachment], times: np.ndarray, step: float) -> None:
        self.motion: list[list[np.ndarray]] = []
        self._read = [system.reader([a.motion(v) for v in SENSED]) for a in seats]
        self._times, self._half = times, 0.5 * step

    def stepped(self, state: RunState) -> None:
        kept = len(self.motion)
        if kept < len(self._times) and state.since_zero >= self._times[kept] - self._half:
            self.motion.append([read().copy() for read in self._read])


POSITION, VELOCITY = slice(0, 2), slice(2, 4)  # of a journal's motion
MAX_IMPLICIT_STATES = 120  # states that an implicit solver takes: each Jacobian is as many evaluations

IMPLICIT_METHODS = ("Radau", "BDF", "LSODA")  # methods of scipy's


@dataclass(frozen=True)
class Solver:
    """One of scipy's, at an error over the models' own scales."""

    method: str
    tolerance: float

    @property
    def implicit(self) -> bool:
        """Whether its steps solve for the state, with a Jacobian."""
        return self.method in IMPLICIT_METHODS

    @property
    def title(self) -> str:
        """For people."""
        return f"{self.method} {self.tolerance:g}"


FIRST_SOLVER = Solver("DOP853", 1e-9)
SECOND_SOLVER = Solver("Radau", 1e-6)
SECOND_SOLVER_OF_MANY = Solver("RK45", 1e-8)  # where there are too many states for an implicit one


@dataclass(frozen=True)
class Solve:
    """One monolithic solution, or a refined one."""

    solver: Solver | Refined
    motion: np.ndarray  # (times, seats, 4): x, y in m, vx, vy in m/s of each journal
    evaluations: int  # of the equations, or macro steps
    wall: float  # s per simulated s


@dataclass(frozen=True)
class Reference:
    """The first solution up to the horizon, and the second to judge it."""

    time: np.ndarray  # s from the scene's zero, up to the horizon
    first: Solve
    second: Solve
    whole: bool  # whether the horizon is the end of what was asked for

    @property
    def horizon(self) -> float:
        """s from the scene's zero."""
        return float(self.time[-1])

    def distance(self, motion: np.ndarray, instants: np.ndarray, part: slice) -> float:
        """Largest distance of `motion` (instants, seats, 4) from the reference's at its `instants`."""
        return largest_distance(motion, self.first.motion[instants], part)

    def floor(self, part: slice) -> float:
        """The largest difference of both solutions (m, or m/s): errors below it say nothing."""
        count = len(self.time)
        return largest_distance(self.second.motion[:count], self.first.motion[:count], part)

    def extent(self, part: slice) -> float:
        """How far the motion goes from where it was at the first instant (m, or m/s)."""
        motion = self.first.motion[: len(self.time)]
        return largest_distance(motion, motion[:1], part)


def largest_distance(a: np.ndarray, b: np.ndarray, part: slice) -> float:
    """Over instants and seats, of POSITION (m) or VELOCITY (m/s); infinite where one is not a number."""
    apart = np.linalg.norm((a - b)[..., part], axis=-1)
    return float(np.max(apart)) if np.isfinite(apart).all() else np.inf


def solve(scene: Scene, seats: Sequence[Attachment], times: np.ndarray, solver: Solver) -> Solve:
    """Journals at `times` (s from zero). Raises TouchdownError where the scene has no equations to join."""
    names = [a.motion(variable) for a in seats for variable in SENSED]
    monolith = Monolith(scene)
    began = clock.perf_counter()
    solution = monolith.solve(times, names, solver.tolerance, solver.method)
    simulated = monolith.zero + float(times[-1]) - monolith.start
    wall = (clock.perf_counter() - began) / simulated
    motion = np.stack([solution.series[name] for name in names], 1).reshape(len(times), len(seats), 4)
    return Solve(solver, motion, solution.evaluations, wall)


def pair(scene: Scene) -> tuple[Solver, Solver]:
    """The two solvers for a scene: of different kind where its size allows."""
    return FIRST_SOLVER, SECOND_SOLVER if Monolith(
        scene
    ).moving <= MAX_IMPLICIT_STATES else SECOND_SOLVER_OF_MANY


def reference(times: np.ndarray, first: Solve, second: Solve, agreed: float) -> Reference:
    """Solutions at `times` (s from zero), up to where their journals part by more than `agreed` (m)."""
    apart = np.linalg.norm((second.motion - first.motion)[..., POSITION], axis=-1).max(axis=1)
    beyond = np.flatnonzero(~(apart <= agreed))
    count = int(beyond[0]) if len(beyond) else len(apart)
    if count == 0:
        raise TouchdownError(
            f"{first.solver.title} and {second.solver.title} differ by {1e6 * apart[0]:.2g} um at "
            f"t = {times[0]:.4g} s already; there is no reference for errors of {1e6 * agreed:.2g} um"
        )
    return Reference(times[:count], first, second, count == len(times))
