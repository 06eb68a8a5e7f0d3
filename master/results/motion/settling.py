"""When a journal has settled: when its motion is what it remains to the end of the recording.

The recording is cut, back from its end, into periods of a pendulum, 2 pi sqrt(clearance / g). In each the
motion has a size, half of how far the journal moves to and fro over the clearance, and a mean contact
force. Swings of two seats beat: so a swing is looked at over BEAT periods, by the largest size and the
mean force. It has settled where one of these holds at the end:

at rest        for LEAST periods all sizes are below REST, and the journal does not whirl
swings on      neither size nor force grows or decays (`trend`), told from the last half of the time in
               contact, LEAST to MOST times BEAT periods
whirls on      the whirl is steady turn by turn

The last two are plateaus: it goes on like that until the rotor has slowed down, or for good. The settling
time is the end of the last period whose size is not within BAND of the clearance, or whose force is not
within FORCES, of their means over the periods that it was told from: known to a period, or to BEAT of them
where it swings on. None where it has not settled.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from touchdown.master.results.motion.trend import LEAST, PART, Trend, together, trend
from touchdown.master.results.whirl.contacts import TURN, Orbit
from touchdown.master.results.whirl.turning import GRAVITY

BEAT = 4  # periods; two modes of a pendulum on two seats are 20 to 40 % apart
MOST = 8  # times BEAT periods
REST = 0.087  # of the clearance: a swing of 5 degrees to either side, half of what makes a pendulum
BAND = 0.1  # of the clearance
FORCES = 0.25  # of the mean force


@dataclass(frozen=True)
class Settling:
    """How a seat ends up."""

    time: float | None  # s from the zero; None: it has not settled
    trend: Trend  # of the motion at the end
    whirls: bool  # at the end
    rests: bool = False

    @property
    def words(self) -> str:
        """For a report."""
        what = "whirls" if self.whirls else "swings"
        if self.time is not None:
            return f"settled at {self.time:.3g} s: {'at rest' if self.rests else f'{what} on steadily'}"
        doing = {
            Trend.GROWING: f"{what}, growing",
            Trend.DECAYING: f"{what}, decaying",
            Trend.STEADY: f"{what} steadily, for too short a time",
            Trend.UNTOLD: f"{what}; whether that grows or decays cannot be told",
        }
        return f"not settled: {doing[self.trend]}"


def period(clearance: float) -> float:
    """Of a pendulum's small swings in a bore (s); clearance: m, on radius."""
    return TURN * math.sqrt(clearance / GRAVITY)


def settling(orbit: Orbit, force: np.ndarray | None, first_contact: float, whirl: Trend | None) -> Settling:
    """How the motion ends up since `first_contact` (s).

    force: size of the contact force (N, rows,), None where unknown. whirl: trend of the whirl that goes on
    at the end, None where none does.
    """
    end, length = float(orbit.time[-1]), period(orbit.clearance)
    count = max(0, int((end - first_contact) / length))
    sizes, forces = _periods(orbit, force, count)
    rests = whirl is None and count >= LEAST and bool(np.all(sizes[-LEAST:] <= REST))
    if whirl is None and not rests:
        sizes, forces = _over_beats(sizes, np.max), _over_beats(forces, np.mean)
        whole = min(MOST, max(LEAST, int(PART * count / BEAT)), count // BEAT)
        told = [trend(values[::-BEAT][:whole][::-1]) for values in (sizes, forces)]
        now, recent = together(told[: 1 if force is None else 2]), whole * BEAT
    else:
        now, recent = whirl or Trend.STEADY, LEAST
    if count < LEAST or now is not Trend.STEADY:
        return Settling(None, now, whirl is not None)
    off = _off(sizes, recent, BAND)
    if not rests and force is not None:
        off |= _off(forces, recent, FORCES * float(np.mean(forces[-recent:])))
    left = np.flatnonzero(off)
    alike = count - 1 - int(left[-1]) if len(left) else count
    if alike < LEAST:
        return Settling(None, now, whirl is not None)
    since = first_contact if alike == count else end - length * alike
    return Settling(since, now, whirl is not None, rests)


def _periods(orbit: Orbit, force: np.ndarray | None, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Sizes (over the clearance) and mean forces (N, 0 where unknown) of the last `count` periods."""
    edges = float(orbit.time[-1]) - period(orbit.clearance) * np.arange(count, -1, -1)
    begins = np.searchsorted(orbit.time, edges)
    begins[-1] = len(orbit.time)
    sizes, forces = np.zeros(count), np.zeros(count)
    for k in range(count):
        rows = slice(begins[k], max(begins[k + 1], begins[k] + 1))
        ways = [float(np.ptp(values[rows])) for values in (orbit.x, orbit.y)]
        sizes[k] = 0.5 * max(ways) / orbit.clearance
        forces[k] = 0.0 if force is None else float(np.mean(np.nan_to_num(force[rows])))
    return sizes, forces


def _over_beats(values: np.ndarray, of: Callable[[np.ndarray], float]) -> np.ndarray:
    """Of each period and those before it, BEAT in all."""
    return np.array([of(values[max(0, k + 1 - BEAT) : k + 1]) for k in range(len(values))])


def _off(values: np.ndarray, recent: int, band: float) -> np.ndarray:
    """Which are farther than `band` from the mean of the last `recent` ones."""
    return np.abs(values - np.mean(values[-recent:])) > band
