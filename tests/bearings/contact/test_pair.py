"""Two bodies in contact: momentum, energy and frame, how far friction may go, and many balls at once."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
import pytest

from touchdown.bearings.contact.friction import (
    COULOMB,
    MAKKAR,
    STRIBECK,
    FrictionLaw,
    coefficient,
    prepared,
)
from touchdown.bearings.contact.laws import ContactLaw, elastic_energy, normal_force
from touchdown.bearings.contact.pair import INSIDE, OUTSIDE, Place, Press, friction_force, press, slip
from touchdown.bearings.rolling.balls import MOST_BALLS, Total
from touchdown.bearings.rolling.bodies.race import (
    Balls,
    Contacts,
    Places,
    Race,
    find_on_circle,
    press_race,
)
from touchdown.modelkit.ports import Motion
from touchdown.modelkit.variables import as_record, layout

BALL = 3.2e-3  # m
SIDES = {"inside": INSIDE, "outside": OUTSIDE}
FRICTIONS = {
    name: as_record(prepared(FrictionLaw(kind=kind)))
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
every_grip = pytest.mark.parametrize("grip", [0.0, 1e-6, 1e-2], ids=["free", "some", "firm"])


class Pair(NamedTuple):
    """Two bodies and where they touch."""

    first: Motion
    second: Motion
    place: Place


def random_pair(rng: np.random.Generator, side: float) -> Pair:
    """Bodies anywhere, moving and spinning; the second one's surface is not a circle around its centre."""
    angle = rng.uniform(-math.pi, math.pi)
    n = np.array([math.cos(angle), math.sin(angle)])
    t = np.array([-n[1], n[0]])
    depth = 10.0 ** rng.uniform(-6.5, -4.0)
    place = Place(*n, depth, side * BALL, rng.uniform(5e-3, 25e-3), rng.normal(0.0, 1e-3))
    second = rng.normal(0.0, 1e-2, 2)
    first = second + place.second * n + place.across * t - place.first * n
    return Pair(
        Motion(*first, *rng.normal(0.0, 0.1, 2), rng.normal(0.0, 900.0)),
        Motion(*second, *rng.normal(0.0, 0.1, 2), rng.normal(0.0, 300.0)),
        place,
    )


def pressed(pair: Pair, side: float, law: Any, friction: Any, grip: float) -> Press:
    """The contact of a pair."""
    return Press(*press(*pair, side, law, friction, grip))


@every_side
@every_law
@every_friction
@every_grip
def test_action_and_reaction(side, law, friction, grip):
    """Opposite forces at one point: no moment is left about any point of the plane."""
    rng = np.random.default_rng(1)
    for _ in range(20):
        pair = random_pair(rng, side)
        found = pressed(pair, side, law, friction, grip)
        about = rng.normal(0.0, 0.1, 2)
        total = found.first_moment + found.second_moment
        for body, sign in ((pair.first, 1.0), (pair.second, -1.0)):
            total += sign * ((body.x - about[0]) * found.fy - (body.y - about[1]) * found.fx)
        assert total == pytest.approx(0.0, abs=1e-15 * math.hypot(found.fx, found.fy))


@every_side
def test_force_acts_where_the_place_says(side):
    """The moments on both bodies are those of the force at the point of contact, normal part included."""
    rng = np.random.default_rng(2)
    for _ in range(50):
        pair = random_pair(rng, side)
        found = pressed(pair, side, LAWS["damped"], FRICTIONS["Makkar"], 0.0)
        n = np.array(pair.place[:2])
        point = np.array(pair.first[:2]) + pair.place.first * n
        size = math.hypot(found.fx, found.fy)
        for body, sign, moment in (
            (pair.first, 1.0, found.first_moment),
            (pair.second, -1.0, found.second_moment),
        ):
            arm = point - np.array(body[:2])
            expected = sign * (arm[0] * found.fy - arm[1] * found.fx)
            assert moment == pytest.approx(expected, rel=1e-9, abs=1e-16 * size)


