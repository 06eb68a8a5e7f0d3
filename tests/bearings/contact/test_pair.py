"""Two bodies in contact: momentum, energy and frame, over a kick and at one instant; many balls at once."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
import pytest
from contact_law import stated_force
from friction_records import prepared

from touchdown.bearings.contact import pair as pairs
from touchdown.bearings.contact.friction import COULOMB, MAKKAR, STRIBECK, FrictionLaw, coefficient
from touchdown.bearings.contact.laws import ContactLaw, elastic_force
from touchdown.bearings.contact.passivity import Beat
from touchdown.bearings.rolling.ball_bodies import (
    Balls,
    Contacts,
    Forces,
    KickBefore,
    Race,
    RacePlaces,
    press_circle,
    press_curve,
    pressing,
    with_friction,
)
from touchdown.bearings.rolling.ball_set import MAX_BALLS
from touchdown.bearings.rolling.balls import Total
from touchdown.bearings.rolling.ring import rounded_lanes
from touchdown.modelkit.ports import Motion
from touchdown.modelkit.variables import as_record, layout

BALL = 3.2e-3  # m
SIDES = {"inside": pairs.INSIDE, "outside": pairs.OUTSIDE}
FRICTIONS = {
    name: prepared(FrictionLaw(kind=kind))
    for name, kind in {"Coulomb": COULOMB, "Stribeck": STRIBECK, "Makkar": MAKKAR}.items()
}
LAWS = {
    "Hertz": as_record(ContactLaw()),
    "damped": as_record(ContactLaw(damping=1e7)),
    "rotor-ring": as_record(ContactLaw(exponent=10 / 9, dissipation=0.12)),
    "linear": as_record(ContactLaw(exponent=1.0, stiffness=1e8, viscous=150.0)),
}
every_side = pytest.mark.parametrize("side", SIDES.values(), ids=SIDES)
every_law = pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)
every_friction = pytest.mark.parametrize("friction", FRICTIONS.values(), ids=FRICTIONS)
LENGTHS = {"still": 0.0, "0.1us": 1e-7, "2.5us": 2.5e-6, "100us": 1e-4}  # s
every_kick = pytest.mark.parametrize("h", LENGTHS.values(), ids=LENGTHS)


class Pair(NamedTuple):
    """Two bodies and where they touch."""

    first: Motion
    second: Motion
    place: pairs.ContactPlace


def random_pair(rng: np.random.Generator, side: float) -> Pair:
    """Bodies anywhere, moving and spinning; the second one's surface is not a circle around its centre."""
    angle = rng.uniform(-math.pi, math.pi)
    n = np.array([math.cos(angle), math.sin(angle)])
    t = np.array([-n[1], n[0]])
    depth = 10.0 ** rng.uniform(-6.5, -4.0)
    place = pairs.ContactPlace(*n, depth, side * BALL, rng.uniform(5e-3, 25e-3), rng.normal(0.0, 1e-3))
    second = rng.normal(0.0, 1e-2, 2)
    first = second + place.second * n + place.across * t - place.first * n
    return Pair(
        Motion(*first, *rng.normal(0.0, 0.1, 2), rng.normal(0.0, 900.0)),
        Motion(*second, *rng.normal(0.0, 0.1, 2), rng.normal(0.0, 300.0)),
        place,
    )


def pressed(
    pair: Pair, side: float, law: Any, friction: Any, kick: pairs.Kick = pairs.NO_KICK
) -> pairs.Press:
    """The contact of a pair."""
    return pairs.Press(*pairs.contact_in_kick(*pair, side, law, friction, kick))


@every_side
@every_friction
def test_force_is_normal_and_friction(side, friction):
    """At an instant: the normal law along n, pressing apart, and the friction law against the sliding."""
    rng = np.random.default_rng(3)
    law = LAWS["damped"]
    for _ in range(50):
        pair = random_pair(rng, side)
        first, second, place = pair
        found = pressed(pair, side, law, friction)
        n, t = np.array([place.nx, place.ny]), np.array([-place.ny, place.nx])
        point = np.array([first.x, first.y]) + place.first * n

        def velocity(body: Motion, point=point) -> np.ndarray:
            return np.array(body[2:4]) + body.spin * np.array([body.y - point[1], point[0] - body.x])

        relative = velocity(first) - velocity(second)
        normal = stated_force(place.indentation, side * (relative @ n), law)
        mu = coefficient(relative @ t, friction)
        force = np.array([found.fx, found.fy])
        assert found.normal == pytest.approx(normal, rel=1e-11)
        assert found.rate == pytest.approx(side * (relative @ n), rel=1e-11, abs=1e-14)
        assert force @ n == pytest.approx(-side * normal, rel=1e-11)
        assert force @ t == pytest.approx(-mu * normal, rel=1e-9, abs=1e-14 * normal)
        assert found.tangential == pytest.approx(force @ t, rel=1e-9, abs=1e-14 * normal)


