"""Figs 28 and 29: spectra of the inner ring's horizontal velocity, bearing without a cage."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from touchdown.master.results.figures.spectrum import HARMONICS, LOW, RPM, spectrum
from touchdown.master.results.figures.style import BLUE, GREY, ORANGE, sheet
from touchdown.master.results.motion.spectra import LENGTH, POINTS, lines, velocity_spectrum, windows
from touchdown.master.results.result import Result
from touchdown.master.studies.dissertation.exhibits.disk.pair import (
    CAGELESS,
    NEAR_HZ,
    SWINGS,
    Pair,
    column,
    pair,
    stacked,
)
from touchdown.master.studies.dissertation.exhibits.drops import Drops, figure_of, seats_of
from touchdown.master.studies.dissertation.exhibits.exhibit import Exhibit, Row

SOURCE_RPM = 8450.0
NEVER_SLOWS = "the stated models lose 25 to 50 rpm in 5 s; a drag (rotor.drag) would slow it as much"
LOPSIDED = (
    "a swing alike to both sides has odd multiples alone; what makes the source's lopsided is not stated"
)
SUPPORT = (700.0, 1500.0)  # Hz, where the housing's mode is looked for
STANDS_OUT = 3.0  # times the median beside it: a multiple of the pendulum that can be seen
"""Of the first HARMONICS multiples, those that do are counted."""
NEAR, BESIDE = 0.1, 0.5  # of the pendulum's frequency, around a multiple
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
        shown = frequency <= LOW
        label = f"{name}, {speed:.0f} rpm, {start:.2f} s to {start + LENGTH:.2f} s"
        axes.semilogy(frequency[shown], amplitude[shown], color=colour, lw=0.8, label=label)
        rows += _rows(name, run, speed, frequency, amplitude)
    for k in range(1, HARMONICS + 1):
        axes.axvline(28.0 * k, color=GREY, lw=0.6, ls=":", zorder=0)
    axes.set_xlim(0.0, LOW)
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
    return velocity_spectrum(run.recording.time, column(run, "ring.x"), start, LENGTH, POINTS)


def _speed(run: Result, start: float) -> float:
    """Mean rotor speed of the window that begins at `start` s (rpm)."""
    time = run.recording.time
    omega = run.recording[seats_of(run)[0].motion("omega")]
    return RPM * float(np.mean(omega[(time >= start) & (time <= start + LENGTH)]))


def _rows(name: str, run: Result, speed: float, f: np.ndarray, v: np.ndarray) -> list[Row]:
    pendulum = figure_of(run, "pendulum_frequency_Hz") or math.nan
    heights = [_height(pendulum * k, 0.5 * pendulum * NEAR, f, v) for k in range(1, HARMONICS + 1)]
    floors = [
        float(np.median(v[np.abs(f - pendulum * k) <= BESIDE * pendulum])) for k in range(1, HARMONICS + 1)
    ]
    seen = sum(height > STANDS_OUT * floor for height, floor in zip(heights, floors, strict=True))
    rows = [
        Row(f"{name}: rotor speed [rpm]", SOURCE_RPM, speed, near=0.01, why=NEVER_SLOWS),
        Row(f"{name}: first line [Hz]", 28.0, pendulum, near=NEAR_HZ, why=SWINGS),
        Row(
            f"{name}: multiples of it that stand out, of {HARMONICS}",
            HARMONICS,
            seen,
            near=0.1,
            why=LOPSIDED,
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
        why=LOPSIDED,
    )


def _height(at: float, reach: float, f: np.ndarray, v: np.ndarray) -> float:
    return float(np.max(v[np.abs(f - at) <= reach]))


def _one_mass(run: Result) -> float:
    """Disk, housing and bearing on the support's spring (Hz)."""
    value = run.ending.value
    volume = math.pi / 6.0 * value("bearing.balls.diameter") ** 3
    masses = [value(name) for name in MASSES]
    balls = value("bearing.balls.count") * value("bearing.balls.density") * volume
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
