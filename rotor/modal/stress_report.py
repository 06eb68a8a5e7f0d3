"""Stresses along a rotor: now, at their peak, and node by node when they peaked.

sigma = r E Y'' (3.20, 3.21) and tau = 4/3 V/A (3.22, 3.23; solid sections) at both ends of every element,
from the modal coordinates, and from the loads by what the modes left out would add (mode acceleration).
A node's stress is the larger of its elements'.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from touchdown.modelkit.kernel import kernel
from touchdown.modelkit.variables import integer, real


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


@kernel
def _at_end(row, per_mode, per_load, y, m):
    """Stresses (x, y) at one element end under the loads at the end of the macro step."""
    n, half = m.d.modes, m.half
    sx, sy = 0.0, 0.0
    for k in range(n):
        sx += per_mode[row, k] * y[k]
        sy += per_mode[row, k] * y[n + k]
    for j in range(m.d.stations):
        u = m.u.station[j]
        sx += per_load[row, j] * (u.fx + u.dfx * half)
        sy += per_load[row, j] * (u.fy + u.dfy * half)
    return sx, sy


@kernel
def report(y, m, time):
    """Stresses at the end of a macro step, and their peaks."""
    d, o = m.d, m.o.stress
    o.bending, o.shear = 0.0, 0.0
    at_bending, at_shear, watched = 0, 0, 0.0
    for row in range(d.ends):
        node = int(d.end_node[row])
        bx, by = _at_end(row, d.bending, d.bending_load, y, m)
        sx, sy = _at_end(row, d.shear, d.shear_load, y, m)
        bending, shear = math.sqrt(bx * bx + by * by), math.sqrt(sx * sx + sy * sy)
        own = m.o.node[node]
        own.peak_bending, own.peak_shear = max(own.peak_bending, bending), max(own.peak_shear, shear)
        if bending > o.bending:
            o.bending, at_bending = bending, node + 1
        if shear > o.shear:
            o.shear, at_shear = shear, node + 1
        if node + 1 == m.p.stress.node:
            watched = max(watched, abs(by))
    if m.p.stress.node == 0:
        watched = o.bending
    if o.bending > o.peak_bending:
        o.peak_bending, o.peak_bending_time, o.peak_bending_node = o.bending, time, at_bending
    if o.shear > o.peak_shear:
        o.peak_shear, o.peak_shear_time, o.peak_shear_node = o.shear, time, at_shear
    if watched > m.s.watched:
        m.s.watched = watched
        o.kept_time = time
        keep(y, m)


@kernel
def keep(y, m):
    """Keep the stresses along the rotor as they are now."""
    d = m.d
    for i in range(d.nodes):
        o = m.o.node[i]
        o.bending_x, o.bending_y, o.shear_x, o.shear_y = 0.0, 0.0, 0.0, 0.0
    for row in range(d.ends):
        o = m.o.node[int(d.end_node[row])]
        bx, by = _at_end(row, d.bending, d.bending_load, y, m)
        sx, sy = _at_end(row, d.shear, d.shear_load, y, m)
        if abs(bx) > abs(o.bending_x):
            o.bending_x = bx
        if abs(by) > abs(o.bending_y):
            o.bending_y = by
        if abs(sx) > abs(o.shear_x):
            o.shear_x = sx
        if abs(sy) > abs(o.shear_y):
            o.shear_y = sy
