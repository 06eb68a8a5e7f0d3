"""The loop: macro steps at t = k H, bearings first, then the bodies under the loads handed over."""

from __future__ import annotations

import math
import signal
import threading
import time as clock
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path

from touchdown.master.common.errors import TouchdownError
from touchdown.master.components.component import Component
from touchdown.master.components.library import load
from touchdown.master.coupling.connections import LOAD, SLOPE
from touchdown.master.coupling.ledger import Ledger
from touchdown.master.coupling.recorder import Recorder
from touchdown.master.coupling.steppers import stepper
from touchdown.master.coupling.steppers.stepper import Stepper
from touchdown.master.coupling.system import System, assemble
from touchdown.master.scene.run_spec import RunSpec
from touchdown.master.scene.scene import Scene
from touchdown.master.scene.step_sizes import shorter_step

BEAT = 64  # macro steps between looks at progress, ledger and components that have nothing left to do


@dataclass
class Outcome:
    """What the loop reports beside the recording."""

    steps: int = 0
    zero: float = 0.0  # s, the scene's zero on the simulation's clock
    end: float = 0.0  # s, on the simulation's clock
    wall_time: float = 0.0  # s, stepping only
    start_up: float = 0.0  # s, loading and initialising
    residual: float = 0.0  # of the ledger, over its scale
    warned_at: float | None = None  # s from zero, where the ledger passed the warning threshold
    stopped_because: str = ""
    coupling: dict[str, float] = field(default_factory=dict)  # what the scheme has to say of itself


def open_system(scene: Scene, in_process: bool = False) -> System:
    """Load the scene's components, as FMUs or in process, and wire them up."""

    def load_one(name: str, fmu: str) -> Component:
        return load(name, fmu, scene.folder, in_process)

    return assemble(scene, scene.run.scheme, load_one)


@contextmanager
def opened(scene: Scene, in_process: bool = False) -> Iterator[System]:
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
    progress: Callable[[float, float], None] = lambda time, residual: None,
    watch: Callable[[float, System], None] | None = None,
) -> Outcome:
    """Initialise `system` and run it to the scene's end.

    progress(time from zero in s, ledger residual) is called now and then; watch(time, system) after
    every macro step. A run that cannot go on, or is interrupted, keeps its recording; the reason then
    stands in the outcome's `stopped_because`.
    """
    began = clock.perf_counter()
    outcome = Outcome()
    with interrupts_noted() as interrupted:
        outcome.zero = system.value(scene.zero) if scene.zero else 0.0
        steps = macro_steps(outcome.zero + scene.run.duration, scene.run.macro_step)
        system.initialise()
        coupling = stepper(system, scene.run)
        ledger = Ledger(system, energy_scale(scene, system))
        recorder = None
        if record_to is not None:
            recorder = Recorder(record_to, scene, system.components, steps + 1)
        try:
            if recorder is not None:
                recorder.append(-outcome.zero)
            outcome.start_up = clock.perf_counter() - began
            _loop(scene, system, coupling, steps, ledger, recorder, outcome, progress, watch, interrupted)
        except TouchdownError as error:
            outcome.stopped_because = str(error)
        finally:
            problem = recorder.close() if recorder is not None else ""
        outcome.stopped_because = outcome.stopped_because or problem
    return outcome


_noted: threading.Event | None = None  # while interrupts are noted; they are the process's, not a run's


@contextmanager
def interrupts_noted() -> Iterator[threading.Event]:
    """Note Ctrl-C instead of raising: an exception in the middle of an FMU's call would break the FMU.

    May be nested; what was noted outside is known inside.
    """
    global _noted
    outer = _noted
    if outer is not None or threading.current_thread() is not threading.main_thread():
        yield outer or threading.Event()
        return
    _noted = noted = threading.Event()

    def note(*_: object) -> None:
        if noted.is_set():  # asked a second time: now, whatever it breaks
            raise KeyboardInterrupt
        noted.set()

    before = signal.signal(signal.SIGINT, note)
    try:
        yield noted
    finally:
        signal.signal(signal.SIGINT, before)
        _noted = None


