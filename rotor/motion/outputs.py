"""Outputs of the flexible rotor: motion at the stations, energy, and stresses along it.

Stresses are given as they are now, at their peak, and node by node at the instant of the peak. They are
looked at after every stride of the rotor, since a macro step may be longer than a mode's swing.

sigma = r E Y'' (3.20, 3.21) and tau = 4/3 V/A (3.22, 3.23; solid sections) at both ends of every element,
from the modal coordinates, and from the loads by what the modes left out would add (mode acceleration).
A node's stress is the larger of its elements'. R: ends of the elements at the nodes that are watched
(`rotor.modal.modal_stresses`), two each but for the shaft's ends.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ...modelkit.gravity import gravity_along
from ...modelkit.kernel import kernel
from ...modelkit.numerics import squared
from ...modelkit.ports import NO_LOAD
from ...modelkit.variables import SWITCH, choice, integer, real
from ..brake import report_brake
from ..thrust import thrust, thrust_ahead
from .equations import (
    BRAKED,
    LOSS,
    SPIN,
    VZ,
    WORK,
    Planar,
    Z,
    accelerations,
    auxiliary,
    energies,
    modal,
    shaft_force,
    shaftwise,
)


@dataclass(frozen=True)
class StressOptions:
    """Options of stress recovery."""

    active: int = choice(1, SWITCH, "whether stresses are computed")
    mode_acceleration: int = choice(
        1, SWITCH, "loads add to the kept modes what those left out would", needs="active"
    )
    node: int = integer(
        0,
        "node whose vertical bending stress decides when the stresses along the rotor are kept; "
        "0: the largest bending stress anywhere",
        minimum=0,
        needs="active",
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
    position: float = real(0.0, "m", "along the axis, from node 1", constant=True, shown="mm")


class _EndStresses(NamedTuple):
    """One kind of stress at the ends of the elements, (R,) each, Pa."""

    x: np.ndarray
    y: np.ndarray
    both: np.ndarray  # resultant of both planes


class Peak(NamedTuple):
    """The largest stress (Pa) and its node, from 1."""

    stress: float
    node: int


@kernel
def report(q, m, work):
    """Stresses in the state q (N,) at the end of a macro step, and what is kept of them, in m.o (Pa).

    work: scratch, as in `look`.
    """
    m.o.stress.bending, m.o.stress.shear = stress_peaks(q, m, m.half, work)


@kernel
def stress_peaks(q, m, since_middle, work):
    """Keep in m.o what is largest of the stresses of q (N,), at a time within the macro step.

    since_middle: s after its middle; work: scratch, two rows of 3 R or more. Returns the largest bending
    and the largest shear stress now (Pa).
    """
    bending, shear = _along(work[0], m), _along(work[1], m)
    rows = m.d.stress
    _recover(rows.bending, rows.bending_load, q, m, since_middle, bending)
    _recover(rows.shear, rows.shear_load, q, m, since_middle, shear)
    worst_bending, worst_shear, watched = _largest(bending, shear, m)
    o, time = m.o.stress, m.time + m.half + since_middle
    if worst_bending.stress > o.peak_bending:
        o.peak_bending, o.peak_bending_node = worst_bending.stress, worst_bending.node
        o.peak_bending_time = time
    if worst_shear.stress > o.peak_shear:
        o.peak_shear, o.peak_shear_node = worst_shear.stress, worst_shear.node
        o.peak_shear_time = time
    if watched > m.s.watched:
        m.s.watched = watched
        o.kept_time = time
        _keep(bending, shear, m)
    return worst_bending.stress, worst_shear.stress


@kernel
def _along(row, m):
    """`_EndStresses` as views of a row of scratch."""
    n = m.d.stress.ends
    return _EndStresses(row[:n], row[n : 2 * n], row[2 * n : 3 * n])


@kernel
def _recover(per_mode, per_load, q, m, since_middle, stress):
    """Set one kind of `stress` (_EndStresses) of q (N,) under loads `since_middle` (s) after the middle.

    per_mode (n, R), per_load (S, R): stress per modal coordinate and per force.
    """
    px, py, _, _ = modal(q, m)
    for i in range(len(stress.x)):
        stress.x[i], stress.y[i] = 0.0, 0.0
    for k in range(m.d.modes):
        _add(per_mode[k], px[k], py[k], stress)
    for j in range(m.d.stations if m.p.stress.mode_acceleration == 1 else 0):
        load = m.u.station[j]
        fx, fy = load.fx + load.dfx * since_middle, load.fy + load.dfy * since_middle
        if fx != 0.0 or fy != 0.0:
            _add(per_load[j], fx, fy, stress)
    for i in range(len(stress.x)):
        stress.both[i] = math.sqrt(stress.x[i] * stress.x[i] + stress.y[i] * stress.y[i])


@kernel
def _add(row, x, y, stress):
    """Add `row` (R,) times x and y to the two planes of `stress` (_EndStresses); becomes vector code."""
    for i in range(len(stress.x)):
        stress.x[i] += row[i] * x
        stress.y[i] += row[i] * y


@kernel
def _largest(bending, shear, m):
    """Largest bending and shear along the rotor (`Peak` each), and the stress that decides what is kept.

    Updates the nodes' own peaks. bending, shear: `_EndStresses`.
    """
    rows, decisive = m.d.stress, m.p.stress.node
    most_bending, most_shear, watched = Peak(0.0, 0), Peak(0.0, 0), 0.0
    for i in range(rows.ends):
        node = int(rows.node[i])
        node_output = m.o.node[int(rows.place[i])]
        node_output.peak_bending = max(node_output.peak_bending, bending.both[i])
        node_output.peak_shear = max(node_output.peak_shear, shear.both[i])
        if bending.both[i] > most_bending.stress:
            most_bending = Peak(bending.both[i], node)
        if shear.both[i] > most_shear.stress:
            most_shear = Peak(shear.both[i], node)
        if node == decisive:
            watched = max(watched, abs(bending.y[i]))
    return most_bending, most_shear, watched if decisive else most_bending.stress


@kernel
def _keep(bending, shear, m):
    """Keep bending and shear (`_EndStresses` each) in m.o.node (Pa)."""
    rows = m.d.stress
    for i in range(m.d.watched):
        o = m.o.node[i]
        o.bending_x, o.bending_y, o.shear_x, o.shear_y = 0.0, 0.0, 0.0, 0.0
    for i in range(rows.ends):
        o = m.o.node[int(rows.place[i])]
        o.bending_x, o.bending_y = _larger(o.bending_x, bending.x[i]), _larger(o.bending_y, bending.y[i])
        o.shear_x, o.shear_y = _larger(o.shear_x, shear.x[i]), _larger(o.shear_y, shear.y[i])


@kernel
def _larger(before, stress):
    """The one of larger size, with its sign (Pa)."""
    return stress if abs(stress) > abs(before) else before


@kernel
def publish(q, m):
    """Outputs m.o from the state q (N,) at the end of the macro step."""
    n = m.d.modes
    acceleration = Planar(np.empty(n), np.empty(n))
    alpha = accelerations(q, m, m.half, acceleration.x, acceleration.y)
    for j in range(m.d.stations):
        _publish_station(q, m, j, acceleration, alpha)
    for j in range(m.d.sensors):
        o = m.o.sensor[j]
        o.x, o.y, o.vx, o.vy = _motion(m.d.sensor_shape[j], q, m)
    e = m.o.energy
    e.kinetic, e.potential = energies(q, m)
    tail = auxiliary(q, m)
    e.dissipated = tail[LOSS]
    report_brake(tail[SPIN], m.time + 2.0 * m.half, tail[BRAKED], m)


@kernel
def _motion(shape, q, m):
    """(x, y, vx, vy), m and m/s, where the modes have this shape (n,), 1/kg^0.5."""
    px, py, pvx, pvy = modal(q, m)
    x, y, vx, vy = 0.0, 0.0, 0.0, 0.0
    for k in range(m.d.modes):
        x += shape[k] * px[k]
        y += shape[k] * py[k]
        vx += shape[k] * pvx[k]
        vy += shape[k] * pvy[k]
    return x, y, vx, vy


@kernel
def _publish_station(q, m, j, acceleration, alpha):
    """Publish the data of station j that a bearing needs; 'free' is the motion without the bearing's load.

    acceleration: `Planar`, of the modes (m kg^0.5/s2); alpha: of the spin (rad/s2).
    """
    d, shape = m.d, m.d.shape[j]
    o, u, tail = m.o.station[j], m.u.station[j], auxiliary(q, m)
    ax, ay = acceleration
    fx, fy = u.fx + u.dfx * m.half, u.fy + u.dfy * m.half
    about_x, about_y = u.mx + u.dmx * m.half, u.my + u.dmy * m.half
    o.x, o.y, o.vx, o.vy = _motion(shape, q, m)
    o.omega = tail[SPIN]
    o.alpha_free = alpha - (u.mz + u.dmz * m.half) / d.inertia
    o.work = tail[WORK + j]
    if m.p.axial == 1:
        along = shaftwise(q, m)
        o.z, o.vz, o.inv_m_z = along[Z], along[VZ], 1.0 / d.mass
        rises = thrust_ahead(m) - thrust(m.p, m.time + 2.0 * m.half)
        o.az_free = (shaft_force(m, m.half) + rises - u.fz - u.dfz * m.half) / d.mass
    o.ax_free, o.ay_free = -d.inv_m[j] * fx, -d.inv_m[j] * fy
    for k in range(d.modes):
        o.ax_free += shape[k] * ax[k]
        o.ay_free += shape[k] * ay[k]
    o.ax_free -= d.crossed[j] * about_y
    o.ay_free += d.crossed[j] * about_x
    o.ry, o.rx, o.wy, o.wx = _motion(d.tilt[j], q, m)
    o.rx, o.wx = 0.0 - o.rx, 0.0 - o.wx  # a slope of the y-z plane is less the tilt about x
    o.alpha_x_free = d.crossed[j] * fy - d.inv_tilt[j] * about_x
    o.alpha_y_free = -d.crossed[j] * fx - d.inv_tilt[j] * about_y
    for k in range(d.modes):
        o.alpha_x_free -= d.tilt[j, k] * ay[k]
        o.alpha_y_free += d.tilt[j, k] * ax[k]
    for i in range(int(d.slots[j])):
        z = o.mode[i]
        z.x, z.y, z.vx, z.vy, z.ax_free, z.ay_free = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    px, py, vx, vy = modal(q, m)
    for k in range(d.modes):
        if d.slot[j, k] >= 0.0:
            z = o.mode[int(d.slot[j, k])]
            z.x += shape[k] * px[k]
            z.y += shape[k] * py[k]
            z.vx += shape[k] * vx[k]
            z.vy += shape[k] * vy[k]
            z.ax_free += shape[k] * (ax[k] - shape[k] * fx - d.tilt[j, k] * about_y)
            z.ay_free += shape[k] * (ay[k] - shape[k] * fy + d.tilt[j, k] * about_x)


@kernel
def publish_constants(m):
    """Outputs that stay: mass (kg), polar inertia (kg m2), positions of nodes (m), and at stations."""
    m.o.mass, m.o.polar_inertia = m.d.mass, m.d.inertia
    for i in range(m.d.watched):
        m.o.node[i].position = m.d.position[i]
    for j in range(m.d.stations):
        _publish_station_constants(m, j)


@kernel
def _publish_station_constants(m, j):
    """Publish constants of station j; modes that share a slot become one of the same static flexibility."""
    d, o = m.d, m.o.station[j]
    o.static_fy = d.static_fy[j]
    if m.p.axial == 1 and d.held[j] != 0.0:
        weight = gravity_along(m.p.gravity, m.p.inclination) * d.mass + thrust(m.p, m.time)
        o.static_fz = -weight if weight != 0.0 else NO_LOAD
    o.inv_m = d.inv_m[j]
    o.inv_I = 1.0 / d.inertia
    o.inv_I_t, o.inv_mI = d.inv_tilt[j], d.crossed[j]
    for i in range(int(d.slots[j])):
        gain, flexibility, crossed = 0.0, 0.0, 0.0
        for k in range(d.modes):
            if d.slot[j, k] == i:
                gain += squared(d.shape[j, k])
                flexibility += squared(d.shape[j, k]) / d.stiffness[k]
                crossed += d.shape[j, k] * d.tilt[j, k]
        z = o.mode[i]
        z.inv_m, z.k_over_m, z.slope = gain, gain / flexibility, crossed / gain
        z.c_over_m = 2.0 * d.damping_ratio * math.sqrt(z.k_over_m)
