"""An HDF5 file that is netCDF-4 as well, and that any reader can open at every moment of a run.

HDF5 changes its file in many small writes, and a reader that opens it between two of them, or that reads on
over them, finds columns of different lengths. So no HDF5 file is changed here. It is made whole, with room
for `ROWS` rows whose times are not numbers (NaN) yet; later rows are written into that room, their times
last. A file without room left, and at the end the one with all rows and no more, is made beside it and
takes its place; who has the old one open keeps it. A process that is killed at any moment leaves the rows
it has written. (Power that fails is not in this: nothing waits for the disk.)
"""

from __future__ import annotations

import os
import re
from collections.abc import Mapping, Sequence
from io import FileIO
from pathlib import Path
from typing import NamedTuple

import h5py
import numpy as np

from ...modelkit.kernel.writing import open_in_place, replacing
from ..common.errors import TouchdownError

NAMES, ENCODED = "names", "percent-encoded"  # attribute of a file whose names are not all as they were
TIME = "time"
ZERO = "zero_s"  # attribute: the scene's zero on the simulation's clock, which recorded instants are on
OTHERS = "third_party"  # attribute: names of the components that are none of the project's own
END = "at_end"  # group of the values that are kept of the end only
ROWS = 2**16  # that there is room for at first
GROWTH = 2  # times the room, where it was too small
NUMBER = np.dtype("<f8")
BLOCK = 2**20  # numbers that are copied at once
VERSION = ("v108", "v108")  # its heads are small; later ones mark files that are open for writing


def link_name(variable: str) -> str:
    """The name of a variable's data set: paths of HDF5 have names without / that are not all dots.

    >>> link_name("load/x"), link_name(".."), link_name("der(a.b[1,2])")
    ('load%2Fx', '%2E%2E', 'der(a.b[1,2])')
    """
    unfit = r"[%/\x00-\x1f\x7f]" if variable.strip(".") else r"\."
    return re.sub(unfit, lambda match: f"%{ord(match[0]):02X}", variable)


class RecordedColumn(NamedTuple):
    """A variable that is recorded."""

    name: str  # COMPONENT/VARIABLE, the latter as `link_name` has it
    unit: str
    meaning: str


class Contents(NamedTuple):
    """The contents of a table."""

    heading: Mapping[str, object]  # attributes of the root
    columns: Sequence[RecordedColumn]


class RecordedTable:
    """Rows of columns over time in the file at `path`, which it replaces; up to `most` rows are expected.

    The first of them are those of `earlier`, a file of the same columns, and how many to take.
    What raises OSError leaves the file as it was; what was appended before stays.
    """

    def __init__(
        self, path: Path, contents: Contents, most: int, earlier: tuple[Path, int] | None = None
    ) -> None:
        self._path, self._contents = path, contents
        self.rows = 0
        self._room = 0
        self._places: Sequence[int] = ()  # of the columns in the file, that of time first
        self._file: FileIO
        self._later = 0.0  # s, of the zero that earlier rows count from, to this one's
        if earlier is not None:
            self._open(*earlier)
        self._replace(max(self.rows, min(max(most, 1), ROWS)), {})

    def _open(self, path: Path, rows: int) -> None:
        """Begin with rows that were written before. Raises TouchdownError where they are not there."""
        names = [TIME, *(column.name for column in self._contents.columns)]
        with h5py.File(path, "r") as file:
            found = [file[name].id.get_offset() if name in file else None for name in names]
            places = [place for place in found if place is not None]
            if len(places) < len(names) or len(file[TIME]) < rows:
                raise TouchdownError(
                    f"{path} has other columns or fewer rows than the run that is to go on, or was packed"
                )
            zero = self._contents.heading.get(ZERO, 0.0)
            self._later = float(file.attrs.get(ZERO, zero)) - float(str(zero))
        self._file = FileIO(open_in_place(path, os.O_RDONLY), "r")
        self._places, self.rows = places, rows

    def append(self, rows: np.ndarray) -> None:
        """Write rows, each of a time (s) and a value per column, onto the disk."""
        while len(rows):
            if self.rows == self._room:
                self._replace(GROWTH * self._room, {})
            fitting = rows[: self._room - self.rows]
            columns = np.ascontiguousarray(fitting.T, NUMBER)
            for place, values in zip(reversed(self._places), columns[::-1], strict=True):
                _put(self._file, values, place + NUMBER.itemsize * self.rows)
            self.rows += len(fitting)
            rows = rows[len(fitting) :]

    def finish(self, at_end: Mapping[str, Mapping[str, float]]) -> None:
        """Give the file the length of its rows, and values of the end, by component and variable."""
        self._replace(self.rows, at_end)

    def close(self) -> None:
        """Let go of the file."""
        self._file.close()

    def _replace(self, room: int, at_end: Mapping[str, Mapping[str, float]]) -> None:
        """Have the rows in a new file with `room` for rows."""
        with replacing(self._path) as part:
            file = FileIO(part.fileno(), "r+", closefd=False)
            places = _create(file, self._contents, room, at_end)
            for k, (before, place) in enumerate(zip(self._places, places, strict=False)):
                self._copy(before, file, place, self._later if k == 0 else 0.0)
            self._later = 0.0
            for row in range(self.rows, room, BLOCK):
                unknown = np.full(min(BLOCK, room - row), np.nan, NUMBER)
                _put(file, unknown, places[0] + NUMBER.itemsize * row)
            if self._places:
                self.close()  # Windows replaces no open file
        self._file = FileIO(open_in_place(self._path, os.O_RDWR), "r+")
        self._places, self._room = places, room

    def _copy(self, before: int, file: FileIO, place: int, later: float) -> None:
        """Copy the rows of a column from its place `before` to its `place` in another file.

        later: added to each.
        """
        for row in range(0, self.rows, BLOCK):
            count, begin = NUMBER.itemsize * min(BLOCK, self.rows - row), NUMBER.itemsize * row
            self._file.seek(before + begin)
            values = np.frombuffer(self._file.read(count), NUMBER)
            _put(file, values + later if later else values, place + begin)


