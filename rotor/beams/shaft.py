"""A flexible rotor as data: elements, masses, seats, supports, and the matrices of the whole.

It is a stepped shaft of circular beam elements, or a superelement of matrices. Nodes are numbered from 1,
at the ends of the elements in their order; positions are measured along the axis from node 1. SI units.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import NamedTuple, TypeVar

import numpy as np
from scipy import linalg

from ...modelkit.errors import TouchdownError, require
from ...modelkit.reader import TEXT, key, listed, number
from .beam_body import NODE, Beams, Matrices, PointMass, in_unit
from .element import Element
from .superelement import Superelement

MAX_NODES = 2000
MAX_STATIONS = 8


@dataclass(frozen=True)
class Unbalance:
    """A heavy spot: mass times radius (kg m) at an angle counter-clockwise from x (rad).

    >>> touchdown.Unbalance(node=5, moment=3e-6)
    Unbalance(node=5, moment=3e-06, angle=0.0)
    """

    node: int = key(NODE)
    moment: float = key(in_unit("kg.m", minimum=0.0), says="mass times radius")
    angle: float = key(in_unit("rad"), 0.0, "counter-clockwise from x")


@dataclass(frozen=True)
class Support:
    """Springs and dampers to the ground at a node, N/m and N s/m: for frequencies, not for the drop.

    >>> touchdown.Support(node=3, stiffness=2e7)
    Support(node=3, stiffness=20000000.0, stiffness_y=None, damping=0.0, damping_y=None)
    """

    node: int = key(NODE)
    stiffness: float = key(in_unit("N/m", minimum=0.0))
    stiffness_y: float | None = key(in_unit("N/m", minimum=0.0), None, "vertical; else as horizontal")
    damping: float = key(in_unit("N.s/m", minimum=0.0), 0.0)
    damping_y: float | None = key(in_unit("N.s/m", minimum=0.0), None, "vertical; else as horizontal")


@dataclass(frozen=True)
class Station:
    """A node with a name: a place where the rotor takes loads, or one that a sensor looks at.

    >>> [s.node for s in touchdown.Rotor.load("rotor_I").stations if s.name == "A"]
    [3]
    """

    name: str
    node: int


class Gap(NamedTuple):
    """A part around the rotor that the rotor must not touch."""

    name: str
    station: str  # or sensor
    radial: float  # m
    journal_radius: float | None = None  # m, of the rotor there, where touching acts

    @property
    def key(self) -> str:
        """The name of a station or sensor of its own."""
        return "gap_" + re.sub(r"[ -]", "_", self.name)


@dataclass(frozen=True)
class Shaft:
    """The rotor. Inertias are those of the undeformed rotor."""

    title: str = key(TEXT)
    elements: tuple[Element, ...] = ()
    points: tuple[PointMass, ...] = ()
    unbalances: tuple[Unbalance, ...] = ()
    stations: tuple[Station, ...] = ()
    sensors: tuple[Station, ...] = ()
    levitated_at: tuple[str, ...] = key(listed(TEXT), (), "stations that hold the rotor at the start")
    damping_ratio: float = key(number(minimum=0.0, below=1.0), 0.003, "of the bending modes")
    about: str = key(TEXT, "", "for readers")
    supports: tuple[Support, ...] = ()
    gaps: tuple[Gap, ...] = ()
    superelement: Superelement | None = None  # in place of elements and points
    called: tuple[str, ...] = field(default=(), compare=False)  # nodes, where it is from; not in its file

    @cached_property
    def body(self) -> Beams | Superelement:
        """The body of beams, or the superelement, that the shaft consists of."""
        return self.superelement or Beams(self.elements, self.points)

    @property
    def nodes(self) -> int:
        """How many there are (N)."""
        return len(self.body.positions)

    @property
    def seats(self) -> tuple[Station, ...]:
        """Stations where touchdown bearings hold it: no magnetic bearing's, and of no gap that acts."""
        others = {*self.levitated_at, *(g.station for g in self.gaps if g.journal_radius is not None)}
        return tuple(s for s in self.stations if s.name not in others)

    @property
    def coordinates(self) -> int:
        """How many describe its motion in a plane (n): with beams two per node."""
        return self.body.coordinates

    def positions(self) -> np.ndarray:
        """Of the nodes, from node 1 (N,), in m."""
        return self.body.positions

    def node(self, station: str) -> int:
        """The node of a station. Raises TouchdownError where no station has that name."""
        for s in (*self.stations, *self.sensors):
            if s.name == station:
                return s.node
        names = ", ".join(s.name for s in self.stations) or "none"
        raise TouchdownError(f"the rotor {self.title} has no station {station}; it has: {names}")

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


