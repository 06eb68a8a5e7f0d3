"""Active magnetic bearing: it levitates the journal until it is shut down.

A proportional-derivative law about the stator's centre plus the static load of this bearing, so that a
rotor that starts at rest floats there. The static load is what the rotor states (`static_fx`, ...), or
else what the seat alone would need: the rotor's acceleration without it times its mass. The force is
limited in each direction, and may lag behind the law as that of an amplifier of finite bandwidth.
Position is measured at the journal or, as on real machines, by a sensor beside it (`sensor`), whose
motion is carried through the macro step with the journal's. Along the shaft it may hold the rotor, too,
as an axial magnetic bearing does at the same place (`axial.stiffness` above 0). From the shutdown on, also
within a macro step, there is no force.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from ...modelkit.kernel import kernel
from ...modelkit.model import Model
from ...modelkit.ports import (
    FlexibleSeatMotion,
    Interface,
    MountMotion,
    MountReaction,
    PointMotion,
    SeatReaction,
    SpatialLoad,
    StaticLoad,
)
from ...modelkit.status import BAD_INPUT, OK
from ...modelkit.variables import Choices, choice, group, integer, real
from .. import seat
from ..seat import space

SUPPLIED, FX, FY, FZ = range(seat.INSIDE, seat.INSIDE + 4)  # work of the control; force where it lags
FORCE_SCALE = 10.0  # N
SENSED = Choices("SensedAt", ("journal", "sensor"))
ROUNDING = 1e-12  # s; a remainder of a macro step that only rounding leaves


@dataclass(frozen=True)
class AxialAxis:
    """The axis along the shaft; it shares bandwidth and shutdown with the others."""

    stiffness: float = real(
        0.0, "N/m", "stiffness of the control; 0: there is none", minimum=0.0, needs="@axial"
    )
    damping: float = real(400.0, "N.s/m", "damping of the control", minimum=0.0, needs="stiffness")
    force_limit: float = real(1000.0, "N", "largest force", above=0.0, needs="stiffness")
    share: float = real(
        1.0,
        "1",
        "of the rotor's static load along the shaft that it takes",
        minimum=0.0,
        maximum=1.0,
        needs="stiffness",
    )


@dataclass(frozen=True)
class Parameters:
    """Stiff enough to hold a small rotor, soft beside the touchdown bearing."""

    stiffness: float = real(2e5, "N/m", "stiffness of the control", minimum=0.0, tunable=True)
    damping: float = real(400.0, "N.s/m", "damping of the control", minimum=0.0, tunable=True)
    bandwidth: float = real(
        0.0, "rad/s", "of the amplifier (first order); 0: no lag", minimum=0.0, shown="rad/s"
    )
    sensed: int = choice(0, SENSED, "where position is measured")
    force_limit: float = real(1000.0, "N", "largest force in each direction", above=0.0, tunable=True)
    shutdown_time: float = real(0.005, "s", "time of the shutdown", minimum=0.0, tunable=True)
    interface: Interface = group(Interface)
    axial: AxialAxis = group(AxialAxis)


@dataclass(frozen=True)
class HeldMotion(StaticLoad, FlexibleSeatMotion):
    """Motion of the journal, and what it takes to hold it."""


@dataclass(frozen=True)
class Inputs:
    """Motion of journal, stator and sensor."""

    journal: HeldMotion = group(HeldMotion)
    housing: MountMotion = group(MountMotion)
    sensor: PointMotion = group(PointMotion)


@dataclass(frozen=True)
class Outputs:
    """Loads, and whether there will be any."""

    journal: SeatReaction = group(SeatReaction)
    housing: MountReaction = group(MountReaction)
    active: int = integer(1, "0 once it is shut down and gives no force any more")
    supplied: float = real(0.0, "J", "work of the control on the rotor since the start", local=True)
    load_x: float = real(0.0, "N", "static load found at the start", constant=True)
    load_y: float = real(0.0, "N", "static load found at the start", constant=True)
    load_z: float = real(0.0, "N", "static load along the shaft found at the start", constant=True)


@dataclass(frozen=True)
class Hidden:
    """Memory between steps."""

    seat: space.SpatialSeatMemory = group(space.SpatialSeatMemory)
    span: float = real(0.0, "s", "how long it still acts in this macro step; negative: not at all")
    since: float = real(0.0, "s", "from the inputs to the beginning of the present stretch")


MEMORY = seat.bearing_memory(Parameters, Outputs, FZ + 1, hidden=Hidden, inputs=Inputs)


@kernel
def _limited(force, limit):
    """The force, cut off at +-`limit` (both N)."""
    return min(max(force, -limit), limit)


@kernel
def _law(t, q, m):
    """Force the control asks for (x and y, N), t seconds into the macro step."""
    p, j, u = m.p, m.u.journal, m.u.sensor
    ex, ey = q[seat.JX] - q[seat.HX], q[seat.JY] - q[seat.HY]
    ux, uy = q[seat.JVX] - q[seat.HVX], q[seat.JVY] - q[seat.HVY]
    if p.sensed == 1:  # what the sensor saw at the restart, moved on as the journal moved
        ux, uy = ux + u.vx - j.vx, uy + u.vy - j.vy
        t += m.s.since
        ex += u.x - j.x + t * (u.vx - j.vx)
        ey += u.y - j.y + t * (u.vy - j.vy)
    fx = _limited(m.o.load_x - p.stiffness * ex - p.damping * ux, p.force_limit)
    return fx, _limited(m.o.load_y - p.stiffness * ey - p.damping * uy, p.force_limit)


@kernel
def _axial_law(q, m):
    """Force along the shaft the control asks for (N)."""
    a, ez, uz = m.p.axial, q[space.JZ] - q[space.HZ], q[space.JVZ] - q[space.HVZ]
    return _limited(m.o.load_z - a.stiffness * ez - a.damping * uz, a.force_limit)


@kernel
def react(t, q, dq, m):
    """`SpatialLoad` of the control (N), zero after the shutdown; sets dq of its work (W) and lag (N/s)."""
    p = m.p
    dq[SUPPLIED], dq[FX], dq[FY], dq[FZ] = 0.0, 0.0, 0.0, 0.0
    if t > m.s.span:
        return SpatialLoad(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    fx, fy = _law(t, q, m)
    if p.bandwidth > 0.0:
        dq[FX], dq[FY] = p.bandwidth * (fx - q[FX]), p.bandwidth * (fy - q[FY])
        fx, fy = q[FX], q[FY]
    dq[SUPPLIED] = fx * (q[seat.JVX] - q[seat.HVX]) + fy * (q[seat.JVY] - q[seat.HVY])
    if p.axial.stiffness == 0.0:
        return SpatialLoad(fx, fy, 0.0, -fx, -fy, 0.0, 0.0, 0.0, 0.0)
    fz, uz = _axial_law(q, m), q[space.JVZ] - q[space.HVZ]
    if p.bandwidth > 0.0:
        dq[FZ] = p.bandwidth * (fz - q[FZ])
        fz = q[FZ]
    dq[SUPPLIED] += fz * uz
    return SpatialLoad(fx, fy, 0.0, -fx, -fy, fz, -fz, 0.0, 0.0)


@kernel
def rhs(t, q, dq, m):
    """Derivative dq (m.n,) of everything the bearing integrates, t (s) into the macro step."""
    space.copy_rates(t, q, dq, m, m.half, react(t, q, dq, m))


@kernel
def observe(t, q, m):
    """Nothing to watch at t (s)."""


@kernel
def ready(m, since):
    """Find how long (s) it acts in the stretch that begins at m.time, `since` (s) after the inputs."""
    left = m.p.shutdown_time - m.time
    m.s.span = -1.0 if left <= ROUNDING else min(left, 2.0 * m.half)
    m.s.since = since


@kernel
def report(q, m):
    """Work supplied (J), and whether it is over: no load left in the last macro step, nor to come."""
    m.o.supplied = q[SUPPLIED]
    m.o.active = 0 if m.s.span < 0.0 else 1


@kernel
def derive(words):
    """Error weights of the state; returns 0: nothing can be wrong between the parameters."""
    m = words.view(MEMORY)[0]
    space.set_weights(m.weight)
    m.n = FZ + 1
    m.weight[FX] = m.weight[FY] = m.weight[FZ] = 1.0 / FORCE_SCALE if m.p.bandwidth > 0.0 else 0.0
    return 0


@kernel
def _load_along(axis, j):
    """Static load (N) along the shaft that the `axis` is to take of the journal `j`."""
    if axis.stiffness == 0.0 or j.inv_m_z == 0.0:
        return 0.0
    return axis.share * (j.static_fz if j.static_fz != 0.0 else -j.az_free / j.inv_m_z)


@kernel
def start(words):
    """Find the static load that the seat reports, and hand it over until the first step is taken.

    words: the memory, in 8-byte words.
    """
    m = words.view(MEMORY)[0]
    space.take_inputs(m.q, m)
    j = m.u.journal
    m.o.load_x, m.o.load_y = j.static_fx, j.static_fy
    if j.inv_m > 0.0 and j.static_fx == 0.0 and j.static_fy == 0.0:
        m.o.load_x = -j.ax_free / j.inv_m
        m.o.load_y = -j.ay_free / j.inv_m
    m.o.load_z = _load_along(m.p.axial, j)
    m.q[FX], m.q[FY], m.q[FZ] = m.o.load_x, m.o.load_y, m.o.load_z
    space.begin(react, report, m)
    if m.p.shutdown_time > m.time:
        m.o.journal.fx, m.o.journal.fy = m.o.load_x, m.o.load_y
        m.o.housing.fx, m.o.housing.fy = -m.o.load_x, -m.o.load_y
        m.o.journal.fz, m.o.housing.fz = m.o.load_z, 0.0 - m.o.load_z


@kernel
def _integrate_for(m, work, span):
    """`seat.integrate` over `span` (s), with load or without; work: (8, m.n) or wider."""
    return space.integrate(rhs, observe, m, work, span)


@kernel
def integrate(m, work, step):
    """Advance m.q by `step` (s): with load up to the shutdown, then free. As `seat.integrate`."""
    acting = m.s.span
    h, status, evaluations = m.h, OK, 0
    if acting > 0.0:
        h, status, evaluations = _integrate_for(m, work, acting)
    if status == OK and acting < step:
        m.s.span = -1.0
        h, status, more = _integrate_for(m, work, step - max(acting, 0.0))
        m.s.span = acting
        evaluations += more
    return h, status, evaluations


@kernel
def instant(t, q, dq, words):
    """Derivative dq (m.n,) and load in m.o (N) under the motion m.u at time t (s)."""
    m = words.view(MEMORY)[0]
    m.s.span = 1.0 if t < m.p.shutdown_time else -1.0
    space.instant(react, 0.0, q, dq, m)


@kernel
def advance(words, work, time, step):
    """One macro step of `step` (s) from `time` (s); returns a status."""
    m = words.view(MEMORY)[0]
    j, u = m.u.journal, m.u.sensor
    if not math.isfinite(u.x + u.y + u.vx + u.vy + j.static_fx + j.static_fy + j.static_fz):
        return BAD_INPUT
    return space.advance_timed(ready, react, integrate, report, words, m, work, time, step)


_STATIC = ("journal.inv_m", "journal.static_fx", "journal.static_fy")
_STATIC_Z = (
    *("axial.stiffness", "axial.share"),
    *("journal.inv_m_z", "journal.static_fz", "journal.az_free"),
)

MODEL = Model(
    name="amb",
    title="Active magnetic bearing",
    about="Magnetic bearing with proportional-derivative control, shut down at a chosen time",
    parameters=Parameters,
    inputs=Inputs,
    outputs=Outputs,
    hidden=Hidden,
    memory=MEMORY,
    derive=derive,
    start=start,
    advance=advance,
    instant=instant,
    starts_from={
        f"{name}{axis}": (f"journal.a{axis}_free", *_STATIC, *when)
        for axis in "xy"
        for name, when in (
            ("load_", ()),
            ("journal.f", ("shutdown_time",)),
            ("housing.f", ("shutdown_time",)),
        )
    }
    | {"load_z": _STATIC_Z}
    | {f"{body}.fz": (*_STATIC_Z, "shutdown_time") for body in ("journal", "housing")},
)
