"""Points of a sweep: as people write them, drawn, tied, from a file, shared among machines."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from touchdown.master.common.errors import TouchdownError
from touchdown.master.scene.file import load_scene
from touchdown.studies.sweep.definition import define, differences, read_definition
from touchdown.studies.sweep.design import Design, designed, parse, parse_all, read_points

ANGLE = "bearing.balls.first_angle"
SCENE = "disk-caged-simplified"


@pytest.mark.parametrize(
    ("text", "values"),
    [
        ("rotor.mass=1.5", ["1.5"]),
        ("rotor.mass = 1.5, 2", ["1.5", "2"]),
        ("bearing.clearance=0.2,0.25,0.3 mm", ["0.2 mm", "0.25 mm", "0.3 mm"]),
        ("bearing.clearance=0.2 mm,250 um", ["0.2 mm", "250 um"]),
        ("run.scheme=hold,interface", ["hold", "interface"]),
        (f"{ANGLE}=0:315:8 deg", [f"{45 * k} deg" for k in range(8)]),
        ("rotor.x=-1e-5:1e-5:3", ["-1e-05", "0", "1e-05"]),
        ("rotor.x=3e-5:1e-5:1", ["3e-05"]),
        ("rotor.x,rotor.y=1,2 um", ["1 um", "2 um"]),
    ],
)
def test_values_as_people_write_them(text: str, values: Sequence[str]) -> None:
    name, found = parse(text)
    assert name == text.partition("=")[0].strip()
    assert list(found) == values


@pytest.mark.parametrize(
    ("texts", "named"),
    [
        (["rotor.mass"], "write NAME=VALUE"),
        (["=1,2"], "write NAME=VALUE"),
        (["rotor.mass="], "the list of values is empty"),
        (["rotor.mass=,"], "a value is missing between the commas"),
        (["rotor.mass=1:2"], "write START:STOP:COUNT"),
        (["rotor.mass=1 kg:2 kg:3"], "write START:STOP:COUNT"),
        (["rotor.mass=one:2:3"], "must be numbers"),
        (["rotor.mass=1:nan:3"], "must be finite numbers"),
        (["rotor.mass=1:2:0"], "COUNT must be a whole number from 1"),
        (["rotor.mass=1:2:2.5"], "COUNT must be a whole number from 1"),
        (["rotor.mass=1,2", "rotor.mass=3"], "is given twice"),
    ],
)
def test_values_that_cannot_be(texts: list[str], named: str) -> None:
    with pytest.raises(TouchdownError, match=named):
        parse_all(texts)


def test_designs_multiply_and_tie() -> None:
    tied = Design.tied({"a.x": [1, 2], "a.y": ["3 m", "4 m"]})
    both = Design.grid({"b.z": [5, 6, 7]}) * tied
    assert len(both) == 6
    assert both.point(2) == {"b.z": 5, "a.x": 2, "a.y": "4 m"}
    assert designed([{"a.x": 1, "a.y": "3 m"}, {"a.y": "4 m", "a.x": 2}]).points == tied.points
    with pytest.raises(TouchdownError, match=r"a\.x, a\.y varies twice"):
        tied * tied
    with pytest.raises(TouchdownError, match=r"there are: a\.x 2, a\.y 1"):
        Design.tied({"a.x": [1, 2], "a.y": [1]})
    with pytest.raises(TouchdownError, match=r"point 2 gives other settings than the first: a\.y"):
        Design.table([{"a.x": 1}, {"a.x": 1, "a.y": 2}])


@pytest.mark.parametrize("method", ["random", "latin", "sobol"])
def test_samples_fill_their_ranges(method: str) -> None:
    """Equal for equal seeds; a Latin hypercube and a Sobol sequence have a point in every sixteenth."""
    draw = getattr(Design, method)
    ranges = {"a.x": "-1:3 mm", "b.y": (10.0, 20.0)}
    design = draw(ranges, 16, seed=7)
    assert design.points == draw(ranges, 16, seed=7).points != draw(ranges, 16, seed=8).points
    x = np.array([float(str(point[0]).removesuffix(" mm")) for point in design.points])
    y = np.array([float(str(point[1])) for point in design.points])
    parts = np.array([(x + 1.0) / 4.0, (y - 10.0) / 10.0])
    assert ((parts >= 0.0) & (parts <= 1.0)).all()
    filled = [len(set(np.floor(16.0 * part))) for part in parts]
    assert filled == [16, 16] or method == "random"


@pytest.mark.parametrize(
    ("make", "named"),
    [
        (lambda: Design.sobol({"a.x": "0:1"}, 100), "ask for a power of 2: 64 or 128"),
        (lambda: Design.latin({"a.x": "1:0 mm"}, 4), "LOW must be below HIGH"),
        (lambda: Design.latin({"a.x": "1 mm"}, 4), "write LOW:HIGH"),
        (lambda: Design.latin({}, 4), "a sample needs a range"),
        (lambda: Design.random({"a.x": "0:1"}, 0), "ask for 1 at least"),
        (lambda: Design.random({"a.x": "0:1"}, 3, seed=-1), "seed = -1"),
        (lambda: Design.grid({}), "nothing varies"),
        (lambda: Design.grid({f"a.{n}": range(10**6) for n in "wxyz"}), f"1{24 * '0'} drops is too large"),
    ],
)
def test_designs_that_cannot_be(make, named: str) -> None:
    with pytest.raises(TouchdownError, match=named):
        make()


def test_points_from_a_file(tmp_path: Path) -> None:
    file = tmp_path / "points.csv"
    file.write_text(
        "rotor.speed [rpm],run.scheme\n6000,hold\n\n9000,interface\n12 rad/s,hold\n", encoding="utf-8"
    )
    asked = define(load_scene(SCENE), read_points(file), in_process=True)
    assert [column.unit for column in asked.columns] == ["rad/s", None]
    assert [value[0] for value in asked.values] == pytest.approx([200.0 * np.pi, 300.0 * np.pi, 12.0])
    assert [value[1] for value in asked.values] == ["hold", "interface", "hold"]


@pytest.mark.parametrize(
    ("text", "named"),
    [
        ("speed\n1\n", "the column 'speed' is not known; columns are settings, such as rotor"),
        ("rotor.speed,rotor.x\n1\n", "line 2: rotor.x is missing"),
        ("rotor.speed,rotor.x\n1, \n", "line 2: rotor.x is missing"),
        ("rotor.speed,rotor.speed\n1,2\n", "there are two columns rotor.speed"),
        ("rotor.speed\n", "has no row below its header"),
        ("", "has no row below its header"),
        ("rotor.speed\n\0\n", "is not a number"),
    ],
)
def test_files_that_are_no_points(text: str, named: str, tmp_path: Path) -> None:
    (tmp_path / "points.csv").write_text(text, encoding="utf-8")
    with pytest.raises(TouchdownError, match=named):
        define(load_scene(SCENE), read_points(tmp_path / "points.csv"), in_process=True)
    with pytest.raises(TouchdownError, match="cannot read"):
        read_points(tmp_path / "no.csv")


def test_names_that_mean_several_settings() -> None:
    scene = load_scene("rotor1-9000")
    design = Design.grid({"bearing_*.clearance": ["0.2 mm"], "housing_A.x0,housing_B.x0": ["1 um"]})
    asked = define(scene, design, in_process=True)
    assert [column.settings for column in asked.columns] == [
        ("bearing_A.clearance", "bearing_B.clearance"),
        ("housing_A.x0", "housing_B.x0"),
    ]
    at = asked.at(scene, 1).components
    assert {at[name].set["clearance"] for name in ("bearing_A", "bearing_B")} == {"0.2 mm"}
    with pytest.raises(TouchdownError, match=r"no variable clearence; did you mean clearance"):
        define(scene, Design.grid({"bearing_*.clearence": [1]}), in_process=True)
    with pytest.raises(TouchdownError, match=r"no component of scene rotor1-9000 matches baering_\*"):
        define(scene, Design.grid({"baering_*.clearance": [1]}), in_process=True)
    every = define(scene, Design.grid({"bearing_?.friction.dyn*": [0.2]}), in_process=True)
    assert every.columns[0].settings == ("bearing_A.friction.dynamic", "bearing_B.friction.dynamic")
    twice = Design.grid({"bearing_*.clearance": ["0.2 mm"], "bearing_A.clearance": ["0.3 mm"]})
    with pytest.raises(TouchdownError, match=r"bearing_A\.clearance varies twice"):
        define(scene, twice, in_process=True)


def test_how_a_value_came_to_be_makes_no_other_sweep() -> None:
    """A duration that is the scene's own may be given or not; another one is another sweep."""
    scene = load_scene("disk-caged-simplified")
    design = Design.grid({"rotor.mass": [1.0, 2.0]})
    plain = define(scene, design, in_process=True)
    same = scene.set({"run.duration": scene.run.duration})
    assert differences(plain, define(same, design, in_process=True)) == []
    other = scene.set({"run.duration": 2.0 * scene.run.duration})
    (said,) = differences(plain, define(other, design, in_process=True))
    assert said.startswith("run.duration is")


