"""The controller's law against C(z), its structures against each other, its states in their order."""

from __future__ import annotations

import math

import numpy as np
import pytest
from levitation import FILTER, KD, KI, KP, PERIOD

from touchdown.bearings.magnetic import amb_controller
from touchdown.bearings.magnetic.levitation import LEVITATED, RELEVITATING, WAITING
from touchdown.modelkit.instance import Instance

NOTCHES = ((900.0, 0.05, 0.5), (1600.0, 0.1, 0.6))  # Hz, damping of the numerator, of the denominator


def notch(frequency: float, numerator: float, denominator: float) -> tuple[float, ...]:
    """b0, b1, b2, a1, a2 by the bilinear transform, prewarped."""
    w, k = 2 / PERIOD * math.tan(math.pi * frequency * PERIOD), 2 / PERIOD
    up, down = (
        np.array([k * k + 2 * d * w * k + w * w, 2 * (w * w - k * k), k * k - 2 * d * w * k + w * w])
        for d in (numerator, denominator)
    )
    return (*(up / down[0]), *(down / down[0])[1:])


def controller(**settings: float) -> Instance:
    """Fed by the samples of a bearing."""
    one = Instance(amb_controller.MODEL)
    for name, value in settings.items():
        one.record["p"][name] = value
    one.record["u"]["period"] = PERIOD
    return one


def sample(one: Instance, *positions: float) -> np.ndarray:
    """The set points (A) after one more sample of the positions (m)."""
    u, o = one.record["u"], one.record["o"]
    for axis, y in zip(u["axis"], positions, strict=False):
        axis["sensed"] = y
    now = u["tick"] * PERIOD
    u["tick"] += 1.0
    one.step(now, PERIOD)
    return np.array([axis["set"] for axis in o["axis"]])


def events(one: Instance, *listed: tuple[float, int]) -> None:
    """Times (s) and kinds."""
    for event, (time, kind) in zip(one.record["p"]["event"], listed, strict=False):
        event["time"], event["kind"] = time, kind


def test_its_impulse_response_is_that_of_its_transfer_function():
    """PID with two notches in the second axis; the integral's share that stays is summed in closed form."""
    one = controller(limit=1e12)
    for section, (f, up, down) in zip(one.record["p"]["channel"][1]["section"], NOTCHES, strict=False):
        for name, value in zip(("b0", "b1", "b2", "a1", "a2"), notch(f, up, down), strict=True):
            section[name] = value
    one.start(0.0)
    count = 4000
    answer = np.array([sample(one, 0.0, -1.0 if k == 0 else 0.0)[1] for k in range(count)])
    z = np.exp(2j * np.pi * np.array([50.0, 900.0, 2500.0]) * PERIOD)
    found = np.array([np.sum(answer * one_z ** -np.arange(count)) for one_z in z])
    found += answer[-1] * z**-count / (1 - 1 / z)
    expected = KP + KI * PERIOD * z / (z - 1) + KD * FILTER * (z - 1) / ((1 + FILTER * PERIOD) * z - 1)
    for f, up, down in NOTCHES:
        b0, b1, b2, a1, a2 = notch(f, up, down)
        expected = expected * (b0 + b1 / z + b2 / z**2) / (1 + a1 / z + a2 / z**2)
    assert np.abs(found / expected - 1).max() < 1e-11


def test_gains_of_a_channel_are_over_those_of_all():
    one = controller()
    channel = one.record["p"]["channel"][2]
    channel["proportional"], channel["integral"], channel["derivative"] = 0.5, 0.0, 2.0
    one.start(0.0)
    y = 1e-6
    found = sample(one, *[y] * 4)
    slope = KD * FILTER * y / (1 + FILTER * PERIOD)  # from the centre, where it started
    usual = -KP * y - KI * PERIOD * y - slope
    assert found == pytest.approx([usual, usual, -0.5 * KP * y - 2.0 * slope, usual], rel=1e-12)


def test_one_more_sample_of_delay():
    usual, late = controller(), controller(delay=1)
    for one in (usual, late):
        one.start(0.0)
    places = np.random.default_rng(3).uniform(-1e-5, 1e-5, 30)
    answers = [sample(usual, y)[0] for y in places]
    delayed = [sample(late, y)[0] for y in places]
    assert delayed[0] == 0.0
    assert delayed[1:] == answers[:-1]


