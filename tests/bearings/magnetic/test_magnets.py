"""Magnets and amplifiers of the actuator against closed forms, the journal held in place."""

from __future__ import annotations

import math

import levitation as lev
import numpy as np
import pytest
from scipy.special import erfcx

from touchdown.bearings.magnetic import amb_actuator
from touchdown.bearings.magnetic.amplifier import (
    COIL_OFF,
    COIL_ON,
    COIL_SHORT,
    COIL_STUCK,
    LINK_OFF,
    LINK_ON,
    SENSOR_LOST,
    SENSOR_ON,
    SENSOR_STUCK,
)
from touchdown.bearings.magnetic.magnet import EDDIES, EDDY_DIRECT, EDDY_FACTORS, EDDY_RATES
from touchdown.modelkit.instance import Instance
from touchdown.modelkit.model import ModelError, StepSizeError

STEP = 1e-4  # s
ALONG = 1j**0.5  # the first axis


def held(current: float = 0.0, displacement: float = 0.0, steps: int = 200, **settings: float) -> Instance:
    """The actuator, its journal held on the first axis (m), after `steps` with a control current (A)."""
    one = Instance(amb_actuator.MODEL)
    p, u = one.record["p"], one.record["u"]
    for name, value in settings.items():
        group, _, last = name.rpartition("__")
        (p[group] if group else p)[last] = value
    u["journal"]["x"], u["journal"]["y"] = (displacement * ALONG).real, (displacement * ALONG).imag
    one.start(0.0)
    u["axis"][0]["set"] = current
    for k in range(steps):
        one.step(k * STEP, STEP)
    return one


def force(one: Instance) -> complex:
    """Along the first axis, and across (N)."""
    j = one.record["o"]["journal"]
    return complex(j["fx"], j["fy"]) * ALONG.conjugate()


def test_constants_are_the_closed_forms():
    """And these the slopes of the force law."""
    assert lev.operating_point(0.0) == pytest.approx((0.0, lev.K_I, lev.K_S), rel=1e-14)
    out = held(steps=0).record["o"]
    assert out["current_factor"] == pytest.approx(lev.K_I, rel=1e-14)
    assert out["displacement_factor"] == pytest.approx(lev.K_S, rel=1e-14)
    assert (
        pytest.approx(25.7996, abs=1e-4),
        pytest.approx(-79452.4, abs=0.1),
        pytest.approx(4.1888e-3, abs=1e-7),
    ) == (lev.K_I, lev.K_S, lev.L0)


@pytest.mark.parametrize(("i", "u"), [(1.0, 0.0), (0.5, 1e-4), (-1.5, 2e-4)])
def test_settled_force_is_that_of_the_currents_and_gaps(i: float, u: float):
    found = force(held(i, u))
    assert found.real == pytest.approx(lev.pull(i, u).real, rel=1e-6)
    assert abs(found.imag) < 1e-6 * abs(lev.pull(i, u))


def test_saturated_iron_limits_the_force():
    """The - coil empty, the + coil far beyond saturation: B_s^2 A/mu0 cos(alpha), and what air adds."""
    one = held(20.0, 0.0, amplifier__current_limit=8.0)
    limit = lev.SATURATED**2 * lev.AREA / lev.MU0 * math.cos(lev.POLE)
    assert limit == pytest.approx(105.87, abs=0.01)
    i, per_flux, iron = 8.0, lev.GAP / (2 * lev.K), 0.1 / (lev.MU0 * 200.0)
    flux = (i + iron * lev.SATURATED) / (per_flux + iron / (200.0 * lev.AREA))
    assert force(one).real == pytest.approx(flux**2 / (4 * lev.K) * math.cos(lev.POLE), rel=1e-6)
    assert 1.0 < force(one).real / limit < 1.02