TOO_UNLIKE_MESSAGE = (
    "the elements of the rotor are too unlike each other to be calculated together; "
    "look for very short or very thin ones"
)


def assembled_matrices(shaft: Shaft) -> Matrices:
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
    """Raises TouchdownError where one of `nodes` (1-based) does not exist."""
    for node in nodes:
        require(
            1 <= node <= shaft.nodes, f"node {node}: the rotor {shaft.title} has nodes 1 to {shaft.nodes}"
        )


def solve_held(stiffness: np.ndarray, loads: np.ndarray) -> np.ndarray:
    """Deflections of a held rotor, scaled first: deflections and slopes are of different size.

    Raises TouchdownError where elements are too unlike each other to be calculated together.
    """
    scale = 1.0 / np.sqrt(np.diag(stiffness))
    try:
        factor = linalg.cho_factor(stiffness * np.outer(scale, scale))
    except linalg.LinAlgError:
        raise TouchdownError(TOO_UNLIKE_MESSAGE) from None
    return (scale * linalg.cho_solve(factor, (scale * loads.T).T).T).T


NODE_TOLERANCE = 1e-7  # m; a node this close is the one that is meant
MIN_ELEMENT_LENGTH = 1e-4  # m; of an element

AtNode = TypeVar("AtNode", PointMass, Unbalance, Station, Support)


def node_at(shaft: Shaft, position: float) -> int | None:
    """The node (from 1) at `position` (m from node 1), or None."""
    apart = np.abs(shaft.positions() - position)
    nearest = int(np.argmin(apart))
    return nearest + 1 if apart[nearest] <= NODE_TOLERANCE else None


def with_node(shaft: Shaft, position: float) -> Shaft:
    """The same rotor with a node at `position` (m from node 1), which cuts an element where it has no node.

    Raises TouchdownError where it is beyond the shaft, less than 0.1 mm from another node, or not a node
    of a superelement.
    """
    if node_at(shaft, position) is not None:
        return shaft
    z = shaft.positions()
    require(
        0.0 < position < z[-1],
        f"{1e3 * position:g} mm is not on the rotor {shaft.title}, which ends at {1e3 * z[-1]:g} mm",
    )
    if not shaft.elements:
        near = int(np.argmin(np.abs(z - position)))
        raise TouchdownError(
            f"{1e3 * position:g} mm is not a node of the rotor {shaft.title}, whose {shaft.body.kind} know "
            f"nothing between nodes; the nearest is node {near + 1} at {1e3 * z[near]:g} mm"
        )
    cut = int(np.searchsorted(z, position)) - 1
    if min(position - z[cut], z[cut + 1] - position) < MIN_ELEMENT_LENGTH:
        near = cut + 1 if position - z[cut] < MIN_ELEMENT_LENGTH else cut + 2
        raise TouchdownError(
            f"{1e3 * position:g} mm is less than 0.1 mm from node {near} of the rotor {shaft.title}; "
            f"name that node"
        )
    element = shaft.elements[cut]
    place = (position - z[cut]) / element.length
    pieces = (element.between(0.0, place), element.between(place, 1.0))

    def moved(things: tuple[AtNode, ...]) -> tuple[AtNode, ...]:
        return tuple(replace(t, node=t.node + 1) if t.node > cut + 1 else t for t in things)

    return replace(
        shaft,
        elements=(*shaft.elements[:cut], *pieces, *shaft.elements[cut + 1 :]),
        points=moved(shaft.points),
        unbalances=moved(shaft.unbalances),
        stations=moved(shaft.stations),
        sensors=moved(shaft.sensors),
        supports=moved(shaft.supports),
    )
