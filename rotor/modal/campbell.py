"""Whirl speeds of a spinning rotor: the lines of its Campbell diagram, free or on supports."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from touchdown.rotor.beams.shaft import Support
from touchdown.rotor.modal.modes import Basis


def whirl_frequencies(
    basis: Basis, speeds: Sequence[float] | np.ndarray, supports: Iterable[tuple[int, float]] = ()
) -> np.ndarray:
    """Whirl speeds at each spin speed, (len(speeds), 2n), rad/s, ascending; forward whirl is positive.

    `supports` are isotropic springs to the ground: (node counted from 1, stiffness in N/m). An undamped
    motion p exp(i w t) has w^2 p = w Omega G p + K p. With K = B B^T and w s = B^T p this is the
    symmetric problem w (p, s) = [[Omega G, B], [B^T, 0]] (p, s): its w are real, and a free rotor's
    zeros cost no accuracy.
    """
    n = len(basis.omega)
    rows = [np.diag(basis.omega)]
    for node, stiffness in supports:
        rows.append(np.sqrt(stiffness) * basis.deflections([node]))
    _, upper = np.linalg.qr(np.vstack(rows))
    B = upper.T
    whirl = np.empty((len(speeds), 2 * n))
    for i, speed in enumerate(speeds):
        whirl[i] = np.linalg.eigvalsh(np.block([[speed * basis.gyroscopic, B], [B.T, np.zeros((n, n))]]))
    return whirl


@dataclass(frozen=True)
class Whirl:
    """Modes of a spinning rotor on supports, by their size: one of each conjugate pair, M in all."""

    roots: np.ndarray  # (M,), complex, 1/s: damping and whirl speed, imaginary part not negative
    sense: np.ndarray  # (M,), 1 circular forward whirl, -1 circular backward, 0 in a plane

    @property
    def frequencies(self) -> np.ndarray:
        """Damped whirl frequencies (M,), Hz."""
        return np.imag(self.roots) / (2.0 * np.pi)

    @property
    def damping_ratios(self) -> np.ndarray:
        """Share of critical damping (M,); 0 for what does not swing and is not damped."""
        size = np.abs(self.roots)
        return np.divide(-np.real(self.roots), size, out=np.zeros_like(size), where=size > 0.0)


def supported_whirl(basis: Basis, speed: float, supports: Sequence[Support]) -> Whirl:
    """Modes at spin `speed` (rad/s) on `supports`, which may differ by plane and damp.

    With p = x + i y as in `Basis`: x'' + C_x x' + K_x x + speed G y' = 0, and y'' + C_y y' + K_y y -
    speed G x' = 0. What is overdamped is left out.
    """
    n = len(basis.omega)
    K, C = np.zeros((2 * n, 2 * n)), np.zeros((2 * n, 2 * n))
    for plane in (slice(0, n), slice(n, 2 * n)):
        K[plane, plane] = np.diag(basis.omega**2)
    C[:n, n:], C[n:, :n] = speed * basis.gyroscopic, -speed * basis.gyroscopic
    for s in supports:
        shape = basis.deflections([s.node])[0]
        tie = np.outer(shape, shape)
        K[:n, :n] += s.stiffness * tie
        K[n:, n:] += (s.stiffness if s.stiffness_y is None else s.stiffness_y) * tie
        C[:n, :n] += s.damping * tie
        C[n:, n:] += (s.damping if s.damping_y is None else s.damping_y) * tie
    system = np.block([[np.zeros_like(K), np.eye(2 * n)], [-K, -C]])
    roots, vectors = np.linalg.eig(system)
    swinging = np.imag(roots) > 0.0
    roots, x, y = roots[swinging], vectors[:n, swinging], vectors[n : 2 * n, swinging]
    turning = -2.0 * np.imag(np.sum(np.conj(x) * y, axis=0))
    sense = turning / np.sum(np.abs(x) ** 2 + np.abs(y) ** 2, axis=0)
    order = np.argsort(np.abs(roots))
    return Whirl(roots[order], sense[order])
