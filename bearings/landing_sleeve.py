"""A landing sleeve: a bore fixed in its housing, and faces on which a shoulder of the rotor lands.

The bore is that of `bushing`; the faces stop the rotor along its shaft (`bearings.contact.face`), which may
be tilted. The bore acts in its middle: it does not tilt the journal.
"""

from __future__ import annotations

from dataclasses import dataclass

from ..modelkit.kernel import kernel
from ..modelkit.model import Model, constants
from ..modelkit.numerics import blank, missing
from ..modelkit.ports import MountReaction, SeatReaction, SpatialLoad
from ..modelkit.variables import group
from . import bushing, seat
from .contact import journal as bore
from .contact.face import (
    Shoulder,
    ShoulderMemory,
    ShoulderReport,
    Slip,
    Tilt,
    land_tilted,
    note_landing,
    report_faces,
    watch_faces,
)
from .contact.journal import RATE_FROM, note_touch, swing_rate, touch
from .heat import shares
from .heat.shares import Sources
from .seat import space

FACE_LOSS = space.OWN  # heat of the faces


@dataclass(frozen=True)
class Parameters(bushing.Parameters):
    """Defaults: the disk of section 4.3 in a bronze sleeve, without faces."""

    shoulder: Shoulder = group(Shoulder)


@dataclass(frozen=True)
class Outputs(bushing.Outputs):
    """Loads, and the contacts."""

    journal: SeatReaction = group(SeatReaction)
    housing: MountReaction = group(MountReaction)
    shoulder: ShoulderReport = group(ShoulderReport)


@dataclass(frozen=True)
class Hidden(bushing.Hidden):
    """Memory between evaluations and steps."""

    seat: space.SpatialSeatMemory = group(space.SpatialSeatMemory)
    shoulder: ShoulderMemory = group(ShoulderMemory)


MEMORY = seat.bearing_memory(
    Parameters,
    Outputs,
    seat.INSIDE,
    derived=bushing.Derived,
    hidden=Hidden,
    inputs=space.SpatialInputs,
)
CONSTANTS, PROBLEMS = constants(MEMORY, bushing.OWN_PROBLEMS)


@kernel
def react(t, q, dq, m):
    """`SpatialLoad` on journal and housing (N, N m); the rate of heat (W) goes to dq."""
    journal, housing = seat.journal_motion(q), seat.housing_motion(q)
    j = touch(journal, housing, m.p.journal_radius, m.p.clearance, m.d.contact, m.d.friction)
    note_touch(m.s.touched, j)
    slip = Slip(
        q[space.JZ] - q[space.HZ],
        q[space.JVZ] - q[space.HVZ],
        journal.vx - housing.vx,
        journal.vy - housing.vy,
        journal.spin,
    )
    tilt = Tilt(q[space.JRX], q[space.JRY], q[space.JWX], q[space.JWY])
    f = land_tilted(slip, tilt, m.p.shoulder, m.d.friction)
    note_landing(m.s.shoulder, f)
    dq[shares.LOSS], dq[FACE_LOSS] = j.loss, f.loss
    shares.set_rates(Sources(j.loss + f.loss, 0.0, 0.0, 0.0, 0.0), j.sliding, dq, shares.HEAT)
    fx, fy = j.fx + f.fx, j.fy + f.fy
    return SpatialLoad(fx, fy, j.journal_moment + f.moment, -fx, -fy, f.fz, -f.fz, f.mx, f.my)


@kernel
def rhs(t, q, dq, m):
    """Derivative dq (m.n,) of everything the bearing integrates, t (s) into the macro step."""
    space.spatial_copy_rates(t, q, dq, m, m.half, react(t, q, dq, m))


@kernel
def observe(t, q, m):
    """Peaks and first contacts, after each accepted micro-step, t (s) into the macro step."""
    bushing.observe(t, q, m)
    watch_faces(m.time + t, m.p.shoulder, m.o.shoulder, m.s.shoulder)


@kernel
def report(q, m):
    """Outputs wanted once per macro step, from the state q (m.n,)."""
    bushing.report(q, m)
    m.o.energy.potential += report_faces(q[FACE_LOSS], m.p.shoulder, m.o.shoulder, m.s.shoulder)
    m.o.energy.dissipated += q[FACE_LOSS]


@kernel
def derive(words):
    """Fill in what the laws leave open, and the error weights; returns a problem's number, or 0."""
    m = words.view(MEMORY)[0]
    blank(words, CONSTANTS)
    problem = bushing.problem_of(m.p, m.message_numbers)
    if problem != 0:
        return problem
    bore.derive(m.d, m.p, m.p.contact.mass)
    space.set_weights(m.weight)
    if m.p.shoulder.gap_minus > 0.0 or m.p.shoulder.gap_plus > 0.0:
        space.weigh_tilt(m.weight)
    m.n = seat.INSIDE
    return missing(words, CONSTANTS)


@kernel
def start(words):
    """Nothing inside; words: the memory, in 8-byte words."""
    m = words.view(MEMORY)[0]
    space.take_spatial_inputs(m.q, m)
    m.o.contact.rate = swing_rate(m.d.contact, m.u.journal.inv_m)
    seat.begin(space.SPATIAL, react, report, m)


@kernel
def integrate(m, work, span):
    """Advance m.q by `span` (s); work: (8, m.n) or wider. As `seat.integrate`."""
    return seat.integrate(space.SPATIAL, rhs, observe, m, work, span)


@kernel
def instant(t, q, dq, words):
    """Derivative dq (m.n,) and load in m.o (N, N m) under the motion m.u."""
    m = words.view(MEMORY)[0]
    seat.instant(space.SPATIAL, react, t, q, dq, m)


@kernel
def advance(words, work, time, step):
    """One macro step of `step` (s) from `time` (s); returns a status."""
    m = words.view(MEMORY)[0]
    return seat.advance(space.SPATIAL, seat.any_time, react, integrate, report, words, m, work, time, step)


MODEL = Model(
    name="landing_sleeve",
    title="Landing sleeve",
    about="Bore and faces fixed in the housing: contact and friction across and along the shaft",
    parameters=Parameters,
    inputs=space.SpatialInputs,
    outputs=Outputs,
    derived=bushing.Derived,
    hidden=Hidden,
    memory=MEMORY,
    derive=derive,
    start=start,
    advance=advance,
    problems=PROBLEMS,
    instant=instant,
    starts_from={"contact.rate": RATE_FROM},
)