@every_side
@every_friction
def test_force_is_normal_and_friction(side, friction):
    """Without grip: the normal law along n, pressing apart, and the friction law against the sliding."""
    rng = np.random.default_rng(3)
    law = LAWS["damped"]
    for _ in range(50):
        pair = random_pair(rng, side)
        first, second, place = pair
        found = pressed(pair, side, law, friction, 0.0)
        n, t = np.array([place.nx, place.ny]), np.array([-place.ny, place.nx])
        point = np.array([first.x, first.y]) + place.first * n

        def velocity(body: Motion, point=point) -> np.ndarray:
            return np.array(body[2:4]) + body.spin * np.array([body.y - point[1], point[0] - body.x])

        relative = velocity(first) - velocity(second)
        normal = normal_force(place.indentation, side * (relative @ n), law)
        mu = coefficient(relative @ t, friction)
        force = np.array([found.fx, found.fy])
        assert found.normal == pytest.approx(normal, rel=1e-11)
        assert found.rate == pytest.approx(side * (relative @ n), rel=1e-11, abs=1e-14)
        assert force @ n == pytest.approx(-side * normal, rel=1e-11)
        assert force @ t == pytest.approx(-mu * normal, rel=1e-9, abs=1e-14 * normal)
        assert found.tangential == pytest.approx(force @ t, rel=1e-9, abs=1e-14 * normal)


@every_side
@every_law
@every_friction
@every_grip
def test_power_balance(side, law, friction, grip):
    """Power on both bodies is what the contact stores and heats, taken away; and it only heats."""
    rng = np.random.default_rng(4)
    for _ in range(20):
        pair = random_pair(rng, side)
        found = pressed(pair, side, law, friction, grip)
        first, second, place = pair
        on_first = found.fx * first.vx + found.fy * first.vy + found.first_moment * first.spin
        on_second = -found.fx * second.vx - found.fy * second.vy + found.second_moment * second.spin
        step = 1e-4 * place.indentation
        lower, upper = (elastic_energy(place.indentation + d, law) for d in (-step, step))
        storing = (upper - lower) / (2.0 * step) * found.rate
        scale = abs(storing) + abs(found.loss) + abs(on_first) + abs(on_second)
        assert on_first + on_second == pytest.approx(-(storing + found.loss), abs=1e-8 * scale)
        assert found.loss >= -1e-12 * scale


def turned(body: Motion, angle: float) -> Motion:
    """The same motion in a frame turned by -angle."""
    c, s = math.cos(angle), math.sin(angle)
    return Motion(
        c * body.x - s * body.y, s * body.x + c * body.y,
        c * body.vx - s * body.vy, s * body.vx + c * body.vy, body.spin,
    )  # fmt: skip


@every_side
@every_law
@every_friction
@every_grip
def test_turning_the_frame_changes_nothing(side, law, friction, grip):
    """Forces turn with the frame; moments, speeds and heat stay."""
    rng = np.random.default_rng(5)
    for _ in range(10):
        pair, angle = random_pair(rng, side), rng.uniform(-math.pi, math.pi)
        c, s = math.cos(angle), math.sin(angle)
        nx, ny = pair.place[:2]
        place = pair.place._replace(nx=c * nx - s * ny, ny=s * nx + c * ny)
        there = pressed(
            Pair(turned(pair.first, angle), turned(pair.second, angle), place), side, law, friction, grip
        )
        here = pressed(pair, side, law, friction, grip)
        force = [c * here.fx - s * here.fy, s * here.fx + c * here.fy]
        np.testing.assert_allclose(there[:2], force, rtol=0, atol=1e-11 * here.normal)
        np.testing.assert_allclose(there[2:], here[2:], rtol=1e-10, atol=1e-13 * here.normal)


@every_side
def test_moving_frame_changes_nothing(side):
    """A common velocity of both bodies is none of the contact's business."""
    rng = np.random.default_rng(6)
    for _ in range(50):
        pair = random_pair(rng, side)
        first, second = (b._replace(vx=b.vx + 0.3, vy=b.vy - 0.7) for b in pair[:2])
        here = pressed(pair, side, LAWS["damped"], FRICTIONS["Makkar"], 0.0)
        there = pressed(Pair(first, second, pair.place), side, LAWS["damped"], FRICTIONS["Makkar"], 0.0)
        np.testing.assert_allclose(there, here, rtol=1e-10, atol=1e-12 * here.normal)


