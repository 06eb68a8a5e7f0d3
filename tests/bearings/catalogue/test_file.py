"""Bearings of a user's own: found, filled in, and each mistake told in one line."""

from __future__ import annotations

from pathlib import Path

import pytest

from touchdown.bearings.catalogue import CatalogueError, bearing, bearing_file_text, bearing_reference, own
from touchdown.bearings.catalogue.bearing_file import read_bearings
from touchdown.master.common.errors import TouchdownError
from touchdown.master.coupling.simulation import opened
from touchdown.master.scene.file import load_scene

OURS = """
["our 7014"]
kind = "angular contact"
bore = "70 mm"
outside = "110 mm"
width = "20 mm"
balls = 19
static_rating = "43 kN"

["our 7014".origins]
static_rating = "the drawing"
"""
SIZES = 'bore = "20 mm"\noutside = "42 mm"\nwidth = "12 mm"\n'
SCENE = '[components.bearing]\nfmu = "simplified_caged"\npreset = "{}"\n'


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder with a file of one's own."""
    (tmp_path / "bearings.toml").write_text(OURS, encoding="utf-8")
    return tmp_path


def test_what_is_given_stays_and_the_rest_is_filled_in(folder: Path) -> None:
    made = own(folder)["our 7014"]
    rule = bearing("7014")
    assert (made.balls.count, made.static_rating) == (19, 43000.0)
    assert made.balls.diameter == rule.balls.diameter
    assert made.dynamic_rating == pytest.approx(rule.dynamic_rating * (19 / 20) ** (2 / 3))
    assert made.origins["static_rating"] == "the drawing"
    assert made.origins["balls"] == "bearings.toml"
    assert made.origins["dynamic_rating"] == "ISO 281"
    assert made.capacity().static == 43000.0


def test_found_from_the_scenes_folder_or_by_a_path(folder: Path) -> None:
    found = bearing_reference("our 7014", folder)
    assert (
        found
        == bearing_reference("bearings.toml:our 7014", folder)
        == f"{folder / 'bearings.toml'}:our 7014"
    )
    assert bearing(found).balls.count == 19
    assert bearing_reference("7014", folder) == "7014"


def test_ones_own_come_before_the_built_in(folder: Path) -> None:
    text = bearing_file_text(bearing("6305")).replace("balls = 7", "balls = 8")
    (folder / "bearings.toml").write_text(text, encoding="utf-8")
    assert bearing(bearing_reference("6305", folder)).balls.count == 8
    assert bearing("6305").balls.count == 7


@pytest.mark.parametrize("name", ["6004", "7914 pair", "7014", "61800"])
def test_a_bearing_written_is_read_again(name: str, tmp_path: Path) -> None:
    """But for the source's way to compute stiffness, and six digits."""
    path = tmp_path / "own.toml"
    path.write_text(bearing_file_text(bearing(name)), encoding="utf-8")
    again = read_bearings(path)[name]
    assert again.numbers() == pytest.approx(bearing(name).numbers(), rel=1e-5)
    assert again.origins == bearing(name).origins


def test_a_scene_takes_it(folder: Path) -> None:
    path = folder / "scene.toml"
    path.write_text(SCENE.format("our 7014"), encoding="utf-8")
    scene = load_scene(str(path))
    with opened(scene, in_process=True) as system:
        assert system.value("bearing.balls.count") == 19
    again = load_scene("disk-caged-simplified").set(
        {"bearing.preset": f"{folder / 'bearings.toml'}:our 7014"}
    )
    assert again.components["bearing"].preset == scene.components["bearing"].preset
    path.write_text(SCENE.format("our 701"), encoding="utf-8")
    with pytest.raises(
        TouchdownError, match=r"bearing: there is no bearing our 701; did you mean our 7014"
    ):
        load_scene(str(path))


def test_a_setting_finds_it_from_where_the_user_stands(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What the scene's own folder does not have."""
    monkeypatch.chdir(folder)
    scene = load_scene("disk-caged-simplified")
    found = f"{folder / 'bearings.toml'}:our 7014"
    for name in ("our 7014", "bearings.toml:our 7014"):
        assert scene.set({"bearing.preset": name}).components["bearing"].preset == found
    with pytest.raises(TouchdownError, match="bearing: there is no bearing our 701; did you mean"):
        scene.set({"bearing.preset": "our 701"})
    (folder / "bearings.toml").write_text("[a", encoding="utf-8")
    with pytest.raises(TouchdownError, match="not valid TOML"):
        scene.set({"bearing.preset": "our 7014"})
    assert scene.set({"bearing.preset": "7014"}).components["bearing"].preset == "7014"


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("[a]\n", "bore is missing"),
        ("[a", "not valid TOML"),
        ("[a]\n" + SIZES.replace('"20 mm"', "20"), "a.bore = 20 has no unit; write text with a unit of m"),
        ("[a]\n" + SIZES.replace("42 mm", "19 mm"), "outside = '19 mm' must be above bore = 0.02 m"),
        ("[a]\n" + SIZES + "ball = 3\n", "ball is not a known key; did you mean ball_diameter or balls"),
        ("[a]\n" + SIZES + 'ball_diameter = "12 mm"\n', "do not fit between bore and outside"),
        ("[a]\n" + SIZES + "inner_groove = 0.4\n", "not a ball bearing"),
        ("[a]\n" + SIZES + 'contact_angle = "100 deg"\n', "contact angle of 1.74533 rad"),
        ("[a]\n" + SIZES.replace("12 mm", "0.1 mm"), "leaves nothing of a ring"),
        ("[a]\n" + SIZES + 'kind = "roller"\n', "there are: angular contact, deep groove"),
        ("[a]\n" + SIZES + "[a.origins]\nbores = 'x'\n", "a.origins.bores is not a known key"),
    ],
)
def test_a_mistake_is_one_line(text: str, says: str, tmp_path: Path) -> None:
    (tmp_path / "bearings.toml").write_text(text, encoding="utf-8")
    with pytest.raises(TouchdownError) as caught:
        own(tmp_path)
    assert says in str(caught.value)
    assert str(tmp_path / "bearings.toml") in str(caught.value)
    assert "\n" not in str(caught.value)


def test_what_is_not_there_is_named(folder: Path) -> None:
    with pytest.raises(TouchdownError, match=r"cannot read .*others.toml: No such"):
        bearing_reference("others.toml:x", folder)
    with pytest.raises(CatalogueError, match=r"bearings.toml: there is no bearing x; there are: our 7014"):
        bearing_reference("bearings.toml:x", folder)
    with pytest.raises(CatalogueError, match="there is no bearing our; did you mean our 7014"):
        bearing_reference("our", folder)


def test_a_row_either_way_round_has_no_contact_angle_in_drops(folder: Path) -> None:
    """Its `single reversed` is for statics; a scene that wants a row under thrust sets the angle itself."""
    reversed_ = OURS.replace("balls = 19", 'balls = 19\narrangement = "single reversed"')
    (folder / "bearings.toml").write_text(reversed_.replace("our 7014", "reversed"), encoding="utf-8")
    turned, rule = own(folder)["reversed"], bearing("7014")
    assert turned.contact_angle == rule.contact_angle > 0.0
    assert turned.angle_in_drops == rule.angle_in_drops == 0.0
    assert turned.settings().keys() == rule.settings().keys()
