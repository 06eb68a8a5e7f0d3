"""Spectra of the rotor's motion while it slows down, one behind the other."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import FigureBase

from touchdown.master.coupling.connections import Attachment
from touchdown.master.results.ending import Finished
from touchdown.master.results.figures.style import BLUE, ORANGE, sized
from touchdown.master.results.motion.spectra import interval, on_grid, waterfall
from touchdown.master.results.recording import Recording

SHORTEST = 8.0  # s after the shutdown
COARSEST = 10e3  # Hz
SPECTRA = 8
POINTS = 32768  # at most
BANDS = (100.0, 2500.0)  # Hz, the panels' ends
BLOCKS = 800  # to which a panel's line is reduced
DECADES = 4.0  # of amplitude shown under the highest line of a panel
STEP = 1.5  # decades from one spectrum to the next
RPM = 60.0 / (2.0 * math.pi)


def has_waterfall(recording: Recording, a: Attachment) -> bool:
    """Whether the run is long and fine enough."""
    time = recording.time
    if (
        len(time) < 2
        or time[-1] - max(0.0, time[0]) < SHORTEST * (1.0 - 1e-6)
        or 1.0 / interval(time) < COARSEST * (1.0 - 1e-6)
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
    points = min(POINTS, 2 ** int(math.log2(len(time) // SPECTRA)))
    panels = sized(figure, 13, 11).subplots(2, len(BANDS), squeeze=False)
    shown = (("a) velocity", "vx", 1e3, "mm/s", BLUE), ("b) displacement", "x", 1e6, "µm", ORANGE))
    for row, (title, variable, factor, unit, colour) in zip(panels, shown, strict=True):
        values = factor * recording[a.motion(variable)][rows]
        frequency, centres, amplitude = waterfall(time, values, points, rate, SPECTRA)
        speeds = RPM * np.interp(centres, time, omega)
        for axes, band in zip(row, BANDS, strict=True):
            part = (frequency > 0.0) & (frequency <= min(band, 0.5 * rate))
            _draw(axes, frequency[part], amplitude[:, part], unit, colour)
            axes.set_xlim(0.0, min(band, 0.5 * rate))
            axes.set_yticks(STEP * np.arange(SPECTRA), [f"{speed:.0f}" for speed in speeds])
            axes.set_title(title)
            axes.set_xlabel("frequency [Hz]")
            axes.set_ylabel("rotor speed, middle of each part [rpm]")
    figure.suptitle(
        f"{run.scene.title}: horizontal motion of the rotor at {a.body_end.title}\n"
        f"{SPECTRA} parts of {len(time) / rate / SPECTRA:.3g} s, from each {points} values at "
        f"{rate / 1e3:g} kHz, Hann; each line stands on its own axis, {STEP:g} decades above the last"
    )
    return list(panels.flat)


def _draw(axes: Axes, frequency: np.ndarray, amplitude: np.ndarray, unit: str, colour: str) -> None:
    """Logarithms of the amplitudes (spectra, frequencies), later ones higher up and behind the others.

    All have the same bottom, DECADES under the highest line of the panel.
    """
    bottom = max(float(np.max(amplitude)), 1e-300) * 10.0**-DECADES
    for k, spectrum in enumerate(amplitude):
        f, v = _peaks(frequency, spectrum)
        height = STEP * k + np.log10(np.maximum(v, bottom) / bottom)
        axes.fill_between(f, STEP * k, height, color="white", zorder=3 - 0.1 * k)
        axes.plot(f, height, color=colour, lw=0.7, zorder=3.05 - 0.1 * k)
        axes.axhline(STEP * k, color=colour, lw=0.3, alpha=0.5, zorder=3.04 - 0.1 * k)
    axes.set_ylim(-0.1, STEP * (len(amplitude) - 1) + DECADES + 0.2)
    _scale(axes, bottom, STEP * (len(amplitude) - 1), unit)


def _scale(axes: Axes, bottom: float, height: float, unit: str) -> None:
    """Amplitudes of the last spectrum, on the right."""
    power = math.ceil(math.log10(bottom))
    powers = np.arange(power, math.floor(math.log10(bottom) + DECADES) + 1)
    right = axes.secondary_yaxis("right")
    right.set_yticks(height + powers - math.log10(bottom), [f"$10^{{{p}}}$" for p in powers])
    right.set_ylabel(f"amplitude of the uppermost [{unit}]", loc="top")


def _peaks(frequency: np.ndarray, amplitude: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Largest value of each of at most BLOCKS stretches, where it is: no line may get lost."""
    size = -(-len(frequency) // BLOCKS)
    count = len(frequency) // size
    index = amplitude[: count * size].reshape(count, size).argmax(axis=1) + size * np.arange(count)
    return frequency[index], amplitude[index]
