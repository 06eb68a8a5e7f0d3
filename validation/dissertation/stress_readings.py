"""Table 4 of the dissertation, the stresses of rotor II, from drops over phases of the unbalance.

Stresses are taken along the rotor at the first distinct peak after it touches down. On its way up the
bending stress ripples with the higher modes. A peak is distinct where nothing exceeds it for half a period
of the third bending mode: a larger stress that comes sooner is a ripple of that or a higher mode.

Like is to be compared with like: a reading of the table is how stresses are recovered, the friction law,
the offsets and the instant. What Halminen does not state is an assumption. Of each reading the medians
stand beside the dissertation's figures, and below them what they move by if one thing is changed.
"""

from __future__ import annotations

import math
import statistics
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ...master.common.errors import Ended, TouchdownError
from ...master.common.text import aligned
from ...master.coupling.observer import Observer, RunState
from ...master.coupling.simulation import opened, simulate
from ...master.coupling.system import System
from ...master.quantities import PLANES, STRESSES, Owner, Summary, enter, values_of
from ...master.results.final_state import FinalState, final_state
from ...master.results.stresses import along, stressed
from ...master.results.summary import seat_name, touchdown_seats
from ...master.results.whirl.evidence import earliest_contact
from ...master.scene.file import load_scene
from ...master.scene.scene import Scene
from .drop_cache import NO_LIMIT, SEATS, Drops, at_phases, numbers

BENDING = (673.5, 1071.0, 2363.0, 2925.0)  # Hz, of rotor II (Table 2, simulated)
WAIT = 0.5 / BENDING[2]  # s
Reader = Callable[[], np.ndarray]
Settings = Mapping[str, object]
Peaked = tuple[Scene, float]  # a scene, and how long nothing exceeds a distinct peak (s)


class FirstPeak(Observer):
    """Ends a run at the first distinct peak after contact of the stress that a rotor watches.

    The stresses it has kept along itself are then those of that instant.
    """

    def __init__(self, peak: Reader, touched: Sequence[Reader], wait: float = WAIT) -> None:
        """Of a time each: peak, when the stress was largest; touched, when a journal was, -1 if not yet.

        wait: s, for which nothing exceeds a distinct peak.
        """
        self._peak, self._touched, self._wait = peak, touched, wait

    @classmethod
    def of(cls, system: System, wait: float = WAIT) -> FirstPeak:
        """The one for the rotor of `system` and its touchdown bearings."""
        (rotor,) = stressed(system)
        bearings = [system.components[a.bearing] for a in touchdown_seats(system)]
        touched = [bearing.reader(["contact.first_time"]) for bearing in bearings]
        return cls(system.components[rotor].reader(["stress.kept_time"]), touched, wait)

    def stepped(self, state: RunState) -> None:
        touched = [float(read()[0]) for read in self._touched]
        first = min((time for time in touched if time >= 0.0), default=state.time)
        peak = float(self._peak()[0])
        if peak > first and state.time - peak >= self._wait:
            state.stop("the first distinct peak is over")


def first_peak(scene: Scene, wait: float = WAIT) -> tuple[Summary, FinalState]:
    """Run `scene` in process up to that peak: the stresses kept then and first contacts, as in a summary,
    and its system at that moment.

    wait: s, for which nothing exceeds it. Raises TouchdownError where the run stops before, or ends
    without one.
    """
    with opened(scene, in_process=True) as system:
        outcome = simulate(scene, system, observers=[FirstPeak.of(system, wait)])
        outcome.raise_if_stopped()
        if outcome.ended is not Ended.AS_WANTED:
            raise TouchdownError(
                f"scene {scene.name}: the bending stress has no distinct peak within "
                f"{scene.run.duration:g} s; a longer run.duration may show one"
            )
        summary, seats = Summary(), touchdown_seats(system)
        for a in seats:
            if (time := system.value(f"{a.bearing}.contact.first_time")) >= 0.0:
                touched = {"first_contact_time": time - outcome.zero}
                enter(summary, touched, Owner.SEAT, seat_name(a, seats))
        (rotor,) = stressed(system)
        component = system.components[rotor]
        kept = {
            f"kept_{kind}_{axis}": max(map(abs, along(component, f"{kind}_{axis}")[1]))
            for kind in STRESSES
            for axis in PLANES
        }
        kept["kept_stress_time"] = system.value(f"{rotor}.stress.kept_time") - outcome.zero
        enter(summary, kept, Owner.COMPONENT, rotor)
        return summary, final_state(system)