class Free(NamedTuple):
    """Two bodies: mass (kg), moment of inertia (kg m2), and what else acts on them (N, N m)."""

    mass: np.ndarray
    inertia: np.ndarray
    others: np.ndarray  # (2, 3)


def random_free(rng: np.random.Generator) -> Free:
    """Bodies about as light as a ball and a ring, under forces as of other contacts."""
    others = rng.normal(0.0, 1.0, (2, 3)) * [30.0, 30.0, 0.1]
    return Free(10.0 ** rng.uniform(-3.5, -2.0, 2), 10.0 ** rng.uniform(-9.0, -6.0, 2), others)


def on_both(place: pairs.ContactPlace, side: float, tangential: float, normal: float) -> np.ndarray:
    """(2, 3) forces and moments of a contact on both bodies, worked out by hand."""
    n, t = np.array([place.nx, place.ny]), np.array([-place.ny, place.nx])
    force = -side * normal * n + tangential * t
    moments = place.first * tangential, -place.second * tangential - side * normal * place.across
    return np.array([[*force, moments[0]], [*-force, moments[1]]])


def accelerations(free: Free, pushes: np.ndarray) -> list[Motion]:
    """Of both bodies under `pushes` (2, 3), in the places of the velocities."""
    return [
        Motion(0.0, 0.0, *push[:2] / m, push[2] / i)
        for push, m, i in zip(pushes, free.mass, free.inertia, strict=True)
    ]


def after(bodies: tuple[Motion, Motion], rates: list[Motion], h: float) -> list[Motion]:
    """Both bodies, their places held, after h (s) of these accelerations."""
    return [
        Motion(b.x, b.y, b.vx + h * a.vx, b.vy + h * a.vy, b.spin + h * a.spin)
        for b, a in zip(bodies, rates, strict=True)
    ]


def answers_of(free: Free, place: pairs.ContactPlace) -> tuple[float, float]:
    """1/kg, of the sliding speed and of the approach, where the second surface is a circle."""
    both = float(np.sum(1.0 / free.mass))
    levers = np.array([place.first, place.second])
    return both + float(np.sum(levers**2 / free.inertia)), both


@every_side
def test_a_kick_is_what_all_other_forces_do(side):
    """From accelerations, what the contact's own forces did in them is taken out again."""
    rng = np.random.default_rng(10)
    for _ in range(50):
        pair, free, h = random_pair(rng, side), random_free(rng), 10.0 ** rng.uniform(-7.0, -4.0)
        place = pair.place._replace(across=0.0)
        last = float(rng.normal(0.0, 50.0)), float(rng.uniform(0.0, 500.0))
        together = accelerations(free, free.others + on_both(place, side, *last))
        answers = answers_of(free, place)
        found = pairs.Kick(*pairs.kick_of(Beat(h, 0.0), answers, *together, place, side, last))
        sliding, rate = pairs.slip(*accelerations(free, free.others), place, side)
        assert found.across == pytest.approx(h * answers[0], rel=1e-14)
        assert found.along == pytest.approx(h * answers[1], rel=1e-14)
        assert found.sliding == pytest.approx(h * sliding, abs=1e-12 * (abs(found.across * last[0]) + h))
        assert found.rate == pytest.approx(h * rate, abs=1e-12 * (abs(found.along * last[1]) + h))


