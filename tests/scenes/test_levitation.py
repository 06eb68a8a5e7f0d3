"""Flexible rotors in their magnetic bearings: stable with any number of modes, and let go as told."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.linalg import expm
from systems import GRAVITY, history

from touchdown.master.common.units import to_si
from touchdown.master.coupling.simulation import opened
from touchdown.master.scene.file import load_scene
from touchdown.master.scene.scene import Scene
from touchdown.rotor.beams.shaft import Shaft
from touchdown.rotor.file import load_rotor, shipped_rotors
from touchdown.rotor.modal.data import tabulate

SCENES = {"rotor1-9000": "rotor_I", "rotor2-case1": "rotor_II"}
ENDS = "AB"
UP_TO = 30e-3  # s, of levitation
JOURNALS = ["rotor.A.x", "rotor.A.y", "rotor.B.x", "rotor.B.y"]


@pytest.fixture(params=sorted(SCENES), scope="module")
def name(request: pytest.FixtureRequest) -> str:
    """A scene of each shipped rotor."""
    return request.param


def shaft(name: str) -> Shaft:
    return load_rotor(shipped_rotors()[SCENES[name]])


def full_speed(name: str) -> float:
    """rad/s, as the scene says."""
    return to_si(load_scene(name).components["rotor"].set["speed"], "rad/s", "rotor.speed")


def closed_loop(name: str, modes: int, residual: int, speed: float) -> np.ndarray:
    """Rate of change of (p, p', force at A, force at B), p = p_x + i p_y the modal coordinates.

    The equations of `rotor.motion.equations` with the law of `bearings.magnetic.amb`, about the rotor
    at rest.
    """
    rotor, scene = shaft(name), load_scene(name)
    d = tabulate(rotor, modes, residual)
    n = d.modes
    p, v = slice(0, n), slice(n, 2 * n)
    a = np.zeros((2 * n + len(ENDS),) * 2, complex)
    a[p, v] = np.eye(n)
    a[v, p] = -np.diag(d.stiffness[:n])
    damping = 2.0 * rotor.damping_ratio * np.sqrt(d.stiffness[:n])
    a[v, v] = 1j * speed * d.gyroscopic.polar[:n, :n] - np.diag(damping)
    for i, end in enumerate(ENDS, 2 * n):
        control = scene.components[f"amb_{end}"].set
        assert control["sensed"] == 1
        actuator = d.shape[[s.name for s in rotor.stations].index(f"amb_{end}"), :n]
        sensor = d.sensor_shape[[s.name for s in rotor.sensors].index(f"sensor_{end}"), :n]
        a[v, i] = actuator
        a[i, p] = -control["bandwidth"] * control["stiffness"] * sensor
        a[i, v] = -control["bandwidth"] * control["damping"] * sensor
        a[i, i] = -control["bandwidth"]
    return a


@pytest.mark.parametrize("modes", [5, 20, 0])
def test_the_control_is_stable(name: str, modes: int) -> None:
    """Every mode decays, also those that the sensor sees elsewhere than the actuator pushes them.

    With the sign of the damping turned round it would not be.
    """
    for residual, speed in ((0, 0.0), (0, full_speed(name)), (1, full_speed(name))):
        a = closed_loop(name, modes, residual, speed)
        found = np.linalg.eigvals(a)
        assert found.real.max() < -10.0  # 1/s
        slow = found[np.abs(found) < 1e3]  # the rotor on its control, forward and backward, A and B
        assert len(slow) == 4
        assert np.all(-slow.real > 0.2 * np.abs(slow))
    n = (len(a) - 2) // 2
    a[2 * n :, n : 2 * n] *= -1.0
    assert np.linalg.eigvals(a).real.max() > 10.0


def levitated(name: str, modes: int = 0, **shutdown: float) -> Scene:
    """The scene with its own macro step, up to 1 ms after the (first) shutdown at A."""
    scene = load_scene(name).set({"rotor.modes": modes, "run.duration": 1e-3})
    for end in ENDS:
        scene = scene.set({f"amb_{end}.shutdown_time": shutdown.get(end, UP_TO)})
    return scene


@pytest.mark.parametrize(("step", "modes"), [(4e-5, 5), (1e-4, 5), (1e-4, 0)])
def test_the_linear_equations_are_the_components(name: str, step: float, modes: int) -> None:
    """A rotor let loose 20 um beside the middle, without unbalance, follows the closed loop above."""
    scene, off = levitated(name, modes, A=4e-3, B=4e-3), 20e-6
    scene = scene.set({"rotor.x": off, "rotor.unbalance_scale": 0.0})
    scene = scene.set({"run.macro_step": step})
    times, motion, _ = history(scene, JOURNALS)
    d = tabulate(shaft(name), modes, 1)
    n = d.modes
    loop = closed_loop(name, modes, 1, full_speed(name))
    bent = d.shape[:, 2:n].T @ (d.held * GRAVITY) / d.stiffness[2:n]
    sag = 1j * np.concatenate((np.zeros(2), bent, np.zeros(n + 2)))  # a displacement to the control
    push = np.where(np.arange(len(loop)) >= 2 * n, loop @ sag, 0.0)
    ahead = expm(np.block([[loop, push[:, None]], [np.zeros((1, len(loop) + 1))]]) * times[0])
    state = np.concatenate((off * d.weight[:n], np.zeros(n + 2), [1.0]))
    worst, moved = 0.0, 0.0
    for k in np.flatnonzero(times < 4e-3 + 1e-9):
        state = ahead @ state
        exact = d.shape[:2, :n] @ (state[:n] + sag[:n])
        found = np.array([motion[f"rotor.{end}.x"][k] + 1j * motion[f"rotor.{end}.y"][k] for end in ENDS])
        worst = max(worst, np.abs(found - exact).max())
        moved = max(moved, np.abs(exact - off).max())
    assert moved > 0.5 * off
    assert worst < 0.0025 * off


def test_every_mode_kept_levitates_quietly(name: str) -> None:
    """With the scene's own macro step: the journals stay near the middle, the ledger near zero."""
    watched = [*JOURNALS, "amb_A.active"]
    times, motion, outcome = history(levitated(name), watched)
    before = times < UP_TO + 1e-9
    assert np.all(motion["amb_A.active"][before] == 1)
    assert motion["amb_A.active"][-1] == 0
    for end in ENDS:
        away = np.hypot(motion[f"rotor.{end}.x"], motion[f"rotor.{end}.y"])[before]
        assert 0.1e-6 < away.max() < 20e-6
        assert away[times[before] > 0.8 * UP_TO].max() < 0.9 * away.max()  # it fades
    assert 0.0 < outcome.residual < 1e-2


@pytest.mark.parametrize("first", ENDS)
def test_the_end_that_is_let_go_first_lands_first(name: str, first: str) -> None:
    """The other one is held 4 ms longer: the rotor tilts and touches where nothing holds it."""
    last = ENDS.replace(first, "")
    scene = levitated(name, 5, **{first: 2e-3, last: 6e-3})
    scene = scene.set({"run.duration": 14e-3 if first == "B" else 18e-3})  # from the shutdown at A
    firsts = {end: f"bearing_{end}.contact.first_time" for end in ENDS}
    times, motion, _ = history(scene, [*JOURNALS, *firsts.values(), "amb_A.active", "amb_B.active"])
    landed = {end: motion[firsts[end]][-1] for end in ENDS}
    between = (times > 2e-3 + 1e-4) & (times < 6e-3)
    assert np.all(motion[f"amb_{first}.active"][between] == 0)
    assert np.all(motion[f"amb_{last}.active"][between] == 1)
    at = np.searchsorted(times, 6e-3)
    assert motion[f"rotor.{first}.y"][at] < motion[f"rotor.{last}.y"][at] - 20e-6
    assert landed[first] > 6e-3
    assert landed[last] < 0.0 or landed[first] < landed[last]


def test_the_static_loads_carry_the_weight(name: str) -> None:
    """They sum to it at the start, without a moment about the centre of mass."""
    scene, rotor = levitated(name), shaft(name)
    with opened(scene, in_process=True) as system:
        system.initialise()
        loads = np.array([system.value(f"amb_{end}.load_y") for end in ENDS])
        sideways = [system.value(f"amb_{end}.load_x") for end in ENDS]
        weight = GRAVITY * system.value("rotor.mass")
    z = rotor.positions()
    arms = np.array([z[rotor.node(f"amb_{end}") - 1] for end in ENDS]) - rotor.centre_of_mass
    assert sideways == [0.0, 0.0]
    assert loads.sum() == pytest.approx(weight, rel=1e-12)
    assert loads @ arms == pytest.approx(0.0, abs=1e-12 * weight)
    assert np.all(loads > 0.2 * weight)
