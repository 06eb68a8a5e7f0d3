"""The loop: macro steps at t = k H, and observers that are told of each."""

from __future__ import annotations

import copy
import math
import time as clock
from collections.abc import Callable, Generator, Iterable, Mapping, Sequence
from contextlib import closing, contextmanager, suppress
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import Any

from ..common.errors import Ended, TouchdownError
from ..common.interrupts import Interrupts, interrupts_noted
from ..components.component import Component
from ..components.loading import Stepping, load_component, modes_of
from ..scene.run_spec import RunSpec
from ..scene.scene import Scene
from .assembly import assemble_system
from .bonds.explain import explain_bonds, uncoupled_warning
from .ledger import EnergyBalanceMonitor, Ledger, MountSwing, ResidualMonitor, WhirlStepControl
from .ledger.auditor import with_estimates
from .loop.compiled_loop import CompiledLoop, PythonLoop
from .loop.span import IdleRemover, Values, removed_by_swap, span, steps_in, time_zero
from .loop_gain import LoopGain
from .observer import LOOK_INTERVAL_STEPS, Observer, RunState
from .penetration import Penetration
from .recorder import Recorder
from .snapshot import DAMAGE, Kept, Resumed, Saved
from .steppers import stepper
from .steppers.stepper import Stepper
from .system import System

MAX_MACRO_STEPS = 10**9  # macro steps of a run; days of work


@dataclass(frozen=True)
class Outcome:
    """The loop's result beside the recording."""

    steps: int = 0
    start: float = 0.0  # s, on the simulation's clock, as the next ones
    end: float = 0.0  # s
    zero: float = 0.0  # s, what times count from
    origin: float = 0.0  # s, what the duration counts from
    wall_time: float = 0.0  # s, stepping only
    start_up: float = 0.0  # s, loading, initialising, and compiling what is new in the first step
    residual: float = 0.0  # of the ledger, over its scale
    share: float = 0.0  # of the ledger's residual in turnover, of the worst connection
    worst: str = ""  # that connection
    made: float = 0.0  # J, energy made by the coupling, less what it lost
    turnover: float = 0.0  # J, energy that the motion turned over at all connections
    unaudited: tuple[str, ...] = ()  # connections without an account, each with why
    warned_at: float | None = None  # s from zero, where the ledger passed the warning threshold
    warning: str = ""  # what it said there
    inside: float | None = None  # share of energy made inside the worst bearing; None: none is judged
    worst_inside: str = ""  # that bearing
    in_system: float | None = None  # share of energy made in the system as a whole; None: it is not judged
    divided_in_impacts: int = 0  # macro steps, of rotors hit by two bearings at once
    shorter_steps: Mapping[float, float] = field(default_factory=dict[float, float])  # s each, for how long
    ended: Ended = Ended.COMPLETED
    reason: str = ""  # why, where it did not complete
    exchange: str = ""  # how everything that is exchanged crosses
    uncoupled_warning: str = ""  # what is to be said where the scheme has nothing to act on
    coupling: dict[str, float] = field(default_factory=dict[str, float])  # what the scheme says of itself
    state: Saved | None = field(default=None, repr=False, compare=False)  # to go on from, if one is kept

    @property
    def simulated(self) -> float:
        """How much time it came on (s)."""
        return self.end - self.start

    @property
    def duration(self) -> float:
        """The run.duration (s) that would have ended the run there."""
        return self.end - self.origin

    def after(self, problem: str) -> Outcome:
        """The outcome where that came to light after the run; "": nothing did."""
        if not problem or self.ended in (Ended.INTERRUPTED, Ended.STOPPED):
            return self
        return replace(self, ended=Ended.STOPPED, reason=problem)

    def raise_if_interrupted(self) -> None:
        """Raise KeyboardInterrupt where Ctrl-C, or a signal like it, ended the run."""
        if self.ended is Ended.INTERRUPTED:
            raise KeyboardInterrupt

    def raise_if_stopped(self) -> None:
        """Raise TouchdownError where the run could not go on, KeyboardInterrupt where Ctrl-C ended it."""
        self.raise_if_interrupted()
        if self.ended is Ended.STOPPED:
            raise TouchdownError(self.reason)


