"""How balls share a static load: inner ring rigid or bent, outer ring held, soft or loose in its seat."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ...modelkit.variables import as_record
from ..contact.materials import elastic_of
from ..rolling.ball_set import RaceStiffness, set_stiffness
from ..rolling.bending import (
    AUTOMATIC,
    HARMONICS_PER_BALL,
    MAX_HARMONICS,
    SHOULDER_HEIGHT,
    Groove,
    compliance,
    section_of,
)
from .entry import Bearing

# Of the load on the most loaded ball, from which on a ring's bending is worth its time
WORTH_BENDING = 0.05
# A loose outer ring on a steel seat: two to three times as stiff as balls and races (N/m per radian)
STEEL_SEAT = 2e10
SEAT_PLACES = 720  # at which a loose ring may touch its seat
OUTER_HARMONICS = 12  # in which an outer ring bends that its seat does not hold round


@dataclass(frozen=True)
class RingSeat:
    """The seat of the outer ring: by default a bore that keeps it round.

    stiffness: of an even radial support, as a translation meets it (N/m); inf: rigid. play: radial, of the
    ring in its bore (m), where it bears on one side only; 0: it fits.
    """

    stiffness: float = math.inf
    play: float = 0.0


HELD = RingSeat()


class _Sharing(NamedTuple):
    """Approaches of the rings at all balls are `by` times the unknowns, less `play`, in units of `depth`.

    Unknowns are the ring's place, the harmonics' amplitudes of the inner and those of the outer ring, and
    of a loose outer ring its place. A loose one leaves its middle at places of the seat by `out` times the
    unknowns, and bears where that is more than its play. Energies are over load times depth.
    """

    by: np.ndarray  # (balls, unknowns)
    push: np.ndarray  # (unknowns,), way of the load
    bent: np.ndarray  # (unknowns,), 1 where an unknown is a harmonic's amplitude, else 0
    play: float
    out: np.ndarray  # (places, unknowns)
    seat_play: float
    seat: float  # stiffness of a place

    def potential(self, ways: np.ndarray) -> float:
        depth, pressed = self._depths(ways), self._pressed(ways)
        stored = 0.4 * np.sum(depth**2.5) + 0.5 * np.sum(self.bent * ways**2) - self.push @ ways
        return float(stored + 0.5 * self.seat * np.sum(pressed**2))

    def slope(self, ways: np.ndarray) -> np.ndarray:
        balls = self.by.T @ self._depths(ways) ** 1.5
        return balls + self.bent * ways - self.push + self.seat * self.out.T @ self._pressed(ways)

    def curvature(self, ways: np.ndarray) -> np.ndarray:
        balls = self.by.T @ (1.5 * np.sqrt(self._depths(ways))[:, None] * self.by)
        touching = self.out[self._pressed(ways) > 0.0]
        return balls + np.diag(self.bent) + self.seat * touching.T @ touching

    def _depths(self, ways: np.ndarray) -> np.ndarray:
        return np.maximum(self.by @ ways - self.play, 0.0)

    def _pressed(self, ways: np.ndarray) -> np.ndarray:
        return np.maximum(self.out @ ways - self.seat_play, 0.0)


class _Waves(NamedTuple):
    """Harmonics of a ring, two unknowns each: how far one of 1 moves the ring, over `depth` (1)."""

    orders: np.ndarray  # (unknowns,)
    size: np.ndarray  # (unknowns,)

    def at(self, angles: np.ndarray) -> np.ndarray:
        """Ways outwards at `angles` (places,) (rad), (places, unknowns), of cosines and sines in turn."""
        waves = self.orders * angles[:, None]
        waves[:, 1::2] -= 0.5 * math.pi
        return self.size * np.cos(waves)


def _waves(groove: Groove, bearing: Bearing, top: int, scale: float, held: float = 0.0) -> _Waves:
    """`_Waves` from the second harmonic to `top` of a ring of the bearing; scale: load over depth (N/m).

    held: stiffness that holds the ring round (N/m).
    """
    section, elastic = section_of(groove), elastic_of(as_record(bearing.ring))
    orders = np.repeat(np.arange(2, top + 1), 2)
    give = [compliance(section, n, elastic.modulus, elastic.poisson) for n in orders]
    return _Waves(orders, np.sqrt([scale / (1.0 / c + held) for c in give]))


def ball_loads(
    bearing: Bearing, load: float, harmonics: int, offset: float = 0.0, seat: RingSeat = HELD
) -> np.ndarray:
    """Loads (N) of the balls in a row, (count,), of a journal that presses a bearing with `load` (N).

    harmonics: the highest in which the inner ring bends, 0: none; offset: of the load from the first ball
    towards the next one, over the angle between them. The load acts at one point of the bore; grooves and
    material are the bearing's.
    """
    from scipy.optimize import minimize  # not in the time of every start

    stiffness = as_record(RaceStiffness())
    set_stiffness(stiffness, as_record(bearing.balls), elastic_of(as_record(bearing.ring)))
    depth = (load / (bearing.balls.rows * float(stiffness["series"]))) ** (2.0 / 3.0)
    angles = 2.0 * math.pi / bearing.balls.count * (np.arange(bearing.balls.count) - offset)
    sharing = _inside(bearing, harmonics, angles, load, depth)
    if seat.play > 0.0 or math.isfinite(seat.stiffness):
        sharing = _in_seat(sharing, bearing, seat, angles, load, depth)
    start = np.where(sharing.bent == 0.0, sharing.push, 0.0) * (max(sharing.play, 0.0) + 1.0)
    if seat.play > 0.0:
        start[[0, -2]] += sharing.seat_play
    found = minimize(
        sharing.potential, start, jac=sharing.slope, hess=sharing.curvature, method="trust-exact", tol=1e-9
    )
    return load / bearing.balls.rows * np.maximum(sharing.by @ found.x - sharing.play, 0.0) ** 1.5


def _inside(bearing: Bearing, harmonics: int, angles: np.ndarray, load: float, depth: float) -> _Sharing:
    """`_Sharing` of balls at `angles` (rad) within an outer ring that is held round."""
    waves = _waves(inner_groove(bearing), bearing, harmonics, load / depth)
    by = np.hstack([_directions(angles), waves.at(angles)])
    push = np.concatenate([[1.0, 0.0], waves.at(np.zeros(1))[0]])
    bent = np.concatenate([np.zeros(2), np.ones(len(push) - 2)])
    return _Sharing(by, push, bent, bearing.balls.play / depth, np.zeros((0, len(push))), 0.0, 0.0)


def _in_seat(
    held: _Sharing, bearing: Bearing, seat: RingSeat, angles: np.ndarray, load: float, depth: float
) -> _Sharing:
    """The same with an outer ring that a soft or loose `seat` lets bend."""
    loose = seat.play > 0.0
    rounding = 0.0 if loose else seat.stiffness
    waves = _waves(outer_groove(bearing), bearing, OUTER_HARMONICS, load / depth, rounding)
    # an even support gives way as a whole, too, which no ball feels; a loose ring lies where it is pressed
    moves = [_directions(angles)] if loose else []
    by = np.hstack([held.by, -waves.at(angles), *(-one for one in moves)])
    more = by.shape[1] - len(held.push)
    push, bent = np.append(held.push, np.zeros(more)), np.append(held.bent, np.ones(more))
    out = np.zeros((0, len(push)))
    if loose:
        bent[-2:] = 0.0
        around = 2.0 * math.pi / SEAT_PLACES * np.arange(SEAT_PLACES)
        out = np.hstack([np.zeros((SEAT_PLACES, len(held.push))), waves.at(around), _directions(around)])
    place = min(STEEL_SEAT, seat.stiffness / math.pi) * 2.0 * math.pi / SEAT_PLACES
    return _Sharing(by, push, bent, held.play, out, seat.play / depth, place * depth / load)


def _directions(angles: np.ndarray) -> np.ndarray:
    """(places, 2) of unit vectors at `angles` (rad)."""
    return np.column_stack([np.cos(angles), np.sin(angles)])


def inner_groove(bearing: Bearing) -> Groove:
    """`Groove` of the bearing's inner ring."""
    b = bearing.balls
    bottom = 0.5 * (b.pitch_diameter - b.diameter)
    shoulder, arc = bottom + SHOULDER_HEIGHT * b.diameter, 0.5 * b.conformity * b.diameter
    return Groove(0.5 * bearing.bore, bottom, shoulder, bearing.width, arc, b.rows)


def outer_groove(bearing: Bearing) -> Groove:
    """`Groove` of the bearing's outer ring."""
    b = bearing.balls
    bottom = 0.5 * (b.pitch_diameter + b.diameter)
    shoulder = bottom - SHOULDER_HEIGHT * b.diameter
    arc = 0.5 * (b.outer_conformity or b.conformity) * b.diameter
    return Groove(0.5 * bearing.outside, bottom, shoulder, bearing.width, arc, b.rows)


def harmonics_for(count: int) -> int:
    """The highest harmonic that `count` balls in a row ask for."""
    return min(math.ceil(HARMONICS_PER_BALL * count), MAX_HARMONICS)


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
    """(ring.harmonics for a `load` (N), gain by bending): `AUTOMATIC` where that is worth it, else 0.

    Rings of rows that have a contact angle in a drop, as pairs do, are left rigid: 0. How they bend is not
    validated.
    """
    gain = gain_by_bending(bearing, load)
    bends = gain > WORTH_BENDING and bearing.angle_in_drops == 0.0
    return AUTOMATIC if bends else 0, gain
