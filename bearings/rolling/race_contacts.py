"""All balls of a bearing against one race.

The same contact as `bearings.contact.pair.press`, for all balls at once: the loops below hold no branches
and no calls of the mathematical library, so that the compiler turns them into vector code. They make up
most of a detailed bearing's cost. Vector code takes `LANES` balls at a time and is slow on what is left
over, so the loops may run past the last ball (`rounded`); what lies there does not matter.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

from touchdown.bearings.contact.friction import curve, follow
from touchdown.bearings.contact.laws import hertz
from touchdown.bearings.contact.pair import Place, friction_force, slip
from touchdown.bearings.contact.search import race_place
from touchdown.bearings.rolling.balls import MOST_BALLS
from touchdown.modelkit.kernel import kernel
from touchdown.modelkit.ports import Motion
from touchdown.modelkit.variables import array

LANES = 16  # as compiled for 512 bit; half of it is in use at 256
SPARE = 2  # balls left over that are quicker alone than with company


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
    """States of all balls, one array each, and their radius."""

    x: object
    y: object
    vx: object
    vy: object
    spin: object
    radius: float


class Race(NamedTuple):
    """What a race is for `contacts`: which side balls lie on, its radius, law and grip."""

    side: float
    radius: float  # m
    stiffness: float  # N/m^1.5
    damping: float  # N s/m2
    grip: float  # s/kg


class Total(NamedTuple):
    """What all balls do to a race: force (N), moment about its centre (N m), heat (W)."""

    fx: float
    fy: float
    moment: float
    loss: float


@kernel
def rounded(count):
    """How many balls the loops run over for `count`; all arrays have room for `MOST_BALLS`."""
    left = count % LANES
    return count if left <= SPARE else count - left + LANES


@kernel
def find_on_circle(balls, ring, race, nx, ny, indentation, second, across):
    """Places of all balls on a circular race around `ring` (Motion)."""
    reach = race.side * balls.radius
    for b in range(len(nx)):
        dx, dy = balls.x[b] - ring.x, balls.y[b] - ring.y
        distance = math.sqrt(dx * dx + dy * dy)
        inverse = 1.0 / distance
        nx[b] = dx * inverse
        ny[b] = dy * inverse
        indentation[b] = race.side * (distance + reach - race.radius)
        second[b] = distance + reach
        across[b] = 0.0


@kernel
def find_on_curve(balls, ring, angle, race, profile, starts, search, s):
    """Places of all balls on a race with a profile, turned by `angle` (rad)."""
    for b in range(len(balls.x)):
        ball = (balls.x[b], balls.y[b], balls.radius)
        at = race_place(b, race.side, ball, (ring.x, ring.y, angle, race.radius), profile, starts, search)
        s.nx[b], s.ny[b], s.indentation[b] = at.nx, at.ny, at.indentation
        s.second[b], s.across[b] = at.second, at.across


@kernel
def _press_all(balls, ring, race, friction, nx, ny, indentation, second, across, out):
    """Forces of all balls at their places; friction: a `Curve`."""
    fx, fy, moment, normals, tangentials, stiffness, loss = out
    reach = race.side * balls.radius
    for b in range(len(nx)):
        ball = Motion(balls.x[b], balls.y[b], balls.vx[b], balls.vy[b], balls.spin[b])
        place = Place(nx[b], ny[b], indentation[b], reach, second[b], across[b])
        sliding, rate = slip(ball, ring, place, race.side)
        normal, elastic, stiff = hertz(place.indentation, rate, race.stiffness, race.damping)
        mu, _ = follow(sliding, friction)
        tangential = friction_force(sliding, mu, normal, race.grip)
        along = -race.side * normal
        fx[b] = along * place.nx - tangential * place.ny
        fy[b] = along * place.ny + tangential * place.nx
        moment[b] = place.across * along - place.second * tangential
        normals[b] = normal
        tangentials[b] = tangential
        stiffness[b] = stiff
        loss[b] = (normal - elastic) * rate - tangential * sliding


@kernel
def press_race(balls, ring, race, friction, s):
    """Forces of all balls on a race around `ring` (Motion), from the places in `s` (Contacts)."""
    n = rounded(len(balls.x))
    nx, ny, indentation, second, across = s.nx[:n], s.ny[:n], s.indentation[:n], s.second[:n], s.across[:n]
    forces = s.fx[:n], s.fy[:n], s.moment[:n], s.normal[:n], s.tangential[:n]
    out = (*forces, s.stiffness[:n], s.loss[:n])
    _press_all(balls, ring, race, curve(friction), nx, ny, indentation, second, across, out)
    fx, fy, moment, loss = 0.0, 0.0, 0.0, 0.0
    for b in range(len(balls.x)):
        fx -= s.fx[b]
        fy -= s.fy[b]
        moment += s.moment[b]
        loss += s.loss[b]
    return Total(fx, fy, moment, loss)
