"""The DC link against closed forms, its account, and one system of equations with coils."""

from __future__ import annotations

import math

import levitation as lev
import numpy as np
import pytest
from scipy.integrate import solve_ivp

from touchdown.bearings.magnetic import amb_actuator, dc_link
from touchdown.bearings.magnetic.amplifier import LINK_OFF
from touchdown.modelkit.instance import Instance
from touchdown.modelkit.model import ModelError

OFF, ON = 1, 2


def link(*events: tuple[float, int], **settings: float) -> Instance:
    """A link, started at 0, with events of these times (s) and kinds."""
    one = Instance(dc_link.MODEL)
    p = one.record["p"]
    for event, values in zip(p["event"], events, strict=False):
        event["time"], event["kind"] = values
    for name, value in settings.items():
        p[name] = value
    one.start(0.0)
    return one


def missing(one: Instance, begun: float) -> float:
    """What its account lacks (J); begun: energy of the capacitor at the start."""
    e = one.record["o"]["energy"]
    used = float(e["taken"]) + float(e["standby"]) + float(e["burnt"])
    return float(e["mains"]) + float(e["generated"]) - used - (float(e["stored"]) - begun)


@pytest.mark.parametrize("step", [1e-3, 0.7e-3, 1e-5])
def test_it_lives_on_by_its_capacitor(step: float):
    """C (U0^2 - Umin^2)/(2 P) from the failure on, within macro steps too, for a steady power P."""
    power, failed = 8.0, 12.3e-3
    one = link((failed, OFF), capacitance=1e-3, mains=100.0, least=40.0, standby=10.0)
    expected = failed + 1e-3 * (100.0**2 - 40.0**2) / (2 * (power + 10.0))
    k, out = 0, one.record["o"]
    while out["locked"] == 0:
        assert out["voltage"] > 40.0
        one.record["u"]["actuator"][k % 4]["energy"] += power * step  # whoever takes it
        one.step(k * step, step)
        k += 1
    assert out["locked_time"] == pytest.approx(expected, rel=1e-9)
    assert (out["failed_time"], out["voltage"]) == (failed, 0.0)
    assert k * step - step <= expected <= k * step


def test_its_account_closes_at_every_macro_step():
    """With both signs of all powers, failures, a chopper that burns, and the mains back; to rounding."""
    rng = np.random.default_rng(1)
    one = link((0.1003, OFF), (0.3, ON), (0.4, OFF), (0.6, ON), capacitance=1e-3, standby=10.0, least=60.0)
    u, out, begun = one.record["u"], one.record["o"], 0.5 * 1e-3 * 100.0**2
    time, turned, seen = 0.0, begun, []
    while time < 0.8:
        step = float(rng.uniform(1e-5, 5e-3))
        for k in range(4):
            u["actuator"][k]["energy"] += rng.normal(3.0, 20.0) * step
        u["braked"] += rng.normal(8.0 if time < 0.3 else -20.0, 400.0) * step
        one.step(time, step)
        time += step
        turned += 500.0 * step
        seen.append([out[name] for name in ("capacitor", "voltage", "locked")])
        assert abs(missing(one, begun)) < 1e-13 * turned
    capacitor, voltage, locked = np.array(seen).T
    assert capacitor.max() == pytest.approx(130.0, rel=1e-12)
    assert {0.0, 1.0} == set(locked)
    assert (voltage == np.where(locked, 0.0, capacitor)).all()
    assert min(out["energy"][name] for name in ("mains", "burnt", "standby")) > 0.1


def test_mains_hold_the_voltage_and_a_chopper_the_ceiling():
    """A generator of 100 W, 90 % efficient, on 10 W of standby, up to 110 V; as a motor 100/0.9 W."""
    one = link(mains=100.0, ceiling=110.0, capacitance=1e-3, standby=10.0, efficiency=0.9)
    out = one.record["o"]
    for k in range(100):
        one.record["u"]["braked"] += 100.0 * 1e-3
        one.step(k * 1e-3, 1e-3)
    assert out["voltage"] == pytest.approx(110.0, rel=1e-12)
    assert out["energy"]["generated"] == pytest.approx(9.0, rel=1e-12)
    assert out["energy"]["burnt"] == pytest.approx(9.0 - 1.0 - 0.5e-3 * (110.0**2 - 100.0**2), rel=1e-12)
    assert out["energy"]["mains"] == 0.0
    for k in range(100, 300):
        one.record["u"]["braked"] -= 100.0 * 1e-3
        one.step(k * 1e-3, 1e-3)
    assert out["voltage"] == pytest.approx(100.0, rel=1e-12)
    left = 2.0 + 20.0 / 0.9 - 0.5e-3 * (110.0**2 - 100.0**2)
    assert out["energy"]["mains"] == pytest.approx(left, rel=1e-12)


