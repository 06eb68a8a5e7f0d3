"""A brake by its table: the speed by closed forms, and its work out of the rotor's energy."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from rotor_alone import MODEL as FLEXIBLE

import touchdown
from touchdown.modelkit.errors import TouchdownError
from touchdown.modelkit.instance import Instance
from touchdown.modelkit.model import Model
from touchdown.rotor.rigid import MODEL as RIGID

INERTIA = 0.5e-3  # kg m2, of the rigid one
SPEED, STEP = 600.0, 1e-3  # rad/s, s
BOTH = pytest.mark.parametrize("model", [RIGID, FLEXIBLE])


def braked(model: Model, over: int, *points: tuple[float, float], speed: float = SPEED) -> Instance:
    """A rotor that floats and turns under a brake of the inertia's size."""
    rotor = Instance(model)
    p = rotor.record["p"]
    p["speed"], p["gravity"], p["brake_over"], p["brake_points"] = speed, 0.0, over, len(points)
    if model is FLEXIBLE:
        p["unbalance_scale"] = 0.0
    for point, (place, torque) in zip(p["brake"], points, strict=False):
        point["speed" if over else "time"], point["torque"] = place, torque * inertia(model)
    rotor.start(0.0)
    return rotor


def inertia(model: Model) -> float:
    if model is RIGID:
        return INERTIA
    rotor = Instance(model)
    rotor.start(0.0)
    return float(rotor.record["d"]["inertia"])


def omega(rotor: Instance) -> float:
    seats = rotor.record["o"]
    return float(seats["A"]["omega"] if rotor.model is RIGID else seats["station"][0]["omega"])


def turned(rotor: Instance, steps: int) -> float:
    """The spin (rad/s) after so many steps; the energy that it lost is the brake's work, and heat."""
    out = rotor.record["o"]
    before = float(out["energy"]["kinetic"])
    for k in range(steps):
        rotor.step(k * STEP, STEP)
    lost = before - float(out["energy"]["kinetic"])
    assert float(out["braking"]["work"]) == pytest.approx(lost, rel=1e-9)
    assert float(out["energy"]["dissipated"]) == pytest.approx(lost, rel=1e-9)
    return omega(rotor)


@BOTH
@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_a_constant_torque_slows_it_in_a_straight_line(model: Model, sense: float) -> None:
    rotor = braked(model, 0, (0.0, 1000.0), speed=sense * SPEED)
    assert turned(rotor, 50) == pytest.approx(sense * (SPEED - 50.0), rel=1e-11)
    power = float(rotor.record["o"]["braking"]["power"])
    assert power == pytest.approx(1000.0 * inertia(model) * abs(omega(rotor)), rel=1e-12)


@BOTH
def test_a_torque_in_proportion_to_the_speed_lets_it_fade(model: Model) -> None:
    """d omega/dt = -c omega; the flexible rotor's strides take the torque at their begin."""
    rotor = braked(model, 1, (0.0, 0.0), (1000.0, 5000.0))
    assert turned(rotor, 50) == pytest.approx(SPEED * math.exp(-5.0 * 0.05), rel=1e-5)


@BOTH
def test_a_torque_that_rises_over_time_slows_it_in_a_parabola(model: Model) -> None:
    rotor = braked(model, 0, (0.01, 0.0), (0.03, 2000.0))
    expected = SPEED - 0.5 * 2000.0 * 0.02 - 2000.0 * 0.02
    assert turned(rotor, 50) == pytest.approx(expected, rel=1e-5)


@BOTH
def test_it_stops_and_stays(model: Model) -> None:
    rotor = braked(model, 1, (0.0, 20000.0), speed=100.0)
    assert abs(turned(rotor, 50)) < 1e-6


def test_points_out_of_order_are_refused() -> None:
    with pytest.raises(TouchdownError, match=r"point 2 of the brake, at 5 .* before, at 10"):
        braked(RIGID, 1, (10.0, 1.0), (5.0, 1.0))


def test_points_of_a_scene_may_be_a_list(tmp_path: Path) -> None:
    (tmp_path / "own.toml").write_text(
        'extends = "disk-caged-simplified"\n[components.rotor.set]\n'
        'brake = [{ time = "20 ms", torque = 0 }, { time = "0.5 s", torque = "0.95 N.m" }]\n',
        encoding="utf-8",
    )
    found = touchdown.load(tmp_path / "own.toml").components["rotor"].set
    points = {name: value for name, value in found.items() if name.startswith("brake")}
    assert points == {
        "brake_points": 2,
        "brake[1].time": "20 ms",
        "brake[1].torque": 0,
        "brake[2].time": "0.5 s",
        "brake[2].torque": "0.95 N.m",
    }
