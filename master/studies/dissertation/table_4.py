"""Table 4 of the source, the stresses of rotor II: read as the source reads them, and as they are.

Drops over unbalance phases; of each reading the medians stand beside the source's figures, and below them
what they move by if one thing is changed.
"""

from __future__ import annotations

import math
import statistics
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from touchdown.master.common.ended import Ended
from touchdown.master.common.errors import TouchdownError
from touchdown.master.common.processes.pool import run_all
from touchdown.master.coupling.steppers.carried import carrying
from touchdown.master.scene.file import load_scene
from touchdown.master.scene.scene import Scene
from touchdown.master.studies.dissertation.ensemble import NO_LIMIT, SEATS, numbers, phases, spread
from touchdown.master.studies.dissertation.first_peak import WAIT, figures_at_first_peak
from touchdown.master.studies.dissertation.readings import (
    ASSUMPTIONS,
    AT_FIRST_PEAK,
    AT_LARGEST,
    READINGS,
    SOURCE,
    Change,
    Reading,
    Settings,
)
from touchdown.master.studies.sweep.design import Design
from touchdown.master.studies.sweep.sweep import Running, sweep

Figures = Mapping[str, object]  # of a drop, as in its summary

COLUMNS = ("kept_bending_y_MPa", "kept_bending_x_MPa", "kept_shear_y_MPa", "kept_shear_x_MPa")
HEADERS = ("sigma_Y", "sigma_X", "tau_Y", "tau_X")
SHORT = {**NO_LIMIT, "run.duration": 0.015}  # s; such a drop ends at its first distinct peak
LABEL, WIDTH, NARROW = 54, 24, 9  # characters


@dataclass(frozen=True)
class Ensemble:
    """Where and how drops run."""

    members: int  # unbalance phases
    folder: Path
    jobs: int
    done: Callable[[], object]  # after each drop
    lost: list[str] = field(default_factory=list[str])  # why drops stopped

    def whole(self, name: str, scene: Scene) -> list[Figures]:
        """Figures of the drops of `scene` to its end, stresses at their largest; table in folder/name."""
        drops = sweep(
            scene.set(NO_LIMIT),
            Design.grid(phases(self.members)),
            self.folder / name,
            Running(self.jobs, in_process=True, anew=True),
            self.done,
        )
        if any(drop.ended is Ended.INTERRUPTED for drop in drops):
            raise KeyboardInterrupt
        self.lost.extend(f"{name}, drop {drop.number}: {drop.failed}" for drop in drops if drop.failed)
        return [drop.summary for drop in drops if not drop.failed]

    def to_first_peak(self, scenes: Sequence[tuple[Scene, float]]) -> list[list[Figures]]:
        """The same, for each scene and wait (s), of drops to the first distinct peak, stresses there."""
        ((name, angles),) = phases(self.members).items()
        drops = [(scene.set({name: angle, **SHORT}), wait) for scene, wait in scenes for angle in angles]
        found = run_all(carrying(_drop), drops, self.jobs, self.done)
        if any(outcome.ended is Ended.INTERRUPTED for outcome in found):
            raise KeyboardInterrupt
        figures = [outcome.value for outcome in found if outcome.value is not None]
        if len(figures) < len(found):
            raise TouchdownError(next(outcome.reason for outcome in found if outcome.value is None))
        return [figures[i : i + self.members] for i in range(0, len(figures), self.members)]


def _drop(task: tuple[Scene, float]) -> Figures:
    return figures_at_first_peak(*task)


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


def medians(drops: Sequence[Figures]) -> list[float]:
    """Of the four stresses (MPa)."""
    return [median(numbers(drops, column)) for column in COLUMNS]


def resultants(drops: Sequence[Figures]) -> tuple[float, float]:
    """Medians of bending and of shear of both planes together (MPa): how a whirl's stress lies in the
    planes is the instant's.
    """
    y, x, shear_y, shear_x = (numbers(drops, column) for column in COLUMNS)
    return median(list(map(math.hypot, y, x))), median(list(map(math.hypot, shear_y, shear_x)))


def instants(drops: Sequence[Figures]) -> list[float]:
    """When the stresses were read, after the first contact of either journal (ms)."""
    times = []
    for drop in drops:
        touched = [t for seat in SEATS for t in numbers([drop], f"first_contact_time_s_bearing_{seat}")]
        times += [1e3 * (read - min(touched)) for read in numbers([drop], "kept_stress_time_s")]
    return times


def whirls(drops: Sequence[Figures]) -> str:
    """In how many drops each journal whirled."""
    counts = {seat: sum(bool(drop.get(f"whirl_{seat}_episodes")) for drop in drops) for seat in SEATS}
    return ", ".join(f"{seat} {count}" for seat, count in counts.items()) + f" of {len(drops)} whirl"


