"""Free-free modes of a rotor, with residual vectors (Halminen (2016), section 3.3).

Few modes leave out the local flexibility at a seat, which matters in a contact. A residual vector is
what the modes left out deflect under a static force there; with it, the reduced rotor has the exact
static flexibility for forces at these nodes.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy import linalg, sparse
from scipy.sparse import linalg as splinalg

from ...modelkit.model import ModelError
from ..beams.beam_body import Matrices
from ..beams.element import Element, element_matrices
from ..beams.shaft import TOO_UNLIKE_MESSAGE, Shaft, assembled_matrices, solve_held, unit_forces

RIGID_MODES = 2  # rigid modes per plane
MAX_SOLVED = 128  # modes per plane of a long list of nodes
MIN_RESIDUAL = 1e-7  # a residual vector this small against its node's deflection is rounding error
# Squared frequency over the highest; below, rounding errors show in the third digit
MIN_FREQUENCY_RATIO = 1e-11
PARALLEL_TOLERANCE = 1e-10  # squared sine below which residual vectors count as one


@dataclass(frozen=True)
class Basis:
    """Generalised coordinates p of one plane: q = shapes p, unit modal masses.

    p'' - i Omega gyroscopic p' - i alpha gyroscopic p + omega^2 p = shapes^T F. Translation and tilt
    come first (omega = 0), then bending modes by frequency, then residual vectors by theirs.
    """

    shapes: np.ndarray  # (2N, n)
    omega: np.ndarray  # (n,), rad/s
    gyroscopic: np.ndarray  # (n, n)
    kept: int  # true modes; the other n - kept are residual vectors

    def deflections(self, nodes: Sequence[int]) -> np.ndarray:
        """Deflection of `nodes` (1-based) per coordinate (len(nodes), n)."""
        return self.shapes[[2 * (node - 1) for node in nodes]]

    def slopes(self, nodes: Sequence[int]) -> np.ndarray:
        """Slope dx/dz of `nodes` (1-based) per coordinate (len(nodes), n)."""
        return self.shapes[[2 * (node - 1) + 1 for node in nodes]]


def basis(shaft: Shaft, modes: int, residual_at: Sequence[int] = ()) -> Basis:
    """The lowest `modes` modes of one plane, the two rigid ones included, and residual vectors.

    0: all, of which rotors with more than `MAX_SOLVED` have only so many here.

    `residual_at` are nodes (1-based) for whose forces the static flexibility shall be exact; what the
    modes leave nothing of, or what another node has brought already, is not added. Raises ModelError where
    there are not so many modes, or the elements are too unlike each other.
    """
    most = min(shaft.coordinates, MAX_SOLVED)
    if modes != 0 and not RIGID_MODES <= modes <= most:
        raise ModelError(
            f"modes = {modes}: the rotor {shaft.title} has {most} modes per plane to keep; "
            f"take {RIGID_MODES} (rigid) to {most}, or 0 for all of them"
        )
    matrices = assembled_matrices(shaft)
    shapes, omega = _free_modes(shaft, matrices, modes or most)
    kept = len(omega)
    if len(residual_at) > 0:
        extra, extra_omega = _residual_vectors(shaft, matrices, shapes, omega, residual_at)
        shapes = np.hstack((shapes, extra))
        omega = np.concatenate((omega, extra_omega))
    gyroscopic = shapes.T @ matrices.polar @ shapes
    gyroscopic[0, :] = gyroscopic[:, 0] = 0.0  # translation turns no section
    return Basis(matrices.shapes @ shapes, omega, 0.5 * (gyroscopic + gyroscopic.T), kept)


def fullest(shaft: Shaft, held_at: Sequence[int]) -> Basis:
    """All modes; of a rotor with more than are kept, also residual vectors at the nodes `held_at`."""
    return basis(shaft, 0, held_at if shaft.coordinates > MAX_SOLVED else ())


def flexibility(shaft: Shaft, nodes: Sequence[int]) -> np.ndarray:
    """Elastic deflection of the free rotor under a unit force at each of `nodes` (2N, len(nodes)), m/N.

    By inertia relief: the force is balanced by the inertia of the rigid motion it causes, and the
    deflection holds no rigid motion.
    """
    matrices = assembled_matrices(shaft)
    return matrices.shapes @ _relieved(shaft, matrices, nodes)


def residual_flexibility(shaft: Shaft, kept: Basis, nodes: Sequence[int]) -> np.ndarray:
    """The part of `flexibility` beyond the coordinates of `kept` (2N, len(nodes)), m/N."""
    return _beyond(kept.shapes, kept.omega, flexibility(shaft, nodes), unit_forces(shaft, nodes))


def _beyond(
    shapes: np.ndarray, omega: np.ndarray, deflection: np.ndarray, forces: np.ndarray
) -> np.ndarray:
    """The part of an elastic `deflection` under `forces` that modes leave, in the same coordinates."""
    elastic = shapes[:, RIGID_MODES:]
    return deflection - elastic @ (elastic.T @ forces / omega[RIGID_MODES:, None] ** 2)


def _rigid_modes(shaft: Shaft, matrices: Matrices) -> np.ndarray:
    """Translation and tilt about the centre of mass, orthonormal in the mass matrix (n, 2)."""
    return matrices.rigid / np.sqrt([shaft.mass, shaft.diametral_inertia])


def _relieved(shaft: Shaft, matrices: Matrices, nodes: Sequence[int]) -> np.ndarray:
    """Coordinates (n, len(nodes)) of the deflection that `flexibility` gives."""
    rigid = _rigid_modes(shaft, matrices)
    inertia = matrices.mass @ rigid
    forces = matrices.shapes.T @ unit_forces(shaft, nodes)
    balanced = forces - inertia @ (rigid.T @ forces)
    held = slice(2, None)  # balanced loads leave no reaction where node 1 is held
    deflection = np.zeros_like(balanced)
    deflection[held] = solve_held(matrices.stiffness[held, held], balanced[held])
    return deflection - rigid @ (inertia.T @ deflection)


def _free_modes(shaft: Shaft, matrices: Matrices, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Shapes (n, count) and frequencies (count,), the rigid ones built, not solved for."""
    rigid = _rigid_modes(shaft, matrices)
    if count == RIGID_MODES:
        return rigid, np.zeros(RIGID_MODES)
    square, bending, highest = _lowest(shaft, matrices, count)
    if square[RIGID_MODES] < MIN_FREQUENCY_RATIO * highest:
        raise ModelError(TOO_UNLIKE_MESSAGE)
    bending = bending[:, RIGID_MODES:count]
    bending = bending - rigid @ (rigid.T @ (matrices.mass @ bending))
    elastic, omega = _ritz(matrices, bending)
    return np.hstack((rigid, elastic)), np.concatenate((np.zeros(RIGID_MODES), omega))


