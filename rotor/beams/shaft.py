"""A flexible rotor as data: a stepped shaft of circular beam elements with what sits on it.

Nodes are numbered from 1, at the ends of the elements in their order; positions are measured along the
axis from node 1. SI units.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from touchdown.modelkit.model import ModelError

MOST_NODES = 64
MOST_STATIONS = 8


def ring_area(outer: float, inner: float) -> float:
    """Area between two diameters (m2)."""
    return math.pi / 4.0 * (outer**2 - inner**2)


def ring_second_moment(outer: float, inner: float) -> float:
    """Second moment of area between two diameters, about a diameter (m4)."""
    return math.pi / 64.0 * (outer**4 - inner**4)


def cowper(poisson: float, ratio: float) -> float:
    """Shear correction factor of a circular section with inner over outer diameter `ratio`.

    Cowper (1966); 6 (1 + nu) / (7 + 6 nu) for a solid section.
    """
    square = ratio**2
    full = (1.0 + square) ** 2
    return 6.0 * (1.0 + poisson) * full / ((7.0 + 6.0 * poisson) * full + (20.0 + 12.0 * poisson) * square)


@dataclass(frozen=True, kw_only=True)
class Element:
    """A cylinder (the core), solid or hollow, with an optional sleeve around it.

    The sleeve reaches from `outer_diameter` to `sleeve_diameter` and always adds mass and rotary
    inertia. It adds stiffness by its modulus: to EI, and to kGA with the shear factor and the Poisson's
    ratio of the core; a modulus of 0 means laminations, which carry nothing. Lengths and diameters in m,
    moduli in Pa, densities in kg/m3.

    >>> steel = touchdown.Element(
    ...     length=0.1, outer_diameter=0.04, modulus=207e9, density=7830.0, poisson=0.3
    ... )
    >>> round(steel.mass, 3)  # kg
    0.984
    """

    length: float
    outer_diameter: float
    inner_diameter: float = 0.0
    modulus: float
    density: float
    poisson: float
    shear_factor: float | None = None  # None: Cowper's for the core
    sleeve_diameter: float = 0.0  # 0: no sleeve
    sleeve_density: float = 0.0
    sleeve_modulus: float = 0.0

    @property
    def kappa(self) -> float:
        """Shear correction factor of (3.9)."""
        if self.shear_factor is not None:
            return self.shear_factor
        return cowper(self.poisson, self.inner_diameter / self.outer_diameter)

    @property
    def area(self) -> float:
        """Of the core (m2)."""
        return ring_area(self.outer_diameter, self.inner_diameter)

    @property
    def second_moment(self) -> float:
        """Of the core's area, about a diameter (m4)."""
        return ring_second_moment(self.outer_diameter, self.inner_diameter)

    @property
    def core_EI(self) -> float:
        """Bending stiffness of the core alone (N m2)."""
        return self.modulus * self.second_moment

    @property
    def EI(self) -> float:
        """Bending stiffness, with the sleeve (N m2)."""
        return self.core_EI + self.sleeve_modulus * self._sleeve_second_moment

    @property
    def kGA(self) -> float:
        """Shear stiffness, with the sleeve (N)."""
        modulus_area = self.modulus * self.area + self.sleeve_modulus * self._sleeve_area
        return self.kappa * modulus_area / (2.0 * (1.0 + self.poisson))

    @property
    def mass_per_length(self) -> float:
        """With the sleeve (kg/m)."""
        return self.density * self.area + self.sleeve_density * self._sleeve_area

    @property
    def diametral_inertia_per_length(self) -> float:
        """Rotary inertia about a diameter, with the sleeve (kg m); the polar one is twice as large."""
        return self.density * self.second_moment + self.sleeve_density * self._sleeve_second_moment

    @property
    def phi(self) -> float:
        """Shear deformation parameter (3.12)."""
        return 12.0 * self.EI / (self.kGA * self.length**2)

    @property
    def mass(self) -> float:
        """kg."""
        return self.mass_per_length * self.length

    @property
    def polar_inertia(self) -> float:
        """kg m2."""
        return 2.0 * self.diametral_inertia_per_length * self.length

    @property
    def diametral_inertia(self) -> float:
        """About the middle of the element (kg m2)."""
        return self.diametral_inertia_per_length * self.length + self.mass * self.length**2 / 12.0

    @property
    def _sleeve_area(self) -> float:
        return ring_area(self.sleeve_diameter, self.outer_diameter) if self.sleeve_diameter else 0.0

    @property
    def _sleeve_second_moment(self) -> float:
        return (
            ring_second_moment(self.sleeve_diameter, self.outer_diameter) if self.sleeve_diameter else 0.0
        )


