"""Two bodies that touch in one point: normal force and friction, at an instant and over a kick.

Every contact of a journal, a ball, a ring or a cage is of this kind. Contacts differ in where the point
lies (`ContactPlace`) and in which side of the surface the first body is on. Both forces act in one point,
so what one body loses in linear and angular momentum the other gains.

A kick of the leapfrog method changes the velocities of light bodies over h seconds, their places held.
Friction and damping answer to that change within the kick: on a ball of half a gram friction does so within
0.1 us. So both are taken implicitly, with the mean of the force over the kick. A contact's relative speed
goes from s to s + ds with

    ds = e + w f        e: by all other forces        w = h J M^-1 J': the answer to its own force f

and the force is a line through its value at the speed s0 where the kick is expected to end
(`friction_line`):

    f = F(s0) + F'(s0) (s + theta ds - s0)        theta = (3 + z)/(6 + z)        z = -w F'(s0)

A linear law then decays by (6 - 2 z)/(6 + 4 z + z^2), the Pade approximant of exp(-z) that Radau IIA has:
of third order, and no step reverses a motion for long, however stiff the law (L-stable). With h = 0 all of
this is the law as it stands, at an instant.

Hairer, Wanner, Solving Ordinary Differential Equations II, 2nd ed., section IV.5.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from ...modelkit.kernel import inlined, kernel
from .friction import curve, height_and_slope, rises
from .laws import elastic_and_damping
from .passivity import NO_BEAT, Beat, passive


class Kick(NamedTuple):
    """Surroundings of a contact's own forces over a kick; all zero: none, the laws as they stand."""

    beat: Beat
    across: float  # s/kg, answer of the sliding speed to friction
    along: float  # s/kg, answer of the approach to the normal force
    sliding: float  # m/s, change of the sliding speed by all other forces
    rate: float  # m/s, change of the indentation's rate by all other forces


NO_KICK = Kick(NO_BEAT, 0.0, 0.0, 0.0, 0.0)


class ForceLine(NamedTuple):
    """Mean force over a kick, for a change ds of the relative speed: (start - slope ds)/base.

    Left as a fraction, as whoever solves for ds divides anyway.
    """

    start: float  # N
    slope: float  # N s/m
    base: float


NO_LINE = ForceLine(0.0, 0.0, 6.0)  # of a contact that does not press


@inlined
def force_on(line, across, sliding):
    """The force (N) of a contact alone, from its `ForceLine`; across (s/kg), sliding (m/s): as `Kick`."""
    return (line.start - line.slope * sliding) / (line.base + line.slope * across)


@inlined
def damped_normal(elastic, damping, rate, along, others):
    """Mean normal force (N) over a kick, never below zero, of a contact that approaches at `rate` (m/s).

    elastic: N; damping: N s/m; along (s/kg) and others (m/s): as `Kick.along` and `Kick.rate`.
    """
    z = along * damping
    force = (6.0 + z) * (elastic + damping * rate) + (3.0 + z) * damping * others
    return max(force / (6.0 + z * (4.0 + z)), 0.0)


@inlined
def steepest(law):
    """Slope (s/m) of a `Curve` at rest."""
    return (law.dynamic + law.extra) * law.slope + law.g1 * (law.g2 - law.g3) + law.g6


@inlined
def spot(expected, answer, normal, law):
    """The speed (m/s) where a kick is expected to end under friction that rises linearly to its peak.

    expected: after the kick, without friction (m/s); answer: as `Kick.across`; law: a `Curve`.
    """
    reach, size = answer * normal, abs(expected)
    bound = law.dynamic + law.extra + 0.75 * law.g1  # of the curve without its viscous part, close to it
    end = max(size / (1.0 + reach * steepest(law)), size - reach * bound)
    return end if expected >= 0.0 else -end


@inlined
def line_at(speed, risen, sliding, answer, normal, law):
    """Friction of a contact under the force `normal` (N) over a kick, as a `ForceLine`.

    speed: the kick's `spot` (m/s); risen: `Rises` there; sliding: speed before the kick (m/s).
    """
    mu, slope = height_and_slope(speed, risen, law)
    slope *= normal
    z = answer * slope
    return ForceLine((6.0 + z) * (slope * (speed - sliding) - normal * mu), (3.0 + z) * slope, 6.0 + z)


@inlined
def friction_line(sliding, expected, answer, normal, law):
    """`line_at` a kick's own `spot`, for a contact alone."""
    speed = spot(expected, answer, normal, law)
    return line_at(speed, rises(speed, law), sliding, answer, normal, law)


INSIDE = 1.0  # the first body lies in a hollow of the second: it presses outwards
OUTSIDE = -1.0  # the first body lies on the second

UNLIMITED_ENERGY = math.inf  # J; a contact that keeps no account can afford what its law asks for


