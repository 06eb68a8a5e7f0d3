"""The ledger: what it calls made is made, what is in doubt is said, and whirls are stepped finely."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from systems import DISK, GRAVITY, rotor_on

from touchdown.master.common.errors import TouchdownError
from touchdown.master.components.in_process import InProcessComponent
from touchdown.master.coupling.ledger import Ledger, WhirlStepControl
from touchdown.master.coupling.observer import RunState
from touchdown.master.coupling.simulation import Outcome, fall_energy, opened, simulate
from touchdown.master.coupling.steppers import stepper
from touchdown.master.results.run import run_scene
from touchdown.master.scene.file import load_scene
from touchdown.master.scene.scene import Scene

STATED = "touchdown.master.coupling.ledger.accounts.WORK"
ELASTIC = {
    "contact.stiffness": 1e8, "contact.exponent": 1.0, "contact.damping": 0.0, "friction.dynamic": 0.0,
    "friction.static": 0.0, "friction.g6": 0.0,
}  # fmt: skip


def bounce(scheme: str, step: float = 2e-5) -> Scene:
    """A mass of 10 kg hits an undamped contact at 0.1 m/s, in free space."""
    rotor = {"mass": 10.0, "gravity": 0.0, "y": -0.3e-3 + 7e-7, "vy": -0.1, "speed": 0.0}
    scene = rotor_on("bushing", rotor, ELASTIC, duration=2e-3, macro_step=step, scheme=scheme)
    return scene.set({"run.stop_residual": 1e9})


def simulated(scene: Scene, in_process: bool = True) -> Outcome:
    with opened(scene, in_process) as system:
        return simulate(scene, system)


def gained(scene: Scene) -> tuple[float, Outcome]:
    """Kinetic energy that the mass gained (J): nothing but the coupling can have made it."""
    with opened(scene, in_process=True) as system:
        outcome = simulate(scene, system)
        assert system.value("bearing.contact.force") == 0.0
        assert system.value("bearing.contact.peak_force") > 1000.0
        return 0.5 * 10.0 * (system.value("rotor.A.vy") ** 2 - 0.1**2), outcome


# -- what was made -------------------------------------------------------------------------------------


def test_the_default_neither_makes_nor_loses_energy() -> None:
    energy, outcome = gained(bounce("interface"))
    assert abs(energy) < 2e-4 * 0.05  # of what it had
    assert outcome.residual < 1e-6 * 0.05


@pytest.mark.parametrize(("scheme", "tolerance"), [("hold", 0.03), ("jacobi-interface", 0.15)])
def test_what_the_ledger_calls_made_the_motion_has(scheme: str, tolerance: float) -> None:
    """The accounts of held loads are of second order in the step, those of late ones of first."""
    energy, outcome = gained(bounce(scheme))
    assert energy > 0.04 * 0.05  # of what it had
    assert outcome.made == pytest.approx(energy, rel=tolerance)
    assert outcome.residual == pytest.approx(energy, rel=tolerance)  # all of it has one sign


@pytest.mark.parametrize(
    ("scheme", "step"), [("hold", 2e-5), ("velocity", 2e-4), ("jacobi-interface", 2e-5)]
)
def test_a_witness_finds_what_a_silent_bearing_does_not_state(
    scheme: str, step: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    energy, stated = gained(bounce(scheme, step))
    monkeypatch.setattr(STATED, "nothing")
    _, heard = gained(bounce(scheme, step))
    assert heard.unaudited == ()
    assert abs(energy) > 1e-5
    assert heard.made == pytest.approx(energy, rel=0.05)
    assert heard.share == pytest.approx(stated.share, rel=0.5)


def test_a_witness_of_an_exact_coupling_finds_little(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(STATED, "nothing")
    energy, outcome = gained(bounce("interface"))
    assert abs(energy) < 1e-5
    assert abs(outcome.made) < 2e-3 * 0.05
    assert outcome.warned_at is None


@pytest.mark.parametrize("scheme", ["iterated", "halving"])
def test_what_cannot_be_heard_is_said(scheme: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(STATED, "nothing")
    result = run_scene(bounce(scheme), tmp_path, in_process=True)
    expected = f"bearing.journal on rotor.A, scheme {scheme} repeats or divides its steps"
    assert result.summary["not_audited"] == expected
    assert result.warnings[-1] == f"not audited: {expected}"


def test_what_can_be_loaded_only_once_is_not_audited(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(self: InProcessComponent) -> InProcessComponent:
        raise TouchdownError("its FMU can be loaded only once in a process")

    monkeypatch.setattr(STATED, "nothing")
    monkeypatch.setattr(InProcessComponent, "second", refuse)
    outcome = simulated(bounce("interface"))
    assert outcome.unaudited == (
        "bearing.journal on rotor.A, its FMU can be loaded only once in a process",
    )


# -- what is in doubt ----------------------------------------------------------------------------------


def first_impact(settings: dict[str, object]) -> tuple[float, Outcome]:
    """Its peak force (N), and the run's outcome."""
    scene = load_scene("disk-caged-simplified").set({"amb.shutdown_time": 1e-3, "run.duration": 9.3e-3})
    with opened(scene.set(settings), in_process=True) as system:
        outcome = simulate(scene.set(settings), system)
        return system.value("bearing.contact.peak_force"), outcome


