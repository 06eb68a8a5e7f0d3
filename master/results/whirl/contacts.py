"""Where the journal presses on the bore, and how that place moves round it: onwards, or to and fro.

A recording shows a row of contacts with flights between them. In contact the place follows from the force
on the journal, of which the bearing presses it back: this holds wherever the orbit has its centre, and
friction turns it by no more than its angle. Where no force was recorded, contact is assumed beyond
TOUCHES of the clearance, in the direction in which the journal stands.

From contact to contact the place goes on along the bore as far as the journal turned in the flight, if
the flight clings to the bore or crosses it as a free body would, along a chord. A chord that spans the
angle a comes as near to the centre as cos(a/2) of the clearance. Gravity bends it: by 0.3 of the
clearance in a quarter of a pendulum's period. Other flights end the row: bounces through the middle,
orbits held by something else than the bore (a magnetic bearing, an unbalance).

A march is cut into stretches that go one way (`one_ways`); those that come back are swings (`_is_swing`). A
free pendulum turns back at its ends, where its speed goes through zero, and stays within a turn from side
to side. A driven one may go over the top and come back: one way by up to MAX_SWING is still a swing if it
turns back into a like one, and slows down before it does.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from enum import StrEnum
from typing import NamedTuple

import numpy as np

TURN = 2.0 * math.pi
TOUCHES = 0.95  # of the clearance: the ring may stand a little off its centre
PRESSES = 1e-6  # of the largest force; below it a foreign bearing's force is rounding
FEWEST = 16  # rows to judge from
FOLLOWED = TURN / 3.0  # between recorded values; more may as well have been the other way round
NEAR = 0.9  # of the clearance; a flight beyond it clings to the bore, which gives and has play
MAX_CLINGING_TURN = (
    0.6 * TURN
)  # most that such a flight turns: the journal touches along 0.4 of a turn or more
HOPS = TURN * 160.0 / 360.0  # most that a chord spans: a star's 150 degrees, and not the 180 of a bounce
BENDS = 0.25  # of the clearance: gravity bends a hop off its chord by so much, inwards or outwards
MAX_SAMPLE_TURN = (
    TURN / 4.0
)  # between recorded values in contact; a whirl turns by less where it is recorded well
CIRCLE_TOLERANCE = 0.05  # of the clearance: so closely an orbit follows the circle through it
MIN_ORBIT_RADIUS = 0.5  # of the clearance, from the orbit's middle: what lies within is a fall or a bounce
MAX_CIRCLE_RADIUS = 1.5  # of the clearance: the radius of a circle that a bore may give way to
# Of a short chord's distance to the centre: a rebound that lands nearby may come so deep
MAX_CHORD_DEPTH = 0.5


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
    return len(step) >= FEWEST and bool(np.median(step) >= MAX_SAMPLE_TURN)


def about_its_circle(orbit: Orbit) -> Orbit:
    """The orbit about the centre of the circle that its outer part runs on, as about a displaced ring.

    Unchanged where that part is not a circle of about the clearance, or does not go all the way round. How
    far off its centre is does not count: a circle so wide has a ring about it, wherever that stands.
    """
    known = np.isfinite(orbit.radius)
    x, y = orbit.x[known] / orbit.clearance, orbit.y[known] / orbit.clearance
    if len(x) < FEWEST:
        return orbit
    far = np.hypot(x - _middle(x), y - _middle(y)) >= MIN_ORBIT_RADIUS
    x, y = x[far], y[far]
    if len(x) < FEWEST:
        return orbit
    # |r|^2 = 2 r . c + (R^2 - |c|^2), linear in the centre c and in the bracket
    matrix = np.column_stack([2.0 * x, 2.0 * y, np.ones(len(x))])
    cx, cy, rest = np.linalg.lstsq(matrix, x * x + y * y, rcond=None)[0]
    radius = math.sqrt(max(rest + cx * cx + cy * cy, 0.0))
    off = np.abs(np.hypot(x - cx, y - cy) - radius)
    quarters = np.unique(np.floor(np.arctan2(y - cy, x - cx) / (0.25 * TURN)))
    if np.median(off) > CIRCLE_TOLERANCE or len(quarters) < 4 or not TOUCHES <= radius <= MAX_CIRCLE_RADIUS:
        return orbit
    return orbit._replace(x=orbit.x - cx * orbit.clearance, y=orbit.y - cy * orbit.clearance)


def _middle(values: np.ndarray) -> float:
    return 0.5 * float(np.min(values) + np.max(values))


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
    least = np.minimum.reduceat(orbit.radius[: rows[-1]], rows[:-1]) if len(rows) > 1 else np.zeros(0)
    hop = (np.diff(lost[rows]) == 0) & _is_hop(step, least)
    return step, np.where(flies, hop, np.abs(step) < FOLLOWED)


def _is_hop(turn: np.ndarray, least: np.ndarray) -> np.ndarray:
    """Whether flights that turn so far (rad) and come so near to the centre belong to a row of contacts."""
    span = np.abs(turn)
    chord = np.cos(0.5 * span)
    clings = (span <= MAX_CLINGING_TURN) & (least >= NEAR)
    deepest = np.minimum(MAX_CHORD_DEPTH * chord, chord - BENDS)
    return clings | ((span <= HOPS) & (least >= deepest) & (least <= chord + BENDS))


END_TURN = (
    TURN / 8.0
)  # left out of a stretch's either end to time it: there it may set out or swing out slowly
SECTION_TURN = TURN / 100.0  # so little of a turn
REST_PERIODS = 0.5  # of a pendulum's period that it takes for a section: it has come to rest in between


class OneWay(NamedTuple):
    """Turning one way: indices into an angle, and the turn between them (rad, counter-clockwise).

    `timed` are such indices without the stretch's ends, `timed_turn` (rad, no sign) lies between them.
    """

    first: int
    last: int
    turn: float
    timed: tuple[int, int]
    timed_turn: float


def one_ways(angle: np.ndarray, back: float) -> list[OneWay]:
    """Stretches of turning one way, where turning back by less than `back` (rad) is passed over.

    They follow one another from extreme to extreme. Each is at least `back` long.
    """
    ways: list[OneWay] = []
    low = high = begun = best = sign = 0
    rate = np.diff(angle)
    extremes = np.flatnonzero(rate[:-1] * rate[1:] <= 0.0) + 1
    for i in (0, *extremes.tolist(), len(angle) - 1):
        if sign == 0:
            low, high = (i if angle[i] < angle[low] else low), (i if angle[i] > angle[high] else high)
            if angle[high] - angle[low] >= back:
                sign = 1 if high > low else -1
                begun, best = min(low, high), max(low, high)
        elif sign * (angle[i] - angle[best]) > 0.0:
            best = i
        elif sign * (angle[best] - angle[i]) >= back:
            ways.append(one_way(angle, begun, best))
            begun, best, sign = best, i, -sign
    if sign:
        ways.append(one_way(angle, begun, best))
    return ways


def one_way(angle: np.ndarray, begun: int, best: int) -> OneWay:
    """From extreme to extreme; timed from where it left the first for good to where it neared the last."""
    part = angle[begun : best + 1]
    turned = np.abs(part - part[0])
    turn = float(part[-1] - part[0])
    margin = min(END_TURN, 0.25 * abs(turn))
    b = int(np.argmax(turned >= abs(turn) - margin))
    a = int(np.flatnonzero(turned[: b + 1] <= margin)[-1])
    return OneWay(begun, best, turn, (begun + a, begun + b), float(abs(part[b] - part[a])))


def _without_rests(time: np.ndarray, angle: np.ndarray, whole: OneWay, pendulum: float) -> list[OneWay]:
    """The parts of a stretch cut where it rests; pendulum: a pendulum's period (s).

    time: s, of each of `angle` (rad). Rests at the stretch's very ends stay: they add no turn.
    """
    turned = math.copysign(1.0, whole.turn) * (angle[whole.first : whole.last + 1] - angle[whole.first])
    furthest = np.maximum.accumulate(turned)
    levels = np.arange(SECTION_TURN, furthest[-1], SECTION_TURN)
    after = np.searchsorted(furthest, levels)
    rests = np.flatnonzero(
        np.diff(_reached(time[whole.first :], furthest, levels, after)) > REST_PERIODS * pendulum
    )
    begins = [whole.first, *(whole.first + after[rests + 1] - 1).tolist()]
    ends = [*(whole.first + after[rests]).tolist(), whole.last]
    return [one_way(angle, a, b) for a, b in zip(begins, ends, strict=True) if a < b]


def _reached(time: np.ndarray, furthest: np.ndarray, levels: np.ndarray, after: np.ndarray) -> np.ndarray:
    """When each of `levels` was reached (s); `after`: the first index that lies at it or beyond."""
    gone = (levels - furthest[after - 1]) / (furthest[after] - furthest[after - 1])
    return time[after - 1] + gone * (time[after] - time[after - 1])


def turn_period(time: np.ndarray, s: OneWay) -> float:
    """Mean time of a revolution (s); time: s, of each of the angle's values."""
    return float(time[s.timed[1]] - time[s.timed[0]]) * TURN / s.timed_turn