class ContactPlace(NamedTuple):
    """Where two bodies touch. n points from the second body's centre, or its hollow's, to the first.

    `first` and `second` are the distances along n of the point of contact from the centres of both
    bodies, `across` the distance from the second one's along t = (-n_y, n_x): zero where its surface is
    a circle around its centre.
    """

    nx: float
    ny: float
    indentation: float  # m; negative: the gap
    first: float  # m
    second: float  # m
    across: float  # m


class Press(NamedTuple):
    """Force on the first body, moments on both about their centres, and what to know of the contact."""

    fx: float  # N; on the second body it is the opposite
    fy: float
    first_moment: float  # N m
    second_moment: float
    normal: float  # N
    tangential: float  # N, on the first body along t
    sliding: float  # m/s, of the first body over the second along t, before the kick
    rate: float  # m/s, of the indentation, before the kick
    damped: float  # N, what of the normal force is damping


@inlined
def slip(first, second, place, side):
    """(Sliding speed along t, rate of the indentation) in m/s of two bodies (Motion) at `place` (m).

    side: INSIDE or OUTSIDE.
    """
    ux, uy = first.vx - second.vx, first.vy - second.vy
    sliding = uy * place.nx - ux * place.ny + first.spin * place.first - second.spin * place.second
    return sliding, side * (ux * place.nx + uy * place.ny + second.spin * place.across)


@kernel
def kick_of(beat, answers, first, second, place, side, last):
    """The `Kick` of a `Beat` at `place`, for bodies whose accelerations are about those of the kick before.

    answers: of the sliding speed and of the approach (1/kg) to the contact's own forces; first, second:
    Motion with accelerations (m/s2, rad/s2) for velocities; last: (friction, normal force) (N) of the kick
    before.
    """
    h = beat.kick
    across, along = h * answers[0], h * answers[1]
    sliding, rate = slip(first, second, place, side)
    return Kick(beat, across, along, h * sliding - across * last[0], h * rate + along * last[1])


class Squeeze(NamedTuple):
    """Two bodies pressed together at a place, before friction."""

    sliding: float  # m/s, of the first body over the second along t, before the kick
    rate: float  # m/s, of the indentation, before the kick
    normal: float  # N
    damped: float  # N, what of it is damping


@kernel
def squeeze(first, second, place, side, law, kick, stored):
    """`Squeeze` of two bodies (Motion) at `place`; law: a record; kick: a `Kick`.

    stored: energy in the contact's account (J).
    """
    sliding, rate = slip(first, second, place, side)
    normal, damped = normal_over(place.indentation, rate, law, kick, stored)
    return Squeeze(sliding, rate, normal, damped)


@kernel
def normal_over(indentation, rate, law, kick, stored):
    """(Normal force, what of it is damping) (N) over a `kick` of a contact that closes at a `rate` (m/s).

    indentation: m; law: a record; stored: energy in the contact's account (J).
    """
    elastic, damping = elastic_and_damping(indentation, law)
    scale = indentation / (law.exponent + 1.0)
    elastic = passive(elastic, scale, stored, rate, kick.rate, kick.along, kick.beat)
    normal = damped_normal(elastic, damping, rate, kick.along, kick.rate)
    return normal, normal - elastic


@kernel
def rubbed(place, side, squeezed, tangential):
    """The `Press` of bodies that are `squeezed` and rub with a force `tangential` (N)."""
    along = -side * squeezed.normal
    return Press(
        along * place.nx - tangential * place.ny,
        along * place.ny + tangential * place.nx,
        place.first * tangential,
        place.across * along - place.second * tangential,
        squeezed.normal,
        tangential,
        squeezed.sliding,
        squeezed.rate,
        squeezed.damped,
    )


@inlined
def contact_heat(press, sliding, rate):
    """Heat (W) of a `Press` over a kick that changes its sliding speed and its rate by so much (m/s).

    The mean force does its work at the mean speed: to the kinetic energy of the bodies this is exact.
    """
    return press.damped * (press.rate + 0.5 * rate) - press.tangential * (press.sliding + 0.5 * sliding)


@kernel
def contact_in_kick(first, second, place, side, law, friction, kick):
    """Contact of two bodies (Motion) at `place`, for an indentation above zero, over a `Kick`.

    Friction is the law's, -mu N (2.39).
    side: INSIDE or OUTSIDE; law, friction: records. Returns a `Press` (N, N m, m/s).
    """
    squeezed = squeeze(first, second, place, side, law, kick, UNLIMITED_ENERGY)
    expected = squeezed.sliding + kick.sliding
    line = friction_line(squeezed.sliding, expected, kick.across, squeezed.normal, curve(friction))
    return rubbed(place, side, squeezed, force_on(line, kick.across, kick.sliding))
