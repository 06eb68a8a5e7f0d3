"""A bearing without a clearance and without friction: rubber between journal and housing."""

from __future__ import annotations

from dataclasses import dataclass

from ..modelkit.kernel import kernel
from ..modelkit.model import Model
from ..modelkit.ports import Interface, Load, PlanarMountReaction, PlanarSeatReaction
from ..modelkit.variables import group, real
from . import seat


@dataclass(frozen=True)
class Parameters:
    """Rubber."""

    stiffness: float = real(1e6, "N/m", "stiffness of the rubber", minimum=0.0)
    damping: float = real(1e3, "N.s/m", "its damping", minimum=0.0)
    interface: Interface = group(Interface)


@dataclass(frozen=True)
class Outputs:
    """Loads."""

    journal: PlanarSeatReaction = group(PlanarSeatReaction)
    housing: PlanarMountReaction = group(PlanarMountReaction)


@dataclass(frozen=True)
class Hidden:
    """Memory of the seat."""

    seat: seat.SeatMemory = group(seat.SeatMemory)


MEMORY = seat.bearing_memory(Parameters, Outputs, seat.INSIDE, hidden=Hidden)


@kernel
def react(t, q, dq, m):
    """Load on journal and housing (N)."""
    journal, housing = seat.journal_motion(q), seat.housing_motion(q)
    k, c = m.p.stiffness, m.p.damping
    fx = -k * (journal.x - housing.x) - c * (journal.vx - housing.vx)
    fy = -k * (journal.y - housing.y) - c * (journal.vy - housing.vy)
    return Load(fx, fy, 0.0, -fx, -fy)


@kernel
def rhs(t, q, dq, m):
    """Nothing is inside; the copies move."""
    seat.copy_rates(t, q, dq, m, m.half, react(t, q, dq, m))


@kernel
def observe(t, q, m):
    """Nothing to watch."""


@kernel
def report(q, m):
    """Nothing to report."""


@kernel
def derive(words):
    """Error weights of the state: the seat's. Returns 0: nothing can be wrong between the parameters."""
    m = words.view(MEMORY)[0]
    seat.set_weights(m.weight)
    m.n = seat.INSIDE
    return 0


@kernel
def start(words):
    """First loads."""
    m = words.view(MEMORY)[0]
    seat.take_inputs(m.q, m)
    seat.begin(seat.PLANAR, react, report, m)


@kernel
def integrate(m, work, span):
    """Advance the state by `span` (s)."""
    return seat.integrate(seat.PLANAR, rhs, observe, m, work, span)


@kernel
def advance(words, work, time, step):
    """One macro step."""
    m = words.view(MEMORY)[0]
    return seat.advance(seat.PLANAR, seat.any_time, react, integrate, report, words, m, work, time, step)


MODEL = Model(
    name="rubber",
    title="Rubber ring",
    about="Linear stiffness and damping between journal and housing",
    parameters=Parameters,
    inputs=seat.BearingInputs,
    outputs=Outputs,
    hidden=Hidden,
    memory=MEMORY,
    derive=derive,
    start=start,
    advance=advance,
)
