"""Two bodies that touch in one point: what they do to each other there.

Both forces act in one point of space, so what one body loses in linear and angular momentum the other
gains. Every contact of a journal, a ball, a ring or a cage is this one; they differ in where the point
lies (`Place`) and in which side of the surface the first body is on.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from touchdown.bearings.contact.friction import curve
from touchdown.bearings.contact.kick import Kick, damped_normal, force_on, friction_line
from touchdown.bearings.contact.laws import elastic_and_damping
from touchdown.bearings.contact.passivity import passive
from touchdown.modelkit.kernel import kernel, woven

INSIDE = 1.0  # the first body lies in a hollow of the second: it presses outwards
OUTSIDE = -1.0  # the first body lies on the second

PLENTY = math.inf  # J; a contact that keeps no account can afford what its law asks for


class Place(NamedTuple):
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


@woven
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
    elastic, damping = elastic_and_damping(place.indentation, law)
    scale = place.indentation / (law.exponent + 1.0)
    elastic = passive(elastic, scale, stored, rate, kick.rate, kick.along, kick.beat)
    normal = damped_normal(elastic, damping, rate, kick.along, kick.rate)
    return Squeeze(sliding, rate, normal, normal - elastic)


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


@woven
def heat(press, sliding, rate):
    """Heat (W) of a `Press` over a kick that changes its sliding speed and its rate by so much (m/s).

    The mean force does its work at the mean speed: to the kinetic energy of the bodies this is exact.
    """
    return press.damped * (press.rate + 0.5 * rate) - press.tangential * (press.sliding + 0.5 * sliding)


@kernel
def press(first, second, place, side, law, friction, kick):
    """Contact of two bodies (Motion) at `place`, for an indentation above zero, over a `Kick`.

    Friction is the law's, -mu N (2.39).
    side: INSIDE or OUTSIDE; law, friction: records. Returns a `Press` (N, N m, m/s).
    """
    squeezed = squeeze(first, second, place, side, law, kick, PLENTY)
    expected = squeezed.sliding + kick.sliding
    line = friction_line(squeezed.sliding, expected, kick.across, squeezed.normal, curve(friction))
    return rubbed(place, side, squeezed, force_on(line, kick.across, kick.sliding))
