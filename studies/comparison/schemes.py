"""Speed against error of coupling schemes on one drop, and advice on the macro step before a run.

The comparison runs schemes at several macro steps. Errors are found in process, which is the same to the
bit as through FMUs; wall time is through FMUs unless asked otherwise. Motion is measured against the
monolithic reference. The peak forces of the first impact (contact, most loaded ball, side of a ball), which
bearings report from inside their steps, are measured against fine steps of the co-simulation, adaptive
inside bearings, whose motion stands beside it.

The advice needs no run (`advise`). A touchdown bearing states at which rate the journal swings on its
contact, from the contact's stiffness and from the masses and elastic modes that the journal moves with
(`contact.rate`, rad/s). A scheme takes so many radians of that swing in a macro step
(`Scheme.angle_limit`, measured: docs/coupling.md).
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...master.common.errors import TouchdownError
from ...master.coupling.simulation import Outcome, opened, refuse_endless, simulate
from ...master.coupling.system import fastest_contact
from ...master.scene.run_spec import tidy
from ...master.scene.scene import Scene
from ...master.scene.schemes import SCHEMES, Scheme, scheme
from ..drop.first_impact import CONTACT, INNER_PEAKS
from ..drop.measured import FINE_STEP, MAX_SPAN, Landing, Plan, Sampler, fine, land, plan
from ..drop.reference import (
    FIRST_SOLVER,
    POSITION,
    REFINED,
    VELOCITY,
    Reference,
    Refined,
    Solve,
    Solver,
    has_equations,
    largest_distance,
    pair,
    reference,
    refine,
    solve,
)
from ..drop.running import undivided
from .engine import Alarm, Begin, Quantity, Row, Stopwatch, Variant, begin_silently, cheapest, measure_all

ABOVE_FLOOR = 10.0  # an error counts from this many times the floor of what it is measured against
MIN_SLOPE = 0.5  # least slope between neighbours: below it something else than the macro step errs
MIN_FITTED_STEPS = 3  # steps that a slope is fitted to


@dataclass(frozen=True)
class Order:
    """Slope of log error over log step, and the steps (s) it was fitted to."""

    value: float
    steps: tuple[float, ...]


def fitted_order(
    steps: Sequence[float], errors: Sequence[float], floor: float, saturated: float
) -> Order | None:
    """The slope over the longest stretch of steps in which the error rises with the step.

    Errors within ABOVE_FLOOR times `floor`, from `saturated` on, and what is not a number are left out;
    a plateau, such as that of the steps inside a bearing, ends a stretch. None where it is too short.
    """
    stretch: list[tuple[float, float]] = []
    longest: list[tuple[float, float]] = []
    for step, error in sorted(zip(steps, errors, strict=True)):
        counts = error > 0.0 and ABOVE_FLOOR * floor < error < saturated
        if not counts:
            stretch = []
            continue
        if stretch and np.log(error / stretch[-1][1]) < MIN_SLOPE * np.log(step / stretch[-1][0]):
            stretch = []
        stretch.append((step, error))
        longest = max(longest, stretch, key=len).copy()
    if len(longest) < MIN_FITTED_STEPS:
        return None
    used, errors_used = zip(*longest, strict=True)
    return Order(float(np.polyfit(np.log(used), np.log(errors_used), 1)[0]), used)


STEPS = (5e-6, 1e-5, 2e-5, 5e-5, 1e-4)  # s
TARGET_ERROR_M = 1e-7  # m
LOOSE_SOLVERS = (Solver("DOP853", 1e-3), Solver("DOP853", 1e-6), Solver("Radau", 1e-3))
LOOSE_SOLVERS_OF_MANY = LOOSE_SOLVERS[:1]  # each takes about as long as the reference
REFERENCE_AGREEMENT = 0.1  # of the target error: what the reference's solvers may differ by
SATURATION = 0.2  # of the motion's extent, of the force, of the energy: such an error is no trend
SAME_TIME_FACTOR = 1.2  # times the least wall time: as good as the same


ERROR_QUANTITIES = {
    "position": Quantity(("journal", "[um]"), 1e6, ".2g", "position_error_m"),
    "velocity": Quantity(("velocity", "[mm/s]"), 1e3, ".2g", "velocity_error_m_s"),
    "force": Quantity(("peak force", "[%]"), 100.0, ".2g", "force_error_relative"),
    "ball": Quantity(("most loaded ball", "[%]"), 100.0, ".2g", "ball_error_relative"),
    "side": Quantity(("ball side", "[%]"), 100.0, ".2g", "side_error_relative"),
    "energy": Quantity(("ledger", "[1]"), 1.0, ".2g", "energy_error_relative"),
}


@dataclass(frozen=True)
class Options:
    """Options of a comparison."""

    schemes: Sequence[str] = tuple(SCHEMES)
    steps: Sequence[float] = STEPS  # s
    duration: float | None = None  # s from the first contact; None: until the first impact is over
    target: float = TARGET_ERROR_M  # m, error of the journal that is good enough
    repeat: int = 3  # runs that are timed
    timed: float | None = None  # s, their duration from the scene's zero; None: as what is compared
    in_process: bool = False


@dataclass(frozen=True)
class Comparison:
    """All rows, and what they are measured against."""

    scene: Scene
    options: Options
    landing: Landing
    exact: Reference
    fine: Mapping[str, float]  # errors of the fine co-simulation: its motion, its forces at twice the step
    rows: Sequence[Row]  # schemes
    monolithic: Sequence[Row]

    @property
    def quantities(self) -> Mapping[str, Quantity]:
        """The quantities that can be compared: fewer without balls, or with balls that only graze."""
        return {key: quantity for key, quantity in ERROR_QUANTITIES.items() if key in self.fine}

    @property
    def forces(self) -> Sequence[str]:
        """The `quantities` that are peak forces."""
        return [q for q in self.quantities if q == CONTACT or q in INNER_PEAKS]

    @property
    def floors(self) -> Mapping[str, float]:
        """By quantity: errors below it say nothing."""
        position, velocity = self.exact.floor(POSITION), self.exact.floor(VELOCITY)
        forces = {q: self.fine[q] for q in self.forces}
        return {"position": position, "velocity": velocity, **forces, "energy": 0.0}

    @property
    def targets(self) -> Mapping[str, float]:
        """By quantity: errors that are good enough, of those that the advice goes by."""
        return {"position": self.options.target}

    def orders(self, scheme: str) -> Mapping[str, Order | None]:
        """By quantity; None where too few macro steps tell."""
        extents = {"position": self.exact.extent(POSITION), "velocity": self.exact.extent(VELOCITY)}
        orders = {}
        for q in self.quantities:
            of = {r.step: r.errors[q] for r in self.rows if r.name == scheme and r.step and q in r.errors}
            limit = SATURATION * extents.get(q, 1.0)
            orders[q] = fitted_order(list(of), list(of.values()), self.floors[q], limit)
        return orders

    def recommended(self) -> Row | None:
        """The cheapest row of a scheme whose journals err by no more than the target.

        Ledgers that do not warn go first; of rows that take about the same time the most accurate one.
        """
        quiet = self._cheapest([row for row in self.rows if row.ledger is Alarm.NONE])
        return quiet or self._cheapest([row for row in self.rows if row.ledger is not Alarm.STOPS])

    def recommended_solver(self) -> Row | None:
        """The cheapest monolithic solver that errs by no more than the target."""
        return self._cheapest(self.monolithic)

    def _cheapest(self, rows: Iterable[Row]) -> Row | None:
        good = [row for row in rows if row.errors.get("position", math.inf) <= self.options.target]
        return cheapest(good, SAME_TIME_FACTOR)


def compare_schemes(scene: Scene, options: Options, begin: Begin = begin_silently) -> Comparison:
    """Run everything; begin(what) before each of `pieces(scene, options)` pieces of work.

    Raises TouchdownError where nothing touches, or where there is no reference. A scheme that stops or
    fails says so in its row.
    """
    limits = scene.run.warn_residual, scene.run.stop_residual
    scene = undivided(scene)
    begin("fine steps")
    refuse_endless(max(options.duration or MAX_SPAN, options.timed or 0.0), min(options.steps))
    landing = land(scene, options.duration)
    looks = plan(landing, (*options.steps, 2.0 * FINE_STEP))
    scene = scene.set({"run.duration": landing.duration})
    solves = _solves(scene, looks, begin)
    exact = reference(looks.times, solves[0], solves[1], REFERENCE_AGREEMENT * options.target)
    judge = _Judge(looks, exact, Stopwatch(options.repeat, options.in_process), options.timed, *limits)
    begin("fine steps")
    finely = judge.errors(fine(scene, 2.0 * FINE_STEP), 2.0 * FINE_STEP)
    judge.stopwatch.warm_up(Variant("", scene))
    rows = measure_all(_variants(scene, options), judge.measure, begin)
    monolithic = [_monolithic(s, exact) for s in solves if isinstance(s.solver, Solver)]
    return Comparison(scene, options, landing, exact, finely, rows, monolithic)


def _variants(scene: Scene, options: Options) -> Iterator[Variant]:
    """Every scheme at every macro step."""
    for name in options.schemes:
        for step in options.steps:
            yield Variant(name, scene.set({"run.scheme": name, "run.macro_step": step}), step)


def pieces(scene: Scene, options: Options) -> int:
    """How many pieces of work a comparison is."""
    return 2 + len(_solvers(scene)) + len(options.schemes) * len(options.steps)


def _solves(scene: Scene, looks: Plan, begin: Begin) -> list[Solve]:
    """Both solutions of the reference, then looser ones."""
    seats, solvers = looks.landing.seats, _solvers(scene)
    if has_equations(scene):
        solve(scene, seats, looks.times[:1], Solver(FIRST_SOLVER.method, 1e-3))  # compiles
    solves: list[Solve] = []
    for solver in solvers:
        begin(solver.title)
        if isinstance(solver, Refined):
            solves.append(refine(scene, seats, looks.times, solver))
        else:
            solves.append(solve(scene, seats, looks.times, solver))
    return solves


def _solvers(scene: Scene) -> Sequence[Solver | Refined]:
    """The solvers of the reference, then looser ones."""
    if not has_equations(scene):
        return REFINED
    first, second = pair(scene)
    return first, second, *_loose(second)


def _loose(second: Solver) -> Sequence[Solver]:
    return LOOSE_SOLVERS if second.implicit else LOOSE_SOLVERS_OF_MANY


def _monolithic(solution: Solve, exact: Reference) -> Row:
    """A solution against the reference, the reference against the other one."""
    other = exact.second if solution is exact.first else exact.first
    count = len(exact.time)
    errors = {
        name: largest_distance(solution.motion[:count], other.motion[:count], part)
        for name, part in (("position", POSITION), ("velocity", VELOCITY))
    }
    return Row(solution.solver.title, None, errors, solution.wall)


@dataclass(frozen=True)
class _Judge:
    """Measures runs against the reference."""

    looks: Plan
    exact: Reference
    stopwatch: Stopwatch
    timed: float | None  # s, duration of the runs that are timed; None: as what is compared
    warn: float
    stop: float

    def measure(self, variant: Variant) -> Row:
        """Errors and wall time of a variant."""
        sampler, outcome = self._sampled(variant.scene, variant.step or FINE_STEP)
        errors = self._errors(sampler, outcome.residual)
        row = Row(variant.name, variant.step, errors, ledger=self._alarm(outcome.share))
        if self.timed is not None:
            variant = replace(variant, scene=variant.scene.set({"run.duration": self.timed}))
        return self.stopwatch.timed(row, variant)

    def errors(self, scene: Scene, step: float) -> Mapping[str, float]:
        """The errors of a run with macro steps of `step` (s). Raises TouchdownError where it stops."""
        try:
            sampler, outcome = self._sampled(scene, step)
        except TouchdownError as error:
            raise TouchdownError(f"with macro steps of {1e6 * step:g} us: {error}") from None
        return self._errors(sampler, outcome.residual)

    def _sampled(self, scene: Scene, step: float) -> tuple[Sampler, Outcome]:
        with opened(scene, True) as system:
            sampler = Sampler(system, self.looks.landing, self.looks.every[step])
            outcome = simulate(scene, system, observers=[sampler])
        outcome.raise_if_stopped()
        return sampler, outcome

    def _alarm(self, share: float) -> Alarm:
        if share > self.stop:
            return Alarm.STOPS
        return Alarm.WARNS if share > self.warn else Alarm.NONE

    def _errors(self, sampler: Sampler, residual: float) -> Mapping[str, float]:
        times = np.array(sampler.times) - self.looks.landing.zero
        motion = np.array(sampler.motion)
        at = np.searchsorted(self.exact.time, times - 1e-10)
        at = np.minimum(at, len(self.exact.time) - 1)
        known = np.abs(self.exact.time[at] - times) < 1e-10  # up to the horizon
        return {
            "position": self.exact.distance(motion[known], at[known], POSITION),
            "velocity": self.exact.distance(motion[known], at[known], VELOCITY),
            **self.looks.landing.force_errors(sampler.peaks),
            "energy": residual,
        }


LONGEST_MACRO_STEP = 1e-4  # s; what happens within a longer macro step is lost to recording and ledger


@dataclass(frozen=True)
class Advice:
    """A macro step, and why."""

    macro_step: float  # s
    reason: str


def advise(scene: Scene, names: Iterable[str] | None = None) -> dict[str, Advice]:
    """The macro step that each of the schemes `names` can take in `scene`; without names, the scene's own.

    Raises TouchdownError where the scene cannot be assembled, or no bearing states its contact's rate.
    """
    with opened(scene, in_process=True) as system:
        system.initialise()
        bearing, rate = fastest_contact(system)
    return {name: _for(scheme(name), bearing, rate) for name in names or [scene.run.scheme.name]}


def _for(chosen: Scheme, bearing: str, rate: float) -> Advice:
    return Advice(
        tidy(min(chosen.angle_limit / rate, LONGEST_MACRO_STEP)),
        f"the journal swings at {rate / (2.0 * math.pi):.3g} Hz on the contact of {bearing}, and scheme "
        f"{chosen.name} takes {chosen.angle_limit:g} rad of that in a macro step, "
        f"up to {1e6 * LONGEST_MACRO_STEP:g} us",
    )
