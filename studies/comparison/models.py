"""Parts that a scene does not need: variants of it, their error and time against the scene as it is.

Errors are found in process, wall time through FMUs unless asked otherwise, with recording as in a run.
"""

from __future__ import annotations

import math
import statistics
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from matplotlib.figure import Figure

from ...master.common.errors import TouchdownError
from ...master.coupling.simulation import Outcome, opened, refuse_endless
from ...master.coupling.system import System
from ...master.results.summary import touchdown_seats
from ...master.scene.scene import ComponentSpec, Scene
from ...reports.figures.style import BLUE, GREY, sheet
from ..drop.first_impact import (
    AVERAGING_TIME,
    INNER_PEAKS,
    MIN_PEAK,
    Peaks,
    Stop,
    Trace,
    forces_text,
    watched_drop,
)
from ..drop.measured import finest_inside
from ..findings import Column, Findings, Record, number, paragraphs, table
from .engine import (
    WALL_TIME,
    Begin,
    Quantity,
    Row,
    Stopwatch,
    Variant,
    begin_silently,
    error_cells,
    error_columns,
    measure_all,
)
from .modes import BASIS_PARAMETERS, RIGID_MODES

MODES = (3, 10, 20)  # per plane, beside the scene's own number and the rigid rotor
ALTERNATIVE_MODELS = {
    "angular_caged": ("angular_simplified", "simplified bearings"),
    "angular_cageless": ("angular_simplified", "simplified bearings"),
    "angular_simplified": ("angular_caged", "detailed bearings"),
    "detailed_caged": ("simplified_caged", "simplified bearings"),
    "detailed_cageless": ("simplified_cageless", "simplified bearings"),
    "simplified_caged": ("detailed_caged", "detailed bearings"),
    "simplified_cageless": ("detailed_cageless", "detailed bearings"),
}
IN_SPACE = "angular_"  # begins the names of bearings in space
COULOMB = 0  # of friction.kind
STEPPING_PARAMETERS = ("interface.", "micro_step")
TOLERANCE_FACTOR = 100.0  # times the tolerance inside a bearing
OFFSETS = ("x0", "y0")  # of a housing out of line


def variants(scene: Scene) -> list[Variant]:
    """All that apply, the coupling first."""
    with opened(scene, in_process=True) as system:
        seats = dict.fromkeys(a.bearing for a in touchdown_seats(system))
        return [
            *_coupling(scene, system),
            *_rotors(scene, system),
            *_bearings(scene, system, list(seats)),
            *_friction(scene, system, list(seats)),
            *_inner_steps(scene, system, list(seats)),
            *_housings(scene, system),
            Variant("nothing recorded", scene, recorded=False),
        ]


def _coupling(scene: Scene, system: System) -> Iterator[Variant]:
    """How much of every difference is the coupling's: half the macro step tells."""
    step = scene.run.macro_step
    for factor in (0.5, 2.0):
        run = scene.set({"run.macro_step": factor * step})
        yield Variant(f"macro step of {1e6 * factor * step:g} us", run)
    if scene.run.scheme.modes and _flexible(system):
        run = scene.set({"run.scheme": "point-mass"})
        yield Variant("rotor's modes not carried (point-mass)", run)


def _flexible(system: System) -> list[str]:
    return [n for n, c in system.components.items() if all(v in c.variables for v in BASIS_PARAMETERS)]


def _rotors(scene: Scene, system: System) -> Iterator[Variant]:
    rotors = _flexible(system)
    if not rotors:
        return
    modes = {system.value(f"{name}.modes") for name in rotors}
    yield Variant("rigid rotor", _all(scene, rotors, {"modes": RIGID_MODES, "residual": 0}))
    for count in MODES:
        if modes != {count}:
            yield Variant(f"{count} modes", _all(scene, rotors, {"modes": count}))
    if any(system.value(f"{name}.residual") for name in rotors):
        yield Variant("no residual flexibility", _all(scene, rotors, {"residual": 0}))
    else:
        yield Variant("with residual flexibility", _all(scene, rotors, {"residual": 1}))
    if any(system.value(f"{name}.stress.active") for name in rotors):
        yield Variant("no stresses", _all(scene, rotors, {"stress.active": 0}))


