"""A drop of a sweep, run again in full: by its number, or as the worst of all."""

from __future__ import annotations

from pathlib import Path

import pytest

import touchdown
from touchdown.command.cli import main
from touchdown.master.common.errors import TouchdownError
from touchdown.studies.sweep.members import Member, without_costs
from touchdown.studies.sweep.results import Sweep
from touchdown.studies.sweep.survival import worst_member

FASTER = {"bearing.clearance": ["0.2 mm", "0.3 mm", "0.25 mm"]}


@pytest.fixture(scope="module")
def swept(tmp_path_factory: pytest.TempPathFactory) -> Sweep:
    scene = touchdown.load("disk-caged-simplified").set({"run.duration": "9 ms"})
    return touchdown.sweep(scene, FASTER, tmp_path_factory.mktemp("sweep"), in_process=True, jobs=1)


def test_a_member_runs_again_as_it_did(swept: Sweep, tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    out = str(tmp_path / "again")
    asked = ("--in-process", "--quiet", "-o", out)
    assert main(["run", str(swept.folder), "--worst", "first_contact_speed", *asked]) == 0
    assert f"drop 2 of {swept.folder} has the worst first_contact_speed" in capsys.readouterr().out
    again = touchdown.open_result(out)
    assert again.scene.name == "disk-caged-simplified-2"
    told = without_costs(again.summary)
    assert {**told, "scene": "disk-caged-simplified"} == swept[1].summary
    assert (tmp_path / "again" / "force.png").is_file()


def test_a_member_takes_other_settings(swept: Sweep, tmp_path: Path) -> None:
    asked = ("--in-process", "--quiet", "--no-pictures", "-o", str(tmp_path))
    changed = ("--duration", "1 ms", "--set", "rotor.mass=2 kg")
    assert main(["run", str(swept.folder), "--member", "3", *changed, *asked]) == 0
    run = touchdown.open_result(tmp_path).scene
    assert run.run.duration == 1e-3
    assert run.components["bearing"].set["clearance"] == "0.25 mm"
    assert run.components["rotor"].set["mass"] == "2 kg"


@pytest.mark.parametrize(
    ("asked", "message"),
    [
        (["--member", "4"], "the sweep has drops 1 to 3, and no 4"),
        (["--member", "1", "--worst", "least_gap"], "is a sweep; add --member NUMBER, or --worst QUANTITY"),
        (["--worst", "least_gap"], "no drop of the sweep tells its least_gap"),
        (["--worst", "peak_contact_forces"], "did you mean peak_contact_force"),
        ([], "is a sweep; add --member NUMBER, or --worst QUANTITY"),
    ],
)
def test_mistakes(asked: list[str], message: str, swept: Sweep, capsys: pytest.CaptureFixture) -> None:
    assert main(["run", str(swept.folder), *asked]) != 0
    assert message in capsys.readouterr().err


def test_the_worst_of_some() -> None:
    """By what is worse of its quantity; of all seats, or of one."""
    at = [(3.0, 900.0), (0.9, 800.0), (2.0, 950.0)]
    members = [
        Member(n, {}, {"seats": {"A": {"lowest_static_safety": s, "peak_ball_force": f}}})
        for n, (s, f) in enumerate(at, start=1)
    ]
    members.append(Member(4, {}, {}, failed="stopped"))
    assert worst_member(members, "lowest_static_safety").number == 2
    assert worst_member(members, "seats.A.peak_ball_force").number == 3
    with pytest.raises(TouchdownError, match="neither more nor less of speed_end is worse"):
        worst_member([Member(1, {}, {"components": {"rotor": {"speed_end": 1.0}}})], "speed_end")
