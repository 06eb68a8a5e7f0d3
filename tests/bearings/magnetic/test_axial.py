"""The axial actuator against closed forms, and against one system of equations with its rotor."""

from __future__ import annotations

import math

import levitation as lev
import numpy as np
import pytest
from scipy.integrate import solve_ivp

import touchdown
from touchdown.bearings.magnetic import amb_actuator, amb_axial
from touchdown.bearings.magnetic.amplifier import COIL_OFF, SENSOR_LOST
from touchdown.bearings.magnetic.magnet import EDDIES, EDDY_FACTORS
from touchdown.bearings.seat import space
from touchdown.master.scene.file import load_scene
from touchdown.modelkit.instance import Instance
from touchdown.modelkit.model import ModelError

MASS, LOAD = 1.65, 16.2  # kg, N
K_I = 4 * lev.K * lev.BIAS / lev.GAP**2
K_S = -4 * lev.K * lev.BIAS**2 / lev.GAP**3
FLUX = amb_actuator.FLUX


def axial(mass: float = 0.0, load: float = 0.0, **settings: float) -> Instance:
    """Started with a journal of a mass (kg; 0: held in place) and a static load (N) to hold."""
    one = Instance(amb_axial.MODEL)
    for name, value in settings.items():
        group, _, last = name.rpartition("__")
        place = one.record["p"]
        for part in group.split("__") if group else ():
            place = place[part]
        place[last] = value
    journal = one.record["u"]["journal"]
    journal["inv_m_z"] = 1.0 / mass if mass else 1e-30
    journal["static_fz"] = load
    if mass:
        journal["az_free"] = -load / mass
    one.start(0.0)
    one.record["u"]["axis"][0]["set"] = one.record["o"]["axis"][0]["hold"]
    return one


def test_constants_are_the_closed_forms():
    """k_i = 4 K i0/s0^2, k_s = -4 K i0^2/s0^3: without a pole angle."""
    out = axial().record["o"]
    assert out["current_factor"] == pytest.approx(K_I, rel=1e-14)
    assert out["displacement_factor"] == pytest.approx(K_S, rel=1e-14)
    assert (pytest.approx(27.925, abs=1e-3), pytest.approx(-93084, abs=1)) == (K_I, K_S)


@pytest.mark.parametrize("load", [LOAD, -70.0, 0.0])
def test_a_static_load_is_held_from_the_start(load: float):
    """F = K ((i0 + i)^2 - (i0 - i)^2)/s0^2; with more than 2 A one coil is left."""
    one = axial(0.0, load)
    assert one.record["o"]["axis"][0]["hold"] == pytest.approx(
        math.copysign(min(abs(load) / K_I, math.sqrt(abs(load) / lev.K) * lev.GAP - lev.BIAS), load)
        if abs(load) > K_I * lev.BIAS
        else load / K_I,
        rel=1e-9,
    )
    for k in range(20):
        one.step(k * 1e-4, 1e-4)
    assert one.record["o"]["journal"]["fz"] == pytest.approx(load, rel=1e-6, abs=1e-9)
    assert one.record["o"]["housing"]["fz"] == pytest.approx(-load, rel=1e-6, abs=1e-9)
    assert all(one.record["o"]["journal"][name] == 0.0 for name in ("fx", "fy", "mx", "my", "mz"))


def free(one: Instance, steps: int, step: float) -> np.ndarray:
    """Places (m) of a journal that moves under the bearing's load alone, at the ends of steps (s)."""
    journal, places = one.record["u"]["journal"], []
    for k in range(steps):
        one.step(k * step, step)
        journal["z"], journal["vz"] = one.record["q"][[space.JZ, space.JVZ]]
        places.append(float(journal["z"]))
    return np.array(places)


def test_a_step_is_that_of_one_system_of_equations():
    """Two flux linkages, place and velocity, under a weight; 0.1 A more is asked for from the start on."""
    one, until = axial(MASS, LOAD, sample_time=0.0), 4e-3
    hold = one.record["o"]["axis"][0]["hold"]
    one.record["u"]["axis"][0]["set"] = hold + 0.1
    targets = lev.BIAS + np.array([1.0, -1.0]) * (hold + 0.1)
    begin = [*(lev.L0 * (lev.BIAS + sign * hold) for sign in (1.0, -1.0)), 0.0, 0.0]

    def rates(t: float, x: np.ndarray) -> list[float]:
        fluxes, gaps = x[:2], lev.GAP - np.array([1.0, -1.0]) * x[2]
        voltage = np.clip(lev.AMPLIFIER * lev.L0 * (targets - fluxes * gaps / (2 * lev.K)), -99.0, 99.0)
        force = (fluxes[0] ** 2 - fluxes[1] ** 2) / (4 * lev.K)
        return [*voltage, x[3], (force - LOAD) / MASS]

    exact = solve_ivp(rates, (0.0, until), begin, "DOP853", rtol=1e-11, atol=1e-14).y[2, -1]
    assert exact == pytest.approx(1.6e-5, rel=0.2)
    assert free(one, 80, until / 80)[-1] == pytest.approx(exact, rel=2e-5)