def table_4(members: int, folder: Path, jobs: int, done: Callable[[], object]) -> list[str]:
    """Both readings of every case, what they assume, and what they hinge on, as lines."""
    at = Ensemble(members, folder, jobs, done)
    peaks = _first_peaks(at)
    lines = [f"{'':<{LABEL}}" + "".join(f"{header:>{WIDTH}}" for header in HEADERS)]
    read: dict[str, list[Figures]] = {}
    for case, readings in READINGS.items():
        *values, verdict = SOURCE[case]
        stresses = "".join(f"{value:>{WIDTH}.4g}" for value in values)
        lines.append(f"{f'case {case}, the source: {verdict}':<{LABEL}}{stresses}")
        for number, reading in enumerate(readings, start=1):
            drops = at.whole(f"table4-case{case}-{number}", _scene(case, reading.settings))
            if reading.first:
                lines += _reading(reading.label, peaks[case][0], case, whirls(drops))
                lines += _reading("  the same drops, largest peak", drops, case)
            else:
                lines += _reading(reading.label, drops, case, whirls(drops))
            read.setdefault(case, drops)
    lines += ["", *assumption_lines(), "", *_hinges(at, peaks, read)]
    return [*lines, *(f"  stopped: {why}" for why in at.lost)]


def runs(members: int) -> int:
    """How many drops `table_4` runs."""
    whole = [*READINGS.values(), *AT_LARGEST.values()]
    to_first = [(None, *changes) for changes in AT_FIRST_PEAK.values()]
    return members * sum(map(len, [*whole, *to_first]))


def _scene(case: str, settings: Settings) -> Scene:
    return load_scene(f"rotor2-case{case}").set(settings)


def _source_reading(case: str) -> Reading:
    return READINGS[case][0]


def changed(case: str, change: Change) -> Scene:
    scene = _scene(case, {**_source_reading(case).settings, **change.settings})
    return scene.swap(rotor=change.rotor) if change.rotor else scene


def _first_peaks(at: Ensemble) -> dict[str, list[list[Figures]]]:
    """By case: the drops of the source's reading, then those of each change."""
    scenes = {
        case: [
            (_scene(case, _source_reading(case).settings), WAIT),
            *((changed(case, change), change.wait) for change in changes),
        ]
        for case, changes in AT_FIRST_PEAK.items()
    }
    drops = iter(at.to_first_peak([task for tasks in scenes.values() for task in tasks]))
    return {case: [next(drops) for _ in tasks] for case, tasks in scenes.items()}


def _reading(label: str, drops: Sequence[Figures], case: str, whirling: str = "") -> list[str]:
    """Two lines: the stresses, and how they compare with the source's."""
    source = SOURCE[case][:4]
    stresses = "".join(f"{spread(numbers(drops, column)):>{WIDTH}}" for column in COLUMNS)
    bending, shear = (
        100.0 * (own / math.hypot(*theirs) - 1.0)
        for own, theirs in zip(resultants(drops), (source[:2], source[2:]), strict=True)
    )
    told = [
        f"rms of logarithms {rms_of_logarithms(medians(drops), source):.3f}",
        f"resultants sigma {bending:+.0f} %, tau {shear:+.0f} %",
        f"{spread(instants(drops))} ms after contact",
        *([whirling] if whirling else []),
    ]
    return [f"  {label:<{LABEL - 2}}{stresses}", f"      {'; '.join(told)}"]


def assumption_lines() -> list[str]:
    """What the source's reading assumes, what that sets, and why; then what both readings do."""
    lines = ["assumed in the source's reading"]
    for assumption in ASSUMPTIONS:
        lines += [f"  {assumption.about}", f"    because: {assumption.because}"]
        if assumption.settings:
            lines.append(f"    {_shown(assumption.settings)}")
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


def _hinges(
    at: Ensemble, peaks: Mapping[str, Sequence[Sequence[Figures]]], read: Mapping[str, Sequence[Figures]]
) -> list[str]:
    """What one change does to the source's reading of each case."""
    heads = (*HEADERS, "s/t", "rms", "moved", "ms")
    lines = [
        "what it hinges on: medians with one change in the source's reading; s/t is sigma_Y/tau_Y; rms of",
        "  logarithms against the source, and of what the change moved; ms after contact",
        f"{'':<{LABEL}}" + "".join(f"{head:>{NARROW}}" for head in heads),
    ]
    for case, changes in AT_FIRST_PEAK.items():
        plain, *others = peaks[case]
        lines += [f"case {case}, first distinct peak", _hinge("as read above", plain, case, plain)]
        lines += [_hinge(c.about, drops, case, plain) for c, drops in zip(changes, others, strict=True)]
    for case, changes in AT_LARGEST.items():
        lines += [f"case {case}, largest peak", _hinge("as read above", read[case], case, read[case])]
        for number, change in enumerate(changes, start=1):
            drops = at.whole(f"table4-case{case}-change{number}", changed(case, change))
            lines.append(f"{_hinge(change.about, drops, case, read[case])}  {whirls(drops)}")
    return lines


def _hinge(about: str, drops: Sequence[Figures], case: str, plain: Sequence[Figures]) -> str:
    own = medians(drops)
    cells = [f"{value:.3g}" for value in own] + [f"{own[0] / own[2]:.1f}"]
    cells += [f"{rms_of_logarithms(own, others):.3f}" for others in (SOURCE[case][:4], medians(plain))]
    cells.append(f"{median(instants(drops)):.2f}")
    return f"  {about:<{LABEL - 2}}" + "".join(f"{cell:>{NARROW}}" for cell in cells)
