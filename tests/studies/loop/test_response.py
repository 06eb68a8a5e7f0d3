"""Answers of loops to unbalance and forces, and their plant: by closed forms, other equations, and runs."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas
import pytest
from levitation import (
    AMPLIFIER,
    FILTER,
    KD,
    KI,
    KP,
    L0,
    MASS,
    PERIOD,
    RESISTANCE,
    Loop,
    by_one_controller,
    from_sample_to_sample,
)
from scipy.linalg import expm
from scipy.signal import cont2discrete
from systems import history

import touchdown
from touchdown.master.common.errors import TouchdownError
from touchdown.master.coupling.simulation import opened
from touchdown.master.scene.file import load_scene
from touchdown.master.scene.scene import Scene
from touchdown.studies.loop.linear_loops import loops_of
from touchdown.studies.loop.over_speed import Found, loops_in
from touchdown.studies.loop.response import unbalance_response, zone

DISK = "disk-caged-relevitated"
ECCENTRICITY = 0.5e-6  # m: of orbits so small that magnets are linear to 1e-6
RPM = math.pi / 30.0
SPEEDS = (1500.0 * RPM, 3600.0 * RPM, 9000.0 * RPM)


@pytest.fixture(scope="module")
def disk() -> Found:
    """Of a disk without weight, whose axes are alike and one is enough."""
    return loops_in(Loop(ECCENTRICITY).scene(0.01, 20e-6).set({"rotor.gravity": 0.0}))


def compliance(omega: float) -> complex:
    """The disk's displacement at the ticks over a force exp(j omega t): m/N.

    Exact from tick to tick, with PID and low-pass written as the transfer function of their set point.
    """
    ahead = from_sample_to_sample(PERIOD, gravity=0.0)
    rates = np.zeros((6, 6), complex)  # the five of `from_sample_to_sample`, and the force
    rates[0, 1], rates[1, 2], rates[1, 5], rates[5, 5] = 1.0, 1.0 / MASS, 1.0 / MASS, 1j * omega
    rates[2:4, :5] = _continuous()[2:4]
    forced = expm(rates * PERIOD)[:4, 5]
    z = np.exp(1j * omega * PERIOD)
    law = KP + KI * PERIOD * z / (z - 1) + KD * FILTER * (z - 1) / ((1 + FILTER * PERIOD) * z - 1)
    fed = np.outer(ahead[:4, 4], [0.0, 0.0, 0.0, -law / z])
    return complex(np.linalg.solve(z * np.eye(4) - ahead[:4, :4] - fed, forced)[0])


def _continuous() -> np.ndarray:
    """Rates of `from_sample_to_sample`, from a sample time so short that its exponential is linear."""
    short = 1e-12
    return (from_sample_to_sample(short, gravity=0.0) - np.eye(5)) / short


def test_the_orbit_of_a_disk_by_hand(disk: Found) -> None:
    response = disk.unbalance
    assert response is not None
    for speed in SPEEDS:
        k = int(np.argmin(np.abs(response.speeds - speed)))
        omega = float(response.speeds[k])
        expected = abs(compliance(omega)) * MASS * ECCENTRICITY * omega**2
        assert response.orbits[k] == pytest.approx(np.full(len(response.places), expected), rel=1e-6)


@pytest.mark.parametrize("speed", SPEEDS)
def test_orbit_current_and_voltage_in_a_run(disk: Found, speed: float) -> None:
    """Settled, within 1e-4, of which the magnets' curvature and the macro step leave 1e-5."""
    scene = Loop(ECCENTRICITY).scene(1.4, 50e-6).set({"rotor.gravity": 0.0, "rotor.speed": speed})
    current, point = "amb.axis[1].current_plus", "controller.axis[1].set"
    times, values, _ = history(scene, ["rotor.A.x", "rotor.A.y", current, point])
    ticks = np.flatnonzero((times > 1.0) & np.isclose(times / PERIOD, np.round(times / PERIOD), atol=1e-6))
    turn = np.exp(1j * speed * times[ticks])
    waves = np.column_stack((turn, turn.conj(), np.ones(len(ticks))))

    def forward(column: np.ndarray) -> complex:
        return complex(np.linalg.lstsq(waves, column[ticks].astype(complex), rcond=None)[0][0])

    orbit = abs(forward(values["rotor.A.x"] + 1j * values["rotor.A.y"]))
    i, asked = 2.0 * forward(values[current]), 2.0 * forward(values[point])
    volts = abs(RESISTANCE * i + AMPLIFIER * L0 * (asked - i))
    response = unbalance_response(scene, loops_of(scene))
    assert response is not None
    found = (
        response.at(speed, part)[0] for part in (response.orbits, response.currents, response.voltages)
    )
    assert [*found] == pytest.approx([orbit, abs(asked), volts], rel=1e-4)


def of_the_law(scene: Scene) -> tuple[float, float]:
    """Stiffness (N/m) and damping (N s/m) of a scene's `amb`."""
    with opened(scene, in_process=True) as system:
        return system.value("amb.stiffness"), system.value("amb.damping")


def test_a_law_of_its_own_by_hand() -> None:
    """Stiffness k and damping c: e w^2 / |k/m - w^2 + j w c/m|."""
    scene = load_scene("disk-caged-simplified").set({"rotor.eccentricity": 1e-6})
    found = loops_in(scene)
    response = found.unbalance
    assert response is not None
    assert response.axes == ()
    with pytest.raises(TouchdownError, match="have no control currents"):
        _ = found.plant
    k, c = of_the_law(scene)
    (root,) = found.loops.rotor.acts[0]
    omega = response.speeds
    expected = 1e-6 * omega**2 / np.abs(k * root**2 - omega**2 + 1j * omega * c * root**2)
    assert response.orbits[:, 0] == pytest.approx(expected, rel=1e-6)


