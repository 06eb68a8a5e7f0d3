"""The flexible rotor alone: against its equations, against finite elements, against laws of motion."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from touchdown.modelkit.instance import Instance
from touchdown.modelkit.model import Model, ModelError
from touchdown.rotor.beams.assembly import assemble, solve, unit_forces
from touchdown.rotor.file import load, parse, shipped
from touchdown.rotor.flexible import flexible_rotor
from touchdown.rotor.modal.modes import basis
from touchdown.rotor.modal.stresses import end_nodes, recovery, stress_rows
from touchdown.rotor.motion.equations import energies
from touchdown.rotor.motion.state import ANGLE, LOSS, SPIN

SHAFT = load(shipped()["rotor_I"])
MODEL = flexible_rotor(SHAFT, "rotor_I")
NAMES = [s.name for s in SHAFT.stations]
NODES = [s.node for s in SHAFT.stations]
ARMS = SHAFT.positions()[[n - 1 for n in NODES]] - SHAFT.centre_of_mass
FAST = 18000.0 * math.pi / 30.0  # rad/s
G = 9.81  # m/s2


Loads = Mapping[str, Mapping[str, float]]
PULLED: Loads = {
    "A": {"fx": 300.0, "fy": -200.0, "mz": 0.05, "dfx": 4e6, "dfy": -3e6, "dmz": 200.0},
    "B": {"fx": -100.0, "fy": 400.0, "mz": -0.02, "dfx": -2e6, "dfy": 1e6, "dmz": -300.0},
    "amb_A": {"fy": 20.0},
    "amb_B": {"fy": 25.0},
}


def give(rotor: Instance, loads: Loads, factor: float = 1.0) -> None:
    """These loads and no others, all times `factor`."""
    for name, station in zip(NAMES, rotor.record["u"]["station"], strict=False):
        for field in ("fx", "fy", "mz", "dfx", "dfy", "dmz"):
            station[field] = factor * loads.get(name, {}).get(field, 0.0)


def started(loads: Loads | None = None, model: Model = MODEL, **parameters: float) -> Instance:
    """A rotor that has just started, then loaded; without loads of its own, it floats."""
    rotor = Instance(model)
    for name, value in parameters.items():
        rotor.record["p"][name] = value
    rotor.start(0.0)
    give(rotor, loads or {})
    return rotor


def run(rotor: Instance, steps: int, step: float) -> None:
    for k in range(steps):
        rotor.step(k * step, step)


def coordinates(rotor: Instance) -> tuple[np.ndarray, np.ndarray]:
    """Modal coordinates and velocities, x + i y."""
    n = int(rotor.record["d"]["modes"])
    px, py, vx, vy = np.array(rotor.record["q"][: 4 * n]).reshape(4, n)
    return px + 1j * py, vx + 1j * vy


def behind(rotor: Instance, index: int) -> float:
    """Angle, spin or loss."""
    return float(rotor.record["q"][4 * int(rotor.record["d"]["modes"]) + index])


def derivative(rotor: Instance, t: float, state: np.ndarray) -> np.ndarray:
    whole = np.zeros(len(rotor.record["q"]))
    whole[: len(state)] = state
    found = np.zeros_like(whole)
    rotor.model.rhs(t, whole, found, rotor.record)  # type: ignore[misc]
    return found[: len(state)]


def integrated(rotor: Instance, step: float) -> np.ndarray:
    """State after a macro step by an integrator that knows nothing of modes."""
    rotor.record["half"] = 0.5 * step
    state = np.array(rotor.record["q"][: int(rotor.record["n"])])
    found = solve_ivp(
        lambda t, y: derivative(rotor, t, y), (0.0, step), state, "DOP853", rtol=1e-12, atol=1e-16
    )
    return found.y[:, -1]


def deviations(step: float, micro_steps: list[float], **parameters: float) -> list[float]:
    """Largest error of a modal coordinate (m kg^0.5) after one macro step in strides of these lengths."""
    setting = {"speed": FAST, "vx": 0.1, "vy": -0.2, **parameters}
    exact = integrated(started(PULLED, **setting), step)
    found = []
    for micro_step in micro_steps:
        rotor = started(PULLED, micro_step=micro_step, **setting)
        rotor.step(0.0, step)
        count = 2 * int(rotor.record["d"]["modes"])
        found.append(float(np.max(np.abs(rotor.record["q"][:count] - exact[:count]))))
    return found


def order(micro_steps: list[float], errors: list[float]) -> float:
    return float(np.polyfit(np.log(micro_steps), np.log(errors), 1)[0])


@pytest.mark.parametrize(("unbalance", "largest"), [(0.0, 2e-10), (1.0, 2e-10), (100.0, 1e-9)])
def test_a_macro_step_solves_the_equations(unbalance: float, largest: float) -> None:
    """Linear loads and moments at both seats, 18000 rpm: 0.04 nm kg^0.5 of 36 um kg^0.5 in 0.1 ms."""
    assert deviations(1e-4, [5e-6], unbalance_scale=unbalance)[0] < largest


@pytest.mark.parametrize("unbalance", [0.0, 1.0])
def test_strides_are_of_second_order(unbalance: float) -> None:
    """Modes to 4 kHz, of which a stride of 0.1 ms is 0.4 periods of the fastest."""
    lengths = [1e-4, 2e-5, 1e-5, 5e-6]
    errors = deviations(1e-4, lengths, unbalance_scale=unbalance, residual=0)
    assert order(lengths, errors) == pytest.approx(2.0, abs=0.15)


@pytest.mark.parametrize("unbalance", [0.0, 1.0, 100.0])
def test_strides_are_of_second_order_with_residual_vectors(unbalance: float) -> None:
    """Up to 12.6 kHz, so from 20 us downwards."""
    lengths = [2e-5, 1e-5, 5e-6]
    errors = deviations(1e-4, lengths, unbalance_scale=unbalance)
    assert order(lengths, errors) == pytest.approx(2.0, abs=0.15)


# --- rigid


def test_two_modes_fall_freely() -> None:
    """A rigid rotor that turns, without unbalance: every station falls alike."""
    rotor = started(modes=2, residual=0, unbalance_scale=0.0, y=1e-4, vx=0.3)
    run(rotor, 50, 1e-4)
    for o in rotor.record["o"]["station"][: len(NAMES)]:
        assert o["y"] == pytest.approx(1e-4 - 0.5 * G * 5e-3**2, rel=1e-11)
        assert o["vy"] == pytest.approx(-G * 5e-3, rel=1e-11)
        assert o["x"] == pytest.approx(0.3 * 5e-3, rel=1e-11)
        assert o["ay_free"] == pytest.approx(-G, rel=1e-11)


def test_a_tilting_rigid_rotor_precesses() -> None:
    """Tilt rate w turns at Ip/Id Omega: slope = w0 (exp(i k t) - 1) / (i k), seats move by their arms."""
    rotor = started(modes=2, residual=0, unbalance_scale=0.0, gravity=0.0, speed=FAST)
    rate, span, steps = 20.0, 1e-2, 100
    rotor.record["q"][2 * 2 + 1] = rate * math.sqrt(SHAFT.diametral_inertia)
    run(rotor, steps, span / steps)
    turn = SHAFT.polar_inertia / SHAFT.diametral_inertia * FAST
    assert turn * span > 1.0
    slope = rate * (np.exp(1j * turn * span) - 1.0) / (1j * turn)
    slope_rate = rate * np.exp(1j * turn * span)
    for arm, o in zip(ARMS, rotor.record["o"]["station"], strict=False):
        assert abs(complex(o["x"], o["y"]) - arm * slope) < 1e-7 * abs(arm * slope)
        assert abs(complex(o["vx"], o["vy"]) - arm * slope_rate) < 1e-10 * abs(arm * slope_rate)


def test_a_force_off_the_centre_moves_and_tilts_a_rigid_rotor() -> None:
    """At rest, F at arm a accelerates arm b by F (1/m + a b / Id)."""
    force, span = 50.0, 1e-3
    rotor = started({"A": {"fx": force}}, modes=2, residual=0, unbalance_scale=0.0, gravity=0.0, speed=0.0)
    run(rotor, 10, span / 10)
    for arm, o in zip(ARMS, rotor.record["o"]["station"], strict=False):
        answer = 1.0 / SHAFT.mass + ARMS[0] * arm / SHAFT.diametral_inertia
        assert o["vx"] == pytest.approx(force * span * answer, rel=1e-10)
        assert o["x"] == pytest.approx(0.5 * force * span**2 * answer, rel=1e-10)
        assert o["vy"] == 0.0
        own = 1.0 / SHAFT.mass + arm**2 / SHAFT.diametral_inertia
        assert o["inv_m"] == pytest.approx(own, rel=1e-12)


# --- laws


def test_a_turned_frame_turns_the_answer() -> None:
    """Loads, start and unbalance turned by 90 degrees: x becomes y, y becomes -x."""
    upright = started(
        PULLED, gravity=0.0, speed=FAST, unbalance_scale=100.0, x=1e-5, y=2e-5, vx=0.1, vy=-0.2
    )
    turned_loads = {
        name: {**f, "fx": -f.get("fy", 0.0), "fy": f.get("fx", 0.0), "dfx": -f.get("dfy", 0.0),
               "dfy": f.get("dfx", 0.0)}
        for name, f in PULLED.items()
    }  # fmt: skip
    turned = started(
        turned_loads, gravity=0.0, speed=FAST, unbalance_scale=100.0, unbalance_angle=0.5 * math.pi,
        x=-2e-5, y=1e-5, vx=0.2, vy=0.1,
    )  # fmt: skip
    run(upright, 20, 1e-4)
    run(turned, 20, 1e-4)
    for one, other in zip(coordinates(upright), coordinates(turned), strict=True):
        assert np.max(np.abs(other - 1j * one)) < 1e-9 * np.max(np.abs(one))
    assert behind(turned, SPIN) == pytest.approx(behind(upright, SPIN), rel=1e-12)
    assert behind(turned, LOSS) == pytest.approx(behind(upright, LOSS), rel=1e-9)


@pytest.mark.parametrize(
    ("unbalance", "largest"),
    [(0.0, 1e-11), (1.0, 3e-7), (100.0, 3e-5)],
)
def test_momentum_is_the_impulse(unbalance: float, largest: float) -> None:
    """m v + d/dt (U exp(i theta)) changes by the impulse of forces and weight, whatever bends."""
    rotor = started(PULLED, speed=FAST, unbalance_scale=unbalance, vx=0.1)
    moment = unbalance * SHAFT.unbalances[0].moment
    assert len(SHAFT.unbalances) == 1

    def momentum() -> complex:
        spin = 1j * behind(rotor, SPIN) * np.exp(1j * behind(rotor, ANGLE))
        return complex(math.sqrt(SHAFT.mass) * coordinates(rotor)[1][0] + moment * spin)

    before, span = momentum(), 2e-3
    run(rotor, 20, span / 20)
    forces = sum(complex(f.get("fx", 0.0), f.get("fy", 0.0)) for f in PULLED.values())
    impulse = (forces - 1j * SHAFT.mass * G) * span
    assert abs(momentum() - before - impulse) < largest * abs(impulse)


def test_the_spin_changes_by_the_impulse_of_the_moments() -> None:
    """Without unbalance; a moment's slope has no impulse."""
    rotor = started(PULLED, speed=FAST, unbalance_scale=0.0)
    run(rotor, 20, 1e-4)
    change = 0.03 * 2e-3 / SHAFT.polar_inertia
    assert behind(rotor, SPIN) - FAST == pytest.approx(change, rel=1e-9)
    assert rotor.record["o"]["station"][0]["omega"] == behind(rotor, SPIN)


