"""Spectra of the inner ring and of the rotor."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm
from matplotlib.figure import FigureBase

from ...master.common.text import RPM, UM
from ...master.coupling.connections import Attachment
from ...master.results.final_state import Finished
from ...master.results.recording import Recording
from ...master.results.spectra import (
    POINTS,
    WINDOW_S,
    full_spectra,
    interval,
    landing_time,
    on_grid,
    samples,
    velocity_spectrum,
    window_starts,
)
from ...master.results.summary import dominant_frequency
from .style import BLUE, GREEN, GREY, ORANGE, PURPLE, TIME, apart, sized

LOW_BAND_HZ, HIGH_BAND_HZ = 700.0, 4000.0  # Hz, the panels' ends
BLOCKS = 1000  # to which a panel's line is reduced
DECADES = 5.0  # of amplitude shown at most
HARMONICS = 20  # of the pendulum that are marked
COLOURS = (BLUE, ORANGE, GREEN, PURPLE)
MOST_WINDOWS = len(COLOURS)

Spectrum = tuple[str, np.ndarray, np.ndarray]  # label, frequency (Hz), amplitude (m/s)


def has_spectrum(recording: Recording, a: Attachment) -> bool:
    """Whether the run is long enough for one window after the landing."""
    return f"{a.bearing}.ring.x" in recording and bool(window_starts(recording.time))


def spectrum(figure: FigureBase, run: Finished, a: Attachment) -> list[Axes]:
    """Amplitude of the ring's horizontal velocity for each window, with its rotor speed (Figs 28, 29).

    Of many windows a few from the first to the last, each in a colour of its own.
    """
    recording = run.recording
    time = recording.time
    spectra = _spectra(recording, a)
    pendulum = _pendulum(recording, a)
    panels = sized(figure, 13, 9.5).subplots(2, 1)
    for axes, limit in zip(panels, (LOW_BAND_HZ, HIGH_BAND_HZ), strict=True):
        end = min(limit, 0.5 / interval(time))
        _draw(axes, spectra, end)
        if limit == LOW_BAND_HZ and pendulum is not None:
            _mark_harmonics(axes, pendulum, end)
        axes.set_xlabel("frequency [Hz]")
        axes.set_ylabel("velocity amplitude [m/s]")
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=3)
    rate, count = 1.0 / interval(time), samples(time, WINDOW_S)
    figure.suptitle(
        f"{run.scene.title}\nhorizontal velocity of the inner ring of {a.bearing}, "
        f"sampled at {rate / 1e3:g} kHz, windows of {WINDOW_S:.4g} s ({count} values), Hann, "
        f"padded with zeros to {max(POINTS, count)}"
    )
    return list(panels)


def _spectra(recording: Recording, a: Attachment) -> list[Spectrum]:
    time = recording.time
    x = recording[f"{a.bearing}.ring.x"]
    omega = recording[a.motion("omega")]
    windows: list[Spectrum] = []
    starts = window_starts(time)
    chosen = np.unique(np.linspace(0, len(starts) - 1, min(len(starts), MOST_WINDOWS)).round().astype(int))
    for start in (starts[k] for k in chosen):
        part = (time >= start) & (time <= start + WINDOW_S)
        speed = RPM * float(np.mean(omega[part]))
        label = f"{start:.2f} s to {start + WINDOW_S:.2f} s after the shutdown, {speed:.0f} rpm"
        windows.append((label, *velocity_spectrum(time, x, start, WINDOW_S, POINTS)))
    return windows


def _pendulum(recording: Recording, a: Attachment) -> float | None:
    """Frequency of the rotor's swing in the bearing (Hz)."""
    settled = recording.time >= landing_time(recording.time)
    x = recording[a.motion("x")]
    return dominant_frequency(recording.time[settled], x[settled])


def _draw(axes: Axes, spectra: list[Spectrum], end: float) -> None:
    largest = 0.0
    lowest = math.inf
    for k, (label, frequency, amplitude) in enumerate(spectra):
        part = (frequency > 0.0) & (frequency <= end)
        f, v = _peaks(frequency[part], amplitude[part])
        axes.semilogy(f, v, color=COLOURS[k], lw=0.8, label=label)
        largest, lowest = max(largest, float(v.max())), min(lowest, float(v.min()))
    axes.set_xlim(0.0, end)
    if largest > 0.0:
        axes.set_ylim(max(0.5 * lowest, largest * 10.0**-DECADES), 3.0 * largest)
    axes.grid(axis="y", color=GREY, alpha=0.25, lw=0.5)


