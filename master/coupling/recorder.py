"""The recorder: rows of a run, from its components into its file."""

from __future__ import annotations

import re
import time as clock
from collections import Counter
from collections.abc import Callable, Collection, Iterable, Sequence
from contextlib import suppress
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ...fmus.version import VERSION
from ...modelkit.variables import Causality
from ..common.errors import TouchdownError, one_of
from ..common.files import NO_ROOM
from ..components.component import READABLE, REPORTED, ScalarVariable, reported
from ..scene.run_spec import RunSpec
from ..scene.scene import Scene
from .connections import full
from .loop.span import zero_of
from .recording_file import (
    ENCODED,
    END,
    NAMES,
    OTHERS,
    TIME,
    ZERO,
    Contents,
    RecordedColumn,
    RecordedTable,
    link_name,
)
from .system import System


class _Chosen(NamedTuple):
    """Variables of a component."""

    recorded: list[str]
    at_end: list[str]  # kept of the end only


def choose(run: RunSpec, system: System) -> dict[str, _Chosen]:
    """By component. Raises TouchdownError for what `run` names and nothing is called."""
    components = system.components
    for name in components:
        if name in (TIME, END):  # its group would have the name of a data set
            raise TouchdownError(f"a component cannot be called {name} and be recorded; rename it")
    every = [full(name, v) for name, component in components.items() for v in component.variables]
    for key, beginnings in (("record", run.record), ("record_also", run.record_also)):
        for b in beginnings:
            if not any(_begins(name, [b]) for name in every):
                raise TouchdownError(f"run.{key}: there is nothing called {b}; {one_of(b, every)}")
    exact = {*run.record, *run.record_also}
    connected = {c.source_name for c in system.connections}
    found: dict[str, _Chosen] = {}
    for name, component in components.items():
        variables = [
            v
            for v in component.variables.values()
            if v.kind in READABLE and (v.causality in REPORTED or full(name, v.name) in exact)
        ]
        members = Counter(_all_members(variable) for variable in component.variables)
        long = {array for array, number in members.items() if number > MAX_MEMBERS}
        chosen = [
            v.name
            for v in variables
            if _chosen(full(name, v.name), v, run, connected, _all_members(v.name) in long)
        ]
        known = set(chosen)
        found[name] = _Chosen(chosen, [v.name for v in variables if v.name not in known])
    recorded = [full(name, v) for name, chosen in found.items() for v in chosen.recorded]
    for key, beginnings in (("record", run.record), ("record_also", run.record_also)):
        for b in beginnings:
            if not any(_begins(name, [b]) for name in recorded):
                raise TouchdownError(
                    f"run.{key}: nothing of {b} is recorded; give whole names of parameters, inputs and "
                    "elements of arrays (numbers only), or set run.record_arrays"
                )
    return found


MAX_MEMBERS = 4  # of what is recorded without being asked for, as the axes of a magnetic bearing are
_INDEX = re.compile(r"\[[\d, ]+\]")


def _all_members(name: str) -> str:
    """The common name of a variable and the others of its array: axis[].set of axis[2].set."""
    return _INDEX.sub("[]", name)


def _chosen(
    name: str, variable: ScalarVariable, run: RunSpec, connected: Collection[str], long: bool
) -> bool:
    """Whether COMPONENT.VARIABLE is recorded; long: it is one of a long array."""
    if name in run.record or _begins(name, run.record_also):
        return True
    if long and not run.record_arrays:
        return False
    if run.record:
        return _begins(name, run.record)
    return variable.causality is Causality.OUTPUT or name in connected or reported(variable.name)


def _begins(name: str, beginnings: Sequence[str]) -> bool:
    """Whether COMPONENT.VARIABLE is one of those, or in the component or group of one."""
    return any(f"{name}.".startswith(f"{b}.") for b in beginnings)


MAX_HELD_NUMBERS = 2**20  # numbers held before they are written, at most: 8 MiB
MAX_LOSS_S = 0.8  # s of wall time between writes: with the write itself, less than a second is lost
# Of the time that writing takes, at most: with very many columns more is lost instead
MAX_WRITING_SHARE = 0.05


