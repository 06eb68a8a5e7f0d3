"""Rotors as arrays: in a NumPy archive (.npz), in a folder of matrices, or a mapping in Python.

A folder holds M.mtx, K.mtx, G.mtx, if there is one C.mtx (Matrix Market), or any of them as .hb
(Harwell-Boeing, as HBMAT of ANSYS writes it), and nodes.csv, whose header is

    node, x [mm], y [mm], z [mm]

with a row for each node, and dofs.csv with the header `node, dof` and a row for each row of the matrices,
or with the header `dof` and a row for each degree of freedom of a node, the same at all of them.
"""

from __future__ import annotations

import csv
import math
import zipfile
from collections.abc import Mapping, Sequence
from io import StringIO
from pathlib import Path
from typing import Any

import numpy as np

from ...modelkit.units import UnitError, to_si
from ..beams.shaft import Shaft
from .matrices import of_matrices
from .modal import of_modes
from .tables import ImportedRotorError, named, separator, text_of

ARCHIVE = ".npz"


def of_arrays(data: Mapping[str, Any], file: str, title: str) -> Shaft:
    """The rotor that arrays by name describe: matrices, or modal data. Raises ImportedRotorError.

    `file` is what to call them in messages. Which arrays there are, and their units:
    `rotor.imports.matrices` and `rotor.imports.modal`.
    """
    if "M" in data or "K" in data:
        return of_matrices(data, file, title)
    if "frequencies" in data:
        return of_modes(data, file, title)
    there = ", ".join(map(str, data)) or "nothing"
    raise ImportedRotorError(
        f"{file}: holds neither matrices (M, K, G) nor modal data (frequencies, deflections, slopes); "
        f"there are: {there}"
    )


def from_archive(path: Path) -> Shaft:
    """The rotor in a NumPy archive. Raises ImportedRotorError."""
    return of_arrays(read_archive(path), str(path), path.stem)


def read_archive(path: Path) -> dict[str, Any]:
    """The arrays of a NumPy archive by name. Raises ImportedRotorError."""
    try:
        with np.load(path, allow_pickle=False) as archive:
            return {name: archive[name] for name in archive.files}
    except OSError as error:
        raise ImportedRotorError(f"{path}: cannot be read: {error.strerror or error}") from None
    except (ValueError, AttributeError, EOFError, zipfile.BadZipFile, MemoryError) as error:
        raise ImportedRotorError(
            f"{path}: cannot be read: {error}; write it by numpy.savez, of numbers and texts"
        ) from None


def from_folder(folder: Path) -> Shaft:
    """The rotor in a folder of Matrix Market files. Raises ImportedRotorError."""
    return of_matrices(read_folder(folder, ("M", "K", "G")), str(folder), folder.name)


def read_folder(folder: Path, needed: Sequence[str]) -> dict[str, Any]:
    """Matrices (`needed`, and C), nodes, coordinates and dofs of a folder. Raises ImportedRotorError."""
    data: dict[str, Any] = {}
    for name in dict.fromkeys((*needed, "C")):
        read = {".mtx": _market, ".hb": _harwell_boeing}
        there = [folder / f"{name}{suffix}" for suffix in read if (folder / f"{name}{suffix}").is_file()]
        if there:
            data[name] = read[there[0].suffix](there[0])
        elif name in needed:
            listed = f"{', '.join(needed[:-1])} and {needed[-1]}"
            raise ImportedRotorError(f"{folder}: has no {name}.mtx, nor {name}.hb; there must be {listed}")
    data["nodes"], data["coordinates"] = _nodes(folder / "nodes.csv")
    data["dofs"] = _dofs(folder / "dofs.csv")
    return data


def _market(path: Path) -> np.ndarray:
    """A matrix, full (n, n)."""
    from scipy import io, sparse

    try:
        found: Any = io.mmread(path)
    except (OSError, ValueError, OverflowError, MemoryError) as error:
        raise ImportedRotorError(
            f"{path}: cannot be read: {error}; it must be Matrix Market text"
        ) from None
    return found.toarray() if sparse.issparse(found) else np.asarray(found)


def _harwell_boeing(path: Path) -> np.ndarray:
    """A matrix, full (n, n). Of a symmetric one there is the lower triangle, which SciPy does not read."""
    from scipy import io

    try:
        lines = path.read_text(encoding="latin-1").splitlines(keepends=True)
        kind = lines[2][:3].upper()
        lines[2] = f"{kind[0]}U{kind[2:]}{lines[2][3:]}"
        found = np.asarray(io.hb_read(StringIO("".join(lines))).toarray())
    except (OSError, ValueError, IndexError, OverflowError, MemoryError) as error:
        raise ImportedRotorError(
            f"{path}: cannot be read: {error}; it must be real, assembled Harwell-Boeing text"
        ) from None
    if kind[1] != "S":
        return found
    return found + np.tril(found, -1).T


def _nodes(path: Path) -> tuple[np.ndarray, np.ndarray]:
    """Names (N,) and coordinates (N, 3), m, of the nodes."""
    head, *rows = _table(path)
    columns = [_column(path, name) for name in head]
    if sorted(name for name, _ in columns) != ["node", "x", "y", "z"]:
        raise ImportedRotorError(
            f"{path}: has the columns {', '.join(head)}; it needs node, x, y and z, lengths with their "
            "unit as in x [mm]"
        )
    names, places = [], []
    for number, row in enumerate(rows, 2):
        cells = dict(zip((name for name, _ in columns), row, strict=True))
        units = dict(columns)
        names.append(cells["node"])
        places.append([_length(cells[a], units[a], f"{path}, row {number}: {a}") for a in "xyz"])
    return np.array(names), np.array(places)


def _column(path: Path, text: str) -> tuple[str, str]:
    """Name and unit of a column."""
    name, unit = named(text)
    name = name.lower()
    if name in ("x", "y", "z") and not unit:
        raise ImportedRotorError(f"{path}: the column {text} has no unit; write {name} [mm], for example")
    return name, unit


def _length(text: str, unit: str, where: str) -> float:
    try:
        value = to_si(f"{text} {unit}", "m", where)
    except UnitError as error:
        raise ImportedRotorError(str(error)) from None
    if not math.isfinite(value):
        raise ImportedRotorError(f"{where} = {text} is no finite number")
    return value


def _dofs(path: Path) -> np.ndarray:
    """(n, 2) node and degree of freedom of each row; or (d,), those of each node."""
    head, *rows = _table(path)
    names = [name.lower() for name in head]
    if names == ["dof"]:
        return np.array([row[0] for row in rows])
    if names != ["node", "dof"]:
        raise ImportedRotorError(
            f"{path}: has the columns {', '.join(head)}; it needs node and dof, or dof"
        )
    return np.array(rows)


def _table(path: Path) -> list[list[str]]:
    """Header and rows of a .csv, all as long as the header."""
    lines = [
        line for line in text_of(path).splitlines() if line.strip(" ,;\t") and not line.startswith("#")
    ]
    if len(lines) < 2:
        raise ImportedRotorError(f"{path}: has no row below its header")
    parted = csv.reader(lines, delimiter=separator(lines[0]))
    rows = [[cell.strip() for cell in row] for row in parted]
    for number, row in enumerate(rows, 1):
        if len(row) != len(rows[0]):
            raise ImportedRotorError(
                f"{path}, row {number}: has {len(row)} cells, the header {len(rows[0])}"
            )
    return rows
