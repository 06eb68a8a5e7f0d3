"""Stresses along a rotor: now, at their peak, and node by node when they peaked.

sigma = r E Y'' (3.20, 3.21) and tau = 4/3 V/A (3.22, 3.23; solid sections) at both ends of every element,
from the modal coordinates, and from the loads by what the modes left out would add (mode acceleration).
A node's stress is the larger of its elements'. R: ends of the elements, two each.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

from touchdown.modelkit.kernel import inlined, kernel
from touchdown.modelkit.variables import integer, real
from touchdown.rotor.motion.state import modal


@dataclass(frozen=True)
class StressOptions:
    """What to compute of the stresses."""

    active: int = integer(1, "0: no stresses are computed", minimum=0, maximum=1)
    mode_acceleration: int = integer(
        1, "1: loads add what the modes left out would; 0: kept modes only", minimum=0, maximum=1
    )
    node: int = integer(
        0,
        "node whose vertical bending stress decides when the stresses along the rotor are kept; "
        "0: the largest bending stress anywhere",
        minimum=0,
    )


@dataclass(frozen=True)
class StressReport:
    """The largest stresses; resultants of both planes."""

    bending: float = real(0.0, "Pa", "largest bending stress along the rotor", local=True, nominal=1e6)
    shear: float = real(0.0, "Pa", "largest shear stress along the rotor", local=True, nominal=1e6)
    peak_bending: float = real(0.0, "Pa", "largest bending stress since the start", local=True, nominal=1e6)
    peak_bending_time: float = real(0.0, "s", "when", local=True)
    peak_bending_node: int = integer(0, "where; nodes count from 1", local=True)
    peak_shear: float = real(0.0, "Pa", "largest shear stress since the start", local=True, nominal=1e6)
    peak_shear_time: float = real(0.0, "s", "when", local=True)
    peak_shear_node: int = integer(0, "where; nodes count from 1", local=True)
    kept_time: float = real(0.0, "s", "instant of the stresses kept along the rotor", local=True)


@dataclass(frozen=True)
class NodeStress:
    """Stresses at a node, at the instant that was kept, and the node's own peaks."""

    bending_x: float = real(0.0, "Pa", "bending stress in the horizontal plane, when kept", local=True)
    bending_y: float = real(0.0, "Pa", "bending stress in the vertical plane, when kept", local=True)
    shear_x: float = real(0.0, "Pa", "shear stress by horizontal forces, when kept", local=True)
    shear_y: float = real(0.0, "Pa", "shear stress by vertical forces, when kept", local=True)
    peak_bending: float = real(0.0, "Pa", "largest bending stress since the start", local=True)
    peak_shear: float = real(0.0, "Pa", "largest shear stress since the start", local=True)
    position: float = real(0.0, "m", "along the axis, from node 1", constant=True)


class Peak(NamedTuple):
    """The largest stress (Pa) and its node, from 1."""

    stress: float
    node: int


@kernel
def report(q, m, time):
    """Stresses in state q (N,) at the end of a macro step, `time` (s), and their peaks, into m.o (Pa)."""
    o = m.o.stress
    worst_bending, worst_shear, watched = _largest(q, m)
    o.bending, o.shear = worst_bending.stress, worst_shear.stress
    if o.bending > o.peak_bending:
        o.peak_bending, o.peak_bending_time, o.peak_bending_node = o.bending, time, worst_bending.node
    if o.shear > o.peak_shear:
        o.peak_shear, o.peak_shear_time, o.peak_shear_node = o.shear, time, worst_shear.node
    if watched > m.s.watched:
        m.s.watched = watched
        o.kept_time = time
        keep(q, m)


@inlined
def _largest(q, m):
    """Largest bending and shear along the rotor (`Peak` each), and the stress that decides what is kept.

    Updates the nodes' own peaks.
    """
    rows, decisive = m.d.stress, m.p.stress.node
    most_bending, most_shear, watched = Peak(0.0, 0), Peak(0.0, 0), 0.0
    for row in range(rows.ends):
        node = int(rows.node[row])
        bending_x, bending_y = _at_end(row, rows.bending, rows.bending_load, q, m)
        shear_x, shear_y = _at_end(row, rows.shear, rows.shear_load, q, m)
        bending = math.sqrt(bending_x * bending_x + bending_y * bending_y)
        shear = math.sqrt(shear_x * shear_x + shear_y * shear_y)
        own = m.o.node[node - 1]
        own.peak_bending, own.peak_shear = max(own.peak_bending, bending), max(own.peak_shear, shear)
        if bending > most_bending.stress:
            most_bending = Peak(bending, node)
        if shear > most_shear.stress:
            most_shear = Peak(shear, node)
        if node == decisive:
            watched = max(watched, abs(bending_y))
    return most_bending, most_shear, watched if decisive else most_bending.stress


@kernel
def _at_end(row, per_mode, per_load, q, m):
    """Stresses (x, y), Pa, at one end of an element under the loads at the end of the macro step.

    per_mode (R, n) and per_load (R, S): stress per modal coordinate and per force; `row` of R.
    """
    px, py, _, _ = modal(q, m)
    sx, sy = 0.0, 0.0
    for k in range(m.d.modes):
        sx += per_mode[row, k] * px[k]
        sy += per_mode[row, k] * py[k]
    for j in range(m.d.stations):
        load = m.u.station[j]
        sx += per_load[row, j] * (load.fx + load.dfx * m.half)
        sy += per_load[row, j] * (load.fy + load.dfy * m.half)
    return sx, sy


@kernel
def keep(q, m):
    """Keep the stresses along the rotor in state q (N,), in m.o.node (Pa)."""
    rows = m.d.stress
    for i in range(m.d.nodes):
        o = m.o.node[i]
        o.bending_x, o.bending_y, o.shear_x, o.shear_y = 0.0, 0.0, 0.0, 0.0
    for row in range(rows.ends):
        o = m.o.node[int(rows.node[row]) - 1]
        bending_x, bending_y = _at_end(row, rows.bending, rows.bending_load, q, m)
        shear_x, shear_y = _at_end(row, rows.shear, rows.shear_load, q, m)
        o.bending_x, o.bending_y = _larger(o.bending_x, bending_x), _larger(o.bending_y, bending_y)
        o.shear_x, o.shear_y = _larger(o.shear_x, shear_x), _larger(o.shear_y, shear_y)


@inlined
def _larger(before, stress):
    """The one of larger size, with its sign (Pa)."""
    return stress if abs(stress) > abs(before) else before