def test_peaks_of_narrow_resonances_are_met() -> None:
    """With a damping ratio of 1e-3, as narrow as a fifth of the speeds' distance: the closed form's."""
    scene = load_scene("disk-caged-simplified").set({"rotor.eccentricity": 1e-6})
    k, _ = of_the_law(scene)
    mass = float(loops_of(scene).rotor.acts[0, 0] ** -2)
    ratio = 1e-3
    scene = scene.set({"amb.damping": 2.0 * ratio * math.sqrt(k * mass)})
    response = loops_in(scene).unbalance
    assert response is not None
    peak = 1e-6 / (2.0 * ratio * math.sqrt(1.0 - ratio**2))
    assert response.orbits.max() == pytest.approx(peak, rel=1e-6)


def test_zones_of_vibration() -> None:
    assert [zone(share) for share in (0.29, 0.3, 0.4, 0.49, 0.5)] == ["A", "B", "C", "C", "D"]


def test_no_unbalance_has_no_response() -> None:
    assert loops_in(load_scene(DISK)).unbalance is None


def test_unstable_speeds_have_no_response() -> None:
    response = loops_in(load_scene(DISK).set({"rotor.eccentricity": 1e-6,
                                              "controller.gain.derivative": -15.5})).unbalance  # fmt: skip
    assert response is not None
    assert np.isnan(response.orbits).all()
    assert zone(float(response.orbits[0, 0])) == ""


@pytest.mark.parametrize("delay", [0, 1])
def test_a_controller_designed_for_the_plant_closes_the_same_loops(delay: int) -> None:
    found = loops_in(by_one_controller().set({"controller_A.delay": delay}))
    plant, law = found.sampled_plant, found.controller
    assert [plant.dt, law.dt] == pytest.approx([PERIOD] * 2, rel=1e-12)
    loop = np.block([[plant.A - plant.B @ law.D @ plant.C, plant.B @ law.C], [-law.B @ plant.C, law.A]])
    expected = np.linalg.eigvals(found.loops.closed(found.own.speed).A)
    apart = np.abs(np.linalg.eigvals(loop)[:, None] - expected)
    assert max(apart.min(axis=0).max(), apart.min(axis=1).max()) < 1e-9


def test_the_sampled_plant_is_the_plant_held_from_sample_to_sample() -> None:
    found = loops_in(load_scene("rotor1-relevitated"))
    plant, sampled = found.plant, found.sampled_plant
    a, b, *_ = cont2discrete((plant.A, plant.B, plant.C, plant.D), PERIOD)
    n, m = b.shape
    assert sampled.A[:n, :n] == pytest.approx(a, abs=1e-9 * np.abs(a).max())
    assert sampled.A[:n, n:] == pytest.approx(b, abs=1e-9 * np.abs(b).max())
    assert sampled.C[:, :n] == pytest.approx(plant.C)
    assert sampled.B[-m:] == pytest.approx(np.eye(m))


def test_answers_of_the_disk_over_the_frequency(disk: Found) -> None:
    """Its axes do not meet, so that L = P C and S = 1/(1 + L); the compliance is that by hand."""
    answers = disk.answers
    assert answers is not None
    gain, s, plant, law, swings = (answers.values[name] for name in "LSPCG")
    assert gain == pytest.approx(plant * law, rel=1e-9)
    assert s == pytest.approx(1.0 / (1.0 + gain), rel=1e-9)
    for k in (10, 200, -10):
        assert swings[k] == pytest.approx([compliance(float(answers.omega[k]))] * 2, rel=1e-6)


def test_pictures_and_tables(tmp_path: Path) -> None:
    found = touchdown.amb_margins(load_scene(DISK).set({"rotor.eccentricity": 1e-6}), tmp_path)
    for name in ("amb-margins", "campbell", "bode", "nyquist", "unbalance"):
        assert (tmp_path / f"{name}.png").stat().st_size > 10_000
    answers = pandas.read_csv(tmp_path / "answers.csv", index_col=0)
    values = found.answers
    assert values is not None
    assert answers["Re(S) [1] amb.axis[1]"].to_numpy() == pytest.approx(values.values["S"][:, 0].real)
    orbits = pandas.read_csv(tmp_path / "unbalance.csv", index_col=0)
    assert "orbit_m amb, sensor" in orbits
    with np.load(tmp_path / "loops.npz") as kept:
        assert kept["plant.A"] == pytest.approx(found.plant.A)
        assert kept["sample_time"] == pytest.approx(PERIOD, rel=1e-12)


def test_a_rotor_that_turns_the_other_way_has_the_mirrored_orbits() -> None:
    """Rotor I with unbalances in two planes, mirrored: speed and angles of the other sign."""
    scene = load_scene("rotor1-relevitated")
    loops = loops_of(scene)
    rotor = loops.rotor
    unbalance = rotor.unbalance * np.exp(1j * np.linspace(0.0, 2.0, len(rotor.unbalance)))
    orbits = list[np.ndarray]()
    for speed, mirrored in ((rotor.speed, unbalance), (-rotor.speed, unbalance.conj())):
        loops.rotor, loops.speed = replace(rotor, speed=speed, unbalance=mirrored), speed
        response = unbalance_response(scene, loops)
        assert response is not None
        orbits.append(response.at(abs(loops.speed), response.orbits))
        budget = loops.unbalance(loops.speed).control
        assert response.at(abs(loops.speed), response.currents) == pytest.approx(budget, rel=1e-9)
    assert orbits[1] == pytest.approx(orbits[0], rel=1e-6)
    assert np.ptp(orbits[0]) > 0.01 * orbits[0].max()