def open_system(scene: Scene, in_process: bool = False, listening: bool = True) -> System:
    """Load the scene's components, as FMUs or in process, and wire them up.

    listening: third-party bearings that report no contact tell what is estimated of it.
    """

    def load_one(name: str, fmu: str) -> Component:
        spec = scene.components[name]
        stepping = Stepping(
            in_process, spec.isolate, scene.run.call_timeout, spec.native, modes_of(spec.set)
        )
        return load_component(name, fmu, scene.folder, stepping)

    return assemble_system(scene, load_one, with_estimates if listening else lambda found, _: dict(found))


@contextmanager
def opened(scene: Scene, in_process: bool = False, listening: bool = True) -> Generator[System]:
    """The scene's system as `open_system` gives it, freed at the end."""
    system = open_system(scene, in_process, listening)
    try:
        yield system
    finally:
        system.close()


def simulate(
    scene: Scene,
    system: System,
    record_to: Path | None = None,
    progress: Callable[[float, float], object] = lambda time, share: None,
    observers: Iterable[Observer] = (),
    begin: Callable[[], object] = lambda: None,
    resumed: Resumed | None = None,
) -> Outcome:
    """Initialise `system` and run it to the scene's end, or until an observer ends it.

    progress(how much of run.duration is over in s, residual over turnover) is called now and then, begin()
    when nothing is refused any more; `observers` are told of every macro step. resumed: the end of another
    run, from which this one goes on. The outcome says how it ended, and why.
    """
    began = clock.perf_counter()
    with interrupts_noted() as interrupted:
        times = span(scene.run, time_zero(scene, system), impacts=bool(system.hit_together))
        steps = _macro_steps(times.length, scene.run.macro_step)
        state = RunState(system, times.zero, steps, times.start, time=times.start)
        state.time_limit = scene.run.time_limit or math.inf
        if resumed is not None and resumed.state["run"]["done"] >= steps:
            raise TouchdownError(
                f"the run in {resumed.folder} has come to run.duration = {scene.run.duration:g} s already; "
                "ask for a longer one to go on"
            )
        system.initialise()
        coupling = stepper(system, scene.run)
        with (
            _ledger_of(scene, system, coupling) as ledger,
            _recording(scene, state, record_to, begin, resumed) as recorder,
        ):
            residual, shortening = ResidualMonitor(ledger, scene.run), WhirlStepControl(ledger, coupling)
            balance = EnergyBalanceMonitor(ledger, scene.run, system)
            penetration, swing = Penetration(system), MountSwing(system, scene.run)
            watching = [penetration, swing, LoopGain(system), residual, balance, shortening, *observers]
            if recorder is not None:
                watching.append(_Recording(recorder, scene.run.record_every))
            idle = IdleRemover(coupling, [ledger, *watching])
            watching.append(idle)
            watching.append(
                _Progress(lambda state: progress(state.time - times.origin, ledger.worst_share))
            )
            start_up = clock.perf_counter() - began
            python_loop = PythonLoop(coupling, ledger, shortening)
            holders = _Holders(system, [coupling, ledger, python_loop, *watching], state, scene.run)
            if resumed is not None:
                holders.resume(resumed, idle, recorder)
            keep = partial(holders.keep, recorder) if recorder and not ledger.listens else _keep_nothing
            with closing(CompiledLoop(python_loop, residual, recorder, watching)) as compiled_loop:
                if resumed is not None and not resumed.state["told"]:
                    _tell(watching, state)
                wall_time, compiling = _loop(compiled_loop, watching, state, interrupted, keep)
    if penetration.warning and state.ended is Ended.STOPPED and state.reason != penetration.warning:
        state.reason = f"{penetration.warning}; {state.reason}"
    return replace(
        _outcome(state, ledger, residual, shortening),
        **_alarm_results(residual, balance, penetration, swing),
        origin=times.origin,
        wall_time=wall_time,
        start_up=start_up + compiling,
        divided_in_impacts=python_loop.impacts.divided,
        exchange="; ".join(explain_bonds(coupling)),
        uncoupled_warning=uncoupled_warning(coupling),
        coupling=coupling.figures,
        state=holders.kept,
    )