def _lowest(shaft: Shaft, matrices: Matrices, count: int) -> tuple[np.ndarray, np.ndarray, float]:
    """Squared frequencies, ascending, and vectors (n, ...) of `count` modes or more; the highest square.

    Of many elements the highest is that of the stiffest by itself, which bounds it from above.
    """
    if shaft.coordinates <= MAX_SOLVED or not shaft.elements:
        square, vectors = linalg.eigh(matrices.stiffness, matrices.mass)
        return square, vectors, float(square[-1])
    K, M = (sparse.csc_array(matrix) for matrix in (matrices.stiffness, matrices.mass))
    middle = shaft.elements[len(shaft.elements) // 2]
    shift = (np.pi / shaft.positions()[-1]) ** 4 * middle.EI / middle.mass_per_length
    start = np.cos(np.arange(2.0 * shaft.nodes))  # any vector that is always the same
    square, vectors = splinalg.eigsh(K, count, M, sigma=-shift, v0=start)
    order = np.argsort(square)
    return square[order], vectors[:, order], max(_highest(element) for element in set(shaft.elements))


def _highest(element: Element) -> float:
    """Highest squared frequency of a free element."""
    matrices = element_matrices(element)
    return float(linalg.eigh(matrices.stiffness, matrices.mass, eigvals_only=True)[-1])


def _residual_vectors(
    shaft: Shaft, matrices: Matrices, shapes: np.ndarray, omega: np.ndarray, nodes: Sequence[int]
) -> tuple[np.ndarray, np.ndarray]:
    """Vectors (n, k), k <= len(nodes), orthonormal to `shapes` and each other, and frequencies (k,)."""
    deflection = _relieved(shaft, matrices, nodes)
    vectors = _beyond(shapes, omega, deflection, matrices.shapes.T @ unit_forces(shaft, nodes))
    vectors = vectors - shapes @ (shapes.T @ (matrices.mass @ vectors))
    size = np.sqrt(np.sum(vectors * (matrices.mass @ vectors), axis=0))
    full = np.sqrt(np.sum(deflection * (matrices.mass @ deflection), axis=0))
    there = size > MIN_RESIDUAL * full
    if not there.any():
        return np.zeros((len(shapes), 0)), np.zeros(0)
    vectors = vectors[:, there] / size[there]
    gram, turns = np.linalg.eigh(vectors.T @ matrices.mass @ vectors)
    return _ritz(matrices, vectors @ turns[:, gram > PARALLEL_TOLERANCE])


def _ritz(matrices: Matrices, vectors: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Rayleigh-Ritz within the span of `vectors` (n, k): mass-normalised shapes and frequencies (k,)."""
    mass = vectors.T @ matrices.mass @ vectors
    stiffness = vectors.T @ matrices.stiffness @ vectors
    square, turns = linalg.eigh(0.5 * (stiffness + stiffness.T), 0.5 * (mass + mass.T))
    return _signed(vectors @ turns, matrices), np.sqrt(square)


def _signed(shapes: np.ndarray, matrices: Matrices) -> np.ndarray:
    """Each column turned so that the first node that moves appreciably moves to the positive side."""
    for column in shapes.T:
        deflection = (matrices.shapes @ column)[0::2]
        first = np.argmax(np.abs(deflection) > 0.1 * np.abs(deflection).max())
        if deflection[first] < 0.0:
            column *= -1.0
    return shapes