def test_translation_and_tilt_with_equal_gains_are_the_axes():
    apart, both = controller(), controller(structure=1)
    for one in (apart, both):
        for k, axis in enumerate(one.record["u"]["axis"]):
            axis["hold"] = 0.1 * k
        one.start(0.0)
    for places in np.random.default_rng(4).uniform(-1e-5, 1e-5, (50, 4)):
        assert sample(both, *places) == pytest.approx(sample(apart, *places), rel=1e-10, abs=1e-13)


def test_anti_windup_keeps_the_integral():
    """Pushed out for a second, the set point leaves its limit as soon as the position is back."""
    one = controller(limit=1.0)
    one.start(0.0)
    for _ in range(10_000):
        assert sample(one, 1e-3)[0] >= -1.0
    assert one.record["s"]["channel"][0]["integral"] > -1.0
    assert sample(one, -1e-4)[0] == 1.0
    assert one.record["o"]["limited_time"] == pytest.approx(10_001 * PERIOD)  # at each sample so far
    for _ in range(100):
        sample(one, -1e-6)
    assert one.record["o"]["limited_time"] < 10_051 * PERIOD  # not while the set points are small


def test_states_follow_the_events_and_the_rotor():
    one = controller()
    events(one, (5e-3, 1), (20e-3, 2))
    one.record["p"]["capture"]["time"] = 10e-3
    for axis in one.record["u"]["axis"][:2]:
        axis["hold"] = 0.5
    one.start(0.0)
    o = one.record["o"]
    seen: list[tuple[int, float]] = []
    for k in range(500):
        t = k * PERIOD
        y = 0.0 if t < 5e-3 else 250e-6 * max(1.0 - max(t - 20e-3, 0.0) / 10e-3, 0.0)
        asked = sample(one, y)
        if not seen or seen[-1][0] != o["state"]:
            seen.append((int(o["state"]), round(t, 6)))
        if o["state"] == WAITING:
            assert o["axis"][0]["enable"] == asked[0] == 0.0
    assert [state for state, _ in seen] == [LEVITATED, WAITING, RELEVITATING, LEVITATED]
    assert [t for _, t in seen[1:3]] == [5e-3, 20e-3]
    inside = 20e-3 + 10e-3 * (1 - 150 / 250)
    assert o["captured_time"] == pytest.approx(inside, abs=1.5 * PERIOD)
    assert seen[3][1] == pytest.approx(inside + 10e-3, abs=1.5 * PERIOD)


def test_relevitation_begins_with_what_holds_the_rotor():
    """Its first set point is the static one: reference and position are the same, there is no jump."""
    one = controller()
    events(one, (5e-3, 1), (20e-3, 2))
    one.record["u"]["axis"][0]["hold"] = 0.5
    one.start(0.0)
    asked = [sample(one, 0.0 if k < 50 else -200e-6)[0] for k in range(201)]
    assert asked[199] == 0.0
    assert asked[200] == pytest.approx(0.5, abs=1e-12)


def test_without_samples_of_the_bearing_a_macro_step_is_one():
    """The bearing tells no period: derivative and integral, and events, go by the macro step."""
    step = 4e-5
    usual, bare = controller(), controller()
    usual.record["u"]["period"], bare.record["u"]["period"] = step, 0.0
    for one in (usual, bare):
        events(one, (10.5 * step, 1))
        one.start(0.0)
    for k, y in enumerate(np.random.default_rng(5).uniform(-1e-5, 1e-5, 20)):
        asked = []
        for one, tick in ((usual, k + 2), (bare, k + 1)):
            u = one.record["u"]
            u["axis"][0]["sensed"], u["tick"] = y, tick
            one.step(k * step, step)
            asked.append(float(one.record["o"]["axis"][0]["set"]))
        assert asked[1] == pytest.approx(asked[0], rel=1e-12)
        assert (asked[1] == 0.0) == (k >= 10)  # the eleventh macro step ends at 11 steps
