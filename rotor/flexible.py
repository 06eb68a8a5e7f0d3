"""A flexible rotor in modal coordinates, made from a shaft: any number of seats, stresses along it.

Sign and frame: x horizontal, y up, z along the shaft, angles counter-clockwise, SI. The equations of
motion are those of `rotor.modal.motion`; what the kernels read is prepared in `rotor.modal.data`.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from touchdown.modelkit.kernel import kernel
from touchdown.modelkit.model import Model, memory_layout
from touchdown.modelkit.ports import (
    MODES,
    Energy,
    FlexibleSeatLoad,
    FlexibleSeatState,
    PointMotion,
    StaticLoad,
)
from touchdown.modelkit.status import BAD_INPUT, BAD_LOAD, OK
from touchdown.modelkit.variables import array, group, groups, integer, real
from touchdown.rotor.beams.shaft import MOST_NODES, MOST_STATIONS, Shaft
from touchdown.rotor.modal import motion as modal_motion
from touchdown.rotor.modal import stress_report
from touchdown.rotor.modal.data import MOST_MODES, Derived, chosen_basis, prepare


@dataclass(frozen=True)
class Parameters:
    """What a shaft does not say."""

    modes: int = integer(
        5, "modes per plane, the two rigid ones included; 0: all of the finite elements'", minimum=0
    )
    residual: int = integer(
        1, "1: the seats keep the flexibility of the modes that are left out", minimum=0, maximum=1
    )
    damping_ratio: float = real(
        -1.0, "1", "damping ratio of the elastic modes; negative: as the rotor's file says", maximum=1.0
    )
    gravity: float = real(9.81, "m/s2", "gravity, downwards", minimum=0.0)
    speed: float = real(942.477796076938, "rad/s", "spin speed at the start")
    unbalance_scale: float = real(1.0, "1", "factor on the shaft's unbalances", minimum=0.0)
    unbalance_angle: float = real(0.0, "rad", "angle of the rotor at the start")
    drag: float = real(0.0, "N.m", "constant torque against the spin", minimum=0.0)
    viscous_drag: float = real(0.0, "N.m.s/rad", "torque against the spin per spin speed", minimum=0.0)
    x: float = real(0.0, "m", "horizontal position at the start")
    y: float = real(0.0, "m", "vertical position at the start")
    vx: float = real(0.0, "m/s", "horizontal velocity at the start")
    vy: float = real(0.0, "m/s", "vertical velocity at the start")
    micro_step: float = real(
        5e-6, "s", "longest stride in which modes and gyroscopics alternate", above=0.0
    )
    stress: stress_report.StressOptions = group(stress_report.StressOptions)


@dataclass(frozen=True)
class Inputs:
    """A load at each station."""

    station: tuple = groups(FlexibleSeatLoad, MOST_STATIONS)


@dataclass(frozen=True)
class StationState(StaticLoad, FlexibleSeatState):
    """Motion at a station, and what holds the rotor there."""


@dataclass(frozen=True)
class Outputs:
    """Motion at the stations, stresses, energy."""

    station: tuple = groups(StationState, MOST_STATIONS)
    sensor: tuple = groups(PointMotion, MOST_STATIONS)
    energy: Energy = group(Energy)
    stress: stress_report.StressReport = group(stress_report.StressReport)
    node: tuple = groups(stress_report.NodeStress, MOST_NODES)
    mass: float = real(0.0, "kg", "mass", constant=True)
    polar_inertia: float = real(0.0, "kg.m2", "polar moment of inertia", constant=True)


@dataclass(frozen=True)
class Stride:
    """Exact strides of the modes, for one length."""

    length: float = real(0.0, "s", "of the stride")
    zz: np.ndarray = array(MOST_MODES)
    zv: np.ndarray = array(MOST_MODES)
    vz: np.ndarray = array(MOST_MODES)
    vv: np.ndarray = array(MOST_MODES)
    zf: np.ndarray = array(MOST_MODES)
    vf: np.ndarray = array(MOST_MODES)
    zg: np.ndarray = array(MOST_MODES)
    vg: np.ndarray = array(MOST_MODES)


@dataclass(frozen=True)
class Hidden:
    """Memory between steps."""

    stride: Stride = group(Stride)
    watched: float = real(0.0, "Pa", "largest of the stress that decides what is kept")


SIZE = 4 * MOST_MODES + modal_motion.WORK + MOST_STATIONS
MEMORY = memory_layout(Parameters, Inputs, Outputs, SIZE, derived=Derived, hidden=Hidden)


@kernel
def publish(y, m):
    """Motion at all stations and sensors at the end of the step, and the energy."""
    n = m.d.modes
    ax, ay = np.empty(n), np.empty(n)
    alpha = modal_motion.accelerate(y, m, m.half, ax, ay)
    for j in range(m.d.stations):
        _publish_station(y, m, j, ax, ay, alpha)
    for j in range(m.d.sensors):
        o = m.o.sensor[j]
        o.x, o.y, o.vx, o.vy = _motion(m.d.sensor_shape[j], y, n)
    e = m.o.energy
    e.kinetic, e.potential = modal_motion.energies(y, m)
    e.dissipated = modal_motion.rest(y, m)[modal_motion.LOSS]


@kernel
def _motion(shape, y, n):
    """(x, y, vx, vy) where the modes have this shape."""
    x, up, vx, vy = 0.0, 0.0, 0.0, 0.0
    for k in range(n):
        x += shape[k] * y[k]
        up += shape[k] * y[n + k]
        vx += shape[k] * y[2 * n + k]
        vy += shape[k] * y[3 * n + k]
    return x, up, vx, vy


@kernel
def _publish_station(y, m, j, ax, ay, alpha):
    """What a bearing at station j needs to know; 'free' is what it does not cause itself."""
    d, n, shape = m.d, m.d.modes, m.d.shape[j]
    o, u, tail = m.o.station[j], m.u.station[j], modal_motion.rest(y, m)
    fx, fy = u.fx + u.dfx * m.half, u.fy + u.dfy * m.half
    o.x, o.y, o.vx, o.vy = _motion(shape, y, n)
    o.omega = tail[modal_motion.SPIN]
    o.alpha_free = alpha - (u.mz + u.dmz * m.half) / d.inertia
    o.work = tail[modal_motion.WORK + j]
    o.ax_free, o.ay_free = -d.inv_m[j] * fx, -d.inv_m[j] * fy
    for i in range(int(d.slots[j])):
        z = o.mode[i]
        z.x, z.y, z.vx, z.vy, z.ax_free, z.ay_free = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for k in range(n):
        o.ax_free += shape[k] * ax[k]
        o.ay_free += shape[k] * ay[k]
        if d.slot[j, k] >= 0.0:
            z = o.mode[int(d.slot[j, k])]
            z.x += shape[k] * y[k]
            z.y += shape[k] * y[n + k]
            z.vx += shape[k] * y[2 * n + k]
            z.vy += shape[k] * y[3 * n + k]
            z.ax_free += shape[k] * (ax[k] - shape[k] * fx)
            z.ay_free += shape[k] * (ay[k] - shape[k] * fy)


@kernel
def start(words):
    """At rest in its magnetic bearings, if it has any, and turning."""
    m = words.view(MEMORY)[0]
    p, d, y = m.p, m.d, m.q
    px, py, vx, vy = modal_motion.modal(y, m)
    for k in range(d.modes):  # w gives every node the same displacement
        px[k], py[k] = d.weight[k] * p.x, d.sag[k] + d.weight[k] * p.y
        vx[k], vy[k] = d.weight[k] * p.vx, d.weight[k] * p.vy
    modal_motion.rest(y, m)[modal_motion.SPIN] = p.speed
    m.half = 0.0
    m.o.mass, m.o.polar_inertia = d.mass, d.inertia
    for i in range(d.nodes):
        m.o.node[i].position = d.position[i]
    for j in range(d.stations):
        _state_constants(m, j)
    publish(y, m)


@kernel
def _state_constants(m, j):
    """What stays at station j; modes that share a place there become one of the same static flexibility."""
    d, o = m.d, m.o.station[j]
    o.static_fy = d.static_fy[j]
    o.inv_m = d.inv_m[j]
    o.inv_I = 1.0 / d.inertia
    for i in range(int(d.slots[j])):
        gain, flexibility = 0.0, 0.0
        for k in range(d.modes):
            if d.slot[j, k] == i:
                gain += d.shape[j, k] ** 2
                flexibility += d.shape[j, k] ** 2 / d.stiffness[k]
        z = o.mode[i]
        z.inv_m, z.k_over_m = gain, gain / flexibility
        z.c_over_m = 2.0 * d.damping_ratio * np.sqrt(z.k_over_m)


@kernel
def _inputs(m):
    """Sum of all inputs, by which one that is not finite is noticed."""
    total = 0.0
    for j in range(m.d.stations):
        u = m.u.station[j]
        total += u.fx + u.fy + u.mz + u.dfx + u.dfy + u.dmz
        for i in range(int(m.d.slots[j])):
            z = u.mode[i]
            total += z.qx + z.qy + z.px + z.py
    return total


@kernel
def advance(words, work, time, step):
    """One macro step under the given loads."""
    m = words.view(MEMORY)[0]
    if not math.isfinite(_inputs(m)):
        return BAD_INPUT
    m.time = time
    m.half = 0.5 * step
    modal_motion.advance(m.q, m, step, m.p.micro_step, work)
    modal_motion.take_mode_loads(m.q, m)
    publish(m.q, m)
    if m.p.stress.active:
        stress_report.report(m.q, m, time + step)
    told = m.o.energy.kinetic + m.o.energy.potential + m.o.stress.bending + m.o.stress.shear
    return OK if modal_motion.finite(m.q, m) and math.isfinite(told) else BAD_LOAD


def derive(shaft: Shaft, p: Parameters) -> Derived:
    """Constants of the kernels, computed once for equal parameters."""
    damping_ratio = p.damping_ratio if p.damping_ratio >= 0.0 else shaft.damping_ratio
    return prepare(shaft, p.modes, p.residual, damping_ratio, p.gravity, p.stress.mode_acceleration)


def check(shaft: Shaft, p: Parameters) -> str | None:
    """What is wrong between shaft and parameters."""
    most = 2 * shaft.nodes
    if p.modes > most or p.modes == 1:
        return f"modes = {p.modes} must be from 2 (rigid) to {most}, all that the model has per plane, or 0"
    if p.stress.node > shaft.nodes:
        return f"stress.node = {p.stress.node}: the rotor's nodes count from 1 to {shaft.nodes}"
    return None


def weights(shaft: Shaft, p: Parameters) -> np.ndarray:
    """Error weights: 1 um and 1 cm/s, by a mode's share where it moves most."""
    found = chosen_basis(shaft, p.modes, p.residual)
    share = np.max(np.abs(found.shapes[::2]), axis=0)
    behind = np.zeros(modal_motion.WORK + len(shaft.stations))
    behind[[modal_motion.ANGLE, modal_motion.SPIN]] = 1e-1
    return np.concatenate([1e6 * share, 1e6 * share, 1e2 * share, 1e2 * share, behind])


