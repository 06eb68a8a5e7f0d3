"""A flexible rotor as data: what it is made of, and what sits on it and holds it.

It is a stepped shaft of circular beam elements, or a superelement of matrices. Nodes are numbered from 1,
at the ends of the elements in their order; positions are measured along the axis from node 1. SI units.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from touchdown.modelkit.model import ModelError
from touchdown.rotor.beams.body import Beams
from touchdown.rotor.beams.body import PointMass as PointMass
from touchdown.rotor.beams.body import disc as disc
from touchdown.rotor.beams.element import Element
from touchdown.rotor.beams.superelement import Superelement

MOST_NODES = 2000
MOST_STATIONS = 8


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
    elements: tuple[Element, ...] = ()
    points: tuple[PointMass, ...] = ()
    unbalances: tuple[Unbalance, ...] = ()
    stations: tuple[Station, ...] = ()
    sensors: tuple[Station, ...] = ()
    levitated_at: tuple[str, ...] = ()  # stations that hold the rotor at rest at the start
    damping_ratio: float = 0.003  # of the bending modes
    about: str = ""
    supports: tuple[Support, ...] = ()
    superelement: Superelement | None = None  # in place of elements and points
    called: tuple[str, ...] = field(default=(), compare=False)  # nodes, where it is from; not in its file

    @cached_property
    def body(self) -> Beams | Superelement:
        """What it is made of."""
        return self.superelement or Beams(self.elements, self.points)

    @property
    def nodes(self) -> int:
        """How many there are (N)."""
        return len(self.body.positions)

    @property
    def coordinates(self) -> int:
        """How many describe its motion in a plane (n): with beams two per node."""
        return self.body.coordinates

    def positions(self) -> np.ndarray:
        """Of the nodes, from node 1 (N,), in m."""
        return self.body.positions

    def node(self, station: str) -> int:
        """The node of a station. Raises ModelError where there is none of that name."""
        for s in (*self.stations, *self.sensors):
            if s.name == station:
                return s.node
        names = ", ".join(s.name for s in self.stations) or "none"
        raise ModelError(f"the rotor {self.title} has no station {station}; it has: {names}")

    @property
    def mass(self) -> float:
        """kg."""
        return self.body.mass

    @property
    def centre_of_mass(self) -> float:
        """Its distance from node 1 (m)."""
        return self.body.centre_of_mass

    @property
    def polar_inertia(self) -> float:
        """About the axis (kg m2)."""
        return self.body.polar_inertia

    @property
    def diametral_inertia(self) -> float:
        """About a diameter through the centre of mass (kg m2)."""
        return self.body.diametral_inertia
