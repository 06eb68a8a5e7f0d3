"""Amplitude spectra of a recorded motion (Halminen (2016), Figs 15, 28 and 29)."""

from __future__ import annotations

import numpy as np

WINDOW_START_S = 1.0  # s after the shutdown, when the landing has died down
POINTS = 262_144
WINDOW_S = POINTS / 200e3  # s of one window: Halminen's (2016) points at 200 kHz
INTERVAL_TOLERANCE = 1e-3  # of an interval, for times that are sums of steps
SIDE_LOBE_LINES = 4  # lines of a spectrum; nearer to a taller line stand that line's own side lobes


def hann(count: int) -> np.ndarray:
    """Hann window of `count` values, periodic: scipy.signal's, which takes a second to import."""
    return 0.5 + 0.5 * np.cos(np.linspace(-np.pi, np.pi, count + 1)[:-1])


def interval(time: np.ndarray) -> float:
    """Time from one recorded value to the next (s)."""
    return float(np.median(np.diff(time)))


def landing_time(time: np.ndarray) -> float:
    """When the landing has died down (s): WINDOW_START_S from the shutdown, or from a start after that."""
    return WINDOW_START_S + max(0.0, float(time[0]))


def window_starts(time: np.ndarray) -> list[float]:
    """Starts (s) of the windows of WINDOW_S, in a row from `landing_time`, that end within `time`."""
    if len(time) < 2:
        return []
    begin = landing_time(time)
    whole = (float(time[-1]) + INTERVAL_TOLERANCE * interval(time) - begin) / WINDOW_S
    return [begin + k * WINDOW_S for k in range(int(whole))] if whole >= 1.0 else []


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
    first = int(np.searchsorted(time, start - INTERVAL_TOLERANCE * step))
    velocity = np.diff(position[first : first + count + 1]) / step
    if len(velocity) < count:
        raise ValueError(f"the recording ends before the window from {start:g} s for {length:g} s does")
    points = max(points, count)
    shape = hann(count)
    frequency = np.fft.rfftfreq(points, step)
    transform = np.fft.rfft((velocity - np.mean(velocity)) * shape, points)
    return frequency, 2.0 * np.abs(transform) / np.sum(shape) / np.sinc(frequency * step)


def on_grid(time: np.ndarray) -> np.ndarray:
    """Which rows are a whole number of intervals after the first: a run may record others between them."""
    row = (time - time[0]) / interval(time)
    return np.abs(row - np.round(row)) < 0.01


def full_spectra(
    time: np.ndarray, z: np.ndarray, length: float, columns: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Spectra of a motion in a plane, x + iy, under windows of `length` (s) along it that overlap.

    time: at even steps (n,), s; z: complex (n,). Returns frequencies (Hz, ascending, below 0 of what goes
    round clockwise), the middles of the windows (columns,), s, and amplitudes (columns, frequencies) in the
    unit of z: a circle of radius r has the height r. The mean of each window is removed; Hann.
    """
    count = samples(time, length)
    starts = np.linspace(0, len(z) - count, columns).round().astype(int)
    parts, shape = z[starts[:, None] + np.arange(count)], hann(count)
    spectrum = np.fft.fft((parts - parts.mean(axis=1, keepdims=True)) * shape, axis=1)
    frequency, middles = np.fft.fftfreq(count, interval(time)), time[starts + count // 2]
    amplitude = np.abs(spectrum) / np.sum(shape)
    return np.fft.fftshift(frequency), middles, np.fft.fftshift(amplitude, axes=1)


def waterfall(
    time: np.ndarray,
    values: np.ndarray,
    points: int = 32768,
    rate: float = 20e3,
    spectra: int = 8,
    window: str = "hann",
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Amplitude spectra of successive parts of a run: (frequencies in Hz, centres in s, amplitudes).

    The run is divided into `spectra` equal parts, whose middles are the centres; the spectrum of each
    takes `points` values from its start, without their mean, under `window`. amplitudes: (spectra,
    frequencies), in the unit of `values`; a sine of amplitude A has the height A. Nothing is resampled:
    raises ValueError where the values (at `time`, s) do not come at `rate` (Hz), or are too few.
    """
    if len(time) < 2 or not np.allclose(np.diff(time), 1.0 / rate, rtol=INTERVAL_TOLERANCE, atol=0.0):
        raise ValueError(f"the recording must have the rate {rate:g} Hz throughout; {_found_rate(time)}")
    from scipy.signal import get_window  # slow to import

    size = len(time) // spectra
    if size < points:
        raise ValueError(f"each of {spectra} parts has {size} values; a spectrum needs {points}")
    shape = get_window(window, points)
    parts = np.stack([values[k * size : k * size + points] for k in range(spectra)])
    spectrum = np.fft.rfft((parts - parts.mean(axis=1, keepdims=True)) * shape)
    scale = np.full(spectrum.shape[1], 2.0)
    scale[0] = 1.0
    if points % 2 == 0:
        scale[-1] = 1.0  # half the rate has no counterpart among the negative frequencies
    centres = time[0] + (np.arange(spectra) + 0.5) * size / rate
    return np.fft.rfftfreq(points, 1.0 / rate), centres, scale * np.abs(spectrum) / np.sum(shape)


def _found_rate(time: np.ndarray) -> str:
    """The fault of the rate, for people."""
    if len(time) < 2:
        return f"it has {len(time)} values"
    steps = np.diff(time)
    return f"its intervals are {np.min(steps):g} s to {np.max(steps):g} s"


def spectral_lines(
    frequencies: np.ndarray, amplitude: np.ndarray, low: float, high: float, count: int
) -> list[tuple[float, float]]:
    """The `count` tallest lines between `low` and `high` (Hz), the tallest first: (Hz, amplitude).

    Each is refined by a parabola through the logarithms of the three values at its top: under a Hann
    window within 0.02 of their spacing, and 4 % in height. Of a line, and what stands less than
    SIDE_LOBE_LINES values beside it, only the tallest counts.
    """
    inner = np.arange(1, len(amplitude) - 1)
    top = (amplitude[inner] > amplitude[inner - 1]) & (amplitude[inner] >= amplitude[inner + 1])
    band = (frequencies[inner] >= low) & (frequencies[inner] <= high)
    tops = inner[top & band]
    chosen: list[int] = []
    for k in tops[np.argsort(-amplitude[tops], kind="stable")].tolist():
        if len(chosen) == count:
            break
        if all(abs(k - other) >= SIDE_LOBE_LINES for other in chosen):
            chosen.append(k)
    return [_refined(frequencies, amplitude, k) for k in chosen]


def _refined(frequencies: np.ndarray, amplitude: np.ndarray, k: int) -> tuple[float, float]:
    """Top of the parabola through the logarithms of the values k - 1 to k + 1."""
    a, b, c = np.log(amplitude[k - 1 : k + 2] + 1e-300)
    shift = 0.5 * (a - c) / (a - 2.0 * b + c)
    top = float(np.exp(b - 0.25 * (a - c) * shift))
    return float(frequencies[k] + shift * (frequencies[1] - frequencies[0])), top
