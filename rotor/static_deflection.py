"""A rotor at rest on supports: deflection and stresses under gravity (Halminen (2016), Fig 19)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..modelkit.errors import require
from .beams.beam_body import rigid_motion
from .beams.element import element_matrices
from .beams.shaft import Shaft, check_nodes
from .modal.modal_stresses import bending_per_moment, end_nodes, shear_per_force
from .modal.modes import flexibility


@dataclass(frozen=True)
class Rest:
    """Deflection and stresses; signs as in `rotor.modal.modal_stresses`, so sagging is positive bending."""

    deflection: np.ndarray  # (N,), m, upwards
    slope: np.ndarray  # (N,)
    reactions: np.ndarray  # (supports,), N, upwards
    node: np.ndarray  # (R,), 1-based; R = 2 elements, start and end of each; none of a superelement
    position: np.ndarray  # (R,), m from node 1
    bending: np.ndarray  # (R,), Pa
    shear: np.ndarray  # (R,), Pa


def at_rest(shaft: Shaft, supports: Sequence[tuple[int, float]], gravity: float = 9.81) -> Rest:
    """The rotor on `supports`: (node counted from 1, stiffness in N/m; math.inf for a rigid one).

    gravity in m/s2. Stresses follow from the equilibrium of each element, exact under the weight along it.
    Raises TouchdownError where there are less than two supports, or one that is not there or not held.
    """
    nodes = [node for node, _ in supports]
    require(
        len(set(nodes)) >= 2 and len(set(nodes)) == len(nodes),
        f"supports at nodes {nodes}: a rotor rests on two nodes or more, each named once",
    )
    check_nodes(shaft, nodes)
    require(
        len(nodes) <= shaft.coordinates,
        f"{shaft.title} has {shaft.coordinates} modes, too few to lie on {len(nodes)} nodes",
    )
    for node, spring in supports:
        require(
            spring > 0.0,
            f"the support at node {node} has a stiffness of {spring:g} N/m; it must be above 0",
        )
    q, reactions = _equilibrium(shaft, supports, gravity)
    bending, shear = _stresses(shaft, q, gravity)
    node = end_nodes(shaft)
    return Rest(q[0::2], q[1::2], reactions, node, shaft.positions()[node - 1], bending, shear)


def _equilibrium(
    shaft: Shaft, supports: Sequence[tuple[int, float]], gravity: float
) -> tuple[np.ndarray, np.ndarray]:
    """Deflection and slope of the nodes (2N,), and forces of the supports (S,), N, upwards.

    The supports bend the rotor by `flexibility`; a rigid motion brings it onto them. Weight alone bends
    nothing: as inertia it is balanced by itself.
    """
    nodes, springs = zip(*supports, strict=True)
    bent = flexibility(shaft, nodes)
    rigid = rigid_motion(shaft.positions(), shaft.centre_of_mass)
    rows = [2 * (node - 1) for node in nodes]
    give = bent[rows] + np.diag(1.0 / np.array(springs))  # m/N, also of the springs
    scale = np.max(np.abs(give)) or 1.0
    count = len(nodes)
    balance = np.block([[give / scale, rigid[rows]], [rigid[rows].T, np.zeros((2, 2))]])
    weight = np.concatenate((np.zeros(count), [gravity * shaft.mass, 0.0]))
    found = np.linalg.solve(balance, weight)
    return bent @ found[:count] + scale * (rigid @ found[count:]), found[:count]


def _stresses(shaft: Shaft, q: np.ndarray, gravity: float) -> tuple[np.ndarray, np.ndarray]:
    """Bending and shear stress (R,) from the forces at the element's ends."""
    bending, shear = [], []
    for i, element in enumerate(shaft.elements):
        matrices = element_matrices(element)
        weight = -gravity * matrices.mass @ np.array([1.0, 0.0, 1.0, 0.0])
        force1, moment1, force2, moment2 = matrices.stiffness @ q[2 * i : 2 * i + 4] - weight
        first, second = element.section(0.0), element.section(1.0)
        bending += [bending_per_moment(first) * -moment1, bending_per_moment(second) * moment2]
        shear += [shear_per_force(first) * force1, shear_per_force(second) * -force2]
    return np.array(bending), np.array(shear)