SOURCE = {  # MPa, and whether it whirls
    "1": (8.76, 2.28, 0.59, 0.16, "no whirl"),
    "2": (7.68, 1.85, 0.55, 0.13, "no whirl"),
    "3a": (15.37, 9.83, 1.11, 0.84, "whirl"),
    "3b": (103.82, 24.42, 7.34, 1.68, "whirl"),
}
OTHER_ROTOR = Path(__file__).with_name("rotor_II_other.toml")


def _both(variable: str, value: object) -> dict[str, object]:
    """A setting of both touchdown bearings."""
    return {f"bearing_{seat}.{variable}": value for seat in SEATS}


def _offsets(a: float) -> dict[str, object]:
    """Bearing A off to one side by `a` (um), bearing B to the other."""
    return {"housing_A.x0": f"{a:g} um", "housing_B.x0": f"{-a:g} um"}


def _supports(factor: float) -> dict[str, object]:
    """The housings' stiffness, in those of the dissertation."""
    return {"housing_A.stiffness": factor * 67e6, "housing_B.stiffness": factor * 37e6}


MODES_ALONE = {"rotor.modes": 10, "rotor.residual": 0, "rotor.stress.mode_acceleration": 0}
COULOMB = _both("friction.kind", 0) | _both("friction.static", 0.27) | _both("friction.dynamic", 0.27)
AS_SOURCE = {**MODES_ALONE, **COULOMB}
ALL_FLEXIBILITY = {"rotor.residual": 1, "rotor.stress.mode_acceleration": 1}
WIDE = _offsets(200.0)
DRAG = _both("rolling.resistance", 0.12)
AS_PRINTED = _both("friction.kind", 1) | _both("friction.dynamic", 0.18)


class _Assumption(NamedTuple):
    """Something the dissertation does not state."""

    about: str
    settings: Settings
    because: str


ASSUMPTIONS = (
    _Assumption(
        "stresses from ten modes per plane, without what loads do to the modes left out",
        MODES_ALONE,
        "sigma/tau of 14 to 15 in the dissertation; all modes give another ratio (below)",
    ),
    _Assumption(
        "friction of 0.27 at every sliding speed (printed: 0.27 static, 0.18 sliding)",
        COULOMB,
        "X over Y of 0.24 to 0.27 in the dissertation's cases 1 and 2",
    ),
    _Assumption(
        f"cases 1 and 2 at the first distinct peak: nothing exceeds it for {1e3 * WAIT:.2f} ms,\n"
        f"    half a period of the third bending mode; case 3 at the largest peak",
        {},
        '"right after the initial contact" and "at the end, when the rotor is whirling"',
    ),
    _Assumption(
        "case 3: each bearing off by the total misalignment; case 2 as printed, half at each",
        WIDE,
        "as printed, nothing whirls in case 3 (below)",
    ),
    _Assumption(
        "case 3b: a drag on the inner rings, 0.05 of the balls' loads times the pitch diameter",
        DRAG,
        "fitted to case 3b: without it the whirl does not grow (below)",
    ),
)


READINGS: Mapping[str, Mapping[str, Settings]] = {  # by case and label; the first is the dissertation's
    "1": {"as the dissertation reads": AS_SOURCE, "true": {}},
    "2": {"as the dissertation reads": AS_SOURCE, "true": {}},
    "3a": {
        "as the dissertation reads": {**AS_SOURCE, **WIDE},
        "true, offsets as the dissertation's reading": WIDE,
        "true, offsets as printed": {},
    },
    "3b": {
        "as the dissertation reads": {**AS_SOURCE, **WIDE, **DRAG},
        "true, offsets and drag as the dissertation's reading": {**WIDE, **DRAG},
        "true, offsets as printed, no drag": {},
    },
}


@dataclass(frozen=True)
class Change:
    """One thing changed in the dissertation's reading of a case."""

    about: str
    settings: Settings = field(default_factory=dict[str, object])
    rotor: Path | None = None
    wait: float = WAIT  # s


