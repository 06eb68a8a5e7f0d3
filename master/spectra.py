"""Amplitude spectra of a recorded motion (Figs 28, 29 of the source)."""

from __future__ import annotations

import numpy as np
from scipy.signal import get_window

BEGIN = 1.0  # s after the shutdown, when the landing has died down
POINTS = 262_144
LENGTH = POINTS / 200e3  # s of one window: the source's points at its 200 kHz
SLACK = 1e-3  # of an interval, for times that are sums of steps


def interval(time: np.ndarray) -> float:
    """Time from one recorded value to the next (s)."""
    return float(np.median(np.diff(time)))


def windows(time: np.ndarray) -> list[float]:
    """Starts (s) of the windows of LENGTH, one after the other from BEGIN, that end within `time`."""
    if len(time) < 2:
        return []
    whole = (float(time[-1]) + SLACK * interval(time) - BEGIN) / LENGTH
    return [BEGIN + k * LENGTH for k in range(int(whole))] if whole >= 1.0 else []


def samples(time: np.ndarray, length: float) -> int:
    """Number of velocities that a window of `length` (s) has."""
    return round(length / interval(time))


def velocity_spectrum(
    time: np.ndarray, position: np.ndarray, start: float, length: float, points: int
) -> tuple[np.ndarray, np.ndarray]:
    """Amplitude of the velocity over frequency, from `start` on for `length` (s): (Hz, m/s).

    The velocity is the difference of neighbouring positions (m) over the interval between them: its mean
    over the interval, so that a vibration near a multiple of the recording's rate hardly shows as an
    alias. The mean takes sin(pi f T)/(pi f T) off a line at f; the spectrum is corrected for that. The
    velocity's own mean is removed, then comes a Hann window, and zeros up to `points` (none where the
    window has more). A line of amplitude A between 0 Hz and half the rate has the height A.
    """
    step = interval(time)
    count = samples(time, length)
    first = int(np.searchsorted(time, start - SLACK * step))
    velocity = np.diff(position[first : first + count + 1]) / step
    if len(velocity) < count:
        raise ValueError(f"the recording ends before the window from {start:g} s for {length:g} s does")
    points = max(points, count)
    hann = get_window("hann", count)
    frequency = np.fft.rfftfreq(points, step)
    lines = np.fft.rfft((velocity - np.mean(velocity)) * hann, points)
    return frequency, 2.0 * np.abs(lines) / np.sum(hann) / np.sinc(frequency * step)
