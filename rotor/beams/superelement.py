"""A rotor known by its matrices, not by its sections: a superelement, as other programs reduce theirs to.

Its coordinates are those of its nodes, or of modes that move them: `shapes` says how far. What takes
diameters (stresses, an outline) it cannot give.
"""

from __future__ import annotations

import hashlib
import math
from dataclasses import dataclass, fields
from functools import cached_property

import numpy as np
from scipy import linalg, sparse

from ...modelkit.errors import TouchdownError, require
from .beam_body import Matrices, rigid_motion

MAX_COORDINATES = 1000  # its matrices are full
ROUNDING = 1e-6  # of third-party matrices
# Of the first bending frequency; a mode below is a rigid one that digits or soft ropes hold
RIGID_FREQUENCY_RATIO = 1e-2
NOISE = 1e-13  # of the highest squared frequency, which the lowest are calculated beside
# Of the largest motion of a node: by which shapes may miss that of a rigid body
RIGID_SHAPE_TOLERANCE = 1e-3
LENGTH_RANGE = (1e-3, 1e2)  # m, of rotors; beyond, units are mistaken
BENDING_RANGE_HZ = (0.1, 1e6)  # of their first bending mode
MAX_BULK_DENSITY = 1e3  # kg/m3, mass over cubed length; slender rotors have 1 to 100, short flywheels more
MAX_DENSITY = 5e4  # kg/m3, twice that of any metal
FREE = (
    "export the rotor free, without bearings and supports, its coordinates and matrices in the same units, "
    "with all digits, and the dofs in their order"
)


@dataclass(frozen=True, eq=False)
class Superelement:
    """A body by its matrices (`rotor.beams.beam_body`), in SI; equal to one of the same numbers.

    With the first two coordinates held it has no rigid motion. `symmetric_body` says whether it is a rotor.
    """

    positions: np.ndarray  # (N,), m from node 1
    mass_matrix: np.ndarray  # (n, n)
    stiffness_matrix: np.ndarray  # (n, n)
    polar_matrix: np.ndarray  # (n, n)
    shapes: np.ndarray | None = None  # (2N, n), deflection and slope by node; None: p is these

    def __post_init__(self) -> None:
        for field in fields(self):
            if (value := getattr(self, field.name)) is not None:
                frozen = np.array(value, dtype=float) + 0.0  # never -0
                frozen.flags.writeable = False
                object.__setattr__(self, field.name, frozen)

    @cached_property
    def _digest(self) -> bytes:
        digest = hashlib.sha256()
        for field in fields(self):
            value = getattr(self, field.name)
            digest.update(b"none" if value is None else repr(value.shape).encode() + value.tobytes())
        return digest.digest()

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Superelement) and self._digest == other._digest

    def __hash__(self) -> int:
        return hash(self._digest)

    @property
    def kind(self) -> str:
        """The kind of body, in words."""
        n = self.coordinates
        return f"matrices of {n} coordinates per plane" if self.shapes is None else f"{n} modes per plane"

    @property
    def coordinates(self) -> int:
        """How many describe its motion (n)."""
        return len(self.mass_matrix)

    @cached_property
    def _rigid(self) -> np.ndarray:
        """Coordinates of a translation by 1 m and of a tilt of 1 about node 1 (n, 2).

        Of shapes, within the two lowest modes: at few nodes, bending modes may seem rigid motions, too.
        """
        motion = rigid_motion(self.positions, 0.0)
        if self.shapes is None:
            return motion
        lowest = linalg.eigh(self.stiffness_matrix, self.mass_matrix)[1][:, :2]
        return lowest @ np.linalg.lstsq(self.shapes @ lowest, motion, rcond=None)[0]

    @cached_property
    def _inertia(self) -> np.ndarray:
        """Of `_rigid` (2, 2): kg, kg m; kg m, kg m2 about node 1."""
        return self._rigid.T @ self.mass_matrix @ self._rigid

    @property
    def mass(self) -> float:
        """kg."""
        return float(self._inertia[0, 0])

    @property
    def centre_of_mass(self) -> float:
        """Its distance from node 1 (m)."""
        return float(self._inertia[0, 1] / self._inertia[0, 0])

    @cached_property
    def polar_inertia(self) -> float:
        """About the axis (kg m2): the gyroscopic moment on a tilting rigid body."""
        return float(self._rigid[:, 1] @ self.polar_matrix @ self._rigid[:, 1])

    @property
    def diametral_inertia(self) -> float:
        """About a diameter through the centre of mass (kg m2)."""
        return float(self._inertia[1, 1]) - self.mass * self.centre_of_mass**2

    def matrices(self) -> Matrices:
        """As they are given."""
        unit = sparse.csr_array(sparse.eye_array(self.coordinates))
        shapes = unit if self.shapes is None else self.shapes
        rigid = self._rigid - np.outer(self._rigid[:, 0], [0.0, self.centre_of_mass])
        return Matrices(self.mass_matrix, self.stiffness_matrix, self.polar_matrix, shapes, rigid)