def _all(scene: Scene, names: Sequence[str], values: Mapping[str, object]) -> Scene:
    return scene.set({f"{name}.{key}": value for name in names for key, value in values.items()})


def _bearings(scene: Scene, system: System, seats: Sequence[str]) -> Iterator[Variant]:
    known = {
        name: ALTERNATIVE_MODELS[fmu]
        for name in seats
        if (fmu := scene.components[name].fmu) in ALTERNATIVE_MODELS
    }
    if known:
        title = " and ".join(dict.fromkeys(title for _, title in known.values()))
        yield Variant(title, _swapped(scene, system, {name: fmu for name, (fmu, _) in known.items()}))
        plain = {
            name: "landing_sleeve" if scene.components[name].fmu.startswith(IN_SPACE) else "bushing"
            for name in known
        }
        yield Variant("plain bushings", _swapped(scene, system, plain))


def _swapped(scene: Scene, system: System, fmus: Mapping[str, str]) -> Scene:
    """With all parameters of the present ones that the others have too, but for those of their steps."""
    components = dict(scene.components)
    for name, fmu in fmus.items():
        variables = system.components[name].variables.values()
        parameters = [v.name for v in variables if v.causality == "parameter" and v.settable]
        values = {
            v: system.value(f"{name}.{v}") for v in parameters if not v.startswith(STEPPING_PARAMETERS)
        }
        components[name] = ComponentSpec(fmu, preset=components[name].preset, inherited=values)
    return replace(scene, components=components)


def _friction(scene: Scene, system: System, seats: Sequence[str]) -> Iterator[Variant]:
    """Other laws between journal and ring, with the scene's coefficients."""
    has = [name for name in seats if "friction.kind" in system.components[name].variables]
    if not has:
        return
    kind = system.components[has[0]].variable("friction.kind")
    present = {system.value(f"{name}.friction.kind") for name in has}
    for value in range(int(kind.minimum or 0), int(kind.maximum or 0) + 1):
        if present != {value}:
            yield Variant(f"friction: {kind.in_words(value)}", _with_law(scene, system, has, value))


def _with_law(scene: Scene, system: System, seats: Sequence[str], kind: int) -> Scene:
    """Scene with that friction law; Coulomb's has one coefficient only, the dynamic one."""
    for name in seats:
        changes: dict[str, object] = {f"{name}.friction.kind": kind}
        if kind == COULOMB:
            changes[f"{name}.friction.static"] = system.value(f"{name}.friction.dynamic")
        scene = scene.set(changes)
    return scene


def _inner_steps(scene: Scene, system: System, seats: Sequence[str]) -> Iterator[Variant]:
    """Longer steps inside bearings of fixed ones, a looser tolerance in those that adapt theirs; and the
    finest in all, which tell how far the scene's own are off.
    """
    fixed = [n for n in seats if "micro_step" in system.components[n].variables]
    fixed = [n for n in fixed if system.value(f"{n}.micro_step") > 0.0]
    if fixed:
        values = {f"{name}.micro_step": 2.0 * system.value(f"{name}.micro_step") for name in fixed}
        yield Variant("steps inside bearings twice as long", scene.set(values))
    variable = "interface.tolerance"
    rest = [n for n in seats if n not in fixed and variable in system.components[n].variables]
    if rest:
        values = {
            f"{name}.{variable}": TOLERANCE_FACTOR * system.value(f"{name}.{variable}") for name in rest
        }
        title = f"tolerance inside bearings {TOLERANCE_FACTOR:g} times as large"
        yield Variant(title, scene.set(values))
    if fixed or rest:
        yield Variant("fine adaptive steps inside bearings", scene.set(finest_inside(system)))