def test_slew_is_limited_by_the_voltage():
    """Without resistance the flux rises by U: dF/dt = 2 U i0/s0 cos(alpha), di/dt = U/L0."""
    one = held(steps=1, amplifier__resistance=0.0)
    one.record["u"]["axis"][0]["set"] = 3.5  # both coils' voltages at their limits for more than 1 us
    before = force(one).real
    span = 2e-6
    one.step(STEP, span)
    axis = one.record["o"]["axis"][0]
    assert (axis["voltage_plus"], axis["voltage_minus"]) == (lev.VOLTAGE, -lev.VOLTAGE)
    slope = (axis["force"] - before) / span
    assert slope == pytest.approx(2 * lev.VOLTAGE * lev.BIAS / lev.GAP * math.cos(lev.POLE), rel=1e-6)
    assert (axis["current_plus"] - lev.BIAS) / span == pytest.approx(lev.VOLTAGE / lev.L0, rel=1e-6)
    assert one.record["o"]["limits"]["voltage_time"] == pytest.approx(span, rel=1e-9)


@pytest.mark.parametrize(
    ("pole", "limit", "resistance", "eddies", "within"),
    [
        (lev.POLE, lev.SATURATED, 2.0, 0.0, 3e-7),
        (1.2, 0.5, 0.0, 0.0, 1e-5),
        (lev.POLE, 0.5, 0.0, 2000.0, 1e-5),
    ],
)
def test_what_the_link_gives_is_heat_field_and_the_rotor_s_work(
    pole: float, limit: float, resistance: float, eddies: float, within: float
):
    """Along a driven path of both axes, with both currents driven: nothing is lost or made.

    Motion is straight and set points are constant over two steps, so that Simpson's rule is smooth; where
    the iron saturates on the way (0.5 T) or currents jump by eddy currents it is not, and the coils have no
    resistance.
    """
    settings = {"magnet__pole_angle": pole, "magnet__flux_limit": limit, "magnet__eddy_bandwidth": eddies}
    one = held(steps=0, amplifier__resistance=resistance, **settings)
    journal, axes, out = one.record["u"]["journal"], one.record["u"]["axis"], one.record["o"]
    step, pairs = 5e-6, 2000
    path = 1.5e-4 * np.exp(2j * math.pi * np.arange(pairs + 1) / 400) * np.linspace(0.0, 1.0, pairs + 1)

    def squares() -> float:
        currents = [axis[f"current_{coil}"] for axis in out["axis"] for coil in ("plus", "minus")]
        return float(np.sum(np.square(currents)))

    def field() -> float:
        place = complex(journal["x"], journal["y"]) / ALONG
        gaps = [lev.GAP - s * math.cos(pole) * u for u in (place.real, place.imag) for s in (1, -1)]
        fluxes = one.record["q"][amb_actuator.FLUX : amb_actuator.FLUX + 4]
        over = np.maximum(fluxes / (200.0 * lev.AREA) - limit, 0.0)
        found = np.sum(fluxes**2 * gaps / (4 * lev.K) + 0.1 * lev.AREA * over**2 / (2 * lev.MU0))
        windings = one.record["q"][amb_actuator.EDDY :][: 4 * EDDIES].reshape(4, EDDIES)
        lags = (fluxes[:, None] - windings) ** 2 if eddies else 0.0 * windings
        return float(found + 0.5 * float(one.record["d"]["eddy"]) * np.sum(lags * EDDY_FACTORS))

    begun, copper = field(), 0.0
    for k in range(pairs):
        velocity = (path[k + 1] - path[k]) / (2 * step)
        journal["vx"], journal["vy"] = velocity.real, velocity.imag
        axes[0]["set"], axes[1]["set"] = math.sin(k // 10 / 20), math.cos(k // 10 / 30)
        heat = squares()
        for half in (0, 1):
            place = path[k] + half * step * velocity
            journal["x"], journal["y"] = place.real, place.imag
            one.step((2 * k + half) * step, step)
            heat += (4.0, 1.0)[half] * squares()
        copper += resistance * heat * step / 3
    journal["x"], journal["y"] = path[-1].real, path[-1].imag
    worked = float(out["supplied"])
    assert abs(worked) > 5e-4
    left = float(out["link_energy"]) - copper - (field() - begun) - float(out["eddy_loss"])
    assert (float(out["eddy_loss"]) > 2.0 * abs(worked)) == (eddies > 0.0)
    assert left == pytest.approx(worked, rel=within)


def half_order(omega: np.ndarray) -> np.ndarray:
    """sqrt(j omega) by the windings."""
    s = 1j * omega[:, None]
    return EDDY_DIRECT * s[:, 0] + np.sum(np.array(EDDY_FACTORS) * s / (s + np.array(EDDY_RATES)), axis=1)


def test_windings_are_a_half_order_derivative():
    """Its largest error from 1 Hz to 10 kHz, as stated."""
    omega = 2 * math.pi * np.geomspace(1.0, 1e4, 5000)
    error = np.abs(half_order(omega) / np.sqrt(1j * omega) - 1.0)
    assert error.max() == pytest.approx(0.0058, abs=1e-4)


@pytest.mark.parametrize("hertz", [5.0, 100.0, 1000.0, 5000.0])
def test_eddy_currents_hold_the_force_back_by_half_an_order(hertz: float):
    """Force over current k_i/(1 + sqrt(j w/w_e)); 0.6 % of the windings' sum, the rest of steps."""
    corner, steps = 2 * math.pi * 300.0, 1000
    one = held(steps=0, sample_time=0.0, magnet__eddy_bandwidth=corner)
    axis, omega, step = one.record["o"]["axis"][0], 2 * math.pi * hertz, 1.0 / (hertz * steps)
    found = []
    for k in range(4 * steps):
        one.record["u"]["axis"][0]["set"] = 0.2 * math.sin(omega * (k + 0.5) * step)
        one.step(k * step, step)
        found.append((axis["force"], axis["current_plus"] - axis["current_minus"]))
    turns = np.exp(-2j * math.pi * np.arange(steps) / steps)
    force, current = np.array(found[-steps:]).T @ turns
    expected = lev.K_I / (1 + np.sqrt(1j * omega / corner))
    assert abs(2.0 * force / current / expected - 1.0) < 1e-2


def test_flux_outlives_the_current_of_a_coil_that_is_off():
    """lambda_0 exp(w_e t) erfc(sqrt(w_e t)) after a current that ends at once, here within 20 us."""
    corner, off = 2 * math.pi * 300.0, 0.1e-3
    fast = {"amplifier__bandwidth": 4e5, "supply__voltage": 2000.0, "magnet__eddy_bandwidth": corner}
    one = held(steps=0, sample_time=0.0, **fast)
    event = one.record["p"]["event"][0]
    event["time"], event["kind"], event["coil"] = off, COIL_OFF, 2
    for k in range(60):
        one.step(k * STEP, STEP)
        if k in (9, 19, 59):
            assert abs(one.record["o"]["axis"][0]["current_minus"]) < 1e-3
            left = one.record["q"][amb_actuator.FLUX + 1] / (lev.L0 * lev.BIAS)
            assert left == pytest.approx(erfcx(math.sqrt(corner * ((k + 1) * STEP - off))), rel=1e-2)


def test_without_eddy_currents_their_states_are_not_there():
    assert held(steps=0).record["n"] == amb_actuator.SIZE


def test_a_coil_whose_amplifier_failed_is_emptied_by_the_link():
    one = Instance(amb_actuator.MODEL)
    event = one.record["p"]["event"][0]
    event["time"], event["kind"], event["coil"] = 0.25e-3, 1, 2
    one.start(0.0)
    for k in range(2):
        one.step(k * STEP, STEP)
    assert force(one).real == pytest.approx(0.0, abs=1e-9)
    one.step(2 * STEP, STEP)
    flux = (
        lev.L0 * lev.BIAS - (lev.VOLTAGE + 0.5 * lev.BIAS) * 50e-6
    )  # of 8.4 mV s; the current falls little in that time
    expected = math.cos(lev.POLE) / (4 * lev.K) * ((lev.L0 * lev.BIAS) ** 2 - flux**2)
    assert one.record["o"]["axis"][0]["force"] == pytest.approx(expected, rel=2e-2)
    for k in range(3, 12):
        one.step(k * STEP, STEP)
    assert one.record["o"]["axis"][0]["current_minus"] == 0.0
    assert one.record["o"]["axis"][1]["current_minus"] == pytest.approx(lev.BIAS, rel=1e-6)


def test_noise_is_even_and_told_again():
    """Within its bound, of the mean and the variance of an even distribution, by seed, tick and axis."""
    one = held(steps=0, sensing__noise=3e-6)
    first = one.save()
    axes = one.record["o"]["axis"]
    seen = []
    for k in range(2000):
        one.step(k * STEP, STEP)
        seen.append([axes[0]["sensed"], axes[1]["sensed"]])
    found = np.array(seen)
    assert np.abs(found).max() <= 3e-6
    assert np.abs(found.mean(axis=0)).max() < 4 * 3e-6 / math.sqrt(3 * 2000)
    assert found.std(axis=0) == pytest.approx([3e-6 / math.sqrt(3)] * 2, rel=0.05)
    assert abs(np.corrcoef(found.T)[0, 1]) < 0.1
    one.restore(first)
    one.step(0.0, STEP)
    assert [axes[0]["sensed"], axes[1]["sensed"]] == seen[0]


def test_a_macro_step_beyond_the_sample_time_is_refused():
    one = held(steps=0)
    with pytest.raises(StepSizeError, match="longer than sample_time, from sample to sample"):
        one.step(0.0, 1.5e-4)


def test_samples_are_counted_from_zero_whenever_it_starts():
    """Started at 1.23 ms it takes the samples at 1.3 and 1.4 ms, numbers 13 and 14."""
    one = Instance(amb_actuator.MODEL)
    one.start(1.23e-3)
    assert one.record["o"]["tick"] == 13
    for k in range(3):
        one.step(1.23e-3 + k * 60e-6, 60e-6)
    assert one.record["o"]["tick"] == 15


def with_events(*listed: tuple[float, int, int]) -> Instance:
    """An actuator with events of these times (s), kinds and coils."""
    one = Instance(amb_actuator.MODEL)
    for event, values in zip(one.record["p"]["event"], listed, strict=False):
        event["time"], event["kind"], event["coil"] = values
    return one


def test_of_events_before_the_start_the_last_one_counts():
    """Whichever their order in the list: the link is on again, the second coil has failed."""
    listed = (
        (0.5, LINK_ON, 0),
        (0.1, LINK_OFF, 0),
        (0.3, COIL_OFF, 2),
        (0.2, COIL_ON, 0),
        (0.2, COIL_OFF, 1),
    )
    for order in (listed, listed[::-1]):
        one = with_events(*order)
        one.start(0.6)
        one.step(0.6, STEP)
        assert one.record["o"]["link"] == lev.VOLTAGE
        first = 1.0 if order is not listed else 0.0  # at the same time, the last of the list
        assert [coil["fault"] == 0 for coil in one.record["s"]["coil"]] == [first, 0.0, 1.0, 1.0]


def run_held(one: Instance, until: float, u: float = 0.0) -> np.ndarray:
    """Currents (A) of the four coils at the time `until` (s), on from where it is, the journal held (m)."""
    journal, out = one.record["u"]["journal"], one.record["o"]
    journal["x"], journal["y"] = (u * ALONG).real, (u * ALONG).imag
    for k in range(round(float(one.record["time"] + 2 * one.record["half"]) / STEP), round(until / STEP)):
        one.step(k * STEP, STEP)
    return np.array([axis[f"current_{coil}"] for axis in out["axis"] for coil in ("plus", "minus")])


def test_the_current_of_a_shorted_coil_decays_by_its_resistance():
    """i = i0 exp(-R t/L), L = 2 K/g, from the event on, to a micro-step's 1e-6; the link gives nothing.

    Without resistance its flux stays, and its current moves with its gap.
    """
    one = with_events((0.25e-3, COIL_SHORT, 2))
    one.start(0.0)
    one.record["u"]["axis"][0]["set"] = 0.0
    i = run_held(one, 8e-3)
    decay = math.exp(-lev.RESISTANCE * (8e-3 - 0.25e-3) / lev.L0)
    assert decay < 0.5
    assert i == pytest.approx([lev.BIAS, lev.BIAS * decay, lev.BIAS, lev.BIAS], rel=1e-5)
    assert one.record["o"]["axis"][0]["voltage_minus"] == 0.0
    heat = lev.RESISTANCE * lev.BIAS**2 * (3 * 8e-3 + 0.25e-3)
    assert one.record["o"]["link_energy"] == pytest.approx(heat, rel=1e-5)
    one = with_events((0.0, COIL_SHORT, 1), (9e-4, COIL_ON, 1))
    one.record["p"]["amplifier"]["resistance"] = 0.0
    one.start(0.0)
    run_held(one, STEP)
    assert run_held(one, 5e-4, 1e-4)[0] == pytest.approx(
        lev.BIAS * (1 - 1e-4 * math.cos(lev.POLE) / lev.GAP), rel=1e-9
    )
    assert run_held(one, 3e-3, 1e-4)[0] == pytest.approx(lev.BIAS, rel=1e-6)  # its amplifier is back


def test_a_stuck_amplifier_drives_its_coil_to_voltage_over_resistance():
    """i = U/R + (i0 - U/R) exp(-R t/L) in iron that does not saturate, to a micro-step's 1e-6."""
    one = with_events((0.25e-3, COIL_STUCK, 3))
    one.record["p"]["magnet"]["flux_limit"] = 1e6
    one.start(0.0)
    end = lev.VOLTAGE / lev.RESISTANCE
    for until in (1e-3, 60e-3):
        left = math.exp(-lev.RESISTANCE * (until - 0.25e-3) / lev.L0)
        i = run_held(one, until)
        assert i[2] == pytest.approx(end + (lev.BIAS - end) * left, rel=1e-5)
    assert i[[0, 1, 3]] == pytest.approx([lev.BIAS] * 3, rel=1e-6)
    assert one.record["o"]["axis"][1]["voltage_plus"] == lev.VOLTAGE
    assert one.record["o"]["limits"]["voltage_time"] == 0.0  # no control asks for it
    limit = float(one.record["p"]["amplifier"]["current_limit"])
    over = 0.25e-3 + lev.L0 / lev.RESISTANCE * math.log((end - lev.BIAS) / (end - limit))
    assert one.record["o"]["limits"]["current_time"] == pytest.approx(
        60e-3 - over, abs=1e-4
    )  # of a micro-step


def test_a_sensor_s_signal_gets_stuck_or_lost_at_the_next_sample():
    """The last sample before the event stays; the other axis, and both amplifiers, go on."""
    one = with_events((0.25e-3, SENSOR_STUCK, 1), (0.55e-3, SENSOR_LOST, 0), (0.85e-3, SENSOR_ON, 2))
    one.record["p"]["sensing"]["noise"] = 3e-6
    one.start(0.0)
    seen = []
    for k in range(1, 12):  # after samples 0 to 10
        run_held(one, k * STEP)
        seen.append([axis["sensed"] for axis in one.record["o"]["axis"]])
    first, second = np.array(seen).T
    assert len(set(first[:3])) == 3
    assert (first[3:6] == first[2]).all()
    assert (first[6:] == 0.0).all()
    assert (second[6:9] == 0.0).all()
    assert len({*second[:6], *second[9:]}) == 8
    with pytest.raises(ModelError, match=r"event\[2\].coil = 3: sensors are numbered 1 to 2 by"):
        with_events((0.0, COIL_OFF, 3), (0.0, SENSOR_LOST, 3)).start(0.0)
