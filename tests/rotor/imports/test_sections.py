"""Rotors as tables of sections, and the places put on them."""

from __future__ import annotations

import math
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest

from touchdown.modelkit.errors import TouchdownError
from touchdown.rotor.beams.shaft import Shaft, Station, Unbalance
from touchdown.rotor.imports import placed
from touchdown.rotor.imports.sections import of_sections

HEAD = (
    "Length [mm], outer_diameter [mm], inner diameter (mm), outer diameter end [mm], material, elements, "
    "mass [kg], polar inertia [kg.cm2], unbalance [g.mm], unbalance angle [deg], station"
)
TABLE = f"""
# from the drawing
{HEAD}
30, 20, 0, , steel, , 0.5, 4, , , A
200, 40, 10, 60, steel, 4, , , 7, 90,
30, 20, , , aluminium, , , , , , B
, , , , , , 1.2, , , ,
"""


def table(text: str) -> Shaft:
    with TemporaryDirectory() as folder:
        path = Path(folder) / "mine.csv"
        path.write_text(text, encoding="utf-8")
        return of_sections(path)


def test_a_table() -> None:
    shaft = table(TABLE)
    assert shaft.positions() == pytest.approx([0.0, 0.015, 0.03, 0.08, 0.13, 0.18, 0.23, 0.245, 0.26])
    assert [e.diameters(1.0)[0] for e in shaft.elements[1:6]] == pytest.approx(
        [0.02, 0.045, 0.05, 0.055, 0.06]
    )
    assert {e.inner_diameter for e in shaft.elements[2:6]} == {0.01}
    assert (shaft.elements[0].modulus, shaft.elements[-1].density) == (207e9, 2700.0)
    assert [(p.node, p.mass, p.polar_inertia) for p in shaft.points] == [
        (1, 0.5, pytest.approx(4e-4)),
        (9, 1.2, 0.0),
    ]
    assert shaft.unbalances == (Unbalance(3, pytest.approx(7e-6), pytest.approx(math.pi / 2.0)),)
    assert shaft.stations == (Station("A", 1), Station("B", 7))


def test_spreadsheets_with_decimal_commas() -> None:
    shaft = table(
        "length [mm];outer diameter [mm];modulus [GPa];density [kg/m3];poisson\n12,5;20,5;70;2700;0,33\n"
    )
    assert (shaft.elements[0].length, shaft.elements[0].outer_diameter) == (0.0125, 0.0205)
    assert shaft.elements[0].poisson == 0.33


def test_a_table_in_german() -> None:
    shaft = table(
        "Welle 7;;;\nL\u00e4nge in mm;Au\u00dfendurchmesser / mm;Bohrung [mm];Werkstoff;Lagerstelle\n"
        "30;20;0;Stahl;A\n200,5;40;10,25;Stahl;\n30;20;;Titan;B\n"
    )
    assert shaft.positions()[-1] == pytest.approx(0.2605)
    assert {e.inner_diameter for e in shaft.elements} == {0.0, 0.01025}
    assert (shaft.elements[0].modulus, shaft.elements[-1].modulus) == (207e9, 114e9)
    assert [s.name for s in shaft.stations] == ["A", "B"]


def test_a_sleeve() -> None:
    head = "length [mm],outer diameter [mm],material,sleeve diameter [mm],sleeve density [kg/m3]"
    element = table(f"{head}\n20,30,steel,50,7650\n").elements[0]
    assert (element.sleeve_diameter, element.sleeve_density, element.sleeve_modulus) == (0.05, 7650.0, 0.0)


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ("Length [mm]", "Length", "line 3: length has no unit; write it as length [mm]"),
        ("Length [mm]", "Breadth [mm]", "[mm]' is not known; did you mean bore; columns are length"),
        ("elements", "material", "line 3: there are two columns material"),
        ("30, 20, 0, , steel", "30, , 0, , steel", "line 4: outer_diameter is missing"),
        ("30, 20, 0, , steel", "30, 20, 20, , steel", "line 4: inner_diameter = '20 mm' is not less than"),
        ("30, 20, 0, , steel", "30, 20, 0, , stele", "line 4: material = 'stele' is not known; did you"),
        ("A\n200", "A, 5\n200", "line 4: has 12 cells, the header 11"),
        ("steel, 4", "steel, 1e9", "line 5: length = '200 mm' makes 1e+09 elements; with those before"),
        (", B\n", ", A\n", "line 6: station = 'A' is there twice"),
        (TABLE, "", "mine.csv: has no row below its header"),
    ],
)  # fmt: skip
def test_mistakes_are_named(old: str, new: str, says: str) -> None:
    assert old in TABLE
    with pytest.raises(TouchdownError) as caught:
        table(TABLE.replace(old, new, 1))
    assert "/mine.csv" in str(caught.value)
    assert says in str(caught.value)


def test_places_by_node_and_by_distance() -> None:
    shaft = table(TABLE)
    with_places = placed(shaft, {"A": 2, "B": "250 mm"}, {"amb_A": "50 mm"}, {"eye": "80 mm"})
    assert [(s.name, s.node) for s in with_places.stations] == [("A", 2), ("B", 10), ("amb_A", 4)]
    assert with_places.levitated_at == ("amb_A",)
    assert [(s.name, s.node) for s in with_places.sensors] == [("eye", 5)]
    assert with_places.positions()[[3, 9]] == pytest.approx([0.05, 0.25])
    assert (with_places.unbalances[0].node, with_places.points[1].node) == (3, 11)
    assert with_places.mass == pytest.approx(shaft.mass, rel=1e-12)
    assert with_places.centre_of_mass == pytest.approx(shaft.centre_of_mass, rel=1e-12)
    assert with_places.diametral_inertia == pytest.approx(shaft.diametral_inertia, rel=1e-12)
    assert placed(shaft).stations == shaft.stations


def test_a_name_stands_once() -> None:
    with pytest.raises(TouchdownError, match="A is there twice"):
        placed(table(TABLE), {"A": 1}, {"A": 2})


@pytest.mark.parametrize(
    ("place", "says"),
    [
        (0, "A = 0 is not a node of the rotor mine, which has nodes 1 to 9"),
        ("261 mm", "261 mm is not on the rotor mine, which ends at 260 mm"),
        ("30.05 mm", "30.05 mm is less than 0.1 mm from node 3"),
    ],
)
def test_places_that_are_not_there(place: int | str, says: str) -> None:
    with pytest.raises(TouchdownError) as caught:
        placed(table(TABLE), {"A": place})
    assert says in str(caught.value)
