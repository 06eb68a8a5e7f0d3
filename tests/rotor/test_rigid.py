"""The rigid rotor alone, against closed forms."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from systems import DISK, GRAVITY, history, rotor_on

from touchdown.master.coupling.simulation import opened
from touchdown.modelkit.instance import Instance
from touchdown.rotor.rigid import MODEL


def test_a_linear_load_moves_it_as_newton_says() -> None:
    instance = Instance(MODEL)
    instance.start(0.0)
    step, mean, slope, moment, turn = 1e-3, 20.0, 4e4, 0.3, 500.0
    load = instance.record["u"]["A"]
    load["fx"], load["dfx"], load["mz"], load["dmz"] = mean, slope, moment, turn
    before = float(instance.record["o"]["A"]["omega"])
    instance.step(0.0, step)
    out = instance.record["o"]["A"]
    assert out["vx"] == pytest.approx(mean * step / DISK, rel=1e-13)
    # the first moment: x = J H/2 - S over m, with S = slope H^3 / 12
    assert out["x"] == pytest.approx((mean * step**2 / 2 - slope * step**3 / 12) / DISK, rel=1e-12)
    assert out["omega"] - before == pytest.approx(moment * step / 0.5e-3, rel=1e-10)
    assert out["alpha_free"] == 0.0


def test_unbalance_runs_on_a_circle() -> None:
    """Free in space, the shaft centre circles the centre of mass at the eccentricity."""
    speed, eccentricity = 900.0, 2e-6
    rotor = {
        "gravity": 0.0, "eccentricity": eccentricity, "speed": speed,
        "x": -eccentricity, "vy": -eccentricity * speed,
    }  # fmt: skip
    times, motion, _ = history(
        rotor_on(None, rotor, duration=0.02, macro_step=5e-5), ["rotor.A.x", "rotor.A.y"]
    )
    np.testing.assert_allclose(
        motion["rotor.A.x"], -eccentricity * np.cos(speed * times), atol=1e-6 * eccentricity
    )
    np.testing.assert_allclose(
        motion["rotor.A.y"], -eccentricity * np.sin(speed * times), atol=1e-6 * eccentricity
    )


def test_what_the_other_seat_does_is_free_acceleration() -> None:
    instance = Instance(MODEL)
    instance.record["u"]["amb"]["fy"] = 3.3
    instance.start(0.0)
    out = instance.record["o"]
    assert out["A"]["ay_free"] == pytest.approx(3.3 / DISK - GRAVITY)
    assert out["amb"]["ay_free"] == pytest.approx(-GRAVITY)
    assert out["A"]["inv_m"] == pytest.approx(1.0 / DISK)


def test_unbalance_makes_no_energy() -> None:
    """A pulled, turned and falling rotor with its centre of mass off the shaft centre."""
    instance = Instance(MODEL)
    instance.record["p"]["eccentricity"] = 1e-3
    instance.start(0.0)
    load = instance.record["u"]["A"]
    load["fx"], load["fy"], load["mz"] = 300.0, -200.0, 0.2
    energy = instance.record["o"]["energy"]

    def balance() -> float:
        return float(energy["kinetic"] + energy["potential"] - instance.record["o"]["A"]["work"])

    before = balance()
    for k in range(200):
        instance.step(k * 1e-4, 1e-4)
    assert abs(instance.record["o"]["A"]["work"]) > 1.0
    assert balance() == pytest.approx(before, abs=1e-6)


def test_unbalance_is_no_static_load() -> None:
    """Its magnetic bearing holds the weight alone: the disk circles about the middle from the start on."""
    rotor = {"eccentricity": 20e-6, "speed": "9000 rpm", "mass": DISK}
    scene = rotor_on("amb", rotor, {"shutdown_time": 1.0}, duration=1e-3, macro_step=2e-5)
    scene = replace(scene, attach=(("bearing.journal", "rotor.amb"),))
    with opened(scene, in_process=True) as system:
        system.initialise()
        assert system.value("rotor.amb.static_fy") == pytest.approx(DISK * GRAVITY, rel=1e-14)
        assert system.value("bearing.load_x") == 0.0
        assert system.value("bearing.load_y") == pytest.approx(DISK * GRAVITY, rel=1e-14)
