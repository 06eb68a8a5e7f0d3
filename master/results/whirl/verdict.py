"""Motion of a journal in its bearing: whirl, pendulum or contact, what drives it, and its verdict in words.

A journal that whirls is pressed to the bore by its own centrifugal force, all the way round. Against the
spin, friction drives it; it would roll at the journal's radius over the clearance times the spin, tens of
times the spin, and mostly slides while the ring turns with it. With the spin it slides. To go round at all,
against gravity, it must be faster than a pendulum: that has a frequency of sqrt(g / clearance) / (2 pi),
29 Hz at 0.3 mm. So what makes a whirl is that the place of contact marches round the bore one way, by a
turn or more, without a rest. How closely the orbit follows the bore meanwhile, and about which point, does
not count: a whirl may hop along chords (`contacts`).

whirl      contacts march one way by a turn or more. Turning back by less than MAX_TURN_BACK does not end
           it, a rest does, and a flight longer than a hop
forward    the whirl turns as the rotor spins; backward against it
goes on    a whirl goes on at the end: the recording ends within STILL_WHIRLING_PERIODS of a period of it,
           which is more than the flight to the next contact takes
pendulum   no whirl, but the contacts swing to and fro by MIN_SWING or more, either way in contact
none       it rests, bounces without swinging, rubs in passing, creeps, or never touches

Where there is no whirl a remark may say more, the first that holds (`_on_turnings`, `_on_circling`):

creeps along the bore   contacts march by a turn or more, at less than CREEP_SHARE of the pendulum's
                        frequency
short of one turn       contacts march one way by less than a turn, but MAX_FREE_SWING or more
partial rub             an orbit circles one way, MIN_WHIRL_TURN or more, and contacts do not march: it
                        touches in places, as an ellipse does, or a circle off the centre
orbits without contact  the same, and never touches

The phase of the contact force tells what drives a whirl, as evidence beside the orbit (`force_phase`). The
bearing presses the journal inwards, and friction turns that force out of the normal. On a journal that
spins, sliding friction points against the spin: it drives a backward whirl and brakes a forward one, which
something else has to keep up, an unbalance for one. Where the journal rolls on the bore, nothing does.

A whirl can be told up to a third of the recording's rate. Thresholds stand with their reasons where they
are defined, here or in `contacts`.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from enum import StrEnum
from typing import Any, NamedTuple

import numpy as np

from ...quantities import Owner, owned
from .contacts import (
    FOLLOWED,
    MAX_TURN_BACK,
    PRESSES,
    TURN,
    March,
    Orbit,
    Turning,
    WhirlDirection,
    about_its_circle,
    marches,
    most_turns,
    one_ways,
    times,
    to_and_fro,
    too_coarse,
    turn_period,
    turnings,
    wrapped,
)


def force_phase(
    orbit: Orbit, force: tuple[np.ndarray, np.ndarray], episode: Episode, spin: float
) -> float | None:
    """Angle (rad) by which the force on the journal leads the inward normal, in the sense of the whirl.

    Above 0 it drives the whirl, below 0 it brakes it; atan of the coefficient of friction, at most, where
    friction is all there is. Forces are summed over the whirl, so that large ones count for more. force:
    all that the bearing presses with (N), friction included, x and y, each (rows,); spin as for
    `classify`. The normal is that of a bore about the orbit's own middle, which may stand off the
    bearing's. None where nothing presses.
    """
    part = (orbit.time >= episode.start) & (orbit.time <= episode.end)
    size = np.hypot(*force)
    part &= np.isfinite(orbit.radius) & np.isfinite(size)
    part[part] = size[part] > PRESSES * np.max(size[part], initial=0.0)
    if not part.any():
        return None
    x, y, fx, fy = orbit.x[part], orbit.y[part], force[0][part], force[1][part]
    x, y = (values - 0.5 * (np.min(values) + np.max(values)) for values in (x, y))
    away = np.maximum(np.hypot(x, y), 1e-300)
    inwards = -float(np.sum((fx * x + fy * y) / away))
    counter_clockwise = float(np.sum((fy * x - fx * y) / away))
    forward = episode.direction is WhirlDirection.FORWARD
    sense = 1.0 if forward == (spin >= 0.0) else -1.0
    return math.atan2(sense * counter_clockwise, inwards)


CONFIDENCE = 0.95


class Share(NamedTuple):
    """A part of all, 0 to 1, and the interval that has it with CONFIDENCE."""

    value: float
    low: float
    high: float


def clopper_pearson(hits: float, count: float) -> Share:
    """The share of `hits` among `count` independent drops, and its exact binomial interval.

    Both may be no whole numbers, where drops weigh differently. `count` must be above 0.
    """
    from scipy.stats import beta  # slow to import, and no run needs it

    tail, misses = 0.5 * (1.0 - CONFIDENCE), count - hits
    low = 0.0 if hits <= 0.0 else float(beta.ppf(tail, hits, misses + 1.0))
    high = 1.0 if misses <= 0.0 else float(beta.ppf(1.0 - tail, hits + 1.0, misses))
    return Share(hits / count, low, high)


AT_THE_END = ", still so at the end"
STILL = "still whirling"
TOO_COARSE = "cannot tell: sampled too coarsely"
STILL_WORDS, OVER_WORDS = re.compile(rf", at \S+ s {STILL}.*"), re.compile(r", \S+ to \S+ s$")


class WhirlKind(StrEnum):
    """Verdicts in three classes."""

    SETTLES = "no whirl"
    TRANSIENT = "transient whirl"
    SUSTAINED = "whirls at the end"


def still(verdict: str, end: float, trend: str) -> str:
    """The words on a whirl that goes on when the run ends (s), and how.

    >>> still("backward whirl", 0.5, "decaying")
    'backward whirl, at 0.5 s still whirling, decaying'
    """
    return f"{verdict}, at {end:.4g} s {STILL}, {trend}"


def transient(verdict: str, start: float, end: float) -> str:
    """The words on a whirl that was over (s) before the run's end.

    >>> transient("backward whirl", 0.134, 0.526)
    'transient backward whirl, 0.134 to 0.526 s'
    """
    return f"transient {verdict}, {start:.3g} to {end:.3g} s"


def verdict_class(words: str) -> str:
    """The common part of verdicts in words that differ in times and turns only.

    >>> verdict_class("backward whirl, at 0.5 s still whirling, decaying")
    'backward whirl, still so at the end'
    >>> verdict_class("transient backward whirl, 0.134 to 0.526 s")
    'transient backward whirl'
    """
    return OVER_WORDS.sub("", STILL_WORDS.sub(AT_THE_END, words)).partition(":")[0]


def short_of_one(turns: float) -> str:
    """Turns below one, two digits behind the point: never told as the whole one of a whirl.

    >>> short_of_one(0.996), short_of_one(0.2498)
    ('0.99', '0.25')
    """
    return f"{min(turns, 0.99):.2f}"


def worst_whirl(summary: Mapping[str, Any]) -> str:
    """The verdict on the seat that whirls most, or still does at the end; "" where none does.

    As `verdict_class` has it: drops compare.
    """
    return max(map(_rank, _verdicts(summary)), default=(False, 0.0, ""))[2]


def how_it_goes_on(summary: Mapping[str, Any]) -> str:
    """How the whirl goes on of the seat at which it does, the one that turns most; "" where none does."""
    going = [(_rank(seat)[1], seat["whirl_trend"]) for seat in _verdicts(summary) if seat["whirl_trend"]]
    return max(going, default=(0.0, ""))[1]


def has_verdict(summary: Mapping[str, Any]) -> bool:
    """Whether one could be given: at any seat, unless what may whirl was recorded too coarsely to tell."""
    found = any(seat["whirl"] is not None for seat in _verdicts(summary))
    return found and not recorded_too_coarsely(summary)


def recorded_too_coarsely(summary: Mapping[str, Any]) -> bool:
    """Whether some seat cannot be told for that, and none is known to whirl."""
    return not worst_whirl(summary) and any(seat["whirl"] == TOO_COARSE for seat in _verdicts(summary))


def kind_of_whirl(words: str) -> WhirlKind:
    """The class of a verdict in words, as `worst_whirl` gives it."""
    if not words:
        return WhirlKind.SETTLES
    return WhirlKind.SUSTAINED if _goes_on(words) else WhirlKind.TRANSIENT


def _verdicts(summary: Mapping[str, Any]) -> list[Mapping[str, Any]]:
    """Of the seats that can whirl."""
    return [seat for seat in owned(summary, Owner.SEAT).values() if "whirl" in seat]


def _rank(seat: Mapping[str, Any]) -> tuple[bool, float, str]:
    if not (turns := seat["whirl_revolutions"]):
        return False, 0.0, ""
    words = verdict_class(seat["whirl"])
    return _goes_on(words), turns, words


def _goes_on(words: str) -> bool:
    """Whether a verdict's class is of a whirl that goes on at the end."""
    return words.endswith(AT_THE_END)