def test_a_definition_without_what_reads_a_sweep_is_damaged(tmp_path: Path) -> None:
    """Here its scene's title, which reports and tables print."""
    asked = define(load_scene(SCENE), Design.grid({"rotor.mass": [1.0, 2.0]}), in_process=True)
    asked.write(tmp_path)
    assert read_definition(tmp_path).columns == asked.columns
    replace(asked, scene={"name": SCENE}).write(tmp_path)
    damaged = r"sweep\.json cannot be read; it is of another version, or dam"
    with pytest.raises(TouchdownError, match=damaged):
        read_definition(tmp_path)


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("columns", [{"name": "rotor.mass", "settings": [], "unit": "kg"}]),
        ("points", [[1.0, 2.0]]),
        ("values", [["1", None]]),
        ("made_of", None),
        ("scene", 3),
    ],
)
def test_a_definition_with_a_value_of_another_kind_is_damaged(
    key: str, value: object, tmp_path: Path
) -> None:
    define(load_scene(SCENE), Design.grid({"rotor.mass": [1.0, 2.0]}), in_process=True).write(tmp_path)
    path = tmp_path / "sweep.json"
    path.write_text(json.dumps(json.loads(path.read_text()) | {key: value}))
    with pytest.raises(TouchdownError, match=r"sweep\.json cannot be read"):
        read_definition(tmp_path)
