"""Recording to HDF5, streamed: memory stays flat, and what was recorded survives a run that stops.

The file is netCDF-4 as well: any reader of either opens it. One group per component holds one dataset
per variable, with the attributes `units` and `long_name`; `time`, in seconds from the scene's zero, is the
one dimension of all of them. Of elements of arrays (``ball[3].x``) only the last values are kept, as
attributes of the group `at_end/COMPONENT`, unless a run asks for all. The attributes of the root say what
was run: title, scene, version, scheme, macro_step_s.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from pathlib import Path

import h5py
import numpy as np

from touchdown.fmus.version import VERSION
from touchdown.master.common.errors import TouchdownError, one_of
from touchdown.master.components.component import NUMBERS, REPORTED, Component, Variable
from touchdown.master.scene.scene import Scene

BLOCK = 4096  # rows held before they are written
TIME = "time"
END = "at_end"  # group of the values that are kept of the end only
REFUSED = (OSError, RuntimeError)  # what h5py raises where the disk is full: writing, flushing, closing


class Recorder:
    """Rows of all recorded variables of a scene's components, `most` of them at the most."""

    def __init__(self, path: Path, scene: Scene, components: Mapping[str, Component], most: int) -> None:
        self.path = path
        self._components = components
        run = scene.run
        _refuse_taken(components)
        _refuse_unused(run.record, components)
        self.names: dict[str, list[str]] = {}
        self.kept_at_end: dict[str, list[str]] = {}
        for name, component in components.items():
            given = [
                v.name
                for v in component.variables.values()
                if v.causality in REPORTED and v.kind in NUMBERS
            ]
            chosen = [v for v in given if _begins(f"{name}.{v}", run.record)]
            self.names[name] = [v for v in chosen if run.record_arrays or "[" not in v]
            self.kept_at_end[name] = [v for v in given if v not in self.names[name]]
        self._file = _created(path)
        self._file.attrs.update(_heading(scene))
        # With a bound, h5netcdf takes the dimension's size from it alone; without, it asks every column for
        # its length, again for every column.
        self._time = self._dataset(TIME, "s", "time from the scene's zero", max(most, BLOCK))
        self._time.make_scale(TIME)
        self._datasets = [
            self._column(name, components[name].variable(variable))
            for name, variables in self.names.items()
            for variable in variables
        ]
        self._readers = {name: components[name].reader(variables) for name, variables in self.names.items()}
        self._resting: dict[str, np.ndarray] = {}  # last values of components that change no more
        self._block = np.zeros((BLOCK, 1 + len(self._datasets)))
        self._filled = 0
        self.rows = 0

    def _column(self, component: str, variable: Variable) -> h5py.Dataset:
        """The dataset of a component's variable."""
        unit, meaning = variable.unit or "1", variable.description
        dataset = self._dataset(f"{component}/{variable.name}", unit, meaning)
        dataset.dims[0].attach_scale(self._time)
        return dataset

    def _dataset(self, name: str, unit: str, meaning: str, most: int | None = None) -> h5py.Dataset:
        dataset = self._file.create_dataset(
            name,
            (0,),
            maxshape=(most,),
            chunks=(BLOCK,),
            dtype="f8",
            compression="gzip",
            compression_opts=1,
        )
        dataset.attrs["units"] = unit
        dataset.attrs["long_name"] = meaning
        return dataset

    def append(self, time: float) -> None:
        """Record all variables at `time` (s). Raises TouchdownError where the file cannot grow."""
        row = self._block[self._filled]
        row[0] = time
        column = 1
        for name, fetch in self._readers.items():
            values = self._resting[name] if name in self._resting else fetch()
            row[column : column + len(values)] = values
            column += len(values)
        self._filled += 1
        if self._filled == BLOCK:
            problem = self._written()
            if problem:
                raise TouchdownError(problem)

    def rest(self, names: Iterable[str]) -> None:
        """The values of these components change no more."""
        for name in names:
            self._resting[name] = np.array(self._readers[name]())

    def _written(self) -> str:
        """Write the rows held; returns what went wrong, or "". Rows that find no room are given up."""
        n, self._filled = self._filled, 0
        if not n:
            return ""
        try:
            self._resize(self.rows + n)
            for column, dataset in enumerate((self._time, *self._datasets)):
                dataset[self.rows :] = self._block[:n, column]
            self._file.flush()
        except REFUSED as error:
            self._give_up()
            return self._problem(error)
        self.rows += n
        return ""

    def _resize(self, rows: int) -> None:
        for dataset in (self._time, *self._datasets):
            dataset.resize((rows,))

    def _give_up(self) -> None:
        """Go back to the rows before: HDF5, which writes the rest when Python exits, would crash there."""
        with suppress(*REFUSED):
            self._resize(self.rows)
            self._file.flush()

    def _problem(self, error: Exception) -> str:
        number = re.search(r"errno = (\d+)", str(error))  # HDF5's message has it among much else
        why = os.strerror(int(number[1])) if number else " ".join(str(error).split())
        return f"cannot write {self.path}: {why}; make room for it"

    def _write_end(self) -> None:
        for name, variables in self.kept_at_end.items():
            if variables:
                group = self._file.require_group(f"{END}/{name}")
                with suppress(TouchdownError):  # one that failed may answer no more
                    values = self._components[name].read(variables)
                    for variable, value in zip(variables, values, strict=True):
                        group.attrs[variable] = float(value)

    def close(self) -> str:
        """Write what is left; returns what went wrong, or ""."""
        problem = self._written()
        try:
            if not problem:
                self._write_end()
            self._file.close()
        except REFUSED as error:
            problem = problem or self._problem(error)
        return problem


def _created(path: Path) -> h5py.File:
    """A new file at `path`, or where a link there leads; who reads an older one goes on reading that."""
    try:
        there = path.resolve()
        there.unlink(missing_ok=True)
        return h5py.File(there, "w", libver="latest")
    except REFUSED as error:
        raise TouchdownError(f"cannot write {path}: {error}; choose another folder with -o") from None


def _heading(scene: Scene) -> dict[str, object]:
    """What was run: attributes of the root."""
    return {
        "title": scene.title,
        "scene": scene.name,
        "version": VERSION,
        "scheme": scene.run.scheme.name,
        "macro_step_s": scene.run.macro_step,
    }


def _begins(name: str, beginnings: Sequence[str]) -> bool:
    """Whether COMPONENT.VARIABLE is one of those, or in the component or group of one."""
    return not beginnings or any(f"{name}.".startswith(f"{b}.") for b in beginnings)


def _refuse_unused(beginnings: Sequence[str], components: Mapping[str, Component]) -> None:
    every = [f"{name}.{v}" for name, component in components.items() for v in component.variables]
    for b in beginnings:
        if not any(_begins(name, [b]) for name in every):
            raise TouchdownError(f"run.record: there is nothing called {b}; {one_of(b, every)}")


def _refuse_taken(components: Iterable[str]) -> None:
    """Raise TouchdownError where a component's group would have a name that the file has already."""
    for name in components:
        if name in (TIME, END):
            raise TouchdownError(f"a component cannot be called {name} and be recorded; rename it")