def test_it_falls_off_the_centre_as_its_negative_stiffness_says():
    """With currents that follow at once: z = z0 cosh(sqrt(-k_s/m) t)."""
    fast = {"amplifier__bandwidth": 1e6, "supply__voltage": 1e5}
    one, rate = axial(MASS, sample_time=0.0, **fast), math.sqrt(-K_S / MASS)
    one.record["u"]["journal"]["z"] = 1e-7
    places = free(one, 100, 1e-4)
    assert places[-1] == pytest.approx(1e-7 * math.cosh(rate * 1e-2), rel=2e-3)


def test_a_levitated_mass_swings_at_the_closed_form():
    """A set point -P z, acting at once: sqrt((k_i P + k_s)/m), of which its magnets give 236.6 rad/s."""
    fast = {"amplifier__bandwidth": 1e6, "supply__voltage": 1e5, "sensing__bandwidth": 1e6}
    one, gain, step = axial(MASS, sample_time=0.0, **fast), 6.64e3, 2e-5
    one.record["u"]["journal"]["z"] = 1e-6
    places = [1e-6]
    for k in range(1500):
        one.record["u"]["axis"][0]["set"] = -gain * places[-1]
        one.step(k * step, step)
        journal = one.record["u"]["journal"]
        journal["z"], journal["vz"] = one.record["q"][[space.JZ, space.JVZ]]
        places.append(float(journal["z"]))
    signs = np.flatnonzero(np.diff(np.sign(places)))
    found = math.pi / step / np.diff(signs).mean()
    assert found == pytest.approx(math.sqrt((K_I * gain + K_S) / MASS), rel=3e-3)


@pytest.mark.parametrize("eddies", [0.0, 2000.0])
def test_what_the_link_gives_is_heat_field_and_work_along_the_shaft(eddies: float):
    """The journal is driven to and fro, and the current too; coils without resistance."""
    one = axial(amplifier__resistance=0.0, magnet__eddy_bandwidth=eddies, sample_time=0.0)
    journal, out, step = one.record["u"]["journal"], one.record["o"], 1e-5
    path = 1.5e-4 * np.sin(2 * math.pi * np.arange(2001) / 400)

    def field() -> float:
        fluxes, place = one.record["q"][FLUX : FLUX + 2], float(journal["z"])
        found = np.sum(fluxes**2 * (lev.GAP + np.array([-place, place])) / (4 * lev.K))
        windings = one.record["q"][amb_actuator.EDDY :][: 2 * EDDIES].reshape(2, EDDIES)
        lags = (fluxes[:, None] - windings) ** 2 if eddies else 0.0 * windings
        return float(found + 0.5 * float(one.record["d"]["eddy"]) * np.sum(lags * EDDY_FACTORS))

    begun = field()
    for k in range(2000):
        journal["z"], journal["vz"] = path[k], (path[k + 1] - path[k]) / step
        one.record["u"]["axis"][0]["set"] = math.sin(k / 300)
        one.step(k * step, step)
    journal["z"] = path[-1]
    worked, lost = float(out["supplied"]), float(out["eddy_loss"])
    assert abs(worked) > 1e-3
    assert (lost > 1e-3) == (eddies > 0.0)
    assert float(out["link_energy"]) - lost - (field() - begun) == pytest.approx(worked, rel=2e-5)


def test_a_failed_coil_and_a_lost_sensor_are_those_of_the_one_axis():
    one = Instance(amb_axial.MODEL)
    events = one.record["p"]["event"]
    for event, values in zip(events, ((1e-3, COIL_OFF, 2), (2e-3, SENSOR_LOST, 1)), strict=False):
        event["time"], event["kind"], event["coil"] = values
    one.record["u"]["journal"]["z"] = 5e-5
    one.start(0.0)
    for k in range(40):
        one.step(k * 1e-4, 1e-4)
        if k == 15:
            assert one.record["o"]["axis"][0]["sensed"] == pytest.approx(5e-5)
    axis = one.record["o"]["axis"][0]
    assert (axis["current_plus"], axis["current_minus"]) == (pytest.approx(lev.BIAS), 0.0)
    assert axis["sensed"] == 0.0
    other = Instance(amb_axial.MODEL)
    other.record["p"]["event"][0]["kind"], other.record["p"]["event"][0]["coil"] = SENSOR_LOST, 2
    with pytest.raises(ModelError, match=r"event\[1\].coil = 2: sensors are numbered 1 to 1 by"):
        other.start(0.0)


def test_a_spindle_falls_onto_a_face_and_is_levitated_again():
    """Its weight held from the start, 0.15 mm of free fall to the face, and back to the centre."""
    scene = load_scene("spindle-relevitated")
    for name in ("controller_A", "controller_B", "controller_axial"):
        scene = scene.set({f"{name}.event[2].time": 20e-3})
    result = touchdown.run(scene.set({"run.duration": 0.07}), in_process=True)
    z, time = (np.asarray(result.data[name].values) for name in ("rotor.collar.z", "time"))
    assert np.abs(z[time < 0.0]).max() < 1e-7
    landed = result.summary["seats"]["A"]["face_landing_time"]
    assert landed == pytest.approx(math.sqrt(2 * 0.15e-3 / 9.81), rel=0.05)
    assert z.min() == pytest.approx(-0.15e-3, rel=0.1)
    assert abs(z[-1]) < 2e-5
    assert abs(result.summary["energy_residual_of_turnover"]) < 1e-3
