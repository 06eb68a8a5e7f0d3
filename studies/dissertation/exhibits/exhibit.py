"""A figure or table of the source as the project makes it, and the drops it needs."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from ....master.common.errors import Ended, TouchdownError
from ....master.common.pool import run_all
from ....master.common.progress import SILENT_PROGRESS, Progress
from ....master.coupling.connections import Attachment
from ....master.coupling.steppers.carried import carrying
from ....master.results.final_state import Finished
from ....master.results.result import Result
from ....master.results.run import run_scene
from ....master.results.summary import touchdown_seats
from ....master.scene.scene import Scene
from ..stress_readings import NO_LIMIT, PHASE, SEATS, phases

if TYPE_CHECKING:
    from matplotlib.figure import Figure


Span = tuple[float, float]  # smallest and largest
Value = float | Span | str
AGREES, DIFFERS, UNCOMPARED = "agrees", "differs", "no value to compare"
UNEXPLAINED = "unexplained"


@dataclass(frozen=True)
class Row:
    """One quantity, as the source states it and as it comes out here.

    A number agrees with a number within `near`, and with a span inside it; for words `holds` says it.

    >>> Row("mass [kg]", 3.3, 3.31).verdict
    'agrees'
    >>> Row("mass [kg]", 3.3, 4.0, why="another rotor").verdict
    'differs: another rotor'
    """

    what: str  # with its unit
    source: Value | None  # None: only in the source's picture
    ours: Value | None  # None: it did not happen
    near: float = 0.05  # of the source's value
    holds: bool | None = None  # for what is no number, whether they say the same
    why: str = ""  # what a deviation hinges on, or what the value assumes

    @property
    def deviation(self) -> float | None:
        """Ours over the source's less one; None where they are not both numbers."""
        if not (_number(self.source) and _number(self.ours)) or self.source == 0.0:
            return None
        return float(self.ours) / float(self.source) - 1.0  # pyright: ignore[reportArgumentType]

    @property
    def within(self) -> str:
        """Up to which deviation it agrees, as text; nothing where it is no question of a number."""
        return "" if self.deviation is None else f"{100.0 * self.near:.3g} %"

    @property
    def agrees(self) -> bool | None:
        """Whether they agree; None where there is nothing to compare."""
        if self.source is None:
            return None
        if self.ours is None:
            return False
        if self.holds is not None:
            return self.holds
        if isinstance(self.source, tuple):
            low, high = _ends(self.ours)
            return self.source[0] <= low and high <= self.source[1]
        if self.deviation is not None:
            return abs(self.deviation) <= self.near
        return self.source == self.ours

    @property
    def verdict(self) -> str:
        """Whether they agree, and why not."""
        if self.agrees is None:
            return f"{UNCOMPARED}: {self.why or 'the source has it in its picture alone'}"
        if self.agrees:
            return f"{AGREES}; {self.why}" if self.why else AGREES
        return f"{DIFFERS}: {self.why or UNEXPLAINED}"


class Exhibit(NamedTuple):
    """A figure or table of the source as it comes out here."""

    figure: Figure | None  # None for a table
    rows: Sequence[Row]
    notes: Sequence[str] = ()  # what is assumed
    lines: Sequence[str] = ()  # of a table of its own


def _number(value: Value | None) -> bool:
    return isinstance(value, int | float) and math.isfinite(value)


def _ends(value: Value) -> Span:
    """Of a number or a span; not a number of words."""
    if isinstance(value, tuple):
        return value
    return (math.nan, math.nan) if isinstance(value, str) else (value, value)


def shown(value: Value | None) -> str:
    """A value as text; a dash where there is none."""
    if value is None:
        return "-"
    if isinstance(value, tuple):
        if math.isinf(value[1]):
            return f"above {value[0]:.4g}"
        return " to ".join(f"{end:.4g}" for end in value)
    return value if isinstance(value, str) else f"{value:.4g}"


def percent(deviation: float | None) -> str:
    """A deviation as text; nothing where there is none."""
    return "" if deviation is None else f"{100.0 * deviation:+.1f} %"


PHASES = 6  # of the unbalance, over which verdicts are counted


@dataclass(frozen=True)
class Drops:
    """Runs of scenes, `jobs` at a time in processes of their own; recordings lie in `folder`."""

    folder: Path
    jobs: int = 2
    progress: Progress = SILENT_PROGRESS
    members: int | None = None  # drops behind a median or a count; None: as the page has it
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
    result = run_scene(scene, folder, in_process=True)
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
