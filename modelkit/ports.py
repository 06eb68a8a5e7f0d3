"""The interface contract between bodies and the bearings that carry them.

A *seat* is the place where a bearing (touchdown or magnetic) holds a journal; a *mount* is where it
sits in its housing. The body gives motion and what the bearing needs to carry a reduced model of the
body through a macro step; the bearing gives back the load as mean and slope, which act on the body as
the load did that it exchanged: same momentum and first moment in time, or, for a housing on springs,
same position and velocity at the end.

Frame: right-handed, x horizontal, y vertical up, z along the shaft; angles and spins counter-clockwise seen
from the +z end; SI. A load is named after the body it acts on.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

from .variables import SWITCH, Choices, choice, groups, real

MODES = 20  # of a flexible body that a seat can carry, per plane
# s; an impact is over once the journal has been free for longer. A light inner ring that rattles between
# journal and balls parts for some ten microseconds at a time; from bounce to bounce of a rotor it is ms.
PARTING_TOLERANCE = 2e-4


@dataclass(frozen=True)
class PointMotion:
    """Motion of a point, such as a sensor looks at, at the beginning of the macro step."""

    x: float = real(0.0, "m", "horizontal position", nominal=1e-4)
    y: float = real(0.0, "m", "vertical position", nominal=1e-4)
    vx: float = real(0.0, "m/s", "horizontal velocity", nominal=0.1)
    vy: float = real(0.0, "m/s", "vertical velocity", nominal=0.1)


@dataclass(frozen=True)
class BodyMotion(PointMotion):
    """Translation of a body at the beginning of the macro step."""

    ax_free: float = real(0.0, "m/s2", "horizontal acceleration from everything but this bearing's force")
    ay_free: float = real(0.0, "m/s2", "vertical acceleration from everything but this bearing's force")
    inv_m: float = real(
        0.0, "1/kg", "acceleration per force of this bearing; 0: motion is prescribed", constant=True
    )


@dataclass(frozen=True)
class SprungMotion(BodyMotion):
    """Motion of a mass on a spring and a damper at the beginning of the macro step.

    With `k_over_m` and `c_over_m` the bearing carries it as the oscillator it is, not as a point mass:
    a housing on its springs, or an elastic mode of a rotor, is fast beside the macro step.
    """

    k_over_m: float = real(
        0.0, "1/s2", "restoring acceleration per displacement; 0: a point mass", constant=True, minimum=0.0
    )
    c_over_m: float = real(
        0.0, "1/s", "damping acceleration per velocity; 0: a point mass", constant=True, minimum=0.0
    )


@dataclass(frozen=True)
class AxialMotion:
    """Motion of a body along the shaft at the beginning of the macro step; all 0: it keeps its place."""

    z: float = real(0.0, "m", "position along the shaft", nominal=1e-4)
    vz: float = real(0.0, "m/s", "velocity along the shaft", nominal=0.1)
    az_free: float = real(0.0, "m/s2", "axial acceleration from everything but this bearing's force")
    inv_m_z: float = real(
        0.0, "1/kg", "axial acceleration per force of this bearing; 0: motion is prescribed", constant=True
    )


@dataclass(frozen=True)
class TiltMotion:
    """Tilt of a shaft at a seat at the beginning of the macro step; all 0: it keeps its direction.

    A positive `ry` moves the +z end to +x, a positive `rx` moves it to -y. A force of this bearing tilts
    the shaft where the seat is off the centre of mass, and a moment moves the seat by the same gain:

        x'' = ax_free + inv_m Fx + inv_mI My          rx'' = alpha_x_free + inv_I_t Mx - inv_mI Fy
        y'' = ay_free + inv_m Fy - inv_mI Mx          ry'' = alpha_y_free + inv_I_t My + inv_mI Fx

    The gyroscopic acceleration at the beginning of the step is in those without the bearing's load. What it
    changes by as the rates change is -gyro (ry' - wy) about x, and gyro (rx' - wx) about y.
    """

    rx: float = real(0.0, "rad", "tilt of the shaft about x", nominal=1e-4)
    ry: float = real(0.0, "rad", "tilt of the shaft about y", nominal=1e-4)
    wx: float = real(0.0, "rad/s", "rate of the tilt about x")
    wy: float = real(0.0, "rad/s", "rate of the tilt about y")
    alpha_x_free: float = real(
        0.0, "rad/s2", "tilt acceleration about x, gyroscopics in it, from everything but this bearing"
    )
    alpha_y_free: float = real(
        0.0, "rad/s2", "tilt acceleration about y, gyroscopics in it, from everything but this bearing"
    )
    inv_I_t: float = real(
        0.0, "1/(kg.m2)", "tilt acceleration per moment; 0: tilt is prescribed", constant=True
    )
    inv_mI: float = real(
        0.0,
        "1/(kg.m)",
        "tilt acceleration about y per force along x, and acceleration along x per moment about y; about x "
        "and along y with the other sign",
        constant=True,
    )
    gyro: float = real(
        0.0, "rad/s", "tilt acceleration about y per rate of the tilt about x; about x with the other sign"
    )


@dataclass(frozen=True)
class MountMotion(AxialMotion, SprungMotion):
    """Motion of a housing at the beginning of the macro step."""

    k_over_m_z: float = real(
        0.0, "1/s2", "axial restoring acceleration per displacement; 0: none", constant=True, minimum=0.0
    )
    c_over_m_z: float = real(
        0.0, "1/s", "axial damping acceleration per velocity; 0: none", constant=True, minimum=0.0
    )


@dataclass(frozen=True)
class ModeMotion(SprungMotion):
    """Share of an elastic mode in the motion of a seat, at the beginning of the macro step.

    `inv_m` is the square of the mode's shape at the seat, mass-normalised; 0: no such mode. The modes
    that are given come first. `slope` tells how it tilts the seat: by `slope` x about y, and by - `slope` y
    about x. A moment acts on it as the force `slope` My along x, and - `slope` Mx along y.
    """

    slope: float = real(0.0, "1/m", "tilt of the seat per displacement by the mode", constant=True)


@dataclass(frozen=True)
class PlanarSeatMotion(BodyMotion):
    """Motion of a journal across the shaft at the beginning of the macro step."""

    omega: float = real(0.0, "rad/s", "spin speed, counter-clockwise seen from the +z end", nominal=1000.0)
    alpha_free: float = real(0.0, "rad/s2", "spin acceleration from everything but this bearing's moment")
    inv_I: float = real(
        0.0, "1/(kg.m2)", "spin acceleration per moment; 0: spin is prescribed", constant=True
    )


@dataclass(frozen=True)
class SeatMotion(TiltMotion, AxialMotion, PlanarSeatMotion):
    """Motion of a journal in space at the beginning of the macro step."""


NO_LOAD = 1e-300  # N; states that nothing has to hold a body, where 0 states nothing


@dataclass(frozen=True)
class StaticLoad:
    """The load that would hold a body at rest; both 0 across the shaft, or 0 along it: not stated."""

    static_fx: float = real(0.0, "N", "force that holds the rotor at rest here at the start", constant=True)
    static_fy: float = real(0.0, "N", "force that holds the rotor at rest here at the start", constant=True)
    static_fz: float = real(0.0, "N", "axial force that holds the rotor at rest here", constant=True)


@dataclass(frozen=True)
class PlanarFlexibleSeatMotion(PlanarSeatMotion):
    """Motion of a journal across the shaft, and of the elastic modes that have a share in it."""

    mode: tuple = groups(SprungMotion, MODES)


@dataclass(frozen=True)
class FlexibleSeatMotion(SeatMotion):
    """Motion of a journal, and of the elastic modes that have a share in it.

    Without modes (not connected, `inv_m` = 0) the journal is carried as a point mass; with them, as the
    sum of their oscillators and of a point mass for the rest of `inv_m`.
    """

    mode: tuple = groups(ModeMotion, MODES)


@dataclass(frozen=True)
class PlanarMountLoad:
    """Force on a housing across the shaft over the last macro step."""

    fx: float = real(0.0, "N", "mean horizontal force over the last macro step")
    fy: float = real(0.0, "N", "mean vertical force over the last macro step")
    dfx: float = real(0.0, "N/s", "slope of the horizontal force, 12/H^3 int (t - t_mid) F dt")
    dfy: float = real(0.0, "N/s", "slope of the vertical force, 12/H^3 int (t - t_mid) F dt")


@dataclass(frozen=True)
class MountLoad(PlanarMountLoad):
    """Force on a housing over the last macro step."""

    fz: float = real(0.0, "N", "mean axial force over the last macro step")
    dfz: float = real(0.0, "N/s", "slope of the axial force, 12/H^3 int (t - t_mid) F dt")


@dataclass(frozen=True)
class PlanarSeatLoad:
    """Force across the shaft and moment about it on a journal over the last macro step."""

    fx: float = real(0.0, "N", "mean horizontal force over the last macro step")
    fy: float = real(0.0, "N", "mean vertical force over the last macro step")
    mz: float = real(0.0, "N.m", "mean moment about the shaft over the last macro step")
    dfx: float = real(0.0, "N/s", "slope of the horizontal force, 12/H^3 int (t - t_mid) F dt")
    dfy: float = real(0.0, "N/s", "slope of the vertical force, 12/H^3 int (t - t_mid) F dt")
    dmz: float = real(0.0, "N.m/s", "slope of the moment, 12/H^3 int (t - t_mid) M dt")


@dataclass(frozen=True)
class SeatLoad(PlanarSeatLoad):
    """Force and moment on a journal over the last macro step."""

    fz: float = real(0.0, "N", "mean axial force over the last macro step")
    dfz: float = real(0.0, "N/s", "slope of the axial force, 12/H^3 int (t - t_mid) F dt")
    mx: float = real(0.0, "N.m", "mean moment about x over the last macro step")
    my: float = real(0.0, "N.m", "mean moment about y over the last macro step")
    dmx: float = real(0.0, "N.m/s", "slope of the moment about x, 12/H^3 int (t - t_mid) M dt")
    dmy: float = real(0.0, "N.m/s", "slope of the moment about y, 12/H^3 int (t - t_mid) M dt")


@dataclass(frozen=True)
class ModeLoad:
    """The effect of a load on a mode in the last macro step, beyond its mean and slope.

    Of the load count its force and, where the mode tilts the seat, its moments (`ModeMotion`).
    For a mode of unit inv_m at rest: the end of its motion under the force as it was, less that under
    mean + slope (t - t_mid). Times the mode's shape at the seat it is what its coordinate lacks.
    """

    qx: float = real(0.0, "kg.m", "displacement times mass, horizontal")
    qy: float = real(0.0, "kg.m", "displacement times mass, vertical")
    px: float = real(0.0, "N.s", "momentum, horizontal")
    py: float = real(0.0, "N.s", "momentum, vertical")


@dataclass(frozen=True)
class PlanarFlexibleSeatLoad(PlanarSeatLoad):
    """Load on a journal across the shaft, and what mean and slope do not say of it to the elastic modes."""

    mode: tuple = groups(ModeLoad, MODES)


@dataclass(frozen=True)
class FlexibleSeatLoad(SeatLoad):
    """Load on a journal, and what mean and slope do not say of it to the elastic modes."""

    mode: tuple = groups(ModeLoad, MODES)


@dataclass(frozen=True)
class EnergyAccount:
    """Energy that crossed a connection since the start, as one of its sides states it."""

    work: float = real(0.0, "J", "work of the load on the body's motion as this side knows it", local=True)
    jump: float = real(0.0, "J", "mean load times the jump of that motion at each restart", local=True)


@dataclass(frozen=True)
class PlanarSeatReaction(PlanarFlexibleSeatLoad, EnergyAccount):
    """Outputs of a planar bearing at its seat."""


@dataclass(frozen=True)
class PlanarMountReaction(PlanarMountLoad, EnergyAccount):
    """Outputs of a planar bearing at its mount."""


@dataclass(frozen=True)
class SeatReaction(FlexibleSeatLoad, EnergyAccount):
    """Outputs of a bearing at its seat."""


@dataclass(frozen=True)
class MountReaction(MountLoad, EnergyAccount):
    """Outputs of a bearing at its mount."""


@dataclass(frozen=True)
class SeatState(SeatMotion, EnergyAccount):
    """Outputs of a body at a seat."""


@dataclass(frozen=True)
class FlexibleSeatState(FlexibleSeatMotion, EnergyAccount):
    """Outputs of a flexible body at a seat."""


@dataclass(frozen=True)
class MountState(MountMotion, EnergyAccount):
    """Outputs of a housing at its mount."""


# How a bearing carries the motion of what it is attached to through a macro step.
HOLD = 0
VELOCITY = 1
ACCELERATION = 2
MODEL = 3
ORDERS = Choices(
    "InterfaceOrder",
    ("held", "velocity", "acceleration", "model"),
    (
        "position held",
        "extrapolated with the velocity",
        "extrapolated with velocity and acceleration",
        "interface model driven by the bearing's own load",
    ),
)


@dataclass(frozen=True)
class Interface:
    """How a bearing treats its inputs between communication points, and how finely it steps."""

    order: int = choice(MODEL, ORDERS, "motion within a macro step")
    lead: int = choice(
        0,
        SWITCH,
        "the load handed over is that of the macro step to come, for tools that step all FMUs at once",
    )
    tolerance: float = real(
        1e-6,
        "1",
        "error of one micro-step over the model's scales",
        above=0.0,
        maximum=1e-2,
        needs="?micro_step == 0",
    )


@dataclass(frozen=True)
class Energy:
    """Energy of a component."""

    kinetic: float = real(0.0, "J", "kinetic energy of the bodies inside", local=True)
    potential: float = real(0.0, "J", "elastic and gravitational energy", local=True)
    dissipated: float = real(0.0, "J", "energy turned into heat since the start", local=True)


class Load(NamedTuple):
    """Instantaneous load of a planar bearing on journal and housing: N; jm: N m, about the shaft."""

    jx: float
    jy: float
    jm: float
    hx: float
    hy: float


class SpatialLoad(NamedTuple):
    """`Load` of a bearing in space: also along the shaft (N), and moments that tilt the journal (N m)."""

    jx: float
    jy: float
    jm: float
    hx: float
    hy: float
    jz: float
    hz: float
    jmx: float
    jmy: float


class Motion(NamedTuple):
    """Instantaneous planar motion of a body: m, m, m/s, m/s, rad/s."""

    x: float
    y: float
    vx: float
    vy: float
    spin: float
