"""More nodes on a shaft: an element cut in two, and everything that sits further on counted anew."""

from __future__ import annotations

from dataclasses import replace
from typing import TypeVar

import numpy as np

from touchdown.modelkit.model import ModelError
from touchdown.rotor.beams.shaft import PointMass, Shaft, Station, Support, Unbalance

CLOSE = 1e-7  # m; a node this close is the one that is meant
SHORTEST = 1e-4  # m; of an element

AtNode = TypeVar("AtNode", PointMass, Unbalance, Station, Support)


def node_at(shaft: Shaft, position: float) -> int | None:
    """The node (from 1) at `position` (m from node 1), or None."""
    apart = np.abs(shaft.positions() - position)
    nearest = int(np.argmin(apart))
    return nearest + 1 if apart[nearest] <= CLOSE else None


def with_node(shaft: Shaft, position: float) -> Shaft:
    """The same rotor with a node at `position` (m from node 1), which cuts an element where there is none.

    Raises ModelError where the position is beyond the shaft, less than 0.1 mm from another node, or not a
    node of a superelement.
    """
    if node_at(shaft, position) is not None:
        return shaft
    z = shaft.positions()
    if not 0.0 < position < z[-1]:
        raise ModelError(
            f"{1e3 * position:g} mm is not on the rotor {shaft.title}, which ends at {1e3 * z[-1]:g} mm"
        )
    if not shaft.elements:
        near = int(np.argmin(np.abs(z - position)))
        raise ModelError(
            f"{1e3 * position:g} mm is no node of the rotor {shaft.title}, whose {shaft.body.kind} know "
            f"nothing between nodes; the nearest is node {near + 1} at {1e3 * z[near]:g} mm"
        )
    cut = int(np.searchsorted(z, position)) - 1
    if min(position - z[cut], z[cut + 1] - position) < SHORTEST:
        near = cut + 1 if position - z[cut] < SHORTEST else cut + 2
        raise ModelError(
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
