"""All balls of a bearing against one race.

The same contact as `bearings.contact.pair.press`, for all balls at once: the loops below are vector code
(`bearings.rolling.ball_state`) and make up most of a detailed bearing's cost. Where a race is no circle,
the contact is searched for.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

from touchdown.bearings.contact.friction import curve, follow
from touchdown.bearings.contact.laws import hertz
from touchdown.bearings.contact.pair import Place, friction_force, slip
from touchdown.bearings.contact.search import Disc, Outline, race_place
from touchdown.bearings.rolling.ball_state import rounded
from touchdown.bearings.rolling.balls import MOST_BALLS, Total
from touchdown.modelkit.kernel import inlined, kernel
from touchdown.modelkit.ports import Motion
from touchdown.modelkit.variables import array


@dataclass(frozen=True)
class Contacts:
    """One contact of each ball, at the last evaluation; places as in `bearings.contact.pair.Place`."""

    nx: tuple = array(MOST_BALLS)
    ny: tuple = array(MOST_BALLS)
    indentation: tuple = array(MOST_BALLS)
    second: tuple = array(MOST_BALLS)
    across: tuple = array(MOST_BALLS)
    fx: tuple = array(MOST_BALLS)  # on the ball
    fy: tuple = array(MOST_BALLS)
    moment: tuple = array(MOST_BALLS)  # on the race
    normal: tuple = array(MOST_BALLS)
    tangential: tuple = array(MOST_BALLS)
    stiffness: tuple = array(MOST_BALLS)
    loss: tuple = array(MOST_BALLS)


class Balls(NamedTuple):
    """States of all balls, an array each, and their radius."""

    x: object  # m
    y: object
    vx: object  # m/s
    vy: object
    spin: object  # rad/s
    radius: float  # m


class Race(NamedTuple):
    """What a race is for its balls: on which side of it they lie, its radius, law and grip."""

    side: float
    radius: float  # m
    stiffness: float  # N/m^1.5
    damping: float  # N s/m2
    grip: float  # s/kg


class Places(NamedTuple):
    """Where all balls touch a race, an array each; a ball's own distance is its radius."""

    nx: object
    ny: object
    indentation: object  # m
    second: object  # m
    across: object  # m


class Forces(NamedTuple):
    """What a race does to all balls, an array each."""

    fx: object  # N, on the ball
    fy: object
    moment: object  # N m, on the race
    normal: object  # N
    tangential: object  # N
    stiffness: object  # N/m, at this load
    loss: object  # W, heat


@inlined
def places_of(contacts, n):
    """`Places` (n,) as views of `contacts` (Contacts)."""
    c = contacts
    return Places(c.nx[:n], c.ny[:n], c.indentation[:n], c.second[:n], c.across[:n])


@inlined
def forces_of(contacts, n):
    """`Forces` (n,) as views of `contacts` (Contacts)."""
    c = contacts
    pressed = c.fx[:n], c.fy[:n], c.moment[:n], c.normal[:n], c.tangential[:n]
    return Forces(*pressed, c.stiffness[:n], c.loss[:n])


@kernel
def find_on_circle(balls, ring, race, places):
    """Set the `places` (n,) (m) of all `balls` on a circular race around `ring` (Motion)."""
    reach = race.side * balls.radius
    for b in range(len(places.nx)):
        dx, dy = balls.x[b] - ring.x, balls.y[b] - ring.y
        distance = math.sqrt(dx * dx + dy * dy)
        inverse = 1.0 / distance
        places.nx[b] = dx * inverse
        places.ny[b] = dy * inverse
        places.indentation[b] = race.side * (distance + reach - race.radius)
        places.second[b] = distance + reach
        places.across[b] = 0.0


@kernel
def find_on_curve(balls, ring, angle, race, profile, starts, search, contacts):
    """Set the places (m) of all `balls` on a race with a profile, turned by `angle` (rad), in `contacts`.

    starts, search: as `bearings.contact.search.race_place` keeps them.
    """
    outline, c = Outline(ring.x, ring.y, angle, race.radius), contacts
    for b in range(len(balls.x)):
        ball = Disc(balls.x[b], balls.y[b], balls.radius)
        at = race_place(b, race.side, ball, outline, profile, starts, search)
        c.nx[b], c.ny[b], c.indentation[b] = at.nx, at.ny, at.indentation
        c.second[b], c.across[b] = at.second, at.across


@kernel
def _press_all(balls, ring, race, friction, places, forces):
    """Set the `forces` (n,) (N, N m, N/m, W) on all `balls` at their `places` (n,); friction: a `Curve`."""
    reach = race.side * balls.radius
    for b in range(len(places.nx)):
        ball = Motion(balls.x[b], balls.y[b], balls.vx[b], balls.vy[b], balls.spin[b])
        nx, ny, indentation = places.nx[b], places.ny[b], places.indentation[b]
        place = Place(nx, ny, indentation, reach, places.second[b], places.across[b])
        sliding, rate = slip(ball, ring, place, race.side)
        normal, elastic, stiff = hertz(place.indentation, rate, race.stiffness, race.damping)
        mu, _ = follow(sliding, friction)
        tangential = friction_force(sliding, mu, normal, race.grip)
        along = -race.side * normal
        forces.fx[b] = along * place.nx - tangential * place.ny
        forces.fy[b] = along * place.ny + tangential * place.nx
        forces.moment[b] = place.across * along - place.second * tangential
        forces.normal[b] = normal
        forces.tangential[b] = tangential
        forces.stiffness[b] = stiff
        forces.loss[b] = (normal - elastic) * rate - tangential * sliding


@kernel
def press_race(balls, ring, race, friction, contacts):
    """Forces of all `balls` on a race around `ring` (Motion), from the places in `contacts`, kept there.

    friction: a record. Returns the `Total` (N, N m, W) on the race.
    """
    n = rounded(len(balls.x))
    _press_all(balls, ring, race, curve(friction), places_of(contacts, n), forces_of(contacts, n))
    fx, fy, moment, loss = 0.0, 0.0, 0.0, 0.0
    for b in range(len(balls.x)):
        fx -= contacts.fx[b]
        fy -= contacts.fy[b]
        moment += contacts.moment[b]
        loss += contacts.loss[b]
    return Total(fx, fy, moment, loss)