def _peaks(frequency: np.ndarray, amplitude: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Largest value of each of at most BLOCKS stretches, where it is.

    Padding with zeros leaves dips between lines, to nearly nothing: they say nothing of the motion.
    """
    size = max(1, len(frequency) // BLOCKS)
    count = len(frequency) // size
    blocks = amplitude[: count * size].reshape(count, size)
    index = blocks.argmax(axis=1) + size * np.arange(count)
    return frequency[index], amplitude[index]


def _mark_harmonics(axes: Axes, pendulum: float, end: float) -> None:
    for k in range(1, HARMONICS + 1):
        if k * pendulum < end:
            axes.axvline(k * pendulum, color=GREY, lw=0.6, ls=":", alpha=0.7, zorder=0)
    axes.set_title(f"dotted: multiples of the pendulum's {pendulum:.1f} Hz", fontsize="medium")


MIN_TIME_S = 0.25  # s after the shutdown
MIN_VALUES = 500  # recorded meanwhile
COLUMNS = 240  # of a waterfall
LINES_SHOWN = 400  # to which its frequencies are reduced
WATERFALL_DECADES = 4.0  # of amplitude shown under the highest
WINDOW_SHARE = 0.1  # s of a window for the root of each second of the run: as fine in time as in frequency
NEAR, WIDE_HZ = 1.4, 2500.0  # times the spin, and Hz: the panels' ends
WORTH = 1.5  # times the near end that the wide one has to be
LIGHT = "#f5f5f5"  # of lines on the colours
LABEL_INCHES, PANEL_INCHES = 0.17, 3.6

Mark = tuple[float, str]  # Hz, and its name


def has_waterfall(recording: Recording, a: Attachment) -> bool:
    """Whether the run is long enough, and recorded the motion at a seat."""
    time = recording.time
    long = len(time) > 1 and float(time[-1] - max(0.0, time[0])) > MIN_TIME_S * (1.0 - 1e-6)
    return (
        long
        and int(np.sum(time >= 0.0)) >= MIN_VALUES
        and all(a.motion(name) in recording for name in ("x", "y", "omega"))
    )


def motion_waterfall(
    figure: FigureBase, run: Finished, a: Attachment, marks: Sequence[Mark] = ()
) -> list[Axes]:
    """How the journal at a seat moves, over time and frequency: with the spin above 0 Hz, else below [µm].

    A circle of radius r has the amplitude r, a swing to and fro half of its own both ways. Dashed: the spin
    (1x); dotted: `marks`. The top tells the rotor's speed, where it falls. Near, and wide where it was
    recorded finely enough for that (Fig 15).
    """
    recording = run.recording
    rows = on_grid(recording.time) & (recording.time >= -1e-9)
    time, spin = recording.time[rows], recording[a.motion("omega")][rows]
    sense = 1.0 if np.median(spin) >= 0.0 else -1.0
    x, y = (UM * recording[a.motion(axis)][rows] for axis in "xy")
    length = WINDOW_SHARE * math.sqrt(float(time[-1] - time[0]))
    frequency, centres, amplitude = full_spectra(time, x + 1j * sense * y, length, COLUMNS)
    once = np.interp(centres, time, np.abs(spin)) / (2.0 * math.pi)
    highest = 0.5 / interval(time)
    near = min(highest, max(NEAR * float(np.max(once)), *(1.1 * mark for mark, _ in marks[:1]), 100.0))
    wide = min(highest, WIDE_HZ)
    ends = [near, wide] if wide > WORTH * near else [near]
    panels = sized(figure, 11.0, 1.2 + PANEL_INCHES * len(ends)).subplots(
        len(ends), 1, sharex=True, squeeze=False
    )[:, 0]
    norm = LogNorm(10.0**-WATERFALL_DECADES * (top := float(np.max(amplitude))), top, clip=True)
    known = [(float(once[-1]), "1x"), *marks]
    for axes, begin, end in zip(panels, (0.0, near), ends, strict=False):
        part = np.abs(frequency) <= end
        fields = _pooled(frequency[part], amplitude[:, part])
        mesh = axes.pcolormesh(centres, *fields, norm=norm, cmap="viridis", rasterized=True)
        axes.set_ylim(-end, end)
        for sign in (1.0, -1.0):
            axes.plot(centres, sign * once, "--", color=LIGHT, lw=0.8, label="_1x")
        both = [(sign * one, name) for one, name in known for sign in (-1.0, 1.0) if begin <= one < end]
        _name_lines(axes, sorted(both), end)
        axes.set_ylabel("below 0 against the spin [Hz]")
    panels[-1].set_xlim(float(time[0]), float(time[-1]))
    panels[-1].set_xlabel(TIME)
    _tell_speed(panels[0], time, RPM * np.abs(spin))
    figure.colorbar(mesh, ax=list(panels), label="amplitude [µm]", pad=0.02, aspect=30)
    figure.suptitle(
        f"{run.scene.title}\nmotion of the rotor in {a.bearing}, windows of {length:.3g} s (Hann), "
        f"recorded at {2e-3 * highest:.4g} kHz"
    )
    return list(panels)


def _pooled(frequency: np.ndarray, amplitude: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Frequencies (n,), and (n, columns) with the largest of each few lines: none may get lost."""
    size = max(1, len(frequency) // LINES_SHOWN)
    count = len(frequency) // size
    blocks = amplitude[:, : count * size].reshape(len(amplitude), count, size)
    return frequency[: count * size].reshape(count, size).mean(axis=1), blocks.max(axis=2).T


def _name_lines(axes: Axes, lines: Sequence[Mark], end: float) -> None:
    """Names of frequencies (ascending) beside the panel, and dotted lines there."""
    height = 2.0 * end * LABEL_INCHES / PANEL_INCHES
    moved = apart([hertz for hertz, _ in lines], [height] * len(lines), -end, end)
    for (hertz, name), y in zip(lines, moved, strict=True):
        if name != "1x":
            axes.axhline(hertz, color=LIGHT, lw=0.7, ls=":", label="_mark")
        across, line = axes.get_yaxis_transform(), {"arrowstyle": "-", "color": GREY, "lw": 0.5}
        axes.annotate(name, (1.0, hertz), (1.02, y), xycoords=across, textcoords=across, va="center",
                      fontsize="small", arrowprops=line)  # fmt: skip


def _tell_speed(axes: Axes, time: np.ndarray, rpm: np.ndarray) -> None:
    """The rotor's speed at the ticks of time, above a panel."""
    ticks = [tick for tick in axes.get_xticks() if time[0] <= tick <= time[-1]]
    top = axes.secondary_xaxis("top")
    top.set_xticks(ticks, [f"{speed:.0f}" for speed in np.interp(ticks, time, rpm)])
    top.set_xlabel("rotor speed [rpm]")
