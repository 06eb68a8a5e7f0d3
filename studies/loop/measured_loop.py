"""A controller measured: C(z) of an FMU of which only the answers are known.

Axis after axis is told a multisine, all of whose lines stand in whole periods, so that nothing leaks. Once
an answer repeats itself, the lines of one period give C(z) there. A rational function through the lines
(AAA: Nakatsukasa, Sete and Trefethen, SIAM J. Sci. Comput. 40 (2018) A1494) gives its poles, least squares
the residues, and the ranks of these how many states there are.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import AAA

from ...master.common.errors import TouchdownError
from ...master.components.component import Component
from ...master.coupling.controller_alone import ControllerAlone, control_axes

PERIOD = 1024  # samples in a period of the multisine
LARGEST = 1e-6  # m, of the multisine: far from every limit, far above rounding
PERIODS = 20  # to wait for an answer that repeats itself
REPEATS = 1e-9  # of the largest answer, from period to period
FITS = 1e-6  # of the largest C(z); what misses a linear law by more has none
ZERO = 1e-10  # of the largest C(z), or residue; less is rounding
RANK = 1e-6  # of a residue's largest singular value
TERMS = 60  # of a rational function, at most


@dataclass(frozen=True)
class MeasuredLaw:
    """C(z) = D + C (z - A)^-1 B of a controller's axes, from -position (m) to set point (A); A diagonal."""

    A: np.ndarray  # (n, n), complex
    B: np.ndarray  # (n, axes)
    C: np.ndarray  # (axes, n)
    D: np.ndarray  # (axes, axes)
    misfit: float  # largest distance from the lines, of the largest C(z)


def measure(component: Component, kinds: Sequence[str], period: float) -> MeasuredLaw:
    """The law of a controller's first axes, as many as `kinds` of set points; it was not initialised.

    period (s): from sample to sample. Raises TouchdownError where its answers do not repeat
    themselves, or are not those of a linear law.
    """
    there = control_axes(component)
    if len(there) < len(kinds):
        raise TouchdownError(f"{component.name} has {len(there)} axes, and is to control {len(kinds)}")
    axes = there[: len(kinds)]
    z, lines = _lines(ControllerAlone(component, axes, period, kinds), axes, component.name)
    return _law(component.name, z, lines)


def _lines(alone: ControllerAlone, axes: list[int], name: str) -> tuple[np.ndarray, np.ndarray]:
    """Where on the unit circle (n,), and C(z) there (n, axes, axes)."""
    numbers = np.arange(1, PERIOD // 2)
    excitation = _multisine(numbers)
    z = np.exp(2j * math.pi * numbers / PERIOD)
    found = np.empty((len(numbers), len(axes), len(axes)), complex)
    for k in range(len(axes)):
        places = np.zeros((PERIOD, len(axes)))
        places[:, k] = excitation
        answer = _repeated(alone, places, name)
        found[:, :, k] = -np.fft.rfft(answer, axis=0)[numbers] / np.fft.rfft(excitation)[numbers, None]
    return z, found


def _multisine(numbers: np.ndarray) -> np.ndarray:
    """A period of all lines (PERIOD,), m; phases by Schroeder keep its peaks low."""
    spectrum = np.zeros(PERIOD // 2 + 1, complex)
    spectrum[numbers] = np.exp(-1j * math.pi * numbers * (numbers - 1) / len(numbers))
    signal = np.fft.irfft(spectrum, PERIOD)
    return signal * (LARGEST / np.abs(signal).max())


def _repeated(alone: ControllerAlone, places: np.ndarray, name: str) -> np.ndarray:
    """Set points (PERIOD, axes) of a period that is as the one before it."""
    before = np.array([alone.sample(place) for place in places])
    for _ in range(PERIODS):
        answer = np.array([alone.sample(place) for place in places])
        if np.abs(answer - before).max() <= REPEATS * np.ptp(answer, axis=0).max():
            return answer
        before = answer
    raise TouchdownError(
        f"{name}: a position that repeats itself, {1e6 * LARGEST:g} um at most, gets another answer each "
        "time; its loop is not known. See that it is on from its start and has no noise of its own"
    )


def _law(name: str, z: np.ndarray, lines: np.ndarray) -> MeasuredLaw:
    """A minimal realisation of C(z) at `lines` (n, axes, axes)."""
    scale = np.abs(lines).max()
    if scale == 0.0:
        raise TouchdownError(f"{name} does not answer to a position; see that it is on from its start")
    poles = _poles(z, lines / scale)
    parts, misfit = _residues(z, lines / scale, poles)
    strong = np.abs(parts[1:]).max(axis=(1, 2)) > ZERO
    if not strong.all():
        poles = poles[strong]
        parts, misfit = _residues(z, lines / scale, poles)
    if misfit > FITS:
        raise TouchdownError(
            f"{name}: no linear law gives its answers to positions of at most {1e6 * LARGEST:g} um (it "
            f"misses them by {misfit:.1g}); its loop is not known"
        )
    states, into, out = [], [], []
    for pole, residue in zip(poles, parts[1:], strict=True):
        u, sizes, v = np.linalg.svd(scale * residue)
        for k in range(int(np.sum(sizes > RANK * sizes[0]))):
            states.append(pole)
            out.append(u[:, k] * sizes[k])
            into.append(v[k])
    width = lines.shape[1]
    return MeasuredLaw(
        np.diag(np.array(states, complex)),
        np.array(into, complex).reshape(-1, width),
        np.array(out, complex).reshape(-1, width).T,
        scale * parts[0],
        misfit,
    )


def _poles(z: np.ndarray, lines: np.ndarray) -> np.ndarray:
    """Of all axes together (n,): a combination of them by chance has each pole of any."""
    mixed = np.random.default_rng(1).uniform(0.5, 1.5, lines.shape[1:])
    values = (lines * mixed).sum(axis=(1, 2))
    fitted = AAA(np.concatenate((z, z.conj())), np.concatenate((values, values.conj())), max_terms=TERMS)
    return np.asarray(fitted.poles(), complex)


def _residues(z: np.ndarray, lines: np.ndarray, poles: np.ndarray) -> tuple[np.ndarray, float]:
    """Value at infinity, then each pole's residue (1 + poles, axes, axes), and the largest misfit."""
    terms = np.column_stack((np.ones(len(z)), *(1.0 / (z - pole) for pole in poles)))
    flat = lines.reshape(len(z), -1)
    parts = np.linalg.lstsq(terms, flat, rcond=None)[0]
    misfit = float(np.abs(terms @ parts - flat).max())
    return parts.reshape(-1, *lines.shape[1:]), misfit
