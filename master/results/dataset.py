"""A recording as an xarray.Dataset that reads from its file what is looked at, when it is."""

from __future__ import annotations

import numpy as np
import xarray
from xarray.backends import BackendArray
from xarray.core import indexing

from .recording import Recording


def run_dataset(recording: Recording) -> xarray.Dataset:
    """Columns named COMPONENT.VARIABLE over `time` (s), with units and long_name; what was run.

    The file stays open, and there, for as long as anything of it is in use.
    """
    columns = {name: _column(recording, name) for name, _ in recording.columns()}
    time = xarray.Variable("time", recording.time, recording.about_column("time"))
    return xarray.Dataset(columns, {"time": time}, recording.about())


def _column(recording: Recording, name: str) -> xarray.Variable:
    cached = indexing.MemoryCachedArray(indexing.LazilyIndexedArray(_Column(recording, name)))
    return xarray.Variable("time", cached, recording.about_column(name))


class _Column(BackendArray):
    """A column in its file. A pickled one carries its values, and needs no file."""

    def __init__(self, recording: Recording, name: str) -> None:
        self._recording = recording
        self._name = name
        self.shape = recording.time.shape
        self.dtype = np.dtype(float)

    def __deepcopy__(self, memo: object) -> _Column:
        """Itself: it does not change."""
        return self

    def __reduce__(self) -> tuple[type, tuple[np.ndarray]]:
        return indexing.NumpyIndexingAdapter, (self._recording.as_read(self._name),)

    def __getitem__(self, key: indexing.ExplicitIndexer) -> np.ndarray:
        return indexing.explicit_indexing_adapter(
            key, self.shape, indexing.IndexingSupport.BASIC, self._recording.as_read(self._name).__getitem__
        )