# --- energy


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
    rotor = started(speed=FAST, vx=0.1, vy=-0.2, **parameters)
    if not gyroscopic:
        rotor.record["d"]["gyroscopic"]["polar"] = 0.0
        rotor.record["d"]["gyroscopic"]["principal"] = 0.0
    before, crossed, step = total(rotor), 0.0, 2e-5
    for k in range(100):
        give(rotor, PULLED, math.cos(2e3 * k * step))
        for station in rotor.record["u"]["station"][: len(NAMES)]:
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


@pytest.mark.parametrize(("mode_loads", "modes"), [(False, 5), (True, 5), (False, 0)])
def test_no_energy_is_lost(mode_loads: bool, modes: int) -> None:
    """With gyroscopics, which only turn the velocities: to rounding, however fast the modes are."""
    lost, work = ledger(mode_loads=mode_loads, modes=modes, unbalance_scale=0.0)
    assert abs(lost) < 1e-11 * work


def test_heat_and_work_are_those_of_the_equations() -> None:
    """Both follow from balances, so against int c v^2 dt and int F v dt, with drag; second order."""
    setting = {"speed": FAST, "vx": 0.1, "vy": -0.2, "damping_ratio": 0.05, "drag": 0.5}
    exact = integrated(started(PULLED, **setting), 1e-4)
    lengths, errors = [2e-5, 1e-5, 5e-6], []
    for length in lengths:
        rotor = started(PULLED, micro_step=length, **setting)
        rotor.step(0.0, 1e-4)
        first = 4 * int(rotor.record["d"]["modes"]) + LOSS
        found = rotor.record["q"][first : len(exact)]
        assert len(found) == 1 + len(NAMES)
        assert np.min(np.abs(exact[first:])) > 1e-5
        errors.append(np.max(np.abs(found / exact[first:] - 1.0)))
    assert errors[-1] < 1e-5
    assert order(lengths, errors) == pytest.approx(2.0, abs=0.15)


