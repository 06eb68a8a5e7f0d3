"""The loop: macro steps at t = k H, and observers that are told of each."""

from __future__ import annotations

import math
import threading
import time as clock
from collections.abc import Callable, Generator, Iterable, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Protocol

from touchdown.master.common.ended import Ended
from touchdown.master.common.errors import TouchdownError
from touchdown.master.common.interrupts import interrupts_noted
from touchdown.master.components.component import Component
from touchdown.master.components.library import load_component
from touchdown.master.coupling.assembly import assemble
from touchdown.master.coupling.ledger import Judge, Ledger
from touchdown.master.coupling.observer import EveryBeat, Moment, Observer
from touchdown.master.coupling.recorder import Recorder
from touchdown.master.coupling.retirement import Retirement
from touchdown.master.coupling.steppers import stepper
from touchdown.master.coupling.steppers.stepper import Stepper
from touchdown.master.coupling.system import System
from touchdown.master.scene.scene import Scene


@dataclass(frozen=True)
class Outcome:
    """What the loop reports beside the recording."""

    steps: int = 0
    zero: float = 0.0  # s, the scene's zero on the simulation's clock
    end: float = 0.0  # s, on the simulation's clock
    wall_time: float = 0.0  # s, stepping only
    start_up: float = 0.0  # s, loading, initialising, and compiling what is new in the first step
    residual: float = 0.0  # of the ledger, over its scale
    warned_at: float | None = None  # s from zero, where the ledger passed the warning threshold
    ended: Ended = Ended.COMPLETED
    reason: str = ""  # why, where it did not complete
    coupling: dict[str, float] = field(default_factory=dict[str, float])  # what the scheme says of itself

    def raise_if_interrupted(self) -> None:
        """Raise KeyboardInterrupt where Ctrl-C ended the run."""
        if self.ended is Ended.INTERRUPTED:
            raise KeyboardInterrupt

    def raise_if_stopped(self) -> None:
        """Raise TouchdownError where the run could not go on, KeyboardInterrupt where Ctrl-C ended it."""
        self.raise_if_interrupted()
        if self.ended is Ended.STOPPED:
            raise TouchdownError(self.reason)


def open_system(scene: Scene, in_process: bool = False) -> System:
    """Load the scene's components, as FMUs or in process, and wire them up."""

    def load_one(name: str, fmu: str) -> Component:
        return load_component(name, fmu, scene.folder, in_process)

    return assemble(scene, load_one)


@contextmanager
def opened(scene: Scene, in_process: bool = False) -> Generator[System]:
    """The scene's system, freed at the end."""
    system = open_system(scene, in_process)
    try:
        yield system
    finally:
        system.close()


def simulate(
    scene: Scene,
    system: System,
    record_to: Path | None = None,
    progress: Callable[[float, float], object] = lambda time, residual: None,
    observers: Iterable[Observer] = (),
) -> Outcome:
    """Initialise `system` and run it to the scene's end, or until an observer ends it.

    progress(time from zero in s, ledger residual) is called now and then; `observers` are told of every
    macro step. Whatever ends the run, its recording is complete up to there; where that is not an error
    of an observer's own, the outcome says how it ended, and why.
    """
    began = clock.perf_counter()
    with interrupts_noted() as interrupted:
        zero = system.value(scene.zero) if scene.zero else 0.0
        now = Moment(system, zero, macro_steps(zero + scene.run.duration, scene.run.macro_step))
        system.initialise()
        coupling = stepper(system, scene.run)
        ledger = Ledger(system, energy_scale(scene, system))
        judge = Judge(ledger, scene.run)
        with _recording(scene, now, record_to) as recording:
            told = [ledger, judge, *observers, *recording]
            told.append(Retirement(coupling, told))
            told.append(EveryBeat(lambda now: progress(now.since_zero, ledger.residual)))
            start_up = clock.perf_counter() - began
            wall_time, compiling = _loop(coupling, told, now, interrupted)
    return Outcome(
        steps=now.done,
        zero=zero,
        end=now.time,
        wall_time=wall_time,
        start_up=start_up + compiling,
        residual=ledger.residual,
        warned_at=judge.warned_at,
        ended=now.ended or Ended.COMPLETED,
        reason=now.reason,
        coupling=coupling.figures,
    )


def macro_steps(duration: float, step: float) -> int:
    """How many macro steps of `step` cover `duration` (s)."""
    if step > duration:
        raise TouchdownError(f"run.macro_step = {step:g} s is longer than the run of {duration:g} s")
    return math.ceil(duration / step - 1e-6)


class Values(Protocol):
    """What knows the values of variables."""

    def value(self, name: str) -> float:
        """Value of COMPONENT.VARIABLE."""
        ...


def energy_scale(scene: Scene, system: Values) -> float:
    """Product of the scene's energy_scale variables (J); 0 where it names none."""
    return math.prod(system.value(name) for name in scene.energy_scale) if scene.energy_scale else 0.0


def _loop(
    coupling: Stepper, observers: Sequence[Observer], now: Moment, interrupted: threading.Event
) -> tuple[float, float]:
    """Take macro steps until the end, or until the run is to end.

    Returns the time that stepping took and what the first step took beyond the others' mean (s): kernels
    are compiled in it.
    """
    step = coupling.run.macro_step
    at_beats = [observer.stepped for observer in observers]
    at_steps = [observer.stepped for observer in observers if not observer.at_beats_only]
    began = settled = clock.perf_counter()
    try:
        for number in range(now.steps):
            if interrupted.is_set():
                now.stop(Ended.INTERRUPTED.value, Ended.INTERRUPTED)
                break
            coupling.step(number, number * step, step)
            now.move(number + 1, step)
            for stepped in at_beats if now.beat else at_steps:
                stepped(now)
            if number == 0:
                settled = clock.perf_counter()
            if now.ended is not None:
                break
    except TouchdownError as error:
        now.fail(str(error))
    ended = clock.perf_counter()
    if now.done < 2:
        return ended - began, 0.0
    each = (ended - settled) / (now.done - 1)
    return now.done * each, settled - began - each


class _Recording(Observer):
    """Records every few macro steps, the last one, and what somebody wants kept."""

    def __init__(self, recorder: Recorder, every: int) -> None:
        self._recorder, self._every = recorder, every

    def stepped(self, now: Moment) -> None:
        if now.done % self._every == 0 or now.last or now.kept == now.done or now.ended:
            self._recorder.append(now.since_zero)

    def retired(self, names: Sequence[str]) -> None:
        self._recorder.rest(names)


@contextmanager
def _recording(scene: Scene, now: Moment, path: Path | None) -> Generator[list[Observer]]:
    """The observer that records into a file at `path`, if there is one; the file is closed at the end."""
    if path is None:
        yield []
        return
    recorder = Recorder(path, scene, now.system.components, now.steps + 1)
    try:
        recorder.append(-now.zero)
        yield [_Recording(recorder, scene.run.record_every)]
    finally:
        problem = recorder.close()
        if problem:
            now.fail(problem)