def symmetric_body(body: Superelement) -> Superelement:
    """`body` with matrices that are symmetric to the bit.

    Raises TouchdownError, in a few words, where its numbers are not those of a free rotor.
    """
    _check_sizes(body)
    for name, matrix in (
        ("M", body.mass_matrix),
        ("K", body.stiffness_matrix),
        ("G", body.polar_matrix),
    ):
        if place := furthest_apart(matrix, matrix.T, np.diag(matrix)):
            i, j = place
            raise TouchdownError(
                f"{name} is not symmetric in a plane: row {i + 1}, column {j + 1} holds {matrix[i, j]:g}, "
                f"row {j + 1}, column {i + 1} holds {matrix[j, i]:g}"
            )
    _check_mass(body.mass_matrix)
    _check_rigid(body)
    _check_inertia(body)
    _check_stiffness(body)
    M, K, G = (0.5 * (A + A.T) for A in (body.mass_matrix, body.stiffness_matrix, body.polar_matrix))
    return Superelement(body.positions, M, K, G, body.shapes)


def furthest_apart(one: np.ndarray, other: np.ndarray, diagonal: np.ndarray) -> tuple[int, int] | None:
    """Row and column, from 0, where two matrices (n, n) are furthest apart; None where they are equal.

    They are to within `ROUNDING` of what the entries of a `diagonal` (n,) beside them lead to expect.
    """
    size = np.sqrt(np.abs(diagonal))
    expected = np.outer(size, size)
    largest = max(np.max(np.abs(one), initial=0.0), np.max(np.abs(other), initial=0.0))
    apart = np.abs(one - other) / np.maximum(expected, ROUNDING * largest or 1.0)
    if np.all(apart <= ROUNDING):
        return None
    row, column = np.unravel_index(int(np.argmax(apart)), apart.shape)
    return int(row), int(column)


def _check_sizes(body: Superelement) -> None:
    z, n = body.positions, body.coordinates
    require(
        z.ndim == 1 and len(z) >= 2 and z[0] == 0.0 and np.all(np.diff(z) > 0.0),
        "the positions must be those of two nodes or more, ascending from 0",
    )
    require(
        LENGTH_RANGE[0] <= z[-1] <= LENGTH_RANGE[1],
        f"the nodes are on {z[-1]:.4g} m, which is out of proportion; look at the units",
    )
    require(
        n <= MAX_COORDINATES,
        f"{n} coordinates per plane are too many, at most {MAX_COORDINATES} are possible; condense "
        "the model to fewer nodes, or import its modes",
    )
    require(n >= 3, f"{n} coordinates per plane hold no bending mode; such a rotor is rigid")
    shape = (2 * len(z), n if body.shapes is not None else 2 * len(z))
    for name, matrix, size in (
        ("M", body.mass_matrix, (shape[1],) * 2),
        ("K", body.stiffness_matrix, (shape[1],) * 2),
        ("G", body.polar_matrix, (shape[1],) * 2),
        ("shapes", body.shapes, shape),
    ):
        if matrix is not None and matrix.shape != size:
            raise TouchdownError(
                f"{name} is {by(matrix.shape)}; {len(z)} nodes and {n} coordinates make it {by(size)}"
            )
        if matrix is not None and not np.all(np.isfinite(matrix)):
            raise TouchdownError(f"{name} holds what is not a finite number")


def by(shape: tuple[int, ...]) -> str:
    """Of a matrix, in words: 3 by 4."""
    return " by ".join(map(str, shape)) or "a single number"


def _check_mass(mass: np.ndarray) -> None:
    """It must be positive definite."""
    size = np.diag(mass)
    if not np.all(size > 0.0):
        row = int(np.argmin(size)) + 1
        raise TouchdownError(
            f"M has no mass in row {row} ({size[row - 1]:g}); export a consistent mass matrix, not a "
            "lumped one, or condense that coordinate"
        )
    scale = 1.0 / np.sqrt(size)
    lowest = linalg.eigvalsh(mass * np.outer(scale, scale))[0]
    require(lowest > 0.0, "M is not positive definite: some motion would have no energy or less than none")