def _put(file: FileIO, data: bytes | np.ndarray, address: int) -> None:
    """Write all of it: a disk that runs full takes a part first."""
    view = memoryview(data).cast("B")  # type: ignore[arg-type]
    os.lseek(file.fileno(), address, os.SEEK_SET)  # Windows has no pwrite
    while view:
        view = view[os.write(file.fileno(), view) :]


def _create(
    file: FileIO, contents: Contents, room: int, at_end: Mapping[str, Mapping[str, float]]
) -> list[int]:
    """Make the file, with numbers that are yet to be written; returns the places of the columns."""
    columns = [RecordedColumn(TIME, "s", "time from the scene's zero"), *contents.columns]
    reserved = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
    reserved.set_alloc_time(h5py.h5d.ALLOC_TIME_EARLY)
    reserved.set_fill_time(h5py.h5d.FILL_TIME_NEVER)
    # aligned, a number lies on one page: a kill leaves it there or not
    with h5py.File(
        file, "w", libver=VERSION, alignment_threshold=1, alignment_interval=NUMBER.itemsize
    ) as created:
        created.attrs.update(contents.heading)
        datasets: list[h5py.Dataset] = []
        for column in columns:
            datasets.append(created.create_dataset(column.name, (room,), dtype=NUMBER, dcpl=reserved))
        _describe(datasets, columns)
        for component, values in at_end.items():
            created.require_group(f"{END}/{component}").attrs.update(values)
        return [dataset.id.get_offset() or 0 for dataset in datasets]


def _describe(datasets: Sequence[h5py.Dataset], columns: Sequence[RecordedColumn]) -> None:
    """Units and meanings; the first of `datasets` is the dimension of the others.

    Attached one by one, each would have HDF5 write the dimension's list of all those before anew.
    """
    time, *others = datasets
    for dataset, column in zip(datasets, columns, strict=True):
        dataset.attrs["units"] = column.unit
        dataset.attrs["long_name"] = column.meaning
    time.make_scale(TIME)
    scales = np.empty(1, object)  # of the one dimension
    scales[0] = np.array([time.ref], h5py.ref_dtype)
    for dataset in others:
        dataset.attrs.create("DIMENSION_LIST", scales, dtype=h5py.vlen_dtype(h5py.ref_dtype))
    if others:
        scaled = np.zeros(len(others), [("dataset", h5py.ref_dtype), ("dimension", "i4")])
        scaled["dataset"] = [dataset.ref for dataset in others]
        time.attrs.create("REFERENCE_LIST", scaled)
