"""Active magnetic bearing: it levitates the journal until it is shut down.

A proportional-derivative law about the stator's centre plus the static load of this bearing, so that a
rotor that starts at rest floats there. The force is limited in each direction, and may lag behind the law
as that of an amplifier of finite bandwidth. Position is measured at the journal or, as on real machines, by
a sensor beside it. Along the shaft it may hold the rotor, too, as an axial magnetic bearing at the same
place does (`axial.stiffness` above 0). From the shutdown on, also within a macro step, the force is zero.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from ...modelkit.body import nothing_to_watch
from ...modelkit.kernel import kernel
from ...modelkit.model import Model
from ...modelkit.ports import (
    Interface,
    MountMotion,
    MountReaction,
    SeatReaction,
    SpatialLoad,
)
from ...modelkit.status import BAD_INPUT, OK
from ...modelkit.variables import choice, group, integer, real
from .. import seat
from ..seat import space
from .law import ROUNDING, limited
from .sensing import (
    AT_SENSOR,
    SENSED,
    SensedInputs,
    SpatialHeldMotion,
    sensed_places,
    static_load,
    static_load_along,
    sum_of_inputs,
)

SUPPLIED, FX, FY, FZ = range(seat.INSIDE, seat.INSIDE + 4)  # work of the control; force where it lags
FORCE_SCALE = 10.0  # N


@dataclass(frozen=True)
class AxialAxis:
    """The axis along the shaft; it shares bandwidth and shutdown with the others."""

    stiffness: float = real(
        0.0, "N/m", "stiffness of the control; 0: no control", minimum=0.0, needs="@axial"
    )
    damping: float = real(400.0, "N.s/m", "damping of the control", minimum=0.0, needs="stiffness")
    force_limit: float = real(1000.0, "N", "largest force", above=0.0, needs="stiffness")
    share: float = real(
        1.0, "1", "of the rotor's static load along the shaft", minimum=0.0, maximum=1.0, needs="stiffness"
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
class Inputs(SensedInputs):
    """Motion of journal, stator and sensor."""

    journal: SpatialHeldMotion = group(SpatialHeldMotion)
    housing: MountMotion = group(MountMotion)


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
def _law(t, q, m):
    """Force the control asks for (x, y, z; N), t seconds into the macro step."""
    p, o, a, j, u = m.p, m.o, m.p.axial, m.u.journal, m.u.sensor
    _, _, ex, ey = sensed_places(m.s.since + t, q, m.u, p.sensed)
    ux, uy = q[seat.JVX] - q[seat.HVX], q[seat.JVY] - q[seat.HVY]
    if p.sensed == AT_SENSOR:
        ux, uy = ux + u.vx - j.vx, uy + u.vy - j.vy
    fx = limited(o.load_x - p.stiffness * ex - p.damping * ux, p.force_limit)
    fy = limited(o.load_y - p.stiffness * ey - p.damping * uy, p.force_limit)
    if a.stiffness == 0.0:
        return fx, fy, 0.0
    ez, uz = q[space.JZ] - q[space.HZ], q[space.JVZ] - q[space.HVZ]
    return fx, fy, limited(o.load_z - a.stiffness * ez - a.damping * uz, a.force_limit)


@kernel
def react(t, q, dq, m):
    """`SpatialLoad` of the control (N), zero after the shutdown; sets dq of its work (W) and lag (N/s)."""
    w = m.p.bandwidth
    dq[SUPPLIED], dq[FX], dq[FY], dq[FZ] = 0.0, 0.0, 0.0, 0.0
    if t > m.s.span:
        return SpatialLoad(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    fx, fy, fz = _law(t, q, m)
    if w > 0.0:
        dq[FX], dq[FY], dq[FZ] = w * (fx - q[FX]), w * (fy - q[FY]), w * (fz - q[FZ])
        fx, fy, fz = q[FX], q[FY], q[FZ]
    dq[SUPPLIED] = fx * (q[seat.JVX] - q[seat.HVX]) + fy * (q[seat.JVY] - q[seat.HVY])
    dq[SUPPLIED] += fz * (q[space.JVZ] - q[space.HVZ])
    return SpatialLoad(fx, fy, 0.0, -fx, -fy, fz, 0.0 - fz, 0.0, 0.0)


@kernel
def rhs(t, q, dq, m):
    """Derivative dq (m.n,) of everything the bearing integrates, t (s) into the macro step."""
    space.spatial_copy_rates(t, q, dq, m, m.half, react(t, q, dq, m))


@kernel
def _ready(m, since):
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
def start(words):
    """Find the static load that the seat reports, and hand it over until the first step is taken."""
    m = words.view(MEMORY)[0]
    space.take_spatial_inputs(m.q, m)
    j = m.u.journal
    m.o.load_x, m.o.load_y = static_load(j)
    if m.p.axial.stiffness > 0.0:
        m.o.load_z = m.p.axial.share * static_load_along(j)
    m.q[FX], m.q[FY], m.q[FZ] = m.o.load_x, m.o.load_y, m.o.load_z
    seat.begin(space.SPATIAL, react, report, m)
    if m.p.shutdown_time > m.time:
        m.o.journal.fx, m.o.journal.fy = m.o.load_x, m.o.load_y
        m.o.housing.fx, m.o.housing.fy = -m.o.load_x, -m.o.load_y
        m.o.journal.fz, m.o.housing.fz = m.o.load_z, 0.0 - m.o.load_z


@kernel
def integrate(m, work, step):
    """Advance m.q by `step` (s): with load up to the shutdown, then free. As `seat.integrate`."""
    acting = m.s.span
    h, status, evaluations = m.h, OK, 0
    for part, span in ((max(acting, 0.0), acting), (step - max(acting, 0.0), -1.0)):
        if status == OK and part > 0.0:
            m.s.span = span
            h, status, more = seat.integrate(space.SPATIAL, rhs, nothing_to_watch, m, work, part)
            evaluations += more
    m.s.span = acting
    return h, status, evaluations


@kernel
def instant(t, q, dq, words):
    """Derivative dq (m.n,) and load in m.o (N) under the motion m.u at time t (s)."""
    m = words.view(MEMORY)[0]
    m.s.span = 1.0 if t < m.p.shutdown_time else -1.0
    seat.instant(space.SPATIAL, react, 0.0, q, dq, m)


@kernel
def advance(words, work, time, step):
    """One macro step of `step` (s) from `time` (s); returns a status."""
    m = words.view(MEMORY)[0]
    if not math.isfinite(sum_of_inputs(m.u)):
        return BAD_INPUT
    return seat.advance(space.SPATIAL, _ready, react, integrate, report, words, m, work, time, step)


_STATIC = ("journal.inv_m", "journal.static_fx", "journal.static_fy")
_AXIAL = ("axial.stiffness", "axial.share", "journal.inv_m_z", "journal.static_fz", "journal.az_free")

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
        f"{name}{axis}": (*needs, *when)
        for axis, needs in (
            *(("x", ("journal.ax_free", *_STATIC)), ("y", ("journal.ay_free", *_STATIC)), ("z", _AXIAL)),
        )
        for name, when in (
            *(("load_", ()), ("journal.f", ("shutdown_time",)), ("housing.f", ("shutdown_time",))),
        )
    },
)
