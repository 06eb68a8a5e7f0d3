"""Macro steps: one by one, or many of them in compiled code.

`PythonLoop` takes one macro step in Python: the stepper steps the components, and the ledger books the
work. `CompiledLoop` calls it, or takes a stretch of many macro steps in compiled code, up to the next one
of which an observer in Python must know. There, components are stepped by the addresses of their kernels
or FMI functions (`_Tables`), and compiled code books the work, too.

Macro steps are taken one by one where a component cannot be stepped by its address, a scheme has a sequence
of its own, a bearing is audited by a second instance, or an observer looks at every step. The results are
the same to the last bit.
"""

from __future__ import annotations

import time as clock
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, cast

import numpy as np

from ...components.component import REACH, WHOLE, ByFunctions, Call, Component, FmiType, InMemory
from ...components.component import ScalarVariable as Scalar
from ..ledger import Ledger, ResidualMonitor, WhirlStepControl
from ..observer import LOOK_INTERVAL_STEPS, Observer, RunState
from ..recorder import Recorder
from ..signal_layout import Scaling
from ..snapshot import Kept, Saved
from ..steppers.gauss_seidel import GaussSeidel, StepTurn
from ..steppers.jacobi import Jacobi
from ..steppers.rates import StepPart
from ..steppers.stepper import Stepper
from .division import ImpactSubsteps
from .helpers import Helpers, helpers
from .kernels.loop_tables import (
    COLUMN,
    FETCH,
    GET,
    INT,
    LONG,
    PART,
    PLAN,
    READ,
    REAL,
    SET,
    STEP,
    TRUTH,
    TURN,
)
from .kernels.stretch import run, run_beside


class PythonLoop(Kept):
    """Macro steps, whole or divided, each part of them booked."""

    KEPT = ("booked",)

    def __init__(self, coupling: Stepper, ledger: Ledger, shortening: WhirlStepControl) -> None:
        self.coupling, self.ledger = coupling, ledger
        self.length = coupling.run.macro_step  # s
        self.booked = 0  # steps, with the parts of those divided
        self.impacts = ImpactSubsteps(coupling)
        self._shortening = shortening

    @property
    def parts(self) -> int:
        """Into how many the next macro step is divided, impacts apart."""
        return 2**self._shortening.halvings

    def save(self) -> Saved:
        return super().save() | {"impacts": self.impacts.save()}

    def load(self, saved: Saved) -> None:
        super().load(saved)
        self.impacts.follow()
        self.impacts.load(saved["impacts"])

    def take(self, state: RunState) -> None:
        """Take one, and move on to its end. Raises TouchdownError where a component cannot go on."""
        number, begin = state.done, state.start + state.done * self.length
        parts = max(self.parts, self.impacts.parts_of(begin, self.length))
        part = self.length / parts
        for k in range(parts):
            self.coupling.step(number * parts + k, begin + k * part, part)
            self.booked += 1
            self.ledger.book(self.booked, part)
        state.move(number + 1, self.length)


Entry = InMemory | ByFunctions


@dataclass
class _Tables:
    """Tables of one system in its present layout; `kept` are the arrays whose addresses they hold."""

    signals: np.ndarray
    components: list[Component]  # by turn
    turns: np.ndarray = field(default_factory=lambda: np.zeros(0, TURN))
    parts: np.ndarray = field(default_factory=lambda: np.zeros(0, PART))
    reads: np.ndarray = field(default_factory=lambda: np.zeros(0, READ))
    columns: np.ndarray = field(default_factory=lambda: np.zeros(0, COLUMN))
    kept: list[object] = field(default_factory=list[object])


