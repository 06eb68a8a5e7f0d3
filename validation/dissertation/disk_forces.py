"""Section 4.3, contacts and spectra: Figs 27 to 33."""

from __future__ import annotations

import math

import numpy as np

from ...bearings.contact.materials import STEEL_DENSITY
from ...master.common.text import RPM
from ...master.results.result import Result
from ...master.results.spectra import POINTS, WINDOW_S, spectral_lines, velocity_spectrum, window_starts
from ...master.scene.file import load_scene
from ...reports.figures.forces import draw_contacts, forces
from ...reports.figures.spectra import HARMONICS, LOW_BAND_HZ, spectrum
from ...reports.figures.style import BLUE, GREY, ORANGE, sheet
from ..case import Found, Row
from .disk_motion import CAGED, CAGELESS, NEAR_HZ, SWINGS, column, each, ending_part, pair, stacked
from .drop_cache import Drops, figure_of, finished, seats_of

SOURCE = {"cageless": 7, "caged": 2}
ONE = "a ball at the edge of the loaded arc comes and goes with the pendulum"
ONE_OFF = "the dissertation's count, more or less one"


def fig_27(drops: Drops) -> Found:
    """Balls between the races at the end, and those that both of them press."""
    runs = drops.of([load_scene(f"disk-{cage}-detailed") for cage in SOURCE])
    figure = sheet(16.4, 8.8)
    rows: list[Row] = []
    for axes, (cage, count), run in zip(figure.subplots(1, 2), SOURCE.items(), runs, strict=True):
        draw_contacts(axes, finished(run), seats_of(run)[0])
        end, mean = (figure_of(run, f"loaded_balls_{which}") for which in ("end", "mean"))
        what, about = f"{cage} detailed: loaded balls", (count - 1.0, count + 1.0)
        rows += [
            Row(f"{what} after 5 s", "", count, end, 1.0 / count, ONE),
            Row(f"{what}, mean of the last second", "", about, mean, why=ONE_OFF),
        ]
    return Found(rows, figure)


SOURCE_RPM = 8450.0
NEVER_SLOWS = "the stated models lose 25 to 50 rpm in 5 s; a drag (rotor.drag) would slow it as much"
ASYMMETRY = (
    "a swing alike to both sides has odd multiples alone; what makes Halminen's lopsided is not stated"
)
SUPPORT = (700.0, 1500.0)  # Hz, where the housing's mode is looked for
STANDS_OUT = 3.0  # times the median beside it: a multiple of the pendulum that can be seen
NEAR_LINE, BESIDE = 0.1, 0.5  # of the pendulum's frequency, around a multiple
MASSES = ("rotor.mass", "housing.mass", "housing.outer_ring", "bearing.ring.mass")
ONE_MASS = "arithmetic, with disk, housing and bearing as one mass; the contact is softer than the support"
OTHER_BEARING = "printed are those of the 9-ball 6004, not of this 17-ball 6904"


def fig_28(drops: Drops) -> Found:
    """Both models in the last window, at the lowest rotor speed."""
    figure = sheet(13.0, 5.0)
    axes = figure.subplots()
    rows: list[Row] = []
    for (name, run), colour in zip(each(pair(drops, CAGELESS)), (BLUE, ORANGE), strict=True):
        time = run.recording.time
        start = window_starts(time)[-1]
        frequency, amplitude = _spectrum(run, start)
        omega = run.recording[seats_of(run)[0].motion("omega")]
        speed = RPM * float(np.mean(omega[(time >= start) & (time <= start + WINDOW_S)]))
        low = frequency <= LOW_BAND_HZ
        label = f"{name}, {speed:.0f} rpm, {start:.2f} s to {start + WINDOW_S:.2f} s"
        axes.semilogy(frequency[low], amplitude[low], color=colour, lw=0.8, label=label)
        rows.append(Row(f"{name}: rotor speed", "rpm", SOURCE_RPM, speed, 0.01, NEVER_SLOWS))
        rows += _multiples(name, run, frequency, amplitude)
    for k in range(1, HARMONICS + 1):
        axes.axvline(28.0 * k, color=GREY, lw=0.6, ls=":", zorder=0)
    axes.set_xlim(0.0, LOW_BAND_HZ)
    axes.set_ylim(bottom=1e-8)
    axes.set_xlabel("frequency [Hz]")
    axes.set_ylabel("velocity amplitude of the inner ring, x [m/s]")
    axes.set_title("dotted: multiples of the dissertation's 28 Hz")
    axes.legend(loc="upper right")
    return Found(rows, figure)


def fig_29(drops: Drops) -> Found:
    """Three windows of each model, up to 4 kHz."""
    runs = pair(drops, CAGELESS)
    rows = [Row("support with all as one mass", "Hz", 972.0, _one_mass(runs.detailed), 0.01)]
    for name, run in each(runs):
        ((peak, _),) = spectral_lines(*_spectrum(run, window_starts(run.recording.time)[0]), *SUPPORT, 1)
        rows.append(Row(f"{name}: tallest line from 700 to 1500 Hz", "Hz", 972.0, peak, why=ONE_MASS))
    rows += _bearing_frequencies(runs.detailed)
    return Found(rows, stacked(runs, spectrum, 13.0, (7.5, 7.5)))


def _spectrum(run: Result, start: float) -> tuple[np.ndarray, np.ndarray]:
    return velocity_spectrum(run.recording.time, column(run, "ring.x"), start, WINDOW_S, POINTS)


