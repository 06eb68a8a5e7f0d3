"""Matrices of a whole rotor in one plane.

The rotor is the same in both planes, so its motion is complex: z = x + i y per node, the slope likewise
(turn of the section in the x-z plane + i times that in the y-z plane). x is horizontal, y is up, the
spin Omega counter-clockwise. With alpha = dOmega/dt, (3.24) reads

    M q'' - i Omega G q' - i alpha G q + K q = F,   gravity: F = -i g M e,

where q (2N,) holds (z, slope) node by node and e is a unit translation.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy import linalg

from touchdown.modelkit.model import ModelError
from touchdown.rotor.beams import beam
from touchdown.rotor.beams.shaft import Shaft

TOO_UNLIKE = (
    "the elements of the rotor are too unlike each other to be calculated together; "
    "look for very short or very thin ones"
)


@dataclass(frozen=True)
class Matrices:
    """Each (2N, 2N), symmetric: mass M, stiffness K, gyroscopic ("polar") G."""

    mass: np.ndarray
    stiffness: np.ndarray
    polar: np.ndarray


def assemble(shaft: Shaft) -> Matrices:
    """Elements, sleeves and point masses together."""
    size = 2 * shaft.nodes
    mass, stiffness, polar = np.zeros((size, size)), np.zeros((size, size)), np.zeros((size, size))
    for i, element in enumerate(shaft.elements):
        own = beam.matrices(element)
        at = slice(2 * i, 2 * i + 4)
        mass[at, at] += own.mass
        stiffness[at, at] += own.stiffness
        polar[at, at] += own.polar
    for point in shaft.points:
        y = 2 * (point.node - 1)
        mass[y, y] += point.mass
        mass[y + 1, y + 1] += point.diametral_inertia
        polar[y + 1, y + 1] += point.polar_inertia
    return Matrices(mass, stiffness, polar)


def translation(shaft: Shaft) -> np.ndarray:
    """The rotor moved sideways by 1 m (2N,)."""
    e = np.zeros(2 * shaft.nodes)
    e[0::2] = 1.0
    return e


def tilt(shaft: Shaft) -> np.ndarray:
    """The rotor turned about its centre of mass by a slope of 1 (2N,)."""
    e = np.ones(2 * shaft.nodes)
    e[0::2] = shaft.positions() - shaft.centre_of_mass
    return e


def unit_forces(shaft: Shaft, nodes: Sequence[int]) -> np.ndarray:
    """A force of 1 N at each of `nodes` (1-based), a column each (2N, len(nodes))."""
    check_nodes(shaft, nodes)
    forces = np.zeros((2 * shaft.nodes, len(nodes)))
    for column, node in enumerate(nodes):
        forces[2 * (node - 1), column] = 1.0
    return forces


def check_nodes(shaft: Shaft, nodes: Sequence[int]) -> None:
    """Raises ModelError where one of `nodes` (1-based) does not exist."""
    for node in nodes:
        if not 1 <= node <= shaft.nodes:
            raise ModelError(f"node {node}: the rotor {shaft.title} has nodes 1 to {shaft.nodes}")


def solve(stiffness: np.ndarray, loads: np.ndarray) -> np.ndarray:
    """Deflections of a held rotor, scaled first: deflections and slopes are of different size.

    Raises ModelError where elements are too unlike each other to be calculated together.
    """
    scale = 1.0 / np.sqrt(np.diag(stiffness))
    try:
        factor = linalg.cho_factor(stiffness * np.outer(scale, scale))
    except linalg.LinAlgError:
        raise ModelError(TOO_UNLIKE) from None
    return (scale * linalg.cho_solve(factor, (scale * loads.T).T).T).T
