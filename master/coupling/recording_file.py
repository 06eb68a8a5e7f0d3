"""An HDF5 file that is netCDF-4 as well, and whole at every moment.

HDF5 changes its file in many small writes, and between two of them it is broken. Here they are held, and
reach the disk at `commit`, in an order of which every beginning is a whole file: what is new lies where
nothing leads to yet; then the heads of the datasets change, one write each, which say how long these are. A
process that is killed at any moment leaves the rows of its last commit, and a full disk never fails HDF5.
(Power that fails is not in this: nothing waits for the disk.)
"""

from __future__ import annotations

import io
import math
import os
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from itertools import pairwise
from pathlib import Path
from typing import BinaryIO, NamedTuple

import h5py
import numpy as np

from ...modelkit.kernel.writing import open_in_place

SUPERBLOCK = 0  # its address: it says how much of the file counts
HEAD = b"OHDR"  # begins the head of an object
INDEX = b"TREE"  # begins an index of chunks
PAGE = 4096


class OrderedFile:
    """The file of a descriptor, which it closes at the end, as h5py takes a file object."""

    def __init__(self, descriptor: int) -> None:
        self.last: int | None = None  # address of the head that changes last of all
        self._descriptor = descriptor
        self._held: dict[int, bytearray] = {}  # by address, in the order in which they came
        self._on_page: dict[int, set[int]] = {}  # addresses of what is held, by the pages it lies on
        self._at = 0
        self._size = os.fstat(self._descriptor).st_size  # as HDF5 sees it
        self._committed = self._size  # on the disk

    # -- as HDF5 sees it -------------------------------------------------------------------------------

    def seek(self, offset: int, whence: int = io.SEEK_SET) -> int:
        """Go to an address."""
        self._at = offset + (self._size if whence == io.SEEK_END else 0)
        return self._at

    def tell(self) -> int:
        """The address."""
        return self._at

    def read(self, count: int) -> bytes:
        """The bytes there, held or on the disk; zeros beyond."""
        found = bytearray(os.pread(self._descriptor, count, self._at).ljust(count, b"\0"))
        for address, first, end in self._shared(count):
            part = self._held[address][first - address : end - address]
            found[first - self._at : end - self._at] = part
        return bytes(found)

    def write(self, data: bytes) -> int:
        """Hold it; what was held of the same place is this now, whichever goes to the disk first."""
        longer = self._held.pop(self._at, bytearray())[len(data) :]  # it waits anew
        for address, first, end in self._shared(len(data)):
            part = data[first - self._at : end - self._at]
            self._held[address][first - address : end - address] = part
        self._held[self._at] = bytearray(data) + longer
        for page in _pages(self._at, len(data) + len(longer)):
            self._on_page.setdefault(page, set()).add(self._at)
        self._size = max(self._size, self._at + len(data))
        return len(data)

    def _shared(self, count: int) -> Iterator[tuple[int, int, int]]:
        """The held part of the `count` bytes from here: addresses, each with its beginning and end."""
        near = [self._on_page.get(page, ()) for page in _pages(self._at, count)]
        for address in set[int]().union(*near) & self._held.keys():
            first = max(address, self._at)
            end = min(address + len(self._held[address]), self._at + count)
            if first < end:
                yield address, first, end

    def truncate(self, size: int) -> int:
        """Hold the size."""
        self._size = size
        return size

    def flush(self) -> None:
        """HDF5 does not know what may be on the disk; `commit` does it."""

    # -- the disk --------------------------------------------------------------------------------------

    def commit(self) -> None:
        """Bring to the disk what is held. Raises OSError where it cannot; the file is whole then, too."""
        before, self._committed = self._committed, max(self._committed, self._size)
        counted = False  # whether what is new may be of the file already
        try:
            if self._committed > before:
                os.ftruncate(self._descriptor, self._committed)
            for address, data in sorted(
                self._pieces(before), key=lambda piece: self._write_order(before, *piece)
            ):
                counted |= address == SUPERBLOCK
                self._put(address, data)
        except OSError:
            if not counted:
                self._committed = before
                with suppress(OSError):
                    os.ftruncate(self._descriptor, before)  # gives back the room, for the summary
            raise
        self._held.clear()
        self._on_page.clear()

    def _pieces(self, end: int) -> list[tuple[int, bytearray]]:
        """The held pieces, cut at `end`, and an index within that by pages."""
        pieces: list[tuple[int, bytearray]] = []
        for address, data in self._held.items():
            cuts = {0, len(data)}
            if address < end < address + len(data):
                cuts.add(end - address)
            if address < end and data.startswith(INDEX):
                cuts.update(page * PAGE - address for page in _pages(address, len(data))[1:])
            ordered = sorted(cuts)
            parts = [(address + a, data[a:b]) for a, b in pairwise(ordered)]
            pieces += reversed(parts)  # of an index, how many entries it has comes first: after them
        return pieces

    def _write_order(self, end: int, address: int, data: bytearray) -> int:
        """When a piece goes to the disk, where the file had `end` bytes; those of one turn as they came."""
        if address >= end:
            return 0
        if address == SUPERBLOCK:
            return 1
        if address == self.last:
            return 4
        return 3 if data.startswith(HEAD) else 2

    def _put(self, address: int, data: bytearray) -> None:
        """Write all of it: a disk that runs full takes a part first."""
        view = memoryview(data)
        while view:
            done = os.pwrite(self._descriptor, view, address)
            view, address = view[done:], address + done

    def close(self) -> None:
        """Let go of the file; what is still held is lost."""
        os.close(self._descriptor)


def _pages(address: int, count: int) -> range:
    """Numbers of the pages that `count` bytes lie on."""
    return range(address // PAGE, (address + count - 1) // PAGE + 1)


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
    """The contents of a table."""

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
    def created(cls, file: BinaryIO, contents: Contents, most: int) -> Table:
        """A new one for up to `most` rows in an empty file."""
        chunk = max(CHUNK, math.ceil(most / CHUNKS))
        disk = OrderedFile(os.dup(file.fileno()))
        tree = _file(disk, "w")
        tree.attrs.update(contents.heading)
        columns = [Column(TIME, "s", "time from the scene's zero"), *contents.columns]
        # With a bound, h5netcdf takes the dimension's size from it alone; without, it asks every column for
        # its length, again for every column.
        bounds = [max(most, chunk), *(None for _ in contents.columns)]
        datasets = [
            tree.create_dataset(
                column.name, (0,), maxshape=(bound,), chunks=(chunk,), dtype="f8", fill_time="never"
            )
            for column, bound in zip(columns, bounds, strict=True)
        ]
        for component in contents.keeping:  # groups, which the file could not get later and be whole
            tree.require_group(f"{END}/{component}")
        _describe(datasets, columns)  # after all heads, which stay small where they cannot grow
        return cls(disk, tree, datasets)

    @classmethod
    def reopened(cls, path: Path, contents: Contents) -> Table:
        """The one at `path`, as it was committed last."""
        disk = OrderedFile(open_in_place(path, os.O_RDWR))
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