def times(time: np.ndarray, s: OneWay) -> tuple[float, float]:
    """Start and end (s), the ends taken as fast as the rest: beyond them it may have rested anywhere."""
    ends = END_TURN / TURN * turn_period(time, s)
    start = max(float(time[s.first]), float(time[s.timed[0]]) - ends)
    return start, min(float(time[s.last]), float(time[s.timed[1]]) + ends)


MIN_SWING = TURN / 36.0  # from side to side; less is what is left of a pendulum, or play
MAX_SWING = 2.0 * TURN  # of a swing from side to side: a turn to either side
MIN_SWING_RATIO = 0.5  # of a swing's turn: least of the one it turns back into; swings decay
MAX_SWING_RATIO = 1.25  # times the one before it: most of a swing that turns back into none such
END_SHARE = 1.0 / 8.0  # of a swing's turn, at an end at which it turns back, takes of its time
# At least: 0.23 in harmonic motion, 0.125 at constant speed, when something hit it back
MIN_TIME_AT_ENDS = 0.17
MAX_TIME_AT_ENDS = 0.45  # at most; more where it came to rest in between


def to_and_fro(march: March) -> bool:
    """Whether it advances either way while in contact: a loop on one side goes back in flight."""
    advanced = [
        s.turn for s in one_ways(march.angle, MIN_SWING) if march.touched(s.first, s.last) * s.turn > 0.0
    ]
    return any(turn > 0.0 for turn in advanced) and any(turn < 0.0 for turn in advanced)


