"""Sequences of stepping: what each of them promises, and what it says when it cannot keep it."""

from __future__ import annotations

import numpy as np
import pytest
from systems import rotor_on

from touchdown.master.common.errors import TouchdownError
from touchdown.master.coupling.simulation import Outcome, open_system, simulate
from touchdown.master.coupling.steppers import stepper
from touchdown.master.coupling.steppers.stepper import Checkpoint
from touchdown.master.scene.file import load_scene
from touchdown.master.scene.scene import Scene
from touchdown.studies.drop.monolithic import Monolith

JOURNAL = ["rotor.A.x", "rotor.A.y"]
END = 9.3e-3  # s after the shutdown; the first impact is over


def disk(scheme: str, step: float, **settings: object) -> Scene:
    """The disk on its caged bearing, from just before the shutdown to just after the first impact."""
    scene = load_scene("disk-caged-simplified").set({"amb.shutdown_time": 1e-3})
    given = {"duration": END, "stop_residual": 1e9, "scheme": scheme, "macro_step": step, **settings}
    return scene.set({f"run.{key}": value for key, value in given.items()})


def ended(scene: Scene, in_process: bool = True) -> tuple[np.ndarray, float, Outcome]:
    """Journal at the end (m), the peak contact force (N), and the outcome."""
    system = open_system(scene, in_process)
    try:
        outcome = simulate(scene, system)
        peak = system.value("bearing.contact.peak_force")
        return np.array([system.value(name) for name in JOURNAL]), peak, outcome
    finally:
        system.close()


@pytest.fixture(scope="module")
def exact() -> np.ndarray:
    """The journal (m) at the end, solved as one system of equations."""
    scene = disk("interface", 1e-5)
    solution = Monolith(scene).solve(np.linspace(END / 3.0, END, 3), JOURNAL, 1e-9, "DOP853")
    return np.array([solution.series[name][-1] for name in JOURNAL])


@pytest.fixture(scope="module")
def peak() -> float:
    """The peak force (N) of the first impact."""
    return ended(disk("interface", 1e-6))[1]


def error(found: np.ndarray, exact: np.ndarray) -> float:
    """Distance (um)."""
    return 1e6 * float(np.hypot(*(found - exact)))


# -- Jacobi ------------------------------------------------------------------------------------------


def test_bearings_that_lead_do_in_parallel_what_they_do_in_turn(exact: np.ndarray, peak: float) -> None:
    found, force, _ = ended(disk("jacobi-lead", 5e-6))
    late, late_force, _ = ended(disk("jacobi-interface", 5e-6))
    assert error(found, exact) < 1e-4
    assert force == pytest.approx(peak, rel=1e-5)
    assert error(late, exact) > 0.05  # the same bearing without the lead
    assert late_force > 1.01 * peak


def test_a_leading_bearing_hands_over_the_next_load_without_moving_on() -> None:
    """Before a rotor that nothing else holds: what it will give in the next step, and no state beyond."""
    rotor = {"y": -0.305e-3, "vy": -0.05}
    scene = rotor_on("simplified_caged", rotor, duration=1.0, macro_step=2e-5)
    plain = open_system(scene, in_process=True)
    leading = open_system(scene.set({"run.scheme": "jacobi-lead"}), in_process=True)
    bearings = [system.components["bearing"] for system in (plain, leading)]
    for system, bearing in zip((plain, leading), bearings, strict=True):
        system.initialise()
        system.feed("bearing")
        bearing.step(0.0, 2e-5)
        bearing.pull()
    kept = [name for name in bearings[0].variables if name.startswith(("ring.", "contact.", "energy."))]
    assert bearings[0].read(kept) == bearings[1].read(kept)
    system = plain
    for name in ("rotor", "bearing"):
        system.feed(name)
        system.components[name].step(0.0 if name == "rotor" else 2e-5, 2e-5)
        system.components[name].pull()
    load_scene = ["journal.fx", "journal.fy", "journal.mz", "journal.dfx", "journal.dfy", "journal.dmz"]
    assert bearings[1].read(load_scene) == pytest.approx(bearings[0].read(load_scene), rel=1e-6)
    assert bearings[1].read(load_scene)[1] > 2.0  # N


def test_a_shutdown_within_the_step_to_come_is_seen() -> None:
    scene = disk("jacobi-lead", 1e-5).set({"amb.shutdown_time": 1.3e-5})
    system = open_system(scene, in_process=True)
    system.initialise()
    weight = 1.65 * 9.81
    given = []
    sequence = stepper(system, scene.run)
    for k in range(3):
        given.append(system.value("amb.journal.fy"))
        sequence.step(k, 1e-5 * k, 1e-5)
    assert given[0] == pytest.approx(weight, rel=1e-9)  # for the first step
    assert given[1] == pytest.approx(0.3 * weight, rel=1e-6)  # it acts for 3 of the second step's 10 us
    assert given[2] == 0.0


def test_all_at_once_with_longer_steps_of_the_bearings(exact: np.ndarray) -> None:
    """Bodies in small steps under bearings in long ones err as all of them do in long ones."""
    scene = disk("jacobi-lead", 5e-6)
    for name in ("bearing", "amb"):
        scene = scene.set({f"{name}.every": 4})
    assert error(ended(scene)[0], exact) < 1e-4


def test_a_bearing_that_retires_leaves_no_load_behind() -> None:
    """The body takes a load one step late: also the last one, which is none."""
    scene = disk("jacobi-interface", 1e-5).set({"amb.shutdown_time": 63e-5})
    system = open_system(scene.set({"run.duration": 2e-3}), in_process=True)
    simulate(scene.set({"run.duration": 2e-3}), system)
    assert "amb" in system.retired
    assert system.components["rotor"].read(["amb.fy"]) == [0.0]


