"""Rotors of ROSS: its published examples by its own frequencies, its objects, and what cannot be imported.

The files in validation/ross are ROSS's; `benchmarks/ross_rotors.py` makes them.
"""

from __future__ import annotations

import json
from copy import deepcopy
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from places import ROOT

from touchdown.modelkit.errors import TouchdownError
from touchdown.rotor.beams.beam_body import PointMass
from touchdown.rotor.beams.shaft import Shaft, Support
from touchdown.rotor.file import parse_rotor, rotor_text
from touchdown.rotor.imports import from_ross, read_rotor
from touchdown.rotor.imports.ross import of_elements

SAVED = ROOT / "validation" / "ross"
THEIRS = json.loads((SAVED / "frequencies.json").read_text(encoding="utf-8"))["hz"]
STEEL = {"name": "Steel", "rho": 7810.0, "E": 211e9, "G_s": 81.2e9, "color": "#525252"}
SHAFT = {"L": 0.1, "idl": 0.0, "odl": 0.05, "material": STEEL}
SOFT = {**STEEL, "E": 1e4, "G_s": 1e4}
OLD: dict[str, dict[str, Any]] = {  # as versions before 2.0 wrote them
    "parameters": {},
    "ShaftElement_ShaftElement 0": {**SHAFT, "idr": 0.01, "odr": 0.06, "n": 0},
    "ShaftElement_ShaftElement 1": {**SHAFT, "n": 1},
    "ShaftElement_sleeve": {**SHAFT, "idl": 0.05, "odl": 0.07, "n": 1, "material": SOFT},
    "DiskElement_Disk 0": {"n": 2, "m": 3.0, "Id": 0.01, "Ip": 0.02, "tag": "Disk 0"},
    "BearingElement_Bearing 0": {"n": 0, "kxx": [1e6], "kyy": [2e6], "cxx": [0.0], "cyy": [5.0]},
    "BearingElement_Bearing 1": {"n": 2, "kxx": [1e6, 3e6], "cxx": [0.0, 0.0], "frequency": [0.0, 100.0]},
}


@pytest.mark.parametrize("name", THEIRS)
def test_an_imported_rotor_can_be_written(name: str) -> None:
    shaft = read_rotor(SAVED / f"{name}.toml", speed=100.0)
    assert parse_rotor(rotor_text(shaft), "again") == shaft


def old(**changes: Any) -> Shaft:
    """The rotor of `OLD` with tables changed; None removes one."""
    data = deepcopy(OLD)
    for name, values in changes.items():
        key = next(key for key in data if key.endswith(name.replace("_", " ")))
        data[key] = {**data[key], **values}
    return of_elements(data, "old.toml", "old", speed=50.0)


def test_a_file_of_an_older_version() -> None:
    shaft = old()
    cone, layered = shaft.elements
    assert (cone.diameters(0.0), cone.diameters(1.0)) == ((0.05, 0.0), (0.06, 0.01))
    assert layered.layers[0].density == 7810.0
    assert layered.layers[0].poisson == pytest.approx(-0.5)
    assert layered.poisson == pytest.approx(211.0 / 162.4 - 1.0)
    assert shaft.points[0].node == 3
    assert shaft.supports == (Support(1, 1e6, 2e6, 0.0, 5.0), Support(3, 2e6))
    assert parse_rotor(rotor_text(shaft), "again") == shaft


def test_json_says_the_same(tmp_path: Path) -> None:
    path = tmp_path / "old.json"
    path.write_text(json.dumps({"_note": "by ROSS", **OLD}), encoding="utf-8")
    assert read_rotor(path, speed=50.0) == old()


@pytest.mark.parametrize(("speed", "said"), [(50.0, False), (100.0, False), (120.0, True)])
def test_coefficients_at_a_speed_beyond_theirs_are_said(speed: float, said: bool) -> None:
    shaft = of_elements(deepcopy(OLD), "old.toml", "old", speed)
    assert ("Bearing 1: taken at 100 rad/s, the nearest" in shaft.about) == said


def test_what_is_otherwise_is_said() -> None:
    assert "1 shaft elements have shear_effects = false" in old(Element_1={"shear_effects": False}).about
    assert "axial_force of shaft elements is left out" in old(Element_1={"axial_force": 9.0}).about
    assert "set damping_ratio" in old(Element_1={"beta": 1e-5}).about
    for name, kind in (("kxy", "cross-coupled"), ("mxx", "mass"), ("kzz", "axial")):
        assert f"its {kind} coefficients are left out" in old(Bearing_0={name: [1e5]}).about
    assert "bearings are grounded" in old(Bearing_0={"n_link": 5}).about
    hutchinson = old(Element_1={"shear_method_calc": "hutchinson"}).elements[1].shear_factor
    assert hutchinson == pytest.approx(0.71197, abs=1e-5)  # by ROSS 2.3.0


def imported(parts: dict[str, dict[str, Any]]) -> Shaft:
    """The rotor of `OLD` and other elements, by class and tag."""
    return of_elements(deepcopy(OLD) | parts, "more.toml", "more", speed=50.0)


def test_point_masses_are_on_the_shaft_or_named() -> None:
    """With both masses given, as ROSS saves them, and on a node that a bearing links to the ground."""
    given = {"n": 1, "m": 3.0, "mx": 3.0, "my": 3.0, "mz": 3.0}
    shaft = imported({"PointMass_a": given, "PointMass_b": {**given, "n": 7}})
    assert shaft.mass == pytest.approx(old().mass + 3.0, rel=1e-12)
    assert shaft.points[1] == PointMass(2, 3.0)
    assert "left out, 1: PointMass_b." in shaft.about
    uneven = imported({"PointMass_a": {"n": 1, "mx": 2.0, "my": 4.0}})
    assert uneven.points[1] == PointMass(2, 3.0)
    assert "PointMass_a: has the mean of its masses in x and y, 2 and 4 kg" in uneven.about