class Recorder:
    """Records what a scene asks for of a system, `most` rows at the most, into a file at `path`.

    earlier: of the run that goes on, its file and the rows of it that stay.

    After begin() the file takes the place of one that was there; it may be read at any time. Raises
    TouchdownError where it cannot be written, or where the scene names what is not there.
    """

    def __init__(
        self,
        path: Path,
        scene: Scene,
        system: System,
        most: int,
        begin: Callable[[], object] = lambda: None,
        earlier: tuple[Path, int] | None = None,
    ) -> None:
        self.path = path
        self._components = system.components
        self._chosen = choose(scene.run, system)
        columns = [
            RecordedColumn(f"{name}/{link_name(v.name)}", v.unit or "1", v.description)
            for name, chosen in self._chosen.items()
            for v in map(self._components[name].variable, chosen.recorded)
        ]
        self._readers = {
            name: self._components[name].reader(chosen.recorded) for name, chosen in self._chosen.items()
        }
        self._resting: dict[str, np.ndarray] = {}  # last values of components that change no more
        width = 1 + len(columns)
        self._block = np.zeros((max(1, MAX_HELD_NUMBERS // width), width))
        self._filled = 0
        self._appended = self._written = -np.inf  # s of wall time: the last row, the last time on the disk
        self._patience = MAX_LOSS_S
        self._failed = False
        begin()
        try:
            encoded = {NAMES: ENCODED} if any("%" in column.name for column in columns) else {}
            contents = Contents(_heading(scene, system) | encoded, columns)
            self._table = RecordedTable(path, contents, most, earlier)
        except OSError as error:
            raise TouchdownError(self._problem(error)) from None

    def append(self, time: float) -> None:
        """Record all variables at `time` (s). Raises TouchdownError where the file cannot grow."""
        row = self._block[self._filled]
        row[0] = time
        column = 1
        for name, fetch in self._readers.items():
            values = self._resting[name] if name in self._resting else fetch()
            row[column : column + len(values)] = values
            column += len(values)
        self.took(1)

    @property
    def rows(self) -> int:
        """How many were recorded."""
        return self._table.rows + self._filled

    @property
    def room(self) -> np.ndarray:
        """Rows to be filled next, at least one: the time (s), then what is recorded, by component."""
        return self._block[self._filled :]

    @property
    def recorded(self) -> dict[str, list[str]]:
        """Variables that are recorded, by component, in the order of the columns."""
        return {name: chosen.recorded for name, chosen in self._chosen.items()}

    def resting(self, name: str) -> np.ndarray | None:
        """The recorded values of a component that changes no more; None while it does."""
        return self._resting.get(name)

    def took(self, count: int) -> None:
        """As many rows of `room` were filled. Raises TouchdownError where the file cannot grow."""
        self._filled += count
        time = clock.monotonic()
        next_one = time + (time - self._appended)  # when it is to be expected
        self._appended = time
        if self._filled == len(self._block) or next_one - self._written > self._patience:
            self.flush()

    def flush(self) -> None:
        """Bring all rows to the disk now. Raises TouchdownError where the file cannot grow."""
        if self._filled:
            try:
                self._write()
            except OSError as error:
                raise TouchdownError(self._problem(error)) from None

    def freeze(self, names: Iterable[str]) -> None:
        """The values of these components change no more."""
        for name in names:
            self._resting[name] = np.array(self._readers[name]())

    def _write(self) -> None:
        """Bring the rows held to the disk. Where that raises OSError, as many as there is room for."""
        rows, self._filled = self._block[: self._filled], 0
        began = clock.thread_time()  # what it costs, not how long others keep it waiting
        before = self._table.rows
        try:
            self._table.append(rows)
        except OSError:
            self._failed = True
            self._squeeze(rows[self._table.rows - before :])
            self._table.close()
            raise
        self._patience = max(MAX_LOSS_S, (clock.thread_time() - began) / MAX_WRITING_SHARE)
        self._written = clock.monotonic()

    def _squeeze(self, rows: np.ndarray) -> None:
        """Bring as many of `rows` to the disk as there is room for."""
        count = len(rows)
        while count := count // 2:
            with suppress(OSError):
                self._table.append(rows[:count])
                rows = rows[count:]

    def _problem(self, error: OSError) -> str:
        remedy = "make room for it" if error.errno in NO_ROOM else "choose another folder with -o"
        return f"cannot write {self.path}: {error.strerror}; {remedy}"

    def _at_end(self) -> dict[str, dict[str, float]]:
        """Values that are kept of the end only, by component and variable."""
        found: dict[str, dict[str, float]] = {}
        for name, chosen in self._chosen.items():
            if chosen.at_end:
                found[name] = {}
                with suppress(TouchdownError):  # one that failed may answer no more
                    values = map(float, self._components[name].read(chosen.at_end))
                    found[name] = dict(zip(chosen.at_end, values, strict=True))
        return found

    def close(self) -> str:
        """Write what is left, and values of the end; returns what went wrong, or ""."""
        if self._failed:
            return ""
        try:
            if self._filled:
                self._write()
            try:
                self._table.finish(self._at_end())
            finally:
                self._table.close()
        except OSError as error:
            return self._problem(error)
        return ""


def _heading(scene: Scene, system: System) -> dict[str, object]:
    """The attributes of the root: the run's title, scene and scheme, and texts that are set."""
    others = ", ".join(name for name, c in system.components.items() if c.third_party)
    return {
        "title": scene.title,
        "scene": scene.name,
        "version": VERSION,
        "scheme": scene.run.scheme.name,
        "macro_step_s": scene.run.macro_step,
        ZERO: zero_of(scene, system),
        **({OTHERS: others} if others else {}),
        **{full(*name): text for name, text in system.texts.items()},
    }