@every_side
@every_law
@every_friction
@pytest.mark.parametrize("h", list(LENGTHS.values())[1:], ids=list(LENGTHS)[1:])
def test_heat_of_a_kick(side, law, friction, h):
    """Free bodies lose to the contact, over a kick, what it stores and heats; friction rubs as it slides.

    The contact's forces are means over the kick: their work is that at the mean velocities.
    """
    rng = np.random.default_rng(4)
    for _ in range(20):
        pair, free = random_pair(rng, side), random_free(rng)
        place = pair.place
        others = pairs.slip(*accelerations(free, free.others), place, side)
        answers = answers_of(free, place)
        kick = pairs.Kick(Beat(h, 0.0), h * answers[0], h * answers[1], h * others[0], h * others[1])
        found = pressed(pair, side, law, friction, kick)
        contact = on_both(place, side, found.tangential, found.normal)
        bodies, rates = (pair.first, pair.second), accelerations(free, free.others + contact)
        changes = [h * each for each in pairs.slip(*rates, place, side)]
        middle = after(bodies, rates, 0.5 * h)
        work = [push @ [b.vx, b.vy, b.spin] for push, b in zip(contact, middle, strict=True)]
        storing = elastic_force(place.indentation, law) * pairs.slip(*middle, place, side)[1]
        scale = float(np.sum(np.abs(work))) + abs(storing)
        assert sum(work) == pytest.approx(
            -(storing + pairs.contact_heat(found, *changes)), abs=1e-11 * scale
        )


class Bunch(NamedTuple):
    """Balls around a race, the race's motion, how all of them accelerate, and where they touch."""

    balls: Balls
    ring: Motion
    race: Race
    rates: Balls  # m/s2, rad/s2 for velocities
    ring_rates: Motion
    contacts: Any
    last: np.ndarray  # N, normal forces of the kick before


MASS, INERTIA = 0.45e-3, 1.8e-9  # kg, kg m2, of a ball


def empty_contacts() -> Any:
    """Contacts to be written to; past the last ball lies what may not matter."""
    contacts = np.zeros(1, dtype=layout(Contacts))[0]
    for name in Contacts.__dataclass_fields__:
        if name != "shape":  # of a rigid race: zero
            contacts[name][:] = math.nan
    contacts["stored"][:] = pairs.UNLIMITED_ENERGY
    return contacts


def random_bunch(rng: np.random.Generator, side: float, count: int, damping: float) -> Bunch:
    """Most balls pressed, some apart; the arrays have room behind the last ball, with nothing in it.

    The outer race (`INSIDE` which the balls lie) keeps its velocity.
    """
    radius = 18.7e-3 if side == pairs.INSIDE else 12.3e-3
    ring = Motion(*rng.normal(0.0, 1e-3, 2), *rng.normal(0.0, 0.1, 2), rng.normal(0.0, 300.0))
    angles = rng.uniform(-math.pi, math.pi, count)
    out = radius - side * (BALL - rng.uniform(-10e-6, 40e-6, count))
    room = np.full((10, 2 * MAX_BALLS), math.nan)
    room[0, :count], room[1, :count] = ring.x + out * np.cos(angles), ring.y + out * np.sin(angles)
    room[2:4, :count] = rng.normal(0.0, 0.1, (2, count))
    room[4, :count] = rng.normal(0.0, 900.0, count)
    room[5:7, :count] = 0.0
    room[7:9, :count] = rng.normal(0.0, 5e3, (2, count))
    room[9, :count] = rng.normal(0.0, 1e6, count)
    balls, rates = (Balls(*(row[:count] for row in rows), BALL) for rows in (room[:5], room[5:]))
    moved = 0.0 if side == pairs.INSIDE else 1.0
    ring_rates = Motion(0.0, 0.0, *(moved * rng.normal(0.0, 1e3, 2)), moved * rng.normal(0.0, 1e5))
    last = rng.uniform(0.0, 500.0, count)
    return Bunch(
        balls, ring, Race(side, radius, 1.3e10, damping), rates, ring_rates, empty_contacts(), last
    )


def place_of(bunch: Bunch, b: int) -> pairs.ContactPlace:
    """Place of ball `b` as it is in the contacts."""
    c = bunch.contacts
    parts = (c[name][b] for name in ("nx", "ny", "indentation"))
    return pairs.ContactPlace(*parts, bunch.race.side * BALL, c["second"][b], c["across"][b])


