"""One kind of file given for another, one notation for another: what it is, and what is meant instead."""

from __future__ import annotations

import json
import shutil
from functools import reduce
from operator import getitem
from pathlib import Path
from typing import Any

import pytest
from commands import SCENE, Command
from places import ROOT

import touchdown
from touchdown.master.common.errors import TouchdownError
from touchdown.master.common.units import to_si
from touchdown.master.scene.file import LATER, read_resolved, restored

PUMP = ROOT / "examples" / "pump_sections.csv"
SPINDLE_MATRICES = ROOT / "examples" / "spindle_matrices"
SAVED = ROOT / "validation" / "ross"
ROSS, MATRICES = SAVED / "rotor_example.toml", SAVED / "rotor_example.npz"
SPINDLE = ROOT / "examples" / "spindle_rotor.toml"


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("run", SPINDLE), f"is a rotor's file, not a scene; `touchdown rotor {SPINDLE}` describes it"),
        (("run", PUMP),
         f"is a table, not a scene; `touchdown import rotor {PUMP}` makes a rotor's file of it"),
        (("run", "left"), "left is what a run left; give left/scene.json"),
        (("import", "rotor", SPINDLE), "is a rotor's file already; `touchdown rotor` describes it"),
        (("import", "rotor", "nowhere"), "there is no file or folder nowhere"),
        (("rotor", ROSS), f"is not a rotor's file; `touchdown import rotor {ROSS}` makes one of ROSS's"),
        (("rotor", "ross.json"),
         "is not a rotor's file; `touchdown import rotor ross.json` makes one of ROSS's"),
        (("rotor", MATRICES), f"`touchdown import rotor {MATRICES}` makes one of matrices or modal data"),
        (("rotor", SPINDLE_MATRICES / "M.mtx"), f"`touchdown import rotor {SPINDLE_MATRICES}` makes one"),
        (("rotor", SPINDLE_MATRICES), f"`touchdown import rotor {SPINDLE_MATRICES}` makes one of its"),
        (("rotor", "rotor"), "did you mean rotor_I or rotor_II, or give"),
        (("rotor", "amb"), "there is no rotor called amb; there are: compressor_rotor, rotor_I, "
         "rotor_II, spindle_rotor"),
        (("new", "m", "--rotor", "rotor1-9000", "--bearings", "7004"),
         "rotor1-9000 is a scene, no rotor; `touchdown scenes rotor1-9000` says which its rotor is"),
        (("report", "mine.toml"), "mine.toml is a scene; `touchdown run mine.toml` first"),
        (("rotor", PUMP), f"is not a rotor's file; `touchdown import rotor {PUMP}` makes one of a table"),
        (("new", "m", "--rotor", PUMP, "--bearings", "7004"), f"`touchdown import rotor {PUMP}` makes one"),
        (("new", "m", "--rotor", "mine.toml", "--bearings", "7004"), "mine.toml is a scene, no rotor's f"),
        (("report", "."), "is not a run's folder, it holds 1 of them; give one, such as left"),
        (("report", "left/summary.json"), "is a file; give the folder that it lies in, left"),
        (("run", 300 * "x"), "unknown scene xxx"),
        (("report", 300 * "x"), "there is no folder xxx"),
        (("report", "left"), "left/result.h5 is missing; run the scene again"),
        (("run", SCENE, "--swap", "bearing=7006"), "take it by --set COMPONENT.preset=7006"),
    ],
)  # fmt: skip
def test_a_mix_up_is_named_with_the_right_command(
    arguments: tuple[object, ...], said: str, command: Command, tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:  # fmt: skip
    monkeypatch.chdir(tmp_path)
    Path("left").mkdir()
    Path("mine.toml").write_text(f'extends = "{SCENE}"')
    Path("ross.json").write_text('{"ShaftElement_a": {}, "ross_version": "1.6"}')
    for name in ("summary", "ending", "scene"):
        Path("left", f"{name}.json").write_text("{}")
    assert said in command(*arguments).line


def test_an_import_replaces_no_file_unasked(command: Command, tmp_path: Path) -> None:
    """What it would write again as it is may be there: nothing is lost."""
    path = tmp_path / "rotor.toml"
    assert command("import", "rotor", PUMP, "-o", path).status == 0
    assert command("import", "rotor", PUMP, "-o", path).status == 0
    path.write_text(path.read_text() + "# by hand\n")
    line = command("import", "rotor", PUMP, "-o", path).line
    assert "rotor.toml is there already; choose another file, or --force" in line
    assert "# by hand" in path.read_text()
    assert command("import", "rotor", PUMP, "-o", path, "--force").status == 0
    assert "# by hand" not in path.read_text()


@pytest.mark.parametrize(
    "line", ["clearance = 0.3 mm", "clearance = 0.3mm", "friction = { kind = 0, dynamic = 15 % }"]
)
def test_a_quantity_without_quotes_is_shown_with_them(line: str, run: Command, tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    path.write_text(f'extends = "{SCENE}"\n[components.bearing.set]\n{line}\n')
    quoted = line.rpartition("= ")[2].removesuffix(" }")
    assert run(path).line.endswith(f'; write "{quoted}" in quotes')


def test_so_it_is_in_a_rotor_of_a_scene(run: Command, command: Command, tmp_path: Path) -> None:
    path = tmp_path / "rotor.toml"
    text = SPINDLE.read_text(encoding="utf-8")
    path.write_text(text.replace('"10 mm"', "10 mm", 1))
    assert command("rotor", path).line.endswith('write "10 mm" in quotes')
    assert run(SCENE, "--swap", f"rotor={path}").line.endswith('write "10 mm" in quotes')
    path.write_text(text.replace("[stations]", "[stations"))
    assert "quotes" not in command("rotor", path).line


@pytest.mark.parametrize(
    ("value", "unit", "said"),
    [
        ("9000 rmp", "rad/s", "did you mean rpm"),
        ("150 MHz", "rad/s", "did you mean "),
        ("G2.5", "kg.m", "is not a number; a rotor's eccentricity or unbalance_scale takes grades"),
        ("3 inch", "m", "it is measured in m; write it in m or km or cm or mm"),
        ("3 kg", "m", "write it in m or km or cm or mm or um or nm"),
        ("3 mN/m", "N/m", "did you mean N/m or "),
    ],
)
def test_a_unit_that_is_none_is_answered_by_those_there_are(value: str, unit: str, said: str) -> None:
    with pytest.raises(TouchdownError) as refused:
        to_si(value, unit, "it")
    assert said in str(refused.value)


def plain() -> dict[str, Any]:
    """A scene as a run leaves it."""
    return json.loads(json.dumps(touchdown.load(SCENE).resolved(), default=str))


def test_a_scene_that_a_run_left_is_read_back() -> None:
    assert restored(plain()) == touchdown.load(SCENE)


BEARING = "components.bearing"


@pytest.mark.parametrize(
    ("key", "value", "said"),
    [
        (f"{BEARING}.preset", 6004, "bearing.preset = 6004 must be"),
        (f"{BEARING}.fmu", 3, "components.bearing.fmu = 3 must be"),
        (f"{BEARING}.set", None, "set = None must be a table"),
        (f"{BEARING}.every", 0, "every = 0 must be a whole number"),
        (f"{BEARING}.names", {"a": 3}, "names.a = 3 must be text"),
        (f"{BEARING}.own", ["mass"], "own.mass is not a known key"),
        ("own", ["mass"], "own.mass is not a known key"),
        ("zero", "3 mm", "zero = '3 mm' has the unit mm"),
        ("attach", [[1, 2]], "attach = [1, 2] must be a pair"),
        ("energy_scale", [1], "energy_scale = 1 must be the name of a variable"),
        ("components", [], "components = [] must be a table"),
        ("title", 3, "title = 3 must be text"),
        ("attach", None, "attach = None must be a list"),
        ("connect", [["a.b", "c.d"]], "must be source, target, and null or factor"),
        ("connect", [["a.b", "c.d", [2.0]]], "must be source, target, and null or"),
        ("bond", [[["a.b", "c.d"], None, None, []]], "must be source, target, and"),
        ("bond", [[["a.b", "c.d", None]]], "must be the wires of force, position"),
    ],
)
def test_one_that_was_edited_is_refused_where_it_is_wrong(
    key: str, value: object, said: str, run: Command, tmp_path: Path
) -> None:
    scene = plain()
    *place, last = key.split(".")
    reduce(getitem, place, scene)[last] = value
    path = tmp_path / "scene.json"
    path.write_text(json.dumps(scene))
    assert said in run(path).line


@pytest.mark.parametrize("place", [(), ("components", "bearing")])
def test_one_that_lacks_a_key_is_refused(place: tuple[str, ...], tmp_path: Path) -> None:
    """But for keys that came with a later version than the run."""
    for key in set(reduce(getitem, place, plain())) - {*LATER}:
        scene = plain()
        del reduce(getitem, place, scene)[key]
        (tmp_path / "scene.json").write_text(json.dumps(scene))
        with pytest.raises(TouchdownError, match=rf": {'.'.join((*place, key))} is missing; a run leaves"):
            read_resolved(tmp_path / "scene.json")


def test_a_report_of_a_run_whose_scene_lost_a_part(command: Command, tmp_path: Path) -> None:
    scene = touchdown.load(SCENE).set({"run.duration": 1e-4})
    touchdown.run(scene, tmp_path / "run", in_process=True).recording.close()
    left = json.loads((tmp_path / "run" / "scene.json").read_text())
    del left["components"]["bearing"]
    (tmp_path / "run" / "scene.json").write_text(json.dumps(left))
    assert "scene.json has other components than ending.json" in command("report", tmp_path / "run").line
    shutil.rmtree(tmp_path / "run")
