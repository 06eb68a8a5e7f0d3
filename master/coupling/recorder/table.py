"""Columns over time in an HDF5 file that is netCDF-4 as well."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

import h5py
import numpy as np

from touchdown.master.coupling.recorder.ordered import OrderedFile

TIME = "time"
END = "at_end"  # group of the values that are kept of the end only
CHUNK = 512  # rows that get their place in the file together, at least
CHUNKS = 64  # of a column at most: HDF5's index of them is then one node, which is never split
# The file's version: from it on columns' heads are small and whole, and later ones mark a file that is open
# for writing, so that none could read it after a kill.
VERSION = ("v108", "v108")


# Bytes. A write within a page is there or not, one over two pages may be there by half when a process is
# killed: heads of objects lie within a page each, aligned, and so small that they fit.
ALIGNED = {"alignment_threshold": 128, "alignment_interval": 512}


class Column(NamedTuple):
    """A variable that is recorded."""

    name: str  # COMPONENT/VARIABLE
    unit: str
    meaning: str


class Contents(NamedTuple):
    """What a table is of."""

    heading: Mapping[str, object]  # attributes of the root
    columns: Sequence[Column]
    keeping: Sequence[str]  # components of which something is kept of the end


class Table:
    """Rows of columns over time in a file. What raises OSError leaves it as it was committed last."""

    def __init__(self, disk: OrderedFile, file: h5py.File, datasets: Sequence[h5py.Dataset]) -> None:
        self._disk, self._file, self._datasets = disk, file, datasets  # of time first
        disk.last = h5py.h5o.get_info(datasets[0].id).addr
        self.rows = len(datasets[0])
        self._broken = False  # nothing but `close` can follow

    @classmethod
    def created(cls, path: Path, contents: Contents, most: int) -> Table:
        """A new one for up to `most` rows."""
        chunk = max(CHUNK, math.ceil(most / CHUNKS))
        disk = OrderedFile(path, new=True)
        file = _file(disk, "w")
        file.attrs.update(contents.heading)
        columns = [Column(TIME, "s", "time from the scene's zero"), *contents.columns]
        # With a bound, h5netcdf takes the dimension's size from it alone; without, it asks every column for
        # its length, again for every column.
        bounds = [max(most, chunk), *(None for _ in contents.columns)]
        datasets = [
            file.create_dataset(
                column.name, (0,), maxshape=(bound,), chunks=(chunk,), dtype="f8", fill_time="never"
            )
            for column, bound in zip(columns, bounds, strict=True)
        ]
        for component in contents.keeping:  # groups, which the file could not get later and be whole
            file.require_group(f"{END}/{component}")
        _describe(datasets, columns)  # after all heads, which stay small where they cannot grow
        return cls(disk, file, datasets)

    @classmethod
    def reopened(cls, path: Path, contents: Contents) -> Table:
        """The one at `path`, as it was committed last."""
        disk = OrderedFile(path, new=False)
        file = _file(disk, "r+")
        return cls(disk, file, [file[TIME], *(file[column.name] for column in contents.columns)])

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

    def close(self) -> None:
        """Commit what was added, unless something failed, and close the file."""
        self._file.close()
        try:
            if not self._broken:
                self._disk.commit()
        finally:
            self._disk.close()


def _file(disk: OrderedFile, mode: str) -> h5py.File:
    return h5py.File(disk, mode, libver=VERSION, rdcc_nbytes=0, **ALIGNED)  # no cache of chunks


def _describe(datasets: Sequence[h5py.Dataset], columns: Sequence[Column]) -> None:
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
