"""Where the journal presses on the bore, and how that place moves round it.

A recording shows a row of contacts with flights between them. In contact the place follows from the force
on the journal, of which the bearing presses it back: this holds wherever the orbit has its centre, and
friction turns it by no more than its angle. Where no force was recorded, contact is assumed beyond
TOUCHES of the clearance, in the direction in which the journal stands.

From contact to contact the place goes on along the bore as far as the journal turned in the flight, if
the flight clings to the bore or crosses it as a free body would, along a chord. A chord that spans the
angle a comes as near to the centre as cos(a/2) of the clearance. Gravity bends it: by 0.3 of the
clearance in a quarter of a pendulum's period. Other flights end the row: bounces through the middle,
orbits held by something else than the bore (a magnetic bearing, an unbalance).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

TURN = 2.0 * math.pi
TOUCHES = 0.95  # of the clearance: the ring may stand a little off its centre
PRESSES = 1e-6  # of the largest force; below it a foreign bearing's force is rounding
FEWEST = 16  # rows to judge from
FOLLOWED = TURN / 3.0  # between recorded values; more may as well have been the other way round
NEAR = 0.9  # of the clearance; a flight beyond it clings to the bore, which gives and has play
CLINGS = 0.6 * TURN  # most that such a flight turns: the journal touches along 0.4 of a turn or more
HOPS = TURN * 160.0 / 360.0  # most that a chord spans: a star's 150 degrees, and not the 180 of a bounce
BENDS = 0.25  # of the clearance: gravity bends a hop off its chord by so much, inwards or outwards
COARSE = TURN / 4.0  # between recorded values in contact; a whirl turns by less where it is recorded well
ROUND, OWN_CENTRE = 0.05, 0.5  # of the clearance: how well a circle fits, how far off its centre may be
DEEPER = 0.5  # of a short chord's distance to the centre: a rebound that lands nearby may come so deep


class Orbit(NamedTuple):
    """A journal's recorded path about the bearing's centre; each of shape (rows,)."""

    time: np.ndarray  # s
    x: np.ndarray  # m
    y: np.ndarray  # m
    clearance: float  # m, on radius

    @property
    def radius(self) -> np.ndarray:
        """Distance to the bearing's centre over the clearance, (rows,)."""
        return np.hypot(self.x, self.y) / self.clearance

    @property
    def angle(self) -> np.ndarray:
        """Direction of the journal from the bearing's centre (rad, counter-clockwise), (rows,)."""
        return np.arctan2(self.y, self.x)


@dataclass(frozen=True)
class March:
    """An unbroken row of contacts: `rows` into the recording, ascending, and the place `angle` there.

    angle: rad, counter-clockwise, without jumps, (len(rows),).
    """

    rows: np.ndarray
    angle: np.ndarray

    def touched(self, first: int, last: int) -> float:
        """Turn (rad, with its sign) between two of its entries while in contact, hops left out."""
        step = np.diff(self.angle[first : last + 1])
        return float(np.sum(step[np.diff(self.rows[first : last + 1]) == 1]))


def wrapped(angle: np.ndarray) -> np.ndarray:
    """The same directions between minus and plus half a turn."""
    return (angle + math.pi) % TURN - math.pi


def marches(orbit: Orbit, force: tuple[np.ndarray, np.ndarray] | None) -> list[March]:
    """The rows of contacts of a recording; force: on the journal (N), x and y, each (rows,)."""
    rows, place = _contacts(orbit, force)
    if len(rows) == 0:
        return []
    step, goes_on = _steps(orbit, rows, place)
    angle = place[0] + np.concatenate([[0.0], np.cumsum(step)])
    parts = np.split(np.arange(len(rows)), np.flatnonzero(~goes_on) + 1)
    return [March(rows[part], angle[part]) for part in parts]