SHORT_WAIT = 0.25 / BENDING[0]  # s
AT_FIRST_PEAK: Mapping[str, Sequence[Change]] = {  # by case, in its dissertation's reading
    "1": (
        Change("what loads do to the modes left out", ALL_FLEXIBILITY),
        Change("all modes", {"rotor.modes": 0}),
        Change("five modes", {"rotor.modes": 5}),
        Change("friction as printed, 0.27 and 0.18", AS_PRINTED),
        Change(f"a peak for {1e3 * SHORT_WAIT:.2f} ms, a quarter of the first mode's", wait=SHORT_WAIT),
        Change("ten times the contact's stiffness", _both("contact.stiffness", 1.2e10)),
        Change("another geometry of equal mass and modes", rotor=OTHER_ROTOR),
        Change("bearing B preloaded by 5 um", {"bearing_B.balls.play": "-5 um"}),
        Change("twice the support's stiffness", _supports(2.0)),
        Change("half of it", _supports(0.5)),
    ),
    "2": (
        Change("each bearing off by the total", _offsets(100.0)),
        Change("the same to the other sides", _offsets(-100.0)),
    ),
}
AT_LARGEST: Mapping[str, Sequence[Change]] = {
    "3a": (
        Change("offsets as printed", _offsets(-100.0)),
        Change("offsets to the other sides", _offsets(-200.0)),
        Change("friction as printed, 0.27 and 0.18", AS_PRINTED),
        Change("the drag of case 3b", DRAG),
    ),
    "3b": [
        Change(f"rolling.resistance = {drag:g}", _both("rolling.resistance", drag))
        for drag in (0.0, 0.06, 0.11, 0.13)
    ],
}


COLUMNS = ("kept_bending_y", "kept_bending_x", "kept_shear_y", "kept_shear_x")
HEADERS = ("sigma_Y", "sigma_X", "tau_Y", "tau_X")
HINGED = (*HEADERS, "s/t", "rms", "moved", "ms", "")
SHORT = {**NO_LIMIT, "run.duration": 0.015}  # s; such a drop ends at its first distinct peak


def read_as(case: str, settings: Settings) -> Scene:
    """A case of the dissertation with other settings."""
    return load_scene(f"rotor2-case{case}").set(settings)


def as_read(case: str, change: Change = Change("")) -> Scene:
    """A case as the dissertation reads it, with one thing changed."""
    scene = read_as(case, {**next(iter(READINGS[case].values())), **change.settings})
    return scene.swap(rotor=change.rotor) if change.rotor else scene


def at_first_peak(drops: Drops, scenes: Sequence[Peaked], members: int) -> list[list[Summary]]:
    """Summary of the drops of each scene over phases, ended at the first distinct peak, stresses there."""
    tasks = [(one, wait) for scene, wait in scenes for one in at_phases(scene.set(SHORT), members)]
    figures = drops.values(_drop, tasks)
    return [figures[i : i + members] for i in range(0, len(figures), members)]


def _drop(task: Peaked) -> Summary:
    return first_peak(*task)[0]


def spread(values: Sequence[float]) -> str:
    """Median, smallest and largest; a dash where there is none."""
    if not values:
        return "-"
    return f"{statistics.median(values):.3g} ({min(values):.3g} to {max(values):.3g})"


def rms_of_logarithms(values: Sequence[float], others: Sequence[float]) -> float:
    """Root of the mean square of ln(value/other): 0.1 is about 10 % either way.

    Not a number where any of them is not above zero.
    """
    pairs = list(zip(values, others, strict=True))
    if not all(value > 0.0 and other > 0.0 for value, other in pairs):
        return math.nan
    return math.sqrt(statistics.fmean(math.log(value / other) ** 2 for value, other in pairs))


def median(values: Sequence[float]) -> float:
    """Not a number where there is none."""
    return statistics.median(values) if values else math.nan


def medians(drops: Sequence[Summary]) -> list[float]:
    """Of the four stresses (MPa)."""
    return [median(numbers(drops, column)) for column in COLUMNS]


def resultants(drops: Sequence[Summary]) -> tuple[float, float]:
    """Medians of bending and of shear of both planes together (MPa): how a whirl's stress lies in the
    planes is the instant's.
    """
    y, x, shear_y, shear_x = (numbers(drops, column) for column in COLUMNS)
    return median(list(map(math.hypot, y, x))), median(list(map(math.hypot, shear_y, shear_x)))


def instants(drops: Sequence[Summary]) -> list[float]:
    """When the stresses were read, after the first contact of either journal (ms)."""
    times = []
    for drop in drops:
        if (touched := earliest_contact(drop)) is not None:
            times += [1e3 * (read - touched) for read in numbers([drop], "kept_stress_time")]
    return times


def whirls(drops: Sequence[Summary]) -> str:
    """In how many drops each journal whirled."""
    of_drops = [values_of(drop, "whirl_episodes") for drop in drops]
    counts = {seat: sum(bool(episodes.get(seat)) for episodes in of_drops) for seat in SEATS}
    return ", ".join(f"{seat} {count}" for seat, count in counts.items()) + f" of {len(drops)} whirl"


