"""The stresses that a flexible rotor tells: those of finite elements, their peaks, one instant."""

from __future__ import annotations

import math

import numpy as np
import pytest
from rotor_alone import (
    ARMS,
    MODEL,
    NAMES,
    NODES,
    PULLED,
    SHAFT,
    coordinates,
    give,
    run,
)

from touchdown.modelkit.instance import Instance
from touchdown.rotor.beams.shaft import assemble, solve, unit_forces
from touchdown.rotor.modal.modes import basis
from touchdown.rotor.modal.stresses import end_nodes, recovery, stress_rows

BALANCED = np.array([300.0, -120.0])  # N at the seats; the magnetic bearings balance them


def balanced() -> np.ndarray:
    """Forces at all stations whose sum and moment vanish."""
    seats, others = [NAMES.index("A"), NAMES.index("B")], [NAMES.index("amb_A"), NAMES.index("amb_B")]
    balance = np.vstack((np.ones(len(ARMS)), ARMS))
    forces = np.zeros(len(NAMES))
    forces[seats] = BALANCED
    forces[others] = np.linalg.solve(balance[:, others], -balance[:, seats] @ BALANCED)
    return forces


def full_stresses(forces: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Bending and shear at the elements' ends by all finite elements, held at node 1."""
    load = unit_forces(SHAFT, NODES) @ forces
    q = np.zeros_like(load)
    q[2:] = solve(assemble(SHAFT).stiffness[2:, 2:], load[2:])
    bending, shear = stress_rows(SHAFT)
    return bending @ q, shear @ q


def test_mode_acceleration_recovers_static_stresses() -> None:
    """Three bending modes at rest under balanced forces: exact with the loads' share, wrong without."""
    few, forces = basis(SHAFT, 5), balanced()
    found = recovery(SHAFT, few, NODES)
    p = np.zeros(5)
    p[2:] = (few.deflections(NODES).T @ forces)[2:] / few.omega[2:] ** 2
    bending, shear = full_stresses(forces)
    for full, by_modes, by_loads in (
        (bending, found.bending @ p, found.bending_load @ forces),
        (shear, found.shear @ p, found.shear_load @ forces),
    ):
        scale = np.max(np.abs(full))
        assert by_modes + by_loads == pytest.approx(full, abs=1e-7 * scale)
        assert np.max(np.abs(by_modes - full)) > 0.05 * scale


@pytest.mark.parametrize(("modes", "residual"), [(3, 0), (5, 0), (5, 1)])
def test_a_rotor_at_rest_under_load_tells_the_stresses_of_finite_elements(
    modes: int, residual: int
) -> None:
    """Damped to rest under balanced forces in x and, times -0.5, in y."""
    forces = balanced()
    loads = {name: {"fx": f, "fy": -0.5 * f} for name, f in zip(NAMES, forces, strict=True)}
    bending, shear = full_stresses(forces)
    resultant = math.hypot(1.0, 0.5)
    told = []
    for acceleration in (1, 0):
        rotor = Instance(MODEL)
        p = rotor.record["p"]
        p["modes"], p["residual"], p["damping_ratio"], p["gravity"] = modes, residual, 1.0, 0.0
        p["speed"], p["unbalance_scale"], p["stress"]["mode_acceleration"] = 0.0, 0.0, acceleration
        rotor.start(0.0)
        give(rotor, loads)
        run(rotor, 50, 1e-4)
        o = rotor.record["o"]["stress"]
        told.append((float(o["bending"]), float(o["shear"])))
    assert told[0][0] == pytest.approx(resultant * np.max(np.abs(bending)), rel=1e-6)
    assert told[0][1] == pytest.approx(resultant * np.max(np.abs(shear)), rel=1e-6)
    assert told[1][1] != pytest.approx(told[0][1], rel=0.02)


@pytest.mark.parametrize("node", [0, 8])
def test_peaks_are_held_and_one_instant_is_kept(node: int) -> None:
    """A pulse and what rings after it: peaks with place and time; stresses when `stress.node` had its."""
    rotor = Instance(MODEL)
    rotor.record["p"]["stress"]["node"] = node
    rotor.record["p"]["residual"] = 0  # so that loads at the seats have stresses of their own
    rotor.record["p"]["micro_step"] = step = 2e-5  # one look a macro step, at its end
    rotor.start(0.0)
    d, o = rotor.record["d"], rotor.record["o"]
    stress = d["stress"]
    n, ends, history = int(d["modes"]), int(stress["ends"]), []
    assert np.array_equal(end_nodes(SHAFT), stress["node"][:ends])
    for k in range(100):
        give(rotor, PULLED if k < 20 else {}, math.sin(math.pi * k / 20.0))
        rotor.step(k * step, step)
        u = rotor.record["u"]["station"]
        force = np.array([u["fx"] + 1j * u["fy"], u["dfx"] + 1j * u["dfy"]])[:, : len(NAMES)]
        last = force[0] + 0.5 * step * force[1]
        p = coordinates(rotor)[0]
        history.append([
            stress[kind][:n, :ends].T @ p + stress[f"{kind}_load"][: len(NAMES), :ends].T @ last
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
        assert o["stress"][f"peak_{kind}_node"] == end_nodes(SHAFT)[where]
        for at in range(1, SHAFT.nodes + 1):
            own = np.max(size[:, end_nodes(SHAFT) == at])
            assert o["node"][at - 1][f"peak_{kind}"] == pytest.approx(own, rel=1e-12)
    rows = end_nodes(SHAFT) == node
    watched = np.abs(record[:, 0]) if node == 0 else np.abs(record[:, 0, rows].imag)
    kept = int(np.argmax(np.max(watched, axis=1)))
    assert o["stress"]["kept_time"] == pytest.approx((kept + 1) * step, abs=1e-12)
    for at in range(1, SHAFT.nodes + 1):
        here = record[kept][:, end_nodes(SHAFT) == at]
        for i, kind in enumerate(("bending", "shear")):
            for axis, values in (("x", here[i].real), ("y", here[i].imag)):
                largest = values[np.argmax(np.abs(values))]
                scale = np.max(np.abs(record[kept][i]))
                assert o["node"][at - 1][f"{kind}_{axis}"] == pytest.approx(largest, abs=1e-11 * scale)


def test_peaks_within_a_macro_step_are_seen() -> None:
    """A pulse of 0.4 ms in macro steps of 40 and of 5 us: the same strides, the same peaks and instants."""
    told, stresses = [], []
    for step in (4e-5, 5e-6):
        rotor = Instance(MODEL)
        rotor.start(0.0)
        largest = 0.0
        for k in range(round(1.2e-3 / step)):
            give(rotor, PULLED if k * step < 4e-4 - 1e-9 else {})
            for u in rotor.record["u"]["station"]:  # no slope: the same load in steps of any length
                u["dfx"] = u["dfy"] = u["dmz"] = 0.0
            rotor.step(k * step, step)
            largest = max(largest, float(rotor.record["o"]["stress"]["shear"]))
        o, nodes = rotor.record["o"]["stress"], rotor.record["o"]["node"][: SHAFT.nodes]
        if step > 1e-5:  # the ends of its macro steps miss the peak
            assert largest < 0.995 * o["peak_shear"]
        told.append(o.copy())
        kinds = ("peak_bending", "peak_shear", "bending_y")
        stresses.append(np.concatenate([nodes[name] for name in kinds]))
    long, short = told
    for kind in ("bending", "shear"):
        assert long[f"peak_{kind}"] == pytest.approx(short[f"peak_{kind}"], rel=1e-4)
        assert long[f"peak_{kind}_time"] == pytest.approx(short[f"peak_{kind}_time"], abs=1e-9)
        assert long[f"peak_{kind}_node"] == short[f"peak_{kind}_node"]
    assert long["kept_time"] == pytest.approx(short["kept_time"], abs=1e-9)
    assert stresses[0] == pytest.approx(stresses[1], abs=1e-4 * np.max(stresses[1]))


def test_no_stresses_where_none_are_asked_for() -> None:
    """stress.active = 0."""
    rotor = Instance(MODEL)
    rotor.record["p"]["stress"]["active"] = 0
    rotor.start(0.0)
    give(rotor, PULLED)
    run(rotor, 5, 1e-4)
    assert rotor.record["o"]["stress"]["peak_bending"] == 0.0
    assert np.all(rotor.record["o"]["node"]["peak_shear"] == 0.0)
