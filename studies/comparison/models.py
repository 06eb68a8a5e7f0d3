"""Parts that a scene does not need: variants of it, their error and time against the unchanged scene.

Errors are found in process, wall time through FMUs unless asked otherwise, with recording as in a run.
"""

from __future__ import annotations

import statistics
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...master.common.errors import TouchdownError
from ...master.common.progress import SILENT_PROGRESS, Progress
from ...master.coupling.simulation import opened, refuse_endless
from ...master.coupling.system import System
from ...master.results.summary import touchdown_seats
from ...master.scene.scene import ComponentSpec, Scene
from ..drop.impact_watch import (
    AVERAGING_TIME,
    INNER_PEAKS,
    MIN_PEAK,
    Stop,
    Trace,
    forces_text,
    watched_drop,
)
from ..drop.measured_drop import finest_inside
from .engine import Comparison, Measure, Options, Row, Stopwatch, Variant, measure_all, relative
from .modes import RIGID_MODES, flexible_rotors

MODES = (3, 10, 20)  # per plane, beside the scene's own number and the rigid rotor
DETAILED = {
    "angular_simplified": "angular_caged",
    "simplified_caged": "detailed_caged",
    "simplified_cageless": "detailed_cageless",
}
SIMPLIFIED = {detailed: plain for plain, detailed in DETAILED.items()}
ALTERNATIVE_MODELS = {**DETAILED, **SIMPLIFIED, "angular_cageless": "angular_simplified"}
BODIES_IN_SPACE = ("angular_caged", "angular_cageless")
REFUSED_THERE = ("ring.harmonics",)  # their rings stay as they are
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
    for step in (0.5 * scene.run.macro_step, 2.0 * scene.run.macro_step):
        yield Variant(f"macro step of {1e6 * step:g} us", scene.set({"run.macro_step": step}))
    if scene.run.scheme.modes and flexible_rotors(system):
        yield Variant("rotor's modes not carried (point-mass)", scene.set({"run.scheme": "point-mass"}))


def _rotors(scene: Scene, system: System) -> Iterator[Variant]:
    rotors = flexible_rotors(system)
    if not rotors:
        return
    modes = {system.value(f"{name}.modes") for name in rotors}
    yield Variant("rigid rotor", _all(scene, rotors, {"modes": RIGID_MODES, "residual": 0}))
    for count in MODES:
        if modes != {count}:
            yield Variant(f"{count} modes", _all(scene, rotors, {"modes": count}))
    has = any(system.value(f"{name}.residual") for name in rotors)
    title = f"{'no' if has else 'with'} residual flexibility"
    yield Variant(title, _all(scene, rotors, {"residual": int(not has)}))
    if any(system.value(f"{name}.stress.active") for name in rotors):
        yield Variant("no stresses", _all(scene, rotors, {"stress.active": 0}))


def _all(scene: Scene, names: Sequence[str], values: Mapping[str, object]) -> Scene:
    return scene.set({f"{name}.{key}": value for name in names for key, value in values.items()})


def _bearings(scene: Scene, system: System, seats: Sequence[str]) -> Iterator[Variant]:
    known = {name: fmu for name in seats if (fmu := scene.components[name].fmu) in ALTERNATIVE_MODELS}
    if known:
        titles = [f"{'detailed' if fmu in DETAILED else 'simplified'} bearings" for fmu in known.values()]
        others = {name: ALTERNATIVE_MODELS[fmu] for name, fmu in known.items()}
        yield Variant(" and ".join(dict.fromkeys(titles)), _swapped(scene, system, others))
        plain = {n: "landing_sleeve" if fmu.startswith(IN_SPACE) else "bushing" for n, fmu in known.items()}
        yield Variant("plain bushings", _swapped(scene, system, plain))