def macro_steps(duration: float, step: float) -> int:
    """How many macro steps of `step` cover `duration` (s)."""
    if step > duration:
        raise TouchdownError(f"run.macro_step = {step:g} s is longer than the run of {duration:g} s")
    return math.ceil(duration / step - 1e-6)


def energy_scale(scene: Scene, system: System) -> float:
    """Product of the scene's energy_scale variables (J); 0 where it names none."""
    return math.prod(system.value(name) for name in scene.energy_scale) if scene.energy_scale else 0.0


def _loop(
    scene: Scene,
    system: System,
    stepper: Stepper,
    steps: int,
    ledger: Ledger,
    recorder: Recorder | None,
    outcome: Outcome,
    progress: Callable[[float, float], None],
    watch: Callable[[float, System], None] | None,
    interrupted: threading.Event,
) -> None:
    step, every = scene.run.macro_step, scene.run.record_every
    limit = scene.run.warn_residual * ledger.scale if ledger.scale > 0.0 else math.inf
    began = clock.perf_counter()
    try:
        for k in range(steps):
            if interrupted.is_set():
                raise TouchdownError("interrupted")
            time = k * step
            stepper.step(k, time, step)
            ledger.update()
            done = k + 1
            outcome.steps = done
            outcome.end = done * step
            noticed = not ledger.total <= limit
            if recorder is not None and (noticed or done % every == 0 or done == steps):
                recorder.append(outcome.end - outcome.zero)
            if noticed:
                limit = _judge(scene, ledger, outcome)
            if watch is not None:
                watch(outcome.end, system)
            if done % BEAT == 0 or done == steps:
                outcome.wall_time = clock.perf_counter() - began
                idle = [name for name in system.order if not _has_work(system.components[name])]
                if idle:
                    system.retire(idle)
                    stepper.follow()
                    ledger.follow(system)
                    if recorder is not None:
                        recorder.rest(idle)
                progress(outcome.end - outcome.zero, ledger.residual)
    finally:
        outcome.wall_time = clock.perf_counter() - began
        outcome.residual = ledger.residual
        outcome.coupling = stepper.figures


def _has_work(component: Component) -> bool:
    """A component that says `active` = 0, and gives no load, gives nothing any more and is not stepped."""
    variable = component.variables.get("active")
    if variable is None or variable.causality != "output" or variable.kind != "Integer":
        return True
    loads = [name for name in component.variables if name.rpartition(".")[2] in LOAD + SLOPE]
    given = [name for name in loads if component.variables[name].causality == "output"]
    return component.read(["active"])[0] != 0 or any(component.read(given))


def _judge(scene: Scene, ledger: Ledger, outcome: Outcome) -> float:
    """Warn, or stop, where the coupling makes or loses too much energy; returns the next limit (J)."""
    run, time = scene.run, outcome.end - outcome.zero
    if ledger.residual <= run.stop_residual:
        outcome.warned_at = time
        return run.stop_residual * ledger.scale
    worst = ledger.worst()
    name = worst.attachment.title if worst else "the system"
    raise TouchdownError(
        f"the energy ledger of {name} is off by {ledger.residual:.2g} of the energy lost by falling at "
        f"t = {time:.6g} s; {_remedy(run, ledger.residual)}"
    )


def _remedy(run: RunSpec, residual: float) -> str:
    if run.scheme.error_order == 0:
        smaller = 0.1 * run.tolerance
        return f"the tolerance of {run.tolerance:g} m is too large, try --set run.tolerance={smaller:g}"
    return (
        f"the macro step of {run.macro_step:g} s is too long for scheme {run.scheme.name}, "
        f"try --macro-step {shorter_step(run, residual):g}"
    )
