"""Whirl speeds of a spinning rotor: the lines of its Campbell diagram."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

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
