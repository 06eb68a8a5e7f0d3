"""The flexible rotor starts as told and steps its equations: order, finite elements, itself again."""

from __future__ import annotations

import numpy as np
import pytest
import rotor_alone as alone
from scipy.integrate import solve_ivp

from touchdown.modelkit.instance import Instance
from touchdown.modelkit.model import ModelError
from touchdown.rotor.beams.shaft import assembled_matrices, unit_forces
from touchdown.rotor.file import parse_rotor
from touchdown.rotor.flexible import flexible_rotor


@pytest.mark.parametrize(("unbalance", "largest"), [(1.0, 2e-10), (100.0, 1e-9)])
def test_a_macro_step_solves_the_equations(unbalance: float, largest: float) -> None:
    """Linear loads and moments at both seats, 18000 rpm: 0.04 nm kg^0.5 of 36 um kg^0.5 in 0.1 ms."""
    assert alone.deviations(1e-4, [5e-6], unbalance_scale=unbalance)[0] < largest


@pytest.mark.parametrize("unbalance", [1.0, 100.0])
def test_strides_are_of_second_order_with_residual_vectors(unbalance: float) -> None:
    """Up to 12.6 kHz, so from 20 us downwards."""
    lengths = [2e-5, 1e-5, 5e-6]
    errors = alone.deviations(1e-4, lengths, unbalance_scale=unbalance)
    assert alone.order(lengths, errors) == pytest.approx(2.0, abs=0.15)


def test_it_starts_at_rest_in_its_magnetic_bearings() -> None:
    """They carry the weight without a moment, bent as the rotor is; nothing accelerates anywhere."""
    rotor = Instance(alone.MODEL)
    rotor.record["p"]["unbalance_scale"] = 0.0
    rotor.start(0.0)
    static = np.array(rotor.record["o"]["station"]["static_fy"][: len(alone.NAMES)])
    assert static[[alone.NAMES.index("A"), alone.NAMES.index("B")]] == pytest.approx(0.0, abs=0.0)
    assert np.sum(static) == pytest.approx(alone.SHAFT.mass * alone.G, rel=1e-12)
    assert static @ alone.ARMS == pytest.approx(0.0, abs=1e-12 * alone.SHAFT.mass * alone.G)
    rotor.record["u"]["station"]["fy"][: len(alone.NAMES)] = static
    rotor.start(0.0)
    sag = np.array(rotor.record["o"]["station"]["y"])
    assert np.max(np.abs(sag)) > 1e-8
    for own, o in zip(static, rotor.record["o"]["station"], strict=False):
        assert abs(o["ay_free"] + o["inv_m"] * own) < 1e-9 * alone.G
        assert o["ax_free"] == 0.0
    alone.run(rotor, 20, 1e-4)
    assert np.max(np.abs(rotor.record["o"]["station"]["y"] - sag)) < 1e-14


STUB = """
title = "Stub"
[material.steel]
modulus = "207 GPa"
density = "7830 kg/m3"
poisson = 0.3
[[element]]
length = "60 mm"
outer_diameter = "20 mm"
[[element]]
length = "80 mm"
outer_diameter = "40 mm"
[[element]]
length = "50 mm"
outer_diameter = "25 mm"
[stations]
A = 1
B = 4
[sensors]
middle = 3
"""


def test_all_modes_are_the_finite_elements() -> None:
    """A step load on a stub that spins, against M q'' - i Omega G q' + K q = F in nodal coordinates."""
    stub = parse_rotor(STUB, "stub.toml")
    model = flexible_rotor(stub, "stub")
    force, span = 200.0 - 50.0j, 1e-3
    rotor = Instance(model)
    p = rotor.record["p"]
    p["modes"], p["damping_ratio"], p["speed"], p["gravity"], p["micro_step"] = 0, 0.0, 4e3, 0.0, 1e-6
    rotor.start(0.0)
    load_a = rotor.record["u"]["station"][0]
    load_a["fx"], load_a["fy"] = force.real, force.imag
    alone.run(rotor, 10, span / 10)
    matrices = assembled_matrices(stub)
    size = 2 * stub.nodes
    inverse = np.linalg.inv(matrices.mass)
    applied = inverse @ unit_forces(stub, [1])[:, 0] * force
    by_shift, by_rate = inverse @ matrices.stiffness, inverse @ (1j * 4e3 * matrices.polar)

    def rates(_: float, s: np.ndarray) -> np.ndarray:
        return np.concatenate((s[size:], applied - by_shift @ s[:size] + by_rate @ s[size:]))

    found = solve_ivp(rates, (0.0, span), np.zeros(2 * size, complex), "DOP853", rtol=1e-10, atol=1e-15)
    q, v = found.y[:size, -1], found.y[size:, -1]
    out = rotor.record["o"]
    for o, node in ((out["station"][0], 1), (out["station"][1], 4), (out["sensor"][0], 3)):
        assert abs(complex(o["x"], o["y"]) - q[2 * node - 2]) < 5e-7 * np.max(np.abs(q[0::2]))
        assert abs(complex(o["vx"], o["vy"]) - v[2 * node - 2]) < 2e-6 * np.max(np.abs(v[0::2]))


def test_a_restored_rotor_goes_the_same_way() -> None:
    """Bit for bit, peaks of stresses included."""
    rotor = alone.started(alone.PULLED, unbalance_scale=100.0, speed=alone.FAST)
    alone.run(rotor, 5, 1e-4)
    kept = rotor.save()
    alone.run(rotor, 5, 1e-4)
    after = rotor.save()
    rotor.restore(kept)
    assert rotor.save() == kept != after
    alone.run(rotor, 5, 1e-4)
    assert rotor.save() == after


@pytest.mark.parametrize(
    ("name", "value", "says"),
    [
        ("modes", 1, f"modes = 1 must be from 2 (rigid) to {2 * alone.SHAFT.nodes}"),
        ("modes", 2 * alone.SHAFT.nodes + 1, f"modes = {2 * alone.SHAFT.nodes + 1} must be"),
        ("stress.node", alone.SHAFT.nodes + 1, f"stress.node = {alone.SHAFT.nodes + 1}: "),
    ],
)
def test_what_the_shaft_does_not_have_is_refused(name: str, value: int, says: str) -> None:
    """One line with the name, the value and the remedy."""
    rotor = Instance(alone.MODEL)
    *groups, field = name.split(".")
    place = rotor.record["p"]
    for group in groups:
        place = place[group]
    place[field] = value
    with pytest.raises(ModelError) as error:
        rotor.start(0.0)
    assert says in str(error.value)
    assert str(2 * alone.SHAFT.nodes if field == "modes" else alone.SHAFT.nodes) in str(error.value)
    assert "\n" not in str(error.value)
