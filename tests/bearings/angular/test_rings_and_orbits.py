"""Rings that give all around, and balls that their orbit throws outwards, in the simplified pair."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq, root

import touchdown
from tests.bearings.angular.test_in_a_bearing import BALLS, PAIR, paired, rates
from touchdown.bearings.angular import hoop, inner_ring
from touchdown.bearings.angular.angular_row import BallRow, Pose, pressed
from touchdown.bearings.angular.thrown_ball import (
    OrbitingBalls,
    ThrownBall,
    alone_on_outer,
    step_balls,
    thrown_ball,
)
from touchdown.bearings.contact.materials import STEEL_NUMBERS, Elastic
from touchdown.bearings.rolling import ring
from touchdown.modelkit.instance import Instance
from touchdown.modelkit.kernel import interpret
from touchdown.modelkit.variables import as_record

(ROW, _) = PAIR.rows()
RACE, RIM, OUTSIDE = 31.6e-3, 34e-3, 50e-3  # m
SPIN = 4000.0  # rad/s


def test_a_housing_of_the_rings_own_steel_is_a_thicker_ring() -> None:
    """Pressed into one, a ring gives as one ring of both; into a stiff one it still gives in itself."""
    pressed_in = hoop.outer_compliance(hoop.PRESSED, RACE, RIM, STEEL_NUMBERS, (OUTSIDE, STEEL_NUMBERS))
    assert pressed_in == pytest.approx(hoop.pressed_bore(RACE, OUTSIDE, STEEL_NUMBERS), rel=1e-12)
    soft, stiff = (
        hoop.outer_compliance(hoop.PRESSED, RACE, RIM, STEEL_NUMBERS, (OUTSIDE, Elastic(modulus, 0.3)))
        for modulus in (1.0, 1e20)
    )
    assert soft == pytest.approx(hoop.pressed_bore(RACE, RIM, STEEL_NUMBERS), rel=1e-9)
    assert 0.0 < stiff < pressed_in


def started(seat: int, **settings: float) -> Instance:
    """The pair with rings that give, started; settings: of balls and preload."""
    instance = paired()
    p = instance.record["p"]
    p["ring"]["hoop"], p["outer_ring"]["seat"], p["gravity"] = 1, seat, 0.0
    for name, value in settings.items():
        p[name] = value
    instance.start(0.0)
    return instance


@pytest.mark.parametrize("clamped", ["preload", "interference"])
def test_a_clamped_pair_starts_at_rest(clamped: str) -> None:
    """Nothing accelerates, each row bears the preload, and the race is closed by what its balls press."""
    values = {"preload": 100.0} if clamped == "preload" else {"preload": 0.0, "interference": 6e-6}
    instance = started(hoop.LOOSE, **values)
    m = instance.record
    q, n = m["q"][: int(m["n"])].copy(), int(m["n"])
    dq = rates(instance, q)
    bending = m["d"]["bending"]
    place = int(bending["first"]) + int(bending["waves"]) - 1
    closed = -float(bending["weight"][0]) * q[place]
    assert n == place + 2
    assert closed > 1e-7
    assert np.abs(dq[[ring.RVX, ring.RVY]]).max() < 1e-6
    held = float(bending["frequency"][0]) ** 2 * abs(q[place])
    assert abs(dq[place + 1]) < 1e-9 * held
    balls = []
    for kept in m["d"]["space"]["row"]:
        row = BallRow(*(float(kept[name]) for name in BallRow._fields))
        balls.append(pressed(row._replace(inner=row.inner - closed), Pose(*(0.0,) * 5), 1.0, 0.0, 0.0))
    if clamped == "preload":
        assert [abs(ball.along) * BALLS.count for ball in balls] == pytest.approx([100.0, 100.0], rel=1e-9)
    load = BALLS.count * sum(ball.outwards for ball in balls)
    assert closed == pytest.approx(hoop.hoop_compliance(m["p"]).race * load, rel=1e-9)


def balanced(ball: ThrownBall, thrown: float) -> tuple[float, float]:
    """What is left of the forces on a ball, across and along, over the largest."""
    largest = max(ball.outer, thrown)
    across = ball.outer * ball.outer_cosine - ball.inner * ball.cosine - thrown
    return across / largest, (ball.outer * ball.outer_sine - ball.inner * ball.sine) / largest


def found(balls: Any, u: float, v: float, thrown: float) -> ThrownBall:
    """The ball after the last one in `balls`, as the bearing finds it: by a step, or a search."""
    balls["u"][0], balls["v"][0] = u, v
    size = thrown, alone_on_outer(ROW, thrown), 0.0
    balls["missed"][0] = 1.0
    if balls["out"][0] != 0.0:  # IEEE arithmetic divides by it, Python's does not
        interpret(step_balls, ROW, *size, 0, 1, balls)
    return interpret(thrown_ball, ROW, *size, 0, balls)


def test_thrown_balls_are_in_balance() -> None:
    """300 places one after the other, as a search goes on from the last."""
    draw, balls = np.random.default_rng(7), as_record(OrbitingBalls())
    touched = 0
    for _ in range(300):
        depth, angle = draw.uniform(-4e-6, 2e-5), draw.uniform(-0.9, 0.9)
        u, v = (ROW.free + depth) * math.cos(angle), (ROW.free + depth) * math.sin(angle)
        thrown = 10.0 ** draw.uniform(-2.0, 2.5)
        found(balls, u, v, thrown)
        ball = found(
            balls, u, v, thrown
        )  # from where it is, as the first time leaves up to 1e-5 of directions
        assert np.abs(balanced(ball, thrown)).max() < 1e-8  # two steps from afar
        if ball.inner == 0.0:
            assert ball.outer == thrown
            continue
        touched += 1
        inner_way = ROW.inner_free + (ball.inner / ROW.inner_stiffness) ** (2.0 / 3.0)
        outer_way = ROW.free - ROW.inner_free + (ball.outer / ROW.outer_stiffness) ** (2.0 / 3.0)
        across = outer_way * ball.outer_cosine + inner_way * ball.cosine
        along = outer_way * ball.outer_sine + inner_way * ball.sine
        # 1e-6 of an indentation of 10 um; loads of 1 mN leave less
        assert (across, along) == pytest.approx((u, v), abs=2e-11)
    assert 150 < touched < 300


def test_a_slow_orbit_leaves_the_spring_between_the_grooves() -> None:
    pose = Pose(2e-6, 1e-6, 3e-6, 0.0, 0.0)
    spring = pressed(ROW, pose, 0.6, 0.8, 0.0)
    u = ROW.inner - ROW.outer + 0.6 * pose.x + 0.8 * pose.y
    v = ROW.inner_at - ROW.outer_at + pose.z
    ball = found(as_record(OrbitingBalls()), u, v, 1e-5)
    assert ball.inner == pytest.approx(spring.force, rel=1e-5)
    assert ball.sine == pytest.approx(spring.sine, rel=1e-5)
    assert ball.indentation == pytest.approx(spring.length - ROW.free, rel=1e-3)


def jones(thrown: float, row: BallRow = ROW) -> tuple[float, float, float]:
    """(Contact angles (rad) at inner and outer race, force (N) of the latter), the ring in the middle."""
    inner, outer = row.inner_free, row.free - row.inner_free
    u, v = row.inner - row.outer, row.inner_at - row.outer_at

    def off(p: np.ndarray) -> list[float]:
        lo, li = math.hypot(*p), math.hypot(u - p[0], v - p[1])
        qo, qi = (
            row.outer_stiffness * max(lo - outer, 0.0) ** 1.5,
            row.inner_stiffness * max(li - inner, 0.0) ** 1.5,
        )
        return [
            qo * p[0] / lo - qi * (u - p[0]) / li - thrown,
            qo * p[1] / lo - qi * (v - p[1]) / li,
        ]

    share = (outer + 1e-6) / row.free
    x, y = root(off, [share * u, share * v], tol=1e-13).x
    force = row.outer_stiffness * max(math.hypot(x, y) - outer, 0.0) ** 1.5
    return math.atan2(v - y, u - x), math.atan2(y, x), force


def test_a_spinning_pair_has_the_angles_of_its_speed() -> None:
    """Without other loads, the ring turning; the orbit is that of the angles found."""
    instance = paired()
    m = instance.record
    m["p"]["balls"]["centrifugal"], m["p"]["gravity"] = 1, 0.0
    instance.start(0.0)
    m["q"][ring.RW] = SPIN
    for k in range(40):
        instance.step(50e-6 * k, 50e-6)
    thrown = float(m["s"]["space"]["centrifugal"])
    angle, outer, force = jones(thrown)
    assert abs(float(m["o"]["along"]["contact_angle"])) == pytest.approx(angle, rel=1e-5)
    assert float(m["o"]["balls"]["force"]) == pytest.approx(force, rel=1e-5)
    ratio = BALLS.diameter / BALLS.pitch_diameter
    orbit = SPIN * (1.0 - ratio * math.cos(angle)) / (1.0 + math.cos(angle - outer))
    mass = float(m["d"]["mass"]) / 2.0
    assert thrown == pytest.approx(0.5 * mass * BALLS.pitch_diameter * orbit**2, rel=1e-4)
    assert math.degrees(angle - outer) > 5.0


def test_energy_closes_with_all_effects() -> None:
    """A drop onto the lying pair with rings that give and grow, thrown balls and heat, which spin up."""
    effects = ("balls.centrifugal", "ring.hoop", "ring.growth", "thermal")
    scene = touchdown.load("disk-upright-pair").set({f"bearing.{name}": 1 for name in effects})
    scene = scene.set({"bearing.outer_ring.seat": "loose", "inclination": 0.0, "amb.shutdown_time": 0.0})
    scene = scene.set(
        {"bearing.friction.kind": 0, "bearing.friction.dynamic": 3.0, "bearing.preload": 20.0}
    )
    result = touchdown.run(scene.set({"rotor.speed": SPIN, "run.duration": "40 ms"}), in_process=True)
    assert result.ending.value("bearing.ring.omega") > 0.6 * SPIN
    s = result.summary
    assert abs(s["energy_balance_relative"]) * s["energy_scale"] < 1e-5 * s["energy_turnover"]


def test_the_outer_ring_gives_under_thrown_balls_too() -> None:
    """A damped spinning pair with a loose outer ring: races as far apart as the loads of both make them."""
    instance = started(hoop.LOOSE)
    m = instance.record
    m["p"]["balls"]["centrifugal"], m["p"]["ring"]["damping_ratio"], m["p"]["damping"] = 1, 0.2, 300.0
    instance.start(0.0)
    m["q"][ring.RW] = SPIN
    for k in range(200):
        instance.step(50e-6 * k, 50e-6)
    thrown, given = float(m["s"]["space"]["centrifugal"]), hoop.hoop_compliance(m["p"])
    row = BallRow(*(float(m["d"]["space"]["row"][0][name]) for name in BallRow._fields))

    def pressed_by(closed: float) -> float:
        angle, outer, force = jones(thrown, row._replace(inner=row.inner - closed))
        inner = force * math.sin(outer) / math.sin(angle) * math.cos(angle)
        load = 2.0 * BALLS.count
        return given.race * load * (inner + given.outer * thrown) - closed

    closed = brentq(pressed_by, 0.0, 3e-6)
    bending = m["d"]["bending"]
    place = int(bending["first"]) + int(bending["waves"]) - 1
    assert -float(bending["weight"][0]) * m["q"][place] == pytest.approx(closed, rel=1e-3)


def test_a_pair_s_rings_bend_and_give_by_the_slopes_of_its_energy() -> None:
    """Both rows press one ring, which bends in its plane and gives all around.

    At a shaken state, the forces on it and on its modes are the slopes of the springs' and modes' energy.
    """
    instance = paired()
    m = instance.record
    p, b = m["p"], m["d"]["bending"]
    p["ring"]["hoop"], p["ring"]["harmonics"], p["gravity"] = 1, 4, 0.0
    p["ring"]["width"], p["journal_radius"], p["clearance"] = 18e-3, 9.9e-3, 0.1e-3
    instance.start(0.0)
    n, first, waves = int(m["n"]), int(b["first"]), int(b["waves"])
    q, draw = m["q"][:n].copy(), np.random.default_rng(11)
    assert waves == 7
    q[first : first + waves] += draw.normal(0.0, 2e-7, waves) / b["weight"][np.arange(waves) // 2]
    places = [ring.RX, ring.RY, inner_ring.Z, inner_ring.RX, inner_ring.RY, *range(first, first + waves)]
    q[places[:5]] += (1e-6, -2e-6, 1e-6, 2e-5, -1e-5)
    rows = [BallRow(*(float(kept[name]) for name in BallRow._fields)) for kept in m["d"]["space"]["row"]]
    angles = float(p["balls"]["first_angle"]) + 2.0 * math.pi / BALLS.count * np.arange(BALLS.count)

    def energy(state: np.ndarray) -> float:
        modes, stored = state[first : first + waves], 0.0
        for a in angles:
            wider = b["weight"][3] * modes[6]
            for k in range(3):
                order, weight = k + 2, b["weight"][k]
                wider += weight * (
                    modes[2 * k] * math.cos(order * a) + modes[2 * k + 1] * math.sin(order * a)
                )
            x, y, z, rx, ry = (state[i] for i in places[:5])
            pose = Pose(x + wider * math.cos(a), y + wider * math.sin(a), z, rx, ry)
            for row in rows:
                ball = pressed(row, pose, math.cos(a), math.sin(a), 0.0)
                stored += 0.4 * ball.force * max(ball.length - row.free, 0.0)
        return stored + 0.5 * float(np.sum((b["frequency"][np.arange(waves) // 2] * modes) ** 2))

    slopes = []
    for place in places:
        step = 1e-10 if place < first else 1e-10 / float(b["weight"][(place - first) // 2])
        ends = [energy(np.where(np.arange(n) == place, q + side * step, q)) for side in (-1.0, 1.0)]
        slopes.append((ends[1] - ends[0]) / (2.0 * step))
    dq, transverse = rates(instance, q), float(m["d"]["space"]["transverse_inertia"])
    masses = [p["ring"]["mass"]] * 2 + [m["d"]["space"]["mass_along"]] + [transverse] * 2 + [1.0] * waves
    velocities = [ring.RVX, ring.RVY, inner_ring.VZ, inner_ring.WX, inner_ring.WY]
    velocities += range(first + waves, first + 2 * waves)
    found = -np.array(masses) * dq[velocities]
    # differences leave 1e-6 of the largest slope of their kind
    for part in (slice(0, 3), slice(3, 5), slice(5, None)):
        assert found[part] == pytest.approx(slopes[part], rel=1e-4, abs=1e-5 * np.abs(slopes[part]).max())