def test_drag_turns_energy_of_the_spin_into_heat() -> None:
    """All of it, though the torque changes within every stride."""
    rotor = started(gravity=0.0, unbalance_scale=0.0, drag=0.5, viscous_drag=1e-3, speed=FAST)
    before = total(rotor)
    run(rotor, 20, 1e-4)
    assert rotor.record["o"]["energy"]["dissipated"] > 1.0
    assert total(rotor) == pytest.approx(before, rel=1e-13)


@pytest.mark.parametrize(
    ("mode_loads", "unbalance", "largest"),
    [
        (False, 1.0, 1e-8),
        (False, 100.0, 1e-6),
        (True, 1.0, 1e-8),
        (True, 100.0, 1e-6),
    ],
)
def test_unbalance_makes_no_energy(mode_loads: bool, unbalance: float, largest: float) -> None:
    """Without gyroscopics, whose i alpha G p does work that linear theory accounts for nowhere."""
    found = extrapolated(mode_loads=mode_loads, unbalance_scale=unbalance, gyroscopic=False)
    assert found < largest


@pytest.mark.parametrize(("unbalance", "largest"), [(1.0, 2e-7), (100.0, 6e-6)])
def test_unbalance_makes_little_energy(unbalance: float, largest: float) -> None:
    """At the default stride, gyroscopics included."""
    lost, work = ledger(unbalance_scale=unbalance)
    assert abs(lost) < largest * work


