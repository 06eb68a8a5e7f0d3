"""Section 4.3, contacts and spectra: Figs 27 to 33, Tables 5 to 7."""

from __future__ import annotations

import math
import statistics
from collections.abc import Mapping, Sequence

import numpy as np

from ....bearings.contact.materials import STEEL_DENSITY
from ....master.coupling.simulation import opened
from ....master.results.result import Result
from ....master.results.spectra import POINTS, WINDOW_S, lines, velocity_spectrum, windows
from ....master.scene.file import load_scene
from ....master.scene.scene import Scene
from ....reports.figures.forces import draw_contacts, forces
from ....reports.figures.spectra import HARMONICS, LOW_BAND_HZ, RPM, spectrum
from ....reports.figures.style import BLUE, GREY, ORANGE, sheet
from ..bearings import (
    COUNTS,
    FURTHER,
    MEMBERS,
    OPTIONS,
    READINGS,
    SCENES,
    STEP_APART,
    TABLE_7,
    Measure,
    member,
)
from ..stress_readings import numbers
from .disk_motion import CAGED, CAGELESS, NEAR_HZ, SWINGS, Pair, column, ending_part, pair, stacked
from .exhibit import Drops, Exhibit, Row, figure_of, finished, seats_of

SOURCE = {"cageless detailed": 7, "caged detailed": 2}
ONE = "a ball at the edge of the loaded arc comes and goes with the pendulum"


def fig_27(drops: Drops) -> Exhibit:
    """Balls between the races at the end, and those that both of them press."""
    runs = dict(zip(SOURCE, drops.of([load_scene(SCENES[model]) for model in SOURCE]), strict=True))
    figure = sheet(16.4, 8.8)
    rows: list[Row] = []
    for axes, (model, run) in zip(figure.subplots(1, 2), runs.items(), strict=True):
        draw_contacts(axes, finished(run), seats_of(run)[0])
        source = SOURCE[model]
        within_one = (source - 1.0, source + 1.0)
        rows += [
            Row(
                f"{model}: loaded balls after 5 s",
                source,
                figure_of(run, "loaded_balls_end"),
                near=1.0 / source,
                why=ONE,
            ),
            Row(
                f"{model}: loaded balls, mean of the last second",
                within_one,
                figure_of(run, "loaded_balls_mean"),
                why="the source's count, more or less one",
            ),
        ]
    return Exhibit(figure, rows)


SOURCE_RPM = 8450.0
NEVER_SLOWS = "the stated models lose 25 to 50 rpm in 5 s; a drag (rotor.drag) would slow it as much"
ASYMMETRY_NOTE = (
    "a swing alike to both sides has odd multiples alone; what makes the source's lopsided is not stated"
)
SUPPORT = (700.0, 1500.0)  # Hz, where the housing's mode is looked for
STANDS_OUT = 3.0  # times the median beside it: a multiple of the pendulum that can be seen
"""Of the first HARMONICS multiples, those that do are counted."""
NEAR_LINE, BESIDE = 0.1, 0.5  # of the pendulum's frequency, around a multiple
MASSES = ("rotor.mass", "housing.mass", "housing.outer_ring", "bearing.ring.mass")
ONE_MASS = "arithmetic, with disk, housing and bearing as one mass; the contact is softer than the support"


def fig_28(drops: Drops) -> Exhibit:
    """Both models in the last window, at the lowest rotor speed."""
    runs = pair(drops, CAGELESS)
    figure = sheet(13.0, 5.0)
    axes = figure.subplots()
    rows: list[Row] = []
    for name, run, colour in zip(Pair._fields, runs, (BLUE, ORANGE), strict=True):
        start = windows(run.recording.time)[-1]
        frequency, amplitude = _spectrum(run, start)
        speed = _speed(run, start)
        shown = frequency <= LOW_BAND_HZ
        label = f"{name}, {speed:.0f} rpm, {start:.2f} s to {start + WINDOW_S:.2f} s"
        axes.semilogy(frequency[shown], amplitude[shown], color=colour, lw=0.8, label=label)
        rows += _spectrum_rows(name, run, speed, frequency, amplitude)
    for k in range(1, HARMONICS + 1):
        axes.axvline(28.0 * k, color=GREY, lw=0.6, ls=":", zorder=0)
    axes.set_xlim(0.0, LOW_BAND_HZ)
    axes.set_ylim(bottom=1e-8)
    axes.set_xlabel("frequency [Hz]")
    axes.set_ylabel("velocity amplitude of the inner ring, x [m/s]")
    axes.set_title("dotted: multiples of the source's 28 Hz")
    axes.legend(loc="upper right")
    return Exhibit(figure, rows)


