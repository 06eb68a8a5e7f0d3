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

from touchdown.master.coupling.connections import Attachment
from touchdown.master.coupling.simulation import Outcome, simulate
from touchdown.master.coupling.system import System
from touchdown.master.results.summary import seat_name
from touchdown.master.scene.scene import Scene

AVERAGE = 50e-6  # s
PARTED = 2e-4  # s
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


class Watch:
    """Keeps the seats' traces while a scene runs, and ends it as `stop` has it."""

    def __init__(self, system: System, seats: Sequence[Attachment], zero: float, stop: Stop | None) -> None:
        self._zero, self._stop = zero, stop
        self._time: list[float] = []
        self._rows: list[list[list[float]]] = [[] for _ in seats]
        self._ends = [_ends(a) for a in seats]
        self._read = [system.components[a.bearing].reader(PEAKS) for a in seats]
        self._loaded: list[float | None] = [None] * len(seats)  # s, when last
        self._first: float | None = None  # s, when any

    def __call__(self, time: float, system: System) -> str | None:
        now = time - self._zero
        self._time.append(now)
        for i, rows in enumerate(self._rows):
            row = [float(system.signals[system.position[end]]) for end in self._ends[i]]
            if row[2] != 0.0 or row[3] != 0.0:  # peaks only grow in contact
                self._loaded[i] = now
                self._first = now if self._first is None else self._first
                row += self._read[i]().tolist()
            else:
                row += rows[-1][4:] if rows else [0.0, 0.0]
            rows.append(row)
        stop = self._stop
        if stop is not None and self._first is not None and len(self._time) % stop.every == 0:
            parted = all(last is not None and now - last > PARTED for last in self._loaded)
            if now - self._first >= stop.after - ROUNDING or (stop.early and parted):
                return "the first impact is over"
        return None

    def traces(self) -> list[Trace]:
        """Of all seats."""
        return [Trace(np.array(self._time), *np.array(rows).T) for rows in self._rows]


def _ends(a: Attachment) -> list[tuple[str, str]]:
    """Where the journal's position and the load on it are exchanged."""
    motion, load = (a.body, a.body_port), (a.bearing, a.bearing_port)
    return [
        (name, f"{port}.{variable}")
        for (name, port), variable in ((motion, "x"), (motion, "y"), (load, "fx"), (load, "fy"))
    ]


def run_watched(
    scene: Scene, system: System, seats: Sequence[Attachment], stop: Stop | None
) -> tuple[Outcome, Mapping[str, Trace]]:
    """Run a scene to its end, or as `stop` has it; raises TouchdownError where it stops by itself."""
    zero = system.value(scene.zero) if scene.zero else 0.0
    watch = Watch(system, seats, zero, stop)
    outcome = simulate(scene, system, watch=watch)
    outcome.raise_if_stopped()
    names = [seat_name(a, list(seats)) for a in seats]
    return outcome, dict(zip(names, watch.traces(), strict=True))
