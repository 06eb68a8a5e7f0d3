"""A run's recording, read back."""

from __future__ import annotations

import os
from collections.abc import Callable, Generator
from contextlib import contextmanager
from pathlib import Path

import h5py
import numpy as np

from ...modelkit.kernel.writing import replacing
from ..common.errors import TouchdownError
from ..coupling.recording_file import END, TIME


class NotRecordedError(TouchdownError):
    """A column that a run did not record."""


class Recording:
    """A recorded run, read back from the file at `path`; `owner` is kept for as long as it is read.

    It stays that run's where another is recorded there later, or the file goes. Raises TouchdownError where
    there is no file, or it cannot be read.
    """

    def __init__(self, path: Path, owner: object = None) -> None:
        self._path = path.absolute()
        self._owner = owner
        with _reading(path):
            self._file = h5py.File(path, "r")
            self._age = os.stat(path).st_mtime_ns
            times = np.asarray(self._file[TIME])
        unknown = np.isnan(times)  # of a run that goes on, or was killed: room for more rows
        self._rows = int(unknown.argmax()) if unknown.any() else len(times)
        self.time = times[: self._rows]

    def __contains__(self, name: str) -> bool:
        return self._dataset(name) is not None

    def _dataset(self, name: str) -> h5py.Dataset | None:
        """The dataset of COMPONENT.VARIABLE; None where there is none."""
        found = self._file.get(self._key(name))
        return found if isinstance(found, h5py.Dataset) else None

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

    def at_end(self, name: str) -> float:
        """Last value of COMPONENT.VARIABLE, also of an array's element. Raises NotRecordedError."""
        component, _, variable = name.partition(".")
        group = self._file.get(f"{END}/{component}")
        if isinstance(group, h5py.Group) and variable in group.attrs:
            return float(np.asarray(group.attrs[variable]))
        return float(self[name][-1])

    def columns(self) -> list[tuple[str, str]]:
        """(COMPONENT.VARIABLE, unit) of everything recorded."""
        columns: list[tuple[str, str]] = []
        for component, group in self._file.items():
            if isinstance(group, h5py.Group) and component != END:
                columns += [(f"{component}.{name}", str(d.attrs["units"])) for name, d in group.items()]
        return columns

    def about(self) -> dict[str, object]:
        """The attributes of the run: title, scene, version, scheme, macro_step_s."""
        return {key: _plain(value) for key, value in self._file.attrs.items()}

    def about_column(self, name: str) -> dict[str, object]:
        """Of `time` or COMPONENT.VARIABLE: units and long_name."""
        given = self._file[self._key(name)].attrs
        return {key: _plain(given[key]) for key in ("units", "long_name")}

    @staticmethod
    def _key(name: str) -> str:
        component, dot, variable = name.partition(".")
        return f"{component}/{variable}" if dot else component

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
    """Raise TouchdownError where the file at `path` cannot be read; h5py raises either of the two."""
    try:
        yield
    except (OSError, RuntimeError) as error:
        raise TouchdownError(f"cannot read {path}: {' '.join(str(error).split())}") from None


def _plain(value: object) -> object:
    """An attribute as Python's own text or number."""
    return value.item() if isinstance(value, np.generic) else value


def write_csv(recording: Recording, path: Path) -> None:
    """All columns with their units, full precision, true times."""
    columns = recording.columns()
    data = np.column_stack([recording.time, *(recording[name] for name, _ in columns)])
    header = ",".join(["time [s]", *(f"{name} [{unit}]" for name, unit in columns)])
    with replacing(path) as file:
        np.savetxt(file, data, delimiter=",", header=header, comments="", fmt="%.17g")
