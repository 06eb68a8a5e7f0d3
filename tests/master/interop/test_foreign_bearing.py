"""A bearing of a user's own, built by pythonfmu without this project, in the place of the project's."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np
import pytest
from places import ROOT
from pythonfmu import FmuBuilder
from systems import history

from touchdown.master.common.errors import TouchdownError
from touchdown.master.coupling.simulation import open_system, opened, simulate
from touchdown.master.interop.check import check_fmu
from touchdown.master.interop.find_scene import find_scene
from touchdown.master.results.run import run_scene
from touchdown.master.scene.file import read_names
from touchdown.reports.figures.plot import draw_all

pytestmark = pytest.mark.slow

EXAMPLES = ROOT / "examples"
NAMES = EXAMPLES / "dry_bushing.toml"
CLEARANCE = 0.2e-3  # m
LOAD = "            load = "


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The example's scene beside the FMU it names."""
    folder = tmp_path_factory.mktemp("own")
    for path in EXAMPLES.glob("*.toml"):
        shutil.copy(path, folder)
    FmuBuilder.build_FMU(EXAMPLES / "dry_bushing.py", dest=folder)
    return folder


def test_it_can_stand_in_for_a_bearing(folder: Path) -> None:
    report = check_fmu(str(folder / "DryBushing.fmu"), "bearing", read_names(NAMES))
    assert report.problems == []
    assert report.lines[-1] == "it can stand in for a bearing"
    assert "journal.inv_m in 1/kg" in report.text  # pythonfmu writes no units
    assert "it reports no contact: first contact, peak force and verdict are estimated" in report.text
    assert "it states no work: the ledger listens to a second instance" in report.text


def test_without_its_names_every_missing_variable_is_named(folder: Path) -> None:
    report = check_fmu(str(folder / "DryBushing.fmu"), "bearing")
    expected = ["journal.x", "journal.y", "journal.fx", "journal.fy"]
    assert [problem.split()[0] for problem in report.problems] == expected
    assert "(input in m)" in report.problems[0]
    with pytest.raises(TouchdownError, match=r"has no variable journal\.x"):
        open_system(find_scene("rotor1-9000").swap(bearing_A=str(folder / "DryBushing.fmu")))


def test_rotor_1_drops_on_it(folder: Path) -> None:
    """Both ends touch their bushings, rebound, and are braked by friction."""
    scene = find_scene(str(folder / "rotor1-dry-bushings.toml")).set(
        {"amb_A.shutdown_time": 0.0, "amb_B.shutdown_time": 0.0, "run.duration": 0.01}
    )
    names = [f"{part}.{name}" for part in ("rotor.A", "rotor.B") for name in ("y", "fy", "omega")]
    _, values, _ = history(scene, names, in_process=False)
    for seat in ("rotor.A", "rotor.B"):
        height, force = values[f"{seat}.y"], values[f"{seat}.fy"]
        assert np.max(force) > 50.0
        assert np.all(force[np.abs(height) < 0.8 * CLEARANCE] == 0.0)
        assert -1.2 * CLEARANCE < np.min(height) < -CLEARANCE
        assert height[-1] > np.min(height) + 5e-6
    assert values["rotor.A.omega"][-1] < values["rotor.A.omega"][0] - 0.05


@pytest.fixture(scope="module")
def telling(folder: Path) -> Path:
    """The example, which also tells the largest force that it found in its steps."""
    script = (EXAMPLES / "dry_bushing.py").read_text(encoding="utf-8")
    for before, after in (
        ("class DryBushing", "class TellingBushing"),
        ('OUTPUTS = ["shaft_fx"', 'OUTPUTS = ["peak", "shaft_fx"'),
        (LOAD, f"            self.peak = max(self.peak, math.hypot(push, rub))\n{LOAD}"),
    ):
        assert before in script
        script = script.replace(before, after)
    (folder / "telling_bushing.py").write_text(script, encoding="utf-8")
    FmuBuilder.build_FMU(folder / "telling_bushing.py", dest=folder)
    return folder / "TellingBushing.fmu"


def test_contact_is_estimated_from_what_crosses(telling: Path, tmp_path: Path) -> None:
    scene = find_scene("disk-caged-simplified").swap(bearing=str(telling))
    scene = scene.with_names("bearing", read_names(NAMES)).set(
        {"amb.shutdown_time": 0.0, "bearing.clearance": 0.3e-3, "run.duration": 0.012}
    )
    result = run_scene(scene, tmp_path, draw=draw_all)
    summary, peak = result.summary, result.recording.at_end("bearing.peak")
    assert summary["contact_estimated_by_master"] == "bearing"
    assert summary["seats"]["A"]["peak_contact_force"] == pytest.approx(peak, rel=0.02)
    assert peak > 300.0
    fall = (2.0 * 0.3e-3 / 9.81) ** 0.5
    assert summary["seats"]["A"]["first_contact_time"] == pytest.approx(fall, abs=5e-5)
    assert summary["seats"]["A"]["first_contact_speed"] == pytest.approx(9.81 * fall, rel=0.01)
    assert summary["seats"]["A"]["whirl"] is not None
    names = {path.stem for path in result.pictures}
    assert names == {"orbit", "force", "distance", "slowing"}
    assert "bearing.journal on rotor.A by what the bearing itself carries" in str(summary["exchange"])