def _swapped(scene: Scene, system: System, fmus: Mapping[str, str]) -> Scene:
    """With all parameters of the present ones that the others have too, but for those of their steps."""
    components = dict(scene.components)
    for name, fmu in fmus.items():
        variables = system.components[name].variables.values()
        parameters = [v.name for v in variables if v.causality == "parameter" and v.settable]
        left_out = REFUSED_THERE if fmu in BODIES_IN_SPACE else ()
        values = {
            v: system.value(f"{name}.{v}")
            for v in parameters
            if not v.startswith(STEPPING_PARAMETERS) and v not in left_out
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
            law = {f"{name}.friction.kind": value for name in has}
            if value == COULOMB:  # it has one coefficient only, the dynamic one
                law |= {f"{name}.friction.static": system.value(f"{name}.friction.dynamic") for name in has}
            yield Variant(f"friction: {kind.in_words(value)}", scene.set(law))


def _inner_steps(scene: Scene, system: System, seats: Sequence[str]) -> Iterator[Variant]:
    """Longer steps inside bearings of fixed ones, a looser tolerance in those that adapt theirs; and the
    finest in all, which tell how far the scene's own are off.
    """

    def larger(names: Sequence[str], variable: str, factor: float) -> Scene:
        return scene.set({f"{n}.{variable}": factor * system.value(f"{n}.{variable}") for n in names})

    fixed = [n for n in seats if f"{n}.micro_step" in system and system.value(f"{n}.micro_step") > 0.0]
    if fixed:
        yield Variant("steps inside bearings twice as long", larger(fixed, "micro_step", 2.0))
    rest = [n for n in seats if n not in fixed and f"{n}.interface.tolerance" in system]
    if rest:
        title = f"tolerance inside bearings {TOLERANCE_FACTOR:g} times as large"
        yield Variant(title, larger(rest, "interface.tolerance", TOLERANCE_FACTOR))
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
MAX_CHANGE = 0.05  # what costs less may be left out
MAX_TIME_RATIO = 0.95  # of the time: leaving a part out for less is not a gain
UNCHANGED = "unchanged"
NOT_YET = -1.0  # contact.first_time without a contact
QUANTITIES = {
    "first": Measure("first_change_s", ("first", "contact us"), 1e6, "+.2f"),
    "force": Measure("force_change_relative", ("journal", "force %"), 100.0, "+.2f"),
    "contact": Measure("contact_change_relative", ("contact", "force %"), 100.0, "+.2f"),
    "position": Measure("position_change_m", ("position", "um"), 1e6, ".3g"),
    "orbit": Measure("orbit_change_relative", ("orbit", "%"), 100.0, "+.2f"),
    "ball": Measure("ball_change_relative", ("most loaded ball", "force %"), 100.0, "+.2f"),
    "side": Measure("side_change_relative", ("ball side", "force %"), 100.0, "+.2f"),
    "change": Measure("largest_change_relative", ("largest", "change %"), 100.0, ".2g", least=1e-5),
}
"""first: of the first contact; force: of the peak on the journal, averaged; contact: of the momentary one;
position: of the worst journal at the end of the scene's first impact there; orbit: of the largest; ball and
side, where the bearings of both have them: of the peaks on the most loaded ball, and between a ball and the
cage or its neighbour. Relative ones are those of the worst seat, with their sign. change: the largest of
force, contact, orbit, and position over orbit.
"""


@dataclass(frozen=True)
class _Drop:
    """One variant's first impacts, by seat."""

    first: float  # s from zero, the first contact
    ends: Mapping[str, float]  # s from zero, of the first impact
    traces: Mapping[str, Trace]
    end: float  # s from zero, of the run
    duration: float  # s, what run.duration ends a run there

    def orbit(self) -> float:
        """Farthest any journal gets from where it floated, up to the end (m)."""
        return max(
            float(np.max(np.hypot(t.x - t.x[0], t.y - t.y[0])[t.time >= self.first]))
            for t in self.traces.values()
        )


def compare(
    scene: Scene,
    options: Options,
    progress: Progress = SILENT_PROGRESS,
    chosen: Sequence[Variant] | None = None,
) -> Comparison:
    """Run `scene` and its variants, all or `chosen`, for the duration from the first contact, or MAX_SPAN.

    Raises TouchdownError where the scene itself does not land or stops; a variant says so in its row.
    """
    span = options.duration or MAX_SPAN
    refuse_endless(span, scene.run.macro_step)
    chosen = variants(scene) if chosen is None else chosen
    scene = _unjudged(scene)
    progress.planned(1 + len(chosen))
    exact = _dropped(scene, Stop(span, early=False))
    progress.done()
    as_long = {"run.duration": exact.duration}  # a run is as long as that of the scene
    unchanged = Variant(UNCHANGED, scene.set(as_long))
    stopwatch = Stopwatch(options)
    stopwatch.warm_up(unchanged)
    own_walls: list[float] = []

    def measure(variant: Variant) -> Row:
        timed = replace(variant, scene=_unjudged(variant.scene).set(as_long))
        errors = _errors(_dropped(timed.scene), exact)
        stopwatch.warm_up(timed)
        walls, others = stopwatch.in_turns(timed, unchanged)
        own_walls.extend(others)
        ratio = statistics.median(wall / other for wall, other in zip(walls, others, strict=True))
        return Row(variant.name, errors=errors, wall=statistics.median(walls), ratio=ratio)

    rows = measure_all(chosen, measure, progress.done)
    wall = statistics.median(own_walls or stopwatch.in_turns(unchanged)[0])
    return Comparison(
        "models",
        f"{scene.title}: what it does not need",
        list(_about(scene, exact, stopwatch)),
        rows,
        QUANTITIES,
        [Row(UNCHANGED, errors=_errors(exact, exact), wall=wall, ratio=1.0)],
        exact,
        targets={"change": MAX_CHANGE},
        drawn=["change"],
        advise=_advice,
    )


def dispensable(comparison: Comparison) -> list[Row]:
    """Variants that are faster for a change below MAX_CHANGE, the fastest first."""
    good = [r for r in comparison.within(comparison.rows) if r.ratio and r.ratio < MAX_TIME_RATIO]
    return sorted(good, key=lambda row: row.ratio or 0.0)


def _unjudged(scene: Scene) -> Scene:
    """Without the ledger's thresholds, and without what they are measured by: other FMUs may lack it."""
    return replace(scene, energy_scale=())


def _dropped(scene: Scene, stop: Stop | None = None) -> _Drop:
    """The drop. Raises TouchdownError where it does not land."""
    with watched_drop(scene, stop) as drop:
        contacts = [drop.system.value(f"{a.bearing}.contact.first_time") for a in drop.seats]
    touched = dict(zip(drop.traces, contacts, strict=True))
    ends = {seat: end for seat, (_, end) in drop.impacts().items() if touched[seat] != NOT_YET}
    if not ends:
        raise TouchdownError(
            "no journal touches its bore before the end: models are compared by such landings; sweep over "
            "settings for those along the shaft, or give a longer --duration"
        )
    first = min(touched[seat] for seat in ends) - drop.outcome.zero
    return _Drop(first, ends, drop.traces, drop.end, drop.outcome.duration)


def _errors(drop: _Drop, exact: _Drop) -> dict[str, float]:
    """`drop` against `exact`; a seat that only one of them touches is not compared."""
    both = [seat for seat in exact.ends if seat in drop.ends]
    if not both:
        raise TouchdownError("it touches down at other seats")
    errors = {"first": drop.first - exact.first, "orbit": relative(drop.orbit(), exact.orbit())}
    peaks, exact_peaks = ([one.traces[s].peaks(one.ends[s]) for s in both] for one in (drop, exact))
    for kind in ("force", "contact"):
        found = [
            relative(getattr(a, kind), getattr(b, kind)) for a, b in zip(peaks, exact_peaks, strict=True)
        ]
        errors[kind] = max(found, key=abs)
    apart = [drop.traces[s].at(exact.ends[s]) - exact.traces[s].at(exact.ends[s]) for s in both]
    errors["position"] = float(max(np.hypot(*place) for place in apart))
    for part in INNER_PEAKS:
        changes = []  # by the end of the scene's first impact, of what is more than grazed
        for seat in both:
            before = exact.traces[seat].momentary_until(exact.ends[seat]).get(part, 0.0)
            after = drop.traces[seat].momentary_until(exact.ends[seat]).get(part)
            if after is not None and before >= MIN_PEAK:
                changes.append(relative(after, before))
        if changes:
            errors[part] = max(changes, key=abs)
    judged = (errors["force"], errors["contact"], errors["orbit"], errors["position"] / exact.orbit())
    return errors | {"change": max(map(abs, judged))}


def _about(scene: Scene, drop: _Drop, stopwatch: Stopwatch) -> Iterator[str]:
    yield scene.title
    average = max(AVERAGING_TIME, scene.run.macro_step)
    for seat, end in drop.ends.items():
        yield (
            f"  {seat}: first impact over at {1e3 * end:.4g} ms, journal force "
            f"{drop.traces[seat].peaks(end).force:.5g} N over {1e6 * average:g} us, "
            f"{forces_text(drop.traces[seat].momentary_until(end))}"
        )
    yield (
        f"  first contact {1e3 * drop.first:.5g} ms, largest orbit {1e6 * drop.orbit():.4g} um up to "
        f"{1e3 * (drop.end - drop.first):.3g} ms after it"
    )
    yield "changes against the unchanged scene; position: as the impact ends"
    yield f"wall time {stopwatch.title}, recorded"
    yield "other bearings have all parameters of the scene's that they know"


def _advice(comparison: Comparison) -> list[str]:
    """Parts whose absence makes the scene faster without changing it by much."""
    good, percent = dispensable(comparison), f"{100.0 * MAX_CHANGE:g} %"
    if not good:
        return [f"nothing of these makes the scene faster for less than {percent}"]
    lines = [
        f"for less than {percent} of the journal's forces, position (over the orbit) and "
        "orbit, each by itself:"
    ]
    for row in good:
        inside = [
            f"; {QUANTITIES[key].head[0]} {QUANTITIES[key].shown(row.errors[key])} %"
            for key in INNER_PEAKS
            if key in row.errors
        ]
        change = QUANTITIES["change"].shown(row.errors["change"])
        lines.append(f"  {row.name}: {change} %, {row.ratio:.2f} of the time{''.join(inside)}")
    return lines
