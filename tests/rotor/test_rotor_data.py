"""The rotors of the source against what it states of them, and one that is made up."""

from __future__ import annotations

import math

import numpy as np
import pytest

from touchdown.rotor.beams.shaft import Shaft
from touchdown.rotor.file import load_rotor, shipped_rotors
from touchdown.rotor.modal.modes import basis
from touchdown.rotor.static_deflection import at_rest


@pytest.fixture(params=["rotor_I", "rotor_II"])
def rotor(request: pytest.FixtureRequest) -> Shaft:
    """Each rotor of the source."""
    return load_rotor(shipped_rotors()[request.param])


def hertz(shaft: Shaft, modes: int) -> np.ndarray:
    """Bending frequencies."""
    return basis(shaft, modes).omega[2:] / (2.0 * math.pi)


def test_a_rotor_says_it_is_a_surrogate_and_has_its_seats(rotor: Shaft):
    assert "surrogate" in rotor.about.lower()
    assert [s.name for s in rotor.stations] == ["A", "B", "amb_A", "amb_B"]
    assert [s.name for s in rotor.sensors] == ["sensor_A", "sensor_B"]
    assert rotor.levitated_at == ("amb_A", "amb_B")
    assert rotor.node("A") < rotor.node("B")


def test_the_compressor_s_rotor_is_what_it_is_for():
    """14 kg, and above 32 000 rpm by far when it bends."""
    shaft = load_rotor(shipped_rotors()["compressor_rotor"])
    assert shaft.mass == pytest.approx(14.0, rel=0.01)
    assert hertz(shaft, 3)[0] > 2.0 * 32000.0 / 60.0


def test_rotor_I():
    shaft = load_rotor(shipped_rotors()["rotor_I"])
    assert shaft.mass == pytest.approx(3.3, rel=1e-3)
    assert shaft.diametral_inertia == pytest.approx(0.017, rel=1e-3)
    assert shaft.polar_inertia == pytest.approx(0.001, rel=1e-3)
    assert hertz(shaft, 3)[0] == pytest.approx(1600.0, rel=0.01)


def test_rotor_II():
    """Table 2, simulated."""
    shaft = load_rotor(shipped_rotors()["rotor_II"])
    assert shaft.mass == pytest.approx(106.0, rel=1e-3)
    assert shaft.polar_inertia == pytest.approx(0.4, rel=1e-3)
    assert hertz(shaft, 6) == pytest.approx([673.5, 1071.0, 2363.0, 2925.0], rel=5e-3)


def test_rotor_II_at_rest_on_its_bearings():
    """Fig 19: no stress at the ends, sagging between the seats, little stress in the motor."""
    shaft = load_rotor(shipped_rotors()["rotor_II"])
    rest = at_rest(shaft, [(shaft.node("A"), math.inf), (shaft.node("B"), math.inf)])
    assert rest.reactions.sum() == pytest.approx(shaft.mass * 9.81)
    assert rest.reactions[0] > rest.reactions[1]  # the centre of mass is on the side of A
    assert np.abs(rest.bending[[0, -1]]).max() < 1e-6 * rest.bending.max()
    assert rest.bending.max() > 4.0 * rest.bending[(rest.position > 0.33) & (rest.position < 0.56)].max()
    assert -1e-4 < rest.deflection.min() < -1e-6
