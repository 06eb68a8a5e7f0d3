"""What a scene does not need: error and time of each variant against the scene as it is.

Errors are found in process, wall time through FMUs unless asked otherwise, with recording as in a run.
"""

from __future__ import annotations

import math
import statistics
import tempfile
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from touchdown.master.common.errors import TouchdownError
from touchdown.master.coupling.loop.span import brief
from touchdown.master.coupling.simulation import Outcome, opened, refuse_endless, simulate
from touchdown.master.results.summary import seat_name, touchdown_seats
from touchdown.master.scene.scene import Scene
from touchdown.master.studies.drop.first_impact import LEAST, Peaks, Stop, Trace, run_watched
from touchdown.master.studies.models.variants import Variant

LONGEST = 20e-3  # s after the first contact
CLEAR = 5.0  # %: what costs less may be left out
FASTER = 0.95  # of the time: what is left out for less is no gain


@dataclass(frozen=True)
class Drop:
    """One variant's first impacts, by seat."""

    first: float  # s from zero, the first contact
    ends: Mapping[str, float]  # s from zero, of the first impact
    peaks: Mapping[str, Peaks]  # in it
    traces: Mapping[str, Trace]

    def orbit(self) -> float:
        """Farthest any journal gets from where it floated, up to the end (m)."""
        return max(
            float(np.max(np.hypot(t.x - t.x[0], t.y - t.y[0])[t.time >= self.first]))
            for t in self.traces.values()
        )


@dataclass(frozen=True)
class Price:
    """What a variant changes."""

    first: float  # s, of the first contact
    force: float  # relative, of the peak force on the journal, averaged; the worst seat, with its sign
    contact: float  # relative, of the momentary contact force; the worst seat, with its sign
    position: float  # m, distance of the worst journal at the end of the scene's first impact there
    orbit: float  # relative, of the largest orbit
    radius: float  # m, the scene's largest orbit
    ball: float | None  # relative, of the peak force on the worst ball; None: no balls on one side
    side: float | None  # relative, of the peak force between a ball and the cage or its neighbour

    @property
    def percent(self) -> float:
        """The largest change of the journal's forces, position over orbit, and orbit."""
        parts = (self.force, self.contact, self.position / self.radius, self.orbit)
        return 100.0 * max(abs(part) for part in parts)


@dataclass(frozen=True)
class Row:
    """A variant; without a price where it failed."""

    title: str
    price: Price | None = None
    wall: float | None = None  # s per simulated s
    ratio: float | None = None  # of wall time to the scene's, of runs one after the other
    failed: str = ""


@dataclass(frozen=True)
class Comparison:
    """All rows against the scene as it is."""

    scene: Scene
    end: float  # s from zero
    drop: Drop
    wall: float  # s per simulated s
    repeat: int
    in_process: bool
    rows: Sequence[Row]

    def dispensable(self) -> list[Row]:
        """What makes the scene faster for a price below CLEAR, the fastest first."""
        good = [
            r for r in self.rows if r.price and r.price.percent < CLEAR and r.ratio and r.ratio < FASTER
        ]
        return sorted(good, key=lambda row: row.ratio or math.inf)


def compare_models(
    scene: Scene,
    chosen: Sequence[Variant],
    duration: float | None = None,
    repeat: int = 3,
    in_process: bool = False,
    begin: Callable[[str], object] = lambda what: None,
) -> Comparison:
    """Run `scene` and its variants `duration` (s) from the first contact, LONGEST without one.

    begin(what) is called before the scene and before each variant. Raises TouchdownError where the scene
    itself does not land or stops; a variant says so in its row.
    """
    refuse_endless(duration or LONGEST, scene.run.macro_step)
    scene = _unjudged(scene)
    begin("the scene as it is")
    exact, outcome = _dropped(scene, Stop(LONGEST if duration is None else duration, early=False))
    as_long = {"run.duration": outcome.duration}
    stopwatch = _Stopwatch(scene.set(as_long), repeat, in_process)
    rows = []
    for variant in chosen:
        begin(variant.title)
        run = _unjudged(variant.scene).set(as_long)
        rows.append(_row(replace(variant, scene=run), exact, stopwatch))
    end = outcome.end - outcome.zero
    return Comparison(scene, end, exact, stopwatch.own(), repeat, in_process, rows)


def _unjudged(scene: Scene) -> Scene:
    """Without the ledger's thresholds, and without what they are measured by: other FMUs may lack it."""
    return replace(scene, energy_scale=())