def test_the_equations_keep_the_energy() -> None:
    """The derivative itself, a hundred times the unbalance and moments; i alpha G p, aside."""
    rotor = started(PULLED, speed=FAST, unbalance_scale=100.0, vx=0.1, vy=-0.2)
    rotor.record["d"]["gyroscopic"]["polar"] = 0.0
    before, end = total(rotor), integrated(rotor, 1e-3)
    rotor.record["q"][: len(end)] = end
    works = end[4 * int(rotor.record["d"]["modes"]) + 3 :]
    after = sum(energies(rotor.record["q"], rotor.record)) + behind(rotor, LOSS) - np.sum(works)
    assert abs(after - before) < 1e-8 * np.sum(np.abs(works))


@pytest.mark.parametrize("micro_step", [5e-6, 1e-3])
def test_a_moment_with_a_slope_does_the_work_that_spins_it_up(micro_step: float) -> None:
    """Nothing else acts, so the work is the gain of I Omega^2 / 2; in one stride and in many."""
    rotor = started(
        {"A": {"mz": 5.0, "dmz": 1e5}}, gravity=0.0, unbalance_scale=0.0, speed=FAST, micro_step=micro_step
    )
    before = behind(rotor, SPIN)
    rotor.step(0.0, 1e-3)
    gain = 0.5 * SHAFT.polar_inertia * (behind(rotor, SPIN) ** 2 - before**2)
    assert gain > 1.0
    assert rotor.record["o"]["station"][0]["work"] == pytest.approx(gain, rel=1e-10)


