"""Stresses of a flexible rotor from its coordinates (Halminen (2016), section 3.2), and the nodes watched.

Bending (3.19): r E N'' q at the outer radius r of the core, by the modulus E of the core. It is
positive where the deflection curves upwards (y'' > 0), and then it is tension on the side of -y and
compression on the side of +y. Halminen (2016) prints (3.20) with the sign of -N'', that of the stress
on the side of +y; here (3.19) holds.

Shear (3.22): factor V / A of the core, with V = EI N''' q as in (3.10), V = M'. The factor is 4/3 for a
solid section only; 4/3 (ro^2 + ro ri + ri^2) / (ro^2 + ri^2) for a hollow one. Where a sleeve or a layer
carries a part of the moment, the core has the share of V that it has of EI. A cone's moment is that of its
middle section, whose shape functions it has; its stresses are those of the sections at its ends.

Stresses of the two planes are the same matrices times the real (x) and imaginary (y) coordinates.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise

import numpy as np

from ..beams.element import Element, shapes
from ..beams.shaft import Shaft
from .modes import Basis, residual_flexibility


@dataclass(frozen=True)
class Recovery:
    """Stresses at both ends of every element, R = 2 elements rows: start, end, start, ...

    Mode displacement: bending p, shear p (Pa). Mode acceleration adds what forces F (S,) at the loaded
    nodes deflect beyond the coordinates: bending p + bending_load F.
    """

    node: np.ndarray  # (R,), 1-based
    position: np.ndarray  # (R,), m from node 1
    bending: np.ndarray  # (R, n), Pa per unit of a coordinate
    shear: np.ndarray  # (R, n)
    bending_load: np.ndarray  # (R, S), Pa/N
    shear_load: np.ndarray  # (R, S)


def recovery(shaft: Shaft, basis: Basis, loaded_nodes: Sequence[int] = ()) -> Recovery:
    """Stress matrices of `basis` for forces at `loaded_nodes` (1-based)."""
    bending, shear = stress_rows(shaft)
    added = residual_flexibility(shaft, basis, loaded_nodes)
    node = end_nodes(shaft)
    return Recovery(
        node=node,
        position=shaft.positions()[node - 1],
        bending=bending @ basis.shapes,
        shear=shear @ basis.shapes,
        bending_load=bending @ added,
        shear_load=shear @ added,
    )


def end_nodes(shaft: Shaft) -> np.ndarray:
    """Node (1-based) of every row of stresses (R,): 1, 2, 2, 3, 3, ...; none without elements."""
    first = np.arange(1, len(shaft.elements) + 1)
    return np.stack((first, first + 1), axis=1).ravel()


def stress_rows(shaft: Shaft) -> tuple[np.ndarray, np.ndarray]:
    """Bending and shear stress per nodal displacement, each (R, 2N), by (3.20) and (3.22)."""
    rows = 2 * len(shaft.elements)
    bending, shear = np.zeros((rows, 2 * shaft.nodes)), np.zeros((rows, 2 * shaft.nodes))
    for i, element in enumerate(shaft.elements):
        core, dofs = element.parts[0], slice(2 * i, 2 * i + 4)
        N = shapes(core, np.array([0.0, element.length]))
        for end in (0, 1):
            section = core.section(end)
            bending[2 * i + end, dofs] = bending_per_moment(section) * core.EI * N.curvature[end]
            shear[2 * i + end, dofs] = shear_per_force(section) * core.EI * N.third[end]
    return bending, shear


def bending_per_moment(element: Element) -> float:
    """Stress at the outer radius of a cylinder's core per bending moment of the whole section (1/m3)."""
    return 0.5 * element.outer_diameter * element.modulus / element.EI


def shear_per_force(element: Element) -> float:
    """Largest shear stress in a cylinder's core per shear force of the whole section (1/m2)."""
    ro, ri = 0.5 * element.outer_diameter, 0.5 * element.inner_diameter
    factor = 4.0 / 3.0 * (ro**2 + ro * ri + ri**2) / (ro**2 + ri**2)
    return factor / element.area * element.core_EI / element.EI


MAX_STRESS_NODES = 64
MAX_SECTION_STEPS = 32  # of them at most where the section changes


def watched_nodes(shaft: Shaft) -> tuple[int, ...]:
    """Nodes, ascending from 1: all up to `MAX_STRESS_NODES`; none of a rotor without elements.

    Of more: the ends, the stations, the greatest changes of section, and then, one by one, the node in
    the middle of the longest stretch without one.
    """
    if not shaft.elements:
        return ()
    return tuple(range(1, shaft.nodes + 1)) if shaft.nodes <= MAX_STRESS_NODES else _chosen(shaft)


@lru_cache(maxsize=16)
def _chosen(shaft: Shaft) -> tuple[int, ...]:
    """`MAX_STRESS_NODES` of more nodes."""
    chosen = {1, shaft.nodes, *(s.node for s in shaft.stations)}
    changes = _changes(shaft)
    greatest = [node for node in sorted(changes, key=lambda n: -changes[n]) if changes[node] > 0.0]
    chosen |= set(greatest[:MAX_SECTION_STEPS])
    z = shaft.positions()
    while len(chosen) < MAX_STRESS_NODES:
        chosen.add(_between(sorted(chosen), z))
    return tuple(sorted(chosen))


def _changes(shaft: Shaft) -> dict[int, float]:
    """How much the bending stress per moment jumps at each inner node: the logarithm of its ratio."""
    return {
        node: abs(math.log(_per_moment(left.section(1.0)) / _per_moment(right.section(0.0))))
        for node, (left, right) in enumerate(pairwise(shaft.elements), 2)
        if left != right
    }


def _per_moment(section: Element) -> float:
    return section.outer_diameter * section.modulus / section.EI


def _between(chosen: list[int], z: np.ndarray) -> int:
    """The node nearest to the middle of the longest stretch (m) between chosen ones that has any."""
    stretches = [(z[b - 1] - z[a - 1], a, b) for a, b in pairwise(chosen) if b > a + 1]
    _, a, b = max(stretches)
    middle = 0.5 * (z[a - 1] + z[b - 1])
    inner = np.arange(a + 1, b)
    return int(inner[np.argmin(np.abs(z[inner - 1] - middle))])
