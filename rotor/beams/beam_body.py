"""A rotor's body: matrices in one plane. Here beams, with masses fixed to them.

The rotor is the same in both planes, so its motion is complex: z = x + i y per node, the slope likewise
(turn of the section in the x-z plane + i times that in the y-z plane). x is horizontal, y is up, the
spin Omega counter-clockwise. With alpha = dOmega/dt, (3.24) reads

    M p'' - i Omega G p' - i alpha G p + K p = shapes^T F,   gravity: F = -i g M e,

in coordinates p (n,), of which q = shapes p (2N,) holds (z, slope) node by node, and e is a unit
translation. The coordinates of beams are those of the nodes: p = q.

All that is asked of a body is what `Beams` has but for its elements and points; the other kind of it is
`rotor.beams.superelement`. Inertias are those of the undeformed rotor.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy import sparse

from ...modelkit.reader import Kind, key, number, whole
from .element import Element, element_matrices, ring_area

USUAL = {  # SI unit: an example; beyond the limits it is a slip, or too far apart to calculate with
    "m": ("12.5 mm", 1e-4, 1e2), "Pa": ("207 GPa", 1e3, 1e13), "kg/m3": ("7830 kg/m3", 1.0, 1e5),
    "kg": ("0.5 kg", 1e-9, 1e6), "kg.m2": ("0.002 kg.m2", 1e-15, 1e7), "kg.m": ("3 g.mm", 1e-12, 1e3),
    "rad": ("90 deg", 0.0, 1e3), "N/m": ("20 MN/m", 1e-3, 1e15), "N.s/m": ("500 N.s/m", 1e-6, 1e12),
}  # fmt: skip
NODE = whole(1, what="node's number")


def in_unit(unit: str, **bounds: float) -> Kind:
    """A value of a rotor file, which has a unit."""
    example, *limits = USUAL[unit]
    return number(unit, strict=True, size=(limits[0], limits[1]), example=example, **bounds)


@dataclass(frozen=True)
class Matrices:
    """Of n coordinates: mass M, stiffness K, gyroscopic ("polar") G, all symmetric; and how nodes move."""

    mass: np.ndarray  # (n, n)
    stiffness: np.ndarray  # (n, n)
    polar: np.ndarray  # (n, n)
    shapes: np.ndarray | sparse.csr_array  # (2N, n)
    rigid: np.ndarray  # (n, 2): a translation by 1 m; a tilt of 1 about the centre of mass


def rigid_motion(positions: np.ndarray, centre: float) -> np.ndarray:
    """Translation by 1 m and tilt of 1 about `centre` (m) of nodes at `positions` (N,): (2N, 2)."""
    motion = np.ones((2 * len(positions), 2))
    motion[1::2, 0] = 0.0
    motion[0::2, 1] = positions - centre
    return motion


@dataclass(frozen=True)
class PointMass:
    """A rigid body fixed to the section at a node: kg, kg m2 about the axis and about a diameter.

    >>> touchdown.PointMass(node=5, mass=1.2, polar_inertia=2e-3, diametral_inertia=1e-3).mass
    1.2
    """

    node: int = key(NODE)
    mass: float = key(in_unit("kg", minimum=0.0))
    polar_inertia: float = key(in_unit("kg.m2", minimum=0.0), 0.0, "about the shaft")
    diametral_inertia: float = key(in_unit("kg.m2", minimum=0.0), 0.0, "about a diameter")


def disc_mass(node: int, outer: float, inner: float, width: float, density: float) -> PointMass:
    """A disc fixed at a node: diameters and width in m, density in kg/m3."""
    mass = density * ring_area(outer, inner) * width
    square = (outer**2 + inner**2) / 4.0
    return PointMass(node, mass, 0.5 * mass * square, mass * (3.0 * square + width**2) / 12.0)


@dataclass(frozen=True)
class Beams:
    """A stepped shaft: elements in their order, and what sits on its nodes."""

    elements: tuple[Element, ...]
    points: tuple[PointMass, ...] = ()

    @property
    def kind(self) -> str:
        """The kind of body, in words."""
        return f"Timoshenko beam of {len(self.elements)} elements"

    @cached_property
    def positions(self) -> np.ndarray:
        """Of the nodes, from node 1 (N,), in m."""
        return np.concatenate(([0.0], np.cumsum([e.length for e in self.elements])))

    @property
    def coordinates(self) -> int:
        """Deflection and slope of each node."""
        return 2 * len(self.elements) + 2

    @cached_property
    def _middles(self) -> np.ndarray:
        """Where the elements have their centres of mass (N - 1,), m."""
        z = self.positions
        return 0.5 * (z[:-1] + z[1:]) + [e.centre_of_mass for e in self.elements]

    @cached_property
    def mass(self) -> float:
        """kg."""
        return sum(e.mass for e in self.elements) + sum(p.mass for p in self.points)

    @cached_property
    def centre_of_mass(self) -> float:
        """Its distance from node 1 (m)."""
        moment = sum(e.mass * middle for e, middle in zip(self.elements, self._middles, strict=True))
        moment += sum(p.mass * self.positions[p.node - 1] for p in self.points)
        return float(moment) / self.mass

    @cached_property
    def polar_inertia(self) -> float:
        """About the axis (kg m2)."""
        return sum(e.polar_inertia for e in self.elements) + sum(p.polar_inertia for p in self.points)

    @cached_property
    def diametral_inertia(self) -> float:
        """About a diameter through the centre of mass (kg m2)."""
        arms = self._middles - self.centre_of_mass
        of_elements = (
            e.diametral_inertia + e.mass * arm**2 for e, arm in zip(self.elements, arms, strict=True)
        )
        z = self.positions - self.centre_of_mass
        of_points = (p.diametral_inertia + p.mass * z[p.node - 1] ** 2 for p in self.points)
        return float(sum(of_elements) + sum(of_points))

    def matrices(self) -> Matrices:
        """Elements, sleeves and point masses together."""
        size = self.coordinates
        mass, stiffness, polar = np.zeros((size, size)), np.zeros((size, size)), np.zeros((size, size))
        for i, element in enumerate(self.elements):
            blocks = element_matrices(element)
            rows = slice(2 * i, 2 * i + 4)
            mass[rows, rows] += blocks.mass
            stiffness[rows, rows] += blocks.stiffness
            polar[rows, rows] += blocks.polar
        for point in self.points:
            y = 2 * (point.node - 1)
            mass[y, y] += point.mass
            mass[y + 1, y + 1] += point.diametral_inertia
            polar[y + 1, y + 1] += point.polar_inertia
        rigid = rigid_motion(self.positions, self.centre_of_mass)
        return Matrices(mass, stiffness, polar, sparse.csr_array(sparse.eye_array(size)), rigid)
