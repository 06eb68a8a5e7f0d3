"""How balls share a static load, under an inner ring that bends or not."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from scipy.optimize import minimize

from ...modelkit.variables import as_record
from ..contact.materials import elastic_of
from ..rolling.ball_set import RaceStiffness, set_stiffness
from ..rolling.bending import AUTOMATIC, HARMONICS_PER_BALL, SHOULDER_HEIGHT, Groove, compliance, section_of
from .entry import Bearing

# Of the load on the most loaded ball, from which on a ring's bending is worth its time
WORTH_BENDING = 0.05


class _Sharing(NamedTuple):
    """Approaches of the rings at all balls are `by` times the unknowns, less `play`, in units of `depth`.

    Unknowns are the ring's place and the harmonics' amplitudes. Energies are over load times depth.
    """

    by: np.ndarray  # (balls, unknowns)
    push: np.ndarray  # (unknowns,), way of the load
    play: float

    def potential(self, at: np.ndarray) -> float:
        depth = self._depths(at)
        return float(0.4 * np.sum(depth**2.5) + 0.5 * np.sum(at[2:] ** 2) - self.push @ at)

    def slope(self, at: np.ndarray) -> np.ndarray:
        bent = np.concatenate([np.zeros(2), at[2:]])
        return self.by.T @ self._depths(at) ** 1.5 + bent - self.push

    def curvature(self, at: np.ndarray) -> np.ndarray:
        bent = np.diag(np.concatenate([np.zeros(2), np.ones(len(at) - 2)]))
        return self.by.T @ (1.5 * np.sqrt(self._depths(at))[:, None] * self.by) + bent

    def _depths(self, at: np.ndarray) -> np.ndarray:
        return np.maximum(self.by @ at - self.play, 0.0)


def ball_loads(bearing: Bearing, load: float, harmonics: int, offset: float = 0.0) -> np.ndarray:
    """Loads (N) of the balls in a row, (count,), of a journal that presses a bearing with `load` (N).

    harmonics: the highest in which the inner ring bends, 0: none; offset: of the load from the first ball
    towards the next one, over the angle between them. The load acts at one point of the bore; the outer
    ring is held, grooves and material are the bearing's.
    """
    count, rows = bearing.balls.count, bearing.balls.rows
    stiffness = as_record(RaceStiffness())
    set_stiffness(stiffness, as_record(bearing.balls), elastic_of(as_record(bearing.ring)))
    spring = rows * float(stiffness["series"])
    depth = (load / spring) ** (2.0 / 3.0)
    angles = 2.0 * math.pi / count * (np.arange(count) - offset)
    shapes = [np.cos(angles), np.sin(angles)]
    push = [1.0, 0.0]
    section, rings = section_of(inner_groove(bearing)), elastic_of(as_record(bearing.ring))
    for n in range(2, harmonics + 1):
        given = compliance(section, n, rings.modulus, rings.poisson)
        root = math.sqrt(given * load / depth)
        shapes += [root * np.cos(n * angles), root * np.sin(n * angles)]
        push += [root, 0.0]
    sharing = _Sharing(np.array(shapes).T, np.array(push), bearing.balls.play / depth)
    start = np.zeros(len(push))
    start[0] = max(sharing.play, 0.0) + 1.0
    found = minimize(
        sharing.potential, start, jac=sharing.slope, hess=sharing.curvature, method="trust-exact", tol=1e-9
    )
    return load / rows * np.maximum(sharing.by @ found.x - sharing.play, 0.0) ** 1.5


def inner_groove(bearing: Bearing) -> Groove:
    """`Groove` of the bearing's inner ring."""
    b = bearing.balls
    bottom = 0.5 * (b.pitch_diameter - b.diameter)
    shoulder, arc = bottom + SHOULDER_HEIGHT * b.diameter, 0.5 * b.conformity * b.diameter
    return Groove(0.5 * bearing.bore, bottom, shoulder, bearing.width, arc, b.rows)


def harmonics_for(count: int) -> int:
    """The highest harmonic that `count` balls in a row ask for."""
    return math.ceil(HARMONICS_PER_BALL * count)


def gain_by_bending(bearing: Bearing, load: float) -> float:
    """By how much more (1) the most loaded ball bears since the ring bends: the worse of two positions.

    load: N, on a ball or between two.
    """
    rigid, bent = (
        max(ball_loads(bearing, load, harmonics, offset).max() for offset in (0.0, 0.5))
        for harmonics in (0, harmonics_for(bearing.balls.count))
    )
    return float(bent / rigid - 1.0)


def harmonics_worth(bearing: Bearing, load: float) -> tuple[int, float]:
    """(ring.harmonics for a `load` (N), gain by bending): `AUTOMATIC` where that is worth it, else 0."""
    gain = gain_by_bending(bearing, load)
    return AUTOMATIC if gain > WORTH_BENDING else 0, gain