SPEEDS = [sign * 10.0**e for e in np.arange(-9.0, 2.1, 0.25) for sign in (1.0, -1.0)]  # m/s
STEEPNESS = 10.0 ** np.arange(-2.0, 4.1, 0.5)  # h w mu'(0) N


@every_friction
def test_friction_stops_but_never_reverses(friction):
    """A step's friction takes sliding no further than to rest, however steep the law and hard the load.

    Where the law as it stands would not overshoot, it is the law.
    """
    grip = 1e-4
    origin = coefficient(1e-9, friction) / 1e-9
    kept, stopped = 0, 0
    for steepness in STEEPNESS:
        normal = steepness / (origin * grip)
        for speed in SPEEDS:
            mu = coefficient(speed, friction)
            force = friction_force(speed, mu, normal, grip)
            after = speed + grip * force
            assert after * speed >= -1e-15 * speed**2
            assert abs(after) < abs(speed)
            assert abs(force) <= abs(mu * normal)
            if abs(mu) * normal * grip <= abs(speed):
                assert force == -mu * normal
                kept += 1
            else:
                assert after == pytest.approx(0.0, abs=1e-15 * abs(speed))
                stopped += 1
    assert kept > 100
    assert stopped > 100


@every_friction
def test_without_grip_the_law_holds(friction):
    """No step, no limit, at rest too."""
    for speed in (*SPEEDS, 0.0):
        mu = coefficient(speed, friction)
        assert friction_force(speed, mu, 1e5, 0.0) == -mu * 1e5
    assert friction_force(0.0, 0.0, 1e5, 1e-3) == 0.0


@every_side
@every_friction
@pytest.mark.parametrize("step", [1e-7, 1e-5, 1e-3])
def test_bodies_that_slide_come_to_rest_together(side, friction, step):
    """Free bodies under their contact's friction alone slide on in the same sense, or no more.

    The sliding speed answers a tangential force with 1/m and arm^2/I of both bodies.
    """
    rng = np.random.default_rng(7)
    stopped = 0
    for _ in range(50):
        pair = random_pair(rng, side)
        first, second, place = pair
        (m1, m2), (i1, i2) = rng.uniform(1e-3, 0.1, 2), rng.uniform(1e-8, 1e-5, 2)
        answer = 1.0 / m1 + 1.0 / m2 + place.first**2 / i1 + place.second**2 / i2
        found = pressed(pair, side, LAWS["Hertz"], friction, step * answer)
        pull = step * found.tangential
        tx, ty = -place.ny, place.nx
        one = first._replace(
            vx=first.vx + pull * tx / m1, vy=first.vy + pull * ty / m1,
            spin=first.spin + place.first * pull / i1,
        )  # fmt: skip
        two = second._replace(
            vx=second.vx - pull * tx / m2, vy=second.vy - pull * ty / m2,
            spin=second.spin - place.second * pull / i2,
        )  # fmt: skip
        before, after = slip(first, second, place, side)[0], slip(one, two, place, side)[0]
        scale = abs(before) + abs(first.spin * place.first) + abs(second.spin * place.second)
        assert after / before <= 1.0
        assert after * math.copysign(1.0, before) >= -1e-13 * scale
        stopped += abs(after) < 1e-13 * scale
    assert stopped > 10 or step < 1e-3


class Bunch(NamedTuple):
    """Balls around a race, the race's motion, and where they touch it."""

    balls: Balls
    ring: Motion
    race: Race
    contacts: Any


def empty_contacts() -> Any:
    """Contacts to be written to; past the last ball lies what may not matter."""
    contacts = np.zeros(1, dtype=layout(Contacts))[0]
    for name in Contacts.__dataclass_fields__:
        contacts[name][:] = math.nan
    return contacts


