"""Ball bearings with a contact angle at rest: closed forms, a solution of Jones', published cases."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from touchdown.bearings.angular.angular_row import (
    BACK_TO_BACK,
    FACE_TO_FACE,
    TANDEM,
    TANDEM_REVERSED,
    Pose,
    pressed,
)
from touchdown.bearings.angular.pair_statics import MountedRows, balance, balls_on
from touchdown.bearings.contact.materials import SILICON_NITRIDE
from touchdown.bearings.rolling.ball_set import BallSet

SPINDLE = MountedRows(  # a pair of hybrid bearings of the size 71904
    BallSet(count=17, diameter=4.8e-3, pitch_diameter=28.5e-3, play=0.0, material=SILICON_NITRIDE),
    math.radians(25.0),
    arrangement=BACK_TO_BACK,
    distance=9e-3,
    preload=100.0,
)


@pytest.mark.parametrize("arrangement", [BACK_TO_BACK, FACE_TO_FACE])
def test_preload_holds_a_pair(arrangement: int) -> None:
    pair = replace(SPINDLE, arrangement=arrangement)
    load, slope = balls_on(pair.rows(), pair.angles(), np.zeros(5))
    assert load == pytest.approx(0.0, abs=1e-10)
    assert np.abs(slope - slope.T).max() < 1e-9 * np.abs(slope).max()
    assert np.linalg.eigvalsh(slope).min() > 0.0
    balls = [pressed(row, Pose(0.0, 0.0, 0.0, 0.0, 0.0), 1.0, 0.0, 0.0) for row in pair.rows()]
    assert [17 * ball.along for ball in balls] == pytest.approx(
        [100.0, -100.0] if arrangement == BACK_TO_BACK else [-100.0, 100.0], rel=1e-10
    )


def test_stiffness_is_the_slope_of_the_load() -> None:
    """At a shifted and tilted pose, by central differences (1e-6 of the largest: their own error)."""
    rows, angles = SPINDLE.rows(), SPINDLE.angles()
    pose = np.array([1e-6, -2e-6, 1.5e-6, 5e-5, -8e-5])
    _, slope = balls_on(rows, angles, pose)
    for k, step in enumerate((1e-9, 1e-9, 1e-9, 1e-7, 1e-7)):
        ahead = np.eye(5)[k] * step
        by = (balls_on(rows, angles, pose + ahead)[0] - balls_on(rows, angles, pose - ahead)[0]) / (
            2 * step
        )
        assert by == pytest.approx(slope[:, k], abs=1e-5 * np.abs(slope[:, k]).max())


def test_back_to_back_resists_tilt_and_tandem_shares_thrust() -> None:
    tilts = [
        balls_on(pair.rows(), pair.angles(), np.zeros(5))[1][4, 4]
        for pair in (SPINDLE, replace(SPINDLE, arrangement=FACE_TO_FACE))
    ]
    assert tilts[0] > 2.0 * tilts[1]
    tandem = replace(SPINDLE, arrangement=TANDEM, preload=0.0)
    found = balance(tandem.rows(), tandem.angles(), (0.0, 0.0, 200.0, 0.0, 0.0))
    assert found.forces[0] == pytest.approx(found.forces[1], rel=1e-9)
    turned = replace(tandem, arrangement=TANDEM_REVERSED)
    mirrored = balance(turned.rows(), turned.angles(), (0.0, 0.0, -200.0, 0.0, 0.0))
    assert mirrored.pose[2] == pytest.approx(-found.pose[2], rel=1e-9)
    np.testing.assert_allclose(mirrored.angles, -found.angles, rtol=1e-9)
    for pair, push in ((tandem, -200.0), (turned, 200.0)):
        with pytest.raises(ValueError, match="no shoulder"):
            balance(pair.rows(), pair.angles(), (0.0, 0.0, push, 0.0, 0.0))


def test_a_pair_with_play_is_free_along_the_shaft_by_it() -> None:
    """By half of it to either side, at which one row's balls just touch."""
    pair = replace(SPINDLE, preload=0.0, interference=-10e-6)
    for side in (-1.0, 1.0):
        free, held = (
            balls_on(pair.rows(), pair.angles(), np.array([0, 0, side * z, 0, 0]))
            for z in (4.99e-6, 5.5e-6)
        )
        assert np.abs(free[0]).max() == 0.0
        assert side * held[0][2] > 1.0
