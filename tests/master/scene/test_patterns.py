"""One setting for all components whose names match."""

from __future__ import annotations

from pathlib import Path

import pytest

from touchdown.master.common.errors import TouchdownError
from touchdown.master.scene.file import load_scene
from touchdown.master.scene.scene import Scene

SCENE = "rotor1-9000"


def given(scene: Scene, setting: str) -> list[object]:
    """What is set in each of the touchdown bearings."""
    return [scene.components[name].set.get(setting) for name in ("bearing_A", "bearing_B")]


def test_a_pattern_sets_all_that_match() -> None:
    scene = load_scene(SCENE).set({"bearing_*.friction.dynamic": 0.2, "amb_?.damping": "300 N.s/m"})
    assert given(scene, "friction.dynamic") == [0.2, 0.2]
    assert scene.components["amb_B"].set["damping"] == "300 N.s/m"
    assert "friction.dynamic" not in scene.components["housing_A"].set


def test_the_last_one_counts() -> None:
    scene = load_scene(SCENE).set({"bearing_*.clearance": 1e-4, "bearing_B.clearance": 2e-4})
    assert given(scene, "clearance") == [1e-4, 2e-4]
    assert given(scene.set({"b*.clearance": 3e-4}), "clearance") == [3e-4, 3e-4]


def test_presets_and_steps_by_pattern() -> None:
    scene = load_scene(SCENE).set({"bearing_*.preset": "61904", "bearing_*.every": 2})
    assert {scene.components[f"bearing_{end}"].preset for end in "AB"} == {"61904"}
    assert {scene.components[f"bearing_{end}"].every for end in "AB"} == {2}


def test_a_pattern_without_a_match_is_refused() -> None:
    with pytest.raises(
        TouchdownError, match=r"no component of scene rotor1-9000 matches brg_\*; there are"
    ):
        load_scene(SCENE).set({"brg_*.clearance": 1e-4})
    with pytest.raises(TouchdownError, match=r"matches r\*n; there are: rotor, amb_A"):
        load_scene(SCENE).set({"r*n.duration": 1.0})
    with pytest.raises(TouchdownError, match=r"cannot set bearing_A; write COMPONENT"):
        load_scene(SCENE).set({"bearing_*": 1.0})


def test_a_file_sets_what_several_share(tmp_path: Path) -> None:
    """Over what the scene it extends says, too; a swap takes it over as the scene's."""
    path = tmp_path / "mine.toml"
    path.write_text(
        f'extends = "{SCENE}"\n[set]\n"run.duration" = "20 ms"\n'
        '[set."bearing_*"]\nfriction.dynamic = 0.2\npreset = "61904"\n',
        encoding="utf-8",
    )
    scene = load_scene(str(path))
    assert given(scene, "friction.dynamic") == [0.2, 0.2]
    assert scene.run.duration == 0.02
    assert scene.components["bearing_A"].own == ()
    assert scene.own == ()
    swapped = scene.swap(bearing_A="bushing").components["bearing_A"]
    assert (swapped.preset, swapped.inherited["friction.dynamic"]) == ("61904", 0.2)


def test_a_file_s_pattern_without_a_match_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    path.write_text(f'extends = "{SCENE}"\n[set]\n"brg_*.clearance" = 1\n', encoding="utf-8")
    with pytest.raises(TouchdownError, match="no component of scene mine matches"):
        load_scene(str(path))


def test_what_is_said_of_one_component_counts_there(tmp_path: Path) -> None:
    """In the same file, and in one that extends it, whose own patterns count over both."""
    shared = '[set."bearing_*"]\nclearance = "0.25 mm"\n'
    (tmp_path / "base.toml").write_text(
        f'extends = "{SCENE}"\n{shared}[components.bearing_A.set]\nclearance = "0.3 mm"\n', "utf-8"
    )
    one = tmp_path / "one.toml"
    one.write_text('extends = "base.toml"\n[components.bearing_B.set]\nclearance = "0.4 mm"\n', "utf-8")
    assert given(load_scene(str(tmp_path / "base.toml")), "clearance") == ["0.3 mm", "0.25 mm"]
    assert given(load_scene(str(one)), "clearance") == ["0.3 mm", "0.4 mm"]
    both = tmp_path / "both.toml"
    both.write_text('extends = "one.toml"\n[set."bearing_*"]\nclearance = "0.2 mm"\n', "utf-8")
    assert given(load_scene(str(both)), "clearance") == ["0.2 mm", "0.2 mm"]
