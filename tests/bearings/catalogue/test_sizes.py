"""The sizes of ISO 15, filled in by rules: their parts fit, and how far they are off makers' catalogues."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from ball_sets import derived, problem_of

from touchdown.bearings.catalogue import (
    NUMBERS,
    Bearing,
    CatalogueError,
    bearing,
    bearing_reference,
    built_in,
)
from touchdown.bearings.catalogue.sizes import FROM_SOURCE, designations, size
from touchdown.master.common.errors import TouchdownError
from touchdown.master.coupling.simulation import open_system
from touchdown.master.scene.file import load_scene

PUBLISHED = {  # C and C_0 (kN), mass (kg; 0: not looked up)
    # NTN, deep groove ball bearings 67, 68, 69, 60, 62, 63 (there 68 and 69 are 618 and 619)
    "61800": (1.83, 0.925, 0.0),
    "61900": (2.70, 1.27, 0.0),
    "6000": (4.55, 1.96, 0.0),
    "6200": (5.10, 2.39, 0.0),
    "6300": (8.20, 3.50, 0.0),
    "61801": (1.92, 1.04, 0.0),
    "61901": (2.89, 1.46, 0.0),
    "6001": (5.10, 2.39, 0.0),
    # SKF, rolling bearings (2018): grooves and steel of its own, C above that of ISO 281
    "61804": (4.03, 2.32, 0.018),
    "61904": (6.37, 3.65, 0.037),
    "6204": (13.5, 6.55, 0.11),
    "6304": (16.8, 7.80, 0.14),
    "6305": (23.4, 11.6, 0.23),
    "6209": (35.1, 21.6, 0.42),
    "6010": (22.9, 16.0, 0.26),
    "6310": (65.0, 38.0, 1.05),
    "6214": (63.7, 45.0, 1.10),
    "6314": (111.0, 68.0, 2.55),
    # SKF, super-precision bearings: 15 deg
    "7014": (52.0, 45.5, 0.0),
}


def mass(made: Bearing) -> float:
    """Of the whole bearing (kg): rings, cage as two balls, balls."""
    return made.ring.mass + made.outer_ring + made.cage * (1.0 + made.balls.count / 2.0)


def off(number: int) -> np.ndarray:
    """Of one of the published numbers of each bearing, how far ours is off, relatively."""
    ours = [(1e-3 * b.dynamic_rating, 1e-3 * b.static_rating, mass(b)) for b in map(bearing, PUBLISHED)]
    theirs = [row[number] for row in PUBLISHED.values()]
    return np.array([own[number] / row - 1.0 for own, row in zip(ours, theirs, strict=True) if row])


def test_ratings_are_near_published_ones() -> None:
    """What `docs/bearings.md` says of them: on average, typically, at most."""
    dynamic, static = off(0), off(1)
    assert abs(dynamic.mean()) < 0.03
    assert dynamic.std() < 0.12
    assert abs(dynamic).max() < 0.20
    assert abs(static.mean()) < 0.05
    assert static.std() < 0.08
    assert abs(static).max() < 0.15


def test_masses_are_near_published_ones() -> None:
    masses = off(2)
    assert masses.size == 10
    assert abs(masses).max() < 0.08


def test_those_of_the_source_come_first() -> None:
    assert built_in()[:3] == ["6004", "6904", "6014"]
    assert len(built_in()) == len(set(built_in())) == 192
    assert bearing("6014").balls.count == 11
    assert size("6014").balls.count == 13


@pytest.mark.parametrize(("name", "plain"), [("7014 CD", "7014 C"), ("71907 ACD/HC5", "71907 AC HC")])
def test_skf_s_designs_are_understood(name: str, plain: str) -> None:
    assert bearing(name).settings() == bearing(plain).settings()


@pytest.mark.parametrize(
    ("name", "meant"),
    [
        ("7014CD", "7014 C"),
        ("7014 CDGA/HCP4A", "7014 C HC"),
        ("71907 ACE/P4ADB", "71907 AC"),
        ("6202/HC5C3", "6202 HC"),
        ("6202-2Z/C3", "6202"),
        ("B7014-C", "7014 C"),
        ("HC7014", "7014 HC"),
    ],
)
def test_other_names_of_makers_are_answered(name: str, meant: str, tmp_path: Path) -> None:
    with pytest.raises(CatalogueError) as refused:
        bearing_reference(name, tmp_path)
    assert str(refused.value).endswith(f" {meant}")
    assert bearing_reference(meant, tmp_path) == meant


CATALOGUE = {bearing.designation: bearing for bearing in FROM_SOURCE}


@pytest.mark.parametrize(
    "made", [*FROM_SOURCE, *map(size, designations()[::7])], ids=lambda b: b.designation
)
def test_the_parts_of_a_bearing_fit(made: Bearing) -> None:
    balls = made.balls
    assert problem_of(balls) is None
    assert made.bore < balls.pitch_diameter - balls.diameter
    assert balls.pitch_diameter + balls.diameter < made.outside
    assert balls.diameter < made.width
    assert min(made.ring.mass, made.static_rating) > 0.0
    if made in FROM_SOURCE:
        assert made.settings()["cage.mass"] == 2.0 * derived(balls)["mass"]
    else:
        assert made.outer_ring > 0.0
        assert made.origins.keys() == made.numbers().keys() == NUMBERS.keys()


def test_a_preset_reaches_the_component() -> None:
    """And what the scene sets comes after it."""
    scene = load_scene("disk-caged-simplified").set({"bearing.preset": "6014", "bearing.balls.play": 1e-6})
    system = open_system(scene, in_process=True)
    assert system.value("bearing.balls.count") == CATALOGUE["6014"].balls.count
    assert system.value("bearing.rolling.static_rating") == CATALOGUE["6014"].static_rating
    assert system.value("bearing.balls.play") == 1e-6


def test_an_unknown_preset_is_named() -> None:
    with pytest.raises(TouchdownError, match="no bearing 6504; did you mean 6"):
        load_scene("disk-caged-simplified").set({"bearing.preset": "6504"})
