"""Run a scene from start to finish, or until it has settled: simulate, record, sum up, draw."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Generator, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

from ..common.errors import Ended, TouchdownError
from ..common.interrupts import interrupts_noted
from ..common.progress import bar_of
from ..common.text import percent
from ..components.compile_ahead import compile_beside, new_models
from ..components.loading import foreign, native_at_hand
from ..coupling.loop.span import zero_of
from ..coupling.observer import Observer, RunState
from ..coupling.simulation import Outcome, open_system, refuse_endless, simulate
from ..coupling.system import System
from ..quantities import Owner, enter, values_of
from ..scene.run_spec import SETTLED, SHUTDOWN, STANDSTILL
from ..scene.scene import Scene
from .clamped_pairs import clamping_warnings
from .final_state import Finished, ReadableSystem, final_state
from .folder import ResultsFolder, claimed, write_final_state
from .heat import heat_warnings
from .least_gaps import closed
from .recording import NotRecordedError, Recording
from .result import RECORDING, Result, Scratch
from .resume import STATE_FILE, Earlier, keep_state
from .settling import settled_at
from .summary import awaited, ball_inertias, course_at, refuse_unknown_seats, summarise, touchdown_seats
from .whirl.evidence import earliest_contact

Draw = Callable[[Finished, Path], list[Path]]  # pictures of a run into a folder; returns the files


def run_scene(
    scene: Scene,
    folder: Path | None,
    in_process: bool = False,
    draw: Draw | None = None,
    progress: bool = False,
    remarks: Sequence[str] = (),
    continue_from: Path | None = None,
) -> Result:
    """Run `scene` and write its results into `folder`; None: a temporary one, gone with the result.

    These are summary.json, scene.json (the scene as it was run), result.h5, and what `draw` asks for.
    remarks: warnings about the scene that were found before. continue_from: the folder of a run of the
    scene, at whose end this one starts; how its components were stepped counts, not `in_process`.

    Raises TouchdownError where the run cannot start. One that stops part-way (also by Ctrl-C) leaves all
    it recorded, and says why in the result.
    """
    refuse_endless(scene.run.duration, scene.run.macro_step)  # before it shows a bar
    earlier = None if continue_from is None else Earlier(continue_from)
    if earlier is not None:
        scene, in_process = earlier.onward(scene), earlier.in_process
    scratch = None
    if folder is None:
        scratch = Scratch()
        folder = scratch.path
    with interrupts_noted() as interrupts, claimed(folder) as results:
        say = partial(print, file=sys.stderr, flush=True) if progress else str
        make_ready([scene], in_process, say, interrupts.is_set)
        system = open_system(scene, in_process)
        try:
            refuse_unknown_seats(scene, system)
            path = folder.absolute() / RECORDING
            resumed = None if earlier is None else earlier.resumed(scene, system, folder)
            watching = _enders(scene, system, path, earlier.done if earlier else 0)
            with _Bar(scene, progress) as show:
                begin = partial(_begin, results, scene, earlier)
                outcome = simulate(scene, system, path, show, watching, begin, resumed)
            state = final_state(system)
            early = outcome.ended is Ended.AS_WANTED  # the run's own observer had seen enough
            if early:
                outcome = replace(outcome, ended=Ended.COMPLETED, reason="")
            outcome = outcome.after(system.close())
            recording = _reopened(folder / RECORDING, scratch, outcome)
            summary, warned = summarise(scene, state, outcome, recording), system.warnings()
            for name, said in warned.items():
                enter(summary, {"warned": said}, Owner.COMPONENT, name)
            warnings = [
                *remarks,
                *system.remarks,
                *_early(summary),
                *_unsettled(scene, summary, early),
                *closed(scene, summary),
                *_fast_balls(state),
                *heat_warnings(Finished(scene, state, recording), touchdown_seats(state)),
                *clamping_warnings(Finished(scene, state, recording), touchdown_seats(state)),
                *(f"component {name}: {said}" for name, said in warned.items()),
            ]
            warnings += _warnings(outcome)
            with _writing(folder, outcome.ended is not Ended.STOPPED):
                drawn: list[Path] = []
                try:
                    write_final_state(folder, state, warnings)
                    if outcome.state is not None:
                        keep_state(folder, outcome.state, in_process, outcome.ended)
                    drawn = _pictures(Finished(scene, state, recording), folder, draw)
                finally:
                    results.finish(summary)
        finally:
            system.close()
    return Result(scene, recording, folder, summary, state, outcome.ended, outcome.reason, warnings, drawn)


def natively(scene: Scene) -> Scene:
    """A copy of which all components of the project's own are FMUs that need no Python."""
    names = [name for name, spec in scene.components.items() if not foreign(spec.fmu)]
    return scene.set({f"{name}.native": True for name in names})


