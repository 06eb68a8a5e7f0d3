"""Spectra of the inner ring and of the rotor."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import FigureBase

from ...master.common.text import RPM
from ...master.coupling.connections import Attachment
from ...master.results.final_state import Finished
from ...master.results.recording import Recording
from ...master.results.spectra import (
    POINTS,
    WINDOW_S,
    interval,
    landing_time,
    on_grid,
    samples,
    velocity_spectrum,
    waterfall,
    window_starts,
)
from ...master.results.summary import dominant_frequency
from .style import BLUE, GREEN, GREY, ORANGE, PURPLE, sized

LOW_BAND_HZ, HIGH_BAND_HZ = 700.0, 4000.0  # Hz, the panels' ends
BLOCKS = 1000  # to which a panel's line is reduced
DECADES = 5.0  # of amplitude shown at most
HARMONICS = 20  # of the pendulum that are marked
COLOURS = (BLUE, ORANGE, GREEN, PURPLE)

Spectrum = tuple[str, np.ndarray, np.ndarray]  # label, frequency (Hz), amplitude (m/s)


def has_spectrum(recording: Recording, a: Attachment) -> bool:
    """Whether the run is long enough for one window after the landing."""
    return f"{a.bearing}.ring.x" in recording and bool(window_starts(recording.time))


def spectrum(figure: FigureBase, run: Finished, a: Attachment) -> list[Axes]:
    """Amplitude of the ring's horizontal velocity for each window, with its rotor speed (Figs 28, 29)."""
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
        f"{run.scene.title}: horizontal velocity of the inner ring\n"
        f"sampled at {rate / 1e3:g} kHz, windows of {WINDOW_S:.4g} s ({count} values), Hann, "
        f"padded with zeros to {max(POINTS, count)}"
    )
    return list(panels)


def _spectra(recording: Recording, a: Attachment) -> list[Spectrum]:
    time = recording.time
    x = recording[f"{a.bearing}.ring.x"]
    omega = recording[a.motion("omega")]
    windows: list[Spectrum] = []
    for start in window_starts(time):
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
        axes.semilogy(f, v, color=COLOURS[k % len(COLOURS)], lw=0.8, label=label)
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


MIN_TIME_S = 8.0  # s after the shutdown
MIN_SAMPLING_HZ = 10e3  # Hz
MAX_SPECTRA = 8
WATERFALL_POINTS = 32768  # at most
WATERFALL_BANDS = (100.0, 2500.0)  # Hz, the panels' ends
WATERFALL_BLOCKS = 800  # to which a panel's line is reduced
WATERFALL_DECADES = 4.0  # of amplitude shown under the highest line of a panel
SPECTRUM_OFFSET = 1.5  # decades from one spectrum to the next


def has_waterfall(recording: Recording, a: Attachment) -> bool:
    """Whether the run is long and fine enough."""
    time = recording.time
    if (
        len(time) < 2
        or time[-1] - max(0.0, time[0]) < MIN_TIME_S * (1.0 - 1e-6)
        or 1.0 / interval(time) < MIN_SAMPLING_HZ * (1.0 - 1e-6)
    ):
        return False
    return a.motion("vx") in recording and a.motion("omega") in recording


def motion_waterfall(figure: FigureBase, run: Finished, a: Attachment) -> list[Axes]:
    """Amplitude of the rotor's horizontal velocity and displacement at a seat over frequency and rotor
    speed, for the parts of the run (Fig 15)."""
    recording = run.recording
    rows = on_grid(recording.time) & (recording.time >= -1e-9)
    time, omega = recording.time[rows], recording[a.motion("omega")][rows]
    rate = 1.0 / interval(time)
    points = min(WATERFALL_POINTS, 2 ** int(math.log2(len(time) // MAX_SPECTRA)))
    panels = sized(figure, 13, 11).subplots(2, len(WATERFALL_BANDS), squeeze=False)
    shown = (("a) velocity", "vx", 1e3, "mm/s", BLUE), ("b) displacement", "x", 1e6, "µm", ORANGE))
    for row, (title, variable, factor, unit, colour) in zip(panels, shown, strict=True):
        values = factor * recording[a.motion(variable)][rows]
        frequency, centres, amplitude = waterfall(time, values, points, rate, MAX_SPECTRA)
        speeds = RPM * np.interp(centres, time, omega)
        for axes, band in zip(row, WATERFALL_BANDS, strict=True):
            part = (frequency > 0.0) & (frequency <= min(band, 0.5 * rate))
            _draw_waterfall(axes, frequency[part], amplitude[:, part], unit, colour)
            axes.set_xlim(0.0, min(band, 0.5 * rate))
            axes.set_yticks(SPECTRUM_OFFSET * np.arange(MAX_SPECTRA), [f"{speed:.0f}" for speed in speeds])
            axes.set_title(title)
            axes.set_xlabel("frequency [Hz]")
            axes.set_ylabel("rotor speed, middle of each part [rpm]")
    figure.suptitle(
        f"{run.scene.title}: horizontal motion of the rotor at {a.body_end.title}\n"
        f"{MAX_SPECTRA} parts of {len(time) / rate / MAX_SPECTRA:.3g} s, from each {points} values at "
        f"{rate / 1e3:g} kHz, Hann; each line stands on its own axis, {SPECTRUM_OFFSET:g} decades above "
        "the last"
    )
    return list(panels.flat)


def _draw_waterfall(
    axes: Axes, frequency: np.ndarray, amplitude: np.ndarray, unit: str, colour: str
) -> None:
    """Logarithms of the amplitudes (spectra, frequencies), later ones higher up and behind the others.

    All have the same bottom, DECADES under the highest line of the panel.
    """
    bottom = max(float(np.max(amplitude)), 1e-300) * 10.0**-WATERFALL_DECADES
    for k, spectrum in enumerate(amplitude):
        f, v = _kept_peaks(frequency, spectrum)
        height = SPECTRUM_OFFSET * k + np.log10(np.maximum(v, bottom) / bottom)
        axes.fill_between(f, SPECTRUM_OFFSET * k, height, color="white", zorder=3 - 0.1 * k)
        axes.plot(f, height, color=colour, lw=0.7, zorder=3.05 - 0.1 * k)
        axes.axhline(SPECTRUM_OFFSET * k, color=colour, lw=0.3, alpha=0.5, zorder=3.04 - 0.1 * k)
    axes.set_ylim(-0.1, SPECTRUM_OFFSET * (len(amplitude) - 1) + WATERFALL_DECADES + 0.2)
    _scale(axes, bottom, SPECTRUM_OFFSET * (len(amplitude) - 1), unit)


def _scale(axes: Axes, bottom: float, height: float, unit: str) -> None:
    """Amplitudes of the last spectrum, on the right."""
    power = math.ceil(math.log10(bottom))
    powers = np.arange(power, math.floor(math.log10(bottom) + WATERFALL_DECADES) + 1)
    right = axes.secondary_yaxis("right")
    right.set_yticks(height + powers - math.log10(bottom), [f"$10^{{{p}}}$" for p in powers])
    right.set_ylabel(f"amplitude of the uppermost [{unit}]", loc="top")


def _kept_peaks(frequency: np.ndarray, amplitude: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Largest value of each of at most BLOCKS stretches, where it is: no line may get lost."""
    size = -(-len(frequency) // WATERFALL_BLOCKS)
    count = len(frequency) // size
    index = amplitude[: count * size].reshape(count, size).argmax(axis=1) + size * np.arange(count)
    return frequency[index], amplitude[index]
