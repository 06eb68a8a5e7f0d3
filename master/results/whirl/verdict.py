"""What a journal does in its bearing, told from where it presses on the bore.

A journal that whirls is pressed to the bore by its own centrifugal force, all the way round. Against the
spin, friction drives it; it would roll at the journal's radius over the clearance times the spin, tens of
times the spin, and mostly slides while the ring turns with it. With the spin it slides. To go round at all,
against gravity, it must be faster than a pendulum: that has a frequency of sqrt(g / clearance) / (2 pi),
29 Hz at 0.3 mm. So what makes a whirl is that the place of contact marches round the bore one way, by a
turn or more, without a rest. How closely the orbit follows the bore meanwhile, and about which point, does
not count: a whirl may hop along chords (`contacts`).

whirl      contacts march one way by a turn or more. Turning back by less than BACK does not end it, a
           rest does, and a flight that is no hop
forward    the whirl turns as the rotor spins; backward against it
goes on    a whirl goes on at the end: the recording ends within WAIT of a period of it, which is more than
           the flight to the next contact takes
pendulum   no whirl, but the contacts swing to and fro by SWING or more, either way in contact (`swings`)
none       it rests, bounces without swinging, rubs in passing, creeps, or never touches

Of what is no whirl a remark may say more, the first of these that holds (`remarks`):

creeps along the bore   contacts march by a turn or more, at less than CREEP of the pendulum's frequency
near miss               contacts march one way by less than a turn, but NEARLY or more
partial rub             an orbit circles one way, LOOPS or more, and contacts do not march: it touches in
                        places, as an ellipse does, or a circle off the centre
orbits without contact  the same, and never touches

A whirl can be told up to a third of the recording's rate. Thresholds stand with their reasons where they
are used: what joins contacts in `contacts`, what is a swing in `swings`, a rest in `stretches`, BACK,
NEARLY and CREEP in `turning`, LOOPS in `remarks`.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import StrEnum

import numpy as np

from touchdown.master.results.whirl.contacts import Orbit, about_its_circle, marches, too_coarse
from touchdown.master.results.whirl.remarks import TOO_COARSE, on_circling, on_turnings
from touchdown.master.results.whirl.stretches import period, times
from touchdown.master.results.whirl.swings import to_and_fro
from touchdown.master.results.whirl.told import AT_THE_END
from touchdown.master.results.whirl.turning import Direction, Turning, most_turns, turnings

WAIT = 0.5  # periods from a whirl's end to the recording's end: it still whirls


class Verdict(StrEnum):
    """What a journal does, as reports word it."""

    NONE = "none"
    PENDULUM = "pendulum"
    FORWARD = "forward whirl"
    BACKWARD = "backward whirl"


WHIRLING = {Direction.FORWARD: Verdict.FORWARD, Direction.BACKWARD: Verdict.BACKWARD}


@dataclass(frozen=True)
class Episode:
    """An unbroken whirl."""

    direction: Direction
    start: float  # s
    end: float  # s
    revolutions: float
    frequency: float  # Hz, mean, without a sign
    radius: float  # m, median
    goes_on: bool  # at the end of the recording

    @property
    def verdict(self) -> Verdict:
        """Forward or backward whirl."""
        return WHIRLING[self.direction]


@dataclass(frozen=True)
class Whirl:
    """Verdict on an orbit, with all whirls in their order; what else is said does not change it."""

    verdict: Verdict
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
        """Of the decisive whirl (m, median), from the bearing's centre."""
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
        said = "no whirl" if self.verdict is Verdict.NONE else self.verdict
        return f"{said}, {self.remark}" if self.remark else said


def classify(
    time: np.ndarray,
    x: np.ndarray,
    y: np.ndarray,
    clearance: float,
    spin: float,
    force: tuple[np.ndarray, np.ndarray] | None = None,
) -> Whirl:
    """What the journal does, from its position x, y (m) relative to the bearing's centre at `time` (s).

    All arrays have the shape (rows,). clearance: m, on radius; spin: of the rotor, rad/s, of which the
    sign counts (0 as above 0). force: the bearing's force on the journal (N), x and y; None where it was
    not recorded: then contact is told from the orbit. Values that are no numbers are passed over.
    """
    orbit = Orbit(time, x, y, clearance)
    if force is None:  # then contact is told from the orbit, whose centre a displaced ring takes along
        orbit = about_its_circle(orbit)
    rows = marches(orbit, force)
    turned = [t for march in rows for t in turnings(orbit, march)]
    episodes = tuple(_episode(orbit, t, spin) for t in turned if t.whirls)
    marched = max((most_turns(march) for march in rows), default=0.0)
    if decisive := _decisive(episodes):
        return Whirl(decisive.verdict, episodes, marched=marched)
    if too_coarse(orbit, force):
        return Whirl(Verdict.NONE, remark=TOO_COARSE, marched=marched)
    remark = on_turnings(turned, spin)
    if any(to_and_fro(march) for march in rows):
        return Whirl(Verdict.PENDULUM, remark=remark, marched=marched)
    return Whirl(Verdict.NONE, remark=remark or on_circling(orbit, rows), marched=marched)


def _decisive(episodes: tuple[Episode, ...]) -> Episode | None:
    return max(episodes, key=lambda e: (e.goes_on, e.revolutions), default=None)


def _episode(orbit: Orbit, t: Turning, spin: float) -> Episode:
    start, end = times(t.time, t.stretch)
    mean = period(t.time, t.stretch)
    first, last = (int(t.march.rows[i]) for i in t.stretch.timed)
    return Episode(
        direction=t.direction(spin),
        start=start,
        end=end,
        revolutions=t.turns,
        frequency=1.0 / mean,
        radius=float(np.median(orbit.radius[first : last + 1])) * orbit.clearance,
        goes_on=float(orbit.time[-1]) - end <= WAIT * mean,
    )