class _Holders:
    """All who hold some of a run's state."""

    def __init__(self, system: System, holders: Sequence[Kept], state: RunState, run: RunSpec) -> None:
        self.kept: Saved | None = None
        self._system, self._state, self._run = system, state, run
        kinds = [type(holder).__name__ for holder in holders]
        names = [f"{kind} {kinds[:k].count(kind)}" for k, kind in enumerate(kinds)]
        self._holders = dict(zip(names, holders, strict=True))

    def keep(self, recorder: Recorder, told: bool) -> None:
        """Keep the state of now, if all can give theirs; told: observers know of the last macro step."""
        state, system = self._state, self._system
        odd = state.ended is not None and state.done % self._run.record_every and state.kept != state.done
        if not all(component.can_serialise for component in system.components.values()):
            return
        with suppress(TouchdownError):  # the run itself is whole
            kept = {
                "told": told,
                "rows": recorder.rows - bool(odd),  # without one that is of this end alone
                "run": state.save(),
                "retired": sorted(system.retired),
                "signals": system.signals,
                "components": {name: c.to_bytes() for name, c in system.components.items()},
                "holders": {name: holder.save() for name, holder in self._holders.items()},
            }
            self.kept = copy.deepcopy(kept)  # later steps do not change it

    def resume(self, resumed: Resumed, idle: IdleRemover, recorder: Recorder | None) -> None:
        """Go on from there. Raises TouchdownError where that cannot be."""
        saved, system = resumed.state, self._system
        try:
            if saved["retired"]:
                idle.take_out(saved["retired"])
            for name, component in system.components.items():
                component.from_bytes(saved["components"][name], resumed.tuned.get(name, {}))
            system.signals[:] = saved["signals"]
            if recorder is not None:
                recorder.freeze(saved["retired"])
            for name, holder in self._holders.items():
                holder.load(saved["holders"].get(name) or holder.save())
            self._state.load(saved["run"])
            self._state.move(self._state.done, self._run.macro_step)
        except DAMAGE as error:
            raise TouchdownError(
                f"the state in {resumed.folder} is not of this scene ({error!r}); run the scene again"
            ) from None


def _outcome(
    state: RunState, ledger: Ledger, residual: ResidualMonitor, shortening: WhirlStepControl
) -> Outcome:
    """Where the run ended, what the ledger found, and what came of it."""
    worst = ledger.worst()
    return Outcome(
        steps=state.done,
        start=state.start,
        end=state.time,
        zero=state.zero,
        ended=state.ended or Ended.COMPLETED,
        reason=state.reason,
        shorter_steps=shortening.times(state),
        residual=ledger.residual,
        share=ledger.worst_share,
        worst=worst.title if worst else "",
        made=ledger.made,
        turnover=ledger.turnover,
        unaudited=ledger.unaudited,
    )


def _alarm_results(
    residual: ResidualMonitor,
    balance: EnergyBalanceMonitor,
    *others: Penetration | MountSwing,
) -> dict[str, Any]:
    """The results of the alarms, and the bearing with the largest error inside."""
    alarms = (*others, residual, balance)
    times = [alarm.warned_at for alarm in alarms if alarm.warned_at is not None]
    worst = balance.worst
    return {
        "warned_at": min(times, default=None),
        "warning": "; ".join(alarm.warning for alarm in alarms if alarm.warning),
        "inside": worst.share if worst else None,
        "worst_inside": worst.bearing if worst else "",
        "in_system": balance.system_sum.share if balance.system_sum else None,
    }


def _macro_steps(duration: float, step: float) -> int:
    """How many macro steps of `step` cover `duration` (s)."""
    if step > duration:
        raise TouchdownError(f"run.macro_step = {step:g} s is longer than the run of {duration:g} s")
    refuse_endless(duration, step)
    return steps_in(duration, step)


def refuse_endless(duration: float, step: float) -> None:
    """Raise TouchdownError where `duration` takes more than MAX_MACRO_STEPS of `step` (both s)."""
    if duration > MAX_MACRO_STEPS * step:
        raise TouchdownError(
            f"{duration:g} s by macro steps of {step:g} s are more than {MAX_MACRO_STEPS:g} of them; ask "
            "for less time, or for longer steps"
        )


def energy_scale(scene: Scene, system: Values) -> float:
    """Product of the scene's energy_scale variables (J); 0 where it names none, or one went in a swap."""
    if any(removed_by_swap(scene, name, system) for name in scene.energy_scale):
        return 0.0
    return math.prod(system.value(name) for name in scene.energy_scale) if scene.energy_scale else 0.0