def test_a_mode_load_moves_the_mode_it_is_for() -> None:
    """The share of that mode in the seat moves by inv_m q and gains inv_m p; no other does."""
    plain, loaded = started(speed=FAST), started(speed=FAST)
    load = loaded.record["u"]["station"][0]["mode"][1]
    load["qx"], load["qy"], load["px"], load["py"] = 1e-7, -2e-7, 1e-3, 2e-3
    for rotor in (plain, loaded):
        rotor.step(0.0, 1e-4)
    one, other = plain.record["o"]["station"][0], loaded.record["o"]["station"][0]
    for k in range(5):
        gain = float(one["mode"][k]["inv_m"]) if k == 1 else 0.0
        for field, given in (("x", 1e-7), ("y", -2e-7), ("vx", 1e-3), ("vy", 2e-3)):
            moved = other["mode"][k][field] - one["mode"][k][field]
            assert moved == pytest.approx(gain * given, rel=1e-9, abs=1e-18)
    assert one["mode"][1]["inv_m"] > 0.01


def test_a_mode_load_leaves_the_angular_momentum() -> None:
    """It moves the unbalance, which takes from the spin; its work is all the energy that it brings."""
    heavy = {"speed": FAST, "gravity": 0.0, "unbalance_scale": 100.0}
    plain, loaded = started(**heavy), started(**heavy)
    loaded.record["u"]["station"][1]["mode"][0]["py"] = 0.1
    for rotor in (plain, loaded):
        rotor.step(0.0, 4e-5)
    d, kick = plain.record["d"], coordinates(loaded)[1] - coordinates(plain)[1]
    moment = 100.0 * (d["unbalance"]["x"] + 1j * d["unbalance"]["y"])[: len(kick)]
    given = np.sum(np.real(kick * np.conj(1j * moment * np.exp(1j * behind(plain, ANGLE)))))
    change = behind(loaded, SPIN) - behind(plain, SPIN)
    assert abs(change) > 1e-4
    assert SHAFT.polar_inertia * change == pytest.approx(-given, rel=1e-9)
    gain = sum(energies(loaded.record["q"], loaded.record)) - sum(energies(plain.record["q"], plain.record))
    work = loaded.record["o"]["station"][1]["work"] - plain.record["o"]["station"][1]["work"]
    assert gain == pytest.approx(float(work), rel=1e-9)


# --- start


def test_gravity_pulls_the_translation_only() -> None:
    """And translation turns no section: exactly, so that no rounding error is told of as a cause."""
    rotor = started(modes=20)
    d = rotor.record["d"]
    assert np.flatnonzero(d["weight"]).tolist() == [0]
    assert d["weight"][0] == pytest.approx(math.sqrt(SHAFT.mass), rel=1e-15)
    assert not d["gyroscopic"]["polar"][0].any()
    assert not d["gyroscopic"]["polar"][:, 0].any()
    assert np.count_nonzero(d["gyroscopic"]["polar"]) > 100


def test_a_rotor_that_nothing_holds_falls_straight_and_unbent() -> None:
    """All modes of a stub that spins, and has no unbalance."""
    rotor = started(model=flexible_rotor(parse(STUB, "stub.toml"), "stub"), modes=0, speed=FAST)
    run(rotor, 50, 1e-4)
    for o in (*rotor.record["o"]["station"][:2], rotor.record["o"]["sensor"][0]):
        assert o["y"] == pytest.approx(-0.5 * G * 5e-3**2, rel=1e-12)
        assert o["x"] == 0.0
    assert not coordinates(rotor)[0][1:].any()


