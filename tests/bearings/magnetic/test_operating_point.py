"""The actuator about its operating point: as its own equations differ there, and as it starts."""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np
import pytest

from touchdown.bearings.magnetic import amb_actuator
from touchdown.bearings.magnetic.amb_actuator import EDDY, FLUX, RESET, SENSE
from touchdown.bearings.magnetic.linear import SIGNAL, LinearActuator
from touchdown.bearings.magnetic.magnet import EDDIES
from touchdown.modelkit.instance import Instance

LOADS = {  # N down, and settings
    "none": (0.0, {}),
    "light": (16.2, {}),
    "integral": (16.2, {"amplifier.reset": 800.0}),
    "one coil": (16.2, {"amplifier.bias": 0.4, "amplifier.reset": 800.0}),
    "one axis": (30.0, {"magnet.angle": 0.0}),
    "saturated": (3.0, {"magnet.flux_limit": 0.35}),
    "one saturated": (24.0, {"magnet.flux_limit": 0.5, "amplifier.reset": 300.0}),
    "at the limit": (16.2, {"amplifier.bias": 8.0}),
    "upwards": (-40.0, {"magnet.angle": 1.0}),
    "eddies": (16.2, {"magnet.eddy_bandwidth": 2000.0}),
    "eddies, integral": (16.2, {"magnet.eddy_bandwidth": 500.0, "amplifier.reset": 800.0}),
}


def loaded(load: float, settings: dict[str, float]) -> Instance:
    """Started with a static load (N) that it holds up."""
    one = Instance(amb_actuator.MODEL)
    for name, value in settings.items():
        group, _, last = name.partition(".")
        one.record["p"][group][last] = value
    one.record["u"]["journal"]["static_fy"], one.record["u"]["journal"]["inv_m"] = load, 0.5
    one.start(0.0)
    return one


def linear(one: Instance, axis: int) -> LinearActuator:
    """Of an axis, 1 or 2."""

    def value(name: str) -> float:
        if name.startswith("axis["):
            return float(one.record["o"]["axis"][axis - 1]["hold"])
        place = one.record["o" if name.startswith(("journal", "link")) else "p"]
        for part in name.split("."):
            place = place[part]
        return float(place)

    return LinearActuator.of(value, axis)


def derivative(one: Instance, axis: int, where: str, at: int, by: float) -> np.ndarray:
    """Of rates of fluxes, signal, integrals, and the force along an axis, by a difference of `by`."""
    found = []
    for sign in (1.0, -1.0):
        q, journal = one.record["q"].copy(), one.record["u"]["journal"]
        angle = float(one.record["p"]["magnet"]["angle"]) + (axis - 1) * math.pi / 2
        along = math.cos(angle), math.sin(angle)
        if where == "q":
            q[at] += sign * by
        if where == "u":
            journal["x"], journal["y"] = (sign * by * part for part in along)
        for k in range(2):
            held = float(one.record["o"]["axis"][k]["hold"])
            one.record["u"]["axis"][k]["set"] = held + (sign * by if (where, k) == ("i", axis - 1) else 0.0)
        dq = np.zeros(len(q))
        assert one.model.instant is not None
        one.model.instant(0.0, q, dq, one.words)
        out = one.record["o"]["journal"]
        own = [FLUX + 2 * (axis - 1), FLUX + 2 * axis - 1, SENSE + axis - 1]
        own += [RESET + 2 * (axis - 1), RESET + 2 * axis - 1, *eddies(axis, (0, 1))]
        found.append(np.append(dq[own], along[0] * out["fx"] + along[1] * out["fy"]))
        journal["x"], journal["y"] = 0.0, 0.0
    return (found[0] - found[1]) / (2.0 * by)


def eddies(axis: int, coils: Iterable[int]) -> list[int]:
    """Where the state has the eddy currents of coils (0: +, 1: -) of an axis."""
    return [EDDY + EDDIES * (2 * (axis - 1) + coil) + k for coil in coils for k in range(EDDIES)]


