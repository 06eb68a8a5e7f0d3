"""Speed against error of coupling schemes on one drop.

Schemes run at several macro steps. Errors are found in process, which is the same to the bit as through
FMUs; wall time is through FMUs unless asked otherwise. Motion is measured against the monolithic reference.
The peak forces of the first impact (contact, most loaded ball, side of a ball), which bearings report from
inside their steps, are measured against fine steps of the co-simulation, adaptive inside bearings, whose
motion stands beside it.
"""

from __future__ import annotations

import statistics
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...master.common.errors import TouchdownError
from ...master.common.progress import SILENT_PROGRESS, Progress
from ...master.coupling.simulation import opened, refuse_endless, simulate
from ...master.scene.scene import Scene
from ..drop.impact_watch import CONTACT, INNER_PEAKS, forces_text
from ..drop.measured_drop import FINE_STEP, MAX_SPAN, Landing, Plan, Sampler, fine, land, plan
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
from ..findings import Column, Record, table
from .engine import (
    MONOLITHIC,
    Alarm,
    Comparison,
    Measure,
    Options,
    Order,
    Row,
    Stopwatch,
    Variant,
    measure_all,
)

ABOVE_FLOOR = 10.0  # an error counts from this many times the floor of what it is measured against
MIN_SLOPE = 0.5  # least slope between neighbours: below it something else than the macro step errs
MIN_FITTED_STEPS = 3  # steps that a slope is fitted to


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
LOOSE_SOLVERS = (Solver("DOP853", 1e-3), Solver("DOP853", 1e-6), Solver("Radau", 1e-3))
LOOSE_SOLVERS_OF_MANY = LOOSE_SOLVERS[:1]  # each takes about as long as the reference
REFERENCE_AGREEMENT = 0.1  # of the target error: what the reference's solvers may differ by
SATURATION = 0.2  # of the motion's extent, of the force, of the energy: such an error is not a trend
QUANTITIES = {
    "position": Measure("position_error_m", ("journal", "[um]"), 1e6, ".2g"),
    "velocity": Measure("velocity_error_m_s", ("velocity", "[mm/s]"), 1e3, ".2g"),
    "force": Measure("force_error_relative", ("peak force", "[%]"), 100.0, ".2g"),
    "ball": Measure("ball_error_relative", ("most loaded ball", "[%]"), 100.0, ".2g"),
    "side": Measure("side_error_relative", ("ball side", "[%]"), 100.0, ".2g"),
    "energy": Measure("energy_error_relative", ("ledger", "[1]"), 1.0, ".2g"),
}


@dataclass(frozen=True)
class _Measured:
    """What schemes are measured against."""

    landing: Landing
    exact: Reference
    fine: Mapping[str, float]  # errors of the fine co-simulation: its motion, its forces at twice the step

    @property
    def forces(self) -> Sequence[str]:
        """The quantities that are peak forces: of balls where there are some that do not only graze."""
        return [q for q in QUANTITIES if q in self.fine and (q == CONTACT or q in INNER_PEAKS)]


def compare(scene: Scene, options: Options, progress: Progress = SILENT_PROGRESS) -> Comparison:
    """Run every scheme at every macro step. Without a duration, until the first impact is over.

    Raises TouchdownError where nothing touches, or where there is no reference. A scheme that stops or
    fails says so in its row.
    """
    options = options if options.macro_steps else replace(options, macro_steps=STEPS)
    limits = scene.run.warn_residual, scene.run.stop_residual
    scene = undivided(scene)
    refuse_endless(max(options.duration or MAX_SPAN, options.timed or 0.0), min(options.macro_steps))
    progress.planned(2 + len(options.schemes) * len(options.macro_steps))
    landing = land(scene, options.duration)
    progress.done()
    looks = plan(landing, (*options.macro_steps, 2.0 * FINE_STEP))
    scene = scene.set({"run.duration": landing.duration})
    solves = _solves(scene, looks, progress)
    exact = reference(looks.times, solves[0], solves[1], REFERENCE_AGREEMENT * options.wanted)
    judge = _Judge(looks, exact, Stopwatch(options), options.timed, *limits)
    measured = _Measured(landing, exact, judge.finely(scene, 2.0 * FINE_STEP))
    progress.done()
    judge.stopwatch.warm_up(Variant("", scene))
    variants = [
        Variant(name, scene.set({"run.scheme": name, "run.macro_step": step}), step)
        for name in options.schemes
        for step in options.macro_steps
    ]
    rows = measure_all(variants, judge.measure, progress.done)
    quantities = {key: quantity for key, quantity in QUANTITIES.items() if key in measured.fine}
    floors = {
        "position": exact.floor(POSITION),
        "velocity": exact.floor(VELOCITY),
        **{q: measured.fine[q] for q in measured.forces},
        "energy": 0.0,
    }
    orders = {name: _fitted(rows, name, exact, floors) for name in options.schemes}
    return Comparison(
        "schemes",
        f"{scene.title}: up to {1e3 * (landing.end - landing.first):.3g} ms after the first contact, "
        f"{judge.stopwatch.title}",
        list(_about(scene, measured, judge.stopwatch)),
        rows,
        quantities,
        [_monolithic(s, exact) for s in solves if isinstance(s.solver, Solver)],
        measured,
        targets={"position": options.wanted},
        floors=floors,
        orders=orders,
        drawn=list(quantities),
        notes=_order_lines(orders, quantities, len(options.macro_steps)),
        advise=_advice,
        tables={"orders.csv": list(_order_records(orders))},
    )


