"""A pair or set of rows under a static load: pose of the inner ring, loads of its balls, stiffness."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...modelkit.variables import as_record
from ..contact.materials import STEEL_NUMBERS, Elastic
from ..rolling.ball_set import BallSet
from .angular_row import SINGLE, SINGLES, BallRow, Pose, ball_rows, pressed

COORDINATES = ("x", "y", "z", "rx", "ry")
NEWTON_STEPS = 4
UNBALANCED = 1e-9  # of the load, what may be left of it


@dataclass(frozen=True)
class MountedRows:
    """Rows of balls with a contact angle, as mounted; grooves, material and play are those of `balls`.

    rings: their material; contact_angle: rad; arrangement: of `ARRANGEMENTS`; distance: of the rows (m);
    preload: by which a pair is clamped (N); interference: by which its rings are closed along the shaft
    instead (m); phase: of the first ball of every row, as an angle around the
    shaft from x (rad).
    """

    balls: BallSet
    contact_angle: float
    rings: Elastic = STEEL_NUMBERS
    arrangement: int = SINGLE
    distance: float = 0.0
    preload: float = 0.0
    interference: float = 0.0
    phase: float = 0.0

    def rows(self) -> tuple[BallRow, ...]:
        """Its rows; a pair of them, or one."""
        both = ball_rows(
            *(as_record(self.balls), self.rings, self.contact_angle),
            *(self.arrangement, self.distance, (self.preload, self.interference, 0.0)),
        )
        return both[:1] if self.arrangement in SINGLES else both

    def angles(self) -> np.ndarray:
        """Of the balls of a row around the shaft (rad), (count,)."""
        count = self.balls.count
        return self.phase + 2.0 * math.pi / count * np.arange(count)


@dataclass(frozen=True)
class RingBalance:
    """An inner ring in balance with a load.

    pose: (5,), x, y, z (m), rx, ry (rad); forces, angles: of every ball, (rows, count) (N; rad, of the
    contact, positive where the ball carries a shaft pushed in +z); stiffness: (5, 5), of the load over the
    pose.
    """

    pose: np.ndarray
    forces: np.ndarray
    angles: np.ndarray
    stiffness: np.ndarray


def balls_on(
    rows: Sequence[BallRow], angles: np.ndarray, pose: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """(Load (5,) that holds the inner ring (N, N m), its slope over the pose (5, 5)) at a pose (5,)."""
    load, slope = np.zeros(5), np.zeros((5, 5))
    place = Pose(*pose)
    for row in rows:
        for c, s in zip(np.cos(angles), np.sin(angles), strict=True):
            ball = pressed(row, place, c, s, 0.0)
            moves = np.array(
                [
                    [c, s, 0.0, -row.inner_at * s, row.inner_at * c],
                    [0.0, 0.0, 1.0, row.lever * s, -row.lever * c],
                ]
            )
            line = np.array([ball.cosine, ball.sine])
            across = ball.force / ball.length
            by = across * np.eye(2) + (ball.slope - across) * np.outer(line, line)
            load += moves.T @ np.array([ball.outwards, ball.along])
            slope += moves.T @ by @ moves
    return load, slope


def energy_at(rows: Sequence[BallRow], angles: np.ndarray, pose: np.ndarray) -> float:
    """Energy of all contacts (J) at a pose (5,)."""
    place, stored = Pose(*pose), 0.0
    for row in rows:
        for c, s in zip(np.cos(angles), np.sin(angles), strict=True):
            ball = pressed(row, place, c, s, 0.0)
            stored += 0.4 * ball.force * max(ball.length - row.free, 0.0)
    return stored


def balance(
    rows: Sequence[BallRow], angles: np.ndarray, load: Sequence[float], held: Sequence[str] = ()
) -> RingBalance:
    """The inner ring of `rows` under a `load` (5,) (N, N, N, N m, N m), with coordinates held at 0.

    angles: of the balls of a row around the shaft (rad); held: names of `COORDINATES`. Raises ValueError
    where the load finds no hold, or a row is pushed to the side without a shoulder.
    """
    from scipy.optimize import minimize  # not in the time of every start

    free = [k for k, name in enumerate(COORDINATES) if name not in held]
    push = np.asarray(load, dtype=float)
    # a unit of each coordinate: what the largest load makes of it, about
    largest = max(float(np.abs(push[:3]).max()), float(np.abs(push[3:]).max()) / rows[0].lever, 1e-3)
    depth = (largest / (len(angles) * rows[0].stiffness)) ** (2.0 / 3.0)
    unit = np.array([1.0, 1.0, 1.0, 1.0 / rows[0].lever, 1.0 / rows[0].lever]) * depth
    scale = largest * depth

    def pose(scaled: np.ndarray) -> np.ndarray:
        whole = np.zeros(5)
        whole[free] = scaled * unit[free]
        return whole

    def energy(scaled: np.ndarray) -> float:
        return (energy_at(rows, angles, pose(scaled)) - float(push @ pose(scaled))) / scale

    def slope(scaled: np.ndarray) -> np.ndarray:
        return ((balls_on(rows, angles, pose(scaled))[0] - push) * unit)[free] / scale

    def curvature(scaled: np.ndarray) -> np.ndarray:
        by = balls_on(rows, angles, pose(scaled))[1] * np.outer(unit, unit) / scale
        return by[np.ix_(free, free)]

    start = np.sign(push[free]) * (2.0 + (rows[0].free - abs(rows[0].inner - rows[0].outer)) / depth)
    scaled = minimize(energy, start, jac=slope, hess=curvature, method="trust-exact").x
    for _ in range(NEWTON_STEPS):  # beyond what differences of energy resolve
        scaled = scaled - np.linalg.lstsq(curvature(scaled), slope(scaled), rcond=None)[0]
    if not np.abs(slope(scaled)).max() < UNBALANCED:
        raise ValueError(f"a load of {np.array2string(push, precision=4)} N, N m finds no hold")
    return _balance_at(rows, angles, pose(scaled))


def _balance_at(rows: Sequence[BallRow], angles: np.ndarray, pose: np.ndarray) -> RingBalance:
    """`RingBalance` at its pose (5,). Raises ValueError as `balance` does."""
    place = Pose(*pose)
    balls = [[pressed(row, place, math.cos(a), math.sin(a), 0.0) for a in angles] for row in rows]
    for row, ones in zip(rows, balls, strict=True):
        side = row.inner_at - row.outer_at
        if any(ball.along * side < 0.0 for ball in ones):
            raise ValueError("a row with a contact angle is pushed to the side on which it has no shoulder")
    return RingBalance(
        pose,
        np.array([[ball.force for ball in row] for row in balls]),
        np.array([[math.atan2(ball.sine, ball.cosine) for ball in row] for row in balls]),
        balls_on(rows, angles, pose)[1],
    )
