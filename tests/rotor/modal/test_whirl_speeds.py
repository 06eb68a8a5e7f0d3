"""Critical speeds and modes on supports: closed forms of rigid rotors."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from touchdown.rotor.beams.beam_body import disc_mass
from touchdown.rotor.beams.element import Element
from touchdown.rotor.beams.shaft import Shaft, Station, Support, Unbalance
from touchdown.rotor.file import rotor_named
from touchdown.rotor.modal.modes import basis
from touchdown.rotor.modal.whirl_speeds import (
    MAP_DECADES,
    MAP_LINES,
    critical_map,
    critical_speeds,
    whirl_frequencies,
)

K = 1e6
LENGTH = 0.6
STIFF = Element(length=LENGTH / 2.0, outer_diameter=0.05, modulus=2e14, density=7830.0, poisson=0.3)
SLENDER = Shaft("slender", (STIFF, STIFF), unbalances=(Unbalance(2, 1e-5),))
WHEEL = replace(SLENDER, points=(disc_mass(2, 0.6, 0.05, 0.02, 7830.0),))
ENDS = (Support(1, K), Support(3, K))


def moments(shaft: Shaft) -> tuple[float, float]:
    """(k l^2 / 2) and Id - Ip: what a tilt has against it, and its inertia when it whirls forwards."""
    return K * LENGTH**2 / 2.0, shaft.diametral_inertia - shaft.polar_inertia


def test_a_wheel_has_one() -> None:
    """Its gyroscopic moment outruns the tilt: Ip > Id."""
    assert moments(WHEEL)[1] < 0.0
    assert critical_speeds(basis(WHEEL, 2), ENDS) == pytest.approx([math.sqrt(2.0 * K / WHEEL.mass)])


def test_planes_that_differ() -> None:
    """Translations by their own springs; tilts where w^4 (Id^2 - Ip^2) - w^2 (a + b) Id + a b = 0."""
    held = [Support(1, K, 4.0 * K), Support(3, K, 4.0 * K)]
    found = critical_speeds(basis(SLENDER, 2), held)
    a, Id, Ip = moments(SLENDER)[0], SLENDER.diametral_inertia, SLENDER.polar_inertia
    tilts = np.sqrt(np.roots([Id**2 - Ip**2, -5.0 * a * Id, 4.0 * a**2]))
    across = [math.sqrt(f * 2.0 * K / SLENDER.mass) for f in (1.0, 4.0)]
    assert found == pytest.approx(sorted([*tilts, *across]))


@pytest.mark.parametrize("name", ["rotor_I", "rotor_II"])
def test_at_a_critical_speed_a_forward_whirl_is_as_fast_as_the_spin(name: str) -> None:
    shaft = rotor_named(name)
    modes = basis(shaft, 0)
    held = [Support(shaft.node("amb_A"), 2e7), Support(shaft.node("amb_B"), 2e7)]
    springs = [(s.node, s.stiffness) for s in held]
    for speed in critical_speeds(modes, held)[:MAP_LINES]:
        whirl = whirl_frequencies(modes, [speed], springs)[0]
        assert np.min(np.abs(whirl / speed - 1.0)) < 1e-8


def test_a_map_marks_what_the_shaft_stands_on() -> None:
    places = [Station("A", 1), Station("B", 3), Station("also_B", 3)]
    shaft = replace(SLENDER, supports=(*ENDS, Support(2, 5.0)))
    found = critical_map(shaft, basis(shaft, 0), places)
    assert found.speeds.shape == (len(found.stiffness), MAP_LINES)
    assert np.log10(found.stiffness[-1] / found.stiffness[0]) == pytest.approx(
        MAP_DECADES[1] - MAP_DECADES[0]
    )
    assert (np.diff(found.speeds[:, 0]) > 0.0).all()
    assert found.marked == ENDS
    assert found.critical == pytest.approx(critical_speeds(basis(shaft, 0), ENDS)[:MAP_LINES])
    assert not len(critical_map(SLENDER, basis(SLENDER, 0), places).critical)