def natively_where_built(scene: Scene) -> Scene:
    """The same where all of its components have native FMUs at hand; else the scene unchanged.

    They leave the same recording, to the bit, and step faster: rotors with bending modes several times.
    """
    specs = scene.components.values()
    if any(foreign(s.fmu) for s in specs):
        return scene
    at_hand = all(s.native or native_at_hand(s.fmu, scene.folder, s.set) for s in specs)
    return natively(scene) if at_hand else scene


def make_ready(
    scenes: Iterable[Scene],
    in_process: bool,
    say: Callable[[str], object] = str,
    stop: Callable[[], bool] = bool,
) -> None:
    """Have compiled what is new of scenes, beside each other; say(what) where that takes a while.

    stop: whether to begin no more of it. Raises TouchdownError for a mistake in the first scene, which is
    not to wait for that.
    """
    first, *others = scenes
    if models := new_models([first, *others], in_process):
        open_system(first, in_process=True).close()
        compile_beside(models, say, stop)


def _begin(results: ResultsFolder, scene: Scene, earlier: Earlier | None) -> None:
    """Remove the results of an earlier run, but not of one that goes on here; then nothing is refused."""
    goes_on = earlier is not None and earlier.folder.resolve() == results.path.resolve()
    with _writing(results.path):
        results.begin(scene.resolved(), (RECORDING, STATE_FILE) if goes_on else ())


@contextmanager
def _writing(folder: Path, matters: bool = True) -> Generator[None]:
    """Raise TouchdownError where results cannot be written, unless it does not matter any more.

    A run that stopped has its reason to tell, which is the same where the disk is full.
    """
    try:
        yield
    except OSError as error:
        if matters:
            raise TouchdownError(
                f"cannot write to {folder}: {error}; choose another folder with -o"
            ) from None


def _reopened(path: Path, owner: object, outcome: Outcome) -> Recording:
    """The recording. Raises TouchdownError where it cannot be read, with what stopped the run if so."""
    try:
        return Recording(path, owner)
    except TouchdownError as error:
        raise TouchdownError(outcome.reason or str(error)) from None


def _early(summary: Mapping[str, Any]) -> list[str]:
    """A warning that a bearing was touched while the rotor was still levitated, which is not a drop."""
    earliest = earliest_contact(summary)
    if earliest is None or earliest >= 0.0:
        return []
    return [
        f"a touchdown bearing was touched {-1e3 * earliest:.3g} ms before the shutdown: the magnetic "
        "bearings do not hold the rotor clear of it; look at its weight, their stiffness and the clearance"
    ]


FAST_BALLS = 0.05  # mean centrifugal force of a ball over the mean load, above which contact angles are off


