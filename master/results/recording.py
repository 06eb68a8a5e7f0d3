"""A run's recording, read back."""

from __future__ import annotations

import os
import stat
from collections.abc import Callable, Generator
from contextlib import contextmanager
from pathlib import Path
from typing import Any
from urllib.parse import unquote

import h5py
import numpy as np

from ..common.errors import TouchdownError
from ..coupling.recording_file import END, NAMES, OTHERS, TIME, ZERO, link_name

INSTANTS = (  # variables that keep when something happened, on the simulation's clock; below zero: never
    *("first_time", "over_time", "sync_time", "contact_time", "stop_time", "commanded_time"),
    *("captured_time", "failed_time", "back_time", "locked_time"),
    *("peak_bending_time", "peak_shear_time", "kept_time"),
)
CONTRACT_INSTANTS = ("contact.first_time", "ring.sync_time")  # of them, what third-party FMUs give


class NotRecordedError(TouchdownError):
    """A column that a run did not record."""


class Recording:
    """A recorded run, read back from the file at `path`; `owner` is kept while the file is read.

    It stays that run's where another is recorded there later, or the file goes. Raises TouchdownError where
    there is no file, or it cannot be read.
    """

    def __init__(self, path: Path, owner: object = None) -> None:
        self._path = path.absolute()
        self._owner = owner
        with _reading(path):
            found = os.stat(path)
            if not stat.S_ISREG(found.st_mode):
                raise OSError("it is a pipe or a device")
            self._age = found.st_mtime_ns
            self._file = h5py.File(path, "r")
            if elsewhere := self._file.id.links.visit(_leading_elsewhere, info=True):
                raise ValueError(f"{elsewhere} is a link, which is not followed")
            self._encoded = NAMES in self._file.attrs
            times = np.asarray(_numbers(self._file[TIME]))
            unknown = np.isnan(times)  # of a run that goes on, or was killed: room for more rows
            self._room = len(times)
            self._rows = int(unknown.argmax()) if unknown.any() else len(times)
            self.time = times[: self._rows]
            if not self._rows:
                raise ValueError("it has no rows; the run ended before the first")
            if not (np.isfinite(self.time).all() and (np.diff(self.time) > 0.0).all()):
                raise ValueError("its times do not follow each other")

    def __contains__(self, name: str) -> bool:
        return self._dataset(name) is not None

    def _dataset(self, name: str) -> h5py.Dataset | None:
        """The dataset of COMPONENT.VARIABLE; None where there is none."""
        with _reading(self._path):
            found = self._file.get(self._key(name))
            return _numbers(found, self._room) if isinstance(found, h5py.Dataset) else None

    def __deepcopy__(self, memo: object) -> Recording:
        """Itself: it does not change."""
        return self

    def __reduce__(self) -> tuple[Callable[[Path, int], Recording], tuple[Path, int]]:
        """Pickled as its path; unpickled where that is still this run's."""
        if self._owner is not None:
            raise TouchdownError(
                "a result in a temporary folder cannot be pickled; give the run a folder to keep it in"
            )
        return _reopened, (self._path, self._age)

    def __getitem__(self, name: str) -> np.ndarray:
        """Values of COMPONENT.VARIABLE. Raises NotRecordedError where there are none."""
        dataset = self._dataset(name)
        if dataset is None:
            raise NotRecordedError(f"{name} was not recorded; see run.record")
        with _reading(self._path):
            return np.asarray(dataset[: self._rows])

    def as_read(self, name: str) -> np.ndarray:
        """The same, but instants count as `time` does, from the scene's zero; NaN: not yet."""
        values = self[name]
        component, _, variable = name.partition(".")
        if variable.rpartition(".")[2] not in INSTANTS:
            return values
        with _reading(self._path):
            others = str(self._file.attrs.get(OTHERS, "")).split(", ")
            if component in others and variable not in CONTRACT_INSTANTS:
                return values
            zero = float(self._file.attrs.get(ZERO, 0.0))  # none in files of earlier versions
        return np.where(values < 0.0, np.nan, values - zero)

    def at_end(self, name: str) -> float:
        """Last value of COMPONENT.VARIABLE, also of an array's element. Raises NotRecordedError."""
        component, _, variable = name.partition(".")
        with _reading(self._path):
            group = self._file.get(f"{END}/{component}")
            if isinstance(group, h5py.Group) and variable in group.attrs:
                return float(np.asarray(group.attrs[variable]))
        return float(self[name][-1])

    def columns(self) -> list[tuple[str, str]]:
        """(COMPONENT.VARIABLE, unit) of everything recorded."""
        columns: list[tuple[str, str]] = []
        with _reading(self._path):
            for component, group in self._file.items():
                if isinstance(group, h5py.Group) and component != END:
                    columns += [
                        (f"{component}.{unquote(name) if self._encoded else name}", str(d.attrs["units"]))
                        for name, d in group.items()
                        if isinstance(d, h5py.Dataset)  # earlier versions made groups of a / in a name
                    ]
        return columns

    def about(self) -> dict[str, object]:
        """The attributes of the run: title, scene, version, scheme, macro_step_s."""
        with _reading(self._path):
            return {key: _plain(value) for key, value in self._file.attrs.items() if key != NAMES}

    def about_column(self, name: str) -> dict[str, object]:
        """Of `time` or COMPONENT.VARIABLE: units and long_name."""
        with _reading(self._path):
            attributes = self._file[self._key(name)].attrs
            return {key: _plain(attributes[key]) for key in ("units", "long_name")}

    def _key(self, name: str) -> str:
        component, dot, variable = name.partition(".")
        link = link_name(variable) if self._encoded else variable
        return f"{component}/{link}" if dot else component

    def close(self) -> None:
        """Close the file."""
        self._file.close()


def _reopened(path: Path, age: int) -> Recording:
    """The recording at `path`, which was written at `age` (ns)."""
    recording = Recording(path)
    if recording._age != age:
        recording.close()
        raise TouchdownError(f"{path} is of another run by now; run this one into a folder of its own")
    return recording


@contextmanager
def _reading(path: Path) -> Generator[None]:
    """Raise TouchdownError where the file at `path` cannot be read; h5py raises any of these."""
    try:
        yield
    except (OSError, RuntimeError, KeyError, ValueError, TypeError, AttributeError, MemoryError) as error:
        raise TouchdownError(f"cannot read {path}: {' '.join(str(error).split())}") from None


def _leading_elsewhere(name: bytes, link: Any) -> str | None:
    """The name of a link that leads out of the file, or to another name in it; None of any other."""
    return None if link.type == h5py.h5l.TYPE_HARD else repr(name.decode(errors="replace"))


def _numbers(dataset: h5py.Dataset, room: int | None = None) -> h5py.Dataset:
    """A column, as a run writes it. Raises ValueError for another, such as one whose rows lie elsewhere."""
    plan = dataset.id.get_create_plist()
    whole = plan.get_external_count() == 0 and plan.get_layout() == h5py.h5d.CONTIGUOUS
    if not (whole and dataset.dtype.kind == "f" and dataset.ndim == 1):
        raise ValueError(f"{dataset.name} is not a column of numbers in this file")
    if dataset.id.get_storage_size() < dataset.nbytes or len(dataset) != (room or len(dataset)):
        raise ValueError(f"{dataset.name} has not as many rows as there are times")
    return dataset


def _plain(value: object) -> object:
    """An attribute as Python's own text or number."""
    return value.item() if isinstance(value, np.generic) else value
