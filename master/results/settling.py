"""Whether a motion grows or decays, when it has settled, and how it goes on.

A trend is told from the size of a motion in successive turns or periods (`trend`). A straight line is
fitted by least squares to the sizes. What counts is by how much it rises from the first to the last of
them, over their mean, and how surely: with the interval of Student's t, which is wide where sizes are few
or scatter.

growing, decaying  the line rises, falls by more than TOLERANCE, and the interval leaves out zero
steady             neither, and the interval stays within MAX_INTERVAL of zero
cannot tell        all else: fewer than MIN_SIZES sizes, or so scattered that it may be either

A journal has settled when its motion is what it remains to the end of the recording (`settling`). The
recording is cut, back from its end, into periods of a pendulum, 2 pi sqrt(clearance / g). In each the
motion has a size, half of how far the journal moves to and fro over the clearance, and a mean contact
force. Swings of two seats beat: so a swing is looked at over BEAT_PERIODS periods, by the largest size and
the mean force. It has settled where one of these holds at the end:

at rest        for MIN_SIZES periods all sizes are below REST_AMPLITUDE, and the journal does not whirl
swings on      neither size nor force grows or decays (`trend`), told from the last half of the time in
               contact, MIN_SIZES to MAX_BEATS times BEAT_PERIODS periods
whirls on      the whirl is steady turn by turn

The last two are plateaus: it goes on like that until the rotor has slowed down, or for good. The settling
time is the end of the last period whose size is not within AMPLITUDE_BAND of the clearance, or whose force
or its root mean square is not within FORCE_BAND, of their means over the periods that it was told from:
known to a period, or to BEAT_PERIODS of them where it swings on. The mean alone tells nothing of bounces,
over which it is the weight. None where it has not settled.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from .whirl.contacts import FOLLOWED, GRAVITY, TURN, Orbit, wrapped
from .whirl.verdict import Episode, OrbitVerdict, still, transient

MIN_SIZES = 4  # sizes; through fewer a line says nothing
MAX_TURNS = 40  # turns, the last ones: what comes before them is past
WHIRL_SHARE = 0.5  # of a whirl's turns, the last ones: it takes the first to come up
TOLERANCE = 0.05  # of the mean, over all the sizes
MAX_INTERVAL = 0.25  # of the mean: wider, and it is anybody's guess
CONFIDENCE = 0.95
UNSETTLED = "not settled"
BEFORE_A_WHIRL = "within a swing of the first contact, before a whirl can build up"
EARLY = f"{UNSETTLED}: the run ends {BEFORE_A_WHIRL}"  # of a pendulum's, as `pendulum_period` has it


class Trend(StrEnum):
    """How a motion goes on, as reports word it."""

    GROWING = "growing"
    STEADY = "steady"
    DECAYING = "decaying"
    UNTOLD = "cannot tell"


def relative_change(sizes: np.ndarray) -> tuple[float, float]:
    """By how much a line through `sizes` (n,) rises over all of them, and half the width of its interval.

    Both are over the mean of the sizes; the interval is infinite where there are less than three.
    """
    from scipy.special import stdtrit  # not in the time of every start

    count, mean = len(sizes), float(np.mean(sizes))
    if count < 3 or mean <= 0.0:
        return 0.0, math.inf
    place = np.arange(count) - 0.5 * (count - 1)
    squares = float(np.sum(place**2))
    slope = float(np.sum(place * sizes)) / squares
    left = sizes - mean - slope * place
    error = math.sqrt(float(np.sum(left**2)) / (count - 2) / squares)
    reach = float(stdtrit(count - 2, 0.5 * (1.0 + CONFIDENCE))) * error
    return slope * (count - 1) / mean, reach * (count - 1) / mean


def trend(sizes: np.ndarray) -> Trend:
    """Of sizes (n,), not below zero, in their order."""
    if len(sizes) < MIN_SIZES:
        return Trend.UNTOLD
    if not np.any(sizes):
        return Trend.STEADY
    risen, reach = relative_change(sizes)
    if abs(risen) > max(TOLERANCE, reach):
        return Trend.GROWING if risen > 0.0 else Trend.DECAYING
    return Trend.STEADY if abs(risen) + reach <= MAX_INTERVAL else Trend.UNTOLD


def joint_trend(trends: Sequence[Trend]) -> Trend:
    """Of a motion that is told from several sizes, such as amplitude and force: none may contradict."""
    kinds = set(trends)
    if not kinds or kinds >= {Trend.GROWING, Trend.DECAYING}:
        return Trend.UNTOLD
    for one in (Trend.GROWING, Trend.DECAYING, Trend.UNTOLD):
        if one in kinds:
            return one
    return Trend.STEADY


def _turn_by_turn(
    orbit: Orbit, force: np.ndarray | None, start: float, end: float
) -> tuple[np.ndarray, ...]:
    """Means over each of the last turns of a whirl from `start` to `end` (s): of its radius, of the force.

    The radius is about the orbit's own middle, over the clearance; force: size of the contact force (N,
    rows,), None where unknown. Turns are whole ones, counted back from the end, at most MAX_TURNS and
    WHIRL_SHARE of all. Without a turn where the recording is too coarse to count them.
    """
    part = (orbit.time >= start) & (orbit.time <= end) & np.isfinite(orbit.radius)
    x, y = (
        values[part] - 0.5 * (np.min(values[part], initial=np.inf) + np.max(values[part], initial=-np.inf))
        for values in (orbit.x, orbit.y)
    )
    steps = wrapped(np.diff(np.arctan2(y, x)))
    if len(steps) == 0 or np.max(np.abs(steps)) >= FOLLOWED:
        return ()
    left = np.abs(np.sum(steps) - np.concatenate([[0.0], np.cumsum(steps)])) / TURN
    count = min(MAX_TURNS, max(MIN_SIZES, int(WHIRL_SHARE * left[0])), int(left[0]))
    turn = np.minimum(left.astype(int), count)  # from the end; what lies before is the last, left out
    shown = [np.hypot(x, y) / orbit.clearance] + ([] if force is None else [force[part]])
    rows = np.maximum(np.bincount(turn, minlength=count + 1)[:count], 1)
    sums = (np.bincount(turn, np.nan_to_num(values), count + 1)[:count] for values in shown)
    return tuple((one / rows)[::-1] for one in sums)


BEAT_PERIODS = 4  # periods; two modes of a pendulum on two seats are 20 to 40 % apart
MAX_BEATS = 8  # times BEAT_PERIODS periods
# Of the clearance: a swing of 5 degrees to either side, half of what makes a pendulum
REST_AMPLITUDE = 0.087
AMPLITUDE_BAND = 0.1  # of the clearance
FORCE_BAND = 0.25  # of the mean force


@dataclass(frozen=True)
class Settling:
    """How a seat ends up."""

    time: float | None  # s from the zero; None: it has not settled
    trend: Trend  # of the motion at the end
    whirls: bool  # at the end
    rests: bool = False
    early: bool = False  # ended before it could tell anything

    @property
    def words(self) -> str:
        """For a report."""
        what = "whirls" if self.whirls else "swings"
        if self.time is not None:
            return f"settled at {self.time:.3g} s: {'at rest' if self.rests else f'{what} on steadily'}"
        if self.early:
            return EARLY
        doing = {
            Trend.GROWING: f"{what}, growing",
            Trend.DECAYING: f"{what}, decaying",
            Trend.STEADY: f"{what} steadily, for too short a time",
            Trend.UNTOLD: f"{what}; whether that grows or decays cannot be told",
        }
        return f"{UNSETTLED}: {doing[self.trend]}"


def pendulum_period(clearance: float) -> float:
    """Of a pendulum's small swings in a bore (s); clearance: m, on radius."""
    return TURN * math.sqrt(clearance / GRAVITY)


