"""A flexible rotor in modal coordinates, made from a shaft: any number of seats, stresses along it.

Sign and frame: x horizontal, y up, z along the shaft, angles counter-clockwise, SI. The equations of
motion are those of `rotor.motion.equations`; what the kernels read is prepared in `rotor.modal.data`.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, replace
from functools import lru_cache, partial

import numpy as np

from ..modelkit.base_motion import BASE_PROBLEM, BaseMotion
from ..modelkit.body import finite
from ..modelkit.excitation import course_problem
from ..modelkit.gravity import INCLINATION, gravity_across
from ..modelkit.kernel import kernel
from ..modelkit.model import Model, constants, memory_layout
from ..modelkit.numerics import missing
from ..modelkit.ports import (
    MODES,
    NO_LOAD,
    Energy,
    FlexibleSeatLoad,
    FlexibleSeatState,
    PointMotion,
    StaticLoad,
)
from ..modelkit.status import BAD_INPUT, BAD_LOAD, OK
from ..modelkit.variables import SWITCH, as_tuple, choice, group, groups, integer, real
from .beams.shaft import MAX_STATIONS, Shaft
from .brake import BRAKE_PROBLEM, OVER, TORQUES, BrakePoint, BrakeReport, brake_problem
from .modal.data import MAX_MODES, Derived, most_modes, tabulate
from .modal.modal_stresses import MAX_STRESS_NODES, watched_nodes
from .modal.modes import RIGID_MODES
from .motion import macro_step, outputs
from .motion.equations import ALONG, ANGLE, SPIN, VZ, WORK, Z, auxiliary, modal, rhs, shaftwise
from .motion.macro_step import Stride, take_mode_loads
from .motion.outputs import publish, publish_constants
from .table import MAX_POINTS
from .thrust import NAMES, ORDER_PROBLEM, ThrustPoint, order_problem


@dataclass(frozen=True)
class Parameters:
    """Parameters beside those of the shaft."""

    modes: int = integer(
        5, "modes per plane, the two rigid ones included; 0: all of the finite elements'", minimum=0
    )
    residual: int = choice(
        1, SWITCH, "the seats keep the flexibility of the modes that are left out", needs="modes"
    )
    damping_ratio: float = real(
        -1.0, "1", "damping ratio of the elastic modes; negative: as the rotor's file says", maximum=1.0
    )
    gravity: float = real(9.81, "m/s2", "gravity, downwards", minimum=0.0)
    speed: float = real(942.477796076938, "rad/s", "spin speed at the start")
    unbalance_scale: float = real(1.0, "1", "factor on the shaft's unbalances", minimum=0.0)
    unbalance_angle: float = real(0.0, "rad", "angle of the rotor at the start")
    drag: float = real(0.0, "N.m", "constant torque against the spin", minimum=0.0, tunable=True)
    viscous_drag: float = real(
        0.0, "N.m.s/rad", "torque against the spin per spin speed", minimum=0.0, tunable=True
    )
    x: float = real(0.0, "m", "horizontal position at the start")
    y: float = real(0.0, "m", "vertical position at the start")
    vx: float = real(0.0, "m/s", "horizontal velocity at the start")
    vy: float = real(0.0, "m/s", "vertical velocity at the start")
    micro_step: float = real(
        5e-6, "s", "longest stride in which modes and gyroscopics alternate", above=0.0
    )
    stress: outputs.StressOptions = group(outputs.StressOptions)
    axial: int = choice(0, SWITCH, "whether it moves along its shaft, in which it is rigid")
    axial_load: float = real(
        0.0, "N", "constant thrust towards +z; acts where axial is on", tunable=True, needs="axial"
    )
    z: float = real(0.0, "m", "position along the shaft at the start", needs="axial")
    vz: float = real(0.0, "m/s", "velocity along the shaft at the start", needs="axial")
    inclination: float = real(0.0, "rad", INCLINATION)
    base: BaseMotion = group(BaseMotion)
    thrust_points: int = integer(
        0,
        "points of the thrust over time in use; acts where axial is on",
        minimum=0,
        maximum=MAX_POINTS,
        needs="axial",
    )
    thrust: tuple = groups(ThrustPoint, MAX_POINTS, needs="axial and thrust_points >= #")
    brake_over: int = choice(0, OVER, "what the brake's table is over", needs="brake_points >= 2")
    brake_points: int = integer(0, "points of the brake's torque in use", minimum=0, maximum=MAX_POINTS)
    brake: tuple = groups(BrakePoint, MAX_POINTS, needs="brake_points >= #")


@dataclass(frozen=True)
class Inputs:
    """A load at each station."""

    station: tuple = groups(FlexibleSeatLoad, MAX_STATIONS)


@dataclass(frozen=True)
class StationState(StaticLoad, FlexibleSeatState):
    """Motion at a station, and what holds the rotor there."""


@dataclass(frozen=True)
class Outputs:
    """Motion at the stations, stresses, energy."""

    station: tuple = groups(StationState, MAX_STATIONS)
    sensor: tuple = groups(PointMotion, MAX_STATIONS)
    energy: Energy = group(Energy)
    stress: outputs.StressReport = group(outputs.StressReport)
    node: tuple = groups(outputs.NodeStress, MAX_STRESS_NODES)
    mass: float = real(0.0, "kg", "mass", constant=True)
    polar_inertia: float = real(0.0, "kg.m2", "polar moment of inertia", constant=True)
    braking: BrakeReport = group(BrakeReport)


@dataclass(frozen=True)
class Hidden:
    """Memory between steps."""

    stride: Stride = group(Stride)
    watched: float = real(0.0, "Pa", "largest of the stress that decides what is kept")


SIZE = 4 * MAX_MODES + WORK + MAX_STATIONS + ALONG
MEMORY = memory_layout(Parameters, Inputs, Outputs, SIZE, derived=Derived, hidden=Hidden)
CONSTANTS, PROBLEMS = constants(
    MEMORY,
    (
        "modes = {0:g} must be from 2 (rigid) to {1:g}, all that the model has per plane, or 0",
        "stress.node = {0:g}: the rotor's nodes count from 1 to {1:g}",
        "stress.node = {0:g} is not one of the rotor's {1:g} nodes whose stresses are followed",
        ORDER_PROBLEM,
        BRAKE_PROBLEM,
        BASE_PROBLEM,
    ),
)


@kernel
def _problem(m):
    """Number of what is wrong between shaft and parameters, or 0."""
    p, most, rows = m.p, m.d.most_modes, m.d.stress
    if p.modes > most or p.modes == 1:
        m.message_numbers[0], m.message_numbers[1] = p.modes, most
        return 1
    if order_problem(p, m.message_numbers) != 0:
        return 4
    if brake_problem(p, m.message_numbers) != 0:
        return 5
    if course_problem(p.base.course, m.message_numbers) != 0:
        return 6
    m.message_numbers[0], m.message_numbers[1] = p.stress.node, m.d.nodes
    if p.stress.node > m.d.nodes:
        return 2
    if p.stress.node == 0:
        return 0
    for i in range(rows.ends):
        if rows.node[i] == p.stress.node:
            return 0
    return 3


@kernel
def _set_weights(m):
    """Set the error weights, 1 um and 1 cm/s by a mode's share where it moves most, and m.n."""
    w, n = m.weight, m.d.modes
    m.n = 4 * n + WORK + m.d.stations + ALONG
    for i in range(len(w)):
        w[i] = 0.0
    for k in range(n):
        w[k] = w[n + k] = 1e6 * m.d.reach[k]
        w[2 * n + k] = w[3 * n + k] = 1e2 * m.d.reach[k]
    w[4 * n + ANGLE] = w[4 * n + SPIN] = 1e-1
    along = shaftwise(w, m)
    along[Z], along[VZ] = 1e6, 1e2