def system_tables(stepper: GaussSeidel, at_once: bool, recorder: Recorder | None) -> _Tables | None:
    """The tables of a stepper's system; None where a component cannot be stepped by address.

    at_once: whether all components take their inputs before any steps.
    """
    entries: list[Entry] = []
    for turn in stepper.turns:
        entry = turn.component.by_address() if _as_written(turn.component) else None
        if entry is None:
            return None
        entries.append(entry)
    tables = _Tables(stepper.system.signals, [turn.component for turn in stepper.turns])
    _add_turns(tables, stepper.turns, entries)
    any_thread = all(isinstance(entry, InMemory) or entry.any_thread for entry in entries)
    _group(tables, stepper.turns, at_once, any_thread)
    if recorder is not None:
        _add_columns(tables, entries, recorder)
    return tables


def _as_written(component: Component) -> bool:
    """Whether `by_address` speaks of the component's own methods, and not of some that were replaced."""

    def depth(method: str) -> int:
        if method in vars(component):
            return -1
        return next(i for i, kind in enumerate(type(component).__mro__) if method in vars(kind))

    return min(map(depth, ("push", "step", "pull", "reader"))) >= depth("by_address")


def _address(array: np.ndarray) -> int:
    assert array.flags.c_contiguous
    return array.ctypes.data


# -- steps ---------------------------------------------------------------------------------------------


def _add_turns(tables: _Tables, turns: Sequence[StepTurn], entries: Sequence[Entry]) -> None:
    parts: list[StepPart] = []
    tables.turns = np.zeros(len(turns), TURN)
    for turn, entry, row in zip(turns, entries, tables.turns, strict=True):
        step_parts = [cut for cut in turn.cuts if isinstance(cut, StepPart)]
        fields = _exchanged(turn, entry) | _called(entry)
        fields |= {"first_part": len(parts), "end_part": len(parts) + len(step_parts)}
        for name, value in fields.items():
            row[name] = value
        parts += step_parts
    tables.parts = np.array([_part(part) for part in parts], PART)
    tables.kept += [turns, entries, parts]


def _group(tables: _Tables, turns: Sequence[StepTurn], at_once: bool, shared: bool) -> None:
    """Put together what steps beside each other: all at once, or, where threads may share the steps, those
    who take nothing that others of their group give in the same step.

    Touchdown bearings are worth it, two and more: others' steps take less than handing them over.
    """
    first, output_places = 0, set[int]()
    for i, turn in enumerate(turns):
        alone = not shared or output_places.intersection(turn.places.tolist())
        if alone and not at_once:
            first, output_places = i, set[int]()
        outputs = turn.component.outputs
        start = (_address(outputs) - _address(tables.signals)) // outputs.dtype.itemsize
        output_places.update(range(start, start + len(outputs)))
        tables.turns["end"][first] = i + 1
        if shared and REACH in turn.component.variables:
            tables.turns["shared"][first] += 1


def _exchanged(turn: StepTurn, entry: Entry) -> dict[str, float]:
    """Fields of what a component takes and gives."""
    component = turn.component
    fields: dict[str, float] = {
        "every": turn.every,
        "period": turn.period,
        "inputs": _address(component.inputs),
        "takes": len(component.inputs),
        "places": _address(turn.places),
        "taken": _address(entry.taken),
        "outputs": _address(component.outputs),
        "gives": len(component.outputs),
        "given": _address(entry.given),
    }
    for cut in turn.cuts:
        if isinstance(cut, Scaling):
            fields |= {"factors": _address(cut.factors), "offsets": _address(cut.offsets)}
    return fields


def _called(entry: Entry) -> dict[str, int]:
    """Fields of what is called."""
    if isinstance(entry, InMemory):
        rows, columns = entry.work.shape
        return {
            "of": _address(entry.words),
            "words": len(entry.words),
            "work": _address(entry.work),
            "rows": rows,
            "columns": columns,
            "step": entry.advance,
        }
    return {
        "functions": 1,
        "of": entry.component,
        "step": entry.do_step,
        "set_real": entry.set_real,
        "get_real": entry.get_real,
        "finite": entry.checked,
    }