def squeeze_all(bunch: Bunch, h: float, across: np.ndarray | None) -> None:
    """All balls pressed on a circle over a kick of h (s), or on a curve askew by `across` (m)."""
    balls, c, rates, at = bunch.balls, bunch.contacts, bunch.rates, bunch.ring_rates
    count, n = len(balls.x), rounded_lanes(len(balls.x))
    places = RacePlaces(*(c[name][:n] for name in RacePlaces._fields))
    shape = c["shape"]
    pressing = (c[name][:n] for name in Forces._fields[:-2])
    forces = Forces(*pressing, shape["rate"][:n], shape["faster"][:n])
    before = KickBefore(Beat(h, 0.5 * h), rates.vx, rates.vy, h * at.vx, h * at.vy, h / MASS)
    c["normal"][:count] = bunch.last
    press_circle(balls, bunch.ring, bunch.race, before, places, forces)
    if across is not None:
        c["across"][:count] = across
        c["normal"][:count] = bunch.last
        press_curve(balls, bunch.ring, bunch.race, before, places, forces)


def kick_alone(bunch: Bunch, b: int, h: float) -> pairs.Kick:
    """What ball `b` of a bunch meets at its race over a kick of h (s)."""
    rates = Motion(*(part[b] for part in bunch.rates[:5]))
    answers = 1.0 / MASS + BALL * BALL / INERTIA, 1.0 / MASS
    last = 0.0, bunch.last[b]
    return pairs.Kick(
        *pairs.kick_of(
            Beat(h, 0.0), answers, rates, bunch.ring_rates, place_of(bunch, b), bunch.race.side, last
        )
    )


def one_of(bunch: Bunch, b: int, h: float, law: Any, friction: Any) -> pairs.Press:
    """Ball `b` of a bunch as a pair with its race, over a kick of h (s)."""
    ball = Motion(*(part[b] for part in bunch.balls[:5]))
    pair = Pair(ball, bunch.ring, place_of(bunch, b))
    return pressed(pair, bunch.race.side, law, friction, kick_alone(bunch, b, h))


@every_side
@every_kick
@pytest.mark.parametrize(("damping", "askew"), [(0.0, 1e-4), (1e7, 0.0)], ids=["curve", "circle"])
def test_many_balls_are_many_pairs(side, h, damping, askew):
    """All balls of a race at once are pressed as each is alone; `test_friction` has what rubs."""
    rng = np.random.default_rng(8)
    law = as_record(ContactLaw(stiffness=1.3e10, damping=damping))
    friction, apart = prepared(FrictionLaw(static=0.0, dynamic=0.0, g6=0.0)), 0
    for count in (1, 9, 16, 17, 32):
        bunch = random_bunch(rng, side, count, damping)
        if askew:  # the balls do not follow how their race would then turn into them
            bunch = bunch._replace(ring_rates=bunch.ring_rates._replace(spin=0.0))
        squeeze_all(bunch, h, rng.normal(0.0, askew, count) if askew else None)
        bunch.contacts["tangential"][:count] = bunch.contacts["loss"][:count] = 0.0
        c, sums, size = bunch.contacts, np.zeros(4), 0.0
        total = Total(*with_friction(pressing(c, side, count), c, count))
        for b in range(count):
            place, found = place_of(bunch, b), one_of(bunch, b, h, law, friction)
            for name in ("normal", "damped", "sliding", "rate"):
                one = getattr(found, name)
                assert c[name][b] == pytest.approx(one, rel=1e-10, abs=1e-12 * (1.0 + found.normal))
            assert c["stiffness"][b] == pytest.approx(1.95e10 * max(place.indentation, 0.0) ** 0.5)
            sums += [-found.fx, -found.fy, found.second_moment, 0.0]
            size += found.normal
            apart += place.indentation < 0.0
            assert (found.normal > 0.0) <= (place.indentation > 0.0)
        np.testing.assert_allclose(total, sums, rtol=1e-10, atol=1e-12 * size)
    assert apart > 5


@every_side
def test_places_on_a_circle(side):
    """The race's circle is met on the line of centres, by as much as the ball reaches over it."""
    rng = np.random.default_rng(9)
    bunch = random_bunch(rng, side, 32, 0.0)
    squeeze_all(bunch, 0.0, None)
    ring, race = bunch.ring, bunch.race
    for b in range(32):
        place = place_of(bunch, b)
        dx, dy = bunch.balls.x[b] - ring.x, bunch.balls.y[b] - ring.y
        distance = math.hypot(dx, dy)
        assert (place.nx, place.ny) == pytest.approx((dx / distance, dy / distance), rel=1e-14)
        assert place.second == pytest.approx(distance + side * BALL, rel=1e-14)
        assert place.indentation == pytest.approx(side * (place.second - race.radius), abs=1e-17)
        assert place.across == 0.0