def random_bunch(rng: np.random.Generator, side: float, count: int, grip: float, damping: float) -> Bunch:
    """Most balls pressed, some apart; the arrays have room behind the last ball, with nothing in it."""
    radius = 18.7e-3 if side == INSIDE else 12.3e-3
    ring = Motion(*rng.normal(0.0, 1e-3, 2), *rng.normal(0.0, 0.1, 2), rng.normal(0.0, 300.0))
    angles = rng.uniform(-math.pi, math.pi, count)
    out = radius - side * (BALL - rng.uniform(-10e-6, 40e-6, count))
    room = np.full((5, 2 * MOST_BALLS), math.nan)
    room[0, :count], room[1, :count] = ring.x + out * np.cos(angles), ring.y + out * np.sin(angles)
    room[2:4, :count] = rng.normal(0.0, 0.1, (2, count))
    room[4, :count] = rng.normal(0.0, 900.0, count)
    balls = Balls(*(row[:count] for row in room), BALL)
    return Bunch(balls, ring, Race(side, radius, 1.3e10, damping, grip), empty_contacts())


def place_of(bunch: Bunch, b: int) -> Place:
    """Place of ball `b` as it is in the contacts."""
    c = bunch.contacts
    parts = (c[name][b] for name in ("nx", "ny", "indentation"))
    return Place(*parts, bunch.race.side * BALL, c["second"][b], c["across"][b])


def press_all(bunch: Bunch, friction: Any, across: np.ndarray | None = None) -> Total:
    """All balls on a circle, whose surface is askew where `across` says so."""
    count, c = len(bunch.balls.x), bunch.contacts
    places = Places(*(c[name][:count] for name in Places._fields))
    find_on_circle(bunch.balls, bunch.ring, bunch.race, places)
    if across is not None:
        c["across"][:count] = across
    return Total(*press_race(bunch.balls, bunch.ring, bunch.race, friction, c))


@every_side
@every_friction
@every_grip
@pytest.mark.parametrize("damping", [0.0, 1e7])
def test_many_balls_are_many_pairs(side, friction, grip, damping):
    """All balls of a race at once get what each gets alone, whatever their number."""
    rng = np.random.default_rng(8)
    law = as_record(ContactLaw(stiffness=1.3e10, damping=damping))
    apart = 0
    for count in (1, 3, 9, 15, 16, 17, 19, 32):
        bunch = random_bunch(rng, side, count, grip, damping)
        total = press_all(bunch, friction, rng.normal(0.0, 1e-4, count))
        c, sums, size = bunch.contacts, np.zeros(4), 0.0
        for b in range(count):
            ball = Motion(*(component[b] for component in bunch.balls[:5]))
            place = place_of(bunch, b)
            found = pressed(Pair(ball, bunch.ring, place), side, law, friction, grip)
            many = [c[name][b] for name in ("fx", "fy", "moment", "normal", "tangential", "loss")]
            one = [
                found.fx, found.fy, found.second_moment, found.normal, found.tangential, found.loss
            ]  # fmt: skip
            np.testing.assert_allclose(many, one, rtol=1e-12, atol=1e-14 * found.normal)
            assert c["stiffness"][b] == pytest.approx(1.95e10 * max(place.indentation, 0.0) ** 0.5)
            sums += [-found.fx, -found.fy, found.second_moment, found.loss]
            size += found.normal
            apart += place.indentation < 0.0
            assert (found.normal > 0.0) <= (place.indentation > 0.0)
        np.testing.assert_allclose(total, sums, rtol=1e-12, atol=1e-14 * size)
    assert apart > 5


@every_side
def test_places_on_a_circle(side):
    """The race's circle is met on the line of centres, by as much as the ball reaches over it."""
    rng = np.random.default_rng(9)
    bunch = random_bunch(rng, side, 32, 0.0, 0.0)
    press_all(bunch, FRICTIONS["Makkar"])
    ring, race = bunch.ring, bunch.race
    for b in range(32):
        place = place_of(bunch, b)
        dx, dy = bunch.balls.x[b] - ring.x, bunch.balls.y[b] - ring.y
        distance = math.hypot(dx, dy)
        assert (place.nx, place.ny) == pytest.approx((dx / distance, dy / distance), rel=1e-14)
        assert place.second == pytest.approx(distance + side * BALL, rel=1e-14)
        assert place.indentation == pytest.approx(side * (place.second - race.radius), abs=1e-17)
        assert place.across == 0.0