MIN_WHIRL_TURN = 2.0 * TURN  # a bounce or two may chance to circle the centre once
# Of the clearance, least radius of an orbit to remark on; on magnetic bearings it is smaller
MIN_ORBIT_RADIUS = 0.2


def _on_turnings(turnings: Sequence[Turning], spin: float) -> str:
    """On contacts that marched, but not as a whirl does; spin: of the rotor (rad/s, its sign counts)."""
    if any(t.turns >= 1.0 for t in turnings):
        return "creeps along the bore"
    best = max((t for t in turnings if not t.creeps), key=lambda t: t.turns, default=None)
    if best is None:
        return ""
    return f"short of one turn: {short_of_one(best.turns)} turn {best.direction(spin)}"


def _on_circling(orbit: Orbit, marches: Sequence[March]) -> str:
    """On an orbit that circles the bearing's centre, or its own, and presses on the bore in places only."""
    touched = np.zeros(len(orbit.time), dtype=bool)
    for march in marches:
        touched[march.rows] = True
    known = np.isfinite(orbit.radius)
    x, y = (float(np.mean(part, where=known)) if known.any() else 0.0 for part in (orbit.x, orbit.y))
    loops = [*_loops(orbit), *_loops(orbit._replace(x=orbit.x - x, y=orbit.y - y))]
    if not loops:
        return ""
    rubs = any(touched[first : last + 1].any() for first, last in loops)
    return "partial rub" if rubs else "orbits without contact"


