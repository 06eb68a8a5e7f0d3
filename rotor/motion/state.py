"""The state of a rotor of n modes and S stations, and views of its parts.

    q = (p_x, p_y, v_x, v_y, angle, spin, loss, work of the load at each station)        (4 n + 3 + S,)

Modal coordinates p (n,) in m kg^0.5 and velocities v = p' (n,) in m kg^0.5/s, of mass-normalised modes
that are the same in both planes; angle in rad, spin in rad/s; loss and work in J, since the start.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from touchdown.modelkit.kernel import kernel

ANGLE, SPIN, LOSS, WORK = range(4)  # behind the modal coordinates and velocities; WORK: one per station


class Planar(NamedTuple):
    """A quantity of every mode in both planes, (n,) each."""

    x: np.ndarray
    y: np.ndarray


class Modal(NamedTuple):
    """Modal coordinates and velocities, (n,) each; of a derivative, its velocities and accelerations."""

    px: np.ndarray
    py: np.ndarray
    vx: np.ndarray
    vy: np.ndarray


@kernel
def planar(row, m):
    """The first 2 n places of `row` as `Planar` views."""
    n = m.d.modes
    return Planar(row[:n], row[n : 2 * n])


@kernel
def modal(q, m):
    """The modal part of a state or of its derivative, (N,): views of n each."""
    n = m.d.modes
    return Modal(q[:n], q[n : 2 * n], q[2 * n : 3 * n], q[3 * n : 4 * n])


@kernel
def rest(q, m):
    """What is behind it: a view (3 + S,) with the places ANGLE, SPIN, LOSS, WORK + station."""
    return q[4 * m.d.modes :]
