"""Coupling schemes on an undamped bounce, twins against FMUs, and the energy ledger."""

from __future__ import annotations

import numpy as np
import pytest
from systems import history, rotor_on

from touchdown.master.common.errors import TouchdownError
from touchdown.master.coupling.observer import EveryStep
from touchdown.master.coupling.simulation import Outcome, energy_scale, open_system, opened, simulate
from touchdown.master.scene.file import load_scene
from touchdown.master.scene.scene import Scene
from touchdown.master.scene.schemes import SCHEMES, scheme


def bounce(name: str) -> tuple[float, float]:
    """A 10 kg mass hits an undamped 1e8 N/m contact at 0.1 m/s, H = 20 us: (rebound, ledger in J)."""
    settings = {
        "contact.stiffness": 1e8, "contact.exponent": 1.0, "contact.damping": 0.0, "friction.dynamic": 0.0,
        "friction.static": 0.0, "friction.g6": 0.0,
    }  # fmt: skip
    rotor = {"mass": 10.0, "gravity": 0.0, "y": -0.3e-3 + 7e-7, "vy": -0.1, "speed": 0.0}
    scene = rotor_on("bushing", rotor, settings, duration=2e-3, macro_step=2e-5, scheme=name)
    _, found, outcome = history(
        scene, ["rotor.A.vy", "bearing.contact.peak_force", "bearing.contact.force"]
    )
    assert found["bearing.contact.peak_force"][-1] > 1000.0
    assert found["bearing.contact.force"][-1] == 0.0
    return found["rotor.A.vy"][-1] / 0.1, outcome.residual


def test_the_default_neither_makes_nor_loses_energy() -> None:
    rebound, residual = bounce("interface")
    assert rebound == pytest.approx(1.0, abs=1e-4)
    assert residual < 1e-6 * 0.05  # of the kinetic energy


def test_schemes_rank_as_their_order() -> None:
    errors = [abs(bounce(name)[0] - 1.0) for name in ("hold", "velocity", "acceleration", "interface")]
    assert errors[0] > 1000.0 * max(errors[1:])
    assert errors[3] < 0.5 * min(errors[:3])


@pytest.mark.parametrize("name", SCHEMES)
def test_every_scheme_lands(name: str) -> None:
    """A disk on the bushing, through its first impact; even the worst scheme knows where that is."""
    rotor = {"y": -0.29e-3, "vy": -0.07}
    scene = rotor_on("bushing", rotor, duration=1e-3, macro_step=2e-6, scheme=name)
    _, found, _ = history(scene, ["bearing.contact.peak_force", "rotor.A.vy"])
    assert found["bearing.contact.peak_force"][-1] == pytest.approx(390.0, rel=0.05)


def test_an_unknown_scheme_is_refused() -> None:
    with pytest.raises(TouchdownError, match="did you mean interface"):
        scheme("interfaces")


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


def residual(name: str, step: float) -> tuple[float, float]:
    """Ledger and balance of all energies through the first impact, over the energy lost by falling."""
    scene = load_scene("disk-caged-simplified").set({"run.duration": 0.01, "run.scheme": name})
    scene = scene.set({"run.macro_step": step, "run.stop_residual": 1e9})
    system = open_system(scene, in_process=True)
    energies = ("kinetic", "potential", "dissipated")

    def total() -> float:
        parts = [system.value(f"{c}.energy.{k}") for c in ("rotor", "bearing", "housing") for k in energies]
        return sum(parts) - system.value("amb.supplied")

    before: list[float] = []
    first = EveryStep(lambda _: before.append(total()) if not before else None)
    outcome = simulate(scene, system, observers=[first])
    return outcome.residual, abs(total() - before[0]) / energy_scale(scene, system)


@pytest.mark.parametrize("name", ["hold", "velocity", "acceleration"])
def test_the_residual_falls_at_the_order_the_scheme_states(name: str) -> None:
    steps = np.array([5e-6, 1e-5, 2e-5, 4e-5])
    found = [residual(name, step)[0] for step in steps]
    order = np.polyfit(np.log(steps), np.log(found), 1)[0]
    assert order == pytest.approx(SCHEMES[name].error_order, abs=0.25)


def test_the_ledger_is_the_energy_that_is_made() -> None:
    """Held motion makes energy; the ledger, a sum of absolute values, bounds it without looking inside."""
    ledger, balance = residual("hold", 1e-5)
    assert 0.02 < balance <= ledger < 1.3 * balance


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
