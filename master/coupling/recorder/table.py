"""Columns over time in an HDF5 file that is netCDF-4 as well."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import h5py
import numpy as np

from touchdown.master.coupling.recorder.ordered import OrderedFile

TIME = "time"
END = "at_end"  # group of the values that are kept of the end only
BLOCK = 4096  # rows that are compressed together
CHUNK = 512  # rows that get their place in the file together, at least
MEMORY = 2**22  # bytes that wait for the disk when a table is copied
CHUNKS = 64  # of a column at most: HDF5's index of them is then one node, which is never split
# The file's version: from it on columns' heads are small and whole, and later ones mark a file that is open
# for writing, so that none could read it after a kill.
VERSION = ("v108", "v108")


class Column(NamedTuple):
    """A variable that is recorded."""

    name: str  # COMPONENT/VARIABLE
    unit: str
    meaning: str


class Table:
    """Rows of columns over time in a file. What raises OSError leaves it as it was committed last."""

    def __init__(self, disk: OrderedFile, file: h5py.File, datasets: Sequence[h5py.Dataset]) -> None:
        self._disk, self._file, self._datasets = disk, file, datasets  # of time first
        disk.last = h5py.h5o.get_info(datasets[0].id).addr
        self.rows = len(datasets[0])
        self._broken = False  # nothing but `close` can follow

    @classmethod
    def created(
        cls,
        path: Path,
        heading: Mapping[str, object],
        columns: Sequence[Column],
        most: int,
        packed: bool = False,
    ) -> Table:
        """A new one for up to `most` rows, which lie as they are, for speed, or `packed`: compressed."""
        if packed:
            layout: dict[str, Any] = {"chunks": (BLOCK,), "compression": "gzip", "compression_opts": 1}
        else:
            layout = {"chunks": (max(CHUNK, -(-most // CHUNKS)),), "fill_time": "never"}
        disk = OrderedFile(path, new=True)
        file = h5py.File(disk, "w", libver=VERSION, rdcc_nbytes=0)  # nothing is cached
        file.attrs.update(heading)
        # With a bound, h5netcdf takes the dimension's size from it alone; without, it asks every column for
        # its length, again for every column.
        time = _dataset(file, Column(TIME, "s", "time from the scene's zero"), max(most, BLOCK), layout)
        time.make_scale(TIME)
        datasets = [time, *(_dataset(file, column, None, layout) for column in columns)]
        for dataset in datasets[1:]:
            dataset.dims[0].attach_scale(time)
        return cls(disk, file, datasets)

    @classmethod
    def reopened(cls, path: Path, columns: Sequence[Column]) -> Table:
        """The one at `path`, as it was committed last."""
        disk = OrderedFile(path, new=False)
        file = h5py.File(disk, "r+", libver=VERSION, rdcc_nbytes=0)
        return cls(disk, file, [file[name] for name in (TIME, *(column.name for column in columns))])

    def append(self, rows: np.ndarray) -> None:
        """Add rows, each of a time (s) and a value per column, and commit them."""
        count, begin = len(rows), self.rows
        there = h5py.h5s.create_simple((begin + count,))
        there.select_hyperslab((begin,), (count,))
        here = h5py.h5s.create_simple((count,))
        for dataset, values in zip(self._datasets, np.ascontiguousarray(rows.T), strict=True):
            dataset.id.set_extent((begin + count,))
            dataset.id.write(here, there, values)
        self.commit()
        self.rows += count

    def commit(self) -> None:
        """Bring to the disk what was added."""
        self._file.flush()
        try:
            self._disk.commit()
        except OSError:
            self._broken = True
            raise

    def keep(self, component: str, values: Mapping[str, float]) -> None:
        """Keep values of the end, by variable."""
        self._file.require_group(f"{END}/{component}").attrs.update(values)

    def copy(self, other: Table) -> None:
        """Take over all rows of another table of the same columns, and what it keeps of the end."""
        self.rows = other.rows
        for mine, others in zip(self._datasets, other._datasets, strict=True):
            mine.resize((self.rows,))
            for begin in range(0, self.rows, BLOCK):
                end = min(begin + BLOCK, self.rows)
                mine[begin:end] = others[begin:end]
                if self._disk.held > MEMORY:
                    self.commit()
        if END in other._file:
            other._file.copy(END, self._file)

    def close(self) -> None:
        """Commit what was added, unless something failed, and close the file."""
        self._file.close()
        try:
            if not self._broken:
                self._disk.commit()
        finally:
            self._disk.close()


def _dataset(file: h5py.File, column: Column, bound: int | None, layout: Mapping[str, Any]) -> h5py.Dataset:
    dataset = file.create_dataset(column.name, (0,), maxshape=(bound,), dtype="f8", **layout)
    dataset.attrs["units"] = column.unit
    dataset.attrs["long_name"] = column.meaning
    return dataset