def _is_swing(time: np.ndarray, angle: np.ndarray, ways: list[OneWay], i: int) -> bool:
    """Whether stretch i of `ways` is one way of a swing: it turns back into a like one, and slowly.

    time: s, of each of `angle` (rad). Where the recording cuts a swing short it need not turn back.
    """
    whole = ways[i]
    before = ways[i - 1] if i > 0 else None
    after = ways[i + 1] if i + 1 < len(ways) else None
    size = abs(whole.turn)
    decays = after is not None and abs(after.turn) >= MIN_SWING_RATIO * size
    came_out = before is not None and size <= MAX_SWING_RATIO * abs(before.turn)
    if size >= MAX_SWING or not (decays or came_out):
        return False
    shares = zip((before, after), _last_parts(time, angle, whole), strict=True)
    return all(other is None or MIN_TIME_AT_ENDS <= share <= MAX_TIME_AT_ENDS for other, share in shares)


def _last_parts(time: np.ndarray, angle: np.ndarray, whole: OneWay) -> tuple[float, float]:
    """Parts of a stretch's time that it spends in the first and the last part of its turn."""
    turned = np.abs(angle[whole.first : whole.last + 1] - angle[whole.first]) / abs(whole.turn)
    within = time[whole.first : whole.last + 1] - time[whole.first]
    left = within[np.flatnonzero(turned <= END_SHARE)[-1]]
    neared = within[np.argmax(turned >= 1.0 - END_SHARE)]
    return float(left / within[-1]), float(1.0 - neared / within[-1])


GRAVITY = 9.81  # m/s2, for the scale of a pendulum's period
MAX_TURN_BACK = TURN / 4.0  # friction and rattle turn a whirl back by less, a swing by more
MAX_FREE_SWING = 0.75 * TURN  # a free swing's one side, half a turn at most, and half as much again
CREEP_SHARE = 0.25  # of the pendulum's frequency


class WhirlDirection(StrEnum):
    """Of a whirl: as the rotor spins, or against it."""

    FORWARD = "forward"
    BACKWARD = "backward"


@dataclass(frozen=True)
class Turning:
    """Contacts that march by MAX_FREE_SWING or more and are no swing; without rest, or they creep."""

    march: March
    stretch: OneWay  # indices into the march
    time: np.ndarray  # s, of the march's rows
    creeps: bool  # so slowly that gravity would have swung it back, were it not carried

    @property
    def whirls(self) -> bool:
        """Whether it is a whirl."""
        return self.turns >= 1.0 and not self.creeps

    @property
    def turns(self) -> float:
        """How many, without a sign."""
        return abs(self.stretch.turn) / TURN

    def direction(self, spin: float) -> WhirlDirection:
        """As the rotor spins (rad/s; 0 as above 0), or against it."""
        along = self.stretch.turn * (-1.0 if spin < 0.0 else 1.0) > 0.0
        return WhirlDirection.FORWARD if along else WhirlDirection.BACKWARD


def most_turns(march: March) -> float:
    """The most that a row of contacts goes one way (turns), swings and rests included; no sign."""
    ways = one_ways(march.angle, MAX_TURN_BACK)
    return max((abs(way.turn) for way in ways), default=float(np.ptp(march.angle))) / TURN


def turnings(orbit: Orbit, march: March) -> Iterator[Turning]:
    """All of a row of contacts, in their order."""
    time = orbit.time[march.rows]
    pendulum = TURN * math.sqrt(orbit.clearance / GRAVITY)
    ways = one_ways(march.angle, MAX_TURN_BACK)
    for i, whole in enumerate(ways):
        if abs(whole.turn) < MAX_FREE_SWING or _is_swing(time, march.angle, ways, i):
            continue
        parts = [
            p for p in _without_rests(time, march.angle, whole, pendulum) if abs(p.turn) >= MAX_FREE_SWING
        ]
        for part in parts:
            yield Turning(march, part, time, CREEP_SHARE * turn_period(time, part) > pendulum)
        if not parts:
            yield Turning(march, whole, time, creeps=True)
