"""Rotor files: what they say, and what their mistakes are answered with."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from touchdown.modelkit.errors import TouchdownError
from touchdown.rotor.beams.beam_body import PointMass
from touchdown.rotor.beams.shaft import MAX_NODES, Shaft, Station, Unbalance
from touchdown.rotor.file import load_rotor, shipped_rotors

GOOD = """
title = "A rotor"
about = "for tests"
damping_ratio = 0.01

[material.steel]
modulus = "207 GPa"
density = "7.83 g/cm3"
poisson = 0.3

[material.laminations]
modulus = "0 GPa"
density = "7650 kg/m3"

[[element]]
length = "50 mm"
outer_diameter = "20 mm"
inner_diameter = "5 mm"

[[element]]
position = "50 mm"
count = 3
length = "20 mm"
outer_diameter = "30 mm"
material = "steel"

[element.sleeve]
outer_diameter = "55 mm"
material = "laminations"

[[element]]
position = "0.11 m"
length = "40 mm"
outer_diameter = "20 mm"

[[disc]]
node = 3
outer_diameter = "80 mm"
inner_diameter = "30 mm"
width = "10 mm"

[[point_mass]]
node = 6
mass = "100 g"
polar_inertia = "200 kg.mm2"

[[unbalance]]
node = 3
moment = "3 g.mm"
angle = "90 deg"

[stations]
A = 2
B = 5
"""


def read(folder: Path, text: str) -> Shaft:
    path = folder / "mine.toml"
    path.write_text(text, encoding="utf-8")
    return load_rotor(path)


def complaint(folder: Path, text: str) -> str:
    """The message about a file, without the file's name, which it must begin with."""
    with pytest.raises(TouchdownError) as caught:
        read(folder, text)
    name, _, rest = str(caught.value).partition("mine.toml: ")
    assert name == f"{folder}/"
    assert "\n" not in rest
    return rest


def test_a_good_file(tmp_path: Path):
    shaft = read(tmp_path, GOOD)
    assert (shaft.title, shaft.about, shaft.damping_ratio) == ("A rotor", "for tests", 0.01)
    assert shaft.positions() == pytest.approx([0.0, 0.05, 0.07, 0.09, 0.11, 0.15])
    first, second = shaft.elements[:2]
    assert (first.outer_diameter, first.inner_diameter) == (0.02, 0.005)
    assert (first.modulus, first.density, first.poisson) == (207e9, 7830.0, 0.3)
    assert (first.sleeve_diameter, first.shear_factor) == (0.0, None)
    assert shaft.elements[1] == shaft.elements[3]
    assert (second.sleeve_diameter, second.sleeve_density, second.sleeve_modulus) == (0.055, 7650.0, 0.0)
    disc, point = shaft.points
    assert disc.mass == pytest.approx(7830.0 * math.pi / 4 * (0.08**2 - 0.03**2) * 0.01)
    assert point == PointMass(6, 0.1, pytest.approx(2e-4), 0.0)
    assert shaft.unbalances == (Unbalance(3, pytest.approx(3e-6), pytest.approx(math.pi / 2)),)
    assert shaft.stations == (Station("A", 2), Station("B", 5))
    assert shaft.node("B") == 5
    with pytest.raises(TouchdownError, match="no station C; it has: A, B"):
        shaft.node("C")


