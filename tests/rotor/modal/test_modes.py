"""Reduced rotors: orthonormal, statically exact where asked, and converging to the full one."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from touchdown.modelkit.errors import TouchdownError
from touchdown.rotor.beams.shaft import Shaft, assembled_matrices
from touchdown.rotor.file import load_rotor, shipped_rotors
from touchdown.rotor.modal.modes import basis, flexibility, residual_flexibility
from touchdown.rotor.modal.whirl_speeds import whirl_frequencies


@pytest.fixture(params=sorted(shipped_rotors()), scope="module")
def rotor(request: pytest.FixtureRequest) -> Shaft:
    """Each shipped rotor."""
    return load_rotor(shipped_rotors()[request.param])


def seats(shaft: Shaft) -> list[int]:
    return [shaft.node("A"), shaft.node("B")]


@pytest.mark.parametrize("modes", [2, 5, 0])
@pytest.mark.parametrize("residual", [False, True])
def test_orthonormal(rotor: Shaft, modes: int, residual: bool):
    b = basis(rotor, modes, seats(rotor) if residual else ())
    m = assembled_matrices(rotor)
    n = len(b.omega)
    assert b.kept == (modes or 2 * rotor.nodes)
    assert n == b.kept + (2 if residual and modes else 0)
    assert b.shapes.T @ m.mass @ b.shapes == pytest.approx(np.eye(n), abs=1e-12)
    stiffness = b.shapes.T @ m.stiffness @ b.shapes
    assert stiffness == pytest.approx(np.diag(b.omega**2), abs=1e-10 * max(b.omega[-1], 1e4) ** 2)
    assert b.gyroscopic == pytest.approx(b.gyroscopic.T)
    assert (b.omega[:2] == 0.0).all()
    assert (np.diff(b.omega[: b.kept]) >= 0.0).all()


def test_residual_vectors_make_static_flexibility_exact(rotor: Shaft):
    at = seats(rotor)
    exact = flexibility(rotor, at)
    scale = np.abs(exact).max()
    for modes in (2, 4, 10):
        assert residual_flexibility(rotor, basis(rotor, modes, at), at) == pytest.approx(
            0.0, abs=1e-9 * scale
        )
        assert np.abs(residual_flexibility(rotor, basis(rotor, modes), at)).max() > 1e-3 * scale
    assert residual_flexibility(rotor, basis(rotor, 0), at) == pytest.approx(0.0, abs=1e-9 * scale)


def test_all_modes_are_the_full_rotor(rotor: Shaft):
    """Whirl speeds of the reduced equations with all modes and those of the matrices themselves."""
    m, speed = assembled_matrices(rotor), 1000.0
    K = m.stiffness.copy()
    supports = [(node, 1e8) for node in seats(rotor)]
    for node, k in supports:
        K[2 * node - 2, 2 * node - 2] += k
    zero, one = np.zeros_like(K), np.eye(len(K))
    inverse = np.linalg.inv(m.mass)
    full = np.linalg.eigvals(np.block([[zero, one], [inverse @ K, speed * inverse @ m.polar]]))
    assert np.abs(full.imag).max() < 1e-6 * np.abs(full.real).max()
    found = whirl_frequencies(basis(rotor, 0), [speed], supports)[0]
    assert found == pytest.approx(np.sort(full.real), rel=1e-7)


def test_reduced_whirl_speeds_converge(rotor: Shaft):
    """First forward bending, on springs at the seats; residual vectors do it with few modes."""
    supports = [(node, 1e8) for node in seats(rotor)]
    at = seats(rotor)

    def lowest(b) -> np.ndarray:
        w = whirl_frequencies(b, [1000.0], supports)[0]
        return np.sort(w[w > 0.0])[:3]

    full = lowest(basis(rotor, 0))
    errors = [np.abs(lowest(basis(rotor, n)) / full - 1.0).max() for n in (4, 8, 16, 28)]
    assert all(a > b for a, b in pairwise(errors))
    assert errors[-1] < 1e-2
    helped = np.abs(lowest(basis(rotor, 4, at)) / full - 1.0).max()
    assert helped < 0.1 * errors[0]


@pytest.mark.parametrize("modes", [1, 1000])
def test_a_number_of_modes_that_cannot_be(rotor: Shaft, modes: int):
    with pytest.raises(TouchdownError, match=rf"modes = {modes}: .* has {2 * rotor.nodes} modes per plane"):
        basis(rotor, modes)


@pytest.mark.parametrize("node", [0, 99])
def test_a_node_that_does_not_exist(rotor: Shaft, node: int):
    with pytest.raises(TouchdownError, match=rf"node {node}: .* has nodes 1 to {rotor.nodes}"):
        basis(rotor, 4, [2, node])


def test_elements_too_unlike_each_other(rotor: Shaft):
    short = replace(rotor.elements[0], length=1e-4, outer_diameter=0.5)
    long = replace(rotor.elements[0], length=2.0, outer_diameter=0.001)
    with pytest.raises(TouchdownError, match="too unlike each other"):
        basis(Shaft("odd", (short, long) * 10), 6)
