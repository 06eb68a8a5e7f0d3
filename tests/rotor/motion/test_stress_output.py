"""The stresses that a flexible rotor tells: those of finite elements, their peaks, one instant."""

from __future__ import annotations

import math

import numpy as np
import pytest
import rotor_alone as alone

from touchdown.modelkit.instance import Instance
from touchdown.rotor.beams.shaft import assembled_matrices, solve_held, unit_forces
from touchdown.rotor.modal.modal_stresses import end_nodes, stress_rows

BALANCED = np.array([300.0, -120.0])  # N at the seats; the magnetic bearings balance them


def balanced() -> np.ndarray:
    """Forces at all stations whose sum and moment vanish."""
    seats, others = (
        [alone.NAMES.index("A"), alone.NAMES.index("B")],
        [alone.NAMES.index("amb_A"), alone.NAMES.index("amb_B")],
    )
    balance = np.vstack((np.ones(len(alone.ARMS)), alone.ARMS))
    forces = np.zeros(len(alone.NAMES))
    forces[seats] = BALANCED
    forces[others] = np.linalg.solve(balance[:, others], -balance[:, seats] @ BALANCED)
    return forces


def full_stresses(forces: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Bending and shear at the elements' ends by all finite elements, held at node 1."""
    load = unit_forces(alone.SHAFT, alone.NODES) @ forces
    q = np.zeros_like(load)
    q[2:] = solve_held(assembled_matrices(alone.SHAFT).stiffness[2:, 2:], load[2:])
    bending, shear = stress_rows(alone.SHAFT)
    return bending @ q, shear @ q


@pytest.mark.parametrize(("modes", "residual"), [(3, 0), (5, 1)])
def test_a_rotor_at_rest_under_load_tells_the_stresses_of_finite_elements(
    modes: int, residual: int
) -> None:
    """Damped to rest under balanced forces in x and, times -0.5, in y."""
    forces = balanced()
    loads = {name: {"fx": f, "fy": -0.5 * f} for name, f in zip(alone.NAMES, forces, strict=True)}
    bending, shear = full_stresses(forces)
    resultant = math.hypot(1.0, 0.5)
    told = []
    for acceleration in (1, 0):
        rotor = Instance(alone.MODEL)
        p = rotor.record["p"]
        p["modes"], p["residual"], p["damping_ratio"], p["gravity"] = modes, residual, 1.0, 0.0
        p["speed"], p["unbalance_scale"], p["stress"]["mode_acceleration"] = 0.0, 0.0, acceleration
        rotor.start(0.0)
        alone.give(rotor, loads)
        alone.run(rotor, 50, 1e-4)
        o = rotor.record["o"]["stress"]
        told.append((float(o["bending"]), float(o["shear"])))
    assert told[0][0] == pytest.approx(resultant * np.max(np.abs(bending)), rel=1e-6)
    assert told[0][1] == pytest.approx(resultant * np.max(np.abs(shear)), rel=1e-6)
    assert told[1][1] != pytest.approx(told[0][1], rel=0.02)


@pytest.mark.parametrize("node", [0, 8])
def test_peaks_are_held_and_one_instant_is_kept(node: int) -> None:
    """A pulse and what rings after it: peaks with place and time; stresses when `stress.node` had its."""
    rotor = Instance(alone.MODEL)
    rotor.record["p"]["stress"]["node"] = node
    rotor.record["p"]["residual"] = 0  # so that loads at the seats have stresses of their own
    rotor.record["p"]["micro_step"] = step = 2e-5  # one look a macro step, at its end
    rotor.start(0.0)
    d, o = rotor.record["d"], rotor.record["o"]
    stress = d["stress"]
    n, ends, history = int(d["modes"]), int(stress["ends"]), []
    assert np.array_equal(end_nodes(alone.SHAFT), stress["node"][:ends])
    for k in range(100):
        alone.give(rotor, alone.PULLED if k < 20 else {}, math.sin(math.pi * k / 20.0))
        rotor.step(k * step, step)
        u = rotor.record["u"]["station"]
        force = np.array([u["fx"] + 1j * u["fy"], u["dfx"] + 1j * u["dfy"]])[:, : len(alone.NAMES)]
        last = force[0] + 0.5 * step * force[1]
        p = alone.coordinates(rotor)[0]
        history.append([
            stress[kind][:n, :ends].T @ p + stress[f"{kind}_load"][: len(alone.NAMES), :ends].T @ last
            for kind in ("bending", "shear")
        ])  # fmt: skip
        assert o["stress"]["bending"] == pytest.approx(np.max(np.abs(history[-1][0])), rel=1e-12)
    record = np.array(history)  # (steps, 2, ends)
    for i, kind in enumerate(("bending", "shear")):
        size = np.abs(record[:, i])
        when, where = np.unravel_index(np.argmax(size), size.shape)
        assert 0 < when < 99
        assert o["stress"][f"peak_{kind}"] == pytest.approx(size[when, where], rel=1e-12)
        assert o["stress"][f"peak_{kind}_time"] == pytest.approx((when + 1) * step, abs=1e-12)
        assert o["stress"][f"peak_{kind}_node"] == end_nodes(alone.SHAFT)[where]
        for at in range(1, alone.SHAFT.nodes + 1):
            own = np.max(size[:, end_nodes(alone.SHAFT) == at])
            assert o["node"][at - 1][f"peak_{kind}"] == pytest.approx(own, rel=1e-12)
    rows = end_nodes(alone.SHAFT) == node
    watched = np.abs(record[:, 0]) if node == 0 else np.abs(record[:, 0, rows].imag)
    kept = int(np.argmax(np.max(watched, axis=1)))
    assert o["stress"]["kept_time"] == pytest.approx((kept + 1) * step, abs=1e-12)
    for at in range(1, alone.SHAFT.nodes + 1):
        here = record[kept][:, end_nodes(alone.SHAFT) == at]
        for i, kind in enumerate(("bending", "shear")):
            for axis, values in (("x", here[i].real), ("y", here[i].imag)):
                largest = values[np.argmax(np.abs(values))]
                scale = np.max(np.abs(record[kept][i]))
                assert o["node"][at - 1][f"{kind}_{axis}"] == pytest.approx(largest, abs=1e-11 * scale)


def test_no_stresses_where_none_are_asked_for() -> None:
    """stress.active = 0."""
    rotor = Instance(alone.MODEL)
    rotor.record["p"]["stress"]["active"] = 0
    rotor.start(0.0)
    alone.give(rotor, alone.PULLED)
    alone.run(rotor, 5, 1e-4)
    assert rotor.record["o"]["stress"]["peak_bending"] == 0.0
    assert np.all(rotor.record["o"]["node"]["peak_shear"] == 0.0)
