"""Drops that exhibits look at: each is run once, however many ask for it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

from touchdown.master.common.ended import Ended
from touchdown.master.common.errors import TouchdownError
from touchdown.master.common.processes.pool import run_all
from touchdown.master.common.progress import UNSEEN, Progress
from touchdown.master.coupling.connections import Attachment
from touchdown.master.coupling.steppers.carried import carrying
from touchdown.master.results.ending import Finished
from touchdown.master.results.result import Result
from touchdown.master.results.run import run_scene
from touchdown.master.results.summary import touchdown_seats
from touchdown.master.scene.scene import Scene
from touchdown.master.studies.dissertation.ensemble import NO_LIMIT, PHASE, SEATS, phases

PHASES = 6  # of the unbalance, over which verdicts are counted


@dataclass(frozen=True)
class Drops:
    """Runs of scenes, `jobs` at a time in processes of their own; recordings lie in `folder`."""

    folder: Path
    jobs: int = 2
    progress: Progress = UNSEEN
    _made: list[Result] = field(default_factory=list[Result])

    def of(self, scenes: Sequence[Scene]) -> list[Result]:
        """The runs of `scenes`, in their order.

        Raises TouchdownError where one stops, and KeyboardInterrupt after Ctrl-C.
        """
        new = [scene for k, scene in enumerate(scenes) if scene not in scenes[:k] and not self._has(scene)]
        self.progress.planned(len(new))
        first = len(self._made)
        tasks = [(scene, self.folder / f"{first + k:03}") for k, scene in enumerate(new)]
        outcomes = run_all(carrying(_run), tasks, self.jobs, self.progress.done) if tasks else []
        if any(outcome.ended is Ended.INTERRUPTED for outcome in outcomes):
            raise KeyboardInterrupt
        for outcome in outcomes:
            if outcome.value is None:
                raise TouchdownError(outcome.reason)
            self._made.append(outcome.value)
        return [next(run for run in self._made if run.scene == scene) for scene in scenes]

    def over_phases(self, scene: Scene, members: int = PHASES) -> list[Result]:
        """The runs of `scene` with its unbalance turned round the circle."""
        return self.of(at_phases(scene, members))

    def _has(self, scene: Scene) -> bool:
        return any(run.scene == scene for run in self._made)


def _run(task: tuple[Scene, Path]) -> Result:
    scene, folder = task
    result = run_scene(scene, folder, in_process=True, pictures=False)
    if result.ended is Ended.INTERRUPTED:
        raise KeyboardInterrupt
    if result.ended is not Ended.COMPLETED:
        raise TouchdownError(f"scene {scene.name} stopped: {result.stopped_because}")
    return result


def at_phases(scene: Scene, members: int = PHASES) -> list[Scene]:
    """`scene` with its unbalance turned round the circle; a violent whirl does not end a drop."""
    return [scene.set({PHASE: angle, **NO_LIMIT}) for angle in phases(members)[PHASE]]


def finished(run: Result) -> Finished:
    """A run as pictures take it."""
    return Finished(run.scene, run.ending, run.recording)


def seats_of(run: Result) -> list[Attachment]:
    """Where its rotor touches down."""
    return touchdown_seats(run.ending)


def figure_of(run: Result, key: str) -> float | None:
    """A number of a run's summary."""
    value = run.summary.get(key)
    return float(value) if isinstance(value, int | float) else None


def whirling(runs: Sequence[Result]) -> int:
    """How many of the runs whirl at either seat."""
    return sum(any(run.summary.get(f"whirl_{seat}_episodes") for seat in SEATS) for run in runs)