def _check_rigid(body: Superelement) -> None:
    """The two lowest modes must be the motions of a rigid body, in deflections and in slopes."""
    if body.shapes is None:
        return
    motion = rigid_motion(body.positions, 0.0)
    missed = np.abs(body.shapes @ body._rigid - motion)
    for column, what in enumerate(("translation", "tilt")):
        for part, name in ((0, "deflections"), (1, "slopes")):
            scale = np.max(np.abs(motion[part::2, column])) or np.max(np.abs(motion)) / body.positions[-1]
            require(
                np.max(missed[part::2, column]) <= RIGID_SHAPE_TOLERANCE * scale,
                f"no combination of the two lowest modes is a {what} of the rigid rotor: its {name} "
                "are missed; give both rigid modes of the free rotor, and slopes with the sign of dx/dz",
            )


def _check_proportion(body: Superelement) -> None:
    """It must not be heavier than any metal, as mistaken units make it.

    A body of mass m and polar inertia J on a length L is somewhere at least as dense as m^2 / (2 pi J L):
    that of a solid cylinder. Point masses without J would seem denser, so m / L^3 counts, too.
    """
    length, mass = float(body.positions[-1]), body.mass
    least = mass**2 / (2.0 * math.pi * body.polar_inertia * length)
    require(
        mass <= MAX_BULK_DENSITY * length**3 or least <= MAX_DENSITY,
        f"{mass:.5g} kg on {length:.4g} m is out of proportion, look at the units: t, not kg, goes "
        "with mm, s and N",
    )


def _check_inertia(body: Superelement) -> None:
    polar, diametral = body.polar_inertia, body.diametral_inertia
    require(
        diametral > 0.0,
        f"M has a diametral inertia of {diametral:.4g} kg.m2, which must be above 0; {FREE}",
    )
    require(
        polar >= 0.0,
        f"G has a polar inertia of {polar:.4g} kg.m2: its sign is the other one; turn it (a spin about "
        "the axis in the sense of the nodes' order is positive)",
    )
    require(polar != 0.0, "G has no polar inertia, and without one no rotor spins")
    require(
        polar <= 2.0 * diametral * (1.0 + RIGID_SHAPE_TOLERANCE),
        f"G has a polar inertia of {polar:.4g} kg.m2, which no body has beside a diametral one of "
        f"{diametral:.4g} kg.m2; G is per spin speed, in rad/s",
    )
    lowest, highest = linalg.eigvalsh(body.polar_matrix)[[0, -1]]
    require(
        lowest >= -ROUNDING * highest,
        f"G gives some section a negative polar inertia (its lowest value is {lowest:.3g})",
    )
    _check_proportion(body)


def _check_stiffness(body: Superelement) -> None:
    """Free but for the two rigid motions, and nowhere negative."""
    K, M = body.stiffness_matrix, body.mass_matrix
    square = linalg.eigh(K, M, eigvals_only=True)
    bending, noise = square[2], NOISE * square[-1]
    require(
        square[0] >= -(RIGID_FREQUENCY_RATIO**2) * abs(bending) - noise,
        f"K is not positive: some motion would have less energy than none; {FREE}",
    )
    rigid = body.matrices().rigid
    for motion, what in zip(rigid.T, ("moved sideways", "tilted"), strict=True):
        squared_frequency = (motion @ K @ motion) / (motion @ M @ motion)
        if abs(squared_frequency) > RIGID_FREQUENCY_RATIO**2 * max(bending, 0.0) + noise:
            swings = math.sqrt(abs(squared_frequency)) / (2.0 * math.pi)
            raise TouchdownError(
                f"K holds the rotor: {what} as a whole it swings at {swings:.4g} Hz; {FREE}"
            )
    require(
        bending > noise,
        "K leaves a third motion free in a plane (a hinge, or a part that is not fastened), or its "
        "numbers are too far apart to calculate with",
    )
    if body.shapes is not None and linalg.eigvalsh(K[2:, 2:], M[2:, 2:])[0] <= ROUNDING * bending + noise:
        raise TouchdownError(
            "with its first two coordinates held the rotor can still move as a rigid body; put the two "
            "rigid modes first"
        )
    first = math.sqrt(bending) / (2.0 * math.pi)
    require(
        BENDING_RANGE_HZ[0] <= first <= BENDING_RANGE_HZ[1],
        f"the first bending mode has {first:.4g} Hz, out of proportion; look at the units of M and K",
    )
