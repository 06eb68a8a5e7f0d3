"""What the bearings do with a rotor's elastic modes: accuracy, what crosses, what is left out."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from systems import AT, DISK, GRAVITY, dropped, history

from touchdown.bearings import bushing, seat
from touchdown.master.coupling.simulation import open_system
from touchdown.master.scene.run_spec import RunSpec
from touchdown.master.scene.scene import ComponentSpec, Scene
from touchdown.modelkit import numerics
from touchdown.modelkit.instance import Instance
from touchdown.studies.drop.monolithic import Monolith

JOURNALS = ["rotor.A.x", "rotor.A.y", "rotor.B.x", "rotor.B.y"]
PEAKS = [f"bearing_{end}.contact.peak_force" for end in "AB"]


def reference(scene: Scene) -> np.ndarray:
    """Both journals (m) at the end, all components solved as one system of equations."""
    solution = Monolith(scene).solve(np.linspace(AT / 9.0, AT, 9), JOURNALS, 1e-9, "DOP853")
    return np.array([solution.series[name][-1] for name in JOURNALS])


def test_one_contact_is_followed_at_large_macro_steps() -> None:
    """The other end moves on its own: what the modes know of this contact is all there is to know."""
    scene = dropped().set({"bearing_B.clearance": 2e-3})
    exact = reference(scene)
    for step, limit in ((4e-5, 0.02), (1e-4, 0.04)):
        _, found, _ = history(scene.set({"run.macro_step": step}), [*JOURNALS, *PEAKS])
        off = np.array([found[name][-1] for name in JOURNALS]) - exact
        assert [found[name][-1] > 500.0 for name in PEAKS] == [True, False]
        assert 1e6 * np.max(np.hypot(*off.reshape(2, 2).T)) < limit  # um


def test_more_modes_than_a_seat_tells_of() -> None:
    """All of the finite elements': what is beyond the last place is lumped in it, and the sums hold."""
    scene = dropped(0)
    system = open_system(scene, in_process=True)
    system.initialise()
    rotor = system.components["rotor"].instance.record  # type: ignore[attr-defined]
    a, n = rotor["o"]["station"][0], int(rotor["d"]["modes"])
    assert rotor["d"]["lumped"][0] == 1.0
    gain, stiffness = rotor["d"]["shape"][0, :n] ** 2, rotor["d"]["stiffness"][2:n]
    assert np.sum(a["mode"]["inv_m"]) == pytest.approx(a["inv_m"] - np.sum(gain[:2]))
    flexibility = np.sum(a["mode"]["inv_m"] / a["mode"]["k_over_m"])
    assert flexibility == pytest.approx(np.sum(gain[2:] / stiffness), rel=1e-8)


def landing(modes: int) -> Scene:
    """Rotor I, turning and a micrometre above a bushing at its end A; 2 ms, with the impact."""
    start = {"modes": modes, "speed": "9000 rpm", "y": "-0.299 mm", "vy": -0.05}
    return Scene(
        "test", "test", {"rotor": ComponentSpec("rotor_I", start), "bearing": ComponentSpec("bushing")},
        attach=(("bearing.journal", "rotor.A"),), run=RunSpec(duration=2e-3, macro_step=4e-5),
    )  # fmt: skip


@pytest.fixture(scope="module")
def few_modes() -> dict[str, float]:
    """Where the journal ends with five modes."""
    return {name: values[-1] for name, values in history(landing(5), JOURNALS[:2])[1].items()}


@pytest.mark.parametrize("modes", [20, 0])
def test_fast_modes_make_no_energy_in_contact(modes: int, few_modes: dict[str, float]) -> None:
    """Of rotor and bearing together, over what the contact turns into heat; and they hardly matter."""
    energies = [
        f"{c}.energy.{kind}"
        for c in ("rotor", "bearing")
        for kind in ("kinetic", "potential", "dissipated")
    ]
    names = [*energies, *JOURNALS[:2], "bearing.contact.peak_force"]
    _, found, outcome = history(landing(modes), names)
    assert found["bearing.contact.peak_force"][-1] > 100.0
    whole, lost = sum(found[name] for name in energies), found["bearing.energy.dissipated"][-1]
    assert lost > 1e-4
    assert np.max(np.abs(whole - whole[0])) < 1e-6 * lost
    assert outcome.residual < 1e-6 * lost
    assert np.hypot(*(found[name][-1] - few_modes[name] for name in JOURNALS[:2])) < 1e-8


STEP = 1e-4  # s
REST = 1.0 / DISK  # 1/kg, of the point mass
MODES = ((0.4, 1e4, 0.01), (0.3, 6e4, 0.02))  # inv_m, angular frequency, damping ratio
START = ((2e-6, -3e-6, 0.02, -0.01), (-1e-6, 1e-6, 0.03, 0.05))  # x, y, vx, vy of each
JOURNAL = (1e-5, -0.309e-3, 0.02, -0.15)  # all together
SPIN, SPIN_UP = 900.0, 2000.0