def _housings(scene: Scene, system: System) -> Iterator[Variant]:
    """Outer rings that stand in the ground, where no housing is out of line."""
    seats = touchdown_seats(system)
    bearings = {a.bearing for a in seats}
    mounts = [a for a in system.attachments if a.bearing in bearings and a not in seats]
    names = {a.body for a in mounts} - {a.body for a in seats}
    offsets = [f"{n}.{v}" for n in names for v in OFFSETS if v in system.components[n].variables]
    if not names or any(system.value(offset) for offset in offsets) or names & tied(scene):
        return
    yield Variant(
        "housings that stand still",
        replace(
            scene,
            components={n: c for n, c in scene.components.items() if n not in names},
            attach=tuple(pair for pair in scene.attach if pair[1].partition(".")[0] not in names),
        ),
    )


def tied(scene: Scene) -> set[str]:
    """Components that others depend on by sensors, single connections or bonds, beside bearings' ports."""
    wires = (*scene.connect, *(wire for bond in scene.bond for wire in bond.wires))
    pairs = (*scene.sense, *((wire.source, wire.target) for wire in wires))
    return {end.partition(".")[0] for pair in pairs for end in pair}


MAX_SPAN = 20e-3  # s after the first contact
MAX_CHANGE_PERCENT = 5.0  # %: what costs less may be left out
MAX_TIME_RATIO = 0.95  # of the time: what is left out for less is no gain


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
class Comparison:
    """All rows against the scene as it is.

    Errors of a row: "first" (s, of the first contact), "force" (relative, of the peak force on the journal,
    averaged), "contact" (of the momentary one), "position" (m, of the worst journal at the end of the
    scene's first impact there), "orbit" (relative, of the largest), and where the bearings of both have
    them "ball" and "side" (relative, of the peak forces on the most loaded ball, and between a ball and the
    cage or its neighbour). Relative ones are those of the worst seat, with their sign.
    """

    scene: Scene
    end: float  # s from zero
    drop: Drop
    wall: float  # s per simulated s
    repeat: int
    in_process: bool
    rows: Sequence[Row]

    def change_percent(self, row: Row) -> float:
        """The largest change of the journal's forces, position over orbit, and orbit (%)."""
        parts = [row.errors[key] for key in ("force", "contact", "orbit")]
        return 100.0 * max(map(abs, (*parts, row.errors["position"] / self.drop.orbit())))

    def dispensable(self) -> list[Row]:
        """Variants that are faster for a change below MAX_CHANGE_PERCENT, the fastest first."""
        good = [
            r
            for r in self.rows
            if r.ratio and r.ratio < MAX_TIME_RATIO and self.change_percent(r) < MAX_CHANGE_PERCENT
        ]
        return sorted(good, key=lambda row: row.ratio or math.inf)


def compare_models(
    scene: Scene,
    chosen: Sequence[Variant],
    duration: float | None = None,
    repeat: int = 3,
    in_process: bool = False,
    begin: Begin = begin_silently,
) -> Comparison:
    """Run `scene` and its variants `duration` (s) from the first contact, MAX_SPAN without one.

    begin(what) is called before the scene and before each variant. Raises TouchdownError where the scene
    itself does not land or stops; a variant says so in its row.
    """
    refuse_endless(duration or MAX_SPAN, scene.run.macro_step)
    scene = _unjudged(scene)
    begin("the scene as it is")
    exact, outcome = _dropped(scene, Stop(MAX_SPAN if duration is None else duration, early=False))
    as_long = {"run.duration": outcome.duration}
    own = Variant("as it is", scene.set(as_long))
    judge = _Judge(exact, own, as_long, Stopwatch(repeat, in_process))
    judge.stopwatch.warm_up(own)
    rows = measure_all(chosen, judge.measure, begin)
    end = outcome.end - outcome.zero
    return Comparison(scene, end, exact, judge.own_wall(), repeat, in_process, rows)


NOT_YET = -1.0  # contact.first_time without a contact


def _unjudged(scene: Scene) -> Scene:
    """Without the ledger's thresholds, and without what they are measured by: other FMUs may lack it."""
    return replace(scene, energy_scale=())