@kernel
def derive(words):
    """Damping, what holds the rotor at the start, error weights; returns a problem's number, or 0.

    m.d holds the tables of as many modes as the parameters ask for.
    """
    m = words.view(MEMORY)[0]
    p, d = m.p, m.d
    problem = _problem(m)
    if problem != 0:
        return problem
    d.damping_ratio = p.damping_ratio if p.damping_ratio >= 0.0 else d.own_damping_ratio
    down = gravity_across(p.gravity, p.inclination)
    for j in range(d.stations):
        d.static_fy[j] = d.held[j] * down if down != 0.0 else NO_LOAD
    for k in range(d.modes):
        d.damping[k], d.sag[k] = 2.0 * d.damping_ratio * math.sqrt(d.stiffness[k]), 0.0
        for j in range(d.stations if k >= RIGID_MODES else 0):
            d.sag[k] += d.shape[j, k] * d.static_fy[j] / d.stiffness[k]
    _set_weights(m)
    return missing(words, CONSTANTS)


@kernel
def start(words):
    """At rest in its magnetic bearings, if it has any, and turning."""
    m = words.view(MEMORY)[0]
    p, d = m.p, m.d
    px, py, vx, vy = modal(m.q, m)
    for k in range(d.modes):  # w gives every node the same displacement
        px[k], py[k] = d.weight[k] * p.x, d.sag[k] + d.weight[k] * p.y
        vx[k], vy[k] = d.weight[k] * p.vx, d.weight[k] * p.vy
    auxiliary(m.q, m)[SPIN] = p.speed
    if p.axial == 1:
        along = shaftwise(m.q, m)
        along[Z], along[VZ] = p.z, p.vz
    m.half = 0.0
    publish_constants(m)
    publish(m.q, m)