def _loops(orbit: Orbit) -> Iterator[tuple[int, int]]:
    """Rows, first and last, of circling one way by MIN_WHIRL_TURN or more outside MIN_ORBIT_RADIUS."""
    angle = orbit.angle
    wide = orbit.radius >= MIN_ORBIT_RADIUS
    joined = wide[:-1] & wide[1:] & (np.abs(wrapped(np.diff(angle))) < FOLLOWED)
    edges = np.flatnonzero(np.diff(np.concatenate([[False], joined, [False]]).astype(int)))
    for first, last in edges.reshape(-1, 2).tolist():
        unwrapped = np.unwrap(angle[first : last + 1])
        for s in one_ways(unwrapped, MAX_TURN_BACK):
            if abs(s.turn) >= MIN_WHIRL_TURN:
                yield first + s.first, first + s.last


STILL_WHIRLING_PERIODS = 0.5  # periods from a whirl's end to the recording's end: it still whirls


class WhirlVerdict(StrEnum):
    """The motion of a journal, as reports word it."""

    NONE = "none"
    PENDULUM = "pendulum"
    FORWARD = "forward whirl"
    BACKWARD = "backward whirl"


WHIRLING = {WhirlDirection.FORWARD: WhirlVerdict.FORWARD, WhirlDirection.BACKWARD: WhirlVerdict.BACKWARD}


@dataclass(frozen=True)
class Episode:
    """An unbroken whirl."""

    direction: WhirlDirection
    start: float  # s
    end: float  # s
    revolutions: float
    frequency: float  # Hz, mean, without a sign
    radius: float  # m, median
    goes_on: bool  # at the end of the recording

    @property
    def verdict(self) -> WhirlVerdict:
        """Forward or backward whirl."""
        return WHIRLING[self.direction]


