"""Spectra of the inner ring's vibration."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import FigureBase

from touchdown.master.coupling.connections import Attachment
from touchdown.master.results.ending import Finished
from touchdown.master.results.figures.style import BLUE, GREEN, GREY, ORANGE, PURPLE, sized
from touchdown.master.results.motion.spectra import (
    LENGTH,
    POINTS,
    interval,
    landed,
    samples,
    velocity_spectrum,
    windows,
)
from touchdown.master.results.recording import Recording
from touchdown.master.results.summary import dominant_frequency

LOW, HIGH = 700.0, 4000.0  # Hz, the panels' ends
BLOCKS = 1000  # to which a panel's line is reduced
DECADES = 5.0  # of amplitude shown at most
HARMONICS = 20  # of the pendulum that are marked
COLOURS = (BLUE, ORANGE, GREEN, PURPLE)
RPM = 60.0 / (2.0 * math.pi)

Spectrum = tuple[str, np.ndarray, np.ndarray]  # label, frequency (Hz), amplitude (m/s)


def has_spectrum(recording: Recording, a: Attachment) -> bool:
    """Whether the run is long enough for one window after the landing."""
    return f"{a.bearing}.ring.x" in recording and bool(windows(recording.time))


def spectrum(figure: FigureBase, run: Finished, a: Attachment) -> list[Axes]:
    """Amplitude of the ring's horizontal velocity for each window, with its rotor speed (Figs 28, 29)."""
    recording = run.recording
    time = recording.time
    spectra = _spectra(recording, a)
    pendulum = _pendulum(recording, a)
    panels = sized(figure, 13, 9.5).subplots(2, 1)
    for axes, limit in zip(panels, (LOW, HIGH), strict=True):
        end = min(limit, 0.5 / interval(time))
        _draw(axes, spectra, end)
        if limit == LOW and pendulum is not None:
            _mark_harmonics(axes, pendulum, end)
        axes.set_xlabel("frequency [Hz]")
        axes.set_ylabel("velocity amplitude [m/s]")
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=3)
    rate, count = 1.0 / interval(time), samples(time, LENGTH)
    figure.suptitle(
        f"{run.scene.title}: horizontal velocity of the inner ring\n"
        f"sampled at {rate / 1e3:g} kHz, windows of {LENGTH:.4g} s ({count} values), Hann, "
        f"padded with zeros to {max(POINTS, count)}"
    )
    return list(panels)


def _spectra(recording: Recording, a: Attachment) -> list[Spectrum]:
    time = recording.time
    x = recording[f"{a.bearing}.ring.x"]
    omega = recording[a.motion("omega")]
    made: list[Spectrum] = []
    for start in windows(time):
        part = (time >= start) & (time <= start + LENGTH)
        speed = RPM * float(np.mean(omega[part]))
        label = f"{start:.2f} s to {start + LENGTH:.2f} s after the shutdown, {speed:.0f} rpm"
        made.append((label, *velocity_spectrum(time, x, start, LENGTH, POINTS)))
    return made


def _pendulum(recording: Recording, a: Attachment) -> float | None:
    """Frequency of the rotor's swing in the bearing (Hz)."""
    settled = recording.time >= landed(recording.time)
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
