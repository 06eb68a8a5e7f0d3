"""Many macro steps in compiled code, up to the next one that somebody in Python must see.

Where a component cannot be stepped by its address, a scheme has a sequence of its own, a bearing is
listened to by a second instance, or an observer looks at every step, macro steps are taken one by one.
What comes out is the same to the last bit.
"""

from __future__ import annotations

import time as clock
from collections.abc import Mapping, Sequence
from typing import Any, cast

import numpy as np

from touchdown.master.components.component import Call
from touchdown.master.coupling.ledger import Judge
from touchdown.master.coupling.loop.helpers import Helpers, helpers
from touchdown.master.coupling.loop.kernels.stretch import run, run_beside
from touchdown.master.coupling.loop.kernels.tables import FETCH, GET, PLAN, SET, STEP
from touchdown.master.coupling.loop.steps import MacroSteps
from touchdown.master.coupling.loop.tables import Tables, tables
from touchdown.master.coupling.observer import BEAT, Moment, Observer
from touchdown.master.coupling.recorder import Recorder
from touchdown.master.coupling.steppers.gauss_seidel import GaussSeidel
from touchdown.master.coupling.steppers.jacobi import Jacobi

AT_ONCE: Mapping[object, bool] = {GaussSeidel.step: False, Jacobi.step: True}
"""Sequences that compiled code knows: whether all components take their inputs before any steps."""
CALLS = {SET: Call.SET, STEP: Call.STEP, GET: Call.GET, FETCH: Call.FETCH}
NO_ROWS = np.zeros((0, 0))
PATIENCE = 0.1  # s of wall time that a stretch may take: so long Ctrl-C and the progress bar wait
MOST = BEAT  # macro steps of a stretch: a contact may make the next ones a hundred times slower


class Stretches:
    """Takes macro steps of a run, as many at once as nobody needs to see."""

    def __init__(
        self, steps: MacroSteps, judge: Judge, recorder: Recorder | None, observers: Sequence[Observer]
    ) -> None:
        self._steps, self._judge, self._recorder = steps, judge, recorder
        self._observers = observers
        self._every = steps.coupling.run.record_every if recorder is not None else 0
        self._at_once = AT_ONCE.get(type(steps.coupling).step)
        seen = any(type(o).due is Observer.due and not o.at_beats_only for o in observers)
        self._able = self._at_once is not None and not seen and not steps.ledger.listens
        self._signals: np.ndarray | None = None  # those that the tables are of
        self._tables: Tables | None = None
        self._helpers: Helpers | None = None
        self._plan = np.zeros(1, PLAN)
        self._longest = 1  # macro steps that a stretch may take

    def take(self, now: Moment) -> None:
        """Take macro steps, and move on to their end. Raises TouchdownError where they cannot be taken."""
        found = self._found() if self._able and now.done > 0 else None
        if found is None:
            self._steps.take(now)
            if self._able and now.done == 1:
                self._get_ready(now)
            return
        began, done = clock.perf_counter(), now.done
        self._stretch(found, now)
        took = clock.perf_counter() - began
        if took > 0.5 * PATIENCE:
            self._longest = max(1, self._longest // 2)
        elif now.done - done == self._longest:
            self._longest = min(2 * self._longest, MOST)

    def close(self) -> None:
        """Send the helpers away."""
        if self._helpers is not None:
            self._helpers.close()
            self._helpers = None

    def _get_ready(self, now: Moment) -> None:
        """Compile what stretches need with all that the first macro step compiles: by one of no length."""
        found = self._found()
        if found is not None:
            self._planned(now, now.done)
            self._run(found, NO_ROWS)

    def _found(self) -> Tables | None:
        """Tables of the system as it is laid out now."""
        coupling = cast(GaussSeidel, self._steps.coupling)
        if self._signals is not coupling.system.signals:
            self.close()
            self._signals = coupling.system.signals
            self._tables = tables(coupling, bool(self._at_once), self._recorder)
            self._steps.impacts.follow()
            self._helpers = None if self._tables is None else helpers(self._tables.turns)
        return self._tables

    def _stretch(self, found: Tables, now: Moment) -> None:
        steps, recorder = self._steps, self._recorder
        steps.coupling.expect(steps.length / steps.parts)
        rows = NO_ROWS if recorder is None else recorder.room
        plan = self._planned(now, self._ends(now, len(rows)))
        failed = self._run(found, rows)
        steps.booked = int(plan["booked"])
        steps.impacts.divided += int(plan["hit"])
        now.move(int(plan["done"]), steps.length)
        if recorder is not None and plan["row"]:
            recorder.took(int(plan["row"]))
        if failed:
            self._refuse(found, plan)

    def _run(self, found: Tables, rows: np.ndarray) -> bool:
        steps, f = self._steps, found
        seats, books = steps.impacts.seats, steps.ledger.books
        given = self._plan, f.turns, f.parts, seats, books, f.signals, f.reads, f.columns, rows
        if self._helpers is None:
            return run(*given)
        self._plan["board"] = self._helpers.call()
        failed = run_beside(*given)
        self._helpers.look()
        return failed

    def _refuse(self, found: Tables, plan: Any) -> None:
        """Raise what the component that failed has to say."""
        failed = int(plan["failed"])
        turn, call = found.turns[failed], CALLS[int(plan["call"])]
        found.components[failed].refuse(call, int(plan["status"]), float(turn["time"]), float(turn["span"]))
        raise AssertionError(f"{found.components[failed].name} has nothing to say of {call}")

    def _ends(self, now: Moment, rows: int) -> int:
        """The macro step at which somebody in Python must look, or so many recorded rows are full."""
        ends = [now.done + self._longest, *(observer.due(now) for observer in self._observers)]
        if rows:
            ends.append((now.done // self._every + rows + 1) * self._every)
        return max(now.done + 1, min(ends))

    def _planned(self, now: Moment, until: int) -> Any:
        """The plan of a stretch from now to the end of macro step `until`."""
        steps = self._steps
        self._plan[0] = (
            self._at_once, 0, now.start, steps.length, steps.parts, steps.impacts.parts, 0, now.done,
            until, 0.0, steps.booked, steps.ledger.fall, self._judge.limit, self._every, 0, now.zero,
            0, 0, 0,
        )  # fmt: skip
        return self._plan[0]