def too_coarse(orbit: Orbit, force: tuple[np.ndarray, np.ndarray] | None) -> bool:
    """Whether contacts in successive rows mostly lie so far apart that which way they went is unknown."""
    rows, place = _contacts(orbit, force)
    successive = np.diff(rows) == 1
    step = np.abs(wrapped(np.diff(place)[successive]))
    return len(step) >= FEWEST and bool(np.median(step) >= COARSE)


def about_its_circle(orbit: Orbit) -> Orbit:
    """The orbit about the centre of the circle that its outer part runs on, as about a displaced ring.

    Unchanged where that part is no circle of about the clearance, or does not go all the way round.
    """
    far = np.flatnonzero(orbit.radius >= OWN_CENTRE)
    if len(far) < FEWEST:
        return orbit
    x, y = orbit.x[far] / orbit.clearance, orbit.y[far] / orbit.clearance
    # |r|^2 = 2 r . c + (R^2 - |c|^2), linear in the centre c and in the bracket
    matrix = np.column_stack([2.0 * x, 2.0 * y, np.ones(len(x))])
    cx, cy, rest = np.linalg.lstsq(matrix, x * x + y * y, rcond=None)[0]
    radius = math.sqrt(max(rest + cx * cx + cy * cy, 0.0))
    off = np.abs(np.hypot(x - cx, y - cy) - radius)
    quarters = np.unique(np.floor(np.arctan2(y - cy, x - cx) / (0.25 * TURN)))
    fits = np.median(off) <= ROUND and len(quarters) == 4 and math.hypot(cx, cy) <= OWN_CENTRE
    if not fits or not TOUCHES <= radius <= 1.0 + OWN_CENTRE:
        return orbit
    return orbit._replace(x=orbit.x - cx * orbit.clearance, y=orbit.y - cy * orbit.clearance)


def _contacts(orbit: Orbit, force: tuple[np.ndarray, np.ndarray] | None) -> tuple[np.ndarray, np.ndarray]:
    """Rows in contact, and where on the bore (rad)."""
    if force is None:
        rows = np.flatnonzero(orbit.radius >= TOUCHES)
        return rows, orbit.angle[rows]
    size = np.hypot(*force)
    rows = np.flatnonzero(size > PRESSES * np.max(size, initial=0.0, where=np.isfinite(size)))
    return rows, np.arctan2(-force[1][rows], -force[0][rows])


def _steps(orbit: Orbit, rows: np.ndarray, place: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """From each row in contact to the next: the turn (rad), and whether the row of contacts goes on."""
    turned = wrapped(np.diff(orbit.angle))
    lost = np.concatenate([[0], np.cumsum(~(np.abs(turned) < FOLLOWED))])
    wound = np.concatenate([[0.0], np.cumsum(np.nan_to_num(turned))])
    flies = np.diff(rows) > 1
    journal = np.where(flies, np.diff(wound[rows]), 0.0)
    step = journal + wrapped(np.diff(place) - journal)
    least = _least_between(orbit.radius, rows)
    hop = (np.diff(lost[rows]) == 0) & _is_hop(step, least)
    return step, np.where(flies, hop, np.abs(step) < FOLLOWED)


def _least_between(radius: np.ndarray, rows: np.ndarray) -> np.ndarray:
    """Least `radius` from each of `rows` to the next, shape (len(rows) - 1,)."""
    if len(rows) < 2:
        return np.zeros(0)
    return np.minimum.reduceat(radius[: rows[-1]], rows[:-1])


def _is_hop(turn: np.ndarray, least: np.ndarray) -> np.ndarray:
    """Whether flights that turn so far (rad) and come so near to the centre belong to a row of contacts."""
    span = np.abs(turn)
    chord = np.cos(0.5 * span)
    clings = (span <= CLINGS) & (least >= NEAR)
    deepest = np.minimum(DEEPER * chord, chord - BENDS)
    return clings | ((span <= HOPS) & (least >= deepest) & (least <= chord + BENDS))
