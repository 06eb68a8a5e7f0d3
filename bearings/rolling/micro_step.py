"""How a bearing steps whose light bodies hit stiff contacts: leapfrog, resolving every hit.

What depends on velocity acts over the kick that follows an evaluation, implicitly
(`bearings.contact.pair`): m.s.kick is its length, zero where the laws are to act as they stand, and
m.s.before the accelerations of the kick before.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

from ...modelkit.integrators import verlet
from ...modelkit.kernel import inlined, kernel
from ...modelkit.numerics import squared
from ...modelkit.variables import array, group, real
from .. import seat
from ..contact.passivity import Beat
from ..heat import shares
from ..heat.shares import Sources
from . import ring
from .ring import MAX_STATES

COPIES = (seat.JVX, seat.JVY, seat.JW, seat.HVX, seat.HVY)  # their velocities
MICRO_STEP = 2.5e-6  # s, the default
RESOLUTION = 0.8  # rad of the fastest contact, at most a step, at the default
BENDING_RESOLUTION = 0.25  # of the fastest mode of a ring: contacts on it are faster, and bound the step
STATIC_BENDING = 0.15  # likewise, where balls are springs: of the ring, only its compliance counts
HIT_RESOLUTION = 0.2  # of the duration of a hit, at most a step, at the default


@dataclass(frozen=True)
class Brake:
    """Loads on the copies that make heat, in the kick at hand."""

    jx: float = real(0.0, "N", "on the journal")
    jy: float = real(0.0, "N", "on the journal")
    jm: float = real(0.0, "N.m", "on the journal")
    hx: float = real(0.0, "N", "on the housing: friction of the balls")
    hy: float = real(0.0, "N", "on the housing: friction of the balls")


@dataclass(frozen=True)
class Kicks:
    """Memory of the kicks of any bearing."""

    kick: float = real(0.0, "s", "length of the kick; 0: none, the laws as they stand")
    drift: float = real(0.0, "s", "half of the drift that follows it; 0: the span ends")
    lately: float = real(0.0, "rad/s", "frequency of the fastest contact of late")
    withheld: float = real(0.0, "J", "what contacts kept from the bodies so far, to be passive")


@dataclass(frozen=True)
class KickMemory(Kicks):
    """Memory of a kick in the plane."""

    rubbed: float = real(0.0, "N", "friction on the journal in the kick before")
    before: tuple = array(MAX_STATES)  # derivative of the state then
    brake: Brake = group(Brake)
    ahead: tuple = array(len(COPIES))  # m/s, by which the velocities of the copies are forecast; rad/s


@inlined
def forecast_kick(trial, dq, h, kick, m):
    """Velocities of the copies in `trial` at the end of a micro-step of h (s), before a `kick` (s).

    dq: derivative of the state at its beginning.
    """
    seat.forecast(trial, dq, h)
    note_kick(COPIES, dq, h, kick, m)


@inlined
def note_kick(velocities, dq, h, kick, m):
    """Note a `kick` (s) after a micro-step of h (s), and how far `velocities` (indices) are forecast."""
    for k, i in enumerate(velocities):
        m.s.ahead[k] = 0.5 * h * dq[i]
    m.s.kick, m.s.drift = kick, kick - 0.5 * h
    for i in range(m.s.seat.inside):  # assigned at once, numba would compare shapes and refuse in Python
        m.s.before[i] = dq[i]


@kernel
def record_work(dq, load, m):
    """Have the copies' work and heat in dq (W) be that of the middle of the kick.

    load: `Load` (N, N m). dq was found with velocities of the copies that were forecast by m.s.ahead; the
    middle of the kick lies half a kick under the accelerations now known from its beginning.
    """
    b, h, ahead = m.s.brake, 0.5 * m.s.kick, m.s.ahead
    jx, jy, jw = h * dq[seat.JVX] - ahead[0], h * dq[seat.JVY] - ahead[1], h * dq[seat.JW] - ahead[2]
    hx, hy = h * dq[seat.HVX] - ahead[3], h * dq[seat.HVY] - ahead[4]
    dq[seat.JE] += load.jx * jx + load.jy * jy + load.jm * jw
    dq[seat.HE] += load.hx * hx + load.hy * hy
    dq[ring.LOSS] -= b.jx * jx + b.jy * jy + b.jm * jw + b.hx * hx + b.hy * hy
    at_bore, at_outer = b.jx * jx + b.jy * jy + b.jm * jw, b.hx * hx + b.hy * hy
    shares.add_heat(Sources(-at_bore, 0.0, 0.0, -at_outer, 0.0), dq, ring.HEAT)


class MissedMotion(NamedTuple):
    """By how much a kick, and the copies in its middle, differ from what forces were found for."""

    part: float  # of the length they were found for
    jx: float  # m/s, journal
    jy: float
    hx: float  # housing
    hy: float


@kernel
def missed_motion(dq, kick, m):
    """`MissedMotion` in a `kick` (s) under dq, found for m.s.kick with copies forecast by m.s.ahead."""
    h, ahead = 0.5 * kick, m.s.ahead
    part = kick / m.s.kick if m.s.kick > 0.0 else 1.0
    jx, jy = h * dq[seat.JVX] - ahead[0], h * dq[seat.JVY] - ahead[1]
    return MissedMotion(part, jx, jy, h * dq[seat.HVX] - ahead[3], h * dq[seat.HVY] - ahead[4])


@kernel
def beat_of(m):
    """The `Beat` (s) at hand."""
    return Beat(m.s.kick, m.s.drift)


@kernel
def withhold(q, races, sides, bore, m):
    """Book what contacts withheld (J) as heat in the state q, and as what the steps cost.

    races: at the inner and at the outer one; sides: of the balls; bore: of the journal.
    """
    energy = races[0] + races[1] + sides + bore
    q[ring.LOSS] += energy
    m.s.withheld += energy
    shares.add_heat(Sources(bore, 0.0, races[0], races[1], sides), q, ring.HEAT)


@kernel
def leapfrog(rhs, drift, fastest, kicked, observe, m, work, span):
    """Advance m.q by `span` (s) in steps of at most m.d.micro_step and m.d.resolution.

    The kernels are those of `verlet.integrate`; `kicked` settles the contacts' accounts; work: rows of
    scratch as long as the state. Returns (micro-step to try next (s), status, evaluations).
    """
    m.s.ahead[:] = 0.0
    record_work(work[0], seat.last_load(m), m)
    return leapfrog_by(forecast_kick, rhs, drift, fastest, kicked, observe, m, work, span)


@kernel
def leapfrog_by(forecast, rhs, drift, fastest, kicked, observe, m, work, span):
    """`leapfrog` with a `forecast_kick` of the copies, whose work is booked up to the first kick."""
    steps = verlet.Steps(m.d.micro_step, m.d.resolution)
    status, evaluations, m.s.lately = verlet.integrate(
        rhs, drift, forecast, fastest, kicked, observe, m, m.q, m.n, work, span, steps, m.s.lately
    )
    m.s.kick = m.s.drift = 0.5 * verlet.step_length(m.s.lately, span, steps)  # if all stays so
    return m.h, status, evaluations


@kernel
def refined(longest):
    """Factor on steps that contacts shorten: 1, and less for a `longest` (s) below the default.

    So all error falls with the step that is asked for.
    """
    return min(longest / MICRO_STEP, 1.0)


@kernel
def fastest_bending(longest, resolution):
    """The highest frequency (rad/s) of a ring's modes in steps of `longest` (s); 0: adaptive, no limit.

    resolution: rad a step.
    """
    return resolution / longest if longest > 0.0 else math.inf


@kernel
def step_in_hit(longest, law, mass):
    """Longest step (s) that resolves a hit, for the `longest` (s) that is asked for.

    law: a record; mass (kg) of the lighter body. At the landing's speed v it must not fly past the contact:
    it gets ((n + 1)/2 m v^2/k)^(1/(n + 1)) deep and stays three times that over v.
    """
    power = 1.0 / (law.exponent + 1.0)
    depth = (0.5 * (law.exponent + 1.0) * mass * squared(seat.VELOCITY_SCALE) / law.stiffness) ** power
    return refined(longest) * HIT_RESOLUTION * 3.0 * depth / seat.VELOCITY_SCALE