def fig_29(drops: Drops) -> Exhibit:
    """Three windows of each model, up to 4 kHz."""
    runs = pair(drops, CAGELESS)
    rows = [Row("support with all as one mass [Hz]", 972.0, _one_mass(runs.detailed), near=0.01)]
    for name, run in zip(Pair._fields, runs, strict=True):
        start = windows(run.recording.time)[0]
        ((peak, _),) = lines(*_spectrum(run, start), *SUPPORT, 1)
        rows.append(Row(f"{name}: tallest line from 700 to 1500 Hz [Hz]", 972.0, peak, why=ONE_MASS))
    return Exhibit(stacked(runs, spectrum, 13.0, (7.5, 7.5)), [*rows, *_bearing_frequencies(runs.detailed)])


def _spectrum(run: Result, start: float) -> tuple[np.ndarray, np.ndarray]:
    return velocity_spectrum(run.recording.time, column(run, "ring.x"), start, WINDOW_S, POINTS)


def _speed(run: Result, start: float) -> float:
    """Mean rotor speed of the window that begins at `start` s (rpm)."""
    time = run.recording.time
    omega = run.recording[seats_of(run)[0].motion("omega")]
    return RPM * float(np.mean(omega[(time >= start) & (time <= start + WINDOW_S)]))


def _spectrum_rows(name: str, run: Result, speed: float, f: np.ndarray, v: np.ndarray) -> list[Row]:
    pendulum = figure_of(run, "pendulum_frequency_Hz") or math.nan
    heights = [_height(pendulum * k, 0.5 * pendulum * NEAR_LINE, f, v) for k in range(1, HARMONICS + 1)]
    floors = [
        float(np.median(v[np.abs(f - pendulum * k) <= BESIDE * pendulum])) for k in range(1, HARMONICS + 1)
    ]
    visible = sum(height > STANDS_OUT * floor for height, floor in zip(heights, floors, strict=True))
    rows = [
        Row(f"{name}: rotor speed [rpm]", SOURCE_RPM, speed, near=0.01, why=NEVER_SLOWS),
        Row(f"{name}: first line [Hz]", 28.0, pendulum, near=NEAR_HZ, why=SWINGS),
        Row(
            f"{name}: multiples of it that stand out, of {HARMONICS}",
            HARMONICS,
            visible,
            near=0.1,
            why=ASYMMETRY_NOTE,
        ),
    ]
    if name == "detailed":
        rows.append(_fourth(heights))
    return rows


def _fourth(heights: Sequence[float]) -> Row:
    ours = ", ".join(f"{1e6 * height:.3g}" for height in heights[1:4])
    return Row(
        "detailed: 2nd, 3rd, 4th multiple [um/s]",
        "the 4th is the tallest",
        ours,
        holds=heights[3] > max(heights[1:3]),
        why=ASYMMETRY_NOTE,
    )


def _height(at: float, reach: float, f: np.ndarray, v: np.ndarray) -> float:
    return float(np.max(v[np.abs(f - at) <= reach]))


def _one_mass(run: Result) -> float:
    """Disk, housing and bearing on the support's spring (Hz)."""
    value = run.ending.value
    volume = math.pi / 6.0 * value("bearing.balls.diameter") ** 3
    masses = [value(name) for name in MASSES]
    balls = value("bearing.balls.count") * STEEL_DENSITY * volume
    return math.sqrt(value("housing.stiffness") / (sum(masses) + balls)) / (2.0 * math.pi)


