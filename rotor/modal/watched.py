"""The nodes of a rotor whose stresses are followed: all, or of a long list those where they matter."""

from __future__ import annotations

import math
from functools import lru_cache
from itertools import pairwise

import numpy as np

from touchdown.rotor.beams.element import Element
from touchdown.rotor.beams.shaft import Shaft

MOST_WATCHED = 64
STEPS = 32  # of them at most where the section changes


def watched(shaft: Shaft) -> tuple[int, ...]:
    """Nodes, ascending from 1: all up to `MOST_WATCHED`; none of a rotor without elements.

    Of more: the ends, the stations, the greatest changes of section, and then, one by one, the node in
    the middle of the longest stretch without one.
    """
    if not shaft.elements:
        return ()
    return tuple(range(1, shaft.nodes + 1)) if shaft.nodes <= MOST_WATCHED else _chosen(shaft)


@lru_cache(maxsize=16)
def _chosen(shaft: Shaft) -> tuple[int, ...]:
    """`MOST_WATCHED` of more nodes."""
    chosen = {1, shaft.nodes, *(s.node for s in shaft.stations)}
    changes = _changes(shaft)
    greatest = [node for node in sorted(changes, key=lambda n: -changes[n]) if changes[node] > 0.0]
    chosen |= set(greatest[:STEPS])
    z = shaft.positions()
    while len(chosen) < MOST_WATCHED:
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
