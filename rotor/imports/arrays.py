"""Rotors as arrays (docs/rotors.md): in a NumPy archive, in a folder of matrices, or a mapping."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np

from ...modelkit.archives import refuse_large
from ...modelkit.errors import TouchdownError, require
from ...modelkit.reader import TEXT, content_of, key, kinds, number
from ...modelkit.sheets import rows
from ..beams.shaft import Shaft
from .harwell_boeing import MAPPING, MATRIX, read_mapping, read_matrix
from .matrices import of_matrices
from .modal import of_modes


@dataclass(frozen=True)
class _Node:
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


def from_folder(folder: Path) -> Shaft:
    """The rotor in a folder of matrices. Raises TouchdownError."""
    return of_matrices(read_folder(folder, ("M", "K", "G")), str(folder), folder.name)


def read_folder(folder: Path, needed: Sequence[str]) -> dict[str, Any]:
    """Matrices (`needed`, and C), nodes, coordinates and dofs of a folder. Raises TouchdownError."""
    data: dict[str, Any] = {}
    for name in dict.fromkeys((*needed, "C")):
        named = [path for path in sorted(folder.glob(f"{name}.*")) if path.stem == name]
        there = [path for path in named if path.suffix.lower() in MATRICES]
        require(len(there) <= 1, f"{folder}: has {' and '.join(path.name for path in there)}; leave one")
        if there:
            data[name] = MATRICES[there[0].suffix.lower()](there[0])
        elif name in needed:
            files = " or ".join(f"{name}{ending}" for ending in MATRICES)
            listed = f"{', '.join(needed[:-1])} and {needed[-1]}"
            raise TouchdownError(f"{folder}: has no {files}; there must be {listed}")
    columns = {name: kind.unit for name, kind in kinds(_Node).items()}
    nodes = [r.read(_Node) for r in rows(folder / "nodes.csv", columns, (*columns,), {"knoten": "node"})]
    data["nodes"] = np.array([node.node for node in nodes])
    data["coordinates"] = np.array([(node.x, node.y, node.z) for node in nodes])
    mapped = [path for path in sorted(folder.iterdir()) if path.suffix.lower() == MAPPING]
    by_table = not mapped or (folder / "dofs.csv").exists()
    data["dofs"] = _dofs(folder / "dofs.csv") if by_table else read_mapping(mapped)
    return data


def _market(path: Path) -> np.ndarray:
    """A matrix, full (n, n)."""
    from scipy import io

    try:
        content = BytesIO(content_of(path, str(path)))
        refuse_large(8 * math.prod(io.mminfo(content)[:2]), f"{path} would fill")
        content.seek(0)
        found: Any = io.mmread(content)
        return found if isinstance(found, np.ndarray) else found.toarray()
    except (ValueError, OverflowError, MemoryError) as error:
        raise TouchdownError(f"{path}: cannot be read: {error}; it must be Matrix Market text") from None


MATRICES = {".mtx": _market, **dict.fromkeys(MATRIX, read_matrix)}


def _dofs(path: Path) -> np.ndarray:
    """(n, 2) node and degree of freedom of each row; or (d,), those of each node."""
    found = rows(path, {"node": "", "dof": ""}, ("dof",), {"knoten": "node", "freiheitsgrad": "dof"})
    names = ("node", "dof") if any("node" in row.values for row in found) else ("dof",)
    cells = np.array([[row.get(name, TEXT) for name in names] for row in found])
    return cells if len(names) == 2 else cells.ravel()