def _bearing_frequencies(run: Result) -> list[Row]:
    """The source's frequencies of balls and defects, which are not those of the bearing it shows."""
    value = run.ending.value
    speed = value("rotor.speed") / (2.0 * math.pi)
    count, d, pitch = (value(f"bearing.balls.{name}") for name in ("count", "diameter", "pitch_diameter"))
    ratio = d / pitch
    spin = 0.5 * speed / ratio * (1.0 - ratio**2)
    why = "printed are those of the 9-ball 6004, not of this 17-ball 6904"
    return [
        Row("defect of the inner ring [Hz]", 810.0, 0.5 * count * speed * (1.0 + ratio), why=why),
        Row("defect of a ball [Hz]", 716.0, 2.0 * spin, why=why),
        Row("balls turn at [Hz]", 358.0, spin, why=why),
    ]


FIRST = 5e-3  # s after the first touch: the first contact is over
NEVER = "never"
BALL = "first_impact_ball_force_N"


def fig_30(drops: Drops) -> Exhibit:
    """Simplified, with a cage."""
    return _exhibit(drops, CAGED, "simplified")


def fig_31(drops: Drops) -> Exhibit:
    """Detailed, with a cage."""
    exhibit = _exhibit(drops, CAGED, "detailed")
    run = _run(drops, CAGED, "detailed")
    knocks = _time_in_contact(run, "pockets.force")
    regular = Row("balls on the cage in the last 50 ms", "all the time", knocks, holds=knocks != NEVER)
    return exhibit._replace(rows=[*exhibit.rows, regular])


def fig_32(drops: Drops) -> Exhibit:
    """Simplified, without a cage."""
    return _exhibit(drops, CAGELESS, "simplified")


def fig_33(drops: Drops) -> Exhibit:
    """Detailed, without a cage."""
    exhibit = _exhibit(drops, CAGELESS, "detailed")
    touches = _time_in_contact(_run(drops, CAGELESS, "detailed"), "neighbours.force")
    none = Row(
        "balls on each other in the last 50 ms",
        NEVER,
        touches,
        holds=touches == NEVER,
        why="where the balls come to lie is chaotic" if touches != NEVER else "",
    )
    return exhibit._replace(rows=[*exhibit.rows, none])


def _run(drops: Drops, cage: str, kind: str) -> Result:
    return getattr(pair(drops, cage), kind)


def _exhibit(drops: Drops, cage: str, kind: str) -> Exhibit:
    run = _run(drops, cage, kind)
    figure = sheet()
    forces(figure, finished(run), seats_of(run)[0])
    return Exhibit(figure, [*_force_rows(run), _ratio(drops, kind)])


def _force_rows(run: Result) -> list[Row]:
    force, time = column(run, "contact.force"), run.recording.time
    first = figure_of(run, "first_contact_time_s") or 0.0
    at = float(time[np.argmax(force)])
    pendulum = figure_of(run, "pendulum_frequency_Hz")
    swing = None if pendulum is None else 0.5 / pendulum
    return [
        Row(
            "rotor on ring, when the force is largest",
            "first contact",
            f"{1e3 * (at - first):.2f} ms after it",
            holds=at - first < FIRST,
        ),
        Row("rotor on ring, largest force [N]", None, figure_of(run, "peak_contact_force_N")),
        Row("most loaded ball in the first contact [N]", None, figure_of(run, BALL)),
        Row("one swing of the pendulum [s]", 0.018, swing, NEAR_HZ, why=SWINGS),
    ]


def _ratio(drops: Drops, kind: str) -> Row:
    """How much harder the first contact presses a ball in the caged bearing."""
    caged, cageless = (figure_of(_run(drops, cage, kind), BALL) for cage in (CAGED, CAGELESS))
    ours = caged / cageless if caged and cageless else None
    return Row(
        f"{kind}: most loaded ball in the first contact, caged over cageless [1]", 2.0, ours, near=0.15
    )


def _time_in_contact(run: Result, variable: str) -> str:
    """How often something presses in the last 50 ms."""
    force = column(run, variable)[ending_part(run)]
    return f"{100.0 * np.mean(force > 0.0):.0f} % of the time" if np.any(force > 0.0) else NEVER


CONTACTS = "contacts"
"""Titles of Table 6's rows begin so; the others are Table 5's."""


def table_5(drops: Drops) -> Exhibit:
    """Coordinates and constraints of each model."""
    return Exhibit(None, _count_rows(of_contacts=False))


def table_6(drops: Drops) -> Exhibit:
    """Elastic contacts of each model."""
    notes = ["one contact of both rings through a ball stands for two; the source: 'reduced to'"]
    return Exhibit(None, _count_rows(of_contacts=True), notes)