def exposed(shaft: Shaft, name: str) -> str | None:
    """Stations and sensors by the names the shaft gives them; what it does not have is hidden."""
    match = re.match(r"(station|sensor|node)\[(\d+)\](.*)", name)
    if match is None:
        return name
    kind, number, tail = match[1], int(match[2]), match[3]
    if kind == "node":
        return name if number <= shaft.nodes else None
    places = shaft.stations if kind == "station" else shaft.sensors
    return f"{places[number - 1].name}{tail}" if number <= len(places) else None


def _starts_from(shaft: Shaft) -> dict[str, tuple[str, ...]]:
    """All nodes start alike but for the sag, and no elastic mode moves yet."""
    basis = ("modes", "residual")
    sag = (*basis, "gravity") if shaft.levitated_at else ()
    turning = ("speed", "drag", "viscous_drag", "unbalance_scale", "unbalance_angle")
    loads = [f"{s.name}.{force}" for s in shaft.stations for force in ("fx", "fy", "mz")]
    accelerations = (*basis, "gravity", *turning, *loads)
    found = {
        "energy.kinetic": ("vx", "vy", "speed", "unbalance_scale", "unbalance_angle"),
        "energy.potential": tuple(dict.fromkeys(("y", "gravity", *sag))),
    }
    for place in (*shaft.stations, *shaft.sensors):
        found |= {f"{place.name}.{name}": (name,) for name in ("x", "vx", "vy")}
        found[f"{place.name}.y"] = ("y", *sag)
    for s in shaft.stations:
        found |= {f"{s.name}.{name}": accelerations for name in ("ax_free", "ay_free", "alpha_free")}
        found |= {f"{s.name}.inv_m": basis, f"{s.name}.omega": ("speed",)}
        if s.name in shaft.levitated_at:
            found[f"{s.name}.static_fy"] = ("gravity",)
        for k in range(1, MODES + 1):
            mode = f"{s.name}.mode[{k}]"
            found[f"{mode}.y"] = sag
            found |= {f"{mode}.{name}": accelerations for name in ("ax_free", "ay_free")}
            found |= {f"{mode}.{name}": basis for name in ("inv_m", "k_over_m")}
            found[f"{mode}.c_over_m"] = (*basis, "damping_ratio")
    return found


_GENERAL = Model(
    name="flexible_rotor",
    title="Flexible rotor",
    about="",
    parameters=Parameters,
    inputs=Inputs,
    outputs=Outputs,
    memory=MEMORY,
    start=start,
    advance=advance,
    weights=lambda p: np.zeros(0),
    derived=Derived,
    hidden=Hidden,
    rhs=modal_motion.rhs,
    publish=publish,
)


def flexible_rotor(shaft: Shaft, name: str, content: str = "") -> Model:
    """The model of a shaft, called `name`; `content` tells shafts of one name apart."""
    return replace(
        _GENERAL,
        name=name,
        content=content,
        title=shaft.title,
        about=f"{shaft.title}: Timoshenko beam of {len(shaft.elements)} elements in modal coordinates",
        derive=partial(derive, shaft),
        check=partial(check, shaft),
        weights=partial(weights, shaft),
        rename=partial(exposed, shaft),
        starts_from=_starts_from(shaft),
    )
