"""Matrices of a whole rotor in one plane, and forces at its nodes (`rotor.beams.body`)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy import linalg

from touchdown.modelkit.model import ModelError
from touchdown.rotor.beams.body import Matrices
from touchdown.rotor.beams.shaft import Shaft

TOO_UNLIKE = (
    "the elements of the rotor are too unlike each other to be calculated together; "
    "look for very short or very thin ones"
)


def assemble(shaft: Shaft) -> Matrices:
    """The matrices of what the rotor is made of."""
    return shaft.body.matrices()


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
