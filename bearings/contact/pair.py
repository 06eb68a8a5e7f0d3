"""Two bodies that touch in one point: what they do to each other there.

Both forces act in one point of space, so what one body loses in linear and angular momentum the other
gains. Every contact of a journal, a ball, a ring or a cage is this one; they differ in where the point
lies (`Place`) and in which side of the surface the first body is on.
"""

from __future__ import annotations

from typing import NamedTuple

from touchdown.bearings.contact.friction import coefficient
from touchdown.bearings.contact.laws import normal_and_elastic
from touchdown.modelkit.kernel import kernel, woven

INSIDE = 1.0  # the first body lies in a hollow of the second: it presses outwards
OUTSIDE = -1.0  # the first body lies on the second


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
    rate: float  # m/s, of the indentation
    loss: float  # W, heat


@woven
def slip(first, second, place, side):
    """(Sliding speed along t, rate of the indentation) in m/s of two bodies (Motion) at `place` (m).

    side: INSIDE or OUTSIDE.
    """
    ux, uy = first.vx - second.vx, first.vy - second.vy
    sliding = uy * place.nx - ux * place.ny + first.spin * place.first - second.spin * place.second
    return sliding, side * (ux * place.nx + uy * place.ny + second.spin * place.across)


@woven
def friction_force(sliding, mu, normal, grip):
    """Friction (N) along t: the law's, -mu N (2.39), but no more than stops the sliding within a step.

    A contact whose sliding speed v answers a tangential force with the acceleration w (1/kg) is stopped
    in h seconds by |v|/(h w); `grip` is h w (s/kg). What an explicit step would take past zero sticks
    instead, however steep the law; where the step resolves it, the law holds. With grip = 0 it always does.
    """
    force = -mu * normal
    return force if grip * abs(force) <= abs(sliding) else -sliding / grip


@kernel
def press(first, second, place, side, law, friction, grip):
    """Contact of two bodies (Motion) at `place`, for an indentation above zero.

    side: INSIDE or OUTSIDE; law, friction: records; grip (s/kg): as for `friction_force`. Returns a `Press`
    (N, N m, m/s, W).
    """
    sliding, rate = slip(first, second, place, side)
    normal, elastic = normal_and_elastic(place.indentation, rate, law)
    tangential = friction_force(sliding, coefficient(sliding, friction), normal, grip)
    along = -side * normal
    return Press(
        along * place.nx - tangential * place.ny,
        along * place.ny + tangential * place.nx,
        place.first * tangential,
        place.across * along - place.second * tangential,
        normal,
        tangential,
        rate,
        (normal - elastic) * rate - tangential * sliding,
    )