@dataclass(frozen=True)
class _Judge:
    """Measures variants against the scene as it is."""

    exact: Drop
    own: Variant
    as_long: Mapping[str, object]  # settings with which a run is as long as that of the scene
    stopwatch: Stopwatch
    walls: list[float] = field(default_factory=list[float])  # s per simulated s, of the scene as it is

    def measure(self, variant: Variant) -> Row:
        """Errors, wall time and its ratio to the scene's."""
        timed = replace(variant, scene=_unjudged(variant.scene).set(self.as_long))
        drop, _ = _dropped(timed.scene)
        errors = _errors(drop, self.exact)
        walls, own = self.stopwatch.against(timed, self.own)
        self.walls.extend(own)
        ratio = statistics.median(wall / mine for wall, mine in zip(walls, own, strict=True))
        return Row(variant.name, errors=errors, wall=statistics.median(walls), ratio=ratio)

    def own_wall(self) -> float:
        """Wall time per simulated second of the scene as it is: the median of all its runs."""
        return statistics.median(self.walls or [self.stopwatch.once(self.own)])


def _dropped(scene: Scene, stop: Stop | None = None) -> tuple[Drop, Outcome]:
    """The drop, and how its run ended."""
    with watched_drop(scene, stop) as drop:
        contacts = [drop.system.value(f"{a.bearing}.contact.first_time") for a in drop.seats]
    touched = dict(zip(drop.traces, contacts, strict=True))
    ends = {seat: end for seat, (_, end) in drop.impacts().items() if touched[seat] != NOT_YET}
    if not ends:
        raise TouchdownError(
            "no journal touches its bore before the end: models are compared by such landings; sweep over "
            "settings for those along the shaft, or give a longer --duration"
        )
    peaks = {seat: drop.traces[seat].peaks(end) for seat, end in ends.items()}
    first = min(touched[seat] for seat in ends) - drop.outcome.zero
    return Drop(first, ends, peaks, drop.traces), drop.outcome


def _errors(drop: Drop, exact: Drop) -> dict[str, float]:
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
    inside = {part: _change_inside(drop, exact, both, part) for part in INNER_PEAKS}
    return {
        "first": drop.first - exact.first,
        "force": force,
        "contact": contact,
        "position": float(max(np.hypot(*place) for place in places)),
        "orbit": drop.orbit() / exact.orbit() - 1.0,
        **{part: change for part, change in inside.items() if change is not None},
    }


def _change_inside(drop: Drop, exact: Drop, seats: Sequence[str], part: str) -> float | None:
    """Relative, of a peak force inside by the end of the scene's first impact; the worst of `seats`.

    None where none of them has that part in both, or it is but grazed.
    """
    changes = []
    for seat in seats:
        end = exact.ends[seat]
        before = exact.traces[seat].momentary_until(end).get(part, 0.0)
        after = drop.traces[seat].momentary_until(end).get(part)
        if after is not None and before >= MIN_PEAK:
            changes.append(after / before - 1.0)
    return max(changes, key=abs, default=None)


def _place(trace: Trace, time: float) -> tuple[float, float]:
    return float(np.interp(time, trace.time, trace.x)), float(np.interp(time, trace.time, trace.y))


MIN_DRAWN_CHANGE = 1e-3  # %; what no change is drawn as
WIDTH = 12  # of the table's columns
AS_IT_IS = "as it is"

ERROR_QUANTITIES = {
    "first": Quantity(("first", "contact us"), 1e6, "+.2f", "first_change_s"),
    "force": Quantity(("journal", "force %"), 100.0, "+.2f", "force_change_relative"),
    "contact": Quantity(("contact", "force %"), 100.0, "+.2f", "contact_change_relative"),
    "position": Quantity(("position", "um"), 1e6, ".3g", "position_change_m"),
    "orbit": Quantity(("orbit", "%"), 100.0, "+.2f", "orbit_change_relative"),
    "ball": Quantity(("most loaded ball", "force %"), 100.0, "+.2f", "ball_change_relative"),
    "side": Quantity(("ball side", "force %"), 100.0, "+.2f", "side_change_relative"),
}


def findings(comparison: Comparison) -> Findings:
    """The scene's own figures, a table of changes by variant, and the parts that may be left out."""
    return Findings(
        paragraphs(_about(comparison), _table(comparison), advice(comparison)),
        tables={"models.csv": _records(comparison)},
        pictures={"models.png": lambda: error_against_time(comparison)},
        dots_per_inch=110,
    )