def _part(part: StepPart) -> tuple[float, ...]:
    means, slopes, last = map(_address, (part.means, part.slopes, part.last))
    return part.bearing, part.body, means, slopes, len(part.slopes), last, len(part.last), part.step


# -- recorded rows -------------------------------------------------------------------------------------


def _add_columns(tables: _Tables, entries: Sequence[Entry], recorder: Recorder) -> None:
    reads: list[tuple[int, ...]] = []
    columns: list[tuple[int, int]] = []
    by_name = {component.name: turn for turn, component in enumerate(tables.components)}
    for name, variables in recorder.recorded.items():
        resting = recorder.resting(name)
        if resting is not None:
            columns += [(_address(resting) + 8 * i, REAL) for i in range(len(resting))]
            tables.kept.append(resting)
            continue
        turn = by_name[name]
        entry, chosen = entries[turn], [tables.components[turn].variable(v) for v in variables]
        if isinstance(entry, InMemory):
            words = _address(entry.words)
            columns += [(words + 8 * v.reference, REAL if v.kind is FmiType.REAL else LONG) for v in chosen]
        else:
            columns += _fetched(tables, reads, turn, entry, chosen)
    tables.reads = np.array(reads, READ)
    tables.columns = np.array(columns, COLUMN)


def _fetched(
    tables: _Tables,
    reads: list[tuple[int, ...]],
    turn: int,
    entry: ByFunctions,
    chosen: Sequence[Scalar],
) -> list[tuple[int, int]]:
    """Columns of values that are fetched by calls, which are added to `reads`."""
    columns = [(0, 0)] * len(chosen)
    for call, kinds, dtype, kind in (
        (entry.get_real, (FmiType.REAL,), "f8", REAL),
        (entry.get_integer, WHOLE, "i4", INT),
        (entry.get_boolean, (FmiType.BOOLEAN,), "i4", TRUTH),
    ):
        indices = [i for i, v in enumerate(chosen) if v.kind in kinds]
        if indices:
            references = np.array([chosen[i].reference for i in indices], np.uint32)
            into = np.zeros(len(indices), dtype)
            tables.kept += [references, into]
            reads.append((turn, call, entry.component, _address(references), len(indices), _address(into)))
            for k, i in enumerate(indices):
                columns[i] = (_address(into) + into.itemsize * k, kind)
    return columns


PARALLEL_SEQUENCES: Mapping[object, bool] = {GaussSeidel.step: False, Jacobi.step: True}
"""Sequences that compiled code knows: whether all components take their inputs before any steps."""
CALLS = {SET: Call.SET, STEP: Call.STEP, GET: Call.GET, FETCH: Call.FETCH}
NO_ROWS = np.zeros((0, 0))
MAX_STRETCH_S = 0.1  # s of wall time that a stretch may take: so long Ctrl-C and the progress bar wait
# Macro steps of a stretch: a contact may make the next ones a hundred times slower
MAX_STRETCH_STEPS = LOOK_INTERVAL_STEPS


