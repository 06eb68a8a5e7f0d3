"""Which row of exported matrices is which motion of which node, and where the nodes are on the axis."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from touchdown.rotor.beams.superelement import by
from touchdown.rotor.imports.given import Given

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
STRAIGHT = 1e-6  # of the length, by which nodes may lie beside the axis


@dataclass(frozen=True)
class Rows:
    """Rows of the matrices (from 0), by plane: deflection and slope, or rotation, of node after node."""

    positions: np.ndarray  # (N,), along the axis, ascending
    x: np.ndarray  # (2N,), of the x-z plane
    y: np.ndarray  # (2N,), of the y-z plane, whose slope is less the rotation
    other: np.ndarray  # along the axis and about it
    names: tuple[str, ...]  # (n,)
    nodes: tuple[str, ...]  # (N,), as they were called


def rows(given: Given, n: int) -> Rows:
    """Of `n` rows of matrices beside coordinates, nodes and dofs. Raises ImportedRotorError."""
    axis, positions = _axis(given)
    count = len(positions)
    nodes = [str(i + 1) for i in range(count)]
    if given.has("nodes"):
        nodes = given.names("nodes").ravel().tolist()
    if len(nodes) != count or len(set(nodes)) < count:
        raise given.error(f"nodes must be {count} different numbers or names, those of the coordinates")
    places = _places(given, nodes, n)
    x, y = (axis + 1) % 3, (axis + 2) % 3
    planes: list[list[int]] = []
    for wanted in ((x, 3 + y), (y, 3 + x)):
        planes.append([])
        for node in np.argsort(positions).tolist():
            for dof in wanted:
                if (node, dof) not in places:
                    raise given.error(f"dofs: {NAMES[dof]} of node {nodes[node]} is missing")
                planes[-1].append(places[node, dof])
    names = {row: f"{NAMES[dof]} of node {nodes[node]}" for (node, dof), row in places.items()}
    return Rows(
        positions=np.sort(positions),
        x=np.array(planes[0]),
        y=np.array(planes[1]),
        other=np.setdiff1d(np.arange(n), np.ravel(planes)),
        names=tuple(names[row] for row in range(n)),
        nodes=tuple(nodes[i] for i in np.argsort(positions).tolist()),
    )


def _axis(given: Given) -> tuple[int, np.ndarray]:
    """Which of the axes the rotor lies on (from 0), and where its nodes are on it (N,)."""
    places = given.numbers("coordinates")
    if places.ndim == 1:
        places = np.outer(places, [0.0, 0.0, 1.0])
    if places.ndim != 2 or places.shape[1] != 3 or len(places) < 2:
        raise given.error("coordinates must be those of two nodes or more: N by 3, or N along z")
    spread = np.ptp(places, axis=0)
    axis = int(np.argmax(spread))
    beside = float(np.delete(spread, axis).max())
    if beside > STRAIGHT * spread[axis]:
        raise given.error(
            f"coordinates: the nodes are up to {beside:g} away from a line along {AXES[axis]}; they must "
            "lie on the rotor's axis, which is one of x, y and z"
        )
    ascending = np.sort(places[:, axis])
    apart = np.diff(ascending)
    if apart.min() <= STRAIGHT * spread[axis]:
        where = ascending[int(np.argmin(apart))]
        raise given.error(f"coordinates: two nodes are at {where:g} along {AXES[axis]}; join them")
    return axis, places[:, axis]


def _places(given: Given, nodes: list[str], n: int) -> dict[tuple[int, int], int]:
    """The row of each degree of freedom (0 to 5) of each node (from 0)."""
    if not given.has("dofs"):
        raise given.error('dofs is missing: node and degree of freedom of each row, such as ("1", "UX")')
    dofs = given.names("dofs")
    if dofs.ndim == 1:
        dofs = np.array([[node, dof] for node in nodes for dof in dofs])
    if dofs.shape != (n, 2):
        raise given.error(
            f"dofs are {by(dofs.shape)}, and M has {n} rows; give node and degree of freedom of each row, "
            "or the degrees of freedom of a node where all have the same"
        )
    number = {node: i for i, node in enumerate(nodes)}
    places: dict[tuple[int, int], int] = {}
    for row, (node, name) in enumerate(dofs.tolist()):
        if node not in number:
            raise given.error(f"dofs, row {row + 1}: node {node} has no coordinates")
        dof = DOFS.get(name.strip().upper())
        if dof is None:
            raise given.error(
                f"dofs, row {row + 1}: {name} is none; they are 1 to 6, or {', '.join(NAMES)}"
            )
        if (number[node], dof) in places:
            raise given.error(f"dofs, row {row + 1}: {NAMES[dof]} of node {node} is there twice")
        places[number[node], dof] = row
    return places