def _fitted(
    rows: Sequence[Row], scheme: str, exact: Reference, floors: Mapping[str, float]
) -> Mapping[str, Order | None]:
    """By quantity; None where too few macro steps tell."""
    extents = {"position": exact.extent(POSITION), "velocity": exact.extent(VELOCITY)}
    orders = {}
    for q, floor in floors.items():
        by_step = {r.step: r.errors[q] for r in rows if r.name == scheme and r.step and q in r.errors}
        orders[q] = fitted_order(
            list(by_step), list(by_step.values()), floor, SATURATION * extents.get(q, 1.0)
        )
    return orders


def _solves(scene: Scene, looks: Plan, progress: Progress) -> list[Solve]:
    """Both solutions of the reference, then looser ones."""
    solvers: Sequence[Solver | Refined] = REFINED
    seats = looks.landing.seats
    if has_equations(scene):
        first, second = pair(scene)
        solvers = (first, second, *(LOOSE_SOLVERS if second.implicit else LOOSE_SOLVERS_OF_MANY))
        solve(scene, seats, looks.times[:1], Solver(FIRST_SOLVER.method, 1e-3))  # compiles
    progress.planned(len(solvers))
    solves: list[Solve] = []
    for solver in solvers:
        if isinstance(solver, Refined):
            solves.append(refine(scene, seats, looks.times, solver))
        else:
            solves.append(solve(scene, seats, looks.times, solver))
        progress.done()
    return solves


def _monolithic(solution: Solve, exact: Reference) -> Row:
    """A solution against the reference, the reference against the other one."""
    other = exact.second if solution is exact.first else exact.first
    count = len(exact.time)
    errors = {
        name: largest_distance(solution.motion[:count], other.motion[:count], part)
        for name, part in (("position", POSITION), ("velocity", VELOCITY))
    }
    return Row(solution.solver.title, None, errors, solution.wall, group=MONOLITHIC)


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
        errors, share = self._errors(variant.scene, variant.step or FINE_STEP)
        alarm = Alarm.STOPS if share > self.stop else Alarm.WARNS if share > self.warn else Alarm.NONE
        row = Row(variant.name, variant.step, errors, ledger=alarm)
        if self.timed is not None:
            variant = replace(variant, scene=variant.scene.set({"run.duration": self.timed}))
        try:
            (walls,) = self.stopwatch.in_turns(variant)
        except TouchdownError as error:
            return replace(row, failed=f"while it was timed: {error}")
        return replace(row, wall=statistics.median(walls))

    def finely(self, scene: Scene, step: float) -> Mapping[str, float]:
        """The errors of fine macro steps of `step` (s). Raises TouchdownError where the run stops."""
        try:
            return self._errors(fine(scene, step), step)[0]
        except TouchdownError as error:
            raise TouchdownError(f"with macro steps of {1e6 * step:g} us: {error}") from None

    def _errors(self, scene: Scene, step: float) -> tuple[Mapping[str, float], float]:
        """Of a run with macro steps of `step` (s), and the ledger's share that thresholds are of."""
        with opened(scene, True) as system:
            sampler = Sampler(system, self.looks.landing, self.looks.every[step])
            outcome = simulate(scene, system, observers=[sampler])
        outcome.raise_if_stopped()
        times = np.array(sampler.times) - self.looks.landing.zero
        motion = np.array(sampler.motion)
        indices = np.minimum(np.searchsorted(self.exact.time, times - 1e-10), len(self.exact.time) - 1)
        known = np.abs(self.exact.time[indices] - times) < 1e-10  # up to the horizon
        errors = {
            "position": self.exact.distance(motion[known], indices[known], POSITION),
            "velocity": self.exact.distance(motion[known], indices[known], VELOCITY),
            **self.looks.landing.force_errors(sampler.peaks),
            "energy": outcome.residual,
        }
        return errors, outcome.share


