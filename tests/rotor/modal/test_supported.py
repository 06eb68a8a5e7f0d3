"""Damped whirls of rotors in bearings: closed forms."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from touchdown.modelkit.model import ModelError
from touchdown.rotor.beams.beam_body import disc_mass
from touchdown.rotor.beams.element import Element
from touchdown.rotor.beams.shaft import Shaft, Support
from touchdown.rotor.file import rotor_named
from touchdown.rotor.modal import supported as held_by
from touchdown.rotor.modal.modes import basis
from touchdown.rotor.modal.whirl_speeds import _crossing, critical_speeds, followed

LENGTH, K, C = 0.6, 1e6, 300.0
ONE = np.eye(2)
STIFF = Element(length=LENGTH / 2.0, outer_diameter=0.05, modulus=2e14, density=7830.0, poisson=0.3)
WHEEL = Shaft("wheel", (STIFF, STIFF), points=(disc_mass(2, 0.3, 0.05, 0.02, 7830.0),))
RIGID = basis(WHEEL, 2)
SPEED = 900.0  # rad/s
EXACT = 1e-9  # relative; found: 1e-12


def bearings(**changes: object) -> list[held_by.LinearBearing]:
    """One at either end."""
    return [replace(held_by.LinearBearing(node, K * ONE, C * ONE), **changes) for node in (1, 3)]  # type: ignore[arg-type]


def upper(*polynomials: list[complex]) -> np.ndarray:
    """Roots of polynomials for x + i y that swing, turned to positive imaginary parts, by their size."""
    roots = np.concatenate([np.roots(p) for p in polynomials])
    roots = np.where(roots.imag < 0.0, np.conj(roots), roots)
    return roots[np.argsort(np.abs(roots))]


def by_size(roots: np.ndarray) -> np.ndarray:
    return roots[np.argsort(np.abs(roots))]


def test_cylindrical_and_conical_modes() -> None:
    """m s^2 + 2 c s + 2 k = 0 twice, and Id s^2 + (c l^2 / 2 - i Ip speed) s + k l^2 / 2 = 0."""
    found = held_by.HeldRotor(RIGID, bearings()).damped_modes(SPEED)
    cylindrical: list[complex] = [WHEEL.mass, 2.0 * C, 2.0 * K]
    arm = LENGTH**2 / 2.0
    conical = [WHEEL.diametral_inertia, arm * C - 1j * WHEEL.polar_inertia * SPEED, arm * K]
    swinging = np.roots(cylindrical)
    expected = np.concatenate(([swinging[swinging.imag > 0.0][0]] * 2, upper(conical)))
    assert found.roots == pytest.approx(by_size(expected), rel=EXACT)
    tilting = ~np.isclose(found.roots, swinging[swinging.imag > 0.0][0], rtol=1e-6)
    assert found.sense[tilting] == pytest.approx([-1.0, 1.0], abs=1e-9)
    assert found.stable
    ratio, decrement = held_by.damping_ratios(found.roots), held_by.log_decrements(found.roots)
    assert decrement == pytest.approx(2.0 * math.pi * ratio / np.sqrt(1.0 - ratio**2))


def test_a_bearing_that_lags() -> None:
    """m s^2 (1 + lag s) + 2 (k + c s) = 0, a lag of more than c / k drives the rotor away."""
    for lag, stable in ((1e-4, True), (1e-3, False)):
        slow = held_by.HeldRotor(RIGID, bearings(lag=lag)).damped_modes(0.0)
        expected = np.roots([lag * WHEEL.mass, WHEEL.mass, 2.0 * C, 2.0 * K])
        swinging, real = expected[expected.imag > 0.0], expected[expected.imag == 0.0].real
        close = np.isclose(slow.roots, swinging[0], rtol=EXACT)
        assert close.sum() == 2
        assert np.isclose(slow.aperiodic, real[0], rtol=1e-7).sum() == 2
        assert slow.stable is stable
    bearing = bearings(lag=1e-3)[0]
    assert bearing.dynamic_stiffness(100.0)[0, 0] == pytest.approx((K + 100j * C) / (1.0 + 0.1j))


def test_a_bearing_on_a_foundation() -> None:
    """Two masses in a row: the rotor's half, and the foundation's."""
    held = bearings(foundation=held_by.Foundation(mass=3.0, stiffness=5e6, damping=80.0))
    found = held_by.HeldRotor(RIGID, held).damped_modes(0.0)
    half, s = 0.5 * WHEEL.mass, np.poly1d([1.0, 0.0])
    own, tied = 3.0 * s**2 + 80.0 * s + 5e6, C * s + K
    chain = (half * s**2 + tied) * (own + tied) - tied**2
    for root in chain.roots[chain.roots.imag > 0.0]:
        assert np.isclose(found.roots, root, rtol=EXACT).sum() == 2
    assert held_by.static_stiffness(held[:1]) == pytest.approx(ONE / (1.0 / K + 1.0 / 5e6))
    assert held_by.static_stiffness(bearings()[:1]) == pytest.approx(K * ONE)


def test_parts_of_a_bearing_stand_on_one_foundation() -> None:
    """Halves of a bearing, one by a sensor in its place, are the whole one: in its modes and at rest."""
    named = held_by.Foundation(mass=3.0, stiffness=5e6, damping=80.0, name="housing.A")
    whole, other = bearings(foundation=named)[0], bearings()[1]
    half = replace(whole, stiffness=0.5 * K * ONE, damping=0.5 * C * ONE)
    found = held_by.HeldRotor(RIGID, [half, other, replace(half, sensed=1)]).damped_modes(SPEED)
    assert found.roots == pytest.approx(
        held_by.HeldRotor(RIGID, [whole, other]).damped_modes(SPEED).roots, rel=EXACT
    )
    assert held_by.static_stiffness([half, half]) == pytest.approx(held_by.static_stiffness([whole]))
    with pytest.raises(ModelError, match=r"two foundations called housing\.A"):
        held_by.HeldRotor(RIGID, [half, replace(other, foundation=replace(named, mass=4.0))])


def test_a_bearing_that_looks_elsewhere() -> None:
    """Both act at one end, one looks at the other: (M s^2 + sum a (k + c s) b^T) v = 0 in one plane."""
    near, far = bearings()[0], replace(bearings()[0], sensed=3)
    found = held_by.HeldRotor(
        RIGID, [near, far, held_by.LinearBearing(3, 2.0 * K * ONE, C * ONE)]
    ).damped_modes(0.0)
    one, two = RIGID.deflections([1, 3])
    stiffness = K * (np.outer(one, one) + np.outer(one, two)) + 2.0 * K * np.outer(two, two)
    damping = C * (np.outer(one, one) + np.outer(one, two)) + C * np.outer(two, two)
    state = np.block([[np.zeros((2, 2)), ONE], [-stiffness, -damping]])
    roots = np.linalg.eigvals(state)
    expected = np.repeat(by_size(roots[roots.imag > 0.0]), 2)
    assert found.roots == pytest.approx(expected, rel=EXACT)


@pytest.mark.parametrize(("share", "stable"), [(0.99, True), (1.01, False)])
def test_cross_coupling_beyond_the_damping_is_unstable(share: float, stable: bool) -> None:
    """A forward whirl of w grows where the cross stiffness is more than c w."""
    cross = share * C * math.sqrt(2.0 * K / WHEEL.mass)
    held = bearings(stiffness=np.array([[K, cross], [-cross, K]]))
    tilt = [replace(b, stiffness=K * ONE, damping=1e3 * ONE) for b in held]  # whose damping is another
    found = held_by.HeldRotor(RIGID, held).damped_modes(0.0)
    least = found.roots[np.argmax(found.roots.real)]
    assert (least.real > 0.0) is not stable
    assert found.stable is stable
    assert held_by.HeldRotor(RIGID, tilt).damped_modes(0.0).stable


def test_what_nothing_holds_is_no_mode_and_what_is_pushed_away_falls() -> None:
    free = held_by.HeldRotor(RIGID, []).damped_modes(SPEED)
    assert len(free.roots) == 1  # the tilt's precession
    assert free.stable
    pushed = held_by.HeldRotor(RIGID, bearings(stiffness=-K * ONE)).damped_modes(0.0)
    assert not pushed.stable
    assert pushed.aperiodic[-1] > 0.0


def test_a_short_lag_takes_no_mode_away() -> None:
    """Its own root is 1 / lag, far above those of the modes."""
    shaft = rotor_named("rotor_I")
    modes = basis(shaft, 5, [3])

    def soft(lag: float, c: float) -> held_by.DampedModes:
        held = [
            held_by.LinearBearing(shaft.node(name), 1e4 * ONE, c * ONE, lag) for name in ("amb_A", "amb_B")
        ]
        return held_by.HeldRotor(modes, held, 0.003).damped_modes(SPEED)

    at_once, found = soft(0.0, 10.0), soft(1.5e-9, 10.0)
    assert found.roots == pytest.approx(at_once.roots, rel=1e-6)  # found: 6e-8
    assert found.free == 0
    assert not soft(1.5e-9, -10.0).stable


def test_what_cannot_be_a_bearing() -> None:
    with pytest.raises(ModelError, match=r"stiffness of a bearing has the shape \(2,\)"):
        held_by.LinearBearing(1, np.ones(2), ONE)


def test_critical_speeds_without_damping() -> None:
    """Of the forward whirls, those of the generalised eigenvalue problem."""
    shaft = rotor_named("rotor_II")
    modes = basis(shaft, 10, [shaft.node("amb_A"), shaft.node("amb_B")])
    held = [held_by.LinearBearing(shaft.node(name), 2e7 * ONE, 0.0 * ONE) for name in ("amb_A", "amb_B")]
    expected = critical_speeds(modes, [Support(b.node, 2e7) for b in held])
    lines = followed(held_by.HeldRotor(modes, held), np.linspace(0.0, 1000.0, 21), 8)
    forward = [c for c in lines.crossings if c.sense > 0.0]
    assert [c.speed for c in forward] == pytest.approx(expected[expected < 1000.0], rel=1e-7)
    assert [c.root.imag for c in lines.crossings] == pytest.approx([c.speed for c in lines.crossings])


def test_lines_keep_to_their_modes() -> None:
    """Forward lines rise, backward ones fall, translations stay; none breaks off."""
    lines = followed(held_by.HeldRotor(RIGID, bearings()), np.linspace(0.0, 2000.0, 41), 4)
    assert lines.roots.shape == (41, 4)
    assert np.isfinite(lines.roots).all()
    swing = np.imag(lines.roots)
    turns = np.sign(np.round(lines.sense, 6))
    assert (turns[2:] == turns[-1]).all()
    rises = np.round(swing[-1] - swing[1], 3)
    assert sorted(np.sign(rises)) == [-1.0, 0.0, 0.0, 1.0]
    assert lines.stable.all()


def test_a_mode_that_stops_swinging_ends_its_line() -> None:
    """A tilt damped beyond its critical damping swings at high speeds only, where it precesses."""
    arm = LENGTH**2 / 2.0
    heavy = 1.5 * 2.0 * math.sqrt(K * WHEEL.diametral_inertia / arm)  # a damping ratio of 1.5
    rotor = held_by.HeldRotor(RIGID, bearings(damping=heavy * ONE))
    lines = followed(rotor, np.linspace(0.0, 2e4, 41), 4)
    swings = np.isfinite(lines.roots).sum(axis=1)
    assert swings[0] < swings[-1]
    assert (held_by.damping_ratios(lines.roots[np.isfinite(lines.roots)]) < 1.0).all()


def test_a_crossing_that_another_mode_hides_is_still_told() -> None:
    """At both ends a mode of the other sense is nearer: the line's own course is left."""
    rotor = held_by.HeldRotor(RIGID, bearings())
    swing = float(rotor.damped_modes(0.0).roots[0].imag)
    speeds, roots = np.array([0.9, 1.1]) * 0.5 * swing, 1j * swing * np.array([0.5, 0.5])
    found = _crossing(rotor, speeds, roots, 1.0)
    assert found.speed == pytest.approx(0.5 * swing)
    assert found.root == pytest.approx(0.5j * swing)


@pytest.mark.parametrize("speed", [1e-3, 1.0, 100.0, 1000.0])
@pytest.mark.parametrize("name", ["rotor_I", "rotor_II"])
def test_what_is_pushed_away_falls_at_any_speed(name: str, speed: float) -> None:
    """Roots that fall in both planes make pairs that hardly swing: they are no modes, and yet there."""
    shaft = rotor_named(name)
    modes = basis(shaft, 16, [3, shaft.nodes - 3])
    for k in (-1e4, -1e6):
        for c in (0.0, 100.0):
            held = [
                held_by.LinearBearing(node, times * k * ONE, c * ONE)
                for node, times in ((4, 1.0), (shaft.nodes - 4, 1.3))
            ]
            assert not held_by.HeldRotor(modes, held, 0.003).damped_modes(speed).stable
