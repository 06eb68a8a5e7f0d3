"""The bearings of the source: they fit, weigh and give way as they should, and reach components."""

from __future__ import annotations

import pytest
from ball_sets import derived, problem_of, stiffness_of

from touchdown.bearings.catalogue.sizes import FROM_SOURCE
from touchdown.master.common.errors import TouchdownError
from touchdown.master.coupling.simulation import open_system
from touchdown.master.scene.file import load_scene

CATALOGUE = {bearing.designation: bearing for bearing in FROM_SOURCE}
STIFFNESS = {  # inner, outer, series in 1e10 N/m^1.5, by (2.43)-(2.46) as corrected
    "6004": (2.322, 2.436, 0.841),
    "6904": (2.021, 2.102, 0.729),
    "6014": (3.210, 3.311, 1.152),
    "7914": (3.168, 3.271, 1.138),
    "7914 pair": (3.168, 3.271, 1.138),  # per ball
}


@pytest.mark.parametrize("name", sorted(CATALOGUE))
def test_contact_stiffness(name: str) -> None:
    found = [1e-10 * k for k in stiffness_of(CATALOGUE[name].balls)]
    assert found == pytest.approx(STIFFNESS[name], abs=6e-4)


@pytest.mark.parametrize("name", sorted(CATALOGUE))
def test_the_parts_fit_together(name: str) -> None:
    bearing = CATALOGUE[name]
    balls = bearing.balls
    assert problem_of(balls) is None
    assert bearing.bore < balls.pitch_diameter - balls.diameter
    assert balls.pitch_diameter + balls.diameter < bearing.outside
    assert balls.diameter < bearing.width
    assert bearing.settings()["cage.mass"] == 2.0 * derived(balls)["mass"]


@pytest.mark.parametrize("name", sorted(CATALOGUE))
def test_a_preset_reaches_the_component(name: str) -> None:
    scene = load_scene("disk-caged-simplified").set({"bearing.preset": name})
    system = open_system(scene.set({"bearing.balls.play": 1e-6}), in_process=True)
    assert system.value("bearing.balls.count") == CATALOGUE[name].balls.count
    assert system.value("bearing.balls.rows") == CATALOGUE[name].balls.rows
    assert system.value("bearing.rolling.static_rating") == CATALOGUE[name].static_rating
    assert system.value("bearing.balls.play") == 1e-6  # what the scene sets comes after the preset


def test_an_unknown_preset_is_named() -> None:
    with pytest.raises(TouchdownError, match="no bearing 6504; did you mean 6"):
        load_scene("disk-caged-simplified").set({"bearing.preset": "6504"})


@pytest.mark.parametrize("name", sorted(CATALOGUE))
def test_each_number_has_an_origin(name: str) -> None:
    assert CATALOGUE[name].origins.keys() == CATALOGUE[name].numbers().keys()