@pytest.fixture(scope="module")
def finely() -> float:
    """Peak force (N) by steps of 1 us."""
    return first_impact({"run.macro_step": 1e-6})[0]


@pytest.mark.parametrize(
    ("scheme", "step", "warns"),
    [
        ("hold", 2e-5, True),
        ("jacobi-interface", 1e-5, True),
        ("hold", 2e-6, False),
        ("interface", 1e-4, False),
    ],
)
def test_a_warning_means_that_a_peak_is_off(scheme: str, step: float, warns: bool, finely: float) -> None:
    peak, outcome = first_impact({"run.scheme": scheme, "run.macro_step": step, "run.stop_residual": 1e9})
    error = abs(peak / finely - 1.0)
    assert (outcome.warned_at is not None) == warns
    assert error > 0.01 if warns else error < 0.005


@pytest.mark.parametrize("name", ["rotor1-9000", "rotor2-case1"])
def test_scenes_at_their_own_steps_are_not_in_doubt(name: str) -> None:
    """Nor are their steps shortened, as in a whirl."""
    outcome = simulated(load_scene(name).set({"run.duration": 0.03}))
    assert not outcome.reason
    assert outcome.warned_at is None
    assert 0.0 < outcome.share < 0.02
    assert outcome.shorter_steps == {}


def test_a_scene_without_a_scale_is_judged_all_the_same() -> None:
    """By what it turns over; the energy lost by falling follows from rotor and clearance."""
    scene = load_scene("disk-caged-simplified")
    bare = Scene(**{**vars(scene), "energy_scale": ()}).set({"run.duration": 0.01, "run.scheme": "hold"})
    with opened(bare, in_process=True) as system:
        system.initialise()
        assert fall_energy(system) == pytest.approx(DISK * GRAVITY * 0.3e-3)
    outcome = simulated(bare)
    assert outcome.warned_at is not None
    assert "that of a force wrong by" in outcome.warning


LANDED = {"amb.shutdown_time": 1e-3, "run.duration": 9.3e-3, "run.stop_residual": 1e9}


@pytest.mark.parametrize(
    ("name", "settings"),
    [
        ("disk-caged-simplified", {"run.scheme": "hold", "run.macro_step": 1e-4}),
        ("disk-cageless-detailed", {"run.scheme": "hold", "run.macro_step": 5e-5}),
        ("disk-cageless-simplified", {"run.scheme": "velocity", "run.macro_step": 1e-4}),
    ],
)
def test_the_coupling_is_blamed_and_its_remedy_removes_the_alarm(
    name: str, settings: dict[str, object]
) -> None:
    """Also where it is the balance inside the bearing that speaks, alone or beside the connection."""
    scene = load_scene(name).set(LANDED | settings)
    said = simulated(scene).warning
    steps = [1e-6 * float(step) for step in re.findall(r'"run.macro_step=([^ ]+) us"', said)]
    assert len(steps) == said.count("; the macro step of")
    assert said.count("--set") == len(steps)
    for step in steps:
        assert simulated(scene.set({"run.macro_step": step})).warning == ""