def _fast_balls(state: ReadableSystem) -> Iterator[str]:
    """A warning of balls without centrifugal force that orbit too fast for their contact angles.

    How far off they are follows from the balance of the most loaded ball, whose force Q at the inner race,
    at the contact angle a, and centrifugal force C the outer race bears: Q (cos a + C/Q), Q sin a.
    """
    for a in touchdown_seats(state):
        share = ball_inertias(state, a).get("ball_centrifugal_share", 0.0)
        if share <= FAST_BALLS:
            continue
        angle = state.value(f"{a.bearing}.balls.contact_angle")
        across, along = math.cos(angle) + share, math.sin(angle)
        yield (
            f"{a.bearing}: after the landing a ball's centrifugal force is on average {percent(share)} of "
            "the load on the most loaded one, and left out here: by the balance of that ball its "
            f"outer race bears about {math.hypot(across, along):.3g} times that load, at "
            f"{math.degrees(math.atan2(along, across)):.3g} deg instead of {math.degrees(angle):.3g} deg. "
            f"Take it along: --set {a.bearing}.balls.centrifugal=1"
        )


def _warnings(outcome: Outcome) -> list[str]:
    """Warnings of a run beside its figures; of one that stopped, only the reason."""
    if outcome.ended is Ended.STOPPED:
        return []
    lines = [outcome.uncoupled_warning] if outcome.uncoupled_warning else []
    lines += [f"not audited: {connection}" for connection in outcome.unaudited]
    if outcome.warning and outcome.ended is Ended.COMPLETED:
        lines.append(outcome.warning)
    return lines


def _pictures(run: Finished, folder: Path, draw: Draw | None) -> list[Path]:
    """On request; none of a run that was broken off before its first step."""
    return [] if draw is None or len(run.recording.time) < 2 else draw(run, folder)


class _Bar:
    """Progress over simulated time, with the run's speed and the ledger's residual over turnover."""

    def __init__(self, scene: Scene, shown: bool) -> None:
        self._bar = bar_of(
            scene.run.duration,
            not shown,
            # tqdm's widget for notebooks stands in for exactly {bar}
            bar_format="{desc} {percentage:3.0f}%|{bar}| {n:.3f} of {total:.3f} s"
            "{postfix}, left {remaining}",
            desc=scene.name,
            mininterval=0.2,
        )

    def __enter__(self) -> Callable[[float, float], None]:
        if self._bar.disable:
            return lambda time, share: None

        self._bar.set_postfix_str("compiling what is new")
        begun: float | None = None  # s, simulated, from which the speed counts

        def show(time: float, share: float) -> None:
            nonlocal begun
            if begun is None or time <= 0.0:  # what is compiled is so in the first steps
                begun = max(time, 0.0)
                self._bar.unpause()
                self._bar.n = self._bar.initial = begun
                return
            speed = self._bar.format_dict["elapsed"] / (time - begun)
            text = f"{speed:.2f} s per simulated s, ledger {share:.1e}"
            self._bar.set_postfix_str(text, refresh=False)
            self._bar.update(min(time, self._bar.total) - self._bar.n)

        return show

    def __exit__(self, *_: object) -> None:
        self._bar.close()


LOOK_INTERVAL_S = 0.05  # s from one look to the next, at least: a swing or two
LOOK_SHARE = 0.05  # of the time that has passed, so that looks at long recordings stay rare
UNTIL_SETTLED = f'run.until = "{SETTLED}"'


STANDSTILL_SPEED = 1.0  # rad/s, below which a rotor stands still


class _UntilStandstill(Observer):
    """Ends the run where all rotors in touchdown bearings stand still."""

    at_beats_only = True

    def __init__(self, system: System) -> None:
        self._spins = sorted({a.motion("omega") for a in touchdown_seats(system)})

    def stepped(self, state: RunState) -> None:
        if all(abs(state.system.value(name)) < STANDSTILL_SPEED for name in self._spins):
            state.stop("the rotor stands still", Ended.AS_WANTED)


def _enders(scene: Scene, system: System, path: Path, done: int) -> list[Observer]:
    """Who ends the run, recorded at `path`, before its time; it goes on after `done` macro steps."""
    if scene.run.until == SETTLED:
        return [_UntilSettled(scene, system, path)]
    if scene.run.until == SHUTDOWN:
        return [_UntilShutdown(scene, system, done)]
    return [_UntilStandstill(system)] if scene.run.until == STANDSTILL else []


