"""Other bearings in a scene's touchdown seats."""

from __future__ import annotations

from pathlib import Path

import pytest
from commands import records

from touchdown.command.cli import main
from touchdown.master.common.errors import FAILED, TouchdownError
from touchdown.master.common.progress import SILENT_PROGRESS
from touchdown.master.coupling.simulation import opened
from touchdown.master.scene.file import load_scene
from touchdown.studies.comparison.bearings import compare, variants
from touchdown.studies.comparison.engine import BEARINGS, Comparison, Options

DISK, OWN = "disk-caged-simplified", "simplified_caged"
EARLY = {"amb.shutdown_time": 1e-3, "run.duration": 10e-3}


@pytest.fixture(scope="module")
def disk() -> Comparison:
    names = (OWN, "simplified_cageless", "6014", "rigid_rotor")
    asked = Options(bearings=names, jobs=1, in_process=True)
    return compare(load_scene(DISK).set(EARLY), asked, SILENT_PROGRESS)


def test_the_same_bearing_deviates_by_nothing(disk: Comparison) -> None:
    (own,) = disk.beside
    assert disk.rows[0].errors == own.errors
    assert set(own.errors.values()) == {0.0}
    assert own.values["peak_contact_force"] == pytest.approx(345.6, abs=0.5)
    assert own.remark == "A: no whirl"


def test_deviations_are_relative(disk: Comparison) -> None:
    (own,) = disk.beside
    for row in disk.rows[1:3]:
        for key in ("first_impact_contact_force", "peak_ball_force", "lowest_static_safety"):
            assert row.errors[f"{key} deviation"] == pytest.approx(row.values[key] / own.values[key] - 1.0)
        assert row.wall
    assert disk.rows[2].errors["lowest_static_safety deviation"] > 1.0  # a far larger bearing


def test_what_is_no_bearing_says_so_in_its_row(disk: Comparison) -> None:
    assert "rigid_rotor, in process has no variable journal.x" in disk.rows[3].failed


def test_what_the_reference_is_and_how_firm_peaks_are(disk: Comparison) -> None:
    assert disk.lines[1].startswith("reference: the scene as it is")
    assert "one draw of many" in disk.lines[2]
    assert any("6014" in text and "sleeve" in text for text in disk.warnings)


def test_every_seat_takes_the_bearing() -> None:
    scene = load_scene("rotor1-9000")
    swapped, fitted = (one.scene for one in variants(scene, ("detailed_caged", "6014")))
    for name in ("bearing_A", "bearing_B"):
        assert swapped.components[name].fmu == "detailed_caged"
        assert fitted.components[name].preset == "6014"
    with opened(scene, True) as before, opened(fitted, True) as after:
        for variable in ("journal_radius", "clearance"):
            assert after.value(f"bearing_A.{variable}") == before.value(f"bearing_A.{variable}")


def test_the_four_of_the_source_are_the_default() -> None:
    assert [one.name for one in variants(load_scene(DISK), Options().bearings)] == list(BEARINGS)


def test_a_scene_that_stops_by_itself_is_no_reference() -> None:
    scene = load_scene(DISK).set({**EARLY, "run.scheme": "hold", "run.stop_residual": 0.01})
    with pytest.raises(TouchdownError, match="the scene with its own bearings: "):
        compare(scene, Options(bearings=(OWN,), jobs=1, in_process=True), SILENT_PROGRESS)


def command(folder: Path, *arguments: str) -> int:
    short = ("--set", "amb.shutdown_time=1 ms", "--set", "run.duration=8 ms", "--in-process", "--jobs", "1")
    return main(["compare", DISK, "--of", "bearings", *arguments, *short, "--quiet", "-o", str(folder)])


def test_the_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert command(tmp_path, "--bearings", f"{OWN},6014") == 0
    assert "first impact" in capsys.readouterr().out
    rows = records(tmp_path / "bearings.csv")
    assert [row["variant"] for row in rows] == [OWN, "6014", "as it is"]
    assert float(rows[0]["peak_contact_force_deviation_relative"]) == 0.0
    assert float(rows[1]["largest_displacement_m"]) > 1e-4


@pytest.mark.parametrize(
    ("name", "says"),
    [("6000", "6000 has a bore of 10 mm"), ("601", "there is no bearing 601; did you")],
)
def test_what_does_not_fit_is_refused_at_once(
    name: str, says: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert command(tmp_path, "--bearings", name) == FAILED
    assert says in capsys.readouterr().err