@kernel
def _inputs(m):
    """Sum of all inputs, in mixed units, by which one that is not finite is noticed."""
    total = 0.0
    for j in range(m.d.stations):
        u = m.u.station[j]
        total += u.fx + u.fy + u.mz + u.dfx + u.dfy + u.dmz + u.mx + u.my + u.dmx + u.dmy
        total += u.fz + u.dfz
        for i in range(int(m.d.slots[j])):
            z = u.mode[i]
            total += z.qx + z.qy + z.px + z.py
    return total


@kernel
def derivative(t, q, dq, words):
    """`rhs`, for Python."""
    rhs(t, q, dq, words.view(MEMORY)[0])


@kernel
def motion(q, words):
    """`publish`, for Python."""
    publish(q, words.view(MEMORY)[0])


@kernel
def advance(words, work, time, step):
    """One macro step under the given loads; arguments as in `modelkit.model.Model`."""
    m = words.view(MEMORY)[0]
    if not math.isfinite(_inputs(m)):
        return BAD_INPUT
    m.time = time
    m.half = 0.5 * step
    macro_step.advance(m.q, m, step, m.p.micro_step, work)
    take_mode_loads(m.q, m)
    publish(m.q, m)
    if m.p.stress.active:
        outputs.report(m.q, m, work)
    checked = m.o.energy.kinetic + m.o.energy.potential + m.o.stress.bending + m.o.stress.shear
    return OK if finite(m) and math.isfinite(checked) else BAD_LOAD


TABULATED = ("modes", "residual")


@lru_cache(maxsize=16)
def _tables(shaft: Shaft, modes: int, residual: int) -> np.ndarray:
    """m.d (1,) with all that depends on the shaft, the number of modes and residual vectors."""
    return np.array([as_tuple(tabulate(shaft, modes, residual))], MEMORY["d"])


def modal_tables(shaft: Shaft, p: Parameters) -> np.ndarray:
    """m.d (1,) as far as tabulated; of two modes where there are not so many as asked for.

    That is for `derive` to say.
    """
    there = p.modes == 0 or RIGID_MODES <= p.modes <= most_modes(shaft)
    return _tables(shaft, p.modes if there else RIGID_MODES, p.residual)


