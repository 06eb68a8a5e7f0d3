"""Ball bearings with a contact angle at rest: closed forms, a solution of Jones', published cases."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import root

from touchdown.bearings.angular.row import (
    BACK_TO_BACK,
    FACE_TO_FACE,
    TANDEM,
    TANDEM_REVERSED,
    Pose,
    pressed,
)
from touchdown.bearings.angular.statics import Mounted, balance, balls_on
from touchdown.bearings.contact.laws import race_contact_stiffness
from touchdown.bearings.contact.materials import SILICON_NITRIDE, STEEL_NUMBERS, effective_modulus
from touchdown.bearings.rolling.ball_set import BallSet

B218 = Mounted(
    BallSet(count=16, diameter=22.23e-3, pitch_diameter=125.26e-3, conformity=1.0464, play=0.0),
    math.radians(40.0),
)
SPINDLE = Mounted(  # a pair of hybrid bearings of the size 71904
    BallSet(count=17, diameter=4.8e-3, pitch_diameter=28.5e-3, play=0.0, material=SILICON_NITRIDE),
    math.radians(25.0),
    arrangement=BACK_TO_BACK,
    distance=9e-3,
    preload=100.0,
)


def jones(bearing: Mounted, load: np.ndarray) -> np.ndarray:
    """Pose (5,) by Jones' equations at rest: each ball in balance between both races, found numerically.

    An implementation of its own: two contacts apart, directions from the ball's centre, no common spring.
    """
    b, modulus = bearing.balls, effective_modulus(STEEL_NUMBERS, STEEL_NUMBERS)
    a0 = bearing.contact_angle
    arc = 0.5 * (b.conformity - 1.0) * b.diameter
    middle = 0.5 * b.pitch_diameter / math.cos(a0)
    inner, outer = (
        float(race_contact_stiffness(b.diameter, radius, b.conformity, modulus, 0))
        for radius in (middle - 0.5 * b.diameter, -middle - 0.5 * b.diameter)
    )
    radius = 0.5 * b.pitch_diameter + arc * math.cos(a0)

    def ball(gap: np.ndarray) -> np.ndarray:
        """Force (2,) outwards and along of a ball on the outer ring; gap: between groove centres (m)."""

        def off(at: np.ndarray) -> np.ndarray:
            to_outer, to_inner = 1e-6 * at, gap - 1e-6 * at
            lo, li = np.linalg.norm(to_outer), np.linalg.norm(to_inner)
            qo, qi = outer * max(lo - arc, 0.0) ** 1.5, inner * max(li - arc, 0.0) ** 1.5
            return qo * to_outer / lo - qi * to_inner / li

        at = root(off, 0.5e6 * gap, tol=1e-15).x * 1e-6
        size = np.linalg.norm(at)
        return outer * max(size - arc, 0.0) ** 1.5 * at / size

    def off(scaled: np.ndarray) -> np.ndarray:
        x, y, z, rx, ry = scaled * (1e-6, 1e-6, 1e-6, 1e-4, 1e-4)
        left, at = -load.astype(float), arc * math.sin(a0)
        for angle in bearing.angles():
            c, s = math.cos(angle), math.sin(angle)
            tilt = ry * c - rx * s
            ahead = 2.0 * arc * math.cos(a0) + x * c + y * s + at * tilt
            up = 2.0 * arc * math.sin(a0) + z - radius * tilt
            fr, fz = ball(np.array([ahead, up]))
            own = (fr * c, fr * s, fz, radius * fz * s - at * fr * s, at * fr * c - radius * fz * c)
            left += own
        return left / np.array([1.0, 1.0, 1.0, radius, radius]) / np.abs(load[:3]).max()

    found = root(off, np.array([5.0, 1.0, 40.0, 1.0, 1.0]), tol=1e-14)
    assert np.abs(found.fun).max() < 1e-11
    return found.x * (1e-6, 1e-6, 1e-6, 1e-4, 1e-4)


def test_a_solution_of_jones_with_all_loads() -> None:
    load = np.array([4e3, -1e3, 17.8e3, 30.0, 60.0])
    found = balance(B218.rows(), B218.angles(), load)
    assert found.pose == pytest.approx(jones(B218, load), rel=1e-9, abs=1e-14)


@pytest.mark.parametrize("arrangement", [BACK_TO_BACK, FACE_TO_FACE])
def test_preload_holds_a_pair(arrangement: int) -> None:
    pair = replace(SPINDLE, arrangement=arrangement)
    load, slope = balls_on(pair.rows(), pair.angles(), np.zeros(5))
    assert load == pytest.approx(0.0, abs=1e-10)
    assert np.abs(slope - slope.T).max() < 1e-9 * np.abs(slope).max()
    assert np.linalg.eigvalsh(slope).min() > 0.0
    balls = [pressed(row, Pose(0.0, 0.0, 0.0, 0.0, 0.0), 1.0, 0.0) for row in pair.rows()]
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
