"""The flexible rotor's energy: kept, turned into heat, and done at its stations."""

from __future__ import annotations

import math

import numpy as np
import pytest
import rotor_alone as alone

from touchdown.modelkit.instance import Instance
from touchdown.rotor.motion.equations import ANGLE, LOSS, SPIN, WORK, energies


def total(rotor: Instance) -> float:
    """All energy, less what came in at the stations."""
    out = rotor.record["o"]
    energy = out["energy"]
    own = energy["kinetic"] + energy["potential"] + energy["dissipated"]
    return float(own - np.sum(out["station"]["work"]))


def ledger(
    moments: bool = False, gyroscopic: bool = True, mode_loads: bool = False, **parameters: float
) -> tuple[float, float]:
    """(what the energy lacks at the end, work in and out at the stations), in J, over 2 ms of pulling."""
    rotor = alone.started(speed=alone.FAST, vx=0.1, vy=-0.2, **parameters)
    if not gyroscopic:
        rotor.record["d"]["gyroscopic"]["polar"] = 0.0
        rotor.record["d"]["gyroscopic"]["principal"] = 0.0
    before, crossed, step = total(rotor), 0.0, 2e-5
    for k in range(100):
        alone.give(rotor, alone.PULLED, math.cos(2e3 * k * step))
        for station in rotor.record["u"]["station"][: len(alone.NAMES)]:
            if not moments:
                station["mz"], station["dmz"] = 0.0, 0.0
            if mode_loads:
                load = station["mode"][0]
                load["qx"], load["qy"] = 1e-8, -2e-8
                load["px"], load["py"] = 1e-3 * math.sin(k), 2e-3
        work = np.array(rotor.record["o"]["station"]["work"])
        rotor.step(k * step, step)
        crossed += float(np.sum(np.abs(rotor.record["o"]["station"]["work"] - work)))
    assert crossed > 0.1
    return total(rotor) - before, crossed


def extrapolated(**setting: float | bool) -> float:
    """Share of the work that is lost, in the limit of short strides."""
    coarse, work = ledger(**setting)  # type: ignore[arg-type]
    fine, _ = ledger(**setting, micro_step=2.5e-6)  # type: ignore[arg-type]
    return abs(4.0 * fine - coarse) / 3.0 / work


def test_no_energy_is_lost_without_gyroscopics() -> None:
    """Forces and moments with slopes, damping, spin: each mode's motion and its ledger are exact."""
    lost, work = ledger(moments=True, gyroscopic=False, unbalance_scale=0.0)
    assert abs(lost) < 1e-11 * work


@pytest.mark.parametrize(("mode_loads", "modes"), [(True, 5), (False, 0)])
def test_no_energy_is_lost(mode_loads: bool, modes: int) -> None:
    """With gyroscopics, which only turn the velocities: to rounding, however fast the modes are."""
    lost, work = ledger(mode_loads=mode_loads, modes=modes, unbalance_scale=0.0)
    assert abs(lost) < 1e-11 * work


def test_heat_and_work_are_those_of_the_equations() -> None:
    """Both follow from balances, so against int c v^2 dt and int F v dt, with drag; second order."""
    setting = {"speed": alone.FAST, "vx": 0.1, "vy": -0.2, "damping_ratio": 0.05, "drag": 0.5}
    exact = alone.integrated(alone.started(alone.PULLED, **setting), 1e-4)
    lengths, errors = [2e-5, 5e-6], []
    for length in lengths:
        rotor = alone.started(alone.PULLED, micro_step=length, **setting)
        rotor.step(0.0, 1e-4)
        behind = 4 * int(rotor.record["d"]["modes"])
        places = behind + np.array([LOSS, *range(WORK, WORK + len(alone.NAMES))])
        found, expected = rotor.record["q"][places], exact[places]
        assert np.min(np.abs(expected)) > 1e-5
        errors.append(np.max(np.abs(found / expected - 1.0)))
    assert errors[-1] < 1e-5
    assert alone.order(lengths, errors) == pytest.approx(2.0, abs=0.15)


@pytest.mark.parametrize(("mode_loads", "unbalance", "largest"), [(False, 100.0, 1e-6), (True, 1.0, 1e-8)])
def test_unbalance_makes_no_energy(mode_loads: bool, unbalance: float, largest: float) -> None:
    """Without gyroscopics, whose i alpha G p does work that linear theory accounts for nowhere."""
    found = extrapolated(mode_loads=mode_loads, unbalance_scale=unbalance, gyroscopic=False)
    assert found < largest


@pytest.mark.parametrize("micro_step", [5e-6, 1e-3])
def test_a_moment_with_a_slope_does_the_work_that_spins_it_up(micro_step: float) -> None:
    """Nothing else acts, so the work is the gain of I Omega^2 / 2; in one stride and in many."""
    rotor = alone.started(
        {"A": {"mz": 5.0, "dmz": 1e5}},
        gravity=0.0,
        unbalance_scale=0.0,
        speed=alone.FAST,
        micro_step=micro_step,
    )
    before = alone.behind(rotor, SPIN)
    rotor.step(0.0, 1e-3)
    gain = 0.5 * alone.SHAFT.polar_inertia * (alone.behind(rotor, SPIN) ** 2 - before**2)
    assert gain > 1.0
    assert rotor.record["o"]["station"][0]["work"] == pytest.approx(gain, rel=1e-10)


def test_a_mode_load_leaves_the_angular_momentum() -> None:
    """It moves the unbalance, which takes from the spin; its work is all the energy that it brings."""
    heavy = {"speed": alone.FAST, "gravity": 0.0, "unbalance_scale": 100.0}
    plain, loaded = alone.started(**heavy), alone.started(**heavy)
    loaded.record["u"]["station"][1]["mode"][0]["py"] = 0.1
    for rotor in (plain, loaded):
        rotor.step(0.0, 4e-5)
    d, kick = plain.record["d"], alone.coordinates(loaded)[1] - alone.coordinates(plain)[1]
    moment = 100.0 * (d["unbalance"]["x"] + 1j * d["unbalance"]["y"])[: len(kick)]
    given = np.sum(np.real(kick * np.conj(1j * moment * np.exp(1j * alone.behind(plain, ANGLE)))))
    change = alone.behind(loaded, SPIN) - alone.behind(plain, SPIN)
    assert abs(change) > 1e-4
    assert alone.SHAFT.polar_inertia * change == pytest.approx(-given, rel=1e-9)
    gain = sum(energies(loaded.record["q"], loaded.record)) - sum(energies(plain.record["q"], plain.record))
    work = loaded.record["o"]["station"][1]["work"] - plain.record["o"]["station"][1]["work"]
    assert gain == pytest.approx(float(work), rel=1e-9)
