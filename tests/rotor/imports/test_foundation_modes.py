"""Modes of foundations from matrices and from modal data."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from places import ROOT

from touchdown.modelkit.errors import TouchdownError
from touchdown.rotor.imports.arrays import read_folder
from touchdown.rotor.imports.foundation_modes import of_foundation, read_foundation

EXAMPLE = ROOT / "examples" / "frame_matrices"
SEATS = {"A": "2", "B": "4"}


def example() -> dict[str, Any]:
    return read_folder(EXAMPLE, ("M", "K"))


def test_modes_of_a_frame() -> None:
    """Two pedestals that move alike on a frame are a pedestal on a half of it: closed form, in x and y."""
    found = read_foundation(EXAMPLE, SEATS, 8, 0.02)
    assert len(found.omega) == 8
    assert found.left_out == pytest.approx(0.0, abs=1e-12)
    for axis, ground, pedestal in ((0, 2e7, 5e7), (1, 5e7, 1.5e8)):
        # m1 (base, 6 kg) on `ground`, m2 (1.5 kg) on it by `pedestal`
        a, b, c = (ground + pedestal) / 6.0, pedestal / 1.5, pedestal**2 / 9.0
        squares = np.roots([1.0, -(a + b), a * b - c])
        a_side, b_side = found.shape[:, 0, axis], found.shape[:, 1, axis]
        alike = np.isclose(a_side, b_side) & (a_side != 0.0)
        assert np.sort(found.omega[alike] ** 2) == pytest.approx(np.sort(squares), rel=1e-9)
    assert np.all(found.damping_ratio == 0.02)
    # what the seats give way by at rest is that of the matrices
    data = example()
    at = [2, 3, 6, 7]
    rest = np.linalg.inv(data["K"])[np.ix_(at, at)]
    shape = found.shape.reshape(8, 4)
    assert np.einsum("mi,mj,m->ij", shape, shape, found.omega**-2.0) == pytest.approx(
        rest, rel=1e-9, abs=1e-15
    )


def test_the_slowest_are_taken_and_the_rest_is_said() -> None:
    few = read_foundation(EXAMPLE, SEATS, 4, 0.01)
    all_of_them = read_foundation(EXAMPLE, SEATS, 8, 0.01)
    np.testing.assert_allclose(few.omega, all_of_them.omega[:4])
    assert few.left_out == pytest.approx(0.21, abs=0.01)


def test_other_units_massless_rows_damping_and_modal_data_tell_the_same(tmp_path: Path) -> None:
    """t, mm and N; a node without a mass; C of 2 zeta/omega times K's part; modes themselves."""
    data, plain = example(), read_foundation(EXAMPLE, SEATS, 8, 0.01)
    in_mm = data | {"M": data["M"] * 1e-3, "K": data["K"] * 1e-3, "units": "mm"}
    np.testing.assert_allclose(of_foundation(in_mm, "", SEATS, 8, 0.01).shape, plain.shape, atol=1e-9)
    nodes = np.append(data["nodes"], "5")
    padded = {name: np.pad(data[name], (0, 2)) for name in "MK"}
    padded["K"][[8, 9], [8, 9]] = 1e8
    massless = {**padded, "nodes": nodes, "dofs": data["dofs"]}
    np.testing.assert_allclose(of_foundation(massless, "", SEATS, 8, 0.01).omega, plain.omega)
    damped = of_foundation(data | {"C": 1e-5 * data["K"]}, "", SEATS, 8, 0.01)
    np.testing.assert_allclose(damped.damping_ratio, 0.5e-5 * plain.omega, rtol=1e-9)
    modal = {"frequencies": plain.omega / (2.0 * np.pi), "nodes": ["2", "4"]}
    modal |= {"xy"[k]: plain.shape[:, :, k].T * np.sqrt(3.0) for k in range(2)}
    np.savez(tmp_path / "modes.npz", **modal, modal_masses=np.full(8, 3.0))
    again = read_foundation(tmp_path / "modes.npz", SEATS, 8, 0.03)
    np.testing.assert_allclose(again.shape, plain.shape, atol=1e-9)
    assert np.all(again.damping_ratio == 0.03)
    assert again.left_out is None


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        ({"K": np.diag([0.0, *[1.0] * 7])}, "K is not positive definite"),
        ({"K": np.triu(np.ones((8, 8)))}, "K is not symmetric"),
        ({"M": np.eye(6)}, "M has 6 rows, K 8"),
        ({"dofs": ["UX", "UZ"]}, "UY of node 2 is missing"),
        ({"nodes": ["1", "2", "3", "3"]}, "nodes must be 4 different"),
        ({"C": -np.eye(8)}, "C: damping ratios must be from 0"),
        ({"G": np.eye(8)}, "G is not known"),
    ],
)
def test_what_is_no_foundation(changes: dict[str, Any], says: str) -> None:
    with pytest.raises(TouchdownError, match=says):
        of_foundation(example() | changes, "frame", SEATS, 8, 0.01)


def test_places_and_files_that_are_not_there(tmp_path: Path) -> None:
    with pytest.raises(TouchdownError, match="there is no node 9; there are: 1, 2, 3, 4"):
        read_foundation(EXAMPLE, {"A": "9"}, 8, 0.01)
    with pytest.raises(TouchdownError, match=r"has no M\.mtx or M\.hb or M\.matrix; there must be M and K"):
        read_foundation(tmp_path, SEATS, 8, 0.01)
    with pytest.raises(TouchdownError, match="foundations are imported from archives"):
        read_foundation(tmp_path / "frame.csv", SEATS, 8, 0.01)