def error_against_time(comparison: Comparison) -> Figure:
    """Bars of change and of time, a line for each variant, in the order of the table."""
    rows = [row for row in comparison.rows if not row.failed]
    figure = sheet(12, 1.6 + 0.32 * len(rows))
    change, time = figure.subplots(1, 2, sharey=True)
    names = [row.name for row in rows]
    changes = [max(comparison.change_percent(row), MIN_DRAWN_CHANGE) for row in rows]
    change.barh(names, changes, color=BLUE, left=MIN_DRAWN_CHANGE)
    change.axvline(MAX_CHANGE_PERCENT, color=GREY, ls="--", lw=0.8)
    change.set_xscale("log")
    change.set_xlabel("largest change of the journal's forces, position over orbit, orbit [%]")
    time.barh(names, [row.ratio for row in rows if row.ratio is not None], color=GREY)
    time.axvline(1.0, color=GREY, ls="--", lw=0.8)
    time.set_xlabel("wall time over that of the scene as it is")
    change.invert_yaxis()
    for axes in (change, time):
        axes.grid(alpha=0.3, axis="x")
    figure.suptitle(f"{comparison.scene.title}: what it does not need")
    return figure


def _about(comparison: Comparison) -> Iterator[str]:
    drop = comparison.drop
    yield comparison.scene.title
    average = max(AVERAGING_TIME, comparison.scene.run.macro_step)
    for seat, end in drop.ends.items():
        yield (
            f"  {seat}: first impact over at {1e3 * end:.4g} ms, journal force "
            f"{drop.peaks[seat].force:.5g} N over {1e6 * average:g} us, "
            f"{forces_text(drop.traces[seat].momentary_until(end))}"
        )
    yield (
        f"  first contact {1e3 * drop.first:.5g} ms, largest orbit {1e6 * drop.orbit():.4g} um up to "
        f"{1e3 * (comparison.end - drop.first):.3g} ms after it"
    )
    where = "in process" if comparison.in_process else "through FMUs"
    yield f"wall time {where}, recorded, median of {comparison.repeat}; position: as the impact ends"
    yield "other bearings have all parameters of the scene's that they know"


def _table(comparison: Comparison) -> list[str]:
    own = Row(AS_IT_IS, wall=comparison.wall, ratio=1.0)
    ratio = Column[Row](("time", "ratio"), lambda row: number(row.ratio, ".2f"))
    columns = [*error_columns(ERROR_QUANTITIES), WALL_TIME, ratio]
    label = Column[Row](("changes against the scene", ""), lambda row: row.name)
    rows = [own, *comparison.rows]
    return table(label, columns, rows, instead=lambda row: row.failed, width=WIDTH)


def advice(comparison: Comparison) -> list[str]:
    """Parts whose absence makes the scene faster without changing it by much."""
    good = comparison.dispensable()
    if not good:
        return [f"nothing of these makes the scene faster for less than {MAX_CHANGE_PERCENT:g} %"]
    return [
        f"for less than {MAX_CHANGE_PERCENT:g} % of the journal's forces, position (over the orbit) and "
        "orbit, each by itself:",
        *(
            f"  {row.name}: {comparison.change_percent(row):.2g} %, {row.ratio:.2f} of the time"
            f"{_inside(row)}"
            for row in good
        ),
    ]


def _inside(row: Row) -> str:
    """The change of the forces inside the bearings, as the rest of a line."""
    inside = {key: ERROR_QUANTITIES[key] for key in INNER_PEAKS if key in row.errors}
    return "".join(f"; {q.head[0]} {q.shown(row.errors[key])} %" for key, q in inside.items())


def _records(comparison: Comparison) -> Iterator[Record]:
    unchanged = dict.fromkeys(ERROR_QUANTITIES, 0.0)
    for row in (Row(AS_IT_IS, None, unchanged, comparison.wall, ratio=1.0), *comparison.rows):
        yield {
            "variant": row.name,
            **error_cells(row, ERROR_QUANTITIES),
            "wall_time_per_simulated_s": row.wall,
            "wall_time_ratio": row.ratio,
            "failed": row.failed,
        }
