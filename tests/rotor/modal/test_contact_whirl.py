"""Whirl round touchdown bearings from receptances, against closed forms."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest
from scipy.optimize import brentq

from touchdown.rotor.file import rotor_named
from touchdown.rotor.modal.contact_whirl import (
    ContactWhirl,
    ElasticModes,
    Stiffness,
    WhirlSeat,
    circling,
    on_modes,
    receptance,
    rigid,
    steady,
)
from touchdown.rotor.modal.modes import basis

CLEARANCE = 0.2e-3


def spring(stiffness: float, ratio: float) -> WhirlSeat:
    """A rigid stator behind a contact, whose force along the circle is a `ratio` of the one inwards."""

    def bearing(depth: float, omega: float) -> complex:
        return complex(-stiffness * depth, math.copysign(ratio * stiffness * depth, omega))

    return WhirlSeat(CLEARANCE, bearing, rigid)


def test_a_free_mass_on_a_damped_carrier() -> None:
    """N = m W^2 (c + X + d): drive by hand from the carrier's loss, N T = c_d W^2 X^2 over W r."""
    mass, k, damping, contact, mu = 20.0, 1e7, 2000.0, 1e9, 0.02
    seat = spring(contact, mu)._replace(carrier=steady(1.0, k, damping))
    whirl = ContactWhirl(lambda omega: np.array([[-1.0 / (mass * omega**2 + 0j)]]), [seat])
    way, settled = whirl.settled(-30.0, -5000.0)
    assert settled is not None
    assert len(way) > 3
    assert settled.drive == pytest.approx(1.0, abs=1e-5)
    for circle in (way[1], settled):
        (force,), (along,), (stroke,) = circle.force, np.abs(circle.along), circle.stroke
        journal = np.hypot(force, circle.drive * along) / (mass * circle.omega**2)  # m, of its circle
        loss = damping * circle.omega**2 * stroke**2
        # what drives it acts on the journal and, the other way, on the carrier: over their motion along it
        power = circle.drive * along * abs(circle.omega) * (CLEARANCE + circle.depth[0])
        assert power == pytest.approx(loss, rel=1e-6)
        assert journal > CLEARANCE
    assert settled.friction == pytest.approx([mu], rel=1e-5)


def test_receptances_of_a_rotor_are_those_of_its_mass_at_low_frequencies() -> None:
    """Translation and tilt of a free rotor that does not spin, at two nodes; with a spin they couple."""
    shaft = rotor_named("rotor_I")
    nodes = [shaft.node("A"), shaft.node("B")]
    modes = basis(shaft, 6)
    omega = 2.0
    found = receptance(modes, 0.003, nodes, 0.0)(omega)
    places = shaft.positions()[np.array(nodes) - 1] - shaft.centre_of_mass
    rigid_body = -(1.0 / shaft.mass + np.outer(places, places) / shaft.diametral_inertia) / omega**2
    np.testing.assert_allclose(np.real(found), rigid_body, rtol=1e-4)
    spun = receptance(modes, 0.003, nodes, 1000.0)
    assert not np.allclose(spun(omega), spun(-omega), rtol=1e-3)
    np.testing.assert_allclose(spun(omega), spun(omega).T, rtol=1e-9)


def test_a_mount_that_slides() -> None:
    """Its stroke under a force that goes round, by hand."""
    k, slide, mass, omega = 1e7, 100.0, 0.5, 800.0

    def sliding(omega: float) -> Callable[[float], complex]:
        friction = 1j * math.copysign(slide, omega)
        return lambda stroke: k + (friction / stroke if stroke > 0.0 else 0.0)

    for sense in (1.0, -1.0):
        found = circling(sliding, mass)(sense * omega, 500.0)
        # |k - m W^2 + i F/X| X = force
        stroke = math.sqrt(500.0**2 - slide**2) / (k - mass * omega**2)
        assert abs(found) * 500.0 == pytest.approx(stroke, rel=1e-7)
        assert np.sign(np.imag(found)) == -sense


def stopped_mount(stop: float) -> Stiffness:
    """10 MN/m and 200 N s/m, and beyond 0.1 mm a stop (N/m^1.5)."""

    def mount(omega: float) -> Callable[[float], complex]:
        return lambda s: 1e7 + 200j * omega + stop * max(s - 1e-4, 0.0) ** 1.5 / max(s, 1e-4)

    return mount


@pytest.mark.parametrize("stop", [1e8, 1e13])
def test_strokes_at_a_stop_are_those_of_a_bracketed_search(stop: float) -> None:
    """From inside the gap to hard on the stop, alone and on a foundation without modes, 5 kg at 60 Hz."""
    mass, omega, mount = 5.0, 60.0 * 2.0 * math.pi, stopped_mount(stop)
    none = ElasticModes(np.zeros(0), np.zeros(0), np.zeros((0, 1, 2)))
    strokes = []
    for force in (100.0, 900.0, 1500.0, 3000.0, 3e4):

        def left(stroke: float, force: float = force) -> float:
            return force / abs(mount(omega)(stroke) - mass * omega**2) - stroke

        stroke = brentq(left, 0.0, 1.01 * left(0.0), xtol=1e-16)
        strokes.append(stroke)
        assert force * abs(circling(mount, mass)(omega, force)) == pytest.approx(stroke, rel=1e-7)
        shared = on_modes(none, [mount], [mass])(omega, np.array([force]))
        assert force * abs(shared[0, 0]) == pytest.approx(stroke, rel=1e-7)
    assert strokes[0] < 1e-4 < strokes[2]