class _UntilShutdown(Observer):
    """Ends the run with the last macro step before the scene's zero, for others to go on from."""

    def __init__(self, scene: Scene, system: System, done: int) -> None:
        """Raises TouchdownError where no macro step after those `done` ends before."""
        ahead = zero_of(scene, system) - scene.run.start_time
        self._last = math.floor(ahead / scene.run.macro_step + 1e-6)
        if self._last <= done:
            raise TouchdownError(
                f'run.until = "{SHUTDOWN}": the scene\'s zero is {ahead:g} s after the start, and '
                f"this run begins at {done * scene.run.macro_step:g} s; have it later, such as by the "
                "magnetic bearings' shutdown_time"
            )

    def due(self, state: RunState) -> int:
        """The macro step that ends the run."""
        return max(self._last, state.done + 1)

    def stepped(self, state: RunState) -> None:
        if state.done >= self._last:
            state.stop("the shutdown comes", Ended.AS_WANTED)


class _UntilSettled(Observer):
    """Reads what was recorded so far now and then, and ends the run where all seats have settled.

    It looks after macro steps that depend on nothing but the run: a repeated run ends at the same step.
    """

    KEPT = ("_next",)

    def __init__(self, scene: Scene, system: System, path: Path) -> None:
        """path: of the recording. Raises TouchdownError where no seat could be told to settle."""
        self._scene, self._system, self._path = scene, system, path
        self._seats = touchdown_seats(system)
        self._next = 1
        if not any("clearance" in system.components[a.bearing].variables for a in self._seats):
            raise TouchdownError(
                f"{UNTIL_SETTLED}: no touchdown bearing states its clearance, so that nothing is known to "
                "settle; "
                'take "end"'
            )

    def due(self, state: RunState) -> int:
        """The macro step of the next look."""
        return min(max(self._next, state.done + 1), state.steps)

    def stepped(self, state: RunState) -> None:
        if state.last or state.done < self._next:
            return
        step = (state.time - state.start) / state.done
        self._next = state.done + math.ceil(max(LOOK_INTERVAL_S, LOOK_SHARE * state.since_zero) / step)
        if state.since_zero > LOOK_INTERVAL_S and self._settled(state):
            state.stop("all seats have settled", Ended.AS_WANTED)

    def _settled(self, state: RunState) -> bool:
        state.flush()
        recording = Recording(self._path)
        try:
            courses = {a.bearing: course_at(self._system, a, recording, state.zero) for a in self._seats}
        except NotRecordedError as error:
            raise TouchdownError(f"{UNTIL_SETTLED}: {error}") from None
        finally:
            recording.close()
        known = {bearing: one for bearing, one in courses.items() if one is not None}
        return settled_at(awaited(self._scene, known)) is not None


def _unsettled(scene: Scene, summary: Mapping[str, Any], early: bool) -> Iterator[str]:
    """A warning that a run was to go on until it has settled, or to a standstill, and has not.

    early: it ended before its duration was over, as it was to
    """
    if scene.run.until == STANDSTILL and summary["completed"] and not early:
        yield (
            f"the rotor still turns at the end of run.duration = {scene.run.duration:g} s; a longer one "
            "may show its standstill, also by `touchdown run --from` the run's folder"
        )
    if scene.run.until != SETTLED or not summary["completed"]:
        return
    times, words = (values_of(summary, key) for key in ("settling_time", "settled"))
    left = [f"{name}: {words[name]}" for name, time in times.items() if time is None and words[name]]
    if left:
        yield (
            f"{'; '.join(left)} by the end of run.duration = {scene.run.duration:g} s; figures and "
            "verdicts are of that time, and a longer run.duration may show more"
        )
