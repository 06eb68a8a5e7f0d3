"""The first impact at each touchdown seat, watched while a scene runs.

A light inner ring rattles between journal and balls: the momentary contact force swings about what the
rotor is decelerated by, and parts from it for some ten microseconds at a time. So an impact is over once
the journal has been free for PARTING_TOLERANCE, and its force is the resultant on the journal averaged over
AVERAGING_TIME, about two periods of that rattle. The momentary peak stands beside it: it is what race and
ring suffer. So do the peaks inside the bearing, as far as it reports them: on the most loaded ball, and at
the side of one.
"""

from __future__ import annotations

from collections.abc import Container, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field

import numpy as np

from ...master.common.errors import TouchdownError
from ...master.components.component import FORCE, POSITION
from ...master.coupling.connections import Attachment
from ...master.coupling.observer import Observer, RunState
from ...master.coupling.simulation import Outcome, opened, simulate
from ...master.coupling.system import System
from ...master.results.summary import seat_name, touchdown_seats
from ...master.scene.scene import Scene
from ...modelkit.ports import PARTING_TOLERANCE

MIN_SPAN = 2e-3  # s


def shortened(scene: Scene) -> Scene:
    """A copy whose magnetic bearings shut down earlier, all by as much, the first MIN_SPAN after the start.

    One that shuts down as early already is not changed. An unbalanced rotor then falls from another
    angle: it is another drop of the same machine.
    """
    with opened(scene, in_process=True) as system:
        times = {
            name: system.value(f"{name}.shutdown_time")
            for name, component in system.components.items()
            if "shutdown_time" in component.variables
        }
    early = min(times.values(), default=0.0) - scene.run.start_time - MIN_SPAN
    if early <= 0.0:
        return scene
    return scene.set({f"{name}.shutdown_time": time - early for name, time in times.items()})


AVERAGING_TIME = 50e-6  # s
ROUNDING = 1e-12  # s
PEAKS = ("contact.peak_force", "contact.peak_indentation")  # of a touchdown bearing, since the start
CONTACT = "force"  # of journal and ring, beside the parts of INNER_PEAKS
INNER_PEAKS = {  # of those bearings that have them, N since the start
    "ball": ("balls.peak_force",),
    "side": ("neighbours.peak_force", "pockets.peak_force"),
}
MIN_PEAK = 1.0  # N; a smaller peak is a graze, whose changes say nothing


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
    inside: Mapping[str, np.ndarray] = field(default_factory=dict)  # N, by part, largest since the start

    def at(self, time: np.ndarray | float) -> np.ndarray:
        """Where the journal is at `time` (s from zero): x and y (m), each as `time` is."""
        return np.array([np.interp(time, self.time, self.x), np.interp(time, self.time, self.y)])

    def first_impact(self) -> tuple[float, float] | None:
        """Its beginning and end (s from zero), the trace's end where it lasts; None: no touch."""
        loaded = np.flatnonzero((self.fx != 0.0) | (self.fy != 0.0))
        if len(loaded) == 0:
            return None
        gaps = np.flatnonzero(np.diff(self.time[loaded]) > _free(self.time[1] - self.time[0]))
        last = loaded[gaps[0]] if len(gaps) else loaded[-1]
        return float(self.time[loaded[0]]), float(self.time[last])

    def peaks(self, end: float) -> Peaks:
        """Largest values up to `end` (s from zero)."""
        part = self.time <= end + AVERAGING_TIME
        time, step = self.time[part], self.time[1] - self.time[0]
        averages = [_averaged(time, step * np.cumsum(f[part])) for f in (self.fx, self.fy)]
        last = self._last(end)
        force = np.max(np.hypot(*averages))
        return Peaks(float(force), float(self.contact[last]), float(self.indentation[last]))

    def momentary_until(self, end: float) -> Mapping[str, float]:
        """Largest momentary forces (N) up to `end` (s from zero): the contact's, and inside by part."""
        last = self._last(end)
        return {part: float(force[last]) for part, force in {CONTACT: self.contact, **self.inside}.items()}

    def _last(self, end: float) -> int:
        """Index of the last macro step up to `end` (s from zero)."""
        return int(np.searchsorted(self.time, end + 0.5 * (self.time[1] - self.time[0]))) - 1


@dataclass(frozen=True)
class Peaks:
    """Peaks of an impact at a seat."""

    force: float  # N, resultant on the journal averaged over AVERAGING_TIME
    contact: float  # N, momentary normal force
    indentation: float  # m, momentary, rotor in ring


def reported_inside(variables: Container[str]) -> Mapping[str, str]:
    """By part of INNER_PEAKS: which of a bearing's variables tells its peak."""
    return {part: name for part, names in INNER_PEAKS.items() for name in names if name in variables}


def forces_text(peaks: Mapping[str, float]) -> str:
    """Momentary peaks (N, by part) in words."""
    titles = {CONTACT: "contact force", "ball": "most loaded ball", "side": "cage or neighbour on a ball"}
    return ", ".join(f"{titles[part]} {force:.5g} N" for part, force in peaks.items())


