"""A rotor file's [superelement]: matrices of the whole rotor in one plane, as blocks of numbers in SI.

    [superelement]
    positions = "0 0.05 0.1 0.15"    # m, of the nodes
    mass = \"\"\"                       # row, column, value; those on the diagonal and below it
    1 1 0.58
    2 1 0.0041
    ...\"\"\"
    stiffness, gyroscopic            # likewise
    shapes                           # row, column, value

Rows and columns of mass, stiffness and gyroscopic (the polar matrix, of inertias about the axis) count
from 1; they are the deflection (m) and the slope dx/dz of node after node. With `shapes` they are other
coordinates, modes for example, and the rows of shapes, deflection and slope of node after node, say how
each of them moves the nodes. The rotor is free: with the first two coordinates held it has no rigid motion
left. Without mass the coordinates are mass-normalised.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from touchdown.modelkit.model import ModelError
from touchdown.rotor.beams.superelement import MOST_COORDINATES, Superelement, checked
from touchdown.rotor.file.table import RotorFileError, Table

FIELDS = ("positions", "mass", "stiffness", "gyroscopic", "shapes")
ENTRY = ("row", "column", "value")


def superelement_of(t: Table) -> Superelement:
    """What the table says. Raises RotorFileError where a number is none, or it is not a free rotor."""
    t.only(*FIELDS)
    positions = _numbers(t, "positions")
    own = 2 * len(positions)
    if own > 2 * MOST_COORDINATES:
        raise t.error("positions", f"are {len(positions)}; at most {MOST_COORDINATES} nodes are possible")
    shapes = _entries(t, "shapes") if "shapes" in t.values else None
    n = own if shapes is None else int(np.max(shapes[:, 1], initial=0.0))
    given = {name: _symmetric(t, name, n) for name in FIELDS[1:4] if name in t.values or name != "mass"}
    body = Superelement(
        positions,
        given.get("mass", np.eye(n)),
        given["stiffness"],
        given["gyroscopic"],
        None if shapes is None else _filled(t, "shapes", shapes, (own, n)),
    )
    try:
        return checked(body)
    except ModelError as error:
        raise RotorFileError(f"{t.file}: superelement: {error}") from None


def _numbers(t: Table, name: str) -> np.ndarray:
    """All numbers of a block, one after the other."""
    text = t.text(name)
    try:
        numbers = np.array(text.split(), dtype=float)
    except ValueError as error:
        raise RotorFileError(f"{t.file}: {t.path(name)}: {error}; write a block of numbers in SI") from None
    if not np.all(np.isfinite(numbers)):
        raise RotorFileError(f"{t.file}: {t.path(name)} holds what is no finite number")
    return numbers


def _entries(t: Table, name: str) -> np.ndarray:
    """Rows, columns and values of a matrix (entries, 3), rows and columns from 1."""
    numbers = _numbers(t, name)
    if len(numbers) % len(ENTRY):
        raise t.error(name, f"holds {len(numbers)} numbers; write three for each entry: {', '.join(ENTRY)}")
    entries = numbers.reshape(-1, len(ENTRY))
    places = entries[:, :2]
    if np.any(places != np.round(places)) or np.any(places < 1.0):
        raise t.error(name, "has an entry whose row or column is no whole number from 1 on")
    if len(np.unique(places, axis=0)) < len(places):
        raise t.error(name, "has two entries at one place")
    if np.any(places[:, 1] > MOST_COORDINATES):
        raise t.error(name, f"has more than {MOST_COORDINATES} columns, which is the most that is possible")
    return entries


def _filled(t: Table, name: str, entries: np.ndarray, size: tuple[int, int]) -> np.ndarray:
    """The matrix of all entries, zero elsewhere."""
    matrix = np.zeros(size)
    rows, columns = (entries[:, i].astype(int) - 1 for i in (0, 1))
    if np.any(rows >= size[0]) or np.any(columns >= size[1]):
        raise t.error(name, f"has an entry beyond its {size[0]} rows and {size[1]} columns")
    matrix[rows, columns] = entries[:, 2]
    return matrix


def _symmetric(t: Table, name: str, n: int) -> np.ndarray:
    """A symmetric matrix (n, n) of the entries on and below its diagonal."""
    entries = _entries(t, name)
    if np.any(entries[:, 1] > entries[:, 0]):
        raise t.error(name, "has an entry above the diagonal; write those on it and below")
    lower = _filled(t, name, entries, (n, n))
    return lower + np.tril(lower, -1).T


def superelement_lines(body: Superelement) -> Iterator[str]:
    """The table for a superelement, from which an equal one is read."""
    yield "\n[superelement]"
    yield f'positions = "{" ".join(map(repr, body.positions.tolist()))}"'
    for name, matrix in (
        ("mass", np.tril(body.mass_matrix)),
        ("stiffness", np.tril(body.stiffness_matrix)),
        ("gyroscopic", np.tril(body.polar_matrix)),
        ("shapes", body.shapes),
    ):
        if matrix is not None:
            rows, columns = np.nonzero(matrix)
            yield f'{name} = """'
            values = matrix[rows, columns].tolist()
            yield from (f"{i + 1} {j + 1} {v!r}" for i, j, v in zip(rows, columns, values, strict=True))
            yield '"""'
