"""Advice on the macro step: what the contact says, and that schemes do bear it."""

from __future__ import annotations

import pytest
from systems import rotor_on

from touchdown.master.common.errors import TouchdownError
from touchdown.master.coupling.simulation import open_system, simulate
from touchdown.master.scene.file import load_scene
from touchdown.master.scene.run_spec import round_down_125
from touchdown.studies.comparison.steps import LONGEST_MACRO_STEP, advise


def test_elastic_modes_make_the_swing_faster() -> None:
    steps = [
        advise(load_scene("rotor1-9000").set({"rotor.modes": modes}))["interface"].macro_step
        for modes in (2, 5, 20)
    ]
    assert LONGEST_MACRO_STEP >= steps[0] > steps[1] > steps[2] > 1e-6
    readable = [round_down_125(step) for step in (4.2e-5, 5e-5, 9.9e-6, 1e-4)]
    assert readable == pytest.approx([2e-5, 5e-5, 5e-6, 1e-4], rel=1e-12)


@pytest.mark.parametrize(
    "scheme", ["hold", "velocity", "acceleration", "point-mass", "iterated", "jacobi-lead"]
)
def test_a_scheme_bears_what_is_advised(scheme: str) -> None:
    """First impact of the disk: its peak force within 1.5 % (hold gains energy all the while)."""

    def peak(name: str, step: float) -> float:
        scene = load_scene("disk-caged-simplified").set(
            {"amb.shutdown_time": 1e-3, "run.duration": 9.3e-3, "run.scheme": name, "run.macro_step": step}
        )
        system = open_system(scene, in_process=True)
        outcome = simulate(scene, system)
        assert not outcome.reason
        return system.value("bearing.contact.peak_force")

    step = advise(load_scene("disk-caged-simplified"), [scheme])[scheme].macro_step
    assert step >= 2e-6
    assert peak(scheme, step) == pytest.approx(peak("interface", 1e-5), rel=0.015)


def test_without_a_contact_there_is_no_advice() -> None:
    with pytest.raises(TouchdownError, match=r"contact\.rate.*give one"):
        advise(rotor_on(None, {}))
