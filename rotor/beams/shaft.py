"""A flexible rotor as data: a stepped shaft of circular beam elements with what sits on it.

Nodes are numbered from 1, at the ends of the elements in their order; positions are measured along the
axis from node 1. SI units.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from touchdown.modelkit.model import ModelError
from touchdown.rotor.beams.element import Element, ring_area

MOST_NODES = 2000
MOST_STATIONS = 8


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
class Support:
    """Springs and dampers to the ground at a node, N/m and N s/m: for frequencies, not for the drop.

    >>> touchdown.Support(node=3, stiffness=2e7)
    Support(node=3, stiffness=20000000.0, stiffness_y=None, damping=0.0, damping_y=None)
    """

    node: int
    stiffness: float
    stiffness_y: float | None = None  # vertically; None: as horizontally
    damping: float = 0.0
    damping_y: float | None = None


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
    supports: tuple[Support, ...] = ()

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

    def _middles(self, z: np.ndarray) -> np.ndarray:
        """Where the elements have their centres of mass (N - 1,), m; nodes lie at z (N,)."""
        return 0.5 * (z[:-1] + z[1:]) + [e.centre_of_mass for e in self.elements]

    @cached_property
    def mass(self) -> float:
        """kg."""
        return sum(e.mass for e in self.elements) + sum(p.mass for p in self.points)

    @cached_property
    def centre_of_mass(self) -> float:
        """Its distance from node 1 (m)."""
        z = self.positions()
        moment = sum(e.mass * at for e, at in zip(self.elements, self._middles(z), strict=True))
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
        of_elements = (
            e.diametral_inertia + e.mass * at**2
            for e, at in zip(self.elements, self._middles(z), strict=True)
        )
        of_points = (p.diametral_inertia + p.mass * z[p.node - 1] ** 2 for p in self.points)
        return float(sum(of_elements) + sum(of_points))