@dataclass(frozen=True)
class PointMass:
    """A rigid body fixed to the section at a node: kg, kg m2 about the axis and about a diameter.

    >>> touchdown.PointMass(node=5, mass=1.2, polar_inertia=2e-3, diametral_inertia=1e-3).mass
    1.2
    """

    node: int
    mass: float
    polar_inertia: float = 0.0
    diametral_inertia: float = 0.0


def disc(node: int, outer: float, inner: float, width: float, density: float) -> PointMass:
    """A disc fixed at a node: diameters and width in m, density in kg/m3."""
    mass = density * ring_area(outer, inner) * width
    square = (outer**2 + inner**2) / 4.0
    return PointMass(node, mass, 0.5 * mass * square, mass * (3.0 * square + width**2) / 12.0)


@dataclass(frozen=True)
class Unbalance:
    """A heavy spot: mass times radius (kg m) at an angle counter-clockwise from x (rad).

    >>> touchdown.Unbalance(node=5, moment=3e-6)
    Unbalance(node=5, moment=3e-06, angle=0.0)
    """

    node: int
    moment: float
    angle: float = 0.0


@dataclass(frozen=True)
class Station:
    """A node with a name: a place where the rotor takes loads, or one that a sensor looks at.

    >>> [s.node for s in touchdown.Rotor.load("rotor_I").stations if s.name == "A"]
    [3]
    """

    name: str
    node: int


@dataclass(frozen=True)
class Shaft:
    """The rotor. Inertias are those of the undeformed rotor."""

    title: str
    elements: tuple[Element, ...]
    points: tuple[PointMass, ...] = ()
    unbalances: tuple[Unbalance, ...] = ()
    stations: tuple[Station, ...] = ()
    sensors: tuple[Station, ...] = ()
    levitated_at: tuple[str, ...] = ()  # stations that hold the rotor at rest at the start
    damping_ratio: float = 0.003  # of the bending modes
    about: str = ""

    @property
    def nodes(self) -> int:
        """How many there are (N)."""
        return len(self.elements) + 1

    def positions(self) -> np.ndarray:
        """Of the nodes, from node 1 (N,), in m."""
        return np.concatenate(([0.0], np.cumsum([e.length for e in self.elements])))

    def node(self, station: str) -> int:
        """The node of a station. Raises ModelError where there is none of that name."""
        for s in (*self.stations, *self.sensors):
            if s.name == station:
                return s.node
        names = ", ".join(s.name for s in self.stations) or "none"
        raise ModelError(f"the rotor {self.title} has no station {station}; it has: {names}")

    @cached_property
    def mass(self) -> float:
        """kg."""
        return sum(e.mass for e in self.elements) + sum(p.mass for p in self.points)

    @cached_property
    def centre_of_mass(self) -> float:
        """Its distance from node 1 (m)."""
        z = self.positions()
        middles = 0.5 * (z[:-1] + z[1:])
        moment = sum(e.mass * at for e, at in zip(self.elements, middles, strict=True))
        moment += sum(p.mass * z[p.node - 1] for p in self.points)
        return float(moment) / self.mass

    @cached_property
    def polar_inertia(self) -> float:
        """About the axis (kg m2)."""
        return sum(e.polar_inertia for e in self.elements) + sum(p.polar_inertia for p in self.points)

    @cached_property
    def diametral_inertia(self) -> float:
        """About a diameter through the centre of mass (kg m2)."""
        z = self.positions() - self.centre_of_mass
        middles = 0.5 * (z[:-1] + z[1:])
        of_elements = (
            e.diametral_inertia + e.mass * at**2 for e, at in zip(self.elements, middles, strict=True)
        )
        of_points = (p.diametral_inertia + p.mass * z[p.node - 1] ** 2 for p in self.points)
        return float(sum(of_elements) + sum(of_points))