def test_it_starts_at_rest_in_its_magnetic_bearings() -> None:
    """They carry the weight without a moment, bent as the rotor is; nothing accelerates anywhere."""
    rotor = Instance(MODEL)
    rotor.record["p"]["unbalance_scale"] = 0.0
    rotor.start(0.0)
    static = np.array(rotor.record["o"]["station"]["static_fy"][: len(NAMES)])
    assert static[[NAMES.index("A"), NAMES.index("B")]] == pytest.approx(0.0, abs=0.0)
    assert np.sum(static) == pytest.approx(SHAFT.mass * G, rel=1e-12)
    assert static @ ARMS == pytest.approx(0.0, abs=1e-12 * SHAFT.mass * G)
    rotor.record["u"]["station"]["fy"][: len(NAMES)] = static
    rotor.start(0.0)
    sag = np.array(rotor.record["o"]["station"]["y"])
    assert np.max(np.abs(sag)) > 1e-8
    for own, o in zip(static, rotor.record["o"]["station"], strict=False):
        assert abs(o["ay_free"] + o["inv_m"] * own) < 1e-9 * G
        assert o["ax_free"] == 0.0
    run(rotor, 20, 1e-4)
    assert np.max(np.abs(rotor.record["o"]["station"]["y"] - sag)) < 1e-14


# --- finite elements

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
    stub = parse(STUB, "stub.toml")
    model = flexible_rotor(stub, "stub")
    force, span = 200.0 - 50.0j, 1e-3
    rotor = Instance(model)
    p = rotor.record["p"]
    p["modes"], p["damping_ratio"], p["speed"], p["gravity"], p["micro_step"] = 0, 0.0, 4e3, 0.0, 1e-6
    rotor.start(0.0)
    load_a = rotor.record["u"]["station"][0]
    load_a["fx"], load_a["fy"] = force.real, force.imag
    run(rotor, 10, span / 10)
    matrices = assemble(stub)
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


# --- stresses

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
    rotor.start(0.0)
    d, o = rotor.record["d"], rotor.record["o"]
    stress = d["stress"]
    n, ends = int(d["modes"]), int(stress["ends"])
    step, history = 2e-5, []
    assert np.array_equal(end_nodes(SHAFT), stress["node"][:ends])
    for k in range(100):
        give(rotor, PULLED if k < 20 else {}, math.sin(math.pi * k / 20.0))
        rotor.step(k * step, step)
        u = rotor.record["u"]["station"]
        force = np.array([u["fx"] + 1j * u["fy"], u["dfx"] + 1j * u["dfy"]])[:, : len(NAMES)]
        last = force[0] + 0.5 * step * force[1]
        p = coordinates(rotor)[0]
        history.append([
            stress[kind][:ends, :n] @ p + stress[f"{kind}_load"][:ends, : len(NAMES)] @ last
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


def test_no_stresses_where_none_are_asked_for() -> None:
    """stress.active = 0."""
    rotor = Instance(MODEL)
    rotor.record["p"]["stress"]["active"] = 0
    rotor.start(0.0)
    give(rotor, PULLED)
    run(rotor, 5, 1e-4)
    assert rotor.record["o"]["stress"]["peak_bending"] == 0.0
    assert np.all(rotor.record["o"]["node"]["peak_shear"] == 0.0)


# --- as it was, and mistakes


def test_a_restored_rotor_goes_the_same_way() -> None:
    """Bit for bit, peaks of stresses included."""
    rotor = started(PULLED, unbalance_scale=100.0, speed=FAST)
    run(rotor, 5, 1e-4)
    kept = rotor.save()
    run(rotor, 5, 1e-4)
    after = rotor.save()
    rotor.restore(kept)
    assert rotor.save() == kept != after
    run(rotor, 5, 1e-4)
    assert rotor.save() == after


@pytest.mark.parametrize(
    ("name", "value", "says"),
    [
        ("modes", 1, f"modes = 1 must be from 2 (rigid) to {2 * SHAFT.nodes}"),
        ("modes", 2 * SHAFT.nodes + 1, f"modes = {2 * SHAFT.nodes + 1} must be"),
        ("stress.node", SHAFT.nodes + 1, f"stress.node = {SHAFT.nodes + 1}: "),
    ],
)
def test_what_the_shaft_does_not_have_is_refused(name: str, value: int, says: str) -> None:
    """One line with the name, the value and the remedy."""
    rotor = Instance(MODEL)
    *groups, field = name.split(".")
    place = rotor.record["p"]
    for group in groups:
        place = place[group]
    place[field] = value
    with pytest.raises(ModelError) as error:
        rotor.start(0.0)
    assert says in str(error.value)
    assert str(2 * SHAFT.nodes if field == "modes" else SHAFT.nodes) in str(error.value)
    assert "\n" not in str(error.value)
