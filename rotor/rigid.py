"""A rigid rotor in planar motion: a disk that floats, falls, bounces and spins.

Three coordinates: position of the shaft centre and rotation. Its seats lie in the plane of the centre
of mass; a rotor that tilts is a matter of the flexible model. Unbalance enters with spin acceleration
as in (3.24): the centre of mass stands off by `eccentricity`, and the shaft centre feels

    m e (omega^2 cos(theta + phase) + alpha sin(theta + phase)),   likewise in y.

A load at the shaft centre turns the rotor about its centre of mass, so unbalance makes no energy.

Sign and frame: x horizontal, y up, angles counter-clockwise, SI.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from touchdown.modelkit import body
from touchdown.modelkit.kernel import kernel
from touchdown.modelkit.model import Model, memory_layout
from touchdown.modelkit.ports import Energy, SeatLoad, SeatState
from touchdown.modelkit.variables import group, real
from touchdown.rotor.drag import drag

X, Y, VX, VY, ANGLE, SPIN, WORK_A, WORK_AMB, LOSS = range(9)
SIZE = 9


@dataclass(frozen=True)
class Parameters:
    """The disk of section 4.3 of the source."""

    mass: float = real(1.65, "kg", "mass", above=0.0)
    inertia: float = real(0.5e-3, "kg.m2", "polar moment of inertia", above=0.0)
    gravity: float = real(9.81, "m/s2", "gravity, downwards", minimum=0.0)
    speed: float = real(942.477796076938, "rad/s", "spin speed at the start")
    eccentricity: float = real(
        0.0, "m", "distance of the centre of mass from the shaft centre", minimum=0.0
    )
    unbalance_angle: float = real(0.0, "rad", "angle of the centre of mass at the start")
    drag: float = real(0.0, "N.m", "constant torque against the spin", minimum=0.0)
    viscous_drag: float = real(0.0, "N.m.s/rad", "torque against the spin per spin speed", minimum=0.0)
    x: float = real(0.0, "m", "horizontal position at the start")
    y: float = real(0.0, "m", "vertical position at the start")
    vx: float = real(0.0, "m/s", "horizontal velocity at the start")
    vy: float = real(0.0, "m/s", "vertical velocity at the start")


@dataclass(frozen=True)
class Inputs:
    """Loads of the touchdown bearing (A) and of the magnetic bearing (amb)."""

    A: SeatLoad = group(SeatLoad)
    amb: SeatLoad = group(SeatLoad)


@dataclass(frozen=True)
class Outputs:
    """Motion at both seats."""

    A: SeatState = group(SeatState)
    amb: SeatState = group(SeatState)
    energy: Energy = group(Energy)


MEMORY = memory_layout(Parameters, Inputs, Outputs, SIZE)


@kernel
def rhs(t, y, dy, m):
    """Newton and Euler under the loads mean + slope (t - t_mid)."""
    p, a, b = m.p, m.u.A, m.u.amb
    s = t - m.half
    ax, ay, am = a.fx + a.dfx * s, a.fy + a.dfy * s, a.mz + a.dmz * s
    bx, by, bm = b.fx + b.dfx * s, b.fy + b.dfy * s, b.mz + b.dmz * s
    braking = drag(y[SPIN], p)
    dvx, dvy, alpha = _accelerations(y, ax + bx, ay + by, am + bm - braking, p)
    dy[X] = y[VX]
    dy[Y] = y[VY]
    dy[VX] = dvx
    dy[VY] = dvy
    dy[ANGLE] = y[SPIN]
    dy[SPIN] = alpha
    dy[WORK_A] = ax * y[VX] + ay * y[VY] + am * y[SPIN]
    dy[WORK_AMB] = bx * y[VX] + by * y[VY] + bm * y[SPIN]
    dy[LOSS] = braking * y[SPIN]


@kernel
def _accelerations(y, fx, fy, moment, p):
    """Of the shaft centre (m/s2) and the spin (rad/s2) under loads at the shaft centre and gravity.

    The centre of mass stands off by e (c, s): I alpha = M + e (Fx s - Fy c), gravity drops out.
    """
    if p.eccentricity == 0.0:
        return fx / p.mass, fy / p.mass - p.gravity, moment / p.inertia
    angle = y[ANGLE] + p.unbalance_angle
    ex, ey = p.eccentricity * math.cos(angle), p.eccentricity * math.sin(angle)
    alpha = (moment + fx * ey - fy * ex) / p.inertia
    w2 = y[SPIN] * y[SPIN]
    return fx / p.mass + w2 * ex + alpha * ey, fy / p.mass + w2 * ey - alpha * ex - p.gravity, alpha


@kernel
def publish(y, m):
    """Outputs at the end of the step: at each seat what it does not cause itself is 'free'."""
    p = m.p
    _publish_seat(y, p, m.o.A, m.u.amb, m.half)
    _publish_seat(y, p, m.o.amb, m.u.A, m.half)
    m.o.A.work = y[WORK_A]
    m.o.amb.work = y[WORK_AMB]
    angle = y[ANGLE] + p.unbalance_angle
    ex, ey = p.eccentricity * math.cos(angle), p.eccentricity * math.sin(angle)
    vx, vy = y[VX] - y[SPIN] * ey, y[VY] + y[SPIN] * ex  # of the centre of mass
    e = m.o.energy
    e.kinetic = 0.5 * p.mass * (vx * vx + vy * vy) + 0.5 * p.inertia * y[SPIN] ** 2
    e.potential = p.mass * p.gravity * (y[Y] + ey)
    e.dissipated = y[LOSS]


@kernel
def _publish_seat(y, p, seat, other, half):
    """`other` is the load of the other seat, taken at its end value."""
    seat.x, seat.y, seat.vx, seat.vy = y[X], y[Y], y[VX], y[VY]
    seat.ax_free, seat.ay_free, seat.alpha_free = _accelerations(
        y,
        other.fx + other.dfx * half,
        other.fy + other.dfy * half,
        other.mz + other.dmz * half - drag(y[SPIN], p),
        p,
    )
    seat.inv_m = 1.0 / p.mass
    seat.omega = y[SPIN]
    seat.inv_I = 1.0 / p.inertia


@kernel
def start(words):
    """State and outputs from the parameters."""
    m = words.view(MEMORY)[0]
    p, y = m.p, m.q
    y[X], y[Y], y[VX], y[VY] = p.x, p.y, p.vx, p.vy
    y[SPIN] = p.speed
    m.half = 0.0
    publish(y, m)


@kernel
def _sum(load):
    return load.fx + load.fy + load.mz + load.dfx + load.dfy + load.dmz


@kernel
def advance(words, work, time, step):
    """One macro step under the given loads."""
    m = words.view(MEMORY)[0]
    return body.advance(rhs, publish, m, work, time, step, _sum(m.u.A) + _sum(m.u.amb))


def weights(p: Parameters) -> np.ndarray:
    """Positions matter at 1 um, velocities at 1 cm/s, spin at 10 rad/s."""
    w = np.zeros(SIZE)
    w[[X, Y]] = 1e6
    w[[VX, VY]] = 1e2
    w[[ANGLE, SPIN]] = 1e-1
    return w


def _starts_from() -> dict[str, tuple[str, ...]]:
    found: dict[str, tuple[str, ...]] = {
        "energy.kinetic": ("mass", "inertia", "speed", "vx", "vy", "eccentricity", "unbalance_angle"),
        "energy.potential": ("mass", "gravity", "y", "eccentricity", "unbalance_angle"),
    }
    for seat, other in (("A", "amb"), ("amb", "A")):
        loads = (f"{other}.fx", f"{other}.fy")
        turning = ("inertia", "drag", "viscous_drag", "speed", f"{other}.mz")
        unbalance = ("eccentricity", "unbalance_angle", *turning, *loads)
        found |= {
            f"{seat}.{name}": (name if name in ("x", "y", "vx", "vy") else source,)
            for name, source in (
                ("x", ""),
                ("y", ""),
                ("vx", ""),
                ("vy", ""),
                ("inv_m", "mass"),
                ("omega", "speed"),
                ("inv_I", "inertia"),
            )
        }
        found[f"{seat}.alpha_free"] = unbalance
        found[f"{seat}.ax_free"] = ("mass", *unbalance)
        found[f"{seat}.ay_free"] = ("mass", "gravity", *unbalance)
    return found


MODEL = Model(
    name="rigid_rotor",
    title="Rigid rotor",
    about="Rigid disk in planar motion with spin, unbalance and drag; one seat for a touchdown "
    "bearing (A), one for a magnetic bearing (amb)",
    parameters=Parameters,
    inputs=Inputs,
    outputs=Outputs,
    memory=MEMORY,
    start=start,
    advance=advance,
    weights=weights,
    rhs=rhs,
    publish=publish,
    starts_from=_starts_from(),
)
