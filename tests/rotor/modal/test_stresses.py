"""Stresses against beam theory, and mode acceleration against the full static solution."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from touchdown.modelkit.errors import TouchdownError
from touchdown.rotor.beams.element import Element
from touchdown.rotor.beams.shaft import Shaft, assembled_matrices, unit_forces
from touchdown.rotor.file import load_rotor, shipped_rotors
from touchdown.rotor.modal.modal_stresses import bending_per_moment, recovery, shear_per_force, stress_rows
from touchdown.rotor.modal.modes import basis, flexibility
from touchdown.rotor.static_deflection import at_rest

ELEMENT = Element(length=0.1, outer_diameter=0.06, modulus=207e9, density=7830.0, poisson=0.3)
UNIFORM = Shaft("uniform", (ELEMENT,) * 8)
SPAN, RADIUS = 0.8, 0.03
MODULUS, A = math.pi / 4 * RADIUS**3, math.pi * RADIUS**2  # of the section, its area


def test_simply_supported_under_a_force_in_the_middle():
    """M c / I and 4/3 V / A, from a deflection that is exact at the nodes."""
    free = [i for i in range(18) if i not in (0, 16)]
    q = np.zeros(18)
    force = -1000.0 * unit_forces(UNIFORM, (5,))[:, 0]
    q[free] = np.linalg.solve(assembled_matrices(UNIFORM).stiffness[np.ix_(free, free)], force[free])
    bending, shear = (rows @ q for rows in stress_rows(UNIFORM))
    everything = recovery(UNIFORM, basis(UNIFORM, 0))
    z = everything.position
    moment = 500.0 * np.minimum(z, SPAN - z)
    assert bending == pytest.approx(moment / MODULUS, abs=1e-3)  # sagging: positive
    V = np.where(np.arange(16) < 8, 500.0, -500.0)
    assert shear == pytest.approx(4.0 / 3.0 * V / A, rel=1e-8)
    assert everything.node.tolist() == [1, 2, 2, 3, 3, 4, 4, 5, 5, 6, 6, 7, 7, 8, 8, 9]


def test_under_its_own_weight():
    """w z (L - z)/2 at any mesh, 5 w L^4/384EI + w L^2/8kGA in the middle."""
    rest = at_rest(UNIFORM, [(1, math.inf), (9, math.inf)])
    w, z = ELEMENT.mass_per_length * 9.81, rest.position
    assert rest.bending == pytest.approx(0.5 * w * z * (SPAN - z) / MODULUS, abs=1.0)
    assert rest.shear == pytest.approx(4.0 / 3.0 * w * (SPAN / 2 - z) / A, abs=1.0)
    sag = 5 * w * SPAN**4 / (384 * ELEMENT.EI) + w * SPAN**2 / (8 * ELEMENT.kGA)
    assert rest.deflection[4] == pytest.approx(-sag, rel=1e-9)
    assert rest.reactions == pytest.approx([0.5 * w * SPAN] * 2)


def test_supports_that_cannot_be():
    for supports in ([(1, math.inf)], [(1, 1e6), (1, 1e6)]):
        with pytest.raises(TouchdownError, match="two nodes or more"):
            at_rest(UNIFORM, supports)
    with pytest.raises(TouchdownError, match="node 10: the rotor uniform has nodes 1 to 9"):
        at_rest(UNIFORM, [(1, math.inf), (10, math.inf)])
    with pytest.raises(TouchdownError, match="node 9 has a stiffness of 0 N/m"):
        at_rest(UNIFORM, [(1, math.inf), (9, 0.0)])


def test_factors_of_sections():
    """Hollow sections towards 2 V / A; a stiff sleeve takes its share of moment and force."""
    assert bending_per_moment(ELEMENT) == pytest.approx(1.0 / MODULUS)
    assert shear_per_force(ELEMENT) == pytest.approx(4.0 / 3.0 / A)
    thin = replace(ELEMENT, inner_diameter=0.0599999)
    assert shear_per_force(thin) * thin.area == pytest.approx(2.0, rel=1e-5)
    twin = replace(ELEMENT, sleeve_diameter=0.08, sleeve_modulus=207e9, sleeve_density=7830.0)
    share = 0.06**4 / 0.08**4
    assert bending_per_moment(twin) == pytest.approx(share / MODULUS)
    assert shear_per_force(twin) == pytest.approx(share * 4.0 / 3.0 / A)


@pytest.fixture(params=sorted(shipped_rotors()), scope="module")
def rotor(request: pytest.FixtureRequest) -> Shaft:
    """Each shipped rotor."""
    return load_rotor(shipped_rotors()[request.param])


def test_mode_acceleration_is_statically_exact(rotor: Shaft):
    """Under seat forces with inertia relief; mode displacement with the same modes is not."""
    at = (rotor.node("A"), rotor.node("B"))
    F = np.array([1000.0, -300.0])
    b = basis(rotor, 5)
    r = recovery(rotor, b, at)
    p = np.zeros(5)
    p[2:] = b.shapes[:, 2:].T @ (unit_forces(rotor, at) @ F) / b.omega[2:] ** 2
    q = flexibility(rotor, at) @ F
    for full, displacement, added in zip(
        stress_rows(rotor), (r.bending, r.shear), (r.bending_load, r.shear_load), strict=True
    ):
        exact = full @ q
        scale = np.abs(exact).max()
        assert displacement @ p + added @ F == pytest.approx(exact, abs=1e-9 * scale)
        assert np.abs(displacement @ p - exact).max() > 0.05 * scale


def test_rigid_motion_makes_no_stress(rotor: Shaft):
    r = recovery(rotor, basis(rotor, 5))
    assert r.bending_load.shape == (2 * len(rotor.elements), 0)
    assert np.abs(r.bending[:, :2]).max() < 1e-9 * np.abs(r.bending).max()
