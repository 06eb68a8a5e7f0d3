"""Rotors from mass, stiffness and gyroscopic matrices: exported here as a finite-element program would."""

from __future__ import annotations

import math
import re
import shutil
from collections.abc import Callable
from io import StringIO
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from places import ROOT
from scipy import io, sparse

import touchdown
from touchdown.modelkit.errors import TouchdownError
from touchdown.rotor.beams.shaft import Shaft
from touchdown.rotor.file import rotor_named
from touchdown.rotor.imports import of_arrays, placed, read_rotor
from touchdown.rotor.imports.arrays import from_folder
from touchdown.rotor.imports.harwell_boeing import read_matrix
from touchdown.rotor.modal.modes import basis, flexibility
from touchdown.rotor.modal.whirl_speeds import whirl_frequencies
from touchdown.rotor.static_deflection import at_rest

EXAMPLE = ROOT / "examples" / "spindle_matrices"
U, R = ("UX", "UY", "UZ"), ("ROTX", "ROTY", "ROTZ")
Arrays = dict[str, Any]


def exported(shaft: Shaft, axis: int = 2, along: bool = True, unit: float = 1.0) -> Arrays:
    """Both planes of a rotor, coordinates `along` and about its `axis`, by a unit of length (m)."""
    one, N = shaft.body.matrices(), shaft.nodes
    x, y = (axis + 1) % 3, (axis + 2) % 3
    dofs = [*U, *R] if along else [U[x], U[y], R[x], R[y]]
    X, Y = (
        np.array([len(dofs) * i + dofs.index(dof) for i in range(N) for dof in plane])
        for plane in ((U[x], R[y]), (U[y], R[x]))
    )
    turned = np.tile([1.0, -1.0], N)  # rotations about x are less the slopes in the y-z plane
    data: Arrays = {name: np.zeros((len(dofs) * N,) * 2) for name in "MKG"}
    for name, matrix in (("M", one.mass), ("K", one.stiffness)):
        data[name] += np.diag(np.where(np.isin(np.arange(len(data[name])), (*X, *Y)), 0.0, 3.0))
        data[name][np.ix_(X, X)] = matrix
        data[name][np.ix_(Y, Y)] = np.outer(turned, turned) * matrix
    data["G"][np.ix_(X, Y)] = one.polar * turned
    data["G"][np.ix_(Y, X)] = -(one.polar * turned).T
    per = np.tile([unit if dof in U else 1.0 for dof in dofs], N)
    for name in "MKG":
        data[name] *= np.outer(per, per) / unit
    data["coordinates"] = np.zeros((N, 3))
    data["coordinates"][:, axis] = shaft.positions() / unit + 7.0
    return data | {"dofs": dofs, "units": "m" if unit == 1.0 else "mm"}


def imported(shaft: Shaft, **how: Any) -> touchdown.Rotor:
    """`shaft` by way of its matrices, with its stations."""
    places = {s.name: s.node for s in shaft.stations}
    held = {name: places.pop(name) for name in shaft.levitated_at}
    sensors = {s.name: s.node for s in shaft.sensors}
    rotor = touchdown.import_rotor(exported(shaft, **how), places, held, sensors)
    return touchdown.Rotor(
        **{**vars(rotor), "unbalances": shaft.unbalances, "damping_ratio": shaft.damping_ratio}
    )


@pytest.mark.parametrize(
    ("name", "how"),
    [("rotor_I", {}), ("rotor_I", {"axis": 1, "unit": 1e-3}), ("rotor_II", {"axis": 0, "along": False})],
)
def test_a_rotor_by_its_matrices_is_the_rotor(name: str, how: dict[str, Any]) -> None:
    """Also in millimetres and tonnes, and along other axes."""
    shaft, rotor = rotor_named(name), imported(rotor_named(name), **how)
    own, found = basis(shaft, 0), basis(rotor, 0)
    assert found.omega == pytest.approx(own.omega, rel=1e-9)  # found: 2e-12
    for speed in (300.0, -2000.0):
        theirs = whirl_frequencies(own, [speed])
        assert whirl_frequencies(found, [speed]) == pytest.approx(theirs, rel=1e-9, abs=1e-6)
    for size in ("mass", "centre_of_mass", "polar_inertia", "diametral_inertia"):
        assert getattr(rotor, size) == pytest.approx(getattr(shaft, size), rel=1e-12)
    seats = [s.node for s in shaft.stations]
    whole = flexibility(shaft, seats)
    assert flexibility(rotor, seats) == pytest.approx(whole, abs=1e-9 * np.max(np.abs(whole)))
    held = [(node, math.inf) for node in sorted(set(seats))]
    lying, theirs = at_rest(rotor, held), at_rest(shaft, held)
    assert lying.reactions == pytest.approx(theirs.reactions, rel=1e-6)
    assert len(lying.bending) == 0