def in_contact(order: int = 3, modes: tuple[tuple[float, float, float], ...] = MODES) -> Instance:
    """A bushing with a journal of a point mass and two modes, pressed 9 um into it and moving on."""
    instance = Instance(bushing.MODEL)
    instance.record["p"]["interface"]["order"] = order
    instance.record["p"]["interface"]["tolerance"] = 1e-10
    j = instance.record["u"]["journal"]
    j["x"], j["y"], j["vx"], j["vy"] = JOURNAL
    j["inv_m"], j["omega"], j["inv_I"] = REST, SPIN, SPIN_UP
    j["ay_free"] = -GRAVITY
    for z, (inv_m, w, ratio), (x, y, vx, vy) in zip(j["mode"], modes, START, strict=False):
        k, c = w * w, 2.0 * ratio * w
        z["x"], z["y"], z["vx"], z["vy"] = x, y, vx, vy
        z["inv_m"], z["k_over_m"], z["c_over_m"] = inv_m, k, c
        z["ax_free"], z["ay_free"] = -k * x - c * vx, -k * y - c * vy
        j["inv_m"] += inv_m
        j["ax_free"] += z["ax_free"]
        j["ay_free"] += z["ay_free"]
    instance.start(0.0)
    return instance


def all_as_one() -> np.ndarray:
    """Point mass and modes after the step, rows of (x, y, vx, vy), by scipy under the bushing's force."""
    force = Instance(bushing.MODEL)
    force.start(0.0)
    inside, rates = np.zeros_like(force.record["q"]), np.zeros_like(force.record["q"])

    def rate(_: float, state: np.ndarray) -> np.ndarray:
        bodies, out = state[:-1].reshape(3, 4), np.zeros(13)
        u, given = force.record["u"]["journal"], force.record["o"]["journal"]
        u["x"], u["y"], u["vx"], u["vy"] = bodies.sum(axis=0)
        u["omega"] = state[-1]
        bushing.MODEL.instant(0.0, inside, rates, force.words)  # type: ignore[misc]
        found = out[:-1].reshape(3, 4)
        pull = np.array([given["fx"], given["fy"]])
        found[:, :2] = bodies[:, 2:]
        found[0, 2:] = REST * pull + np.array([0.0, -GRAVITY])
        for row, body, (inv_m, w, ratio) in zip(found[1:], bodies[1:], MODES, strict=True):
            row[2:] = inv_m * pull - w * w * body[:2] - 2.0 * ratio * w * body[2:]
        out[-1] = SPIN_UP * given["mz"]
        return out

    modes = np.array(START)
    start = np.append(np.vstack((np.array(JOURNAL) - modes.sum(axis=0), modes)).ravel(), SPIN)
    solution = solve_ivp(rate, (0.0, STEP), start, "DOP853", rtol=1e-12, atol=1e-16, max_step=1e-6)
    return solution.y[:-1, -1].reshape(3, 4)


def test_modes_end_the_macro_step_where_the_force_as_it_was_takes_them() -> None:
    """Mean, slope and what is handed over beside them; without the latter the faster mode is off."""
    instance = in_contact()
    instance.step(0.0, STEP)
    exact = all_as_one()
    load, copy = instance.record["o"]["journal"], instance.record["q"]
    assert load["fy"] > 100.0
    end = copy[[seat.JX, seat.JY, seat.JVX, seat.JVY]]
    np.testing.assert_allclose(end[:2], exact.sum(axis=0)[:2], rtol=0.0, atol=1e-14)
    np.testing.assert_allclose(end[2:], exact.sum(axis=0)[2:], rtol=0.0, atol=1e-10)
    for n, (inv_m, w, ratio) in enumerate(MODES):
        handed = load["mode"][n]
        found = numerics.oscillator_step(w * w, 2.0 * ratio * w, STEP)
        for i, axis in enumerate("xy"):
            z, v = START[n][i], START[n][i + 2]
            mean, slope = inv_m * load[f"f{axis}"], inv_m * load[f"df{axis}"]
            moved = found.zz * z + found.zv * v + found.zf * mean + found.zg * slope
            speed = found.vz * z + found.vv * v + found.vf * mean + found.vg * slope
            assert moved + inv_m * handed[f"q{axis}"] == pytest.approx(exact[n + 1, i], abs=1e-15)
            assert speed + inv_m * handed[f"p{axis}"] == pytest.approx(exact[n + 1, i + 2], abs=1e-10)
            if n == 1 and axis == "y":
                assert abs(moved - exact[n + 1, i]) > 1e-10
                assert abs(speed - exact[n + 1, i + 2]) > 1e-5


@pytest.mark.parametrize("order", [0, 1, 2])
def test_modes_are_carried_by_the_interface_model_only(order: int) -> None:
    instance = in_contact(order)
    plain = in_contact(order, ())
    instance.step(0.0, STEP)
    assert instance.record["s"]["seat"]["modes"] == 0
    assert instance.record["n"] == plain.record["n"]
    handed = instance.record["o"]["journal"]["mode"]
    assert all(not handed[name].any() for name in ("qx", "qy", "px", "py"))