def test_a_link_that_locked_out_waits_for_the_voltage_of_the_mains():
    """By the generator too, not before; electronics that are off take nothing."""
    one = link((0.0, OFF), mains=100.0, least=50.0, capacitance=1e-3, standby=100.0)
    out, k = one.record["o"], 0
    while out["locked"] == 0:
        one.step(k * 1e-3, 1e-3)
        k += 1
    standby = out["energy"]["standby"]
    for _ in range(60):
        one.record["u"]["braked"] += 0.05 / 0.9
        one.step(k * 1e-3, 1e-3)
        k += 1
        assert (out["voltage"] > 0.0) == (out["capacitor"] >= 100.0)
        if out["locked"] == 1:
            assert out["energy"]["standby"] == standby
    assert out["locked_time"] == pytest.approx(0.5e-3 * (100.0**2 - 50.0**2) / 100.0, rel=1e-9)


def test_a_failure_is_dated_once_and_ends_when_the_mains_are_back():
    one = link((1.5e-3, OFF), (3e-3, OFF), (5.2e-3, 2))
    for k in range(8):
        one.step(k * 1e-3, 1e-3)
        is_back = one.record["o"]["back_time"] >= 0.0
        assert is_back == (k >= 5)
    assert one.record["o"]["failed_time"] == pytest.approx(1.5e-3)
    assert one.record["o"]["back_time"] == pytest.approx(5.2e-3)


def test_voltages_out_of_order_are_refused():
    for wrong in ({"least": 100.0}, {"ceiling": 99.0}):
        with pytest.raises(ModelError, match="the mains' voltage must be above least"):
            link(**wrong)


def test_an_actuator_on_a_link_refuses_events_of_its_own():
    one = Instance(amb_actuator.MODEL)
    one.record["u"]["link_voltage"] = 100.0
    one.record["p"]["event"][1]["kind"] = LINK_OFF
    with pytest.raises(ModelError, match=r"event\[2\] is of its own link, and another one feeds it"):
        one.start(0.0)


CAPACITY, STANDBY, UNTIL, SWAP = 40e-6, 1.0, 8e-3, 1e-3  # F, W, s, s


def coupled(step: float) -> tuple[np.ndarray, np.ndarray]:
    """Voltage (V) and energy taken (J) every `SWAP`, the mains off from 0, in macro steps of `step` (s).

    The journal is held; an axis is off in every other `SWAP`, and its set point is 1.5 A in the others.
    """
    supply = link((0.0, OFF), capacitance=CAPACITY, standby=STANDBY, least=0.0)
    one = Instance(amb_actuator.MODEL)
    one.record["p"]["sample_time"] = 0.0
    one.record["u"]["link_voltage"] = 100.0
    one.start(0.0)
    per, found = round(SWAP / step), []
    for k in range(round(UNTIL / step)):
        one.record["u"]["axis"][0]["set"], one.record["u"]["axis"][0]["enable"] = 1.5, k // per % 2 == 0
        one.record["u"]["link_voltage"] = supply.record["o"]["voltage"]
        one.step(k * step, step)
        supply.record["u"]["actuator"][0]["energy"] = one.record["o"]["link_energy"]
        supply.step(k * step, step)
        found.append([supply.record["o"]["voltage"], one.record["o"]["link_energy"]])
    assert one.record["o"]["limits"]["voltage_time"] > 0.1e-3  # the voltage matters
    volts, taken = np.array(found)[per - 1 :: per].T
    return volts, taken


def one_system() -> tuple[np.ndarray, np.ndarray]:
    """The same by scipy: flux linkages, and the capacitor's voltage by C U U' = -sum v i - P."""
    q, volts, taken = np.array([lev.L0 * lev.BIAS] * 4 + [100.0, 0.0]), [], []
    for k in range(round(UNTIL / SWAP)):
        target = np.array([*([3.5, 0.5] if k % 2 == 0 else [0.0, 0.0]), lev.BIAS, lev.BIAS])

        def rates(t: float, q: np.ndarray, target: np.ndarray = target) -> np.ndarray:
            i = q[:4] / lev.L0
            asked = lev.RESISTANCE * i + lev.AMPLIFIER * lev.L0 * (target - i)
            v = np.clip(asked, -q[4], q[4])
            power = float(v @ i)
            return np.array([*(v - lev.RESISTANCE * i), -(power + STANDBY) / (CAPACITY * q[4]), power])

        q = solve_ivp(rates, (0.0, SWAP), q, "DOP853", rtol=1e-10, atol=1e-12).y[:, -1]
        volts.append(q[4])
        taken.append(q[5])
    return np.array(volts), np.array(taken)


def test_coils_on_a_falling_link_as_one_system():
    """Of first order in the macro step; coils that are emptied charge the capacitor."""
    volts, taken = one_system()
    assert np.diff(taken).min() < -0.01
    assert np.diff(volts).max() > 1.0
    assert volts[-1] < 95.0
    errors = []
    for step in (20e-6, 10e-6, 5e-6):
        found, energy = coupled(step)
        errors.append(np.abs(found - volts).max())
        balance = 0.5 * CAPACITY * (100.0**2 - found**2) - STANDBY * SWAP * np.arange(1, len(found) + 1)
        assert np.abs(balance - energy).max() < 1e-12  # J, of some 0.1
    assert errors[0] < 6.5e-3  # twice what was found
    assert math.log2(errors[0] / errors[2]) / 2 == pytest.approx(1.0, abs=0.1)
