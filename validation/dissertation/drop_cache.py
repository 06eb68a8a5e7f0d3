"""The drops that the dissertation's figures need, each run once."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import TypeVar

from ...master.common.errors import Ended, TouchdownError
from ...master.common.pool import TaskOutcome, run_all
from ...master.common.progress import SILENT_PROGRESS, Progress
from ...master.coupling.connections import Attachment
from ...master.coupling.steppers.carried import carrying
from ...master.quantities import Summary, finite_number, summary_items, values_of
from ...master.results.final_state import Finished
from ...master.results.result import Result
from ...master.results.run import run_scene
from ...master.results.summary import touchdown_seats
from ...master.scene.scene import Scene

SEATS = ("A", "B")
NO_LIMIT = {"run.stop_residual": 1000.0}  # of what is turned over: never, so that every drop counts
PHASES = 6  # of the unbalance, over which verdicts are counted
Task = TypeVar("Task")
Value = TypeVar("Value")


@dataclass(frozen=True)
class Drops:
    """Runs of scenes, `jobs` at a time in processes of their own; recordings lie in `folder`."""

    folder: Path
    jobs: int = 2
    progress: Progress = SILENT_PROGRESS
    members: int | None = None  # drops behind a median or a count; None: as the page has it
    _made: list[Result] = field(default_factory=list[Result])

    def outcomes(self, work: Callable[[Task], Value], tasks: Sequence[Task]) -> list[TaskOutcome[Value]]:
        """How `work` on each of the tasks ended. Raises KeyboardInterrupt after Ctrl-C."""
        self.progress.planned(len(tasks))
        outcomes = run_all(carrying(work), tasks, self.jobs, self.progress.done) if tasks else []
        if any(outcome.ended is Ended.INTERRUPTED for outcome in outcomes):
            raise KeyboardInterrupt
        return outcomes

    def values(self, work: Callable[[Task], Value], tasks: Sequence[Task]) -> list[Value]:
        """What `work` gives of each of the tasks. Raises TouchdownError where one stops."""
        found: list[Value] = []
        for outcome in self.outcomes(work, tasks):
            if outcome.value is None:
                raise TouchdownError(outcome.reason)
            found.append(outcome.value)
        return found

    def of(self, scenes: Sequence[Scene]) -> list[Result]:
        """The runs of `scenes`, in their order. Raises TouchdownError where one stops."""
        known = [run.scene for run in self._made]
        new = [scene for k, scene in enumerate(scenes) if scene not in [*scenes[:k], *known]]
        self._made.extend(
            self.values(_run, [(s, self.folder / f"{k:03}") for k, s in enumerate(new, len(known))])
        )
        return [next(run for run in self._made if run.scene == scene) for scene in scenes]

    def summaries(self, scenes: Sequence[Scene]) -> tuple[list[Summary], list[str]]:
        """Summaries of the runs of `scenes` that complete, and why others stopped; nothing else is kept."""
        ended = self.outcomes(_summary, [(scene, None) for scene in scenes])
        figures = [outcome.value for outcome in ended if outcome.value is not None]
        return figures, [outcome.reason for outcome in ended if outcome.value is None]


def _run(task: tuple[Scene, Path | None]) -> Result:
    scene, folder = task
    result = run_scene(scene, folder, in_process=True)
    if result.ended is Ended.INTERRUPTED:
        raise KeyboardInterrupt
    if result.ended is not Ended.COMPLETED:
        raise TouchdownError(f"scene {scene.name} stopped: {result.stopped_because}")
    return result


def _summary(task: tuple[Scene, Path | None]) -> Summary:
    return _run(task).summary


@contextmanager
def dropping(
    jobs: int, progress: Progress = SILENT_PROGRESS, members: int | None = None
) -> Iterator[Drops]:
    """Drops whose recordings are gone at the end."""
    with tempfile.TemporaryDirectory(prefix="touchdown_") as folder:
        yield Drops(Path(folder), jobs, progress, members)


def at_phases(scene: Scene, members: int = PHASES) -> list[Scene]:
    """`scene` with its unbalance turned round the circle; a violent whirl does not end a drop."""
    angles = [f"{360.0 * i / members:g} deg" for i in range(members)]
    return [scene.set({"rotor.unbalance_angle": angle, **NO_LIMIT}) for angle in angles]


def finished(run: Result) -> Finished:
    """A run as pictures take it."""
    return Finished(run.scene, run.ending, run.recording)


def seats_of(run: Result) -> list[Attachment]:
    """Where its rotor touches down."""
    return touchdown_seats(run.ending)


def numbers(summaries: Sequence[Summary], key: str) -> list[float]:
    """A quantity of the drops that have it, in the unit in which people read it."""
    return [
        item.quantity.factor * value
        for summary in summaries
        for item in summary_items(summary)
        if item.quantity.key == key and (value := finite_number(item.of(summary))) is not None
    ]


def figure_of(run: Result, key: str) -> float | None:
    """A number of a run's summary, in the unit in which people read it."""
    return next(iter(numbers([run.summary], key)), None)


def whirling(runs: Sequence[Result]) -> int:
    """How many of the runs whirl at any seat."""
    return sum(any(values_of(run.summary, "whirl_episodes").values()) for run in runs)
