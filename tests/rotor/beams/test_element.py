"""Beam elements against closed forms: statics with shear, a free beam's frequencies, whirl of a top."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.polynomial import legendre
from scipy import linalg

from touchdown.rotor.beams import element as beam
from touchdown.rotor.beams.beam_body import disc_mass
from touchdown.rotor.beams.element import Element
from touchdown.rotor.beams.shaft import Shaft, assembled_matrices
from touchdown.rotor.modal.modes import basis

STEEL = {"modulus": 207e9, "density": 7830.0, "poisson": 0.3}
LENGTH = 0.8


def uniform(count: int, **changes) -> Shaft:
    """A beam of 60 mm x 0.8 m in `count` elements."""
    element = Element(**({"length": LENGTH / count, "outer_diameter": 0.06, **STEEL} | changes))
    return Shaft("uniform", (element,) * count)


SOLID = uniform(1).elements[0]
HOLLOW = replace(SOLID, inner_diameter=0.04)
SLEEVED = replace(SOLID, sleeve_diameter=0.09, sleeve_density=7650.0, sleeve_modulus=80e9)
STUBBY = replace(SOLID, length=0.05)
SECTIONS = pytest.mark.parametrize(
    "element", [HOLLOW, SLEEVED, STUBBY], ids=["hollow", "sleeved", "stubby"]
)


# -- statics -----------------------------------------------------------------------------------------


@SECTIONS
def test_cantilever_under_a_force_and_a_moment(element: Element):
    """One element is exact: F L^3/3EI + F L/kGA and F L^2/2EI; M L^2/2EI and M L/EI."""
    L, EI, kGA = element.length, element.EI, element.kGA
    free = beam.element_matrices(element).stiffness[2:, 2:]
    assert np.linalg.solve(free, [1.0, 0.0]) == pytest.approx([L**3 / (3 * EI) + L / kGA, L**2 / (2 * EI)])
    assert np.linalg.solve(free, [0.0, 1.0]) == pytest.approx([L**2 / (2 * EI), L / EI])


@SECTIONS
def test_simply_supported_under_a_force_off_centre(element: Element):
    """Two elements; F a b (deflection a b / 3EI + shear 1/kGA) / L under the force."""
    a, b = 0.3 * element.length, 0.7 * element.length
    shaft = Shaft("two", (replace(element, length=a), replace(element, length=b)))
    free = [1, 2, 3, 5]
    K = assembled_matrices(shaft).stiffness[np.ix_(free, free)]
    deflection = np.linalg.solve(K, [0.0, 1.0, 0.0, 0.0])[1]
    L = element.length
    assert deflection == pytest.approx(a**2 * b**2 / (3 * element.EI * L) + a * b / (L * element.kGA))


def test_shape_functions_by_hand():
    """The curvature of (3.20) as printed, but for its sign, and D of (3.16)."""
    element = STUBBY
    L, phi = element.length, element.phi
    S = np.linspace(0.0, L, 7)
    N = beam.shapes(element, S)
    printed = np.stack(
        (
            6 * L - 12 * S,
            4 * L**2 + phi * L**2 - 6 * S * L,
            12 * S - 6 * L,
            2 * L**2 - phi * L**2 - 6 * S * L,
        ),
        axis=1,
    ) / (L**3 * (1 + phi))
    assert N.curvature == pytest.approx(-printed)
    D = phi / (2 * L * (1 + phi)) * np.array([2.0, L, -2.0, L])
    assert N.third[3] * element.EI / element.kGA == pytest.approx(D)
    ends = beam.shapes(element, np.array([0.0, L]))
    assert ends.deflection == pytest.approx(np.eye(4)[[0, 2]], abs=1e-14)
    assert ends.slope == pytest.approx(np.eye(4)[[1, 3]], abs=1e-12)


# -- sections ----------------------------------------------------------------------------------------


def test_sections():
    assert SOLID.kappa == pytest.approx(7.8 / 8.8)
    assert HOLLOW.kappa == pytest.approx(0.5625, abs=0.03)  # towards 2 (1 + nu)/(4 + 3 nu) = 0.53
    thin = replace(SOLID, inner_diameter=0.0599999)
    assert thin.kappa == pytest.approx(2 * 1.3 / 4.9, rel=1e-6)
    assert pytest.approx(207e9 * math.pi / 64 * (0.06**4 - 0.04**4)) == HOLLOW.EI
    assert pytest.approx(SOLID.EI + 80e9 * math.pi / 64 * (0.09**4 - 0.06**4)) == SLEEVED.EI
    added = SOLID.kappa * 80e9 / 2.6 * math.pi / 4 * (0.09**2 - 0.06**2)
    assert SLEEVED.kGA == pytest.approx(SOLID.kGA + added)
    assert replace(SOLID, shear_factor=0.9).kGA == pytest.approx(SOLID.kGA * 0.9 / SOLID.kappa)


def test_inertias_of_a_sleeve_are_those_of_a_ring():
    mass = 7650.0 * math.pi / 4 * (0.09**2 - 0.06**2) * LENGTH
    assert SLEEVED.mass - SOLID.mass == pytest.approx(mass)
    assert SLEEVED.polar_inertia - SOLID.polar_inertia == pytest.approx(mass * (0.09**2 + 0.06**2) / 8)
    added = mass * ((0.09**2 + 0.06**2) / 16 + LENGTH**2 / 12)
    assert SLEEVED.diametral_inertia - SOLID.diametral_inertia == pytest.approx(added)


def test_a_disc_is_a_short_hollow_element():
    element = replace(HOLLOW, length=0.02)
    point = disc_mass(1, 0.06, 0.04, 0.02, 7830.0)
    assert point.mass == pytest.approx(element.mass)
    assert point.polar_inertia == pytest.approx(element.polar_inertia)
    assert point.diametral_inertia == pytest.approx(element.diametral_inertia)


# -- the whole rotor; rigid motions: `test_cones_and_layers` ---------------------------------------


def free_beam(element: Element) -> np.ndarray:
    """First four frequencies (rad/s) of a free Timoshenko beam, by polynomials over its whole length.

    Deflection and slope are Legendre series of their own (Galerkin), exact to ten digits here.
    """
    degree, points = 24, 60
    x, weights = legendre.leggauss(points)
    w = weights[:, None] * LENGTH / 2.0
    P = legendre.legvander(x, degree)
    D = np.stack([legendre.legval(x, legendre.legder(row)) for row in np.eye(degree + 1)], 1) * 2.0 / LENGTH
    zero = np.zeros((degree + 1, degree + 1))
    PP, DP, DD = P.T @ (w * P), D.T @ (w * P), D.T @ (w * D)
    K = element.kGA * np.block([[DD, -DP], [-DP.T, PP]]) + element.EI * np.block([[zero, zero], [zero, DD]])
    m, j = element.mass_per_length, element.diametral_inertia_per_length
    M = np.block([[m * PP, zero], [zero, j * PP]])
    return np.sqrt(linalg.eigh(K, M, eigvals_only=True)[2:6])


RIGID_IN_SHEAR = 1e6  # shear factor


@pytest.mark.parametrize(
    ("factor", "order"), [(None, 2.0), (RIGID_IN_SHEAR, 4.0)], ids=["shear", "bending"]
)
def test_convergence(factor: float | None, order: float):
    """Order of the error of the first four frequencies.

    Fourth order where bending decides. The shear angle is constant within an element (3.16) while the
    shear force under inertia loads is not, so where shear decides the order is two.
    """
    counts = np.array([8, 12, 16, 24])
    found = np.array([basis(uniform(n, shear_factor=factor), 6).omega[2:] for n in counts])
    exact = free_beam(SOLID) if factor is None else basis(uniform(120, shear_factor=factor), 6).omega[2:]
    errors = found / exact - 1.0
    assert (errors > 0.0).all()  # a Ritz method comes from above
    orders = [-np.polyfit(np.log(counts), np.log(e), 1)[0] for e in errors.T]
    assert orders == pytest.approx([order] * 4, abs=0.3)
