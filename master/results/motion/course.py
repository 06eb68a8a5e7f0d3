"""What a journal did up to the end of its recording, and how that goes on: no verdict without its time."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from touchdown.master.results.motion.settling import Settling, settling
from touchdown.master.results.motion.trend import TOLERANCE, Trend, change, together, trend, turn_by_turn
from touchdown.master.results.whirl.contacts import Orbit
from touchdown.master.results.whirl.told import over, still
from touchdown.master.results.whirl.verdict import Episode, Whirl

HOW = {one: one.value for one in Trend} | {Trend.UNTOLD: "whether it grows or decays cannot be told"}
LONGER, MOST = 2.0, 4.0  # times the run, to be proposed where nothing says for how long; at most
MARGIN = 1.2  # times the run, at least; of the time that a whirl takes to die out, too


@dataclass(frozen=True)
class Course:
    """Of one seat."""

    whirl: Whirl
    trend: Trend | None  # of the whirl that goes on at the end; None where none does
    settling: Settling | None  # None: it was not touched
    end: float  # s, of the recording
    left: float | None = None  # s, until a whirl that decays has died out, if its force falls as it does

    @property
    def words(self) -> str:
        """The verdict with its time, for a report."""
        episode = self.whirl.decisive
        if episode is None:
            return self.whirl.words
        if not episode.goes_on:
            return over(episode.verdict, episode.start, episode.end)
        return still(episode.verdict, self.end, HOW[self.trend or Trend.UNTOLD])

    @property
    def duration(self) -> float | None:
        """To be proposed for a run (s, to the end it should have): None where it has settled."""
        if self.settling is None or self.settling.time is not None or self.end <= 0.0:
            return None
        wanted = LONGER * self.end if self.left is None else MARGIN * (self.end + self.left)
        return _rounded_up(min(max(wanted, MARGIN * self.end), MOST * self.end))


def course(
    orbit: Orbit, force: tuple[np.ndarray, np.ndarray] | None, whirl: Whirl, first_contact: float | None
) -> Course:
    """Of a seat, from its recorded path, the force on its journal (N, x and y) and its verdict.

    first_contact: s, None where there was none.
    """
    size = None if force is None else np.hypot(*force)
    decisive = whirl.decisive
    now, left = (
        (None, None) if decisive is None or not decisive.goes_on else _goes_on(orbit, size, decisive)
    )
    settled = None if first_contact is None else settling(orbit, size, first_contact, now)
    return Course(whirl, now, settled, float(orbit.time[-1]), left)


def _goes_on(orbit: Orbit, force: np.ndarray | None, episode: Episode) -> tuple[Trend, float | None]:
    """How a whirl goes on, and how long it has left (s) where it decays."""
    turns = turn_by_turn(orbit, force, episode.start, episode.end)
    now = together([trend(sizes) for sizes in turns])
    if now is not Trend.DECAYING:
        return now, None
    fallen = max(-change(sizes)[0] for sizes in turns)
    return now, len(turns[0]) / episode.frequency * (1.0 / max(fallen, TOLERANCE) - 0.5)


def proposed(courses: Sequence[Course]) -> float | None:
    """How long a run should be (s) so that all its seats settle; None where they have."""
    return max((d for one in courses if (d := one.duration) is not None), default=None)


def settled_at(courses: Sequence[Course]) -> float | None:
    """When all have settled (s from the zero); None where one has not."""
    times = [one.settling.time if one.settling else None for one in courses]
    known = [time for time in times if time is not None]
    return max(known) if known and len(known) == len(times) else None


def _rounded_up(seconds: float) -> float:
    """To two digits."""
    unit = 10.0 ** (math.floor(math.log10(seconds)) - 1)
    return float(f"{math.ceil(seconds / unit - 1e-9) * unit:.2g}")
