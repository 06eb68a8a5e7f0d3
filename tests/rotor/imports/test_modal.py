"""Rotors from modal data: the free modes of one plane, and what they do not hold."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from touchdown.modelkit.errors import TouchdownError
from touchdown.rotor.beams.shaft import Shaft
from touchdown.rotor.file import rotor_named
from touchdown.rotor.imports import of_arrays, read_rotor
from touchdown.rotor.modal.modes import basis

Arrays = dict[str, Any]
MODES = 7


def exported(shaft: Shaft, modes: int = MODES) -> Arrays:
    """Mass-normalised modes of a rotor."""
    kept = basis(shaft, modes)
    return {
        "positions": shaft.positions(),
        "frequencies": kept.omega / (2.0 * math.pi),
        "deflections": kept.shapes[0::2],
        "slopes": kept.shapes[1::2],
        "gyroscopic": kept.gyroscopic,
    }


@pytest.mark.parametrize("name", ["rotor_I", "rotor_II"])
def test_a_rotor_by_its_modes_has_them(name: str, tmp_path: Path) -> None:
    shaft = rotor_named(name)
    kept = basis(shaft, MODES)
    np.savez(tmp_path / "modes.npz", **exported(shaft))
    found = read_rotor(tmp_path / "modes.npz")
    again = basis(found, 0)
    assert again.omega == pytest.approx(kept.omega, rel=1e-9)  # found: 2e-15
    assert again.gyroscopic == pytest.approx(kept.gyroscopic, abs=1e-9 * np.max(kept.gyroscopic))
    for size in ("mass", "centre_of_mass", "polar_inertia", "diametral_inertia"):
        assert getattr(found, size) == pytest.approx(getattr(shaft, size), rel=1e-9)
    assert "What modes beyond" in found.about
    assert f"mass {shaft.mass:.4g} kg, as the modes say" in found.about


def test_scale_order_and_the_shapes_of_rigid_modes_do_not_matter() -> None:
    """Modal masses of any size, frequencies in any order, rigid modes that move and tilt at once."""
    shaft = rotor_named("rotor_II")
    data = exported(shaft)
    turn = np.eye(MODES)
    turn[:2, :2] = [[0.6, -0.8], [0.8, 0.6]]
    masses = np.linspace(0.5, 4.0, MODES)
    change = (turn * np.sqrt(masses))[:, ::-1]
    mixed = {name: data[name] @ change for name in ("deflections", "slopes")}
    mixed |= {"gyroscopic": change.T @ data["gyroscopic"] @ change, "modal_masses": masses[::-1]}
    found = of_arrays(data | mixed | {"frequencies": data["frequencies"][::-1]}, "mixed", "mixed")
    own, again = basis(shaft, MODES), basis(found, 0)
    assert found.mass == pytest.approx(shaft.mass, rel=1e-9)
    assert again.omega == pytest.approx(own.omega, rel=1e-9)
    assert again.shapes == pytest.approx(own.shapes, abs=1e-9 * np.max(np.abs(own.shapes)))


def few(shaft: Shaft, nodes: int, modes: int) -> Arrays:
    """Modes of `shaft` at few of its nodes, from the first to the last."""
    kept = np.linspace(0, shaft.nodes - 1, nodes).round().astype(int)
    data = exported(shaft, modes)
    return data | {name: data[name][kept] for name in ("positions", "deflections", "slopes")}


@pytest.mark.parametrize(("nodes", "modes"), [(3, 8), (4, 10)])
def test_few_nodes_may_have_many_modes(nodes: int, modes: int) -> None:
    """More than they have coordinates, where bending modes together look like a rigid motion."""
    shaft = rotor_named("rotor_I")
    found = of_arrays(few(shaft, nodes, modes), "few", "few")
    for size in ("mass", "centre_of_mass", "polar_inertia", "diametral_inertia"):
        assert getattr(found, size) == pytest.approx(getattr(shaft, size), rel=1e-9)


def test_gyroscopics_may_be_inertias_of_the_nodes() -> None:
    shaft = rotor_named("rotor_I")
    data = exported(shaft)
    inertias = np.linspace(1e-5, 3e-5, shaft.nodes)
    slopes = data["slopes"]
    del data["gyroscopic"]
    found = of_arrays(data | {"polar_inertias": inertias}, "own", "own")
    assert found.polar_inertia == pytest.approx(inertias.sum(), rel=1e-9)
    made = basis(found, 0).gyroscopic[1:, 1:]
    assert made == pytest.approx((slopes.T @ (inertias[:, None] * slopes))[1:, 1:], abs=1e-9)


def given(**values: Any) -> Callable[[Arrays], None]:
    return lambda data: data.update(values)


def gone(name: str) -> Callable[[Arrays], object]:
    return lambda data: data.pop(name)


def times(name: str, factor: float) -> Callable[[Arrays], None]:
    return lambda data: data.update({name: factor * data[name]})


def largest_is_one(data: Arrays) -> None:
    largest = np.abs(data["deflections"]).max(axis=0)
    for name in ("deflections", "slopes"):
        data[name] = data[name] / largest


def bending_only(data: Arrays) -> None:
    data["frequencies"] = data["frequencies"][2:]
    for name in ("deflections", "slopes"):
        data[name] = data[name][:, 2:]


MISTAKES = [
    (gone("gyroscopic"), "give one of gyroscopic (n by n) and polar_inertias"),
    (given(deflections=np.ones((3, MODES))), f"deflections is 3 by {MODES}; it must be"),
    (given(gyroscopic=np.arange(49.0).reshape(7, 7)), "G is not symmetric in a plane"),
    (
        largest_is_one,
        "every mode has the largest deflection 1, so they are not mass-normalised: give modal",
    ),
    (bending_only, "a free rotor has two rigid modes of 0 Hz in a plane"),
    (times("slopes", -1.0), "slopes with the sign of dx/dz"),
    (times("positions", 10.0), "is a tilt of the rigid rotor"),
    (times("gyroscopic", -1.0), "its sign is the other one"),
]


@pytest.mark.parametrize(("spoil", "says"), MISTAKES, ids=[says[:40] for _, says in MISTAKES])
def test_a_mistake_is_told_in_one_line(spoil: Callable[[Arrays], object], says: str) -> None:
    data = exported(rotor_named("rotor_II"))
    spoil(data)
    with pytest.raises(TouchdownError) as error:
        of_arrays(data, "modes.npz", "modes")
    told = str(error.value)
    assert told.startswith("modes.npz: ")
    assert says in told
    assert "\n" not in told


def test_two_modes_are_no_flexible_rotor() -> None:
    with pytest.raises(TouchdownError, match="2 modes hold no bending mode"):
        of_arrays(exported(rotor_named("rotor_I"), 2), "modes.npz", "modes")
