"""The Reference-FMUs of the Modelica Association, from a folder that the user names."""

from __future__ import annotations

import csv
import io
import os
import zipfile
from collections.abc import Sequence
from pathlib import Path

import fmpy
import numpy as np

from ..command.api.run import run
from ..master.scene.file import parse_scene
from .case import Row, UnavailableError

VARIABLE = "TOUCHDOWN_REFERENCE_FMUS"
RESULTS = "extra/org.fmi-standard.fmi-ls-ref/{}_out.csv"  # in an FMU, by its name
LEFT_OUT = ("Roberts",)  # holds the results of the bouncing ball


def _published(path: Path) -> dict[str, np.ndarray]:
    """An FMU's own results: time (s) and numbers by variable, a column for each element of an array."""
    with zipfile.ZipFile(path) as archive:
        name = RESULTS.format(path.stem)
        if path.stem in LEFT_OUT or name not in archive.namelist():
            return {}
        names, *lines = csv.reader(io.StringIO(archive.read(name).decode("utf-8")))
    columns: dict[str, np.ndarray] = {}
    for name, cells in zip(names, zip(*lines, strict=True), strict=True):
        try:
            columns[name] = np.array([[_number(word) for word in cell.split()] for cell in cells])
        except ValueError:
            continue  # a text
    return columns


def _number(word: str) -> float:
    """Of a cell. Raises ValueError for a text."""
    return float(word == "true") if word in ("true", "false") else float(word)


def _compared(path: Path) -> list[Row]:
    """A row for each number that an FMU has published results of; the time at which they differ most."""
    columns = _published(path)
    if not columns:
        return []
    times = columns.pop("time")[:, 0]
    version = fmpy.read_model_description(str(path), validate=False).fmiVersion[:1]
    steps = {"duration": float(times[-1]), "macro_step": float(np.diff(times).min()), "record_every": 1}
    scene = parse_scene({"run": steps, "components": {"m": {"fmu": str(path)}}}, path.stem, path.parent)
    data = run(scene).data
    rows: list[Row] = []
    for name, values in columns.items():
        for k, theirs in enumerate(values.T, start=1):
            key = f"{name}[{k}]" if values.shape[1] > 1 else name
            if np.any(theirs):
                ours = np.asarray(data.get(f"m.{key}", []))
                rows.append(_row(f"FMI {version} {path.stem}, {key}", theirs, ours))
    return rows


def _row(quantity: str, theirs: np.ndarray, ours: np.ndarray) -> Row:
    """Where both differ most; where they are equal, the last value that is not next to nothing."""
    count = min(len(theirs), len(ours))
    if count < len(theirs) - 1:  # it stopped before the end, or was not recorded; Stair ends a step early
        return Row(f"{quantity}, {count} of {len(theirs)}", "", float(len(theirs)), float("nan"))
    theirs, ours = theirs[:count], ours[:count]
    apart = np.abs(ours - theirs)
    large = np.flatnonzero(np.abs(theirs) > 1e-3 * np.max(np.abs(theirs)))
    worst = int(np.argmax(apart)) if np.any(apart) else int(large[-1])
    wrong = theirs[worst] == 0.0 != ours[worst]
    return Row(
        f"{quantity}, the worst of {count}",
        "",
        float(theirs[worst]),
        float("nan" if wrong else ours[worst]),
    )


def rows_in(folder: Path) -> list[Row]:
    """Rows of all FMUs in a folder and below. Raises `UnavailableError` where none holds results."""
    rows = [row for path in sorted(folder.rglob("*.fmu")) for row in _compared(path)]
    if not rows:
        raise UnavailableError(f"no FMU in {folder} holds published results ({RESULTS.format('NAME')})")
    return rows


def reference_fmus() -> Sequence[Row]:
    """Each FMU alone in a scene, at the macro step of its results; a variable that is 0 throughout makes no
    row. Stair ends its run a macro step early. Not run: Clocks (scheduled execution only), Roberts (it
    holds the bouncing ball's results)."""
    folder = os.environ.get(VARIABLE)
    if not folder:
        raise UnavailableError(f"set {VARIABLE} to a folder of Reference-FMUs")
    if not Path(folder).is_dir():
        raise UnavailableError(f"{VARIABLE} = {folder} is not a folder")
    return rows_in(Path(folder))