def test_a_superelement_is_written_and_read_to_the_bit(tmp_path: Path) -> None:
    rotor = imported(rotor_named("rotor_II"))
    again = touchdown.Rotor.load(rotor.save(tmp_path / "again.toml"))
    assert again == rotor
    assert hash(again.superelement) == hash(rotor.superelement)
    assert rotor != imported(rotor_named("rotor_I"))


def test_the_example_is_the_spindle() -> None:
    """A folder of Matrix Market files, along x."""
    shaft, found = rotor_named(str(ROOT / "examples" / "spindle_rotor.toml")), read_rotor(EXAMPLE)
    assert basis(found, 0).omega == pytest.approx(basis(shaft, 0).omega, rel=1e-9)
    assert found.polar_inertia == pytest.approx(shaft.polar_inertia, rel=1e-12)


def test_matrices_may_be_sparse_dofs_floats_and_digits_few() -> None:
    """What NumPy and SciPy make of text files; single precision moves the first modes by its digits."""
    shaft = rotor_named("rotor_I")
    data = exported(shaft)
    own = basis(shaft, 6).omega[2:]
    data["dofs"] = np.array([[node + 1.0, dof + 1.0] for node in range(shaft.nodes) for dof in range(6)])
    found = of_arrays(data | {name: sparse.csr_array(data[name]) for name in "MKG"}, "sparse", "sparse")
    assert basis(found, 6).omega[2:] == pytest.approx(own, rel=1e-9)
    rounded = of_arrays(data | {name: data[name].astype(np.float32) for name in "MKG"}, "single", "single")
    assert basis(rounded, 6).omega[2:] == pytest.approx(own, rel=1e-3)


def test_a_drop_of_the_matrices_is_that_of_the_beams() -> None:
    """To rounding, until rounding decides how the rotor bounces off: it touches at 9 ms; found to 15 ms."""
    shaft = rotor_named("rotor_I")
    scene = touchdown.load("rotor1-9000").set({"run.duration": "10 ms"})
    own, found = (touchdown.run(s, in_process=True) for s in (scene, scene.swap(rotor=imported(shaft))))
    for place in ("A.x", "A.y", "B.x", "B.y"):
        name = f"rotor.{place}"
        apart = np.abs(found.data[name].values - own.data[name].values)
        assert apart.max() < 1e-9  # m; found: 9e-11
    for end in "AB":
        peak = f"seats.{end}.peak_contact_force"
        assert own.flat[peak] > 100.0
        assert found.flat[peak] == pytest.approx(own.flat[peak], rel=1e-5)
    assert not any("stress" in key for key in found.summary["components"]["rotor"])
    assert "peak_bending_stress" in own.summary["components"]["rotor"]


def changed(name: str, row: int, column: int, value: float) -> Callable[[Arrays], None]:
    """What puts a value into a matrix."""

    def change(data: Arrays) -> None:
        data[name][row, column] = value

    return change


def spring(data: Arrays) -> None:
    for row in (0, 1):
        data["K"][row, row] += 1e6


def lumped(data: Arrays) -> None:
    data["M"] = np.diag(np.diag(data["M"]))
    for row in range(3, len(data["M"]), 6):
        data["M"][row, row] = data["M"][row + 1, row + 1] = 0.0


def coupled(data: Arrays) -> None:
    data["K"][0, 2] = data["K"][2, 0] = 1e8