@dataclass(frozen=True)
class OrbitVerdict:
    """Verdict on an orbit, with all whirls in their order; what else is said does not change it."""

    verdict: WhirlVerdict
    episodes: tuple[Episode, ...] = ()
    remark: str = field(default="", compare=False)
    marched: float = field(default=0.0, compare=False)  # turns, the most that contacts went one way

    @property
    def decisive(self) -> Episode | None:
        """The whirl that goes on at the end, or else the longest (most revolutions); None where none is."""
        return _decisive(self.episodes)

    @property
    def goes_on(self) -> bool:
        """Whether a whirl goes on at the end of the recording."""
        return any(e.goes_on for e in self.episodes)

    @property
    def revolutions(self) -> float:
        """Of the decisive whirl; 0 where there is none."""
        return self.decisive.revolutions if self.decisive else 0.0

    @property
    def radius(self) -> float | None:
        """Of the decisive whirl (m, median), from the bearing's centre, or the circle's (`classify`)."""
        return self.decisive.radius if self.decisive else None

    @property
    def frequency(self) -> float | None:
        """Of the decisive whirl (Hz, mean), without a sign."""
        return self.decisive.frequency if self.decisive else None

    @property
    def start(self) -> float | None:
        """Of the decisive whirl (s)."""
        return self.decisive.start if self.decisive else None

    @property
    def end(self) -> float | None:
        """Of the decisive whirl (s)."""
        return self.decisive.end if self.decisive else None

    @property
    def words(self) -> str:
        """For a report, without times: "no whirl", "pendulum", "forward whirl, still so at the end"..."""
        if self.remark == TOO_COARSE:
            return self.remark
        if self.episodes:
            return f"{self.verdict}{AT_THE_END}" if self.goes_on else f"transient {self.verdict}"
        text = "no whirl" if self.verdict is WhirlVerdict.NONE else self.verdict
        return f"{text}, {self.remark}" if self.remark else text


def classify(
    time: np.ndarray,
    x: np.ndarray,
    y: np.ndarray,
    clearance: float,
    spin: float,
    force: tuple[np.ndarray, np.ndarray] | None = None,
) -> OrbitVerdict:
    """The verdict on a journal at x, y (m) relative to the bearing's centre at `time` (s).

    All arrays have the shape (rows,). clearance: m, on radius; spin: of the rotor, rad/s, of which the
    sign counts (0 as above 0). force: the bearing's force on the journal (N), x and y; None where it was
    not recorded: then contact is told from the orbit, about the circle that it runs on if it does.
    Values that are no numbers are passed over.
    """
    orbit = Orbit(time, x, y, clearance)
    if force is None:  # then contact is told from the orbit, whose centre a displaced ring takes along
        orbit = about_its_circle(orbit)
    rows = marches(orbit, force)
    turned = [t for march in rows for t in turnings(orbit, march)]
    episodes = tuple(_episode(orbit, t, spin) for t in turned if t.whirls)
    marched = max((most_turns(march) for march in rows), default=0.0)
    if decisive := _decisive(episodes):
        return OrbitVerdict(decisive.verdict, episodes, marched=marched)
    if too_coarse(orbit, force):
        return OrbitVerdict(WhirlVerdict.NONE, remark=TOO_COARSE, marched=marched)
    remark = _on_turnings(turned, spin)
    if any(to_and_fro(march) for march in rows):
        return OrbitVerdict(WhirlVerdict.PENDULUM, remark=remark, marched=marched)
    return OrbitVerdict(WhirlVerdict.NONE, remark=remark or _on_circling(orbit, rows), marched=marched)


def _decisive(episodes: tuple[Episode, ...]) -> Episode | None:
    return max(episodes, key=lambda e: (e.goes_on, e.revolutions), default=None)


def _episode(orbit: Orbit, t: Turning, spin: float) -> Episode:
    start, end = times(t.time, t.stretch)
    mean = turn_period(t.time, t.stretch)
    first, last = (int(t.march.rows[i]) for i in t.stretch.timed)
    return Episode(
        direction=t.direction(spin),
        start=start,
        end=end,
        revolutions=t.turns,
        frequency=1.0 / mean,
        radius=float(np.median(orbit.radius[first : last + 1])) * orbit.clearance,
        goes_on=float(orbit.time[-1]) - end <= STILL_WHIRLING_PERIODS * mean,
    )
