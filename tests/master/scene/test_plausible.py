"""What a scene says of its machine beside itself: refused where it cannot be, said where it hardly can."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from commands import SCENE, Command

import touchdown
from touchdown.master.common.errors import TouchdownError
from touchdown.master.coupling.simulation import opened
from touchdown.master.scene.file import shipped_scenes
from touchdown.master.scene.plausible import PlausibleSeat, plausibility_warnings
from touchdown.studies.sweep.members import Journal, Member, read_journal
from touchdown.studies.sweep.report import warned

VALUES = {
    "journal_radius": 9.7e-3,
    "clearance": 0.3e-3,
    "friction.dynamic": 0.15,
    "friction.static": 0.2,
    "balls.count": 9.0,
}
SEAT = PlausibleSeat("bearing", VALUES, "6004", 20e-3, "rotor", 9000.0 * math.pi / 30.0)


def with_value(name: str, value: float) -> PlausibleSeat:
    """The seat, one of its parameters set."""
    return replace(SEAT, values={**VALUES, name: value})


def test_a_usual_machine_is_not_remarked_on() -> None:
    assert plausibility_warnings([SEAT, SEAT]) == []
    bushing = {name: value for name, value in VALUES.items() if name != "balls.count"}
    assert (
        plausibility_warnings([PlausibleSeat("bushing", bushing, None, None, "rotor", 20000.0)]) == []
    )  # no balls
    assert plausibility_warnings([PlausibleSeat("probe", {}, None, None, "rotor", None)]) == []


@pytest.mark.parametrize("name", shipped_scenes())
def test_nor_are_scenes_that_come_along(name: str) -> None:
    """Of nothing, also not of settings that do nothing."""
    with opened(touchdown.load(name), in_process=True) as system:
        assert list(system.remarks) == []


@pytest.mark.parametrize(
    ("seat", "said"),
    [
        (with_value("clearance", 1.5e-3),
         "bearing.clearance = 1.5 mm is 15 % of the journal's radius of 9.7 mm"),
        (with_value("friction.dynamic", 1.5), "bearing.friction.dynamic = 1.5 is implausibly high"),
        (with_value("friction.static", 2.0), "bearing.friction.static = 2 is implausibly high"),
        (replace(SEAT, speed=20000.0, bare_speed=True),
         "rotor.speed = 190986 rpm is more than a bearing of 20 mm bore runs (50000 rpm by the rule of "
         "1,000,000 mm rpm); a number without a unit is in rad/s"),
        (replace(SEAT, speed=-20000.0, bore=None, designation=None),
         "rotor.speed = -190986 rpm is more than a bearing of 19.4 mm bore runs"),
        (replace(SEAT, bore=70e-3, designation="6014"), "fill 20 mm of the bore of 6014, 70 mm"),
    ],
)  # fmt: skip
def test_what_hardly_can_be_is_said_once(seat: PlausibleSeat, said: str) -> None:
    (line,) = plausibility_warnings([seat, seat])
    assert said in line


def test_weight_along_the_shaft_needs_a_face_on_its_side() -> None:
    """Standing on its -z end, a rotor falls towards it; one whose face is on the other side falls on."""
    faces = {"shoulder.gap_minus": 0.0, "shoulder.gap_plus": 1e-4}
    lying = PlausibleSeat("b", faces, None, None, "rotor", None, gravity=9.81, inclination=0.0, axial=True)
    assert plausibility_warnings([lying]) == []
    (line,) = plausibility_warnings([replace(lying, inclination=0.5 * math.pi)])
    assert "pulls rotor towards -z, where no bearing has a face; set b.shoulder.gap_minus" in line
    assert plausibility_warnings([replace(lying, inclination=-0.5 * math.pi)]) == []
    planar = replace(lying, bearing="a", values={}, inclination=0.5 * math.pi)
    beside = plausibility_warnings([planar, replace(lying, inclination=0.5 * math.pi)])
    assert beside == [line]


@pytest.mark.parametrize(
    ("changes", "warned"),
    [
        ({}, False),  # lying, without a thrust
        ({"inclination": 0.5 * math.pi}, True),  # the weight alone, of a body that does not state its mass
        ({"inclination": 0.5 * math.pi, "arrangement": "tandem reversed"}, False),
        ({"inclination": 0.5 * math.pi, "arrangement": "back to back"}, False),
        ({"thrusts": [-1.0]}, True),
        ({"thrusts": [1.0]}, False),
        ({"thrusts": [50.0, -1.0]}, True),  # at one of its times
        ({"thrusts": [20.0], "inclination": 0.5 * math.pi, "mass": 1.65}, False),  # outweighs 16.2 N
        ({"thrusts": [10.0], "inclination": 0.5 * math.pi, "mass": 1.65}, True),
        ({"thrusts": [1.0], "arrangement": "tandem reversed"}, True),
    ],
)
def test_a_push_to_the_open_side_of_a_row(changes: dict[str, Any], warned: bool) -> None:
    """A tandem pair carries a shaft pushed in +z; with faces on both sides."""
    values = {"shoulder.gap_minus": 1e-4, "shoulder.gap_plus": 1e-4, "balls.contact_angle": 0.4}
    seat = PlausibleSeat("b", values, None, None, "rotor", None, gravity=9.81, inclination=0.0, axial=True)
    seat = replace(seat, **{"arrangement": "tandem"} | changes)
    lines = plausibility_warnings([seat])
    assert bool(lines) == warned
    if warned:
        turned = "tandem" if seat.arrangement == "tandem reversed" else "tandem reversed"
        assert f'set b.arrangement = "{turned}", or take a pair back to back' in lines[0]
    planar = replace(seat, values={**values, "balls.contact_angle": 0.0})
    other_bearing = replace(seat, values={"balls.contact_angle": 0.4})
    assert plausibility_warnings([planar]) == []
    assert not any("shaft pushed" in line for line in plausibility_warnings([other_bearing]))


def test_a_pair_with_a_contact_angle_needs_a_bearing_in_space() -> None:
    pair = replace(SEAT, designation="71904 DB", is_angled=True)
    with pytest.raises(
        TouchdownError, match=r"bearing\.preset = 71904 DB is a pair .*planar; set fmu = angular_simplified"
    ):
        plausibility_warnings([pair])
    in_space = replace(pair, values={**VALUES, "balls.contact_angle": 0.4})
    assert plausibility_warnings([in_space]) == []


@pytest.mark.parametrize(
    ("setting", "said"),
    [
        ("bearing.preset=7000",
         "journal_radius = 9.7 mm, a journal of 19.4 mm, does not go into 7000, whose bore is 10 mm; "
         "take a bearing with a wider bore"),
        ("bearing.friction.dynamic=15",
         "dynamic = 15 is not a coefficient of friction: steel on steel has 0.1 to"),
    ],
)  # fmt: skip
def test_what_cannot_be_is_refused_by_all_that_run_a_scene(
    setting: str, said: str, command: Command, tmp_path: Path
) -> None:
    swept = ["sweep", SCENE, "--vary", "rotor.mass=1,2", "--quiet"]
    for verb in (["run", SCENE, "--quiet"], swept):
        assert said in command(*verb, "--set", setting, "-o", tmp_path / "out").line
    assert said in command("compare", SCENE, "--of", "steps", "--set", setting).line
    assert not list(tmp_path.glob("out/*.json"))


def test_a_run_says_what_hardly_can_be(run: Command) -> None:
    ended = run(SCENE, "--set", "run.duration=1e-4", "--set", "rotor.speed=20000", "--in-process")
    assert ended.status == 0
    assert "warning: rotor.speed = 190986 rpm is more than a bearing of 20 mm bore" in ended.stderr


def test_a_sweep_keeps_what_its_runs_warn_of(tmp_path: Path) -> None:
    members = [Member(n, {}, {}, warnings=("it is fast",) if n > 1 else ()) for n in (1, 2, 3)]
    journal = Journal(tmp_path / "members.jsonl")
    for member in members:
        journal.add(member)
    back = read_journal(journal.path, {1: {}, 2: {}, 3: {}}).members
    assert warned([back[n] for n in (1, 2, 3)]) == ["  2 x it is fast (drop 2)"]


FACED = replace(SEAT, values={**VALUES, "shoulder.gap_minus": 1e-4, "shoulder.gap_plus": 0.0}, axial=True)
BARE = replace(FACED, values={**VALUES, "shoulder.gap_minus": 0.0, "shoulder.gap_plus": 0.0})


@pytest.mark.parametrize(
    ("seats", "said"),
    [
        ([FACED, replace(BARE, bearing="other")], None),  # one of two is enough
        ([BARE], "rotor.axial = 1: no bearing holds rotor along its shaft; set bearing.shoulder.gap_minus"),
        ([replace(SEAT, axial=True)], "take a bearing with faces, such as landing_sleeve"),
        ([replace(FACED, axial=False)],
         "bearing has faces for a shoulder to land on, and rotor does not move along its shaft; "
         "set rotor.axial = 1"),
        ([replace(FACED, gravity=0.0)], None),
        ([replace(SEAT, axial=False, gravity=0.0)], "rotor.axial = 1 lets it move along its shaft, too"),
    ],
)  # fmt: skip
def test_what_is_not_carried_along_the_shaft_is_said(seats: list[PlausibleSeat], said: str | None) -> None:
    found = plausibility_warnings(seats)
    assert found == [] if said is None else len(found) == 1
    assert said is None or said in found[0]
