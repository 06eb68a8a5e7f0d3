"""Matrices and their degrees of freedom as HBMAT of ANSYS writes them, and Harwell-Boeing text of others.

After a header of four lines, or five where there are right-hand sides, come pointers to columns, rows and
values: as many lines of each as the header says, in the Fortran formats that it names. Right-hand sides,
behind them, are left out. Of a symmetric matrix there is one triangle.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from scipy import sparse

from ...modelkit.archives import refuse_large
from ...modelkit.errors import TouchdownError
from ...modelkit.reader import content_of

MATRIX = ".hb", ".matrix"
MAPPING = ".mapping"  # beside them: equation, node and degree of freedom of each row
MIRRORED = {"S": 1.0, "H": 1.0, "Z": -1.0, "U": 0.0}  # kind: sign of the triangle that is not there
_FORMAT = re.compile(r"\([^()]*?(\d*)[IDEFG](\d+)", re.IGNORECASE)  # numbers of a line, and their width
_EXPONENT = re.compile(r"(?<=[\d.])[DE]?(?=[-+])|D", re.IGNORECASE)  # its letter; 3 digits may have none
_EQUATION = re.compile(r"\s*(\d+)\s+(\d+)\s+([A-Z]\w*)\s*", re.IGNORECASE)


def read_matrix(path: Path) -> np.ndarray:
    """The matrix in a file, full (n, n). Raises TouchdownError."""
    try:
        return _matrix(content_of(path, str(path)).decode("latin-1").splitlines())
    except (ValueError, IndexError, OverflowError, MemoryError) as error:
        raise TouchdownError(
            f"{path}: cannot be read: {error}; it must be a real, assembled matrix as Harwell-Boeing text "
            "(HBMAT of ANSYS: Form ASCII)"
        ) from None


def _matrix(lines: Sequence[str]) -> np.ndarray:
    cards = [*map(int, lines[1].split()), 0][1:5]  # lines of pointers, rows, values and right-hand sides
    kind, (n, columns, count) = lines[2][:3].upper(), map(int, lines[2][3:].split()[:3])
    if kind[0] != "R" or kind[1] not in MIRRORED or kind[2] != "A" or n != columns:
        raise ValueError(f"it is {kind}, {n} by {columns}")
    refuse_large(8 * n * n, f"its {n} rows would fill")
    line = 5 if cards[3] > 0 else 4
    parts: list[np.ndarray] = []
    sizes = (n + 1, count, count)
    for (per, width), size, length in zip(_FORMAT.findall(lines[3]), sizes, cards, strict=False):
        parts.append(_numbers(lines[line : line + length], int(per or 1), int(width), size))
        line += length
    pointers, rows, values = parts
    found = sparse.csc_array((values, rows.astype(int) - 1, pointers.astype(int) - 1), shape=(n, n))
    found.check_format(full_check=True)
    whole = found.toarray()
    above, below = np.triu(whole, 1), np.tril(whole, -1)
    if np.any(above) and np.any(below):
        return whole
    return whole + MIRRORED[kind[1]] * (above + below).T


def _numbers(lines: Sequence[str], per: int, width: int, size: int) -> np.ndarray:
    """Numbers (size,) of `width` characters each, at most `per` on a line; exponents may begin with D.

    SciPy writes other widths than it says, with blanks between; without blanks the widths hold.
    """
    texts = " ".join(lines).split()
    if len(texts) != size:
        texts = [
            line[i : i + width] for line in lines for i in range(0, min(per * width, len(line)), width)
        ]
    found = [float(_EXPONENT.sub("e", text)) for text in texts if text.strip()]
    if len(found) != size:
        raise ValueError(f"it holds {len(found)} of {size} numbers")
    return np.array(found)


def read_mapping(paths: Sequence[Path]) -> np.ndarray:
    """(n, 2) node and degree of freedom of each row, as all the files say. Raises TouchdownError."""
    found = [_mapping(path) for path in paths]
    for path, other in zip(paths, found, strict=True):
        if not np.array_equal(other, found[0]):
            raise TouchdownError(f"{path} and {paths[0].name} differ; write all matrices of one .full file")
    return found[0]


def _mapping(path: Path) -> np.ndarray:
    lines = content_of(path, str(path)).decode("latin-1").splitlines()
    rows: list[tuple[str, str]] = []
    for number, line in enumerate(lines, 1):
        match = _EQUATION.fullmatch(line)
        if match and int(match[1]) == len(rows) + 1:
            rows.append((match[2], match[3]))
        elif match or (rows and line.strip()):
            raise TouchdownError(f"{path}, line {number}: is not equation {len(rows) + 1}, node and DOF")
    if not rows:
        raise TouchdownError(f"{path}: has no line of equation, node and DOF, such as 1 1 UX")
    return np.array(rows)