def fall_energy(system: System) -> float:
    """Energy that a rotor loses by falling through a bearing's clearance (J); 0 where none declares it."""
    energies = [0.0]
    for a in system.attachments:
        declared = (f"{a.body}.mass", f"{a.body}.gravity", f"{a.bearing}.clearance")
        if a.motion("omega") in system and all(name in system for name in declared):
            energies.append(math.prod(map(system.value, declared)))
    return max(energies)


def _loop(
    loop: CompiledLoop,
    observers: Sequence[Observer],
    state: RunState,
    interrupted: Interrupts,
    keep: Callable[[bool], object],
) -> tuple[float, float]:
    """Take macro steps until the end, or until the run is to end; keep(told) is called there.

    Returns the time that stepping took and what the first step took beyond the others' mean (s): kernels
    are compiled in it.
    """
    began = settled = clock.perf_counter()
    first = state.done + 1
    try:
        while not state.last and state.ended is None:
            late = clock.perf_counter() - began > state.time_limit
            if interrupted.is_set() or late:
                keep(True)
                if late:
                    state.fail(f"it takes longer than run.time_limit = {state.time_limit:g} s")
                else:
                    state.stop(interrupted.reason, Ended.INTERRUPTED)
                break
            loop.take(state)
            if state.last:  # what is done at the end alone is not done before a later one
                keep(False)
            _tell(observers, state)
            if state.ended is not None and not state.last:
                keep(True)
            if state.done == first:
                settled = clock.perf_counter()
    except TouchdownError as error:
        state.fail(str(error))
    ended = clock.perf_counter()
    if state.done <= first:
        return ended - began, 0.0
    each = (ended - settled) / (state.done - first)
    return (state.done - first + 1) * each, settled - began - each


def _tell(observers: Sequence[Observer], state: RunState) -> None:
    """Tell observers of a macro step, those of beats at beats only."""
    for observer in observers:
        if state.beat or not observer.at_beats_only:
            observer.stepped(state)


def _keep_nothing(told: bool) -> None:
    """There is no file for it, or somebody holds more than can be kept."""


@contextmanager
def _ledger_of(scene: Scene, system: System, coupling: Stepper) -> Generator[Ledger]:
    """The ledger of the run, closed at the end."""
    scale = energy_scale(scene, system)
    ledger = Ledger(coupling, scale, scale or fall_energy(system))
    try:
        yield ledger
    finally:
        ledger.close()


class _Recording(Observer):
    """Records every few macro steps, the last one, and what somebody wants kept."""

    def __init__(self, recorder: Recorder, every: int) -> None:
        self._recorder, self._every = recorder, every

    def stepped(self, state: RunState) -> None:
        if state.done % self._every == 0 or state.last or state.kept == state.done or state.ended:
            self._recorder.append(state.since_zero)

    def due(self, state: RunState) -> int:
        """At the end; compiled code records, and what somebody wants kept is told to all."""
        return state.steps

    def retired(self, names: Sequence[str]) -> None:
        self._recorder.freeze(names)


class _Progress(Observer):
    """Tells how far the run is, not more often than there are beats."""

    def __init__(self, tell: Callable[[RunState], object]) -> None:
        self._tell, self._last_look = tell, 0

    def stepped(self, state: RunState) -> None:
        if state.last or state.done >= self._last_look + LOOK_INTERVAL_STEPS:
            self._last_look = state.done
            self._tell(state)

    def due(self, state: RunState) -> int:
        """Whenever macro steps stop for others, or because time has passed."""
        return state.steps


@contextmanager
def _recording(
    scene: Scene,
    state: RunState,
    path: Path | None,
    begin: Callable[[], object],
    resumed: Resumed | None,
) -> Generator[Recorder | None]:
    """The recorder that writes to `path`, if there is one; the file is closed at the end."""
    if path is None:
        yield None
        return
    earlier = None if resumed is None else (resumed.recording, int(resumed.state["rows"]))
    recorder = Recorder(path, scene, state.system, state.steps + 1, begin, earlier)
    try:
        state.flush = recorder.flush
        if earlier is None:
            recorder.append(-(state.zero - state.start))  # the other way round 0 s would have another sign
        yield recorder
    finally:
        problem = recorder.close()
        if problem:
            state.fail(problem)
