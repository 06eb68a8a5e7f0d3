"""Modes and Campbell lines of the shipped rotors against ROSS, where it is installed.

ROSS knows no sleeves. An element is given to it as parallel elements on the same nodes: one carries
the stiffness (a solid section with the EI and kGA of core and sleeve together, without mass), the
others the mass and rotary inertia of core and sleeve (without stiffness). These take their shape
functions from their own shear parameter, so their shear modulus is chosen to make it the carrier's.
Matrices are ROSS's own, their lateral part is solved here: as it stands, a free rotor.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

from touchdown.rotor.beams.element import Element, cowper
from touchdown.rotor.beams.shaft import Shaft
from touchdown.rotor.file import load, shipped
from touchdown.rotor.modal.modes import basis
from touchdown.rotor.modal.whirl_speeds import whirl_frequencies

ross = pytest.importorskip("ross")

NOTHING = 1e-9  # times a density or a modulus
BENDING = 8  # modes compared
AGREE = 1e-4  # relative; found: 2e-10 (rotor I) and 1e-5 (rotor II, whose laminations have no stiffness)
SPEEDS = {"rotor_I": 18000.0, "rotor_II": 10000.0}  # rpm


def ross_rotor(shaft: Shaft):
    """The shaft as ROSS sees it."""
    elements = [part for i, e in enumerate(shaft.elements) for part in _parallel(i, e)]
    discs = [
        ross.DiskElement(n=p.node - 1, m=p.mass, Id=p.diametral_inertia, Ip=p.polar_inertia)
        for p in shaft.points
    ]
    return ross.Rotor(elements, discs)


def _parallel(n: int, e: Element) -> list:
    if not e.sleeve_diameter:
        steel = ross.Material("core", rho=e.density, E=e.modulus, Poisson=e.poisson)
        return [_element(n, e.length, e.inner_diameter, e.outer_diameter, steel)]
    assert e.inner_diameter == 0.0  # the carrier below is solid
    EA = e.kGA * 2.0 * (1.0 + e.poisson) / e.kappa
    diameter = 4.0 * math.sqrt(e.EI / EA)
    modulus = EA / (math.pi / 4.0 * diameter**2)
    carrier = ross.Material("carrier", rho=NOTHING * e.density, E=modulus, Poisson=e.poisson)
    parts = [_element(n, e.length, 0.0, diameter, carrier)]
    for inner, outer, density in (
        (0.0, e.outer_diameter, e.density),
        (e.outer_diameter, e.sleeve_diameter, e.sleeve_density),
    ):
        E = NOTHING * modulus
        mass = ross.Material("mass", rho=density, E=E, G_s=E / _modulus_ratio(e, inner, outer))
        parts.append(_element(n, e.length, inner, outer, mass))
    return parts


def _modulus_ratio(e: Element, inner: float, outer: float) -> float:
    """E/G that gives a section the shear parameter of `e`; Cowper's factor depends on it in turn."""
    ratio = 2.0 * (1.0 + e.poisson)
    gyration = (outer**2 + inner**2) / 16.0
    for _ in range(200):
        ratio = e.phi * cowper(0.5 * ratio - 1.0, inner / outer) * e.length**2 / (12.0 * gyration)
    return ratio


def _element(n: int, length: float, inner: float, outer: float, material):
    return ross.ShaftElement(L=length, idl=inner, odl=outer, material=material, n=n)


def lateral(rotor) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """M, K and G of ROSS without the axial and torsional coordinates."""
    keep = [6 * node + i for node in range(len(rotor.nodes)) for i in (0, 1, 3, 4)]
    return tuple(matrix[np.ix_(keep, keep)] for matrix in (rotor.M(0), rotor.K(0), rotor.G()))


def ross_lines(rotor, speed: float) -> np.ndarray:
    """Whirl frequencies (rad/s, no sign), ascending."""
    M, K, G = lateral(rotor)
    zero, inverse = np.zeros_like(M), np.linalg.inv(M)
    found = np.linalg.eigvals(np.block([[zero, np.eye(len(M))], [-inverse @ K, -speed * inverse @ G]]))
    return np.sort(found.imag[found.imag > 0.0])


@pytest.mark.parametrize("name", sorted(SPEEDS))
@pytest.mark.parametrize("share", [0.0, 0.5, 1.0])
def test_lines_of_the_campbell_diagram(name: str, share: float):
    shaft = load(shipped()[name])
    speed = share * SPEEDS[name] * 2.0 * math.pi / 60.0
    ours = np.sort(np.abs(whirl_frequencies(basis(shaft, 0), [speed])[0]))
    lowest = 0.5 * basis(shaft, 3).omega[2]  # below: rigid modes
    ours = ours[ours > lowest][: 2 * BENDING]
    theirs = ross_lines(ross_rotor(shaft), speed)
    theirs = theirs[theirs > lowest][: 2 * BENDING]
    assert ours == pytest.approx(theirs, rel=AGREE)


@pytest.mark.parametrize("name", sorted(SPEEDS))
def test_mass_and_inertia(name: str):
    shaft = load(shipped()[name])
    M, _, G = lateral(ross_rotor(shaft))
    sideways = np.zeros(len(M))
    sideways[0::4] = 1.0
    assert sideways @ M @ sideways == pytest.approx(shaft.mass, rel=1e-6)
    turn_x, turn_y = np.zeros(len(M)), np.zeros(len(M))
    z = shaft.positions() - shaft.centre_of_mass
    turn_x[1::4], turn_x[2::4] = -z, 1.0
    turn_y[0::4], turn_y[3::4] = z, 1.0
    assert turn_x @ M @ turn_x == pytest.approx(shaft.diametral_inertia, rel=1e-6)
    assert abs(turn_x @ G @ turn_y) == pytest.approx(shaft.polar_inertia, rel=1e-6)
