"""A rigid rotor: a disk that floats, falls, bounces and spins, also along its shaft, and that may tilt.

Three coordinates: position of the shaft centre and rotation; with `axial` a fourth, along the shaft; with
a `transverse_inertia` I_t two more, its small tilts. Its seats lie `bearing_position` and `amb_position`
from the plane of the centre of mass. With the polar inertia I_p, the spin Omega and the moments M of all
loads about the centre of mass,

    I_t rx'' + I_p Omega ry' = M_x        I_t ry'' - I_p Omega rx' = M_y

A moment about the shaft acts about the tilted shaft, and brings no other. Along the shaft
act gravity, by the shaft's inclination, and the thrust of the process (`rotor.thrust`). Unbalance enters
with spin acceleration as in (3.24): the centre of mass stands off by `eccentricity`, and the shaft centre
feels

    m e (omega^2 cos(theta + phase) + alpha sin(theta + phase)),   likewise in y.

A load at the shaft centre turns the rotor about its centre of mass, so unbalance makes no energy.

Sign and frame: x horizontal, y up, angles counter-clockwise, SI.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from ..modelkit import body
from ..modelkit.base_motion import BASE_PROBLEM, BaseMotion, base_acceleration, base_after, moving
from ..modelkit.excitation import course_problem
from ..modelkit.gravity import INCLINATION, gravity_across, gravity_along
from ..modelkit.kernel import kernel
from ..modelkit.model import Model, memory_layout
from ..modelkit.numerics import squared
from ..modelkit.ports import NO_LOAD, Energy, SeatLoad, SeatState, StaticLoad
from ..modelkit.variables import SWITCH, choice, group, groups, integer, real
from .brake import (
    BRAKE_PROBLEM,
    OVER,
    TORQUES,
    BrakePoint,
    BrakeReport,
    brake_problem,
    brake_torque,
    drag,
    report_brake,
)
from .table import MAX_POINTS
from .thrust import NAMES, ORDER_PROBLEM, ThrustPoint, order_problem, thrust, thrust_ahead

# the state q: m, m, m/s, m/s of the shaft centre, rad, rad/s, and J since the start
X, Y, VX, VY, ANGLE, SPIN, WORK_A, WORK_AMB, LOSS = range(9)
Z, VZ, WORK_OUTSIDE = range(9, 12)  # along the shaft; J since the start: work of thrust and moving base
RX, RY, WX, WY = range(12, 16)  # rad, rad/s: its tilt
BRAKED = 16  # J since the start: work of the brake, part of LOSS
SIZE = 17


@dataclass(frozen=True)
class Parameters:
    """The disk of Halminen (2016), section 4.3."""

    mass: float = real(1.65, "kg", "mass", above=0.0)
    inertia: float = real(0.5e-3, "kg.m2", "polar moment of inertia", above=0.0)
    gravity: float = real(9.81, "m/s2", "gravity, downwards", minimum=0.0)
    speed: float = real(942.477796076938, "rad/s", "spin speed at the start")
    eccentricity: float = real(
        0.0, "m", "distance of the centre of mass from the shaft centre", minimum=0.0
    )
    unbalance_angle: float = real(
        0.0, "rad", "angle of the centre of mass at the start", needs="eccentricity"
    )
    drag: float = real(0.0, "N.m", "constant torque against the spin", minimum=0.0, tunable=True)
    viscous_drag: float = real(
        0.0, "N.m.s/rad", "torque against the spin per spin speed", minimum=0.0, tunable=True
    )
    x: float = real(0.0, "m", "horizontal position at the start")
    y: float = real(0.0, "m", "vertical position at the start")
    vx: float = real(0.0, "m/s", "horizontal velocity at the start")
    vy: float = real(0.0, "m/s", "vertical velocity at the start")
    axial: int = choice(0, SWITCH, "whether it moves along its shaft")
    axial_load: float = real(
        0.0, "N", "constant thrust towards +z; acts where axial is on", tunable=True, needs="axial"
    )
    z: float = real(0.0, "m", "position along the shaft at the start", needs="axial")
    vz: float = real(0.0, "m/s", "velocity along the shaft at the start", needs="axial")
    transverse_inertia: float = real(
        0.0, "kg.m2", "transverse (diametral) moment of inertia; 0: it does not tilt", minimum=0.0
    )
    bearing_position: float = real(
        0.0,
        "m",
        "of the seat A along the shaft, from the centre of mass; matters where it tilts",
        needs="transverse_inertia",
    )
    amb_position: float = real(
        0.0,
        "m",
        "of the magnetic bearing along the shaft, from the centre of mass; likewise",
        needs="transverse_inertia",
    )
    rx: float = real(0.0, "rad", "tilt about x at the start, where it tilts", needs="transverse_inertia")
    ry: float = real(0.0, "rad", "tilt about y at the start, where it tilts", needs="transverse_inertia")
    wx: float = real(0.0, "rad/s", "rate of the tilt about x at the start", needs="transverse_inertia")
    wy: float = real(0.0, "rad/s", "rate of the tilt about y at the start", needs="transverse_inertia")
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
    """Loads of the touchdown bearing (A) and of the magnetic bearing (amb)."""

    A: SeatLoad = group(SeatLoad)
    amb: SeatLoad = group(SeatLoad)


@dataclass(frozen=True)
class Outputs:
    """Motion at both seats; what holds the rotor at the magnetic bearing (shown as amb.static_fx, ...)."""

    A: SeatState = group(SeatState)
    amb: SeatState = group(SeatState)
    energy: Energy = group(Energy)
    held: StaticLoad = group(StaticLoad)  # below here: value references of those above stay
    braking: BrakeReport = group(BrakeReport)


MEMORY = memory_layout(Parameters, Inputs, Outputs, SIZE)


@kernel
def rhs(t, q, dq, m):
    """Newton and Euler: dq (16,) of the state q (16,) under the loads mean + slope (t - t_mid); t in s."""
    p, since_middle = m.p, t - m.half
    ax, ay, am = _load_at(m.u.A, since_middle)
    bx, by, bm = _load_at(m.u.amb, since_middle)
    braking = drag(q[SPIN], m.time + t, p)
    dvx, dvy, alpha = _accelerations(q, ax + bx, ay + by, am + bm - braking, p)
    dq[X] = q[VX]
    dq[Y] = q[VY]
    dq[VX] = dvx
    dq[VY] = dvy
    dq[ANGLE] = q[SPIN]
    dq[SPIN] = alpha
    az, bz = _thrust_of(m.u.A, since_middle), _thrust_of(m.u.amb, since_middle)
    dq[Z] = q[VZ]
    push = thrust(p, m.time + t)
    dq[VZ] = _axial_acceleration(az + bz + push, p)
    dq[WORK_OUTSIDE] = push * q[VZ]
    if moving(p.base):
        base_x, base_y = base_acceleration(m, t - m.half)
        dq[VX], dq[VY] = dvx - base_x, dvy - base_y
        vx, vy = _centre_velocity(q, p)
        dq[WORK_OUTSIDE] -= p.mass * (base_x * vx + base_y * vy)
    dq[WORK_A] = ax * q[VX] + ay * q[VY] + am * q[SPIN] + az * q[VZ]
    dq[WORK_AMB] = bx * q[VX] + by * q[VY] + bm * q[SPIN] + bz * q[VZ]
    dq[LOSS] = braking * q[SPIN]
    dq[BRAKED] = brake_torque(q[SPIN], m.time + t, p) * q[SPIN]
    a_tilts, b_tilts = _moments_of(m.u.A, since_middle), _moments_of(m.u.amb, since_middle)
    about_x = a_tilts[0] - p.bearing_position * ay + b_tilts[0] - p.amb_position * by
    about_y = a_tilts[1] + p.bearing_position * ax + b_tilts[1] + p.amb_position * bx
    dq[RX], dq[RY] = q[WX], q[WY]
    dq[WX], dq[WY] = _tilt_accelerations(q, about_x, about_y, p)
    if p.transverse_inertia > 0.0:
        dq[WORK_A] += _tilting_power(q, ax, ay, a_tilts, p.bearing_position)
        dq[WORK_AMB] += _tilting_power(q, bx, by, b_tilts, p.amb_position)


@kernel
def _centre_velocity(q, p):
    """Of the centre of mass (m/s, m/s)."""
    angle = q[ANGLE] + p.unbalance_angle
    ex, ey = p.eccentricity * math.cos(angle), p.eccentricity * math.sin(angle)
    return q[VX] - q[SPIN] * ey, q[VY] + q[SPIN] * ex


@kernel
def _tilting_power(q, fx, fy, moments, position):
    """Power (W) on the tilt of a load at a seat `position` (m) from the centre of mass; moments: N m."""
    return (moments[0] - position * fy) * q[WX] + (moments[1] + position * fx) * q[WY]


@kernel
def _load_at(load, since_middle):
    """(N, N, N m) of a load, `since_middle` (s) after the middle of the macro step."""
    return (
        load.fx + load.dfx * since_middle,
        load.fy + load.dfy * since_middle,
        load.mz + load.dmz * since_middle,
    )


@kernel
def _thrust_of(load, since_middle):
    """Axial force (N) of a load, `since_middle` (s) after the middle of the macro step."""
    return load.fz + load.dfz * since_middle


@kernel
def _moments_of(load, since_middle):
    """Moments (N m) about x and y of a load, `since_middle` (s) after the middle of the macro step."""
    return load.mx + load.dmx * since_middle, load.my + load.dmy * since_middle


@kernel
def _tilt_accelerations(q, about_x, about_y, p):
    """(rad/s2, rad/s2) under moments about the centre of mass (N m); 0 where it does not tilt."""
    if p.transverse_inertia == 0.0:
        return 0.0, 0.0
    spinning = p.inertia * q[SPIN]
    return (
        (about_x - spinning * q[WY]) / p.transverse_inertia,
        (about_y + spinning * q[WX]) / p.transverse_inertia,
    )


@kernel
def _axial_acceleration(force, p):
    """Along the shaft (m/s2), under gravity and the `force` (N) of thrust and seats; 0 where it stays."""
    return gravity_along(p.gravity, p.inclination) + force / p.mass if p.axial == 1 else 0.0


@kernel
def _accelerations(q, fx, fy, moment, p):
    """Of the shaft centre (m/s2, m/s2) and the spin (rad/s2), in state q (16,), under gravity and loads.

    The loads act at the shaft centre: fx, fy (N), moment (N m). The centre of mass stands off by e (c, s):
    I alpha = M + e (Fx s - Fy c), gravity drops out.
    """
    down = gravity_across(p.gravity, p.inclination)
    if p.eccentricity == 0.0:
        return fx / p.mass, fy / p.mass - down, moment / p.inertia
    angle = q[ANGLE] + p.unbalance_angle
    ex, ey = p.eccentricity * math.cos(angle), p.eccentricity * math.sin(angle)
    alpha = (moment + fx * ey - fy * ex) / p.inertia
    w2 = q[SPIN] * q[SPIN]
    return fx / p.mass + w2 * ex + alpha * ey, fy / p.mass + w2 * ey - alpha * ex - down, alpha


@kernel
def _publish(q, m):
    """Outputs m.o from the state q (17,) at the end of the step: what a seat does not cause is 'free'."""
    p, push, end = m.p, thrust_ahead(m), m.time + 2.0 * m.half
    braking = drag(q[SPIN], end, p)
    _publish_seat(q, p, m.o.A, m.u.amb, m.half, push, braking)
    _publish_seat(q, p, m.o.amb, m.u.A, m.half, push, braking)
    if p.transverse_inertia > 0.0:
        _publish_tilt(q, p, m.o.A, p.bearing_position, m.u.amb, p.amb_position, m.half)
        _publish_tilt(q, p, m.o.amb, p.amb_position, m.u.A, p.bearing_position, m.half)
    if moving(p.base):
        base_x, base_y = base_after(m)
        m.o.A.ax_free, m.o.A.ay_free = m.o.A.ax_free - base_x, m.o.A.ay_free - base_y
        m.o.amb.ax_free, m.o.amb.ay_free = m.o.amb.ax_free - base_x, m.o.amb.ay_free - base_y
    m.o.A.work = q[WORK_A]
    m.o.amb.work = q[WORK_AMB]
    angle = q[ANGLE] + p.unbalance_angle
    ey = p.eccentricity * math.sin(angle)
    vx, vy = _centre_velocity(q, p)
    e = m.o.energy
    e.kinetic = 0.5 * p.mass * (vx * vx + vy * vy) + 0.5 * p.inertia * squared(q[SPIN])
    e.potential = p.mass * gravity_across(p.gravity, p.inclination) * (q[Y] + ey)
    if p.axial == 1:
        e.kinetic += 0.5 * p.mass * squared(q[VZ])
        e.potential -= p.mass * gravity_along(p.gravity, p.inclination) * q[Z] + q[WORK_OUTSIDE]
    elif moving(p.base):
        e.potential -= q[WORK_OUTSIDE]
    if p.transverse_inertia > 0.0:
        e.kinetic += 0.5 * p.transverse_inertia * (squared(q[WX]) + squared(q[WY]))
    e.dissipated = q[LOSS]
    report_brake(q[SPIN], end, q[BRAKED], m)


@kernel
def _publish_seat(q, p, seat, other, half, push, braking):
    """Motion of a seat under `other`, the other one's load, at its end: `half` (s) after the middle.

    push: mean thrust on the way to the next (N); braking: torque against the spin (N m).
    """
    seat.x, seat.y, seat.vx, seat.vy = q[X], q[Y], q[VX], q[VY]
    fx, fy, moment = _load_at(other, half)
    seat.ax_free, seat.ay_free, seat.alpha_free = _accelerations(q, fx, fy, moment - braking, p)
    seat.inv_m = 1.0 / p.mass
    seat.omega = q[SPIN]
    seat.inv_I = 1.0 / p.inertia
    if p.axial == 1:
        seat.z, seat.vz, seat.inv_m_z = q[Z], q[VZ], 1.0 / p.mass
        seat.az_free = _axial_acceleration(_thrust_of(other, half) + push, p)


@kernel
def _publish_tilt(q, p, seat, position, other, other_at, half):
    """Tilt at a seat `position` (m) from the centre of mass, and what it adds to the seat's motion there.

    other: the other seat's load, `other_at` (m), at its end, `half` (s) after the middle.
    """
    fx, fy, _ = _load_at(other, half)
    mx, my = _moments_of(other, half)
    seat.x += position * q[RY]
    seat.y -= position * q[RX]
    seat.vx += position * q[WY]
    seat.vy -= position * q[WX]
    about_x, about_y = _tilt_accelerations(q, mx - other_at * fy, my + other_at * fx, p)
    seat.rx, seat.ry, seat.wx, seat.wy = q[RX], q[RY], q[WX], q[WY]
    seat.alpha_x_free, seat.alpha_y_free = about_x, about_y
    seat.ax_free += position * about_y
    seat.ay_free -= position * about_x
    seat.inv_I_t, seat.inv_mI = 1.0 / p.transverse_inertia, position / p.transverse_inertia
    seat.gyro = p.inertia * q[SPIN] / p.transverse_inertia
    seat.inv_m += position * position / p.transverse_inertia


@kernel
def derive(words):
    """Error weights: positions matter at 1 um, velocities at 1 cm/s, spin at 10 rad/s, tilts at 10 urad.

    Returns 1, 2 or 3 where the points of thrust, brake or base are not in order, else 0.
    """
    m = words.view(MEMORY)[0]
    m.n = SIZE
    m.weight[X], m.weight[Y], m.weight[Z] = 1e6, 1e6, 1e6
    m.weight[VX], m.weight[VY], m.weight[VZ] = 1e2, 1e2, 1e2
    m.weight[ANGLE], m.weight[SPIN] = 1e-1, 1e-1
    m.weight[RX], m.weight[RY], m.weight[WX], m.weight[WY] = 1e5, 1e5, 1e1, 1e1
    if order_problem(m.p, m.message_numbers) != 0:
        return 1
    if brake_problem(m.p, m.message_numbers) != 0:
        return 2
    return 3 if course_problem(m.p.base.course, m.message_numbers) != 0 else 0


@kernel
def start(words):
    """State and outputs from the parameters; words: the memory (`modelkit.model.Model`)."""
    m = words.view(MEMORY)[0]
    p, q = m.p, m.q
    q[X], q[Y], q[VX], q[VY] = p.x, p.y, p.vx, p.vy
    q[SPIN] = p.speed
    if p.axial == 1:
        q[Z], q[VZ] = p.z, p.vz
    if p.transverse_inertia > 0.0:
        q[RX], q[RY], q[WX], q[WY] = p.rx, p.ry, p.wx, p.wy
    m.half = 0.0
    _publish(q, m)
    # unbalance turns, and is not a static load
    weight = gravity_across(p.gravity, p.inclination) / (1.0 / p.mass)
    m.o.held.static_fy = weight if weight != 0.0 else NO_LOAD
    if p.axial == 1:
        weight = gravity_along(p.gravity, p.inclination) * p.mass + thrust(p, m.time)
        m.o.held.static_fz = -weight if weight != 0.0 else NO_LOAD


@kernel
def _sum(load):
    """Sum of a load's values, in mixed units, by which one that is not finite is noticed."""
    across = load.fx + load.fy + load.mz + load.dfx + load.dfy + load.dmz
    return across + load.fz + load.dfz + load.mx + load.my + load.dmx + load.dmy


