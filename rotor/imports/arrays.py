"""Rotors as arrays (docs/rotors.md): in a NumPy archive, in a folder of matrices, or a mapping."""

from __future__ import annotations

import zipfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from io import StringIO
from pathlib import Path
from typing import Any

import numpy as np

from ...modelkit.errors import TouchdownError
from ...modelkit.reader import TEXT, key, kinds, number, rows
from ..beams.shaft import Shaft
from .matrices import of_matrices
from .modal import of_modes

ARCHIVE = ".npz"


@dataclass(frozen=True)
class Node:
    """A row of nodes.csv; coordinates in m."""

    node: str = key(TEXT)
    x: float = key(number("m"))
    y: float = key(number("m"))
    z: float = key(number("m"))


def of_arrays(data: Mapping[str, Any], file: str, title: str) -> Shaft:
    """The rotor that arrays by name describe: matrices, or modal data. Raises TouchdownError.

    `file` is what to call them in messages. Which arrays there are, and their units:
    `rotor.imports.matrices` and `rotor.imports.modal`.
    """
    if "M" in data or "K" in data:
        return of_matrices(data, file, title)
    if "frequencies" in data:
        return of_modes(data, file, title)
    there = ", ".join(map(str, data)) or "nothing"
    raise TouchdownError(
        f"{file}: holds neither matrices (M, K, G) nor modal data (frequencies, deflections, slopes); "
        f"there are: {there}"
    )


def read_archive(path: Path) -> dict[str, Any]:
    """The arrays of a NumPy archive by name. Raises TouchdownError."""
    try:
        with np.load(path, allow_pickle=False) as archive:
            return {name: archive[name] for name in archive.files}
    except OSError as error:
        raise TouchdownError(f"{path}: cannot be read: {error.strerror or error}") from None
    except (ValueError, AttributeError, EOFError, zipfile.BadZipFile, MemoryError) as error:
        raise TouchdownError(
            f"{path}: cannot be read: {error}; write it by numpy.savez, of numbers and texts"
        ) from None


def from_folder(folder: Path) -> Shaft:
    """The rotor in a folder of Matrix Market files. Raises TouchdownError."""
    return of_matrices(read_folder(folder, ("M", "K", "G")), str(folder), folder.name)


def read_folder(folder: Path, needed: Sequence[str]) -> dict[str, Any]:
    """Matrices (`needed`, and C), nodes, coordinates and dofs of a folder. Raises TouchdownError."""
    data: dict[str, Any] = {}
    for name in dict.fromkeys((*needed, "C")):
        read = {".mtx": _market, ".hb": _harwell_boeing}
        there = [folder / f"{name}{suffix}" for suffix in read if (folder / f"{name}{suffix}").is_file()]
        if there:
            data[name] = read[there[0].suffix](there[0])
        elif name in needed:
            listed = f"{', '.join(needed[:-1])} and {needed[-1]}"
            raise TouchdownError(f"{folder}: has no {name}.mtx, nor {name}.hb; there must be {listed}")
    columns = {name: kind.unit for name, kind in kinds(Node).items()}
    nodes = [row.read(Node) for row in rows(folder / "nodes.csv", columns, (*columns,))]
    data["nodes"] = np.array([node.node for node in nodes])
    data["coordinates"] = np.array([(node.x, node.y, node.z) for node in nodes])
    data["dofs"] = _dofs(folder / "dofs.csv")
    return data


def _market(path: Path) -> np.ndarray:
    """A matrix, full (n, n)."""
    from scipy import io, sparse

    try:
        found: Any = io.mmread(path)
    except (OSError, ValueError, OverflowError, MemoryError) as error:
        raise TouchdownError(f"{path}: cannot be read: {error}; it must be Matrix Market text") from None
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
        raise TouchdownError(
            f"{path}: cannot be read: {error}; it must be real, assembled Harwell-Boeing text"
        ) from None
    if kind[1] != "S":
        return found
    return found + np.tril(found, -1).T


def _dofs(path: Path) -> np.ndarray:
    """(n, 2) node and degree of freedom of each row; or (d,), those of each node."""
    found = rows(path, {"node": "", "dof": ""}, ("dof",))
    names = ("node", "dof") if any("node" in row.values for row in found) else ("dof",)
    cells = np.array([[row.get(name, TEXT) for name in names] for row in found])
    return cells if len(names) == 2 else cells.ravel()
