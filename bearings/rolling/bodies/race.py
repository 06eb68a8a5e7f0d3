"""All balls of a bearing against one race.

The same contact as `bearings.contact.pair.press`, for all balls at once: the loops below, and those of
`bearings.rolling.rubbing` for friction, are vector code (`bearings.rolling.ball_state`) and make up most of
a detailed bearing's cost. Where a race is no circle, the contact is searched for.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

from touchdown.bearings.contact.kick import damped_normal
from touchdown.bearings.contact.laws import hertz
from touchdown.bearings.contact.pair import Place, slip
from touchdown.bearings.contact.passivity import Beat, middle_of, passive, settled
from touchdown.bearings.contact.search import Disc, Outline, race_place
from touchdown.bearings.rolling.balls import MOST_BALLS, Total
from touchdown.bearings.rolling.rubbing import RubbedRace
from touchdown.modelkit.kernel import kernel, woven
from touchdown.modelkit.ports import Motion
from touchdown.modelkit.variables import array


@dataclass(frozen=True)
class Contacts(RubbedRace):
    """One contact of each ball, at the last evaluation; places as in `bearings.contact.pair.Place`."""

    nx: tuple = array(MOST_BALLS)
    ny: tuple = array(MOST_BALLS)
    indentation: tuple = array(MOST_BALLS)
    second: tuple = array(MOST_BALLS)
    across: tuple = array(MOST_BALLS)
    stiffness: tuple = array(MOST_BALLS)
    rate: tuple = array(MOST_BALLS)  # m/s, of the indentation, before the kick
    middle: tuple = array(MOST_BALLS)  # m/s, in the middle of the kick
    damped: tuple = array(MOST_BALLS)  # N, what of the normal force is damping
    stored: tuple = array(MOST_BALLS)  # J, as `bearings.contact.passivity`


class Balls(NamedTuple):
    """States of all balls, an array each, and their radius."""

    x: object  # m
    y: object
    vx: object  # m/s
    vy: object
    spin: object  # rad/s
    radius: float  # m


class Race(NamedTuple):
    """What a race is for its balls: on which side of it they lie, its radius and law."""

    side: float
    radius: float  # m
    stiffness: float  # N/m^1.5
    damping: float  # N s/m2


class Places(NamedTuple):
    """Where all balls touch a race, an array each; a ball's own distance is its radius."""

    nx: object
    ny: object
    indentation: object  # m
    second: object  # m
    across: object  # m


class Before(NamedTuple):
    """Changes of velocity over the kick before: of all balls, an array each, and of their race's centre."""

    beat: Beat
    ax: object  # m/s2, of the balls
    ay: object
    race_x: float  # m/s
    race_y: float
    answer: float  # s/kg, of a ball's speed to a force over the kick


class Forces(NamedTuple):
    """What presses a race and all balls, an array each; on entry, `normal` is that of the kick before."""

    normal: object  # N
    stiffness: object  # N/m, at this load
    damped: object  # N, what of it is damping
    sliding: object  # m/s, before the kick
    rate: object  # m/s, of the indentation, before the kick
    stored: object  # J, in their accounts


@kernel
def places_of(contacts, n):
    """`Places` (n,) as views of `contacts` (Contacts)."""
    c = contacts
    return Places(c.nx[:n], c.ny[:n], c.indentation[:n], c.second[:n], c.across[:n])


@kernel
def forces_of(contacts, n):
    """`Forces` (n,) as views of `contacts` (Contacts)."""
    c = contacts
    return Forces(c.normal[:n], c.stiffness[:n], c.damped[:n], c.sliding[:n], c.rate[:n], c.stored[:n])


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


class Squeezed(NamedTuple):
    """A ball pressed against a race, before friction."""

    normal: float  # N
    stiffness: float  # N/m
    damped: float  # N
    sliding: float  # m/s
    rate: float  # m/s


