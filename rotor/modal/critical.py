"""Undamped critical speeds: where a whirl is as fast as the spin that an unbalance drives it with.

A whirl at the spin speed w, x = X cos w t and y = Y sin w t in the coordinates of `Basis`, has

    K_x X = w^2 (X - G Y),    K_y Y = w^2 (Y - G X),

K with the springs of the supports. Where both planes are held alike, Y = X is the forward whirl, which
unbalance drives, and Y = -X the backward one, which it does not.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy import linalg

from touchdown.rotor.beams.shaft import Shaft, Station, Support
from touchdown.rotor.modal.modes import Basis

STIFFNESSES = 61  # of a map
DECADES = (-4, 2)  # of a map, about the first bending mode's frequency squared times the mass
LINES = 5  # of a map
LEAST = 1e-12  # of the largest 1 / w^2: below, rounding of what has no critical speed


@dataclass(frozen=True)
class CriticalMap:
    """Critical speeds over the stiffness of the supports at some stations, equal at all of them.

    `marked` are the supports that the shaft itself has there, and `own` its critical speeds on them.
    """

    places: tuple[Station, ...]
    stiffness: np.ndarray  # (K,), N/m, of each support
    speeds: np.ndarray  # (K, L), rad/s, ascending; nan where there are less
    marked: tuple[Support, ...]
    own: np.ndarray  # (up to L,), rad/s; empty where a place has no support


def critical_speeds(basis: Basis, supports: Sequence[Support]) -> np.ndarray:
    """Critical speeds on `supports`, without their damping, ascending (C,), rad/s.

    Where the planes are held alike, those of the forward whirl; else all, since unbalance drives all. A
    whirl whose gyroscopic moment outruns it has none. At least two nodes must be held.
    """
    planes = [_held(basis, supports, plane) for plane in ("stiffness", "stiffness_y")]
    one, G = np.eye(len(basis.omega)), basis.gyroscopic
    if np.array_equal(planes[0], planes[1]):
        return _speeds(planes[0], one - G)
    return _speeds(np.asarray(linalg.block_diag(*planes)), np.block([[one, -G], [-G, one]]))


def critical_map(shaft: Shaft, basis: Basis, places: Sequence[Station]) -> CriticalMap:
    """The map of `shaft` held at `places`, two nodes or more; about its first bending mode."""
    scale = shaft.mass * basis.omega[2] ** 2
    low, high = (round(np.log10(scale) + decade) for decade in DECADES)
    stiffness = np.logspace(low, high, STIFFNESSES)
    held = [Support(node, 1.0) for node in dict.fromkeys(s.node for s in places)]
    speeds = [critical_speeds(basis, [replace(s, stiffness=k) for s in held]) for k in stiffness]
    nodes = {s.node for s in held}
    stiff = [s for s in shaft.supports if 0.0 not in (s.stiffness, s.stiffness_y)]
    marked = tuple(s for s in stiff if s.node in nodes)
    own = critical_speeds(basis, marked) if {s.node for s in marked} == nodes else np.zeros(0)
    return CriticalMap(tuple(places), stiffness, np.array([_first(s) for s in speeds]), marked, own[:LINES])


def _first(speeds: np.ndarray) -> np.ndarray:
    """The lowest `LINES` of them (LINES,), nan where there are less."""
    return np.pad(speeds[:LINES], (0, max(0, LINES - len(speeds))), constant_values=np.nan)


def _held(basis: Basis, supports: Sequence[Support], plane: str) -> np.ndarray:
    """Stiffness of a plane with the springs there (n, n)."""
    K = np.diag(basis.omega**2)
    for s in supports:
        stiffness = getattr(s, plane)
        shape = basis.deflections([s.node])[0]
        K += (s.stiffness if stiffness is None else stiffness) * np.outer(shape, shape)
    return K


def _speeds(K: np.ndarray, M: np.ndarray) -> np.ndarray:
    """Real w of K v = w^2 M v, ascending; K is positive definite, M need not be."""
    inverse = linalg.eigh(M, K, eigvals_only=True)  # 1 / w^2
    return 1.0 / np.sqrt(inverse[inverse > LEAST * inverse[-1]][::-1])
