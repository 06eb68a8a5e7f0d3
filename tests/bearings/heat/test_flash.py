"""Temperature of a contact that slides, against Blok's formula by hand and its limits."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import quad

from touchdown.bearings import simplified_caged
from touchdown.bearings.contact.materials import SILICON_NITRIDE, STEEL
from touchdown.bearings.heat.flash import SHAPE, Surface, contact_temperature, damage
from touchdown.modelkit.instance import Instance

STEEL_ENTERS = math.sqrt(46.0 * 7830.0 * 460.0)  # W s^0.5/(m2 K): 12.87e3
MADE, WIDTH = 1e5, 4e-4  # W/m, m


def steel(speed: float, warmth: float = 0.0) -> Surface:
    return Surface(speed, warmth, STEEL)


def test_the_shape_is_that_of_a_half_ellipse() -> None:
    """Strips of heat at s, each of which warms what comes behind it by 1/sqrt(pi (x - s))."""

    def warmth(x: float) -> float:  # with s = x - (1 + x) u^2, which has no pole
        course = lambda u: math.sqrt(max(1.0 - (x - (1.0 + x) * u * u) ** 2, 0.0))  # noqa: E731
        return 4.0 / math.pi**1.5 * math.sqrt(1.0 + x) * quad(course, 0.0, 1.0)[0]

    assert max(warmth(x) for x in np.linspace(0.6, 0.7, 101)) == pytest.approx(SHAPE, rel=1e-6)
    assert pytest.approx(1.11 / math.sqrt(2.0), rel=2e-3) == SHAPE  # as Blok rounds it


def test_both_surfaces_share_the_heat_by_hand() -> None:
    """1e5 W/m in a strip of 0.8 mm, over one surface at 36 m/s, over the other at 4 m/s: 38.15 K."""
    by_hand = 0.7859834 * 1e5 / (0.02 * (12872.0 * 6.0 + 12872.0 * 2.0))
    assert by_hand == pytest.approx(38.16, abs=0.01)
    assert contact_temperature(MADE, WIDTH, steel(36.0), steel(-4.0)) == pytest.approx(by_hand, rel=1e-4)
    warm = contact_temperature(MADE, WIDTH, steel(36.0, 100.0), steel(4.0, 20.0))
    assert warm == pytest.approx(by_hand + 0.75 * 100.0 + 0.25 * 20.0, rel=1e-4)


def test_a_surface_at_rest_takes_no_heat() -> None:
    alone = SHAPE * MADE / (STEEL_ENTERS * math.sqrt(WIDTH * 36.0))
    assert contact_temperature(MADE, WIDTH, steel(36.0, 10.0), steel(0.0, 500.0)) == pytest.approx(
        alone + 10.0
    )


@pytest.mark.parametrize("speed", [0.0, 20.0])
def test_surfaces_that_roll_are_as_warm_as_they_are(speed: float) -> None:
    both = contact_temperature(0.0, WIDTH, steel(speed, 30.0), steel(speed, 30.0))
    assert both == pytest.approx(30.0)


def test_ceramic_takes_less_and_steel_does_not_bear_all() -> None:
    """sqrt(25*3200*700) of silicon nitride is 0.58 of steel's."""
    hybrid = contact_temperature(MADE, WIDTH, steel(9.0), Surface(9.0, 0.0, SILICON_NITRIDE))
    both = contact_temperature(MADE, WIDTH, steel(9.0), steel(9.0))
    assert hybrid / both == pytest.approx(2.0 / 1.5814, rel=1e-3)
    assert damage(200.0) is None
    assert [(damage(t) or "").split()[3:] for t in (300.0, 800.0, 1300.0)] == [
        ["steel", "is", "tempered,", "and", "loses", "its", "hardness"],
        ["steel", "turns", "to", "austenite"],
        ["steel", "melts"],
    ]


@pytest.mark.parametrize("thermal", [0, 1])
def test_a_bearing_watches_its_bore(thermal: int) -> None:
    """A journal at 8.7 m/s, pressed into a ring at rest: the flash of its force, by hand."""
    made = Instance(simplified_caged.MODEL)
    p, motion = made.record["p"], made.record["u"]["journal"]
    p["thermal"], p["friction"]["kind"] = thermal, 0
    motion["y"], motion["omega"] = -float(p["clearance"]) - 20e-6, 900.0
    made.start(0.0)
    made.step(0.0, 1e-7)
    o, radius, clearance = made.record["o"], float(p["journal_radius"]), float(p["clearance"])
    press, sliding = float(o["contact"]["force"]) / float(p["contact"]["length"]), 900.0 * radius
    modulus = 207e9 / (2.0 * 0.91)
    half_width = math.sqrt(4.0 * press * radius * (radius + clearance) / clearance / (math.pi * modulus))
    flash = SHAPE * 0.1 * press * sliding / (STEEL_ENTERS * math.sqrt(half_width * sliding))
    assert flash > 10.0
    found = o["temperature"]["contact"], o["temperature"]["contact_time"]
    # the ring is pushed aside, so that the strip goes over its bore at some mm/s, and takes 2 % of the heat
    assert found == ((pytest.approx(flash, rel=0.03), pytest.approx(1e-7)) if thermal else (0.0, -1.0))