def stress_readings(drops: Drops, members: int) -> list[str]:
    """Both readings of every case, what they assume, and what they hinge on, as lines."""
    lost: list[str] = []

    def to_the_end(case: str, scene: Scene) -> list[Summary]:
        figures, why = drops.summaries(at_phases(scene, members))
        lost.extend(f"  stopped: case {case}, {reason}" for reason in why)
        return figures

    changes = {case: (Change(""), *more) for case, more in AT_FIRST_PEAK.items()}
    tasks = [(as_read(case, c), c.wait) for case, of_case in changes.items() for c in of_case]
    ended = iter(at_first_peak(drops, tasks, members))
    peaks = {case: [next(ended) for _ in of_case] for case, of_case in changes.items()}
    rows: list[tuple[str, ...]] = [("", *HEADERS)]
    read: dict[str, list[Summary]] = {}
    for case, readings in READINGS.items():
        *values, verdict = SOURCE[case]
        rows.append((f"case {case}, the dissertation: {verdict}", *(f"{value:.4g}" for value in values)))
        for label, settings in readings.items():
            figures = to_the_end(case, read_as(case, settings))
            if case in peaks and case not in read:
                rows += _reading(label, peaks[case][0], case, whirls(figures))
                rows += _reading("  the same drops, largest peak", figures, case)
            else:
                rows += _reading(label, figures, case, whirls(figures))
            read.setdefault(case, figures)
    lines = [*aligned(rows, "<>"), "", *assumption_lines(), "", *HINGES]
    rows = [("", *HINGED)]
    for case, of_case in changes.items():
        rows.append((f"case {case}, first distinct peak",))
        for change, figures in zip(of_case, peaks[case], strict=True):
            rows.append(_hinge(change.about or "as read above", figures, case, peaks[case][0]))
    for case, of_case in AT_LARGEST.items():
        rows += [(f"case {case}, largest peak",), _hinge("as read above", read[case], case, read[case])]
        for change in of_case:
            figures = to_the_end(case, as_read(case, change))
            rows.append(_hinge(change.about, figures, case, read[case], whirls(figures)))
    return lines + aligned(rows, "<>>>>>>>><") + lost


HINGES = (
    "what it hinges on: medians with one change in Halminen's reading; s/t is sigma_Y/tau_Y; rms of",
    "  logarithms against the dissertation, and of what the change moved; ms after contact",
)


def _reading(label: str, drops: Sequence[Summary], case: str, whirling: str = "") -> list[tuple[str, ...]]:
    """Two rows: the stresses, and how they compare with the dissertation's."""
    source = SOURCE[case][:4]
    stresses = (spread(numbers(drops, column)) for column in COLUMNS)
    bending, shear = (
        100.0 * (computed / math.hypot(*theirs) - 1.0)
        for computed, theirs in zip(resultants(drops), (source[:2], source[2:]), strict=True)
    )
    lines = [
        f"rms of logarithms {rms_of_logarithms(medians(drops), source):.3f}",
        f"resultants sigma {bending:+.0f} %, tau {shear:+.0f} %",
        f"{spread(instants(drops))} ms after contact",
        *([whirling] if whirling else []),
    ]
    return [(f"  {label}", *stresses), (f"      {'; '.join(lines)}",)]


def assumption_lines() -> list[str]:
    """The assumptions of Halminen's reading, with settings and reasons; then both readings' results."""
    lines = ["assumed in the dissertation's reading"]
    for about, settings, because in ASSUMPTIONS:
        lines += [
            f"  {about}",
            f"    because: {because}",
            *([f"    {_shown(settings)}"] if settings else []),
        ]
    return [
        *lines,
        "true: as the scenes set it; residual flexibility, mode acceleration, friction of 0.27 and 0.18",
        "both: the rotor is a surrogate; in each plane the largest stress along it when the",
        "  vertical bending stress at node 4 peaks; rms of ln(here/source) of the four medians",
    ]


def _shown(settings: Settings) -> str:
    """Settings as text; those of both bearings once."""
    shown = {}
    for name, value in settings.items():
        twin = name.replace("bearing_A", "bearing_B")
        if name.startswith("bearing_B") and name.replace("bearing_B", "bearing_A") in settings:
            continue
        alike = twin != name and settings.get(twin) == value
        shown[name.replace("bearing_A", "bearing_A and _B") if alike else name] = value
    return ", ".join(f"{name} = {value}" for name, value in shown.items())


def _hinge(
    about: str, drops: Sequence[Summary], case: str, plain: Sequence[Summary], whirling: str = ""
) -> tuple[str, ...]:
    computed = medians(drops)
    cells = [f"{value:.3g}" for value in computed] + [f"{computed[0] / computed[2]:.1f}"]
    cells += [f"{rms_of_logarithms(computed, others):.3f}" for others in (SOURCE[case][:4], medians(plain))]
    return f"  {about}", *cells, f"{median(instants(drops)):.2f}", whirling