def _free(step: float) -> float:
    """How long a journal is free once it has parted (s): PARTING_TOLERANCE, and at least one macro step."""
    return max(PARTING_TOLERANCE, 1.5 * step)


def _averaged(time: np.ndarray, impulse: np.ndarray) -> np.ndarray:
    """Mean force over AVERAGING_TIME before each time, or over a macro step where that is longer."""
    span = max(AVERAGING_TIME, time[1] - time[0])
    return (impulse - np.interp(time - span, time, impulse, left=0.0)) / span


@dataclass(frozen=True)
class Stop:
    """When to end a run."""

    after: float  # s from the first contact of any seat, at the latest
    early: bool  # also once the first impact is over at every seat
    every: int = 1  # macro steps between looks


class _Watch(Observer):
    """Keeps the seats' traces while a scene runs, and ends it as `stop` has it."""

    def __init__(self, system: System, seats: Sequence[Attachment], stop: Stop | None) -> None:
        self._stop = stop
        self._time: list[float] = []
        self._rows: list[list[list[float]]] = [[] for _ in seats]
        self._names = [[*map(a.motion, POSITION), *map(a.load, FORCE)] for a in seats]
        bearings = [system.components[a.bearing] for a in seats]
        self._inside = [reported_inside(bearing.variables) for bearing in bearings]
        reported = [(*PEAKS, *names.values()) for names in self._inside]
        self._read = [bearing.reader(names) for bearing, names in zip(bearings, reported, strict=True)]
        self._loaded: list[float | None] = [None] * len(seats)  # s, when last
        self._first: float | None = None  # s, when any

    def stepped(self, state: RunState) -> None:
        time = state.since_zero
        self._time.append(time)
        for i, rows in enumerate(self._rows):
            row = [state.system.signal(name) for name in self._names[i]]
            if row[2] != 0.0 or row[3] != 0.0:
                self._loaded[i] = time
                self._first = time if self._first is None else self._first
            if self._loaded[i] is None:  # all is at rest
                row += [0.0] * (len(PEAKS) + len(self._inside[i]))
            else:
                row += self._read[i]().tolist()
            rows.append(row)
        if self._enough(time):
            state.stop("the first impact is over")

    def _enough(self, time: float) -> bool:
        """Whether the run may end at `time` (s from zero)."""
        stop = self._stop
        if stop is None or self._first is None or len(self._time) % stop.every:
            return False
        free = _free(time - self._time[-2] if len(self._time) > 1 else 0.0)
        parted = all(last is not None and time - last > free for last in self._loaded)
        return time - self._first >= stop.after - ROUNDING or (stop.early and parted)

    def traces(self) -> list[Trace]:
        """Of all seats."""
        time, traces = np.array(self._time), list[Trace]()
        for rows, inside in zip(self._rows, self._inside, strict=True):
            columns = list(np.array(rows).T)  # the last are the peaks of the parts of `inside`
            outer = len(columns) - len(inside)
            peaks = dict(zip(inside, columns[outer:], strict=True))
            traces.append(Trace(time, *columns[:outer], inside=peaks))
        return traces


@dataclass(frozen=True)
class WatchedDrop:
    """A drop whose seats were watched, and its system as the run left it."""

    scene: Scene
    system: System
    seats: Sequence[Attachment]
    outcome: Outcome
    traces: Mapping[str, Trace]  # by seat

    @property
    def end(self) -> float:
        """Its end (s from the scene's zero)."""
        return self.outcome.end - self.outcome.zero

    @property
    def first(self) -> float:
        """The first contact of any seat (s from the scene's zero)."""
        return min(start for start, _ in self.impacts().values())

    def impacts(self) -> Mapping[str, tuple[float, float]]:
        """The first impact (s from zero) at each seat that is touched; TouchdownError where none is."""
        impacts = {seat: impact for seat, t in self.traces.items() if (impact := t.first_impact())}
        if not impacts:
            duration = self.scene.run.duration
            raise TouchdownError(f"nothing touches down within run.duration = {duration:g} s")
        return impacts


@contextmanager
def watched_drop(scene: Scene, stop: Stop | None = None, body: str | None = None) -> Iterator[WatchedDrop]:
    """Run a scene in process to its end, or as `stop` has it, and watch its seats: all, or those of `body`.

    Raises TouchdownError where there is no such seat, or the run stops by itself.
    """
    with opened(scene, in_process=True) as system:
        seats = [a for a in touchdown_seats(system) if body in (None, a.body)]
        if not seats:
            where = "to compare at" if body is None else f"on {body}"
            raise TouchdownError(f"scene {scene.name} has no touchdown bearing {where}")
        watch = _Watch(system, seats, stop)
        outcome = simulate(scene, system, observers=[watch])
        outcome.raise_if_stopped()
        names = [seat_name(a, seats) for a in seats]
        traces = dict(zip(names, watch.traces(), strict=True))
        yield WatchedDrop(scene, system, seats, outcome, traces)