MISTAKES = {
    # name: (text, replaced by, pieces of the message)
    "missing title": ('title = "A rotor"', "", ("title is missing", "must be text")),
    "missing poisson": ("poisson = 0.3", "", ("element[1].material is missing", "laminations, steel")),
    "unknown field": (
        "count = 3",
        "cuont = 3",
        ("element[2].cuont is not a known key", "did you mean count"),
    ),
    "metres for mm": (
        'length = "50 mm"',
        'length = "500 m"',
        ("element[1].length = '500 m'", "0.0001 to 100 m"),
    ),
    "core of modulus 0": ('"207 GPa"', '"0 GPa"', ("element[1].material", "modulus of 0", "only a sleeve")),
    "core of laminations": (
        'material = "steel"',
        'material = "laminations"',
        ("element[2].material = 'laminations' has no poisson",),
    ),
    "poisson": (
        "poisson = 0.3",
        "poisson = 0.6",
        ("material.steel.poisson = 0.6", "at least -0.9 and below 0.5"),
    ),
    "cone thinner than its bore": (
        'inner_diameter = "5 mm"',
        'inner_diameter = "5 mm"\nouter_diameter_end = "4 mm"',
        ("element[1].inner_diameter = '5 mm' must be below outer_diameter_end = '4 mm'",),
    ),
    "cone with a sleeve": (
        'outer_diameter = "30 mm"',
        'outer_diameter = "30 mm"\nouter_diameter_end = "40 mm"',
        ("element[2].sleeve", "cannot sit on a cone"),
    ),
    "layer in a layer": (
        'inner_diameter = "5 mm"',
        'layers = [{ outer_diameter = "15 mm" }]',
        ("element[1].layers[1].outer_diameter = '15 mm' must be above what it sits on",),
    ),
    "layer of laminations": (
        'inner_diameter = "5 mm"',
        'layers = [{ outer_diameter = "35 mm", material = "laminations" }]',
        ("element[1].layers[1].material", "has no poisson, which the layer needs"),
    ),
    "support without stiffness": (
        "[stations]",
        "[[support]]\nnode = 2\n\n[stations]",
        ("support[1].stiffness is missing", "N/m"),
    ),
    "bore too wide": (
        'inner_diameter = "5 mm"',
        'inner_diameter = "20 mm"',
        ("element[1].inner_diameter = '20 mm' must be below outer_diameter = '20 mm'",),
    ),
    "sleeve too small": (
        'outer_diameter = "55 mm"',
        'outer_diameter = "25 mm"',
        ("element[2].sleeve.outer_diameter = '25 mm'", "above that of the core", "'30 mm'"),
    ),
    "unknown material": (
        'material = "steel"',
        'material = "steal"',
        ("element[2].material = 'steal'", "did you mean steel"),
    ),
    "gap": ('"0.11 m"', '"0.12 m"', ("element[3].position = '0.12 m' leaves a gap", "end at 110 mm")),
    "overlap": ('"0.11 m"', '"0.1 m"', ("element[3].position = '0.1 m' overlaps", "end at 110 mm")),
    "station off the shaft": ("B = 5", "B = 7", ("stations.B = 7 is not a node", "1 to 6")),
    "station twice": ("B = 5", "A = 5", ("not valid TOML", "line 54")),
    "station's name": ("B = 5", '"B 1" = 5', ("stations.'B 1' = 5", "letters, digits and _")),
    "station's keyword": ("B = 5", "in = 5", ("stations.in = 5 has a name that cannot be used",)),
    "one bracket": ("[[disc]]", "[disc]", ("disc = {", "each written [[disc]]")),
    "too many nodes": ("count = 3", "count = 100000", ("element[2]", f"at most {MAX_NODES}")),
}


@pytest.mark.parametrize("mistake", MISTAKES)
def test_mistakes(tmp_path: Path, mistake: str):
    old, new, pieces = MISTAKES[mistake]
    assert old in GOOD
    message = complaint(tmp_path, GOOD.replace(old, new, 1))
    for piece in pieces:
        assert piece in message


def test_no_elements(tmp_path: Path):
    head = GOOD[: GOOD.index("[[element]]")]
    assert "element is missing; describe the shaft" in complaint(tmp_path, head)
    assert "element = [] is missing" in complaint(tmp_path, f"element = []\n{head}")


def test_most_nodes(tmp_path: Path):
    text = GOOD.replace("count = 3", f"count = {MAX_NODES - 3}").replace('position = "0.11 m"', "")
    assert read(tmp_path, text).nodes == MAX_NODES
    text = text.replace(f"count = {MAX_NODES - 3}", f"count = {MAX_NODES - 2}")
    assert f"element[3] brings the rotor to {MAX_NODES + 1} nodes" in complaint(tmp_path, text)


def test_a_byte_order_mark_is_understood(tmp_path: Path):
    """As some editors begin a file with."""
    path = tmp_path / "rotor.toml"
    path.write_bytes(b"\xef\xbb\xbf" + shipped_rotors()["rotor_I"].read_bytes())
    assert load_rotor(path) == load_rotor(shipped_rotors()["rotor_I"])


def test_files_that_cannot_be_read(tmp_path: Path):
    with pytest.raises(TouchdownError, match=r"cannot read .*gone\.toml: No such file"):
        load_rotor(tmp_path / "gone.toml")
    with pytest.raises(TouchdownError, match="cannot read"):
        load_rotor(tmp_path)
    path = tmp_path / "latin.toml"
    path.write_bytes('title = "Läufer"'.encode("latin-1"))
    with pytest.raises(TouchdownError, match="UTF-8"):
        load_rotor(path)