@pytest.mark.parametrize(("name", "axis"), [(name, 1 + i % 2) for i, name in enumerate(LOADS)])
def test_the_linear_actuator_is_the_derivative_of_the_model(name: str, axis: int):
    """Rates and force by state, displacement and control current; coils that are off stay off."""
    one = loaded(*LOADS[name])
    lin, inductance = linear(one, axis), float(one.record["d"]["inductance"])
    carry = [0 if c.sign > 0 else 1 for c in lin.coils]
    integrals = carry if lin.amplifier.reset > 0.0 else []
    windings = [5 + EDDIES * k + n for k in carry for n in range(EDDIES)]
    rows = [2, *carry, *(3 + k for k in integrals), *windings][: lin.states]  # of `derivative`, in order
    first = 2 * (axis - 1)
    places = [SENSE + axis - 1, *(FLUX + first + k for k in carry), *(RESET + first + k for k in integrals)]
    places += eddies(axis, carry)
    small = [1e-6, *(1e-5 * inductance for _ in carry), *(1e-6 for _ in integrals)]
    small += [1e-5 * inductance] * len(windings)
    for column in range(lin.states):
        d = derivative(one, axis, "q", places[column], small[column])
        assert d[rows] == pytest.approx(lin.rates[:, column], rel=1e-6, abs=1e-6 * np.abs(lin.rates).max())
        assert d[-1] == pytest.approx(lin.force[column], rel=1e-6, abs=1e-9)
    moved = lin.moved.copy()
    moved[SIGNAL] = lin.sensing.bandwidth
    d = derivative(one, axis, "u", 0, 1e-7)
    assert d[rows] == pytest.approx(moved, rel=1e-6, abs=1e-6 * np.abs(moved).max())
    if name != "at the limit":  # a set point at its limit may fall, and not rise
        d = derivative(one, axis, "i", 0, 1e-4)
        assert d[rows] == pytest.approx(lin.driven, rel=1e-6, abs=1e-6)


@pytest.mark.parametrize("name", LOADS)
def test_it_starts_with_the_force_that_holds_the_load(name: str):
    one = loaded(*LOADS[name])
    assert one.model.instant is not None
    one.model.instant(0.0, one.record["q"].copy(), np.zeros(len(one.record["q"])), one.words)
    force = one.record["o"]["journal"]
    assert float(force["fy"]) == pytest.approx(LOADS[name][0], rel=1e-12, abs=1e-11)
    assert float(force["fx"]) == pytest.approx(0.0, abs=1e-11)
    assert all(linear(one, axis).holds for axis in (1, 2))


def test_a_load_beyond_the_limits_is_said():
    one = linear(loaded(16.1865, {"magnet.flux_limit": 0.35}), 1)
    assert not one.holds
    assert next(one.shortfalls()).startswith("its magnets give 9.568 N at most")


def test_what_limits_do_not_allow():
    """Bias above a limit, unbalance beyond it, saturation, and a coil that is off; else nothing."""

    def said(settings: dict[str, float], control: float = 0.0, swing: float = 0.0) -> str:
        one = linear(loaded(16.1865, settings), 1)
        return " | ".join(one.shortfalls(control, [swing] * len(one.coils)))

    assert said({}) == ""
    assert said({}, control=3.5) == ""
    assert "is to carry 6.044 A (bias 2, holding 0.4436, unbalance 3.6 A)" in said({}, control=3.6)
    assert "its bias of 8 A is above amplifier.current_limit = 6 A" in said({"amplifier.bias": 8.0})
    assert "saturates" in said({"magnet.flux_limit": 0.5})
    assert said({"magnet.flux_limit": 0.52}) == ""
    assert "make 0.6118 T" in said({"magnet.flux_limit": 0.52}, swing=0.1 * 200 * 1e-4)
    assert "switches one coil off; k_i is 12.15 N/A" in said({"amplifier.bias": 0.4})
