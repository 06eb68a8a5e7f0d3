"""Cones and layers: closed forms, refinement, and ROSS's matrices of a cone."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from touchdown.rotor.beams import element
from touchdown.rotor.beams.beam_body import rigid_motion
from touchdown.rotor.beams.element import Element, split_element
from touchdown.rotor.beams.shaft import Shaft, assembled_matrices
from touchdown.rotor.modal.modal_stresses import stress_rows
from touchdown.rotor.modal.modes import basis
from touchdown.rotor.static_deflection import at_rest

POISSON = 211.0 / (2.0 * 81.2) - 1.0
ROSS_CONE = Element(  # of the docstrings of ross.ShaftElement
    length=0.5,
    outer_diameter=0.1,
    outer_diameter_end=0.15,
    inner_diameter=0.05,
    modulus=211e9,
    density=7810.0,
    poisson=POISSON,
)
CONE = replace(ROSS_CONE, inner_diameter=0.0, outer_diameter=0.1, outer_diameter_end=0.04)
STEEL = Element(length=0.02, outer_diameter=0.02, modulus=207e9, density=7830.0, poisson=0.3)


def test_the_matrices_of_ross() -> None:
    """As ROSS 2.3.0 prints them."""
    m = element.element_matrices(ROSS_CONE)
    assert m.mass[:2, :2].round(6).tolist() == [[11.369864, 0.861976], [0.861976, 0.086675]]
    assert (1e-6 * m.stiffness[:2, :2]).round(4).tolist() == [[219.9614, 41.2975], [41.2975, 12.2353]]
    assert m.polar[:2, :2].round(6).tolist() == [[0.309408, 0.010859], [0.010859, 0.006721]]


def test_body_of_a_solid_cone() -> None:
    """The whole, and its pieces together, against the closed forms of a truncated cone."""
    R, r, h = 0.05, 0.02, CONE.length
    volume = math.pi * h / 3.0 * (R**2 + R * r + r**2)
    centre = h / 4.0 * (R**2 + 2.0 * R * r + 3.0 * r**2) / (R**2 + R * r + r**2)  # from the wide end
    polar = 0.3 * 7810.0 * volume * (R**5 - r**5) / (R**3 - r**3)
    for count in (1, 7):
        shaft = Shaft("cone", tuple(split_element(CONE, count)))
        assert shaft.mass == pytest.approx(7810.0 * volume, rel=1e-12)
        assert shaft.centre_of_mass == pytest.approx(centre, rel=1e-12)
        assert shaft.polar_inertia == pytest.approx(polar, rel=1e-12)


@pytest.mark.parametrize("layered", [False, True])
def test_rigid_motion_weighs_what_it_should(layered: bool) -> None:
    bronze = replace(ROSS_CONE, inner_diameter=0.1, inner_diameter_end=0.15, outer_diameter=0.16,
                     outer_diameter_end=0.17, density=8800.0, modulus=0.0)  # fmt: skip
    shaft = Shaft("cone", (replace(ROSS_CONE, layers=(bronze,) if layered else ()), CONE))
    m = assembled_matrices(shaft)
    e, t = rigid_motion(shaft.positions(), shaft.centre_of_mass).T
    assert e @ m.mass @ e == pytest.approx(shaft.mass, rel=1e-12)
    assert e @ m.mass @ t == pytest.approx(0.0, abs=1e-12 * shaft.mass)
    assert t @ m.mass @ t == pytest.approx(shaft.diametral_inertia, rel=1e-12)
    assert t @ m.polar @ t == pytest.approx(shaft.polar_inertia, rel=1e-12)
    for motion in (e, t):
        assert np.abs(m.stiffness @ motion).max() < 1e-12 * np.abs(m.stiffness).max()


def test_stress_at_the_ends_of_a_cone() -> None:
    """From shape functions, what equilibrium asks for, where the shaft is thin as where it is thick."""
    shaft = Shaft("cone", tuple(split_element(CONE, 16)))
    lying = at_rest(shaft, [(1, math.inf), (17, math.inf)])
    assert lying.bending[7:25:2] == pytest.approx(lying.bending[8:26:2], rel=1e-9)  # either side of a node
    thick = shaft.elements[8].diameters(0.0)[0]
    moment = lying.bending[16] * math.pi / 32.0 * thick**3
    upwards = lying.reactions[0] * 0.25 - sum(
        9.81 * e.mass * (0.25 - z - e.length / 2.0 - e.centre_of_mass)
        for e, z in zip(shaft.elements[:8], shaft.positions(), strict=False)
    )
    assert moment == pytest.approx(upwards, rel=1e-9)
    q = np.stack([lying.deflection, lying.slope], axis=1).ravel()
    assert (stress_rows(shaft)[0] @ q)[7:25] == pytest.approx(lying.bending[7:25], rel=0.03)


def composite(sleeved: bool, count: int) -> Shaft:
    """A slender steel shaft in a tube of bronze, 1 m long."""
    if sleeved:
        one = replace(STEEL, sleeve_diameter=0.03, sleeve_density=8800.0, sleeve_modulus=110e9)
    else:
        tube = replace(STEEL, inner_diameter=0.02, outer_diameter=0.03, modulus=110e9, density=8800.0)
        one = replace(STEEL, layers=(tube,))
    return Shaft("composite", tuple(split_element(one.stretched(1.0), count)))


@pytest.mark.parametrize("sleeved", [True, False])
def test_two_materials_over_one_another(sleeved: bool) -> None:
    """First free bending frequency: 22.3733 sqrt(EI / m) / L^2, both materials in EI and m."""
    shaft = composite(sleeved, 40)
    EI = math.pi / 64.0 * (207e9 * 0.02**4 + 110e9 * (0.03**4 - 0.02**4))
    per_length = math.pi / 4.0 * (7830.0 * 0.02**2 + 8800.0 * (0.03**2 - 0.02**2))
    assert pytest.approx(EI, rel=1e-12) == shaft.elements[0].EI
    assert shaft.mass == pytest.approx(per_length, rel=1e-12)
    slender = 22.3733 * math.sqrt(EI / per_length)
    assert basis(shaft, 3).omega[2] == pytest.approx(slender, rel=5e-3)  # shear and rotary inertia: -0.4 %
    assert basis(shaft, 3).omega[2] == pytest.approx(
        basis(composite(not sleeved, 40), 3).omega[2], rel=1e-3
    )


def test_a_layer_carries_its_share_of_a_moment() -> None:
    """The core's stress in a composite is that of its own curvature."""
    for shaft in (composite(True, 10), composite(False, 10)):
        lying = at_rest(shaft, [(1, math.inf), (11, math.inf)])
        moment = shaft.mass * 9.81 * 1.0 / 8.0
        assert lying.bending.max() == pytest.approx(0.01 * 207e9 * moment / shaft.elements[0].EI, rel=1e-6)