def _count_rows(of_contacts: bool) -> list[Row]:
    rows: list[Row] = []
    for model, scene in SCENES.items():
        with opened(load_scene(scene), in_process=True) as system:
            system.initialise()
            for title, variables, source in COUNTS:
                if title.startswith(CONTACTS) == of_contacts:
                    count = sum(system.value(f"bearing.size.{variable}") for variable in variables)
                    rows.append(Row(f"{model}: {title}", source[model], count, near=0.0))
    return rows


DURATION = 5.0  # s
NEAR_REPEATABLE = 0.03
CHAOTIC = {"ball and ball", "ball and cage"}
NEAR_ROUGH = 0.3  # of what is chaotic, or only about stated


def table_7(drops: Drops) -> Exhibit:
    """Medians over drops whose balls start 1e-7 rad apart."""
    return Exhibit(None, _measured(drops, TABLE_7), [_note(drops)])


def bearings(drops: Drops) -> Exhibit:
    """Table 7 and further figures with the spread over the drops."""
    rows = _measured(drops, (*TABLE_7, *FURTHER), spread=True)
    for kind in ("detailed", "simplified"):
        caged, cageless = (
            numbers(_ensemble(drops, f"{cage} {kind}", {}), BALL) for cage in ("caged", "cageless")
        )
        if caged and cageless:
            ratio = statistics.median(caged) / statistics.median(cageless)
            what = f"{kind}: first-impact ball force, caged over cageless [1]"
            rows.append(Row(what, 2.0, ratio, near=0.15))
    return Exhibit(None, rows, [_note(drops)])


def options(drops: Drops) -> Exhibit:
    """The effect of each option of section 5.3, and of damping by ratio, on Table 7."""
    rows: list[Row] = []
    _prepare(drops, [*((model, {}) for model in SCENES), *((m, settings) for _, m, settings in OPTIONS)])
    for label, model, settings in OPTIONS:
        plain, changed = (_ensemble(drops, model, s) for s in ({}, settings))
        for quantity in TABLE_7:
            before, after = numbers(plain, quantity.key), numbers(changed, quantity.key)
            if before and after:
                change = f"{statistics.median(before):.4g} -> {statistics.median(after):.4g}"
                what = f"{label}, {model}: {quantity.title} [um]"
                rows.append(Row(what, None, change, why="without -> with the option"))
    return Exhibit(None, rows, [_note(drops)])


def _measured(drops: Drops, quantities: Sequence[Measure], spread: bool = False) -> list[Row]:
    """Medians by quantity and ensemble, where the model has it, beside the source's value if it has one."""
    _prepare(drops, list(READINGS.values()))
    rows: list[Row] = []
    for quantity in quantities:
        for name, reading in READINGS.items():
            values = numbers(_ensemble(drops, *reading), quantity.key)
            if not values or (not spread and name not in quantity.source):
                continue
            repeatable = quantity in TABLE_7 and quantity.title not in CHAOTIC
            near = NEAR_REPEATABLE if repeatable else NEAR_ROUGH
            unit = " [um]" if quantity in TABLE_7 else ""
            why = quantity.hinges_on.get(name, "")
            if spread and len(values) > 1:
                several = f"{len(values)} drops: {min(values):.4g} to {max(values):.4g}"
                why = "; ".join(filter(None, (several, why)))
            source, middle = quantity.source.get(name), statistics.median(values)
            rows.append(Row(f"{quantity.title}, {name}{unit}", source, middle, near, why=why))
    return rows


def _scenes(drops: Drops, model: str, settings: Mapping[str, object]) -> list[Scene]:
    return [member(model, k, DURATION, settings) for k in range(drops.members or MEMBERS)]


def _prepare(drops: Drops, readings: Sequence[tuple[str, Mapping[str, object]]]) -> None:
    """Run all of them beside each other."""
    drops.of([scene for reading in readings for scene in _scenes(drops, *reading)])


def _ensemble(drops: Drops, model: str, settings: Mapping[str, object]) -> list[Mapping[str, object]]:
    return [run.summary for run in drops.of(_scenes(drops, model, settings))]


def _note(drops: Drops) -> str:
    return f"medians over drops ({drops.members or MEMBERS}), balls {STEP_APART:g} rad apart at the start"
