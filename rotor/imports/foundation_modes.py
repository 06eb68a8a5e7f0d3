"""Elastic modes of a foundation under touchdown bearings, from its matrices or from modal data.

Either way the foundation stands, without the carriers of its bearings. Matrices are as those of rotors
(`rotor.imports.matrices`) without G: M, K, nodes, dofs, units and, if there is one, C. Axes are those of
scenes: UX is horizontal, UY up, and the rotor lies along z. Modal data are arrays by name, for N nodes
and n modes, in SI:

    frequencies      (n,) Hz
    x, y             (N, n) deflections of the nodes
    nodes            (N,) their numbers or names; without, from 1
    modal_masses     (n,) kg; without them the shapes are mass-normalised, deflections in 1/kg^0.5
    damping_ratios   (n,) of critical; without them that which is asked for
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from scipy.linalg import eigh

from ...modelkit.archives import ARCHIVE, read_archive
from ...modelkit.errors import TouchdownError
from .arrays import read_folder
from .matrices import row_places, unit_of
from .named_arrays import Given

MODAL_FIELDS = "frequencies", "x", "y", "nodes", "modal_masses", "damping_ratios"
MATRIX_FIELDS = "M", "K", "C", "coordinates", "nodes", "dofs", "units"
SYMMETRY = 1e-6  # of the largest entry, by which matrices may differ across their diagonal
STILL = 1e-9  # of the largest deflection of any mode: what moves the seats by less is left out
ALIKE = 1e-6  # relative, by which deflections differ that are alike but for rounding
UX, UY = 0, 1


@dataclass(frozen=True)
class FoundationModes:
    """Of a foundation, the slowest first."""

    omega: np.ndarray  # (n,), rad/s
    damping_ratio: np.ndarray  # (n,)
    shape: np.ndarray  # (n, S, 2), x and y of the seats, mass-normalised, 1/kg^0.5
    left_out: float | None  # of what a seat gives way by at rest, the part of other modes; None: not known


def read_foundation(path: Path, seats: Mapping[str, str], most: int, ratio: float) -> FoundationModes:
    """Of a foundation in an archive (.npz) or a folder of matrices, at most `most` that move its seats.

    seats: the node of each by name. ratio: of critical damping, where the file tells none. Raises
    TouchdownError.
    """
    if path.is_dir():
        return of_foundation(read_folder(path, ("M", "K")), str(path), seats, most, ratio)
    if path.suffix.lower() == ARCHIVE:
        return of_foundation(read_archive(path), str(path), seats, most, ratio)
    raise TouchdownError(
        f"{path}: foundations are imported from archives ({ARCHIVE}) of matrices or modal data, and from "
        "folders of matrices"
    )


def of_foundation(
    data: Mapping[str, Any], file: str, seats: Mapping[str, str], most: int, ratio: float
) -> FoundationModes:
    """As `read_foundation`, of these arrays. Raises TouchdownError."""
    arrays = Given(file, data)
    found = _of_matrices(arrays, seats, ratio) if arrays.has("K") else _of_modes(arrays, seats, ratio)
    moved = np.max(np.abs(found.shape), axis=(1, 2))
    kept = np.flatnonzero(moved > STILL * np.max(moved, initial=0.0))[:most]
    arrays.require(len(kept), f"no mode moves {' or '.join(seats.values())}")
    left_out = _left_out(found, kept) if arrays.has("K") else None
    shape = found.shape[kept]
    shape[np.abs(shape) < STILL * np.max(moved)] = 0.0
    flat = shape.reshape(len(kept), -1)
    large = np.abs(flat) > (1.0 - ALIKE) * np.max(np.abs(flat), axis=1, keepdims=True)
    first = np.take_along_axis(flat, np.argmax(large, axis=1)[:, None], 1)  # of the largest, which may tie
    shape *= np.sign(first)[:, :, None]
    return FoundationModes(found.omega[kept], found.damping_ratio[kept], shape, left_out)


def _left_out(found: FoundationModes, kept: np.ndarray) -> float:
    """Of what a seat gives way by at rest, in a direction, the largest part of modes not `kept`."""
    gives = (found.shape / found.omega[:, None, None]) ** 2  # m/N
    whole = np.sum(gives, axis=0)
    gone = whole - np.sum(gives[kept], axis=0)
    return float(np.max(gone / np.maximum(whole, STILL * np.max(whole))))


def _of_modes(arrays: Given, seats: Mapping[str, str], ratio: float) -> FoundationModes:
    arrays.only(*MODAL_FIELDS)
    frequencies = arrays.numbers("frequencies").ravel()
    x = arrays.numbers("x")
    arrays.require(
        x.ndim == 2 and x.shape[1] == len(frequencies),
        f"x must have a row for each node and a column for each of {len(frequencies)} modes",
    )
    nodes = _names(arrays, len(x))
    y, n = arrays.numbers("y", x.shape), len(frequencies)
    masses = arrays.numbers("modal_masses", (n,)) if arrays.has("modal_masses") else np.ones(n)
    ratios = arrays.numbers("damping_ratios", (n,)) if arrays.has("damping_ratios") else np.full(n, ratio)
    for name, values in (("frequencies", frequencies), ("modal_masses", masses)):
        arrays.require(np.all(values > 0.0), f"{name} must be above 0; a foundation stands")
    _check_ratios(arrays, "damping_ratios", ratios)
    places = [_place(arrays, nodes, node) for node in seats.values()]
    order = np.argsort(frequencies)
    shape = np.stack([x[places], y[places]], axis=-1).transpose(1, 0, 2) / np.sqrt(masses)[:, None, None]
    return FoundationModes(2.0 * np.pi * frequencies[order], ratios[order], shape[order], None)


def _of_matrices(arrays: Given, seats: Mapping[str, str], ratio: float) -> FoundationModes:
    arrays.only(*MATRIX_FIELDS)
    M, K = _symmetric(arrays, "M"), _symmetric(arrays, "K")
    arrays.require(M.shape == K.shape, f"M has {len(M)} rows, K {len(K)}; they must be alike")
    nodes = _names(arrays, None)
    rows = row_places(arrays, nodes, len(M))
    indices: list[int] = []
    for node in seats.values():
        for dof, name in ((UX, "UX"), (UY, "UY")):
            row = rows.get((_place(arrays, nodes, node), dof))
            if row is None:
                raise arrays.error(f"dofs: {name} of node {node} is missing")
            indices.append(row)
    try:  # the other way round, as M may be singular
        squares, shapes = eigh(M, K)
    except np.linalg.LinAlgError:
        raise arrays.error(
            "K is not positive definite: a foundation stands; hold it where it does"
        ) from None
    moving = np.flatnonzero(squares > STILL**2 * np.max(squares))[::-1]
    omega = 1.0 / np.sqrt(squares[moving])
    shapes = shapes[:, moving] * omega  # from unit strain energy to unit modal mass
    ratios = np.full(len(omega), ratio)
    if arrays.has("C"):
        ratios = np.sum(shapes * (_symmetric(arrays, "C") @ shapes), axis=0) / (2.0 * omega)
        _check_ratios(arrays, "C: damping ratios", ratios)
    per_kg = np.sqrt(1.0 if unit_of(arrays) == 1.0 else 1000.0)  # masses in t, with mm
    shape = shapes[indices].reshape(len(seats), 2, len(omega)).transpose(2, 0, 1) / per_kg
    return FoundationModes(omega, ratios, shape, None)


def _check_ratios(arrays: Given, name: str, ratios: np.ndarray) -> None:
    if np.any((ratios < 0.0) | (ratios >= 1.0)):
        wrong = ratios[(ratios < 0.0) | (ratios >= 1.0)][0]
        raise arrays.error(f"{name} must be from 0 to below 1; one is {wrong:.4g}")


def _symmetric(arrays: Given, name: str) -> np.ndarray:
    matrix = arrays.numbers(name)
    arrays.require(matrix.ndim == 2 and matrix.shape[0] == matrix.shape[1], f"{name} must be square")
    arrays.require(
        np.max(np.abs(matrix - matrix.T)) <= SYMMETRY * np.max(np.abs(matrix)), f"{name} is not symmetric"
    )
    return 0.5 * (matrix + matrix.T)


def _names(arrays: Given, count: int | None) -> list[str]:
    """Of the nodes; count: how many there must be, None where the rows of matrices tell."""
    if arrays.has("nodes"):
        names = arrays.names("nodes").ravel().tolist()
    elif count is not None:
        names = [str(k + 1) for k in range(count)]
    else:
        raise arrays.error("nodes is missing: their numbers or names, in order")
    arrays.require(
        count in (None, len(names)) and len(set(names)) == len(names),
        f"nodes must be {count or len(names)} different numbers or names",
    )
    return names


def _place(arrays: Given, nodes: list[str], node: str) -> int:
    if node not in nodes:
        some = ", ".join(nodes[:10]) + (", ..." if len(nodes) > 10 else "")
        raise arrays.error(f"there is no node {node}; there are: {some}")
    return nodes.index(node)