class CompiledLoop:
    """Takes macro steps of a run, as many at once as pass unobserved."""

    def __init__(
        self,
        steps: PythonLoop,
        residual: ResidualMonitor,
        recorder: Recorder | None,
        observers: Sequence[Observer],
    ) -> None:
        self._steps, self._residual, self._recorder = steps, residual, recorder
        self._observers = observers
        self._every = steps.coupling.run.record_every if recorder is not None else 0
        self._at_once = PARALLEL_SEQUENCES.get(type(steps.coupling).step)
        every_step = any(type(o).due is Observer.due and not o.at_beats_only for o in observers)
        self._able = self._at_once is not None and not every_step and not steps.ledger.listens
        self._signals: np.ndarray | None = None  # those that the tables are of
        self._tables: _Tables | None = None
        self._helpers: Helpers | None = None
        self._plan = np.zeros(1, PLAN)
        self._longest = 1  # macro steps that a stretch may take
        self._ready = False  # whether the first step was taken, which has all compiled

    def take(self, state: RunState) -> None:
        """Take macro steps, and move on to their end. Raises TouchdownError where they cannot be taken."""
        found = self._current_tables() if self._able and self._ready else None
        if found is None:
            self._steps.take(state)
            if self._able and not self._ready:
                self._get_ready(state)
            self._ready = True
            return
        began, done = clock.perf_counter(), state.done
        self._stretch(found, state)
        took = clock.perf_counter() - began
        if took > 0.5 * MAX_STRETCH_S:
            self._longest = max(1, self._longest // 2)
        elif state.done - done == self._longest:
            self._longest = min(2 * self._longest, MAX_STRETCH_STEPS)

    def close(self) -> None:
        """Send the helpers away."""
        if self._helpers is not None:
            self._helpers.close()
            self._helpers = None

    def _get_ready(self, state: RunState) -> None:
        """Compile what stretches need with all that the first macro step compiles: by one of no length."""
        found = self._current_tables()
        if found is not None:
            self._planned(state, state.done)
            self._run(found, NO_ROWS)

    def _current_tables(self) -> _Tables | None:
        """Tables of the system in its present layout."""
        coupling = cast(GaussSeidel, self._steps.coupling)
        if self._signals is not coupling.system.signals:
            self.close()
            self._signals = coupling.system.signals
            self._tables = system_tables(coupling, bool(self._at_once), self._recorder)
            self._steps.impacts.follow()
            self._helpers = None if self._tables is None else helpers(self._tables.turns)
        return self._tables

    def _stretch(self, found: _Tables, state: RunState) -> None:
        steps, recorder = self._steps, self._recorder
        steps.coupling.expect(steps.length / steps.parts)
        rows = NO_ROWS if recorder is None else recorder.room
        plan = self._planned(state, self._ends(state, len(rows)))
        failed = self._run(found, rows)
        steps.booked = int(plan["booked"])
        steps.impacts.divided += int(plan["hit"])
        state.move(int(plan["done"]), steps.length)
        if recorder is not None and plan["row"]:
            recorder.took(int(plan["row"]))
        if failed:
            self._refuse(found, plan)

    def _run(self, found: _Tables, rows: np.ndarray) -> bool:
        steps, f = self._steps, found
        seats, books = steps.impacts.seats, steps.ledger.books
        arguments = self._plan, f.turns, f.parts, seats, books, f.signals, f.reads, f.columns, rows
        if self._helpers is None:
            return run(*arguments)
        self._plan["board"] = self._helpers.call()
        failed = run_beside(*arguments)
        self._helpers.judge()
        return failed

    def _refuse(self, found: _Tables, plan: Any) -> None:
        """Raise what the component that failed has to say."""
        failed = int(plan["failed"])
        turn, call = found.turns[failed], CALLS[int(plan["call"])]
        found.components[failed].refuse(call, int(plan["status"]), float(turn["time"]), float(turn["span"]))
        raise AssertionError(f"{found.components[failed].name} has nothing to say of {call}")

    def _ends(self, state: RunState, rows: int) -> int:
        """The macro step at which somebody in Python must look, or so many recorded rows are full."""
        ends = [state.done + self._longest, *(observer.due(state) for observer in self._observers)]
        if rows:
            ends.append((state.done // self._every + rows + 1) * self._every)
        return max(state.done + 1, min(ends))

    def _planned(self, state: RunState, until: int) -> Any:
        """The plan of a stretch from now to the end of macro step `until`."""
        steps = self._steps
        self._plan[0] = (
            self._at_once, 0, state.start, steps.length, steps.parts, steps.impacts.parts, 0, state.done,
            until, 0.0, steps.booked, steps.ledger.fall, self._residual.limit, self._every, 0, state.zero,
            0, 0, 0,
        )  # fmt: skip
        return self._plan[0]
