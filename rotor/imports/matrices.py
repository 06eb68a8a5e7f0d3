"""Rotors from mass, stiffness and gyroscopic matrices of other finite-element programs (docs/rotors.md).

Degrees of freedom are displacements and right-handed rotations, 1 to 6 (or T1 to T3 and R1 to R3; UX to UZ
and ROTX to ROTZ). On an axis along z the slope in the x-z plane is the rotation about y, that in the y-z
plane is less the one about x; along x and y likewise, in cyclic order.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from textwrap import shorten
from typing import Any

import numpy as np

from ...modelkit.errors import TouchdownError
from ..beams.shaft import Shaft
from ..beams.superelement import Superelement, by, furthest_apart, symmetric_body
from ..modal.modes import RIGID_MODES, basis
from .named_arrays import Given

AXES = "XYZ"
NAMES = ("UX", "UY", "UZ", "ROTX", "ROTY", "ROTZ")
DOFS = {
    name: i
    for i in range(6)
    for name in (
        *(NAMES[i], f"{'TR'[i // 3]}{AXES[i % 3]}"),
        *(str(i + 1), f"{'TR'[i // 3]}{i % 3 + 1}"),
    )
}
AXIS_TOLERANCE = 1e-6  # of the length, by which nodes may lie beside the axis


@dataclass(frozen=True)
class MatrixRows:
    """Rows of the matrices (from 0), by plane: deflection and slope, or rotation, of node after node."""

    positions: np.ndarray  # (N,), along the axis, ascending
    x: np.ndarray  # (2N,), of the x-z plane
    y: np.ndarray  # (2N,), of the y-z plane, whose slope is less the rotation
    other: np.ndarray  # along the axis and about it
    names: tuple[str, ...]  # (n,)
    nodes: tuple[str, ...]  # (N,), as they were called


def matrix_rows(arrays: Given, n: int) -> MatrixRows:
    """Of `n` rows of matrices beside coordinates, nodes and dofs. Raises TouchdownError."""
    axis, positions = _axis(arrays)
    count = len(positions)
    nodes = [str(i + 1) for i in range(count)]
    if arrays.has("nodes"):
        nodes = arrays.names("nodes").ravel().tolist()
    arrays.require(
        len(nodes) == count and len(set(nodes)) == count,
        f"nodes must be {count} different numbers or names, those of the coordinates",
    )
    places = row_places(arrays, nodes, n)
    x, y = (axis + 1) % 3, (axis + 2) % 3
    planes: list[list[int]] = []
    for dofs in ((x, 3 + y), (y, 3 + x)):
        planes.append([])
        for node in np.argsort(positions).tolist():
            for dof in dofs:
                arrays.require(
                    (node, dof) in places, f"dofs: {NAMES[dof]} of node {nodes[node]} is missing"
                )
                planes[-1].append(places[node, dof])
    names = {row: f"{NAMES[dof]} of node {nodes[node]}" for (node, dof), row in places.items()}
    return MatrixRows(
        positions=np.sort(positions),
        x=np.array(planes[0]),
        y=np.array(planes[1]),
        other=np.setdiff1d(np.arange(n), np.ravel(planes)),
        names=tuple(names[row] for row in range(n)),
        nodes=tuple(nodes[i] for i in np.argsort(positions).tolist()),
    )


def _axis(arrays: Given) -> tuple[int, np.ndarray]:
    """Which of the axes the rotor lies on (from 0), and where its nodes are on it (N,)."""
    places = arrays.numbers("coordinates")
    if places.ndim == 1:
        places = np.outer(places, [0.0, 0.0, 1.0])
    arrays.require(
        places.ndim == 2 and places.shape[1] == 3 and len(places) >= 2,
        "coordinates must be those of two nodes or more: N by 3, or N along z",
    )
    spread = np.ptp(places, axis=0)
    axis = int(np.argmax(spread))
    beside = float(np.delete(spread, axis).max())
    arrays.require(
        beside <= AXIS_TOLERANCE * spread[axis],
        f"coordinates: the nodes are up to {beside:g} away from a line along {AXES[axis]}; they must "
        "lie on the rotor's axis, which is one of x, y and z",
    )
    ascending = np.sort(places[:, axis])
    apart = np.diff(ascending)
    if apart.min() <= AXIS_TOLERANCE * spread[axis]:
        where = ascending[int(np.argmin(apart))]
        raise arrays.error(f"coordinates: two nodes are at {where:g} along {AXES[axis]}; join them")
    return axis, places[:, axis]


def row_places(arrays: Given, nodes: list[str], n: int) -> dict[tuple[int, int], int]:
    """The row of each degree of freedom (0 to 5) of each node (from 0)."""
    arrays.require(
        arrays.has("dofs"), 'dofs is missing: node and degree of freedom of each row, such as ("1", "UX")'
    )
    dofs = arrays.names("dofs")
    if dofs.ndim == 1:
        dofs = np.array([[node, dof] for node in nodes for dof in dofs])
    arrays.require(
        dofs.shape == (n, 2),
        f"dofs are {by(dofs.shape)}, and M has {n} rows; give node and degree of freedom of each row, "
        "or the degrees of freedom of a node where all have the same",
    )
    number = {node: i for i, node in enumerate(nodes)}
    places: dict[tuple[int, int], int] = {}
    for row, (node, name) in enumerate(dofs.tolist()):
        arrays.require(node in number, f"dofs, row {row + 1}: node {node} has no coordinates")
        dof = DOFS.get(name.strip().upper())
        if dof is None:
            raise arrays.error(
                f"dofs, row {row + 1}: {name} is not known; they are 1 to 6, or {', '.join(NAMES)}"
            )
        arrays.require(
            (number[node], dof) not in places,
            f"dofs, row {row + 1}: {NAMES[dof]} of node {node} is there twice",
        )
        places[number[node], dof] = row
    return places


FIELDS = ("M", "K", "G", "C", "coordinates", "nodes", "dofs", "units")
LENGTHS = {"m": 1.0, "mm": 1e-3}  # m
UNIT_MISTAKES = (  # what mends a mistake: a factor of the coordinates, and the unit; and what to say
    (-1.0, None, "the coordinates run against the axis of the matrices; turn their sign along it"),
    (1.0, "m", 'these are matrices in kg, m, s, N, so it is units = "m"'),
    (1.0, "mm", 'these are matrices in t, mm, s, N; give units = "mm"'),
    (1e-3, "m", "the coordinates are in mm, the matrices in kg, m, s, N; divide the coordinates by 1000"),
    (1e3, "mm", 'the matrices are in t, mm, s, N; give the coordinates in mm, too, and units = "mm"'),
)
AXIAL_MOTION = "motion along the axis or about it, which a rotor here does not have"
DAMPING_TOLERANCE = 1e-3  # of the first bending frequency: damping of a rigid motion below it counts as 0
PROPORTIONAL_TOLERANCE = 1e-3  # of alpha: by which C may differ from alpha M on the rigid modes
MAX_LISTED_RATIOS = 5  # damping ratios
MAX_LISTED_CHARACTERS = 200  # characters of nodes' names


def of_matrices(data: Mapping[str, Any], file: str, title: str) -> Shaft:
    """The rotor of these arrays. Raises TouchdownError."""
    arrays = Given(file, data)
    arrays.only(*FIELDS)
    M = arrays.numbers("M")
    arrays.require(M.ndim == 2 and M.shape[0] == M.shape[1], f"M is {by(M.shape)}; it must be square")
    planes = Planes(arrays, matrix_rows(arrays, len(M)), unit_of(arrays))
    planes.check_mass(M)
    body = _body(arrays, planes, M)
    try:
        body = symmetric_body(body)
    except TouchdownError as error:
        raise arrays.error(_mistaken(arrays, M) or str(error)) from None
    positions = body.positions
    about, called = "Imported from mass, stiffness and gyroscopic matrices.", ()
    if planes.rows.nodes != tuple(str(i + 1) for i in range(len(positions))):
        listed = shorten(", ".join(planes.rows.nodes), MAX_LISTED_CHARACTERS, placeholder=" ...")
        about += f"\nIts nodes from 1 on are those called {listed}"
        called = planes.rows.nodes
    shaft = Shaft(title, superelement=body, about=about, called=called)
    if not arrays.has("C"):
        return shaft
    return _damped(arrays, shaft, planes.alike("C", arrays.numbers("C", M.shape)))


def _body(arrays: Given, planes: Planes, M: np.ndarray) -> Superelement:
    """Of one plane, in SI, unchecked."""
    positions = planes.metre * planes.rows.positions
    return Superelement(
        positions - positions[0],
        planes.alike("M", M),
        planes.alike("K", arrays.numbers("K", M.shape)),
        planes.polar(arrays.numbers("G", M.shape)),
    )


def _mistaken(arrays: Given, M: np.ndarray) -> str:
    """Which mistake about axis or units, put right, makes these the matrices of a rotor; "" of none."""
    places = arrays.numbers("coordinates")
    for factor, unit, says in UNIT_MISTAKES:
        changes = {"coordinates": factor * places} | ({} if unit is None else {"units": unit})
        other = Given(arrays.file, {**arrays.data, **changes})
        try:
            symmetric_body(_body(other, Planes(other, matrix_rows(other, len(M)), unit_of(other)), M))
        except TouchdownError:
            continue
        return says
    return ""


def unit_of(arrays: Given) -> float:
    """The unit of length (m)."""
    name = str(np.asarray(arrays.data.get("units", "m")))
    arrays.require(
        name in LENGTHS, f'units = {name!r} is not known; "m" is for kg, m, s, N and "mm" for t, mm, s, N'
    )
    return LENGTHS[name]


@dataclass(frozen=True)
class Planes:
    """Parts of the matrices in one plane, in SI, after a look at the rest. All raise TouchdownError."""

    arrays: Given
    rows: MatrixRows
    metre: float  # the unit of length, m

    def alike(self, name: str, matrix: np.ndarray) -> np.ndarray:
        """M, K or C of a plane (2N, 2N): symmetric, the same in both, and nothing between them."""
        size = np.diag(matrix)
        if place := furthest_apart(matrix, matrix.T, size):
            what = f"{name} is not symmetric"
            if name == "C":
                what += " (what is gyroscopic in it belongs into G, per spin speed in rad/s)"
            raise self._refusal(what, matrix, *_mirrored(place))
        self._check_alone(name, matrix, size)
        crossed = f"{name} couples the planes, which only G may (are the dofs in the order of the rows?)"
        self._check_empty(crossed, matrix, size, self.rows.x, self.rows.y)
        x, y = self._part(matrix, "xx"), self._part(matrix, "yy")
        if place := furthest_apart(x, y, np.diag(x)):
            places = (self._place("xx", place), self._place("yy", place))
            raise self._refusal(f"{name} is not the same in both planes", matrix, *places)
        return self._in_si(0.5 * (x + y))

    def check_mass(self, M: np.ndarray) -> None:
        """Each deflection and each rotation has a mass of its own."""
        for row in (*self.rows.x, *self.rows.y):
            self.arrays.require(
                M[row, row] > 0.0,
                f"M has {M[row, row]:g} for {self.rows.names[row]}, where a mass must be; export a "
                "consistent mass matrix, not a lumped one, or condense what has no mass",
            )

    def polar(self, matrix: np.ndarray) -> np.ndarray:
        """The polar matrix of one plane (2N, 2N): what G has from the y-z plane on the x-z plane."""
        size = np.full(len(matrix), np.max(np.abs(matrix), initial=0.0))
        if place := furthest_apart(matrix, -matrix.T, size):
            raise self._refusal("G is not skew-symmetric", matrix, *_mirrored(place))
        self._check_alone("G", matrix, size)
        for plane in (self.rows.x, self.rows.y):
            self._check_empty("G couples a plane to itself", matrix, size, plane, plane)
        polar = self._part(matrix, "xy")
        if place := furthest_apart(polar, polar.T, size[: len(polar)]):
            places = (self._place("xy", one) for one in _mirrored(place))
            raise self._refusal("G is not the same in both planes", matrix, *places)
        return self._in_si(0.5 * (polar + polar.T))

    def _part(self, matrix: np.ndarray, planes: str) -> np.ndarray:
        """Of the deflections and slopes in two planes (2N, 2N)."""
        part = matrix[np.ix_(getattr(self.rows, planes[0]), getattr(self.rows, planes[1]))]
        turned = np.tile([1.0, -1.0], len(part) // 2)  # slopes of the y-z plane are less the rotations
        if planes[0] == "y":
            part = turned[:, None] * part
        return part * turned if planes[1] == "y" else part

    def _place(self, planes: str, place: tuple[int, int]) -> tuple[int, int]:
        """Row and column of the whole matrix, of those of a part."""
        return getattr(self.rows, planes[0])[place[0]], getattr(self.rows, planes[1])[place[1]]

    def _in_si(self, part: np.ndarray) -> np.ndarray:
        """From the unit of length given; energies are then in N times it."""
        per = np.tile([1.0 / self.metre, 1.0], len(part) // 2)
        return self.metre * part * np.outer(per, per)

    def _check_alone(self, name: str, matrix: np.ndarray, size: np.ndarray) -> None:
        """Bending has nothing to do with motion along the axis or about it."""
        lateral = np.concatenate((self.rows.x, self.rows.y))
        self._check_empty(
            f"{name} couples bending to {AXIAL_MOTION}", matrix, size, lateral, self.rows.other
        )

    def _check_empty(
        self, what: str, matrix: np.ndarray, size: np.ndarray, lines: np.ndarray, columns: np.ndarray
    ) -> None:
        """Nothing of a matrix is in these rows and columns; `size` (n,) tells what is small."""
        part = np.zeros_like(matrix)
        part[np.ix_(lines, columns)] = matrix[np.ix_(lines, columns)]
        if place := furthest_apart(part, np.zeros_like(part), size):
            raise self._refusal(what, matrix, place)

    def _refusal(self, what: str, matrix: np.ndarray, *places: tuple[int, int]) -> TouchdownError:
        """The error to raise about the entries at some places."""
        names = self.rows.names
        couplings = [f"{matrix[i, j]:g} between {names[i]} and {names[j]}" for i, j in places]
        return self.arrays.error(f"{what}: {', '.join(couplings)}")


def _mirrored(place: tuple[int, int]) -> tuple[tuple[int, int], tuple[int, int]]:
    """A place of a matrix, and that on the other side of its diagonal."""
    row, column = place
    return place, (column, row)


def _damped(arrays: Given, shaft: Shaft, C: np.ndarray) -> Shaft:
    """`shaft` with the damping ratio that C (2N, 2N) gives the first bending mode; `about` tells others."""
    free = basis(shaft, 0)
    modal = np.sum(free.shapes * (C @ free.shapes), axis=0)  # 1/s
    if np.max(np.abs(modal[:RIGID_MODES])) > DAMPING_TOLERANCE * free.omega[RIGID_MODES]:
        rigid = free.shapes[:, :RIGID_MODES]
        alpha = modal[:RIGID_MODES].mean()
        beside = np.max(np.abs(rigid.T @ C @ rigid - alpha * np.eye(RIGID_MODES)))
        arrays.require(
            beside > PROPORTIONAL_TOLERANCE * alpha,
            f"C has a share of alpha M (alpha = {alpha:.4g} 1/s), which damps rigid motion, too; it "
            "belongs to the surroundings; export C without it",
        )
        raise arrays.error(
            "C damps the rotor as a whole, so it holds bearings; export the rotor without, they belong "
            "into the scene"
        )
    ratios = modal[RIGID_MODES:] / (2.0 * free.omega[RIGID_MODES:])
    arrays.require(
        0.0 <= ratios[0] < 1.0,
        f"C gives the first bending mode a damping ratio of {ratios[0]:g}, not of 0 to 1",
    )
    listed = ", ".join(f"{100.0 * ratio:.3g} %" for ratio in ratios[:MAX_LISTED_RATIOS])
    about = f"{shaft.about}\nC gives the bending modes damping ratios of {listed}; here all have the first."
    return replace(shaft, damping_ratio=float(ratios[0]), about=about)
