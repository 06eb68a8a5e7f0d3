"""The first impact at each touchdown seat of a rotor, watched while a scene runs.

A light inner ring rattles between journal and balls: the momentary contact force swings about what the
rotor is decelerated by, and parts from it for some ten microseconds at a time. So an impact is over once
the journal has been free for PARTED, and its force is the resultant on the journal averaged over AVERAGE,
about two periods of that rattle. The momentary peak stands beside it: it is what race and ring suffer.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from touchdown.master.components.contract import FORCE, POSITION
from touchdown.master.coupling.connections import Attachment
from touchdown.master.coupling.observer import Moment, Observer
from touchdown.master.coupling.simulation import Outcome, simulate
from touchdown.master.coupling.system import System
from touchdown.master.results.summary import seat_name
from touchdown.master.scene.scene import Scene
from touchdown.modelkit.ports import PARTED

AVERAGE = 50e-6  # s
ROUNDING = 1e-12  # s
PEAKS = ("contact.peak_force", "contact.peak_indentation")  # of a touchdown bearing, since the start


@dataclass(frozen=True)
class Trace:
    """One seat at the end of every macro step."""

    time: np.ndarray  # s from the scene's zero
    x: np.ndarray  # m, journal
    y: np.ndarray
    fx: np.ndarray  # N, on the journal, mean over the macro step
    fy: np.ndarray
    contact: np.ndarray  # N, largest normal force since the start
    indentation: np.ndarray  # m, rotor in ring, largest since the start

    def first_impact(self) -> tuple[float, float] | None:
        """Its beginning and end (s from zero), the trace's end where it lasts; None: no touch."""
        loaded = np.flatnonzero((self.fx != 0.0) | (self.fy != 0.0))
        if len(loaded) == 0:
            return None
        gaps = np.flatnonzero(np.diff(self.time[loaded]) > PARTED)
        last = loaded[gaps[0]] if len(gaps) else loaded[-1]
        return float(self.time[loaded[0]]), float(self.time[last])

    def peaks(self, end: float) -> Peaks:
        """Largest values up to `end` (s from zero)."""
        part = self.time <= end + AVERAGE
        time, step = self.time[part], self.time[1] - self.time[0]
        averages = [_averaged(time, step * np.cumsum(f[part])) for f in (self.fx, self.fy)]
        at = int(np.searchsorted(self.time, end + 0.5 * step)) - 1
        force = np.max(np.hypot(*averages))
        return Peaks(float(force), float(self.contact[at]), float(self.indentation[at]))


@dataclass(frozen=True)
class Peaks:
    """What an impact did at a seat."""

    force: float  # N, resultant on the journal averaged over AVERAGE
    contact: float  # N, momentary normal force
    indentation: float  # m, momentary, rotor in ring


def _averaged(time: np.ndarray, impulse: np.ndarray) -> np.ndarray:
    """Mean force over AVERAGE before each time, or over a macro step where that is longer."""
    span = max(AVERAGE, time[1] - time[0])
    return (impulse - np.interp(time - span, time, impulse, left=0.0)) / span


@dataclass(frozen=True)
class Stop:
    """When to end a run."""

    after: float  # s from the first contact of any seat, at the latest
    early: bool  # also once the first impact is over at every seat
    every: int = 1  # macro steps between looks


class Watch(Observer):
    """Keeps the seats' traces while a scene runs, and ends it as `stop` has it."""

    def __init__(self, system: System, seats: Sequence[Attachment], stop: Stop | None) -> None:
        self._stop = stop
        self._time: list[float] = []
        self._rows: list[list[list[float]]] = [[] for _ in seats]
        self._names = [[*map(a.motion, POSITION), *map(a.load, FORCE)] for a in seats]
        self._read = [system.components[a.bearing].reader(PEAKS) for a in seats]
        self._loaded: list[float | None] = [None] * len(seats)  # s, when last
        self._first: float | None = None  # s, when any

    def stepped(self, now: Moment) -> None:
        time = now.since_zero
        self._time.append(time)
        for i, rows in enumerate(self._rows):
            row = [now.system.signal(name) for name in self._names[i]]
            if row[2] != 0.0 or row[3] != 0.0:  # peaks only grow in contact
                self._loaded[i] = time
                self._first = time if self._first is None else self._first
                row += self._read[i]().tolist()
            else:
                row += rows[-1][4:] if rows else [0.0, 0.0]
            rows.append(row)
        if self._enough(time):
            now.stop("the first impact is over")

    def _enough(self, time: float) -> bool:
        """Whether the run may end at `time` (s from zero)."""
        stop = self._stop
        if stop is None or self._first is None or len(self._time) % stop.every:
            return False
        parted = all(last is not None and time - last > PARTED for last in self._loaded)
        return time - self._first >= stop.after - ROUNDING or (stop.early and parted)

    def traces(self) -> list[Trace]:
        """Of all seats."""
        return [Trace(np.array(self._time), *np.array(rows).T) for rows in self._rows]


def run_watched(
    scene: Scene, system: System, seats: Sequence[Attachment], stop: Stop | None
) -> tuple[Outcome, Mapping[str, Trace]]:
    """Run a scene to its end, or as `stop` has it; raises TouchdownError where it stops by itself."""
    watch = Watch(system, seats, stop)
    outcome = simulate(scene, system, observers=[watch])
    outcome.raise_if_stopped()
    names = [seat_name(a, list(seats)) for a in seats]
    return outcome, dict(zip(names, watch.traces(), strict=True))
