"""Matrices of a whole rotor in one plane.

The rotor is the same in both planes, so its motion is complex: z = x + i y per node, the slope likewise
(turn of the section in the x-z plane + i times that in the y-z plane). x is horizontal, y is up, the
spin Omega counter-clockwise. With alpha = dOmega/dt, (3.24) reads

    M q'' - i Omega G q' - i alpha G q + K q = F,   gravity: F = -i g M e,

where q (2N,) holds (z, slope) node by node and e is a unit translation.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rotor import beam
from rotor.shaft import Shaft


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


def unit_forces(shaft: Shaft, nodes: tuple[int, ...]) -> np.ndarray:
    """A force of 1 N at each of `nodes` (1-based), a column each (2N, len(nodes))."""
    forces = np.zeros((2 * shaft.nodes, len(nodes)))
    for column, node in enumerate(nodes):
        forces[2 * (node - 1), column] = 1.0
    return forces
