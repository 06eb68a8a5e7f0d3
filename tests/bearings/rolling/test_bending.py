"""Rings that bend: closed forms, finite elements, sharing of loads, and the drop."""

from __future__ import annotations

import math

import numpy as np
import pytest

import touchdown
from tests.support.bearing_states import instance_of
from touchdown.bearings import catalogue
from touchdown.bearings.catalogue.load_sharing import RingSeat, ball_loads, inner_groove
from touchdown.bearings.rolling.bending import compliance, frequency, section_of
from touchdown.master.common.errors import TouchdownError
from touchdown.master.coupling.simulation import opened
from touchdown.modelkit.instance import Instance

MODULUS, POISSON, DENSITY = 207e9, 0.3, 7830.0
BEARINGS = {name: catalogue.bearing(name) for name in ("6904", "6004")}
LINE = {"bearing.contact.law": "line", "bearing.contact.damping": 1e9, "bearing.contact.load": 400.0}


@pytest.mark.parametrize(
    ("name", "elements", "given"),
    [
        ("6904", (12.88, 35.08, 64.06, 98.05), (19.348, 2.9066, 0.9008, 0.3890)),
        ("6004", (15.24, 40.81, 73.18, 110.1), (7.9364, 1.2292, 0.3947, 0.1768)),
    ],
)
def test_modes_of_real_sections(name: str, elements: tuple[float, ...], given: tuple[float, ...]) -> None:
    """2-D finite elements' kHz within 1.3 %; compliances (nm/N) of another program of the same beam."""
    section = section_of(inner_groove(BEARINGS[name]))
    for n, (kilohertz, nanometres) in enumerate(zip(elements, given, strict=True), start=2):
        found = frequency(section, n, MODULUS, POISSON, DENSITY) / (2e3 * math.pi)
        assert found == pytest.approx(kilohertz, rel=0.013)
        assert 1e9 * compliance(section, n, MODULUS, POISSON) == pytest.approx(nanometres, rel=3e-4)


@pytest.mark.parametrize(
    ("name", "seat", "rigid", "bent"),
    [
        ("6904", RingSeat(stiffness=1e8), 80.0, 114.0),
        ("6904", RingSeat(play=5e-6), 111.0, 144.0),
        ("6004", RingSeat(play=20e-6), 262.0, 271.0),
    ],
)
def test_an_outer_ring_that_is_soft_or_loose_in_its_seat(
    name: str, seat: RingSeat, rigid: float, bent: float
) -> None:
    """350 N, with an inner ring that is rigid or bends: as another program, which rounds to 1 N."""
    for harmonics, asked in ((0, rigid), (12, bent)):
        worst = ball_loads(BEARINGS[name], 350.0, harmonics, seat=seat).max()
        assert worst == pytest.approx(asked, abs=1.2)


@pytest.mark.parametrize(
    ("scene", "ball"), [("disk-cageless-detailed", 301.0), ("disk-caged-simplified", 439.0)]
)
def test_the_first_impact(scene: str, ball: float) -> None:
    """Of a minimal model with 16 harmonics: 3 % below it (6904), 1.4 % (6004), and room for rounding."""
    bent = LINE | {"bearing.ring.harmonics": -1, "bearing.balls.first_angle": "-90 deg"}
    run = touchdown.run(touchdown.load(scene).set({"run.duration": "9.5 ms", **bent}), in_process=True)
    peak = run.summary["seats"]["A"]["first_impact_ball_force"]
    assert peak == pytest.approx(ball, rel=0.04 if "detailed" in scene else 0.045)
    assert abs(run.summary["energy_made_inside_of_turnover"]) < 1e-4
    assert run.summary["energy_balance_relative"] < 2e-3


def test_a_ring_too_stiff_to_bend_is_rigid() -> None:
    """With a 10 000-fold width, to 0.2 %."""
    scenes = touchdown.load("disk-caged-simplified").set({"run.duration": "9 ms"})
    stiff = scenes.set({"bearing.ring.harmonics": -1, "bearing.ring.width": 90.0})
    rigid, bent = (
        touchdown.run(one, in_process=True).summary["seats"]["A"]["first_impact_ball_force"]
        for one in (scenes, stiff)
    )
    assert bent == pytest.approx(rigid, rel=2e-3)


@pytest.mark.parametrize("bearing", ["simplified_cageless", "simplified_caged"])
def test_a_free_ring_rings(bearing: str) -> None:
    """One harmonic let go, without weight: a cosine of its frequency, as leapfrog steps of h have it.

    That is 2/h asin(h w/2); adaptive steps keep to w within their tolerance.
    """
    instance, span = _afloat(bearing), 2e-5
    d, q = instance.memory["d"]["bending"][0], instance.memory["q"][0]
    at, rate, weight = int(d["first"]), float(d["frequency"][0]), float(d["weight"][0])
    if bearing != "simplified_caged":
        h = span / math.ceil(span / float(instance.memory["d"]["micro_step"][0]) - 1e-6)
        rate = 2.0 / h * math.asin(0.5 * h * rate)
    q[at] = 1e-7 / weight
    found = np.empty((100, 2))
    for k in range(100):
        instance.step(k * span, span)
        found[k] = weight * q[at : at + 2]
    expected = 1e-7 * np.cos(rate * span * np.arange(1, 101))
    assert found[:, 0] == pytest.approx(expected, abs=2e-10)
    assert found[:, 1] == pytest.approx(0.0, abs=1e-15)


def _afloat(bearing: str) -> Instance:
    """A 6904's ring with its second harmonic, that balls in play do not touch, without weight."""
    instance = instance_of(bearing)
    p = instance.memory["p"]
    p["gravity"], p["balls"]["play"] = 0.0, 20e-6
    p["ring"]["harmonics"], p["interface"]["tolerance"] = 2, 1e-8
    instance.start(0.0)
    return instance


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"bearing.clearance": "3 mm"}, "whose bore of 0.0127 m reaches its race of 0.0123 m"),
        ({"bearing.ring.width": "3 mm"}, "whose 1 grooves leave nothing of its width of 0.003 m"),
    ],
)
def test_a_ring_that_is_none_is_refused(settings: dict[str, str], message: str) -> None:
    scene = touchdown.load("disk-caged-simplified").set({"bearing.ring.harmonics": 2, **settings})
    with pytest.raises(TouchdownError, match=message), opened(scene, in_process=True) as system:
        system.initialise()
