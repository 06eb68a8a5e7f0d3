"""Rotor files in scenes and on the command line: what works, and one clear line for each mistake."""

from __future__ import annotations

import zipfile
from pathlib import Path

import pytest

from touchdown.command.cli import main
from touchdown.fmus.recipes import recipe
from touchdown.master.common.errors import TouchdownError
from touchdown.master.coupling.simulation import open_system, opened
from touchdown.master.results.recording import NotRecordedError, Recording
from touchdown.master.results.run import run_scene
from touchdown.master.scene.file import load_scene
from touchdown.master.scene.scene import Scene

SMALL = """
title = "Small shaft"

[material.steel]
modulus = "207 GPa"
density = "7830 kg/m3"
poisson = 0.3

[[element]]
count = 4
length = "50 mm"
outer_diameter = "20 mm"

[stations]
A = 1
B = 5
"""


@pytest.fixture
def rotor_file(tmp_path: Path) -> Path:
    """A rotor in a folder that is no plain name."""
    folder = tmp_path / "Läufer und Lager"
    folder.mkdir()
    path = folder / "small shaft.toml"
    path.write_text(SMALL, encoding="utf-8")
    return path


def scene_of(folder: Path, text: str) -> Scene:
    """A scene from TOML in `folder`."""
    path = folder / "scene.toml"
    path.write_text(text, encoding="utf-8")
    return load_scene(str(path))


ON_BUSHINGS = """
attach = [["left.journal", "rotor.A"], ["right.journal", "rotor.B"]]
[run]
duration = 1e-3
macro_step = 2e-5
[components.rotor]
fmu = "small shaft.toml"
[components.left]
fmu = "bushing"
[components.right]
fmu = "bushing"
"""


@pytest.mark.parametrize("in_process", [True, False])
def test_a_rotor_file_is_a_component(rotor_file: Path, in_process: bool) -> None:
    """Named in a scene beside it, as an FMU and in process: 0.5 mm of free fall in 10 ms."""
    scene = scene_of(rotor_file.parent, ON_BUSHINGS)
    summary = run_scene(scene, rotor_file.parent / "out", in_process).summary
    assert summary["completed"]
    assert summary["seats"]["A"]["largest_displacement"] == pytest.approx(0.5 * 9.81 * 1e-6, rel=1e-6)


def test_fmus_of_one_name_but_different_files_do_not_meet(tmp_path: Path, rotor_file: Path) -> None:
    """Two rotors of the same file name in one process keep their own mass."""
    other = tmp_path / "other"
    other.mkdir()
    heavier = other / rotor_file.name
    heavier.write_text(SMALL.replace('"20 mm"', '"40 mm"'), encoding="utf-8")
    assert recipe(str(rotor_file)).content != recipe(str(heavier)).content
    text = f'[components.light]\nfmu = "{rotor_file}"\n[components.heavy]\nfmu = "{heavier}"\n'
    with opened(scene_of(tmp_path, text)) as system:
        system.initialise()
        assert system.value("heavy.mass") / system.value("light.mass") == pytest.approx(4.0, rel=1e-12)