def test_a_bearing_that_cannot_lead_is_refused() -> None:
    scene = disk("interface", 1e-5).set({"bearing.interface.lead": 1})
    with pytest.raises(TouchdownError, match=r"bearing\.interface\.lead follows from the scheme"):
        open_system(scene, in_process=True)


# -- iterated ----------------------------------------------------------------------------------------


def test_repeating_a_step_replaces_the_interface_model(exact: np.ndarray, peak: float) -> None:
    found, force, outcome = ended(disk("iterated", 2e-5))
    assert error(found, exact) < 1e-3
    assert force == pytest.approx(peak, rel=1e-3)
    assert 1.0 < outcome.coupling["repetitions_per_step"] < 4.0
    assert outcome.coupling["shortest_macro_step"] == pytest.approx(20e-6)


def test_a_step_that_does_not_converge_is_divided(monkeypatch: pytest.MonkeyPatch, peak: float) -> None:
    """The shorter the step, the nearer the motion of the last one."""
    monkeypatch.setattr("touchdown.master.coupling.steppers.iterated.MAX_REPETITIONS", 3)
    _, force, outcome = ended(disk("iterated", 5e-5, tolerance=1e-16))
    assert not outcome.reason
    assert outcome.coupling["shortest_macro_step"] < 50e-6
    assert force == pytest.approx(peak, rel=1e-3)


def test_a_step_that_never_converges_stops_and_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("touchdown.master.coupling.steppers.iterated.MAX_REPETITIONS", 1)
    _, _, outcome = ended(disk("iterated", 5e-5, tolerance=1e-18))
    assert "does not converge" in outcome.reason
    assert "smaller macro step" in outcome.reason
    assert "\n" not in outcome.reason


# -- halving -----------------------------------------------------------------------------------------


def test_halving_follows_its_tolerance() -> None:
    """Rotor I's two contacts act on each other, so its steps need dividing in the impact."""
    smallest, errors = [], []
    for tolerance in (1e-9, 1e-11):
        run = {"duration": 8.3e-3, "scheme": "halving", "macro_step": 1e-4, "tolerance": tolerance}
        scene = load_scene("rotor1-9000").set({f"amb_{end}.shutdown_time": 2e-4 for end in "AB"})
        scene = scene.set({f"run.{key}": value for key, value in run.items()})
        system = open_system(scene, in_process=True)
        outcome = simulate(scene, system)
        assert not outcome.reason
        errors.append(outcome.coupling["largest_step_error"] / tolerance)
        smallest.append(outcome.coupling["shortest_macro_step"])
    assert max(errors) <= 1.0
    assert smallest[1] < smallest[0] < 100e-6


# -- going back --------------------------------------------------------------------------------------


def test_a_checkpoint_takes_a_whole_system_back_in_mid_contact() -> None:
    """Through FMUs: the same steps again give the same signals to the last bit."""
    scene = disk("interface", 2e-5).set({"run.duration": 8.0e-3})
    system = open_system(scene.set({"run.duration": 1e-2}))  # what FMUs take for their stop time
    try:
        simulate(scene, system)
        assert system.value("bearing.contact.force") > 20.0
        sequence = stepper(system, scene.run)
        with Checkpoint(system) as before:
            sequence.step(0, 9e-3, 2e-5)
            once = system.signals.copy()
            assert not np.array_equal(once, before.signals)
            before.restore()
            assert np.array_equal(system.signals, before.signals)
            sequence.step(0, 9e-3, 2e-5)
            assert np.array_equal(system.signals, once)
    finally:
        system.close()


@pytest.mark.parametrize("scheme", ["iterated", "halving"])
def test_fmus_that_cannot_be_taken_back_are_refused(scheme: str) -> None:
    scene = disk(scheme, 2e-5)
    system = open_system(scene, in_process=True)
    system.components["housing"].can_save = False
    with pytest.raises(TouchdownError, match=r"housing .* cannot save its state; choose another scheme"):
        simulate(scene, system)


# -- macro steps of their own ------------------------------------------------------------------------


def test_a_bearing_may_take_longer_steps_than_its_bodies(exact: np.ndarray, peak: float) -> None:
    scene = disk("interface", 1e-5)
    for name in ("bearing", "amb"):
        scene = scene.set({f"{name}.every": 4})
    found, force, outcome = ended(scene)
    assert error(found, exact) < 0.02
    assert force == pytest.approx(peak, rel=2e-3)
    assert outcome.residual < 1e-3


def test_a_body_may_not_take_longer_steps_than_its_bearing() -> None:
    scene = disk("interface", 1e-5).set({"rotor.every": 2})
    with pytest.raises(TouchdownError, match="must be a multiple of its body's"):
        simulate(scene, open_system(scene, in_process=True))


def test_schemes_that_go_back_step_all_alike() -> None:
    scene = disk("iterated", 1e-5).set({"bearing.every": 2})
    with pytest.raises(TouchdownError, match=r"remove bearing\.every = 2"):
        simulate(scene, open_system(scene, in_process=True))


@pytest.mark.parametrize("value", [0, 1.5, "two"])
def test_a_multiple_is_a_whole_number(value: object) -> None:
    with pytest.raises(TouchdownError, match=r"bearing\.every"):
        disk("interface", 1e-5).set({"bearing.every": value})