def _about(scene: Scene, measured: _Measured, stopwatch: Stopwatch) -> Iterator[str]:
    landing, exact = measured.landing, measured.exact
    yield scene.title
    for seat, (start, end) in landing.impacts.items():
        forces = forces_text(landing.peaks(seat))
        yield f"  {seat}: first impact {1e3 * start:.4g} to {1e3 * end:.4g} ms, {forces}"
    first, second = exact.first, exact.second
    counted = "macro steps" if isinstance(first.solver, Refined) else "evaluations"
    known = ", ".join(f"{QUANTITIES[q].head[0]} {100.0 * measured.fine[q]:.1g} %" for q in measured.forces)
    until = "the end" if exact.whole else f"{1e3 * exact.horizon:.4g} ms, where they part"
    yield (
        f"compared up to {1e3 * landing.end:.4g} ms, {1e3 * (landing.end - landing.first):.3g} ms after "
        "the first contact"
    )
    yield (
        f"reference: {first.solver.title} ({first.evaluations} {counted}) and {second.solver.title} "
        f"({second.evaluations}) agree to {1e6 * exact.floor(POSITION):.1g} um up to {until}"
    )
    yield (
        f"co-simulation in fine steps is off by {1e6 * measured.fine['position']:.1g} um; "
        f"peak forces are measured against it, known to: {known}"
    )
    yield f"wall time {stopwatch.title}; of monolithic solvers, one run in process"


def _order_lines(
    orders: Mapping[str, Mapping[str, Order | None]], quantities: Mapping[str, Measure], steps: int
) -> list[str]:
    """By scheme; the steps used stand beside the order."""
    if steps < MIN_FITTED_STEPS:
        return [f"an order is fitted to {MIN_FITTED_STEPS} macro steps or more"]

    def cell(order: Order | None) -> str:
        return (
            f"{order.value:.2f} ({1e6 * order.steps[0]:g}-{1e6 * order.steps[-1]:g} us)" if order else "-"
        )

    columns = [
        Column[str](quantity.head[:1], lambda scheme, key=key: cell(orders[scheme][key]))
        for key, quantity in quantities.items()
    ]
    return table(Column[str](("order",), str), columns, list(orders), width=22)


def _order_records(orders: Mapping[str, Mapping[str, Order | None]]) -> Iterator[Record]:
    """Fitted orders, and the steps they were fitted to."""
    for scheme, by_quantity in orders.items():
        for quantity, order in by_quantity.items():
            steps = " ".join(f"{step:g}" for step in (order.steps if order else ()))
            value = order and order.value
            yield {"scheme": scheme, "quantity": quantity, "order": value, "macro_steps_s": steps}


def _advice(comparison: Comparison) -> list[str]:
    """Scheme and macro step for the error that is wanted."""
    target = f"for {1e6 * comparison.targets['position']:g} um: "
    best = comparison.recommended()
    if best is None:
        errors = [row for row in comparison.rows if row.errors]
        if not errors:
            return [f"{target}no scheme got there; try smaller --macro-steps"]
        least = min(errors, key=lambda row: row.errors["position"])
        near = f"{least.name} at {1e6 * (least.step or 0.0):g} us comes nearest"
        return [f"{target}none of these, {near}; try smaller --macro-steps or a larger --wanted"]
    lines = [
        f'{target}--set run.scheme={best.name} --set "run.macro_step={1e6 * (best.step or 0.0):g} us" is '
        f"{1e6 * best.errors['position']:.2g} um off and takes {best.wall:.3g} s per simulated s"
    ]
    if solver := comparison.cheapest(comparison.beside):
        lines.append(f"  the fastest monolithic solver there, {solver.name}, takes {solver.wall:.3g} s")
    return lines
