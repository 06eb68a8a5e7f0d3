"""Active magnetic bearing: it levitates the journal until it is shut down.

A proportional-derivative law about the stator's centre plus the load it found at the start, so that a
rotor that starts at rest in the centre floats there. The load comes from the seat itself: what the
rotor would accelerate at without it, times its mass. The force is limited in each direction. From the
shutdown on, also within a macro step, there is none.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from bearings import seat
from modelkit import dopri
from modelkit.kernel import kernel
from modelkit.model import Model, memory_layout
from modelkit.ports import Interface, Load, MountReaction, SeatReaction
from modelkit.status import OK
from modelkit.variables import group, integer, real

SUPPLIED = seat.INSIDE
ROUNDING = 1e-12  # s; a remainder of a macro step that only rounding leaves


@dataclass(frozen=True)
class Parameters:
    """Stiff enough to hold a small rotor, soft beside the touchdown bearing."""

    stiffness: float = real(2e5, "N/m", "stiffness of the control", minimum=0.0)
    damping: float = real(400.0, "N.s/m", "damping of the control", minimum=0.0)
    force_limit: float = real(1000.0, "N", "largest force in each direction", above=0.0)
    shutdown_time: float = real(0.005, "s", "time of the shutdown")
    interface: Interface = group(Interface)


@dataclass(frozen=True)
class Outputs:
    """Loads, and whether there will be any."""

    journal: SeatReaction = group(SeatReaction)
    housing: MountReaction = group(MountReaction)
    active: int = integer(1, "0 once it is shut down and gives no force any more")
    supplied: float = real(0.0, "J", "work of the control on the rotor since the start", local=True)
    load_x: float = real(0.0, "N", "static load found at the start", constant=True)
    load_y: float = real(0.0, "N", "static load found at the start", constant=True)


@dataclass(frozen=True)
class Hidden:
    """Memory between steps."""

    seat: seat.SeatMemory = group(seat.SeatMemory)
    span: float = real(0.0, "s", "how long it still acts in this macro step; negative: not at all")


MEMORY = memory_layout(Parameters, seat.BearingInputs, Outputs, SUPPLIED + 1, hidden=Hidden)


@kernel
def _limited(force, limit):
    return min(max(force, -limit), limit)


@kernel
def react(t, y, dy, m):
    """Load of the control, zero after the shutdown."""
    p = m.p
    if t > m.s.span:
        dy[SUPPLIED] = 0.0
        return Load(0.0, 0.0, 0.0, 0.0, 0.0)
    ex, ey = y[seat.JX] - y[seat.HX], y[seat.JY] - y[seat.HY]
    ux, uy = y[seat.JVX] - y[seat.HVX], y[seat.JVY] - y[seat.HVY]
    fx = _limited(m.o.load_x - p.stiffness * ex - p.damping * ux, p.force_limit)
    fy = _limited(m.o.load_y - p.stiffness * ey - p.damping * uy, p.force_limit)
    dy[SUPPLIED] = fx * ux + fy * uy
    return Load(fx, fy, 0.0, -fx, -fy)


@kernel
def rhs(t, y, dy, m):
    """Everything the bearing integrates within a macro step."""
    seat.copy_rates(t, y, dy, m, m.half, react(t, y, dy, m))


@kernel
def observe(t, y, m):
    """Nothing to watch."""


@kernel
def report(y, m):
    """Work supplied, and whether it is over: no load left in the last macro step, nor to come."""
    m.o.supplied = y[SUPPLIED]
    m.o.active = 0 if m.s.span < 0.0 else 1


@kernel
def start(words):
    """Find the static load that the seat reports."""
    m = words.view(MEMORY)[0]
    seat.take_inputs(m.y, m)
    j = m.u.journal
    if j.inv_m > 0.0:
        m.o.load_x = -j.ax_free / j.inv_m
        m.o.load_y = -j.ay_free / j.inv_m
    seat.begin(react, report, m)


@kernel
def _integrate_for(m, work, span):
    tolerance = m.p.interface.tolerance
    return dopri.integrate(rhs, observe, m, m.y, m.n, m.weight, work, span, m.h, tolerance)


@kernel
def integrate(m, work, step):
    """Advance the state by `step` (s): with load up to the shutdown, then free."""
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
def instant(t, y, dy, m):
    """Derivative and load under the motion m.u at time t (s)."""
    m.s.span = 1.0 if t < m.p.shutdown_time else -1.0
    seat.instant(react, 0.0, y, dy, m)


@kernel
def advance(words, work, time, step):
    """One macro step."""
    m = words.view(MEMORY)[0]
    left = m.p.shutdown_time - time
    m.s.span = -1.0 if left <= ROUNDING else min(left, step)
    return seat.advance(react, integrate, report, m, work, time, step)


def weights(p: Parameters) -> np.ndarray:
    """Error weights of the state."""
    return seat.weights([0.0])


MODEL = Model(
    name="amb",
    title="Active magnetic bearing",
    about="Magnetic bearing with proportional-derivative control, shut down at a chosen time",
    parameters=Parameters,
    inputs=seat.BearingInputs,
    outputs=Outputs,
    hidden=Hidden,
    memory=MEMORY,
    start=start,
    advance=advance,
    weights=weights,
    instant=instant,
    starts_from={
        "load_x": ("journal.ax_free", "journal.inv_m"),
        "load_y": ("journal.ay_free", "journal.inv_m"),
    },
)