def exposed(shaft: Shaft, name: str) -> str | None:
    """Stations and sensors by the names the shaft gives them; what it does not have is hidden.

    That is all stresses where it has no elements to have them.
    """
    if name.startswith("stress.") and not shaft.elements:
        return None
    match = re.match(r"(station|sensor|node)\[(\d+)\](.*)", name)
    if match is None:
        return name
    kind, number, tail = match[1], int(match[2]), match[3]
    if kind == "node":
        nodes = watched_nodes(shaft)
        return f"node[{nodes[number - 1]}]{tail}" if number <= len(nodes) else None
    places = shaft.stations if kind == "station" else shaft.sensors
    return f"{places[number - 1].name}{tail}" if number <= len(places) else None


def _starts_from(shaft: Shaft) -> dict[str, tuple[str, ...]]:
    """All nodes start alike but for the sag, and no elastic mode moves yet."""
    basis = ("modes", "residual")
    weight = ("gravity", "inclination")
    along = ("axial", *weight, *NAMES)
    sag = (*basis, *weight) if shaft.levitated_at else ()
    turning = ("speed", *TORQUES, "unbalance_scale", "unbalance_angle")
    loads = [f"{s.name}.{force}" for s in shaft.stations for force in ("fx", "fy", "mz", "mx", "my")]
    thrusts = [f"{s.name}.fz" for s in shaft.stations]
    accelerations = (*basis, *weight, *turning, *loads)
    causes = {
        "energy.kinetic": ("vx", "vy", "speed", "unbalance_scale", "unbalance_angle", "axial", "vz"),
        "energy.potential": tuple(dict.fromkeys(("y", *weight, *sag, "axial", "z"))),
    }
    causes["braking.power"] = ("speed", *TORQUES[2:])
    for place in (*shaft.stations, *shaft.sensors):
        causes |= {f"{place.name}.{name}": (name,) for name in ("x", "vx", "vy")}
        causes[f"{place.name}.y"] = ("y", *sag)
    for s in shaft.stations:
        free = ("ax_free", "ay_free", "alpha_free", "alpha_x_free", "alpha_y_free")
        causes |= {f"{s.name}.{name}": accelerations for name in free}
        causes |= {f"{s.name}.{name}": basis for name in ("inv_m", "inv_I_t", "inv_mI")}
        causes |= {f"{s.name}.rx": sag, f"{s.name}.omega": ("speed",)}
        causes |= {f"{s.name}.{name}": ("axial", name) for name in ("z", "vz")}
        causes |= {f"{s.name}.inv_m_z": ("axial",), f"{s.name}.az_free": (*along, *thrusts)}
        if s.name in shaft.levitated_at:
            causes |= {f"{s.name}.static_fy": weight, f"{s.name}.static_fz": along}
        for k in range(1, MODES + 1):
            mode = f"{s.name}.mode[{k}]"
            causes[f"{mode}.y"] = sag
            causes |= {f"{mode}.{name}": accelerations for name in ("ax_free", "ay_free")}
            causes |= {f"{mode}.{name}": basis for name in ("inv_m", "k_over_m", "slope")}
            causes[f"{mode}.c_over_m"] = (*basis, "damping_ratio")
    return causes


_GENERAL = Model(
    name="flexible_rotor",
    title="Flexible rotor",
    about="",
    parameters=Parameters,
    inputs=Inputs,
    outputs=Outputs,
    memory=MEMORY,
    derive=derive,
    start=start,
    advance=advance,
    problems=PROBLEMS,
    derived=Derived,
    hidden=Hidden,
    tabulated=TABULATED,
    derivative=derivative,
    motion=motion,
)


def flexible_rotor(shaft: Shaft, name: str, content: str = "") -> Model:
    """The model of a shaft, called `name`; `content` tells shafts of one name apart."""
    return replace(
        _GENERAL,
        name=name,
        content=content,
        title=shaft.title,
        about=f"{shaft.title}: {shaft.body.kind}, in modal coordinates",
        tables=partial(modal_tables, shaft),
        rename=partial(exposed, shaft),
        starts_from=_starts_from(shaft),
    )
