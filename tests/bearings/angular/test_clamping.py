"""How hard a pair is clamped, at rest and at speed, beside closed forms."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import pytest

from tests.bearings.angular.test_in_a_bearing import BALLS, PAIR
from tests.bearings.angular.test_rings_and_orbits import jones
from touchdown.bearings.angular.clamping import Clamping, clamping
from touchdown.bearings.angular.hoop import LOOSE
from touchdown.bearings.contact.materials import SILICON_NITRIDE_DENSITY, STEEL_DENSITY, STEEL_NUMBERS
from touchdown.bearings.heat.growth import spin_growth
from touchdown.bearings.rolling.ball_set import inner_radius
from touchdown.modelkit.variables import as_record

SPIN = 3000.0  # rad/s
BORE = 10e-3  # m
(ROW, _) = PAIR.rows()
SIZES = {f"balls.{name}": value for name, value in vars(BALLS).items()}
SIZES |= {"balls.contact_angle": PAIR.contact_angle, "arrangement": PAIR.arrangement, "clearance": 0.1e-3}
SIZES |= {"row_distance": PAIR.distance, "journal_radius": BORE - 0.1e-3, "ring.width": 9e-3}


def clamped(*, thrown: bool = False, **settings: float) -> list[Clamping]:
    """At rest and at SPIN."""
    known = SIZES | {name.replace("__", "."): value for name, value in settings.items()}
    value: Any = lambda name, default: known.get(name, default)  # noqa: E731
    return clamping(value, thrown, (0.0, SPIN))


@pytest.mark.parametrize("hoop", [0, 1])
def test_at_rest_it_is_the_preload(hoop: int) -> None:
    """Also of rings that give under it; without growth and orbit nothing changes by spin."""
    rest, fast = clamped(preload=120.0, ring__hoop=hoop, outer_ring__seat=LOOSE)
    assert rest.preload == pytest.approx(120.0, rel=1e-6)
    assert fast == rest
    assert rest.ball == pytest.approx(120.0 / BALLS.count / math.sin(PAIR.contact_angle), rel=0.1)


def test_a_ring_that_grows_clamps_harder() -> None:
    """By the spring between groove centres that the growth takes apart."""
    race = float(inner_radius(as_record(BALLS)))
    grown = float(spin_growth(BORE, race, SPIN, STEEL_DENSITY, STEEL_NUMBERS).rim)
    _, fast = clamped(interference=4e-6, ring__growth=1)
    arc = abs(ROW.inner_at - ROW.outer_at)
    out, along = ROW.inner - ROW.outer + grown, arc - _approach() + 2e-6
    length = math.hypot(out, along)
    force = ROW.stiffness * (length - ROW.free) ** 1.5
    assert grown > 1e-7
    assert fast.preload == pytest.approx(BALLS.count * force * along / length, rel=1e-6)
    assert fast.interference == pytest.approx(2.0 * (along - math.sqrt(ROW.free**2 - out**2)), rel=1e-6)
    assert fast.interference > 4e-6
    gives = clamped(interference=4e-6, ring__growth=1, ring__hoop=1, outer_ring__seat=LOOSE)[1]
    assert 0.0 < gives.preload < fast.preload


def _approach() -> float:
    """Of the inner groove of PAIR by its own preload (m)."""
    return abs(ROW.inner_at - ROW.outer_at) - ROW.free * math.sin(PAIR.contact_angle)


def test_balls_that_are_thrown_are_in_balance_at_their_own_angles() -> None:
    """Rows stay in place; balls roll without spin on the outer race."""
    row, _ = replace(PAIR, preload=120.0).rows()
    mass = SILICON_NITRIDE_DENSITY * math.pi / 6.0 * BALLS.diameter**3
    angle = outer = PAIR.contact_angle
    force = 0.0
    for _ in range(20):
        across = 1.0 - BALLS.diameter / BALLS.pitch_diameter * math.cos(angle)
        orbit = SPIN * across / (1.0 + math.cos(angle - outer))
        angle, outer, force = jones(0.5 * mass * BALLS.pitch_diameter * orbit**2, row)
    thrown = clamped(preload=120.0, thrown=True)[1]
    assert thrown.ball == pytest.approx(force, rel=1e-5)
    assert thrown.preload == pytest.approx(BALLS.count * force * math.sin(outer), rel=1e-5)
    assert thrown.preload > 125.0
    assert math.degrees(angle - outer) > 2.0


def test_play_along_the_shaft_is_an_interference_below_zero() -> None:
    rest, _ = clamped(interference=-10e-6)
    assert rest.preload == 0.0
    assert rest.interference == pytest.approx(-10e-6, rel=1e-9)


def test_a_single_row_clamps_nothing() -> None:
    assert clamped(arrangement=0) == []