def _multiples(name: str, run: Result, f: np.ndarray, v: np.ndarray) -> list[Row]:
    """The pendulum's frequency and its first HARMONICS multiples in a spectrum."""
    pendulum = figure_of(run, "pendulum_frequency") or math.nan
    off = [np.abs(f - pendulum * k) for k in range(1, HARMONICS + 1)]
    heights = [float(np.max(v[one <= 0.5 * pendulum * NEAR_LINE])) for one in off]
    floors = [float(np.median(v[one <= BESIDE * pendulum])) for one in off]
    visible = sum(height > STANDS_OUT * floor for height, floor in zip(heights, floors, strict=True))
    what = f"{name}: multiples of it that stand out, of {HARMONICS}"
    rows = [
        Row(f"{name}: first line", "Hz", 28.0, pendulum, NEAR_HZ, SWINGS),
        Row(what, "", HARMONICS, visible, 0.1, ASYMMETRY),
    ]
    if name == "detailed":
        ours, tallest = (
            ", ".join(f"{1e6 * height:.3g}" for height in heights[1:4]),
            "the 4th is the tallest",
        )
        what, holds = "detailed: 2nd, 3rd, 4th multiple [um/s]", heights[3] > max(heights[1:3])
        rows.append(Row(what, "", tallest, ours, why=ASYMMETRY, holds=holds))
    return rows


def _one_mass(run: Result) -> float:
    """Disk, housing and bearing on the support's spring (Hz)."""
    value = run.ending.value
    volume = math.pi / 6.0 * value("bearing.balls.diameter") ** 3
    balls = value("bearing.balls.count") * STEEL_DENSITY * volume
    masses = [value(name) for name in MASSES]
    return math.sqrt(value("housing.stiffness") / (sum(masses) + balls)) / (2.0 * math.pi)


def _bearing_frequencies(run: Result) -> list[Row]:
    """The dissertation's frequencies of balls and defects, which are not those of the bearing it shows."""
    value = run.ending.value
    speed = value("rotor.speed") / (2.0 * math.pi)
    count, d, pitch = (value(f"bearing.balls.{name}") for name in ("count", "diameter", "pitch_diameter"))
    ratio = d / pitch
    spin = 0.5 * speed / ratio * (1.0 - ratio**2)
    inner = 0.5 * count * speed * (1.0 + ratio)
    return [
        Row("defect of the inner ring", "Hz", 810.0, inner, why=OTHER_BEARING),
        Row("defect of a ball", "Hz", 716.0, 2.0 * spin, why=OTHER_BEARING),
        Row("balls turn at", "Hz", 358.0, spin, why=OTHER_BEARING),
    ]


FIRST = 5e-3  # s after the first touch: the first contact is over
NEVER = "never"
BALL = "first_impact_ball_force"


def fig_30(drops: Drops) -> Found:
    """Simplified, with a cage."""
    return _forces(drops, CAGED, "simplified")


def fig_31(drops: Drops) -> Found:
    """Detailed, with a cage."""
    found, knocks = _forces(drops, CAGED, "detailed"), _pressing(drops, CAGED, "pockets.force")
    row = Row("balls on the cage in the last 50 ms", "", "all the time", knocks, holds=knocks != NEVER)
    return found._replace(rows=[*found.rows, row])


def fig_32(drops: Drops) -> Found:
    """Simplified, without a cage."""
    return _forces(drops, CAGELESS, "simplified")


def fig_33(drops: Drops) -> Found:
    """Detailed, without a cage."""
    found, touches = _forces(drops, CAGELESS, "detailed"), _pressing(drops, CAGELESS, "neighbours.force")
    why = "where the balls come to lie is chaotic" if touches != NEVER else ""
    row = Row("balls on each other in the last 50 ms", "", NEVER, touches, why=why, holds=touches == NEVER)
    return found._replace(rows=[*found.rows, row])


def _forces(drops: Drops, cage: str, kind: str) -> Found:
    """Contact forces of a model, and how much harder the first contact presses a ball with a cage."""
    cageless, caged = (getattr(pair(drops, one), kind) for one in (CAGELESS, CAGED))
    run: Result = caged if cage == CAGED else cageless
    figure = sheet()
    forces(figure, finished(run), seats_of(run)[0])
    peak_time = float(run.recording.time[np.argmax(column(run, "contact.force"))])
    after = peak_time - (figure_of(run, "first_contact_time") or 0.0)
    pendulum = figure_of(run, "pendulum_frequency")
    swing = None if pendulum is None else 0.5 / pendulum
    with_cage, without = (figure_of(one, BALL) for one in (caged, cageless))
    ratio = with_cage / without if with_cage and without else None
    when, most = "rotor on ring, when the force is largest", "most loaded ball in the first contact"
    rows = [
        Row(when, "", "first contact", f"{1e3 * after:.2f} ms after it", holds=after < FIRST),
        Row("rotor on ring, largest force", "N", None, figure_of(run, "peak_contact_force")),
        Row(most, "N", None, figure_of(run, BALL)),
        Row("one swing of the pendulum", "s", 0.018, swing, NEAR_HZ, SWINGS),
        Row(f"{kind}: {most}, caged over cageless", "", 2.0, ratio, 0.15),
    ]
    return Found(rows, figure)


def _pressing(drops: Drops, cage: str, variable: str) -> str:
    """How often something presses in the detailed model in the last 50 ms."""
    run = pair(drops, cage).detailed
    force = column(run, variable)[ending_part(run)]
    return f"{100.0 * np.mean(force > 0.0):.0f} % of the time" if np.any(force > 0.0) else NEVER
