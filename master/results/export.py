"""A recording as a file of other programs: a column for each variable, its unit in the head; SI."""

from __future__ import annotations

import re
from collections.abc import Callable
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, BinaryIO

import numpy as np

from ...modelkit.errors import require
from ...modelkit.kernel.writing import replacing
from ..common.errors import one_of
from ..common.files import make_writable, writing_to
from ..coupling.recording_file import TIME
from ..scene.scene import Scene
from .result import Result

if TYPE_CHECKING:
    import pandas

MAX_SHEET = 1_048_576, 16_384  # rows and columns of a sheet, with its heads
MAX_MAT_NAME = 63  # characters of a name in MATLAB
HEADS = "heads"  # of the columns, in a .mat


def _to_sheet(frame: pandas.DataFrame, file: BinaryIO) -> None:
    shape = frame.shape[0] + 1, frame.shape[1] + 1
    require(
        shape[0] <= MAX_SHEET[0] and shape[1] <= MAX_SHEET[1],
        f"the recording has {shape[0] - 1} rows and {shape[1]} columns, more than a sheet of xlsx holds; "
        "take parquet, mat or csv, or run it with a larger run.record_every",
    )
    frame.to_excel(file, engine="openpyxl")


def _to_mat(frame: pandas.DataFrame, file: BinaryIO) -> None:
    """A vector for each column, called as MATLAB allows; `heads` has these names beside whole ones."""
    from scipy.io import savemat

    columns: dict[str, np.ndarray] = {}
    whole = frame.reset_index()
    for head in whole:
        name = TIME if head == frame.index.name else head.rpartition(" [")[0]
        called = re.sub(r"\W+", "_", name, flags=re.ASCII)[: MAX_MAT_NAME - 4].strip("_")
        called = called if called[:1].isalpha() else f"x{called}"
        while called in (*columns, HEADS):
            called += "_"
        columns[called] = whole[head].to_numpy()
    heads = np.array(list(zip(columns, whole, strict=True)), object)
    savemat(file, {**columns, HEADS: heads}, do_compression=True, oned_as="column")


WRITERS: dict[str, tuple[Callable[[pandas.DataFrame, BinaryIO], None], str]] = {  # and what it takes
    "csv": (lambda frame, file: frame.to_csv(file), ""),
    "xlsx": (_to_sheet, "openpyxl"),
    "mat": (_to_mat, ""),
    "parquet": (lambda frame, file: frame.to_parquet(file, engine="pyarrow"), "pyarrow"),
}


def _clock(scene: Scene) -> str:
    """Head of the column of times, which says from what they count, instants in other columns too."""
    return "time [s]" if scene.zero is None else f"time from {scene.zero} [s]"


def export(result: Result, path: Path, to: str) -> Path:
    """Write all that was recorded to `path`, in the format `to`; returns it. Raises TouchdownError."""
    require(to in WRITERS, f"there is no export to {to!r}; {one_of(to, WRITERS)}")
    write, library = WRITERS[to]
    require(
        not library or find_spec(library) is not None,
        f"{to} takes {library}, which is not installed: pip install {library}; or take csv or mat",
    )
    make_writable(path.parent)
    frame = result.to_pandas()
    units = {"time": "s"} | frame.attrs["units"]
    frame = frame.rename(columns=lambda name: f"{name} [{units[name]}]").rename_axis(_clock(result.scene))
    with writing_to(path.parent), replacing(path) as file:
        write(frame, file)
    return path
