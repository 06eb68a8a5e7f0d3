"""Coupling schemes: each of them lands, errs as it states, and steps FMUs as it does models."""

from __future__ import annotations

import numpy as np
import pytest
from systems import history, rotor_on

from touchdown.master.coupling.simulation import Outcome, open_system, opened, simulate
from touchdown.master.scene.file import load_scene
from touchdown.master.scene.scene import Scene
from touchdown.master.scene.schemes import SCHEMES


@pytest.mark.parametrize("name", SCHEMES)
def test_every_scheme_lands(name: str) -> None:
    """A disk on the bushing, through its first impact; even the worst scheme knows where that is."""
    rotor = {"y": -0.29e-3, "vy": -0.07}
    scene = rotor_on("bushing", rotor, duration=1e-3, macro_step=2e-6, scheme=name)
    _, found, _ = history(scene, ["bearing.contact.peak_force", "rotor.A.vy"])
    assert found["bearing.contact.peak_force"][-1] == pytest.approx(390.0, rel=0.05)


def test_fmus_and_models_in_process_agree_bit_for_bit() -> None:
    """All exchanged signals after a run that includes the first impact."""
    scene = load_scene("disk-caged-simplified").set({"run.duration": 0.012})
    signals = []
    for in_process in (False, True):
        with opened(scene, in_process) as system:
            assert not simulate(scene, system).reason
            assert system.value("bearing.contact.peak_force") > 300.0
            signals.append(system.signals.copy())
    assert np.array_equal(*signals)


def test_a_component_that_is_done_is_not_stepped_any_more() -> None:
    scene = load_scene("disk-caged-simplified").set({"run.duration": 0.01, "run.macro_step": 2e-5})
    system = open_system(scene, in_process=True)
    calls = 0
    step = system.components["amb"].step

    def counted(time: float, size: float) -> None:
        nonlocal calls
        calls += 1
        step(time, size)

    system.components["amb"].step = counted  # type: ignore[method-assign]
    outcome = simulate(scene, system)
    assert 250 < calls < 250 + 2 * 64 < outcome.steps


@pytest.mark.parametrize(("name", "step"), [("hold", 1e-4), ("velocity", 5e-4), ("interface", 2e-2)])
def test_a_step_that_is_too_long_stops_and_names_one_that_holds(name: str, step: float) -> None:
    scene = load_scene("disk-caged-simplified").set({"run.duration": 0.05, "run.scheme": name})
    outcome = simulated(scene.set({"run.macro_step": step}))
    assert outcome.reason.startswith("the energy error of the coupling at bearing.")
    suggested = 1e-6 * float(outcome.reason.split("run.macro_step=")[1].split()[0])
    assert suggested < step
    again = simulated(scene.set({"run.macro_step": suggested}))
    assert not again.reason


def simulated(scene: Scene) -> Outcome:
    """Outcome of a run in process."""
    return simulate(scene, open_system(scene, in_process=True))