def test_a_rotor_file_of_any_name_is_built_and_checked(
    rotor_file: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The script inside the FMU is one that Python reads as it was meant."""
    for name in ("small shaft", "2. Läufer 转子", 'it\'s "quoted" """ back\\under'):
        path = rotor_file.with_name(f"{name}.toml")
        path.write_text(SMALL, encoding="utf-8")
        assert main(["build", str(path), "-o", str(rotor_file.parent / "built")]) == 0
        built = Path(capsys.readouterr().out.strip())
        with zipfile.ZipFile(built) as archive:
            assert "Small shaft" in archive.read("modelDescription.xml").decode()
            script = f"resources/{archive.read('resources/slavemodule.txt').decode()}.py"
            compile(archive.read(script), script, "exec")
    assert main(["check", str(built.with_name("small_shaft.fmu"))]) == 0
    text = capsys.readouterr().out
    assert "passed" in text
    assert "port A: of a body, seat of a journal, with up to 20 elastic modes" in text


@pytest.mark.parametrize(
    ("old", "new", "named"),
    [
        ('length = "50 mm"', "length = 50", "element[1].length"),
        ("B = 5", "B = 9", "stations.B"),
        ("[stations]", 'levitated_at = ["C"]\n[stations]', "levitated_at"),
    ],
)
def test_a_mistake_in_a_rotor_file_is_one_line(
    rotor_file: Path, capsys: pytest.CaptureFixture[str], old: str, new: str, named: str
) -> None:
    """Named with file and place, from every command that reads it; nothing is written."""
    assert old in SMALL
    text = SMALL.replace(old, new, 1)
    if new.startswith("levitated_at"):  # a key of the file, not of a table
        text = f'levitated_at = ["C"]\n{SMALL}'
    rotor_file.write_text(text, encoding="utf-8")
    out = rotor_file.parent / "out"
    for arguments in (
        ["build", str(rotor_file), "-o", str(out)],
        ["rotor", str(rotor_file), "-o", str(out)],
    ):
        assert main(arguments) == 2
        line = capsys.readouterr().err.strip()
        assert "\n" not in line
        assert rotor_file.name in line
        assert named in line
    with pytest.raises(TouchdownError, match=r"small shaft\.toml"):
        open_system(scene_of(rotor_file.parent, ON_BUSHINGS), in_process=True)
    assert not out.exists()


@pytest.mark.parametrize(
    ("setting", "named"),
    [
        (("rotor.modes", 1), "modes = 1 must be from 2"),
        (("rotor.modes", 41), "to 40, all that the model has"),
        (("rotor.modes", -1), "rotor.modes = -1 must be at least 0"),
        (("rotor.C.fx", 1.0), "no variable C.fx"),
        (("rotor.stress.node", 21), "nodes count from 1 to 20"),
        (("rotor.damping_ratio", 2.0), "rotor.damping_ratio = 2 must be at most 1"),
        (("run.record", "rotor.C"), "there is nothing called rotor.C"),
        (("run.record", 5), "run.record"),
    ],
)
def test_settings_that_cannot_be(tmp_path: Path, setting: tuple[str, object], named: str) -> None:
    with pytest.raises(TouchdownError, match=named):
        run_scene(load_scene("rotor1-9000").set(dict([setting])), tmp_path, in_process=True)


@pytest.mark.parametrize(
    ("text", "named"),
    [
        ('attach = [["amb_A.journal", "rotor.C"]]', "rotor_I.* has no variable C.x"),
        ('sense = [["amb_A.sensors", "rotor.sensor_A"]]', "amb.* has no variable sensors.x"),
        ('sense = [["amb_A.sensor", "rotor.sensor_Z"]]', "rotor_I.* has no variable sensor_Z.x"),
        ('sense = [["amb_A.journal", "rotor.sensor_A"]]', "amb_A.journal.x has two sources"),
        ('sense = ["amb_A.sensor", "rotor.sensor_A"]', "must be a pair such as"),
        ('sense = [["amb_C.sensor", "rotor.sensor_A"]]', "no component amb_C"),
    ],
)
def test_ports_that_are_not_there(tmp_path: Path, text: str, named: str) -> None:
    with pytest.raises(TouchdownError, match=named):
        open_system(scene_of(tmp_path, f'extends = "rotor1-9000"\n{text}\n'), in_process=True)


def test_a_scene_extends_another(tmp_path: Path) -> None:
    """Tables are merged, a component that names its FMU is new, and other scenes stay as they are."""
    (tmp_path / "other.toml").write_text('extends = "scene.toml"', encoding="utf-8")
    for wrong, said in (
        ("rotor1-900", "did you mean rotor1-9000"),
        *((name, "leads back to itself") for name in ("scene.toml", "other.toml")),
        ("none.toml", "cannot read scene"),
        ("", "extends = ''"),
    ):
        with pytest.raises(TouchdownError, match=said):
            scene_of(tmp_path, f'extends = "{wrong}"\n')
    text = 'extends = "rotor1-9000"\n[run]\nduration = 0.25\n[components.rotor.set]\nmodes = 3\n'
    scene = scene_of(tmp_path, f'{text}[components.bearing_B]\nfmu = "bushing"\n')
    base = load_scene("rotor1-9000")
    assert scene.run.duration == 0.25
    assert scene.run.macro_step == base.run.macro_step
    assert scene.components["rotor"].set == {**base.components["rotor"].set, "modes": 3}
    assert scene.components["bearing_B"].fmu == "bushing"
    assert not scene.components["bearing_B"].set
    assert scene.components["bearing_A"] == base.components["bearing_A"]
    assert scene.attach == base.attach


def test_only_what_is_asked_for_is_recorded(tmp_path: Path) -> None:
    """Figures that need more are left out; what is there is what a full recording has."""
    scene = load_scene("rotor1-9000").set({"run.duration": 1e-3})
    for name in ("amb_A", "amb_B"):
        scene = scene.set({f"{name}.shutdown_time": 4e-3})
    everything = run_scene(scene, tmp_path / "all", in_process=True)
    less = scene.set({"run.record": "rotor.A.y,amb_A"})
    little = run_scene(less, tmp_path / "some", in_process=True)
    assert "whirl" in everything.summary["seats"]["A"]
    assert "whirl" not in little.summary["seats"]["A"]
    full, part = (Recording(result.folder / "result.h5") for result in (everything, little))
    names = [name for name, _ in part.columns()]
    assert "rotor.A.y" in names
    assert all(name == "rotor.A.y" or name.startswith("amb_A.") for name in names)
    for name in names:
        assert (part[name] == full[name]).all()
    with pytest.raises(NotRecordedError, match=r"rotor\.B\.y was not recorded"):
        _ = part["rotor.B.y"]
    full.close()
    part.close()


def test_a_bearing_that_is_done_keeps_its_last_values(tmp_path: Path) -> None:
    """After the shutdown the magnetic bearings are not stepped; their columns go on with what they gave."""
    scene = load_scene("rotor1-9000").set({"run.duration": 8e-3})
    for name in ("amb_A", "amb_B"):
        scene = scene.set({f"{name}.shutdown_time": 2e-3})
    result = run_scene(scene, tmp_path, in_process=True)
    recording = Recording(result.folder / "result.h5")
    late = recording.time > 5e-3
    assert (recording["amb_A.active"][late] == 0.0).all()
    supplied = recording["amb_A.supplied"]
    assert supplied[-1] != 0.0
    assert (supplied[late] == supplied[-1]).all()
    assert (recording["amb_A.journal.fy"][late] == 0.0).all()
    recording.close()