def test_carriers_that_share_a_mode_are_two_masses_in_a_row() -> None:
    """Pushed alike, they are 2 m on 2 k on a mode; each is a mount by itself where no mode gives way."""
    m, k, c, big, own, ratio = 0.5, 1e7, 500.0, 15.0, 900.0, 0.02
    shapes = np.array([[[1.0, 0.0]] * 2, [[0.0, 1.0]] * 2]) / math.sqrt(big)  # along x, along y
    half = ElasticModes(np.array([own]), np.array([ratio]), shapes[:1])
    both = ElasticModes(np.array([own, own]), np.array([ratio, ratio]), shapes)

    def mount(omega: float) -> Callable[[float], complex]:
        return lambda stroke: k + 1j * omega * c

    for omega in (700.0, -1300.0):
        dynamic = k + 1j * omega * c
        found = on_modes(both, [mount, mount], [m, m])(omega, np.array([1.0, 1.0j]))
        below = big * (own**2 - omega**2 + 2j * ratio * own * omega)
        u = 2.0 / (below - (below + 2.0 * dynamic) * m * omega**2 / dynamic)  # 2 (F + m W^2 v) = below u
        v = u * (below + 2.0 * dynamic) / (2.0 * dynamic)
        assert found @ [1.0, 1.0] == pytest.approx([v, v], rel=1e-9)
        assert half.around(omega) == pytest.approx(0.5 * both.around(omega), rel=1e-12)  # in the mean
        none = ElasticModes(np.zeros(0), np.zeros(0), np.zeros((0, 2, 2)))
        alone = on_modes(none, [mount, mount], [m, m])(omega, np.ones(2))
        assert alone == pytest.approx(circling(mount, m)(omega, 1.0) * np.eye(2), rel=1e-12)


def test_a_circle_leads_to_the_next_in_few_evaluations() -> None:
    """It is the one that is found anew from the one before, without what is known of the slope."""
    asked: list[float] = []

    def bearing(depth: float, omega: float) -> complex:
        asked.append(depth)
        return complex(-1e9 * depth, -2e7 * depth)

    seat = WhirlSeat(CLEARANCE, bearing, steady(1.0, 1e7, 2000.0))
    whirl = ContactWhirl(lambda omega: np.array([[-1.0 / (20.0 * omega**2 + 0j)]]), [seat])
    circles = whirl.faster(-30.0, -500.0)
    way = [next(circles), next(circles)]
    asked.clear()
    way += circles
    assert len(way) > 30
    assert len(asked) < 8 * len(way)
    for before, circle in zip(way[4::8], way[5::8], strict=False):
        anew = whirl.at(circle.omega, before)
        assert anew is not None
        assert circle.drive == pytest.approx(anew.drive, rel=1e-6)
        assert circle.force == pytest.approx(anew.force, rel=1e-8)


def test_a_whirl_that_nothing_stops_goes_on() -> None:
    """A free mass round a rigid stator without a loss: no circle needs any drive."""
    whirl = ContactWhirl(lambda omega: np.array([[-1.0 / (20.0 * omega**2 + 0j)]]), [spring(1e9, 0.02)])
    way, settled = whirl.settled(-30.0, -300.0)
    assert settled is None
    assert way[-1].drive < 1e-6
    assert abs(way[-1].omega) >= 300.0


def test_two_carriers_at_their_stops_on_one_mode() -> None:
    """Forces balance at strokes that are those of the stiffness they were found with."""
    mass, omega, mount = 5.0, 60.0 * 2.0 * math.pi, stopped_mount(1e11)
    shapes = np.array([[[1.0, 0.0], [0.6, 0.0]], [[0.0, 1.0], [0.0, 0.6]]]) / math.sqrt(15.0)
    modes = ElasticModes(np.full(2, 900.0), np.full(2, 0.02), shapes)
    asked: list[float] = []

    def seen(omega: float) -> Callable[[float], complex]:
        def at(stroke: float) -> complex:
            asked.append(stroke)
            return mount(omega)(stroke)

        return at

    force = np.array([3000.0, 2000.0j])
    way = on_modes(modes, [seen, seen], [mass, mass])(omega, force) @ force
    pressed = force + mass * omega**2 * way  # by each mount, on the modes
    give = way - modes.around(omega) @ pressed
    stiffness = [mount(omega)(abs(one)) for one in give]
    assert np.abs(give).min() > 1e-4
    assert stiffness * give == pytest.approx(pressed, rel=1e-6)
    assert len(asked) < 300


def test_what_has_no_stroke_has_no_receptance_and_no_circle() -> None:
    """A mount that becomes the softer the farther it goes gives way without end."""

    def softer(omega: float) -> Callable[[float], complex]:
        return lambda stroke: complex(1e7 / (1.0 + 2.0 * 1e7 / 500.0 * stroke))

    assert np.isnan(circling(softer, 0.0)(300.0, 500.0))
    none = ElasticModes(np.zeros(0), np.zeros(0), np.zeros((0, 1, 2)))
    ground = on_modes(none, [softer], [0.0])
    assert np.isnan(ground(300.0, np.array([500.0]))).all()

    def free(omega: float) -> np.ndarray:
        return np.array([[-1.0 / (20.0 * omega**2 + 0j)]])

    assert ContactWhirl(free, [spring(1e9, 0.02)]).at(-500.0) is not None
    lost = spring(1e9, 0.02)._replace(carrier=lambda omega, force: complex(math.nan, math.nan))
    assert ContactWhirl(free, [lost]).at(-500.0) is None
