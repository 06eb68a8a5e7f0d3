"""The housing of a touchdown bearing: a mass on springs and dampers to the ground, at rest at the start.

The outer ring sits in it and moves with it, along the shaft, too. `x0`, `y0` put its rest position off the
rotor's axis (misalignment). Frame and signs as everywhere: x horizontal, y up, SI.
"""

from __future__ import annotations

from dataclasses import dataclass

from ...modelkit import body
from ...modelkit.base_motion import BASE_PROBLEM, BaseMotion, base_acceleration, base_after, moving
from ...modelkit.excitation import course_problem
from ...modelkit.gravity import gravity_across, gravity_along
from ...modelkit.kernel import kernel
from ...modelkit.model import Model, memory_layout
from ...modelkit.numerics import squared
from ...modelkit.ports import Energy, MountLoad, MountState
from ...modelkit.variables import group, real
from .mount_law import Body, Ground

X, Y, VX, VY, WORK, LOSS, Z, VZ, WORK_BASE = range(9)
SIZE = 9


@dataclass(frozen=True)
class Parameters(Ground, Body):
    """Defaults: the disk and rotor I of Halminen (2016)."""

    stiffness: float = real(
        2.5e8, "N/m", "stiffness to the ground, each direction and along the shaft", minimum=0.0
    )
    damping: float = real(
        2500.0, "N.s/m", "damping to the ground, each direction and along the shaft", minimum=0.0
    )
    base: BaseMotion = group(BaseMotion)


@dataclass(frozen=True)
class Inputs:
    """Force of the bearing."""

    seat: MountLoad = group(MountLoad)


@dataclass(frozen=True)
class Outputs:
    """Motion."""

    seat: MountState = group(MountState)
    energy: Energy = group(Energy)


MEMORY = memory_layout(Parameters, Inputs, Outputs, SIZE)


@kernel
def rhs(t, q, dq, m):
    """Derivative dq (9,) of the state q (9,) under the force mean + slope (t - t_mid); t: s."""
    p, u = m.p, m.u.seat
    mass = p.mass + p.outer_ring
    s = t - m.half
    fx, fy = u.fx + u.dfx * s, u.fy + u.dfy * s
    dq[X] = q[VX]
    dq[Y] = q[VY]
    dq[VX] = (fx - p.stiffness * (q[X] - p.x0) - p.damping * q[VX]) / mass
    dq[VY] = (fy - p.stiffness * (q[Y] - p.y0) - p.damping * q[VY]) / mass - gravity_across(
        p.gravity, p.inclination
    )
    fz = u.fz + u.dfz * s
    dq[Z] = q[VZ]
    dq[VZ] = (fz - p.stiffness * q[Z] - p.damping * q[VZ]) / mass + gravity_along(p.gravity, p.inclination)
    dq[WORK] = fx * q[VX] + fy * q[VY] + fz * q[VZ]
    dq[WORK_BASE] = 0.0
    if moving(p.base):
        base_x, base_y = base_acceleration(m, t - m.half)
        dq[VX], dq[VY] = dq[VX] - base_x, dq[VY] - base_y
        dq[WORK_BASE] = -mass * (base_x * q[VX] + base_y * q[VY])
    dq[LOSS] = p.damping * (squared(q[VX]) + squared(q[VY]) + squared(q[VZ]))


@kernel
def _publish(q, m):
    """Outputs at the end of the step, from the state q (9,)."""
    p, o = m.p, m.o.seat
    mass = p.mass + p.outer_ring
    down, along = gravity_across(p.gravity, p.inclination), gravity_along(p.gravity, p.inclination)
    ex, ey = q[X] - p.x0, q[Y] - p.y0
    o.x, o.y, o.vx, o.vy = q[X], q[Y], q[VX], q[VY]
    o.ax_free = -(p.stiffness * ex + p.damping * q[VX]) / mass
    o.ay_free = -(p.stiffness * ey + p.damping * q[VY]) / mass - down
    if moving(p.base):
        base_x, base_y = base_after(m)
        o.ax_free, o.ay_free = o.ax_free - base_x, o.ay_free - base_y
    o.inv_m = 1.0 / mass
    o.k_over_m, o.c_over_m = p.stiffness / mass, p.damping / mass
    o.z, o.vz, o.inv_m_z = q[Z], q[VZ], o.inv_m
    o.az_free = -(p.stiffness * q[Z] + p.damping * q[VZ]) / mass + along
    o.k_over_m_z, o.c_over_m_z = o.k_over_m, o.c_over_m
    o.work = q[WORK]
    e = m.o.energy
    e.kinetic = 0.5 * mass * (squared(q[VX]) + squared(q[VY]) + squared(q[VZ]))
    e.potential = 0.5 * p.stiffness * (ex * ex + ey * ey) + mass * down * q[Y]
    e.potential += 0.5 * p.stiffness * squared(q[Z]) - mass * along * q[Z]
    e.potential -= q[WORK_BASE]
    e.dissipated = q[LOSS]


@kernel
def derive(words):
    """Error weights: positions matter at 1 um, velocities at 1 cm/s.

    Returns 1 where the points of the base are not in order, else 0.
    """
    m = words.view(MEMORY)[0]
    m.n = SIZE
    m.weight[X], m.weight[Y], m.weight[Z] = 1e6, 1e6, 1e6
    m.weight[VX], m.weight[VY], m.weight[VZ] = 1e2, 1e2, 1e2
    return 1 if course_problem(m.p.base.course, m.message_numbers) != 0 else 0


@kernel
def start(words):
    """At rest, sagged under its own weight; words: the memory, in 8-byte words."""
    m = words.view(MEMORY)[0]
    p = m.p
    mass = p.mass + p.outer_ring
    sag = mass * gravity_across(p.gravity, p.inclination) / p.stiffness if p.stiffness > 0.0 else 0.0
    m.q[X], m.q[Y] = p.x0, p.y0 - sag
    if p.stiffness > 0.0:
        m.q[Z] = mass * gravity_along(p.gravity, p.inclination) / p.stiffness
    _publish(m.q, m)


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
    """One macro step of `step` (s) from `time` (s) under the given force; returns a status."""
    m = words.view(MEMORY)[0]
    u = m.u.seat
    return body.advance(rhs, _publish, m, work, time, step, u.fx + u.fy + u.fz + u.dfx + u.dfy + u.dfz)


_MASS = ("mass", "outer_ring")
_SAG = (*_MASS, "stiffness", "gravity", "inclination")

MODEL = Model(
    name="housing",
    title="Housing",
    about="Housing with the outer ring on springs and dampers to the ground",
    parameters=Parameters,
    inputs=Inputs,
    outputs=Outputs,
    memory=MEMORY,
    derive=derive,
    start=start,
    advance=advance,
    derivative=derivative,
    motion=motion,
    problems=(BASE_PROBLEM,),
    starts_from={
        "seat.x": ("x0",),
        **dict.fromkeys(("seat.y", "seat.ay_free", "energy.potential"), ("y0", *_SAG)),
        **dict.fromkeys(("seat.z", "seat.az_free"), _SAG),
        **dict.fromkeys(("seat.inv_m", "seat.inv_m_z"), _MASS),
        **dict.fromkeys(("seat.k_over_m", "seat.k_over_m_z"), ("stiffness", *_MASS)),
        **dict.fromkeys(("seat.c_over_m", "seat.c_over_m_z"), ("damping", *_MASS)),
    },
)