def test_a_role_names_what_is_missing() -> None:
    assert "it has no shutdown_time" in check_fmu("bushing", "amb").text
    assert "no port of a body that spins" in check_fmu("housing", "rotor").problems[0]
    assert "seat.fx is missing (input in N)" in check_fmu("bushing", "housing").problems[0]
    for name, role in (
        ("amb", "amb"),
        ("bushing", "bearing"),
        ("rigid_rotor", "rotor"),
        ("housing", "housing"),
    ):
        assert check_fmu(name, role).problems == []


def test_a_step_in_which_it_bounces_too_high_stops_the_run(folder: Path) -> None:
    """It states no work: a second instance of it tells what a macro step of 1 ms made."""
    scene = find_scene("disk-caged-simplified").swap(bearing=str(folder / "DryBushing.fmu"))
    scene = scene.with_names("bearing", read_names(NAMES)).set(
        {"amb.shutdown_time": "5.1 ms", "bearing.clearance": 0.3e-3, "run.duration": 0.02}
    )
    heights, outcomes = [], []
    for step in (1e-3, 2e-5):
        run = scene.set({"run.macro_step": step, "run.stop_residual": 1e9})
        _, values, outcome = history(run, ["rotor.A.y"], in_process=False)
        height = values["rotor.A.y"] + 0.3e-3
        heights.append(np.max(height[np.argmax(height < 0.0) :]))
        outcomes.append(outcome)
    long, short = outcomes
    assert heights[0] > 1.4 * heights[1]
    assert long.unaudited == short.unaudited == ()
    assert long.share > 0.2
    assert short.warned_at is None
    lost_by_falling = 1.65 * 9.81 * 0.3e-3
    assert abs(short.made) < 0.02 * lost_by_falling
    with opened(scene.set({"run.macro_step": 1e-3})) as system:
        stopped = simulate(scene.set({"run.macro_step": 1e-3}), system)
    assert "bearing.journal on rotor.A" in stopped.reason
    assert stopped.share > scene.run.stop_residual


def variant(folder: Path, name: str, *changes: tuple[str, str]) -> str:
    """The path of the example's FMU as `name`, its script changed."""
    script = (EXAMPLES / "dry_bushing.py").read_text(encoding="utf-8")
    for before, after in (("class DryBushing", f"class {name}"), *changes):
        assert before in script
        script = script.replace(before, after)
    path = folder / f"{name.lower()}.py"
    path.write_text(script, encoding="utf-8")
    return str(FmuBuilder.build_FMU(path, dest=folder))


@pytest.fixture(scope="module")
def pushing_out(folder: Path) -> str:
    """One whose force has the wrong sign."""
    return variant(folder, "PushingOut", ("self.shaft_mz = mean", "self.shaft_mz = [-m for m in mean]"))


@pytest.fixture(scope="module")
def in_kilonewtons(folder: Path) -> str:
    """One that is a thousand times too soft."""
    return variant(
        folder, "InKilonewtons", ('"stiffness": 2e7, "damping": 2e3', '"stiffness": 2e4, "damping": 2.0')
    )


def test_a_force_of_the_wrong_sign_is_found_by_pressing(pushing_out: str) -> None:
    problem = check_fmu(pushing_out, "bearing", read_names(NAMES)).problems[0]
    assert "is pushed further out" in problem
    assert "turn their signs" in problem


def test_a_stiffness_that_cannot_be_meant_is_said(in_kilonewtons: str, folder: Path) -> None:
    report = check_fmu(in_kilonewtons, "bearing", read_names(NAMES))
    assert report.problems == []
    assert "is pushed back, at 2e+04 N/m; touchdown bearings have" in report.text
    right = check_fmu(str(folder / "DryBushing.fmu"), "bearing", read_names(NAMES)).text
    assert "is pushed back, at 2e+07 N/m\n" in right


@pytest.mark.parametrize(
    ("fixture", "ended"), [("pushing_out", "stopped"), ("in_kilonewtons", "completed")]
)
def test_a_bearing_that_does_not_hold_its_journal_is_said(
    fixture: str, ended: str, request: pytest.FixtureRequest
) -> None:
    scene = find_scene("disk-caged-simplified").swap(bearing=request.getfixturevalue(fixture))
    scene = scene.with_names("bearing", read_names(NAMES)).set(
        {"amb.shutdown_time": 0.0, "bearing.clearance": 0.3e-3, "run.duration": 0.04}
    )
    with opened(scene) as system:
        outcome = simulate(scene, system)
    assert outcome.ended.value == ended
    said = outcome.reason or outcome.warning
    assert "times its clearance: that bearing does not hold it" in said
    assert "macro_step" not in said.partition(";")[0]
