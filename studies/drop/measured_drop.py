"""A measured drop: what fine steps say of it, and runs looked at where they can be compared."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ...master.common.errors import TouchdownError
from ...master.components.component import SENSED
from ...master.coupling.connections import Attachment
from ...master.coupling.observer import Observer, RunState
from ...master.coupling.simulation import opened
from ...master.coupling.system import System
from ...master.results.summary import seat_name, touchdown_seats
from ...master.scene.scene import Scene
from ...master.scene.schemes import DEFAULT
from .impact_watch import CONTACT, MIN_PEAK, ROUNDING, Stop, Trace, reported_inside, watched_drop

FINE_STEP = 1e-6  # s, macro step of what peak forces are measured against
MAX_SPAN = 5e-3  # s after the first contact
FINE_SETTINGS = {"interface.tolerance": 1e-9, "micro_step": 0.0}  # as far as a bearing has them


@dataclass(frozen=True)
class Landing:
    """The drop with fine steps, up to the end of what is compared."""

    first: float  # s from zero, the first contact
    end: float  # s from zero
    zero: float  # s, on the simulation's clock
    seats: Sequence[Attachment]
    impacts: Mapping[str, tuple[float, float]]  # s from zero: the first impact at each seat
    traces: Mapping[str, Trace]
    start: float = 0.0  # s, on the simulation's clock
    duration: float = 0.0  # s, what run.duration ends a run there

    def peaks(self, seat: str) -> Mapping[str, float]:
        """Largest momentary forces of its first impact (N): the contact's, and inside by part."""
        return self.traces[seat].momentary_until(self.impacts[seat][1])

    def force_errors(self, found: Mapping[str, tuple[float, Mapping[str, float]]]) -> Mapping[str, float]:
        """Relative errors of the largest forces, by part, of the worst seat; grazes are left out.

        found: by seat the instant (s from zero) at which they were read, and they (N) by part. Each is
        held against what it was by that instant: a cage goes on rattling when the journal has parted.
        """
        errors: dict[str, float] = {}
        for seat, (time, forces) in found.items():
            for part, exact in self.traces[seat].momentary_until(time).items():
                if exact >= MIN_PEAK:
                    errors[part] = max(errors.get(part, 0.0), abs(forces[part] / exact - 1.0))
        return errors


def fine(scene: Scene, step: float) -> Scene:
    """Small macro steps, and bearings that take steps inside as tight as they can."""
    scene = scene.set({"run.scheme": DEFAULT, "run.macro_step": step})
    with opened(scene, True) as system:
        return scene.set(finest_inside(system))


def finest_inside(system: System) -> dict[str, float]:
    """Settings with which touchdown bearings take adaptive steps inside, as tight as they can."""
    return {
        f"{a.bearing}.{variable}": value
        for a in touchdown_seats(system)
        for variable, value in FINE_SETTINGS.items()
        if variable in system.components[a.bearing].variables
    }


def land(scene: Scene, duration: float | None) -> Landing:
    """Drop it with fine steps, `duration` (s) from the first contact.

    Without one until the first impact is over at every seat, at most MAX_SPAN. Raises TouchdownError where
    there is no touchdown bearing, nothing touches, or the run stops.
    """
    stop = Stop(MAX_SPAN if duration is None else duration, early=duration is None)
    with watched_drop(fine(scene, FINE_STEP), stop) as drop:
        impacts, run = drop.impacts(), drop.outcome
    return Landing(
        drop.first, drop.end, run.zero, drop.seats, impacts, drop.traces, run.start, run.duration
    )


@dataclass(frozen=True)
class Plan:
    """Where runs are looked at."""

    landing: Landing
    every: Mapping[float, int]  # by macro step (s): how many of them lie between instants
    times: np.ndarray  # s from zero: the instants of all macro steps


def plan(landing: Landing, steps: Sequence[float]) -> Plan:
    """Instants from the scene's zero on at multiples of each macro step, as far apart as the longest."""
    span, longest = landing.zero + landing.end - landing.start, max(steps)
    if longest > landing.end - landing.first:
        raise TouchdownError(
            f"--macro-steps: {1e6 * longest:g} us is longer than what is compared, "
            f"{1e6 * (landing.end - landing.first):.4g} us from the first contact; a plain number is in s"
        )
    every = {step: math.ceil(longest / step - 1e-9) for step in steps}
    grids = [step * n * np.arange(1, math.floor(span / (step * n) + 1e-9) + 1) for step, n in every.items()]
    clock = landing.start + np.unique(np.round(np.concatenate(grids), 12))
    return Plan(landing, every, clock[clock > landing.zero] - landing.zero)


class Sampler(Observer):
    """Keeps the journals' motion at instants, and the peak forces at the ends of the first impacts."""

    def __init__(self, system: System, landing: Landing, every: int) -> None:
        self.times: list[float] = []  # s on the simulation's clock
        self.motion: list[list[np.ndarray]] = []
        self.peaks: dict[str, tuple[float, Mapping[str, float]]] = {}  # s from zero, N by part
        self._end = landing.end
        self._every = every
        self._system = system
        self._read = [system.reader([a.motion(v) for v in SENSED]) for a in landing.seats]
        names = {seat_name(a, list(landing.seats)): a.bearing for a in landing.seats}
        self._ends = {seat: (end, names[seat]) for seat, (_, end) in landing.impacts.items()}

    def stepped(self, state: RunState) -> None:
        if state.done % self._every == 0:
            self.times.append(state.time)
            self.motion.append([read().copy() for read in self._read])
        step = (state.time - state.start) / state.done
        last = state.since_zero + step > self._end + ROUNDING  # that is known of the landing
        for seat in [seat for seat, (end, _) in self._ends.items() if last or state.since_zero >= end]:
            _, bearing = self._ends.pop(seat)
            inside = reported_inside(self._system.components[bearing].variables)
            parts = {CONTACT: f"{bearing}.contact.peak_force"}
            parts |= {part: f"{bearing}.{name}" for part, name in inside.items()}
            self.peaks[seat] = state.since_zero, {p: self._system.value(n) for p, n in parts.items()}
