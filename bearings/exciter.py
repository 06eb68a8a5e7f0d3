"""Exciter: a force on a rotor over time, as of a shaker or an impact hammer.

It attaches to a rotor's port as a bearing does, and touches nothing. The integral of its force over each
macro step is that of its course in closed form, so a rotor takes the impulse to rounding.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from ..modelkit.body import nothing_to_watch
from ..modelkit.excitation import (
    NEVER,
    ORDER_PROBLEM,
    PULSE,
    Course,
    course,
    course_integral,
    course_problem,
    next_change,
)
from ..modelkit.kernel import kernel
from ..modelkit.model import Model
from ..modelkit.ports import Interface, Load, PlanarMountReaction, PlanarSeatReaction
from ..modelkit.status import OK
from ..modelkit.variables import group, real
from . import seat

ROUNDING = 1e-12  # s; a remainder of a macro step that only rounding leaves


@dataclass(frozen=True)
class Parameters:
    """A hammer's blow, once it has a size."""

    force_x: float = real(0.0, "N", "size of a step, of each line, of a table", needs="course.form != 2")
    force_y: float = real(0.0, "N", "the same upwards", needs="course.form != 2")
    impulse_x: float = real(0.0, "N.s", "of the half sine", needs="course.form == 2")
    impulse_y: float = real(0.0, "N.s", "of the half sine, upwards", needs="course.form == 2")
    course: Course = group(Course, form=PULSE)
    interface: Interface = group(Interface)


@dataclass(frozen=True)
class Outputs:
    """Loads, and what was given."""

    journal: PlanarSeatReaction = group(PlanarSeatReaction)
    housing: PlanarMountReaction = group(PlanarMountReaction)
    supplied: float = real(0.0, "J", "work on rotor and housing since the start", local=True)
    given_x: float = real(0.0, "N.s", "impulse on the rotor since the start", local=True)
    given_y: float = real(0.0, "N.s", "impulse on the rotor since the start, upwards", local=True)


@dataclass(frozen=True)
class Hidden:
    """Memory between steps."""

    seat: seat.SeatMemory = group(seat.SeatMemory)
    done: float = real(0.0, "s", "of the macro step, ahead of what is being integrated")
    first: float = real(-NEVER, "s", "from the course's beginning: between its changes,")
    last: float = real(NEVER, "s", "where what is being integrated ends")


MEMORY = seat.bearing_memory(Parameters, Outputs, seat.INSIDE, hidden=Hidden)


@kernel
def sizes(p):
    """Of the force (N, N) where its course is 1."""
    if p.course.form != PULSE:
        return p.force_x, p.force_y
    peak = 0.5 * math.pi / p.course.width
    return peak * p.impulse_x, peak * p.impulse_y


@kernel
def react(t, q, dq, m):
    """`Load` (N), t (s) into what is being integrated; there is nothing inside."""
    since = m.time + m.s.done + t - m.p.course.begin
    share = course(min(max(since, m.s.first), m.s.last), m.p.course)
    x, y = sizes(m.p)
    return Load(share * x, share * y, 0.0, -share * x, -share * y)


@kernel
def rhs(t, q, dq, m):
    """Derivative dq (m.n,) of everything that is integrated, t (s) into what is being integrated."""
    seat.copy_rates(m.s.done + t, q, dq, m, m.half, react(t, q, dq, m))


@kernel
def report(q, m):
    """Impulse and work given up to the end of the macro step."""
    x, y = sizes(m.p)
    given = course_integral(m.time + 2.0 * m.half - m.p.course.begin, m.p.course)
    m.o.given_x, m.o.given_y = x * given, y * given
    m.o.supplied = m.o.journal.work + m.o.housing.work


@kernel
def integrate(m, work, step):
    """Advance m.q by `step` (s), from change to change of the course. As `seat.integrate`."""
    h, status, evaluations = m.h, OK, 0
    begun = m.time - m.p.course.begin
    while status == OK and step - m.s.done > ROUNDING:
        since = begun + m.s.done
        span = min(step - m.s.done, max(next_change(since + ROUNDING, m.p.course), ROUNDING))
        m.s.first, m.s.last = since + ROUNDING, since + span - ROUNDING  # on this side of changes
        m.h = h
        h, status, more = seat.integrate(seat.PLANAR, rhs, nothing_to_watch, m, work, span)
        evaluations += more
        m.s.done += span
    m.s.done, m.s.first, m.s.last = 0.0, -NEVER, NEVER
    x, y = sizes(m.p)
    given = course_integral(begun + step, m.p.course) - course_integral(begun, m.p.course)
    m.q[seat.JPX], m.q[seat.JPY] = x * given, y * given
    m.q[seat.HPX], m.q[seat.HPY] = -x * given, -y * given
    return h, status, evaluations


@kernel
def derive(words):
    """Error weights; returns 1 where points are not in order, else 0."""
    m = words.view(MEMORY)[0]
    seat.set_weights(m.weight)
    m.n = seat.INSIDE
    return 1 if course_problem(m.p.course, m.message_numbers) != 0 else 0


@kernel
def start(words):
    """Nothing inside; words: the memory, in 8-byte words."""
    m = words.view(MEMORY)[0]
    seat.take_inputs(m.q, m)
    seat.begin(seat.PLANAR, react, report, m)


@kernel
def instant(t, q, dq, words):
    """Derivative dq (m.n,) and load in m.o (N) at time t (s)."""
    m = words.view(MEMORY)[0]
    m.time = t
    seat.instant(seat.PLANAR, react, 0.0, q, dq, m)


@kernel
def advance(words, work, time, step):
    """One macro step of `step` (s) from `time` (s); returns a status."""
    m = words.view(MEMORY)[0]
    return seat.advance(seat.PLANAR, seat.any_time, react, integrate, report, words, m, work, time, step)


MODEL = Model(
    name="exciter",
    title="Exciter",
    about="Force on a rotor over time: step, half-sine impulse, multisine or table",
    parameters=Parameters,
    inputs=seat.BearingInputs,
    outputs=Outputs,
    hidden=Hidden,
    memory=MEMORY,
    derive=derive,
    start=start,
    advance=advance,
    problems=(f"course.{ORDER_PROBLEM}",),
    instant=instant,
)
