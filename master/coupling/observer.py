"""Observers of a run: small objects that the loop calls after every macro step."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import ClassVar

from ..common.errors import Ended
from .snapshot import Kept
from .system import System

LOOK_INTERVAL_STEPS = 64  # macro steps between looks at what needs none at every step


@dataclass
class RunState(Kept):
    """Where a run stands. There is one of a run: the loop moves it on, and observers read it."""

    KEPT: ClassVar[tuple[str, ...]] = ("done", "kept")

    system: System
    zero: float  # s, the scene's zero on the simulation's clock
    steps: int  # macro steps of the whole run
    start: float = 0.0  # s, on the simulation's clock
    done: int = 0  # macro steps taken
    time: float = 0.0  # s, on the simulation's clock: the end of the last macro step
    last: bool = False  # whether no macro step is left
    beat: bool = False  # whether it is one of those at which slow looks are taken
    kept: int = 0  # the last macro step that somebody wants recorded
    ended: Ended | None = None  # None: it goes on
    reason: str = ""
    time_limit: float = math.inf  # s of wall time that stepping may take
    flush: Callable[[], object] = lambda: None  # brings all that was recorded to the disk

    @property
    def since_zero(self) -> float:
        """Time from the scene's zero (s)."""
        return self.time - self.zero

    def move(self, done: int, step: float) -> None:
        """On to the end of macro step `done` (from 1), each of `step` (s)."""
        self.done = done
        self.time = self.start + done * step
        self.last = done == self.steps
        self.beat = self.last or done % LOOK_INTERVAL_STEPS == 0

    @property
    def next_beat(self) -> int:
        """The next macro step at which slow looks are taken."""
        return min(self.steps, (self.done // LOOK_INTERVAL_STEPS + 1) * LOOK_INTERVAL_STEPS)

    def keep(self) -> None:
        """Have this moment recorded, at any record_every of the scene."""
        self.kept = self.done

    def stop(self, reason: str, ended: Ended = Ended.AS_WANTED) -> None:
        """End the run here; what is asked first counts. The other observers still see this step."""
        if self.ended is None:
            self.ended, self.reason = ended, reason

    def fail(self, reason: str) -> None:
        """The run cannot go on, unless it has ended badly already."""
        if self.ended in (None, Ended.AS_WANTED):
            self.ended, self.reason = Ended.STOPPED, reason


class Observer(Kept, ABC):
    """Is told of a run. A TouchdownError from it stops the run; anything else goes on to the caller.

    One that must know in a run that goes on what it knew before names its attributes in `KEPT`.
    """

    at_beats_only: ClassVar[bool] = False  # whether it is told now and then, and at the end, only

    @abstractmethod
    def stepped(self, state: RunState) -> None:
        """A macro step was taken; `state.stop(reason)` ends the run here."""

    def due(self, state: RunState) -> int:
        """The next macro step that it must be told of, after `state.done`; earlier ones it may be told of.

        Macro steps that no observer must be told of are taken in compiled code, where that can be.
        """
        return state.next_beat if self.at_beats_only else state.done + 1

    def retired(self, names: Sequence[str]) -> None:
        """These components are stepped no more, and what is exchanged stands elsewhere in the signals."""


class EveryStep(Observer):
    """Calls a function after every macro step."""

    def __init__(self, call: Callable[[RunState], object]) -> None:
        self._call = call

    def stepped(self, state: RunState) -> None:
        self._call(state)


class EveryBeat(EveryStep):
    """Calls a function now and then, and at the end."""

    at_beats_only = True
