"""A run to the standstill: what is set for it, and where it ends."""

from __future__ import annotations

from pathlib import Path

import pytest

from touchdown.master.common.errors import Ended, TouchdownError
from touchdown.master.results.run import run_scene
from touchdown.master.scene.file import load_scene
from touchdown.master.scene.spin_down import MACRO_STEP, MODES, ROW_STEP, TOLERANCE, spin_down

INERTIA, SPEED = 0.5e-3, 9000.0  # kg m2, rpm


def test_it_is_coarser_but_for_what_the_user_set() -> None:
    scene = load_scene("compressor").set({"run.macro_step": 2e-5, "bearing_B.interface.tolerance": 1e-7})
    found = spin_down(scene.set({"rotor.modes": 20}), "60 s")
    assert (found.run.duration, found.run.until) == (60.0, "standstill")
    assert found.run.macro_step == 2e-5  # as set
    assert found.run.record_every == round(ROW_STEP / 2e-5)
    assert found.components["bearing_A"].set["interface.tolerance"] == TOLERANCE
    assert found.components["bearing_B"].set["interface.tolerance"] == 1e-7
    assert found.components["rotor"].set["modes"] == 20
    assert "interface.tolerance" not in found.components["housing_A"].set
    plain = spin_down(load_scene("compressor"), 60.0)
    assert (plain.run.macro_step, plain.components["rotor"].set["modes"]) == (MACRO_STEP, MODES)
    fixed = spin_down(load_scene("rotor1-9000"), 60.0).components["bearing_A"]
    assert "interface.tolerance" not in fixed.set  # its steps are of one length


def test_one_duration_is_enough() -> None:
    scene = load_scene("compressor").set({"run.duration": "2 s"})
    with pytest.raises(TouchdownError, match=r"beside which run\.duration = 2 s would be another"):
        spin_down(scene, "60 s")
    assert spin_down(spin_down(load_scene("compressor"), "60 s"), "90 s").run.duration == 90.0


def test_it_ends_where_the_rotor_stands_still(tmp_path: Path) -> None:
    """The brake takes what friction in the bearing does not."""
    brake = {"rotor.brake_points": 1, "rotor.brake[1].torque": "20 N.m"}
    scene = load_scene("disk-caged-simplified").set({"rotor.speed": f"{SPEED} rpm", **brake})
    result = run_scene(spin_down(scene, "0.1 s"), tmp_path, in_process=True)
    assert result.ended is Ended.COMPLETED
    assert 0.01 < result.summary["end_time"] < 0.03
    assert abs(result.recording["rotor.A.omega"][-1]) < 1.0
    turned = 0.5 * INERTIA * (SPEED * 3.141592653589793 / 30.0) ** 2
    assert result.recording["rotor.braking.work"][-1] == pytest.approx(turned, rel=0.02)
    assert result.recording["rotor.braking.power"].max() == pytest.approx(20.0 * 942.48, rel=1e-3)
    assert not any("still turns" in warning for warning in result.warnings)
    short = run_scene(spin_down(scene, "5 ms"), tmp_path / "short", in_process=True)
    assert any("still turns at the end" in warning for warning in short.warnings)
