"""Swaps: every role, from wherever the user stands, and what becomes of the settings."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import pytest
from commands import SCENE, Command

import touchdown
from touchdown.fmus.recipes import preset
from touchdown.master.common.errors import TouchdownError
from touchdown.master.coupling.simulation import opened
from touchdown.master.scene.file import load_scene
from touchdown.master.scene.scene import retitled

SHORT = touchdown.Element(length=0.05, outer_diameter=0.02, modulus=207e9, density=7830.0, poisson=0.3)
SHAFT = touchdown.Rotor(
    "Short shaft",
    8 * (SHORT,),
    stations=[touchdown.Station("A", 5), touchdown.Station("amb", 5)],
    levitated_at=["amb"],
)
BRIEF = ("--set", "run.duration=1e-4")


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Where the user stands: a folder with files of each kind in one of its folders."""
    folder = tmp_path / "here" / "mine"
    folder.mkdir(parents=True)
    monkeypatch.chdir(tmp_path / "here")
    SHAFT.save(folder / "shaft.toml")
    return tmp_path / "here"


def brief(scene: touchdown.Scene) -> touchdown.Result:
    """A run of a few macro steps, in process where it can be."""
    return touchdown.run(scene.set({"run.duration": 1e-4}), in_process=True)


@pytest.mark.parametrize("way", ["mine/shaft.toml", "./mine/../mine/shaft.toml", "{here}/mine/shaft.toml"])
def test_a_rotor_file_is_looked_up_where_the_user_stands(way: str, here: Path) -> None:
    swapped = load_scene(SCENE).swap(rotor=way.format(here=here))
    assert Path(swapped.components["rotor"].fmu).is_absolute()
    assert brief(swapped).ended is touchdown.Ended.COMPLETED


def test_a_missing_file_is_named_by_where_it_was_looked_for(run: Command, here: Path) -> None:
    for name in ("my.toml", "my.fmu"):
        assert str(Path.cwd() / name) in run(SCENE, "--swap", f"rotor={name}").line


def test_every_role_by_name_and_by_file(run: Command, built: Mapping[str, Path], here: Path) -> None:
    """Each put in for itself from a file, and another of its kind by name where there is one."""
    swaps = {"rotor": "rigid_rotor", "amb": "amb", "bearing": "simplified_cageless", "housing": "housing"}
    for name, fmu in swaps.items():
        copy = Path.cwd() / f"{fmu}.fmu"
        copy.write_bytes(built[fmu].read_bytes())
        for way in (fmu, copy.name):
            ended = run(SCENE, *BRIEF, "--swap", f"{name}={way}")
            assert (ended.status, ended.stderr) == (0, ""), (name, way)


def test_a_rotor_with_other_ports_is_refused_by_its_ports(run: Command) -> None:
    line = run(SCENE, *BRIEF, "--swap", "rotor=rotor_I").line
    assert "rotor_I, in process has no variable amb.x" in line
    assert "(ports it has: A, B, amb_A, amb_B, sensor_A, sensor_B)" in line


def test_a_rotor_with_other_ports_can_be_told_them(run: Command, here: Path) -> None:
    Path("ports.toml").write_text('amb = "amb_A"\n')
    ended = run(SCENE, *BRIEF, "--swap", "rotor=rotor_I", "--names", "rotor=ports.toml")
    assert ended.status == 0
    assert ended.stderr.splitlines() == [
        "touchdown: warning: rotor is rotor_I instead of rigid_rotor, and does not take over rotor.mass; "
        "rotor.inertia"
    ]


def test_what_the_user_set_stays_and_must_fit(run: Command) -> None:
    scene = load_scene(SCENE)
    for changed in (
        scene.set({"rotor.mass": "2 kg"}).swap(rotor="rotor_I"),
        scene.swap(rotor="rotor_I").set({"rotor.mass": "2 kg"}),
    ):
        with pytest.raises(TouchdownError, match=r"rotor\.mass has the causality calculatedParameter"):
            brief(changed)
    line = run(SCENE, *BRIEF, "--swap", "bearing=bushing", "--set", "bearing.balls.first_angle=1").line
    assert "bearing (bushing, in process) has no variable balls.first_angle" in line