@kernel
def derivative(t, q, dq, words):
    """`rhs`, for Python."""
    rhs(t, q, dq, words.view(MEMORY)[0])


@kernel
def motion(q, words):
    """`_publish`, for Python."""
    _publish(q, words.view(MEMORY)[0])


@kernel
def advance(words, work, time, step):
    """One macro step under the given loads; arguments as in `modelkit.model.Model`."""
    m = words.view(MEMORY)[0]
    return body.advance(rhs, _publish, m, work, time, step, _sum(m.u.A) + _sum(m.u.amb))


def _exposed(name: str) -> str:
    """The exposed names of variables: the support belongs to the seat of the magnetic bearing."""
    return name.replace("held.", "amb.")


_ALONG = ("gravity", "inclination", *NAMES)


def _starts_from() -> dict[str, tuple[str, ...]]:
    """Dependencies of the first outputs: at a seat, also on the load at the other one."""
    causes: dict[str, tuple[str, ...]] = {
        "energy.kinetic": (
            *("mass", "inertia", "speed", "vx", "vy", "eccentricity", "unbalance_angle"),
            *("axial", "vz", "transverse_inertia", "wx", "wy"),
        ),
        "energy.potential": (
            *("mass", "gravity", "inclination", "y", "eccentricity", "unbalance_angle"),
            *("axial", "z"),
        ),
        "braking.power": ("speed", *TORQUES[2:]),
        "amb.static_fy": ("mass", "gravity", "inclination"),
        "amb.static_fz": ("axial", "mass", *_ALONG),
    }
    positions = {"A": "bearing_position", "amb": "amb_position"}
    for seat, other in (("A", "amb"), ("amb", "A")):
        lever = ("transverse_inertia", positions[seat])
        crossed = {"x": "ry", "y": "rx", "vx": "wy", "vy": "wx"}
        causes |= {f"{seat}.{name}": (name, tilt, *lever) for name, tilt in crossed.items()}
        causes |= {f"{seat}.omega": ("speed",), f"{seat}.inv_I": ("inertia",)}
        causes |= {f"{seat}.inv_m": ("mass", *lever), f"{seat}.inv_mI": lever}
        causes |= {f"{seat}.{name}": ("transverse_inertia", name) for name in ("rx", "ry", "wx", "wy")}
        causes[f"{seat}.inv_I_t"] = ("transverse_inertia",)
        causes[f"{seat}.gyro"] = ("transverse_inertia", "inertia", "speed")
        turned = ("transverse_inertia", "inertia", "speed", positions[other])
        about = {
            "x": (*turned, "wy", f"{other}.mx", f"{other}.fy"),
            "y": (*turned, "wx", f"{other}.my", f"{other}.fx"),
        }
        causes |= {f"{seat}.alpha_{axis}_free": named for axis, named in about.items()}
        causes |= {f"{seat}.{name}": ("axial", name) for name in ("z", "vz")}
        causes[f"{seat}.inv_m_z"] = ("axial", "mass")
        causes[f"{seat}.az_free"] = ("axial", "mass", *_ALONG, f"{other}.fz")
        turning = ("inertia", *TORQUES, "speed", f"{other}.mz")
        spinning = ("eccentricity", "unbalance_angle", *turning, f"{other}.fx", f"{other}.fy")
        causes[f"{seat}.alpha_free"] = spinning
        causes[f"{seat}.ax_free"] = _once("mass", *spinning, positions[seat], *about["y"])
        weight = ("gravity", "inclination")
        causes[f"{seat}.ay_free"] = _once("mass", *weight, *spinning, positions[seat], *about["x"])
    return causes


def _once(*names: str) -> tuple[str, ...]:
    """Each name once."""
    return tuple(dict.fromkeys(names))


MODEL = Model(
    name="rigid_rotor",
    title="Rigid rotor",
    about="Rigid rotor with spin, unbalance and drag, in the plane, along its shaft and tilting; one seat "
    "for a touchdown bearing (A), one for a magnetic bearing (amb)",
    parameters=Parameters,
    inputs=Inputs,
    outputs=Outputs,
    memory=MEMORY,
    derive=derive,
    start=start,
    advance=advance,
    problems=(ORDER_PROBLEM, BRAKE_PROBLEM, BASE_PROBLEM),
    derivative=derivative,
    motion=motion,
    rename=_exposed,
    starts_from=_starts_from(),
)