@woven
def _squeeze(b, balls, ring, place, race, before, last, stored):
    """Ball `b` at its `Place` on a race, `Squeezed`.

    last: its normal force (N) in the kick before; stored: energy in its account (J).
    """
    ball = Motion(balls.x[b], balls.y[b], balls.vx[b], balls.vy[b], balls.spin[b])
    sliding, rate = slip(ball, ring, place, race.side)
    elastic, damping, stiffness = hertz(place.indentation, race.stiffness, race.damping)
    faster_x = before.beat.kick * before.ax[b] - before.race_x
    faster_y = before.beat.kick * before.ay[b] - before.race_y
    others = race.side * (faster_x * place.nx + faster_y * place.ny) + before.answer * last
    elastic = passive(elastic, 0.4 * place.indentation, stored, rate, others, before.answer, before.beat)
    normal = damped_normal(elastic, damping, rate, before.answer, others)
    return Squeezed(normal, stiffness, normal - elastic, sliding, rate)


@woven
def press_circle(balls, ring, race, before, places, forces):
    """Set `places` (n,) (m) of all `balls` on a circular race around `ring` (Motion), and their `forces`.

    before: `Before`. Forces (n,) (N, N/m, m/s) are those of pressing, friction comes later.
    """
    reach = race.side * balls.radius
    for b in range(len(places.nx)):
        dx, dy = balls.x[b] - ring.x, balls.y[b] - ring.y
        distance = math.sqrt(dx * dx + dy * dy)
        inverse = 1.0 / distance
        second = distance + reach
        place = Place(dx * inverse, dy * inverse, race.side * (second - race.radius), reach, second, 0.0)
        pressed = _squeeze(b, balls, ring, place, race, before, forces.normal[b], forces.stored[b])
        places.nx[b], places.ny[b] = place.nx, place.ny
        places.indentation[b], places.second[b], places.across[b] = place.indentation, second, 0.0
        forces.normal[b], forces.stiffness[b] = pressed.normal, pressed.stiffness
        forces.damped[b], forces.sliding[b], forces.rate[b] = pressed.damped, pressed.sliding, pressed.rate


@woven
def press_curve(balls, ring, race, before, places, forces):
    """Set the `forces` (n,) of all `balls` on any race, whose `places` were found (`find_on_curve`).

    The rest as for `press_circle`.
    """
    reach, p = race.side * balls.radius, places
    for b in range(len(p.nx)):
        place = Place(p.nx[b], p.ny[b], p.indentation[b], reach, p.second[b], p.across[b])
        pressed = _squeeze(b, balls, ring, place, race, before, forces.normal[b], forces.stored[b])
        forces.normal[b], forces.stiffness[b] = pressed.normal, pressed.stiffness
        forces.damped[b], forces.sliding[b], forces.rate[b] = pressed.damped, pressed.sliding, pressed.rate


@woven
def pressing(contacts, side, count):
    """The `Total` (N, N m) of normal forces that `count` balls on that `side` of a race exert on it."""
    fx, fy, moment = 0.0, 0.0, 0.0
    for b in range(count):
        along = side * contacts.normal[b]
        fx += along * contacts.nx[b]
        fy += along * contacts.ny[b]
        moment -= along * contacts.across[b]
    return Total(fx, fy, moment, 0.0)


@woven
def with_friction(pressed, contacts, count):
    """`Total` (N, N m, W) on a race that is `pressed` (Total) and rubbed by `count` balls."""
    fx, fy, moment, loss = pressed.fx, pressed.fy, pressed.moment, 0.0
    for b in range(count):
        fx += contacts.tangential[b] * contacts.ny[b]
        fy -= contacts.tangential[b] * contacts.nx[b]
        moment -= contacts.tangential[b] * contacts.second[b]
        loss += contacts.loss[b]
    return Total(fx, fy, moment, loss)


@woven
def settle_race(contacts, side, count, kick, part, vx, vy):
    """Settle the accounts of `count` balls on that `side` of a race after a `kick` (s).

    part: of the kick in which the forces were found; vx, vy: by how much the race was faster in its middle
    than it was taken to be (m/s). Returns what the contacts withheld (J).
    """
    withheld, c = 0.0, contacts
    for b in range(count):
        if c.indentation[b] <= 0.0 and c.stored[b] <= 0.0:  # apart for longer
            continue
        closing = middle_of(c.rate[b], c.middle[b], part) - side * (vx * c.nx[b] + vy * c.ny[b])
        taken = kick * (c.normal[b] - c.damped[b]) * closing
        c.stored[b], lost = settled(c.stored[b], c.indentation[b], taken)
        withheld += lost
    return withheld