@pytest.mark.parametrize(
    ("name", "settings"),
    [
        ("disk-caged-simplified", {"housing.mass": 0.01}),
        ("disk-cageless-simplified", {"run.macro_step": 1e-3}),
    ],
)
def test_what_leaves_the_peak_right_gives_no_alarm(name: str, settings: dict[str, object]) -> None:
    """A light housing, and a macro step of the length of the impact: the bearing carries both inside."""
    peaks: list[float] = []
    for changes in (settings, settings | {"run.macro_step": 2e-6}):
        scene = load_scene(name).set(LANDED | changes)
        with opened(scene, in_process=True) as system:
            assert simulate(scene, system).warning == ""
            peaks.append(system.value("bearing.contact.peak_force"))
    assert peaks[0] == pytest.approx(peaks[1], rel=0.02)


@pytest.mark.parametrize(("scheme", "warns"), [("velocity", True), ("interface", False)])
def test_a_housing_that_swings_far_in_a_macro_step(scheme: str, warns: bool) -> None:
    """By 1.1 rad, the outer ring with it: said where its bearing carries it along a straight line."""
    scene = load_scene("disk-caged-simplified").set({"housing.mass": 0.3, "run.duration": "1 ms"})
    with opened(scene, in_process=True) as system:
        mass = 0.3 + system.value("housing.outer_ring")
        frequency = (system.value("housing.stiffness") / mass) ** 0.5
    warning = simulated(scene.set({"run.macro_step": 1.1 / frequency, "run.scheme": scheme})).warning
    assert ("housing.seat swings 1.1 rad on its springs" in warning) is warns
    below = simulated(scene.set({"run.macro_step": 0.9 / frequency, "run.scheme": scheme})).warning
    assert "swings" not in below


# -- whirls --------------------------------------------------------------------------------------------

WHIRL = {"run.macro_step": 4e-5, "run.duration": 0.15, "run.stop_residual": 10.0}


def test_shortened_steps_are_those_of_fmus_and_recorded_on_the_grid(tmp_path: Path) -> None:
    scene = load_scene("rotor1-18000-225um").set(WHIRL).set({"run.record": "rotor.A"})
    ends = []
    for in_process in (True, False):
        result = run_scene(scene, tmp_path / str(in_process), in_process)
        step = scene.run.macro_step * scene.run.record_every
        np.testing.assert_allclose(np.diff(result.recording.time)[:-1], step, rtol=1e-6)
        shorter = [result.summary[key] for key in ("time_in_shorter_steps", "shortest_macro_step")]
        assert all(shorter)
        ends.append((shorter, result.recording["rotor.A.x"][-1], result.recording["rotor.A.y"][-1]))
        result.recording.close()
    assert ends[0] == ends[1]


@pytest.mark.parametrize("scheme", ["jacobi-lead", "iterated", "acceleration"])
def test_schemes_bear_steps_that_change(scheme: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Steps that are divided now and then through an impact lead where whole ones do."""

    def switch(self: WhirlStepControl, now: RunState) -> None:
        self.halvings = 2 * (now.done // 7 % 2)

    scene = load_scene("disk-caged-simplified").set(
        {"amb.shutdown_time": 1e-3, "run.duration": 9.3e-3, "run.scheme": scheme, "run.macro_step": 1e-5}
    )
    found = []
    for change in (False, True):
        if change:
            monkeypatch.setattr(WhirlStepControl, "stepped", switch)
        with opened(scene, in_process=True) as system:
            simulate(scene, system).raise_if_stopped()
            found.append([system.value(f"rotor.A.{axis}") for axis in "xy"])
    assert np.max(np.abs(np.subtract(*found))) < 1e-9  # m


@pytest.mark.parametrize(
    "settings", [{"run.whirl_halvings": 0}, {"run.scheme": "halving"}, {"bearing_A.every": 2}]
)
def test_some_runs_have_whole_steps_only(settings: dict[str, object]) -> None:
    scene = load_scene("rotor1-9000").set(settings)
    with opened(scene, in_process=True) as system:
        system.initialise()
        steps = stepper(system, scene.run)
        shortening = WhirlStepControl(Ledger(steps, 0.01, 0.01), steps)
        moment = RunState(system, 0.0, 1000)
        for number in range(1000):
            for account in shortening.ledger.accounts:
                account.record["turned"] += 1.0
                account.book(-0.1)
            moment.move(number + 1, 4e-5)
            shortening.stepped(moment)
            assert shortening.halvings == 0
