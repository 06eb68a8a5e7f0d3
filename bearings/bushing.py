"""Plain touchdown bearing: a bushing fixed in its housing, with nothing that rolls.

The simplest thing a journal can land in. It serves as a bearing of its own (planetary whirl, dry
friction), and as the check of the contact law and of the coupling against closed forms.
"""

from __future__ import annotations

from dataclasses import dataclass

from ..modelkit.kernel import kernel
from ..modelkit.model import Model, constants
from ..modelkit.numerics import blank, missing
from ..modelkit.ports import Energy, Interface, Load, PlanarMountReaction, PlanarSeatReaction
from ..modelkit.variables import group, real
from . import seat
from .contact import journal as bore
from .contact.friction import FrictionLaw
from .contact.journal import (
    RATE_FROM,
    ContactMemory,
    ContactReport,
    Touched,
    note_touch,
    swing_rate,
    time_to_touch,
    touch,
    watch_contact,
)
from .contact.laws import elastic_energy
from .contact.line import BoreContact
from .heat import shares
from .heat.shares import HeatReport, Sources


@dataclass(frozen=True)
class Parameters:
    """Defaults: the disk of section 4.3 in a bronze bushing."""

    clearance: float = real(0.3e-3, "m", "radial clearance of the journal in the bore", above=0.0)
    journal_radius: float = real(9.7e-3, "m", "radius of the journal", above=0.0)
    interface: Interface = group(Interface)
    contact: BoreContact = group(BoreContact, damping=1e7)
    friction: FrictionLaw = group(FrictionLaw, static=0.27, dynamic=0.18)


@dataclass(frozen=True)
class Outputs:
    """Loads, and the contact."""

    journal: PlanarSeatReaction = group(PlanarSeatReaction)
    housing: PlanarMountReaction = group(PlanarMountReaction)
    contact: ContactReport = group(ContactReport)
    energy: Energy = group(Energy)
    heat: HeatReport = group(HeatReport)


@dataclass(frozen=True)
class Derived:
    """Constants that follow from the parameters."""

    contact: BoreContact = group(BoreContact)
    friction: FrictionLaw = group(FrictionLaw)


@dataclass(frozen=True)
class Hidden:
    """Memory between evaluations and steps."""

    seat: seat.SeatMemory = group(seat.SeatMemory)
    contact: ContactMemory = group(ContactMemory)
    touched: Touched = group(Touched)


MEMORY = seat.bearing_memory(Parameters, Outputs, seat.INSIDE, derived=Derived, hidden=Hidden)
STATIC = Parameters().friction.static
MASSLESS = len(bore.PROBLEMS) + 1  # number of the problem
OWN_PROBLEMS = (
    *bore.PROBLEMS,
    "contact.damping_ratio = {0:g} needs contact.mass above 0 kg; "
    "a bushing does not know the mass of its journal",
)
CONSTANTS, PROBLEMS = constants(MEMORY, OWN_PROBLEMS)


@kernel
def react(t, q, dq, m):
    """`Load` on journal and housing (N, N m); inside there is only heat, whose rate (W) goes to dq."""
    journal, housing = seat.journal_motion(q), seat.housing_motion(q)
    j = touch(journal, housing, m.p.journal_radius, m.p.clearance, m.d.contact, m.d.friction)
    note_touch(m.s.touched, j)
    dq[shares.LOSS] = j.loss
    shares.set_rates(Sources(j.loss, 0.0, 0.0, 0.0, 0.0), j.sliding, dq, shares.HEAT)
    return Load(j.fx, j.fy, j.journal_moment, -j.fx, -j.fy)


@kernel
def rhs(t, q, dq, m):
    """Derivative dq (m.n,) of everything the bearing integrates, t (s) into the macro step."""
    seat.copy_rates(t, q, dq, m, m.half, react(t, q, dq, m))


@kernel
def observe(t, q, m):
    """Peaks and the first contact, after each accepted micro-step, t (s) into the macro step."""
    watch_contact(m.time + t, seat.journal_motion(q), m.s.touched, m.o.contact, m.s.contact)


@kernel
def report(q, m):
    """Outputs wanted once per macro step, from the state q (m.n,)."""
    c, s = m.o.contact, m.s.touched
    c.force, c.indentation = s.normal, s.indentation
    c.sliding = q[seat.JW] * m.p.journal_radius
    c.reach = time_to_touch(seat.journal_motion(q), seat.housing_motion(q), m.p.clearance)
    m.o.energy.potential = elastic_energy(s.indentation, m.d.contact)
    m.o.energy.dissipated = q[shares.LOSS]
    shares.report(q, shares.HEAT, m)


@kernel
def problem_of(p, numbers):
    """The number in `PROBLEMS` of a fault in the parameters p, or 0; numbers: of the message."""
    if p.contact.damping_ratio > 0.0 and p.contact.mass == 0.0:
        numbers[0] = p.contact.damping_ratio
        return MASSLESS
    return bore.bore_problem(p, STATIC, numbers)


@kernel
def derive(words):
    """Fill in what the laws leave open, and the error weights; returns a problem's number, or 0."""
    m = words.view(MEMORY)[0]
    blank(words, CONSTANTS)
    problem = problem_of(m.p, m.message_numbers)
    if problem != 0:
        return problem
    bore.derive(m.d, m.p, m.p.contact.mass)
    seat.set_weights(m.weight)
    m.n = seat.INSIDE
    return missing(words, CONSTANTS)


@kernel
def start(words):
    """Nothing inside; words: the memory, in 8-byte words."""
    m = words.view(MEMORY)[0]
    seat.take_inputs(m.q, m)
    m.o.contact.rate = swing_rate(m.d.contact, m.u.journal.inv_m)
    seat.begin(seat.PLANAR, react, report, m)


@kernel
def integrate(m, work, span):
    """Advance m.q by `span` (s); work: (8, m.n) or wider. As `seat.integrate`."""
    return seat.integrate(seat.PLANAR, rhs, observe, m, work, span)


@kernel
def instant(t, q, dq, words):
    """Derivative dq (m.n,) and load in m.o (N, N m) under the motion m.u."""
    m = words.view(MEMORY)[0]
    seat.instant(seat.PLANAR, react, t, q, dq, m)


@kernel
def advance(words, work, time, step):
    """One macro step of `step` (s) from `time` (s); returns a status."""
    m = words.view(MEMORY)[0]
    return seat.advance(seat.PLANAR, seat.any_time, react, integrate, report, words, m, work, time, step)


MODEL = Model(
    name="bushing",
    title="Plain touchdown bushing",
    about="Bore fixed in the housing: contact and friction, no rolling elements",
    parameters=Parameters,
    inputs=seat.BearingInputs,
    outputs=Outputs,
    derived=Derived,
    hidden=Hidden,
    memory=MEMORY,
    derive=derive,
    start=start,
    advance=advance,
    problems=PROBLEMS,
    instant=instant,
    starts_from={"contact.rate": RATE_FROM},
)