def gone(name: str) -> Callable[[Arrays], object]:
    return lambda data: data.pop(name)


def given(**values: Any) -> Callable[[Arrays], None]:
    return lambda data: data.update(values)


def times(name: str, factor: float) -> Callable[[Arrays], None]:
    return lambda data: data.update({name: factor * np.asarray(data[name])})


def grounded(data: Arrays) -> None:
    data["C"] = np.zeros_like(data["K"])
    data["C"][[0, 1], [0, 1]] = 1e3


def few_digits(data: Arrays) -> None:
    """Six, of which the entries of K leave nothing for what its rigid motions take."""
    for name in "MKG":
        data[name] = np.array([[float(f"{value:.5e}") for value in row] for row in data[name]])


def kilograms_and_millimetres(data: Arrays) -> None:
    data.update(exported(rotor_named("rotor_I"), unit=1e-3))
    data["M"] *= 1e3
    data["G"] *= 1e3


def planes(data: Arrays) -> None:
    data["K"][0, 0] *= 1.01


def between(data: Arrays) -> None:
    data["K"][0, 1] = data["K"][1, 0] = 1e8


def mass_damped(data: Arrays) -> None:
    data["C"] = 50.0 * data["M"]


def hinged(data: Arrays) -> None:
    """Two halves that are not fastened to each other."""
    half = 6 * (len(data["coordinates"]) // 2)
    for block in (np.s_[:half, half:], np.s_[half:, :half]):
        data["K"][block] = 0.0


MISTAKES = [
    (gone("G"), "G is missing"),
    (gone("dofs"), "dofs is missing"),
    (gone("coordinates"), "coordinates is missing"),
    (given(unit="mm"), "unit is not known; did you mean units"),
    (given(units="inch"), "units = 'inch' is not known"),
    (given(M=np.ones((3, 4))), "M is 3 by 4; it must be square"),
    (given(K=np.ones((3, 3))), "K is 3 by 3; it must be"),
    (given(K=[["a"]]), "K must be an array of real numbers"),
    (given(dofs=["UX", "UY"]), "dofs are 40 by 2, and M has 120 rows"),
    (given(dofs="UX"), "dofs are 20 by 2, and M has 120 rows"),
    (given(dofs=[{}]), "dofs must be an array of texts or whole numbers"),
    (given(units="mm"), 'so it is units = "m"'),
    (times("coordinates", -1.0), "the coordinates run against the axis of the matrices"),
    (times("coordinates", 1e3), "the coordinates are in mm, the matrices in kg, m, s, N"),
    (few_digits, "some motion would have less energy than none; export the rotor free"),
    (kilograms_and_millimetres, "kg on 0.3097 m is out of proportion, look at the units"),
    (mass_damped, "alpha M (alpha = 50 1/s), which damps rigid motion, too"),
    (times("K", 1e-12), "the first bending mode has"),
    (given(dofs=["UX", "UY", "UZ", "ROTX", "ROTY", "PHI"]), "PHI is not known; they are 1 to 6"),
    (given(dofs=["UX", "UY", "UZ", "ROTX", "ROTY", "UX"]), "UX of node 1 is there twice"),
    (given(dofs=["UY", "UX", "UZ", "ROTX", "ROTY", "ROTZ"]), "are the dofs in the order of the rows?"),
    (given(dofs=["UX", "ROTY", "UZ", "ROTX", "UY", "ROTZ"]), "are the dofs in the order of the rows?"),
    (given(nodes=[1, 2]), "nodes must be"),
    (changed("M", 0, 0, math.nan), "M holds what is not a finite number, first at [1, 1]"),
    (changed("M", 0, 7, 1.0), "M is not symmetric: 1 between UX of node 1 and UY of node 2, 0 between"),
    (changed("G", 3, 4, 5.0), "G is not skew-symmetric: 5 between ROTX of node 1 and ROTY of node 1"),
    (changed("coordinates", 3, 0, 0.01), "away from a line along Z"),
    (changed("coordinates", 3, 2, 7.0), "two nodes are at 7 along Z"),
    (times("coordinates", 1e5), "m, which is out of proportion; look at the units"),
    (times("coordinates", 10.0), "K holds the rotor: tilted as a whole it swings at"),
    (times("G", -1.0), "G has a polar inertia of -"),
    (times("G", 942.0), "G is per spin speed, in rad/s"),
    (times("G", 0.0), "G has no polar inertia"),
    (times("M", -1.0), "for UX of node 1, where a mass must be"),
    (times("K", -1.0), "K is not positive"),
    (spring, "K holds the rotor: moved sideways as a whole it swings at"),
    (hinged, "K holds the rotor"),
    (lumped, "M has 0 for ROTY of node 1, where a mass must be; export a consistent"),
    (planes, "K is not the same in both planes"),
    (coupled, "K couples bending to motion along the axis or about it"),
    (between, "K couples the planes"),
    (grounded, "C damps the rotor as a whole"),
]


@pytest.mark.parametrize(("spoil", "says"), MISTAKES, ids=[says[:40] for _, says in MISTAKES])
def test_a_mistake_is_told_in_one_line(spoil: Callable[[Arrays], object], says: str) -> None:
    data = exported(rotor_named("rotor_I"))
    spoil(data)
    with pytest.raises(TouchdownError) as error:
        of_arrays(data, "rotor.npz", "rotor")
    told = str(error.value)
    assert told.startswith("rotor.npz: ")
    assert says in told
    assert "\n" not in told


def test_a_place_that_is_no_node_is_refused() -> None:
    with pytest.raises(touchdown.TouchdownError, match=r"not a node .* the nearest is node 4 at 40 mm"):
        touchdown.import_rotor(EXAMPLE, {"A": "41 mm"})
    assert placed(read_rotor(EXAMPLE), {"A": "40 mm"}).node("A") == 4


def test_a_place_may_be_what_the_file_calls_its_node() -> None:
    data = exported(rotor_named("rotor_I"))
    count = len(data["coordinates"])
    data["nodes"] = np.arange(count) + 101
    rotor = touchdown.import_rotor(data, {"A": 103, "B": 18})
    assert (rotor.node("A"), rotor.node("B")) == (3, 18)
    assert "A at node 3 (called 103), B at node 18 (called 118)" in repr(rotor)
    data["nodes"] = [f"N{i}" for i in range(count)]
    assert touchdown.import_rotor(data, {"A": "N2"}).node("A") == 3
    data["nodes"] = np.arange(count)[::-1] + 1
    with pytest.raises(touchdown.TouchdownError, match=rf"node 3 along the axis, called {count - 2}, at"):
        touchdown.import_rotor(data, {"A": 3})


def test_folders_and_archives_that_cannot_be_read_are_told(tmp_path: Path) -> None:
    def refused(path: Path, says: str) -> None:
        with pytest.raises(TouchdownError, match=says):
            read_rotor(path)

    refused(tmp_path, r"has no M\.mtx")
    for name in "MKG":
        io.mmwrite(tmp_path / f"{name}.mtx", sparse.eye_array(8))
    refused(tmp_path, "cannot read .*nodes.csv")
    nodes = tmp_path / "nodes.csv"
    nodes.write_text("node, x [mm], y [mm]\n1, 0, 0\n")
    refused(tmp_path, "needs node, x, y, z")
    nodes.write_text("node, x, y, z\n1, 0, 0, 0\n")
    refused(tmp_path, "line 1: x has no unit")
    nodes.write_text("node, x [mm], y [mm], z [mm]\n1, 0, 0, 0\n2, 0, 0\n")
    refused(tmp_path, "line 3: z is missing")
    nodes.write_text("node, x [mm], y [mm], z [mm]\n1, 0, 0, 0\n2, a, 0, 0\n")
    refused(tmp_path, "row 3: x = 'a 1'|is not a number")
    nodes.write_text("node, x [mm], y [mm], z [mm]\n1, 0, 0, 0\n2, 0, 0, 5\n")
    (tmp_path / "dofs.csv").write_text("row\nUX\n")
    refused(tmp_path, "the column .row. is not known")
    (tmp_path / "K.mtx").write_text("nothing\n")
    refused(tmp_path, "K.mtx: is not read as Matrix Market text|K.mtx: cannot be read")
    (tmp_path / "no.npz").write_text("nothing\n")
    refused(tmp_path / "no.npz", "is damaged or not an archive of NumPy")
    np.savez(tmp_path / "other.npz", A=1.0)
    refused(tmp_path / "other.npz", "holds neither matrices")


def harwell_boeing(matrix: np.ndarray, kind: str = "RUA", per: int = 1, force: bool = False) -> str:
    """As HBMAT of ANSYS writes a matrix; others write several numbers on a line. force: with its F."""
    n, symmetric = len(matrix), kind[1] in "SZ"
    rows = [[i for i in np.flatnonzero(matrix[:, j]) if i >= j or not symmetric] for j in range(n)]
    pointers = np.cumsum([1, *map(len, rows)])
    places = [(i, j) for j, column in enumerate(rows) for i in column]

    def real(value: float) -> str:
        digits, _, exponent = f"{value:.14E}".partition("E")
        letter = "" if abs(int(exponent)) > 98 else "D"
        text = f"{digits.replace('-', '').replace('.', '')}{letter}{int(exponent) + 1:+03d}"
        return f"{'-' if value < 0.0 else ''}0.{text}"

    numbers: list[list[str]] = [
        [f"{pointer:14d}" for pointer in pointers],
        [f"{i + 1:14d}" for i, _ in places],
        [f"{real(matrix[place]):>25}" for place in places],
        [f"{real(1.0):>25}"] * n if force else [],
    ]
    cards = [["".join(part[k : k + per]) for k in range(0, len(part), per)] for part in numbers]
    count = "" if per == 1 else str(per)
    head = [
        "Stiffness matrix from ANSYS FULL file dumped into Harwell-Boeing format".ljust(80),
        "".join(f"{size:14d}" for size in (sum(map(len, cards)), *map(len, cards))),
        f"{kind:14}{n:14d}{n:14d}{len(places):14d}{0:14d}",
        f"{f'({count}I14)':16}{f'({count}I14)':16}{f'({count}d25.15)':20}{f'({count}d25.15)':20}",
        *([f"{'F':14}{1:14d}{0:14d}"] if force else []),
    ]
    return "\n".join([*head, *(line for part in cards for line in part)]) + "\n"


def same_superelement(found: Shaft, expected: Shaft) -> None:
    for part in ("mass_matrix", "stiffness_matrix", "polar_matrix"):
        np.testing.assert_allclose(
            getattr(found.superelement, part), getattr(expected.superelement, part), rtol=1e-12, atol=1e-9
        )


@pytest.mark.parametrize(
    ("ending", "gyroscopic", "per", "force"),
    [("hb", "RUA", 1, False), ("HB", "RUA", 3, True), ("matrix", "RZA", 1, True)],
)
def test_a_folder_of_harwell_boeing_files_is_the_same_rotor(
    ending: str, gyroscopic: str, per: int, force: bool, tmp_path: Path
) -> None:
    """Matrices by a triangle, with right-hand sides; rows as HBMAT maps them."""
    shutil.copy(EXAMPLE / "nodes.csv", tmp_path)
    for name, kind in zip("MKG", ("RSA", "RSA", gyroscopic), strict=True):
        matrix = io.mmread(EXAMPLE / f"{name}.mtx").toarray()
        (tmp_path / f"{name}.{ending}").write_text(harwell_boeing(matrix, kind, per, force))
    nodes = [line.split(",")[0] for line in (EXAMPLE / "nodes.csv").read_text().splitlines()[1:]]
    rows = [f"{int(node):14d}    {dof}" for node in nodes for dof in ("UY", "UZ", "ROTY", "ROTZ")]
    mapping = [
        f"{'Matrix Eqn':>14}{'Node':>14}    DOF",
        *(f"{i:14d}{row}" for i, row in enumerate(rows, 1)),
    ]
    (tmp_path / "K.mapping").write_text("\n".join(mapping))
    (tmp_path / "M.MAPPING").write_text("\n".join(mapping))
    same_superelement(from_folder(tmp_path), from_folder(EXAMPLE))
    for lines, says in (
        ([*mapping[:-1], mapping[2]], f"M.MAPPING, line {len(mapping)}: is not equation {len(rows)}, node"),
        (mapping[:1], r"M.MAPPING: has no line of equation, node and DOF"),
        (mapping[:-4], r"M.MAPPING and K.mapping differ"),
    ):
        (tmp_path / "M.MAPPING").write_text("\n".join(lines))
        with pytest.raises(TouchdownError, match=says):
            from_folder(tmp_path)
    shutil.copy(EXAMPLE / "dofs.csv", tmp_path)  # is taken before them
    same_superelement(from_folder(tmp_path), from_folder(EXAMPLE))
    shutil.copy(EXAMPLE / "K.mtx", tmp_path)
    with pytest.raises(TouchdownError, match=rf"has K.{ending} and K.mtx; leave one"):
        from_folder(tmp_path)


def test_harwell_boeing_text_of_others(tmp_path: Path) -> None:
    path, matrix = tmp_path / "K.hb", np.array([[2.0, -1e-120], [-1e-120, -4.5e10]])
    written = StringIO()
    io.hb_write(written, sparse.csc_matrix(matrix.round()))
    path.write_text(written.getvalue())
    np.testing.assert_array_equal(read_matrix(path), matrix.round())
    scaled = harwell_boeing(matrix).replace("(d25.15)", "(1P,1E25.15)").replace("D", "E")
    whole = harwell_boeing(matrix).replace("RUA", "RSA")  # both triangles of a symmetric one
    touching = re.sub(" {3}(?=[ -]0[.])", "", harwell_boeing(matrix, per=2)).replace("25.15", "22.15")
    assert re.search(r"\d-0", touching)
    for text in (scaled, harwell_boeing(matrix, "RSA", 2), whole, touching):
        path.write_text(text)
        np.testing.assert_allclose(read_matrix(path), matrix, rtol=1e-14)
    good = harwell_boeing(matrix)
    for text, says in (
        ("nothing", r"K\.hb: cannot be read"),
        (good.replace("RUA", "CUA"), "it is CUA, 2 by 2; it must be a real, assembled matrix"),
        (good.replace("RUA", "PUA"), "it is PUA, 2 by 2"),
        (good[: good.rindex("-0.")].rstrip(), "it holds 3 of 4 numbers"),
        (good.replace(f"{5:14d}\n", f"{6:14d}\n"), "cannot be read"),
        ("\0\1" * 300, "Form ASCII"),
    ):
        assert text != good
        path.write_text(text)
        with pytest.raises(TouchdownError, match=says):
            read_matrix(path)


def test_rows_may_come_in_any_order_and_nodes_by_any_name(tmp_path: Path) -> None:
    data = exported(rotor_named("rotor_I"))
    nodes = [f"N{3 * i}" for i in range(len(data["coordinates"]))]
    whole = np.array([[node, str(1 + i)] for node in nodes for i in range(6)])
    mixed = np.random.default_rng(1).permutation(len(whole))
    turned = np.random.default_rng(2).permutation(len(nodes))
    data |= {name: data[name][np.ix_(mixed, mixed)] for name in "MKG"}
    data |= {"dofs": whole[mixed], "nodes": np.array(nodes)[turned]}
    data["coordinates"] = data["coordinates"][turned]
    np.savez(tmp_path / "mixed.npz", **data)
    found = read_rotor(tmp_path / "mixed.npz")
    assert found.superelement == of_arrays(exported(rotor_named("rotor_I")), "own", "").superelement
    assert "those called N0, N3, N6" in found.about


def test_damping_of_the_free_rotor_becomes_a_ratio() -> None:
    shaft = rotor_named("rotor_I")
    data = exported(shaft)
    stiffness_share = 1e-6  # s
    data["C"] = stiffness_share * data["K"]
    found = of_arrays(data, "rotor.npz", "damped")
    first = basis(shaft, 3).omega[2]
    assert found.damping_ratio == pytest.approx(0.5 * stiffness_share * first, rel=1e-9)
    assert f"{50.0 * stiffness_share * first:.3g} %" in found.about