def _row(variant: Variant, exact: Drop, stopwatch: _Stopwatch) -> Row:
    try:
        drop, _ = _dropped(variant.scene)
        return Row(variant.title, _price(drop, exact), *stopwatch.time(variant))
    except TouchdownError as error:
        return Row(variant.title, failed=str(error))


def _dropped(scene: Scene, stop: Stop | None = None) -> tuple[Drop, Outcome]:
    """The drop, and how its run ended."""
    with opened(scene, in_process=True) as system:
        seats = touchdown_seats(system)
        if not seats:
            raise TouchdownError(f"scene {scene.name} has no touchdown bearing to compare at")
        outcome, traces = run_watched(scene, system, seats, stop)
        touched = {seat_name(a, seats): system.value(f"{a.bearing}.contact.first_time") for a in seats}
    impacts = {seat: impact for seat, t in traces.items() if (impact := t.first_impact())}
    if not impacts:
        raise TouchdownError(f"nothing touches down within run.duration = {scene.run.duration:g} s")
    ends = {seat: end for seat, (_, end) in impacts.items()}
    peaks = {seat: traces[seat].peaks(end) for seat, end in ends.items()}
    first = min(touched[seat] for seat in impacts) - outcome.zero
    return Drop(first, ends, peaks, traces), outcome


def _price(drop: Drop, exact: Drop) -> Price:
    """`drop` against `exact`; a seat that only one of them touches is not compared."""
    both = [seat for seat in exact.ends if seat in drop.ends]
    if not both:
        raise TouchdownError("it touches down at other seats")
    force, contact = (
        max((getattr(drop.peaks[s], kind) / getattr(exact.peaks[s], kind) - 1.0 for s in both), key=abs)
        for kind in ("force", "contact")
    )
    places = [
        np.subtract(_place(drop.traces[s], exact.ends[s]), _place(exact.traces[s], exact.ends[s]))
        for s in both
    ]
    radius = exact.orbit()
    return Price(
        first=drop.first - exact.first,
        force=force,
        contact=contact,
        position=float(max(np.hypot(*place) for place in places)),
        orbit=drop.orbit() / radius - 1.0,
        radius=radius,
        ball=_change_inside(drop, exact, both, "ball"),
        side=_change_inside(drop, exact, both, "side"),
    )


def _change_inside(drop: Drop, exact: Drop, seats: Sequence[str], part: str) -> float | None:
    """Relative, of a peak force inside by the end of the scene's first impact; the worst of `seats`.

    None where none of them has that part in both, or it is but grazed.
    """
    changes = []
    for seat in seats:
        end = exact.ends[seat]
        before = exact.traces[seat].momentary_until(end).get(part, 0.0)
        after = drop.traces[seat].momentary_until(end).get(part)
        if after is not None and before >= LEAST:
            changes.append(after / before - 1.0)
    return max(changes, key=abs, default=None)


def _place(trace: Trace, time: float) -> tuple[float, float]:
    return float(np.interp(time, trace.time, trace.x)), float(np.interp(time, trace.time, trace.y))


class _Stopwatch:
    """Times variants against the scene as it is, one after the other: a busy machine slows both."""

    def __init__(self, scene: Scene, repeat: int, in_process: bool) -> None:
        self._scene, self._repeat, self._in_process = Variant("", scene), repeat, in_process
        self._spent: list[float] = []
        self._warm_up(self._scene)

    def time(self, variant: Variant) -> tuple[float, float]:
        """Wall time per simulated second, and its ratio to the scene's own; medians."""
        self._warm_up(variant)
        own, others = [], []
        for _ in range(self._repeat):
            own.append(self._once(self._scene))
            others.append(self._once(variant))
        self._spent += own
        ratios = [other / mine for other, mine in zip(others, own, strict=True)]
        return statistics.median(others), statistics.median(ratios)

    def own(self) -> float:
        """Wall time per simulated second of the scene as it is: the median of all its runs."""
        return statistics.median(self._spent or [self._once(self._scene)])

    def _warm_up(self, variant: Variant) -> None:
        """Compile what is to be timed."""
        self._once(variant, 2)

    def _once(self, variant: Variant, steps: int | None = None) -> float:
        """Wall time per simulated second, of the whole run or of its first macro steps."""
        scene = variant.scene
        with tempfile.TemporaryDirectory() as folder, opened(scene, self._in_process) as system:
            record_to = Path(folder) / "result.h5" if variant.recorded else None
            run = scene if steps is None else brief(scene, system, steps)
            outcome = simulate(run, system, record_to)
        outcome.raise_if_stopped()
        return outcome.wall_time / outcome.simulated