def settling(orbit: Orbit, force: np.ndarray | None, first_contact: float, whirl: Trend | None) -> Settling:
    """How the motion ends up since `first_contact` (s).

    force: size of the contact force (N, rows,), None where unknown. whirl: trend of the whirl that goes on
    at the end, None where none does.
    """
    end, length = float(orbit.time[-1]), pendulum_period(orbit.clearance)
    count = max(0, int((end - first_contact) / length))
    sizes, forces, squares = _periods(orbit, force, count)
    if whirl is None and count == 0:
        return Settling(None, Trend.UNTOLD, False, early=True)
    rests = whirl is None and count >= MIN_SIZES and bool(np.all(sizes[-MIN_SIZES:] <= REST_AMPLITUDE))
    if whirl is None and not rests:
        sizes, forces = _over_beats(sizes, np.max), _over_beats(forces, np.mean)
        squares = _over_beats(squares, np.mean)
        whole = min(
            MAX_BEATS, max(MIN_SIZES, int(WHIRL_SHARE * count / BEAT_PERIODS)), count // BEAT_PERIODS
        )
        pair = [trend(values[::-BEAT_PERIODS][:whole][::-1]) for values in (sizes, forces)]
        tendency, recent = joint_trend(pair[: 1 if force is None else 2]), whole * BEAT_PERIODS
    else:
        tendency, recent = whirl or Trend.STEADY, MIN_SIZES
    if count < MIN_SIZES or tendency is not Trend.STEADY:
        return Settling(None, tendency, whirl is not None)
    off = _off(sizes, recent, AMPLITUDE_BAND)
    if force is not None:
        for values in (np.sqrt(squares),) if rests else (forces, np.sqrt(squares)):
            off |= _off(values, recent, FORCE_BAND * float(np.mean(values[-recent:])))
    left = np.flatnonzero(off)
    alike = count - 1 - int(left[-1]) if len(left) else count
    if alike < MIN_SIZES:
        return Settling(None, tendency, whirl is not None)
    since = first_contact if alike == count else end - length * alike
    return Settling(since, tendency, whirl is not None, rests)


