"""A whole system as one FMU, stepped by the container's own native code."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from fmpy import read_model_description, simulate_fmu
from fmpy.validation import validate_fmu
from systems import history

from touchdown.master.common.errors import TouchdownError
from touchdown.master.interop.container import write_container
from touchdown.master.scene.file import load_scene
from touchdown.master.scene.scene import Scene

SETTINGS = {"amb.shutdown_time": 0.0, "run.duration": 0.012, "run.macro_step": 2e-5}
WATCHED = ["rotor.A.x", "rotor.A.y", "bearing.contact.peak_force"]
EVERY = 5  # macro steps of the container in one of its host


def dropped(**more: object) -> Scene:
    return load_scene("disk-caged-simplified").set({**SETTINGS, **more})


@pytest.mark.slow
@pytest.mark.parametrize(("scheme", "close"), [("interface", 1e-7), ("jacobi-lead", 0.0)])
def test_a_container_drops_the_rotor_as_the_master_does(scheme: str, close: float, tmp_path: Path) -> None:
    """Bit for bit, where bearings go first only until the contact: their ring starts free."""
    scene = dropped(**{"run.scheme": scheme})
    path = write_container(scene, tmp_path / "whole-disk.fmu")
    assert validate_fmu(str(path)) == []
    step = EVERY * scene.run.macro_step
    found = simulate_fmu(str(path), stop_time=0.012, output_interval=step, output=WATCHED)
    _, values, _ = history(scene, WATCHED, in_process=False)
    assert values["bearing.contact.peak_force"][-1] > 100.0
    for name in WATCHED[:2]:
        own = values[name][EVERY - 1 :: EVERY]
        assert np.array_equal(found[name][1:70], own[:69])
        assert np.max(np.abs(found[name][1:] - own)) <= close
    peaks = found["bearing.contact.peak_force"][-1], values["bearing.contact.peak_force"][-1]
    assert peaks[0] == pytest.approx(peaks[1], rel=1e-3)


@pytest.mark.slow
def test_a_container_starts_when_its_scene_does(tmp_path: Path) -> None:
    """It says so, and its FMUs are told: the magnetic bearing holds the rotor until then."""
    start = 0.25  # s
    settings = {"run.start_time": start, "amb.shutdown_time": start + 1e-3, "run.duration": 2e-3}
    scene = dropped(**settings, **{"run.scheme": "jacobi-lead"})
    path = write_container(scene, tmp_path / "later.fmu")
    experiment = read_model_description(str(path)).defaultExperiment
    assert experiment is not None
    times = float(str(experiment.startTime)), float(str(experiment.stopTime))
    assert times == (start, pytest.approx(start + 3e-3))
    step, stop = EVERY * scene.run.macro_step, start + 3e-3
    found = simulate_fmu(
        str(path), start_time=start, stop_time=stop, output_interval=step, output=["rotor.A.y"]
    )
    _, values, _ = history(scene, ["rotor.A.y"], in_process=False)
    assert values["rotor.A.y"][-1] < values["rotor.A.y"][40] - 1e-6
    assert found["rotor.A.y"][1:] == pytest.approx(values["rotor.A.y"][EVERY - 1 :: EVERY], abs=1e-12)


@pytest.mark.slow
def test_equal_scenes_give_equal_containers(tmp_path: Path) -> None:
    first, again = (write_container(dropped(), tmp_path / folder / "disk.fmu") for folder in ("a", "b"))
    assert first.read_bytes() == again.read_bytes()


@pytest.mark.parametrize(
    ("setting", "value", "expected"),
    [
        ("run.scheme", "halving", "cannot step as scheme halving does; take interface or jacobi-lead"),
        ("bearing.every", 2, "remove `every` of component bearing"),
    ],
)
def test_what_a_container_cannot_do_is_refused(
    setting: str, value: object, expected: str, tmp_path: Path
) -> None:
    with pytest.raises(TouchdownError, match=expected):
        write_container(dropped(**{setting: value}), tmp_path / "disk.fmu")