def test_what_is_of_no_known_class_is_named() -> None:
    """Also where it has the fields of a shaft, a disc or a bearing."""
    coupling = {"n": 2, "L": 0.1, "odl": 0.1, "o_d": 0.1, "m": 1.0, "Id": 1.0, "Ip": 1.0, "kxx": [1e9]}
    thrust = {"n": 1, "kxx": [0.0], "cxx": [0.0], "kzz": [1e8]}
    shaft = imported(
        {"CouplingElement_c": coupling, "MotorElement_m": {"n": 1}, "BearingElement_t": thrust}
    )
    assert "left out, 3: CouplingElement_c, MotorElement_m, BearingElement_t." in shaft.about
    assert (shaft.nodes, shaft.mass) == (3, pytest.approx(old().mass, rel=1e-12))
    assert (shaft.supports, shaft.stations) == (old().supports, old().stations)
    with pytest.raises(TouchdownError, match="begins at node 2 of ROSS's, but CouplingElement_c: this is"):
        imported({"CouplingElement_c": coupling, "ShaftElement_far": {**SHAFT, "n": 3}})


@pytest.mark.parametrize(
    ("axes", "kxx", "stiffness"),
    [
        ({"speed": [0.0, 100.0]}, [1e6, 3e6], 2e6),
        ({"frequency": [0.0, 100.0]}, [1e6, 3e6], 2e6),
        (
            {"speed": [0.0, 100.0], "frequency": [40.0, 60.0, 80.0]},
            [[1e6, 2e6, 9e6], [3e6, 5e6, 9e6]],
            2.75e6,
        ),
    ],
)
def test_coefficients_over_speed_frequency_or_both(axes: Any, kxx: Any, stiffness: float) -> None:
    """At 50 rad/s of each: the middle between two speeds and, of three frequencies, the first two."""
    bearing = {"n": 1, "kxx": kxx, "cxx": np.zeros_like(kxx).tolist(), **axes}
    shaft = imported({"PlainJournal_p": bearing})
    assert shaft.supports[1] == Support(2, pytest.approx(stiffness))  # type: ignore[arg-type]
    assert "PlainJournal_p" not in shaft.about


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        ({"Element_1": {"n": 5}}, "no shaft element begins at node 2"),
        ({"sleeve": {"L": 0.2}}, "another element on the same nodes has 0.1 m"),
        ({"Element_1": {"material": "Steel"}}, "material = 'Steel' must be a table, as newer"),
        ({"Element_1": {"material": {**STEEL, "G_s": 0.0}}}, "material.G_s = 0.0 must be above 0"),
        ({"Bearing_1": {"frequency": None}}, "kxx cannot be read as numbers over speed or frequency"),
        ({"Bearing_1": {"kxx": [[1e6], [1e6, 2e6]]}}, "Bearing 1.kxx cannot be read as numbers"),
        ({"Element_1": {"odl": None}}, "Element 1.odl is missing"),
        ({"Bearing_1": {"frequency": [100.0, 0.0]}}, "the speeds it is given at do not rise"),
    ],
)
def test_what_cannot_be_imported_is_named(changes: dict[str, Any], says: str) -> None:
    with pytest.raises(TouchdownError) as caught:
        old(**changes)
    assert says in str(caught.value)
    assert "\n" not in str(caught.value)


def test_what_is_no_rotor_of_ross(tmp_path: Path) -> None:
    path = tmp_path / "other.toml"
    path.write_text('title = "x"', encoding="utf-8")
    with pytest.raises(TouchdownError, match="is not a rotor that ROSS saved"):
        read_rotor(path)
    path.write_text("[", encoding="utf-8")
    with pytest.raises(TouchdownError, match="is not valid TOML"):
        read_rotor(path)
    sheet = tmp_path / "rotor.xlsx"
    sheet.touch()
    with pytest.raises(
        TouchdownError, match="is a workbook of a spreadsheet program; save its sheet as CSV"
    ):
        read_rotor(sheet)
    with pytest.raises(TouchdownError, match="imported from ROSS's files"):
        read_rotor(sheet.rename(tmp_path / "rotor.step"))
    with pytest.raises(TouchdownError, match=r"cannot read .*gone\.csv: No such file"):
        read_rotor(tmp_path / "gone.csv")
    with pytest.raises(TouchdownError, match="a str is no"):
        from_ross("rotor")


def test_an_object_says_the_same() -> None:
    def element(key: str) -> SimpleNamespace:
        values = {n: np.array(v) if isinstance(v, list) else v for n, v in OLD[key].items()}
        if "material" in values:
            values["material"] = SimpleNamespace(**values["material"])
        kind, _, tag = key.partition("_")
        own = type(f"My{kind}", (type(kind, (SimpleNamespace,), {}),), {})  # derived from ROSS's
        return own(**{"tag": tag, **values})

    elements = [element(key) for key in OLD if key != "parameters"]
    shaft = from_ross(SimpleNamespace(tag="old", elements=elements), speed=50.0)
    expected = old()
    assert (shaft.elements, shaft.points) == (expected.elements, expected.points)
    assert (shaft.supports, shaft.stations) == (expected.supports, expected.stations)