def test_what_the_scene_set_is_taken_over_where_it_can_be() -> None:
    scene = load_scene(SCENE)
    taken = brief(scene.swap(bearing="simplified_cageless"))
    assert taken.warnings == []
    left = brief(scene.swap(bearing="bushing"))
    assert left.warnings == [
        "bearing is bushing instead of simplified_caged, and does not take over bearing.balls.first_angle"
    ]


def test_another_model_is_of_the_same_bearing() -> None:
    """It takes the preset of the scene as far as it can; a bushing has nothing of balls to take."""
    scene = load_scene("rotor1-9000").set({"bearing_A.preset": "6006"})
    found: dict[str, dict[str, float]] = {}
    for model in ("simplified_caged", "detailed_cageless", "bushing"):
        own = replace(scene.components["bearing_A"], own=())  # as if the scene's file said so
        written = replace(scene, components={**scene.components, "bearing_A": own})
        with opened(written.swap(bearing_A=model), in_process=True) as system:
            found[model] = {
                name: system.value(f"bearing_A.{name}")
                for name in ("balls.count", "balls.diameter", "ring.mass")
                if f"bearing_A.{name}" in system
            }
    assert found["detailed_cageless"] == found["simplified_caged"]
    assert found["simplified_caged"]["balls.diameter"] == pytest.approx(preset("6006")["balls.diameter"])
    assert found["bushing"] == {}
    assert written.swap(bearing_A="own.fmu").components["bearing_A"].preset is None


def test_a_zero_that_goes_with_its_component() -> None:
    """Times count from the start, and what is told says so."""
    result = brief(load_scene(SCENE).swap(amb="bushing"))
    (line,) = result.warnings
    assert "amb.shutdown_time; zero = amb.shutdown_time, so times count from the start" in line
    assert result.summary["simulated_time"] == pytest.approx(1e-4)


def test_a_setting_of_the_users_outlives_two_swaps() -> None:
    scene = load_scene(SCENE).set({"bearing.clearance": "0.2 mm", "bearing.preset": "6904"})
    spec = scene.swap(bearing="bushing").swap(bearing="detailed_caged").components["bearing"]
    assert spec.set == {"clearance": "0.2 mm"}
    assert spec.preset == "6904"
    assert spec.instead_of == "simplified_caged"


@pytest.mark.parametrize(
    ("title", "swap", "alone", "after"),
    [
        ("Dropped on a simplified caged bearing", ("bearing", "simplified_caged", "detailed_caged"), True,
         "Dropped on a detailed caged bearing"),
        ("Rotor I dropped", ("rotor", "rotor_I", "/my/own_rotor.toml"), True, "Own rotor dropped"),
        ("Rotor II dropped", ("rotor", "rotor_I", "own"), True, "Rotor II dropped (rotor: own)"),
        ("Two", ("bearing_A", "bushing", "amb"), False, "Two (bearing_A: amb)"),
        ("Two (bearing_A: amb)", ("bearing_A", "amb", "bushing"), False, "Two (bearing_A: bushing)"),
        ("Amb dropped", ("amb", "amb", "bushing"), True, "Bushing dropped"),
        ("A rotor", ("rotor", "rotor_I", "/c/short_shaft_0123456789abcdef.toml"), True,
         "A rotor (rotor: short shaft)"),
        ("A disk", ("rotor", "rigid_rotor", "rigid_rotor"), True, "A disk"),
    ],
)  # fmt: skip
def test_titles_follow(title: str, swap: tuple[str, str, str], alone: bool, after: str) -> None:
    assert retitled(title, *swap, alone) == after


def test_pictures_bear_the_new_title() -> None:
    swapped = load_scene(SCENE).swap(bearing="detailed_caged")
    assert swapped.title == "Rigid disk dropped on a detailed caged bearing"
    twice = load_scene("rotor1-detailed").swap(bearing_A="simplified_cageless")
    assert twice.title.endswith("on two detailed bearings (bearing_A: simplified cageless)")
