"""Ends a run once its seats have settled (`run.until = "settled"`), told as its summary tells it."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from pathlib import Path

from ..common.errors import Ended, TouchdownError
from ..coupling.observer import Observer, RunState
from ..coupling.system import System
from ..scene.run_spec import SETTLED
from ..scene.scene import Scene
from .recording import NotRecordedError, Recording
from .settling import settled_at
from .summary import awaited, course_at, touchdown_seats

LOOK_INTERVAL_S = 0.05  # s from one look to the next, at least: a swing or two
LOOK_SHARE = 0.05  # of the time that has passed, so that looks at long recordings stay rare
UNTIL_SETTLED = f'run.until = "{SETTLED}"'


class UntilSettled(Observer):
    """Reads what was recorded so far now and then, and ends the run where all seats have settled.

    It looks after macro steps that hang on nothing but the run, so that it ends where it ended before.
    """

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

    def due(self, now: RunState) -> int:
        """The macro step of the next look."""
        return min(max(self._next, now.done + 1), now.steps)

    def stepped(self, now: RunState) -> None:
        if now.last or now.done < self._next:
            return
        step = (now.time - now.start) / now.done
        self._next = now.done + math.ceil(max(LOOK_INTERVAL_S, LOOK_SHARE * now.since_zero) / step)
        if now.since_zero > LOOK_INTERVAL_S and self._settled(now):
            now.stop("all seats have settled", Ended.AS_WANTED)

    def _settled(self, now: RunState) -> bool:
        now.flush()
        recording = Recording(self._path)
        try:
            courses = {a.bearing: course_at(self._system, a, recording, now.zero) for a in self._seats}
        except NotRecordedError as error:
            raise TouchdownError(f"{UNTIL_SETTLED}: {error}") from None
        finally:
            recording.close()
        known = {bearing: one for bearing, one in courses.items() if one is not None}
        return settled_at(awaited(self._scene, known)) is not None


def unsettled(scene: Scene, summary: Mapping[str, object]) -> Iterator[str]:
    """That a run was to go on until it has settled, and has not."""
    if scene.run.until != SETTLED or not summary["completed"]:
        return
    said = {key: str(value) for key, value in summary.items() if key.startswith("settled")}
    left = [f"{key}: {value}" for key, value in said.items() if value.startswith("not settled")]
    if left:
        yield (
            f"{'; '.join(left)} by the end of run.duration = {scene.run.duration:g} s; figures and "
            "verdicts are of that time, and a longer run.duration may show more"
        )