def _periods(
    orbit: Orbit, force: np.ndarray | None, count: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Of the last `count` periods: sizes (over the clearance), mean forces (N) and mean squares of forces
    (N2), both 0 where unknown."""
    edges = float(orbit.time[-1]) - pendulum_period(orbit.clearance) * np.arange(count, -1, -1)
    begins = np.searchsorted(orbit.time, edges)
    begins[-1] = len(orbit.time)
    sizes, forces, squares = np.zeros((3, count))
    for k in range(count):
        rows = slice(begins[k], max(begins[k + 1], begins[k] + 1))
        ways = [float(np.ptp(values[rows])) for values in (orbit.x, orbit.y)]
        sizes[k] = 0.5 * max(ways) / orbit.clearance
        if force is not None:
            known = np.nan_to_num(force[rows])
            forces[k], squares[k] = np.mean(known), np.mean(known * known)
    return sizes, forces, squares


def _over_beats(values: np.ndarray, statistic: Callable[[np.ndarray], float]) -> np.ndarray:
    """Of each period and those before it, BEAT_PERIODS in all."""
    return np.array([statistic(values[max(0, k + 1 - BEAT_PERIODS) : k + 1]) for k in range(len(values))])


def _off(values: np.ndarray, recent: int, band: float) -> np.ndarray:
    """Which are farther than `band` from the mean of the last `recent` ones."""
    return np.abs(values - np.mean(values[-recent:])) > band


TREND_NAMES = {one: one.value for one in Trend} | {
    Trend.UNTOLD: "whether it grows or decays cannot be told"
}
# Times the run, to be proposed where nothing says for how long; at most
LONGER_FACTOR, MAX_LONGER = 2.0, 4.0
# w^2 r over g of what just keeps to a circle against gravity, w by the time of a turn
LOOP = 2.42
TIME_MARGIN = 1.2  # times the run, at least; of the time that a whirl takes to die out, too


@dataclass(frozen=True)
class Outlook:
    """Of one seat."""

    whirl: OrbitVerdict
    trend: Trend | None  # of the whirl that goes on at the end; None where none does
    settling: Settling | None  # None: it was not touched
    end: float  # s, of the recording
    left: float | None = (
        None  # s, until a whirl that decays has died out, if it goes on decaying as it does
    )

    @property
    def words(self) -> str:
        """The verdict with its time, for a report."""
        episode = self.whirl.decisive
        if episode is None:
            return self.whirl.words
        if not episode.goes_on:
            return transient(episode.verdict, episode.start, episode.end)
        return still(episode.verdict, self.end, TREND_NAMES[self.trend or Trend.UNTOLD])

    @property
    def duration(self) -> float | None:
        """To be proposed for a run (s, to the end it should have): None where it has settled."""
        if self.settling is None or self.settling.time is not None or self.end <= 0.0:
            return None
        needed = LONGER_FACTOR * self.end if self.left is None else TIME_MARGIN * (self.end + self.left)
        needed = min(max(needed, TIME_MARGIN * self.end), MAX_LONGER * self.end)
        unit = 10.0 ** (math.floor(math.log10(needed)) - 1)  # rounded up, to two digits
        return float(f"{math.ceil(needed / unit - 1e-9) * unit:.2g}")


def course(
    orbit: Orbit,
    force: tuple[np.ndarray, np.ndarray] | None,
    whirl: OrbitVerdict,
    first_contact: float | None,
) -> Outlook:
    """Of a seat, from its recorded path, the force on its journal (N, x and y) and its verdict.

    first_contact: s, None where there was none.
    """
    size = None if force is None else np.hypot(*force)
    decisive = whirl.decisive
    tendency, left = (
        (None, None) if decisive is None or not decisive.goes_on else _goes_on(orbit, size, decisive)
    )
    settled = None if first_contact is None else settling(orbit, size, first_contact, tendency)
    return Outlook(whirl, tendency, settled, float(orbit.time[-1]), left)


def _goes_on(orbit: Orbit, force: np.ndarray | None, episode: Episode) -> tuple[Trend, float | None]:
    """How a whirl goes on, and how long it has left (s) where it decays."""
    turns = _turn_by_turn(orbit, force, episode.start, episode.end)
    tendency = joint_trend([trend(sizes) for sizes in turns])
    if tendency is not Trend.DECAYING:
        return tendency, None
    return tendency, _time_left(orbit, turns, episode.frequency)


def _time_left(orbit: Orbit, turns: Sequence[np.ndarray], frequency: float) -> float | None:
    """How long (s) until a decaying whirl of `frequency` (Hz) is too slow to go round against gravity.

    Radius and force decay exponentially, as what is damped does; the faster of them counts. turns: sizes in
    successive turns, the radius over the clearance first.
    """
    rate = max(-_slope(np.log(sizes)) for sizes in turns if np.all(sizes > 0.0))  # 1 a turn
    if rate <= 0.0:  # the sizes fall, but not as what is damped does
        return None
    radius = float(turns[0][-1]) * orbit.clearance
    excess = radius * (TURN * frequency) ** 2 / (LOOP * GRAVITY)
    return max(math.log(max(excess, 1.0)) / rate, 1.0) / frequency


def _slope(values: np.ndarray) -> float:
    """Of a line through values (n,), from one to the next."""
    place = np.arange(len(values)) - 0.5 * (len(values) - 1)
    return float(place @ values / (place @ place))


def proposed(courses: Sequence[Outlook]) -> float | None:
    """How long a run should be (s) so that all its seats settle; None where they have."""
    return max((d for one in courses if (d := one.duration) is not None), default=None)


def settled_at(courses: Sequence[Outlook]) -> float | None:
    """When all have settled (s from the zero); None where one has not."""
    times = [one.settling.time if one.settling else None for one in courses]
    known = [time for time in times if time is not None]
    return max(known) if known and len(known) == len(times) else None
