"""A system's tables for compiled macro steps: who is called, what is copied, and what is recorded."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from touchdown.master.components.component import WHOLE, ByFunctions, Component, InMemory, Kind, Variable
from touchdown.master.components.contract import REACH
from touchdown.master.coupling.layout import Scaling
from touchdown.master.coupling.loop.kernels.tables import (
    COLUMN,
    INT,
    LONG,
    PART,
    READ,
    REAL,
    TRUTH,
    TURN,
)
from touchdown.master.coupling.recorder import Recorder
from touchdown.master.coupling.steppers.gauss_seidel import GaussSeidel, Turn
from touchdown.master.coupling.steppers.rates import Part

Entry = InMemory | ByFunctions


@dataclass
class Tables:
    """Tables of one system, as it is laid out now; `kept` are the arrays whose addresses they hold."""

    signals: np.ndarray
    components: list[Component]  # by turn
    turns: np.ndarray = field(default_factory=lambda: np.zeros(0, TURN))
    parts: np.ndarray = field(default_factory=lambda: np.zeros(0, PART))
    reads: np.ndarray = field(default_factory=lambda: np.zeros(0, READ))
    columns: np.ndarray = field(default_factory=lambda: np.zeros(0, COLUMN))
    kept: list[object] = field(default_factory=list[object])


def tables(stepper: GaussSeidel, at_once: bool, recorder: Recorder | None) -> Tables | None:
    """The tables of a stepper's system; None where a component cannot be stepped by address.

    at_once: whether all components take their inputs before any steps.
    """
    entries: list[Entry] = []
    for turn in stepper.turns:
        entry = turn.component.by_address() if _as_written(turn.component) else None
        if entry is None:
            return None
        entries.append(entry)
    made = Tables(stepper.system.signals, [turn.component for turn in stepper.turns])
    _add_turns(made, stepper.turns, entries)
    _group(made, stepper.turns, at_once, shared=all(map(_any_thread, entries)))
    if recorder is not None:
        _add_columns(made, entries, recorder)
    return made


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


def _add_turns(made: Tables, turns: Sequence[Turn], entries: Sequence[Entry]) -> None:
    parts: list[Part] = []
    made.turns = np.zeros(len(turns), TURN)
    for turn, entry, row in zip(turns, entries, made.turns, strict=True):
        own = [cut for cut in turn.cuts if isinstance(cut, Part)]
        fields = _exchanged(turn, entry) | _called(entry)
        fields |= {"first_part": len(parts), "end_part": len(parts) + len(own)}
        for name, value in fields.items():
            row[name] = value
        parts += own
    made.parts = np.array([_part(part) for part in parts], PART)
    made.kept += [turns, entries, parts]


def _group(made: Tables, turns: Sequence[Turn], at_once: bool, shared: bool) -> None:
    """Put together what steps beside each other: all at once, or, where threads may share the steps, those
    who take nothing that others of their group give in the same step.

    Touchdown bearings are worth it, two and more: others' steps take less than handing them over.
    """
    first, given = 0, set[int]()
    for i, turn in enumerate(turns):
        alone = not shared or given.intersection(turn.places.tolist())
        if alone and not at_once:
            first, given = i, set[int]()
        outputs = turn.component.outputs
        start = (_address(outputs) - _address(made.signals)) // outputs.dtype.itemsize
        given.update(range(start, start + len(outputs)))
        made.turns["end"][first] = i + 1
        if shared and REACH in turn.component.variables:
            made.turns["shared"][first] += 1


def _any_thread(entry: Entry) -> bool:
    """Whether a component may be stepped by any thread."""
    return isinstance(entry, InMemory) or entry.any_thread


def _exchanged(turn: Turn, entry: Entry) -> dict[str, int]:
    """Fields of what a component takes and gives."""
    component = turn.component
    fields = {
        "every": turn.every,
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


def _part(part: Part) -> tuple[float, ...]:
    means, slopes, last = map(_address, (part.means, part.slopes, part.last))
    return part.bearing, part.body, means, slopes, len(part.slopes), last, len(part.last), part.step


# -- recorded rows -------------------------------------------------------------------------------------


def _add_columns(made: Tables, entries: Sequence[Entry], recorder: Recorder) -> None:
    reads: list[tuple[int, ...]] = []
    columns: list[tuple[int, int]] = []
    by_name = {component.name: turn for turn, component in enumerate(made.components)}
    for name, variables in recorder.recorded.items():
        resting = recorder.resting(name)
        if resting is not None:
            columns += [(_address(resting) + 8 * i, REAL) for i in range(len(resting))]
            made.kept.append(resting)
            continue
        turn = by_name[name]
        entry, chosen = entries[turn], [made.components[turn].variable(v) for v in variables]
        if isinstance(entry, InMemory):
            words = _address(entry.words)
            columns += [(words + 8 * v.reference, REAL if v.kind is Kind.REAL else LONG) for v in chosen]
        else:
            columns += _fetched(made, reads, turn, entry, chosen)
    made.reads = np.array(reads, READ)
    made.columns = np.array(columns, COLUMN)


def _fetched(
    made: Tables,
    reads: list[tuple[int, ...]],
    turn: int,
    entry: ByFunctions,
    chosen: Sequence[Variable],
) -> list[tuple[int, int]]:
    """Columns of values that are fetched by calls, which are added to `reads`."""
    columns = [(0, 0)] * len(chosen)
    for call, wanted, dtype, kind in (
        (entry.get_real, (Kind.REAL,), "f8", REAL),
        (entry.get_integer, WHOLE, "i4", INT),
        (entry.get_boolean, (Kind.BOOLEAN,), "i4", TRUTH),
    ):
        at = [i for i, v in enumerate(chosen) if v.kind in wanted]
        if at:
            of, into = np.array([chosen[i].reference for i in at], np.uint32), np.zeros(len(at), dtype)
            made.kept += [of, into]
            reads.append((turn, call, entry.component, _address(of), len(at), _address(into)))
            for k, i in enumerate(at):
                columns[i] = (_address(into) + into.itemsize * k, kind)
    return columns
