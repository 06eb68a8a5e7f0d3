"""Other bearings in a scene's touchdown seats."""

from __future__ import annotations

from pathlib import Path

import pytest
from commands import records
from stub import MACHINE, STUB

from touchdown.command.cli import main
from touchdown.master.common.errors import STOPPED, Ended, TouchdownError
from touchdown.master.common.progress import SILENT_PROGRESS
from touchdown.master.coupling.simulation import opened
from touchdown.master.scene.file import load_scene
from touchdown.studies.comparison import drops
from touchdown.studies.comparison.bearings import compare, variants
from touchdown.studies.comparison.engine import BEARINGS, Comparison, Options
from touchdown.studies.sweep import tasks
from touchdown.studies.sweep.members import Member
from touchdown.studies.sweep.tasks import Task

DISK, OWN = "disk-caged-simplified", "simplified_caged"
EARLY = {"amb.shutdown_time": 1e-3, "run.duration": 10e-3}


@pytest.fixture(scope="module")
def disk() -> Comparison:
    names = (OWN, "simplified_cageless", "6014", "rigid_rotor")
    asked = Options(bearings=names, jobs=1, in_process=True)
    return compare(load_scene(DISK).set(EARLY), asked, SILENT_PROGRESS)


def test_the_same_bearing_deviates_by_nothing_and_others_relatively(disk: Comparison) -> None:
    (own,) = disk.beside
    assert disk.rows[0].errors == own.errors
    assert set(own.errors.values()) == {0.0}
    assert own.values["peak_contact_force"] == pytest.approx(345.6, abs=0.5)
    assert own.remark == "A: no whirl"
    for row in disk.rows[1:3]:
        for key in ("first_impact_contact_force", "peak_ball_force", "lowest_static_safety"):
            assert row.errors[f"{key} deviation"] == pytest.approx(row.values[key] / own.values[key] - 1.0)
        assert row.wall
    assert disk.rows[2].errors["lowest_static_safety deviation"] > 1.0  # a far larger bearing


def test_what_is_no_bearing_and_how_firm_peaks_are_is_said(disk: Comparison) -> None:
    assert "rigid_rotor, in process has no variable journal.x" in disk.rows[3].failed
    assert disk.lines[1].startswith("reference: the unchanged scene")
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
    assert [one.name for one in variants(load_scene(DISK), Options().bearings)] == list(BEARINGS)


RUB_RING = """
[[gap]]
name = "rub ring"
at = "rotor.C"
radial = "0.2 mm"
journal_radius = "14 mm"
"""


def test_bushings_of_gaps_stay_and_do_not_count(tmp_path: Path) -> None:
    """A rub ring catches the rotor before the bearings do, which then have neither force nor verdict."""
    (tmp_path / "stub.toml").write_text(STUB.replace("B = 5", "B = 5\nC = 3"), encoding="utf-8")
    (tmp_path / "own.toml").write_text(MACHINE + RUB_RING, encoding="utf-8")
    steps = {"run.duration": "12 ms", "run.macro_step": "10 us"}
    scene = load_scene(str(tmp_path / "own.toml")).set(steps)
    (swapped,) = variants(scene, ("detailed_caged",))
    fmus = {name: spec.fmu for name, spec in swapped.scene.components.items() if name != "rotor"}
    assert fmus == {"gap_rub_ring": "bushing"} | dict.fromkeys(("bearing_A", "bearing_B"), "detailed_caged")
    found = compare(scene, Options(bearings=("bushing",), jobs=1, in_process=True), SILENT_PROGRESS)
    for row in (*found.rows, *found.beside):
        assert row.wall
        assert "peak_contact_force" not in row.values
        assert row.remark == "A: no whirl, B: no whirl"


def test_a_seat_without_a_verdict_is_not_named() -> None:
    seats = {"A": {"bearing": "a", "whirl": None}, "B": {"bearing": "b", "whirl": "pendulum"}}
    assert drops._row("one", Member(1, {}, {"seats": seats}), {}).remark == "B: pendulum"


def test_ctrl_c_in_this_process_ends_it(monkeypatch: pytest.MonkeyPatch) -> None:
    ended = Member(1, {}, {}, "interrupted", Ended.INTERRUPTED)
    runs: list[Task] = []
    monkeypatch.setattr(tasks, "_run_task", lambda task: runs.append(task) or ended)
    with pytest.raises(KeyboardInterrupt):
        compare(load_scene(DISK), Options(bearings=(OWN,), jobs=1, in_process=True), SILENT_PROGRESS)
    assert len(runs) == 1


def test_a_scene_that_stops_by_itself_is_no_reference() -> None:
    scene = load_scene(DISK).set({**EARLY, "run.scheme": "hold", "run.stop_residual": 0.01})
    with pytest.raises(TouchdownError, match="the unchanged scene: "):
        compare(scene, Options(bearings=(OWN,), jobs=1, in_process=True), SILENT_PROGRESS)


@pytest.mark.parametrize(
    ("bearings", "status"), [(f"{OWN},6014", 0), ("rigid_rotor", STOPPED), (f"rigid_rotor,{OWN}", 0)]
)
def test_the_command(
    bearings: str, status: int, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Its table, and the exit status, which says whether all failed."""
    short = ("--set", "amb.shutdown_time=1 ms", "--set", "run.duration=8 ms", "--in-process", "--jobs", "1")
    asked = [
        "compare",
        DISK,
        "--of",
        "bearings",
        "--bearings",
        bearings,
        *short,
        "--quiet",
        "-o",
        str(tmp_path),
    ]
    assert main(asked) == status
    said, complaint = capsys.readouterr()
    rows = records(tmp_path / "bearings.csv")
    assert [row["variant"] for row in rows] == [*bearings.split(","), "unchanged"]
    assert ("touchdown: all variants failed, see the table" in complaint) == bool(status)
    if bearings.endswith("6014"):
        assert "first impact" in said
        assert float(rows[0]["peak_contact_force_deviation_relative"]) == 0.0
        assert float(rows[1]["largest_displacement_m"]) > 1e-4
