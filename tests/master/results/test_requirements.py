"""What a scene requires of its drop: margins by hand, what is not told, what is refused; over a sweep."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import touchdown
from touchdown.command.cli import main
from touchdown.master.common.errors import STOPPED, Ended, TouchdownError
from touchdown.master.quantities import Summary
from touchdown.master.results.required import add_requirements, judged
from touchdown.master.scene.file import read_resolved
from touchdown.master.scene.requirements import Requirement, read_requirements
from touchdown.master.scene.scene import Scene
from touchdown.modelkit.reader import Table
from touchdown.reports.chapters.summary import requirements
from touchdown.reports.subject import Subject
from touchdown.studies.loop.over_speed import loops_in
from touchdown.studies.sweep.members import Member
from touchdown.studies.sweep.report import requirement_lines

SCENE = """
extends = "disk-caged-simplified"
[requirements]
contact_force = "400 N"
stroke = "1 um"
"""


def seats(**values: dict[str, float | None]) -> Summary:
    return {"seats": values}


def touched(force: float | None) -> dict[str, float | None]:
    return {"first_contact_time": 0.01, "peak_contact_force": force}


def untouched() -> dict[str, float | None]:
    return {"first_contact_time": None, "peak_contact_force": None}


def heat(met: bool, margin: float) -> Summary:
    return {"requirements_met": met, "requirements": {"heat": {"margin": margin}}}


@pytest.mark.parametrize(
    ("kind", "limit", "summary", "found", "margin"),
    [
        ("least_gap", 1e-4, {"least_gap": 150e-6}, 1.5e-4, 0.5),
        ("least_gap", 1e-4, {"least_gap": -50e-6}, -5e-5, -1.5),
        ("ball_pressure", 2e9, seats(A={"largest_ball_pressure": 1.5e9}), 1.5e9, 0.25),
        ("ball_force", 1e3, seats(A={"peak_ball_force": 8.0}, B={"peak_ball_force": 1100.0}), 1100.0, -0.1),
        ("contact_force", 1e3, seats(A=touched(800.0), B=untouched()), 800.0, 0.2),
        ("static_safety", 2.0, seats(A={"lowest_static_safety": 5.0}, B={"lowest_static_safety": 3.0}),
         3.0, 0.5),
        ("whirl_turns", 0.0, seats(A={"whirl_revolutions": 0.0}), 0.0, 0.0),
        ("whirl_turns", 0.0, seats(A={"whirl_revolutions": 2.0}), 2.0, -1.0),
    ],
)  # fmt: skip
def test_margins(kind: str, limit: float, summary: Summary, found: float, margin: float) -> None:
    """Over the limit; of several bearings the worst counts."""
    (one,) = judged([Requirement(kind, limit)], summary)
    assert one.found == pytest.approx(found, abs=1e-12)
    assert one.margin == pytest.approx(margin, abs=1e-12)
    assert one.met is (margin >= 0.0)


def test_margins_are_words_for_people() -> None:
    """Of lengths in um, of others in per cent or without a number. A bar is full at the limit."""
    summary = {"least_gap": 150e-6, **seats(A=touched(800.0) | {"lowest_static_safety": 3e8})}
    wanted = [("least_gap", 1e-4), ("least_gap", 2e-4), ("contact_force", 1e3), ("static_safety", 2.0)]
    gap, narrow, force, safety = judged([Requirement(*one) for one in wanted], summary)
    said = [one.left() for one in (gap, narrow, force, safety)]
    assert said == ["50 um to spare", "50 um beyond the limit", "20 % to spare", "far above"]
    assert [one.used for one in (narrow, force)] == [1.0, 0.8]
    assert (gap.used, safety.used) == pytest.approx((2.0 / 3.0, 0.0), abs=1e-6)
    assert narrow.compared() == "least gap left of all, 150 um of at least 200 um"


@pytest.mark.parametrize(
    ("kind", "summary"),
    [
        ("settling_time", {}),
        ("settling_time", {"settling_time": None}),
        ("contact_force", seats(A=untouched())),
        ("heat", seats(A=untouched() | {"bearing_heat": 0.0})),
        ("contact_force", seats(A=touched(0.1), B=touched(None))),
    ],
)
def test_what_a_run_does_not_tell_is_not_met(kind: str, summary: Summary) -> None:
    """Nothing was touched, or B was and has no force."""
    wanted = (Requirement(kind, 0.5),)
    assert "this run has no such figure" in judged(wanted, summary)[0].words()
    before = dict(summary)
    add_requirements(summary, ())
    assert summary == before
    add_requirements(summary, wanted)
    assert summary["requirements_met"] is False
    assert summary["requirements"][kind]["margin"] is None


@pytest.mark.parametrize(
    ("entry", "message"),
    [
        ({"gap": 1.0}, "requirements.gap is not a known key; .*least_gap"),
        ({"heat": "5 mm"}, "heat = '5 mm' has the unit mm"),
        ({"heat": -1.0}, "must be at least 0 J"),
        ({"ball_pressure": 4}, "ball_pressure = 4 is out of .* in Pa, write such as '4 GPa'"),
        ({"stroke": 0.1}, "stroke = 0.1 is out of proportion; it must be 0 to 0.02 m"),
    ],
)
def test_mistakes_are_one_line(entry: dict[str, object], message: str) -> None:
    with pytest.raises(TouchdownError, match=message):
        read_requirements(Table("requirements.", entry))


NAMED = """
extends = "disk-caged-simplified"
[[gap]]
name = "seal A"
at = "rotor.A"
radial = "0.35 mm"
[[gap]]
name = "impeller"
at = "rotor.A"
axial = "0.3 mm"
[requirements]
least_gap = { limit = "20 um", clause = "4.1", impeller = 5e-5, "seal A" = { limit = 3e-4, clause = "S" } }
temperature.A = "80 K"
settling_time = { limit = "1 s", A = "0.5 s" }
sensitivity = 3
"""


def load(folder: Path, text: str) -> Scene:
    (folder / "own.toml").write_text(text, encoding="utf-8")
    return touchdown.load(folder / "own.toml")


def test_one_gap_or_bearing_is_limited_by_its_name(tmp_path: Path) -> None:
    """A clause is printed with its limit; what no drop tells is not judged by one."""
    scene = load(tmp_path, NAMED)
    gaps = {"seal A": {"least": 1e-4}, "impeller": {"least": 2e-4}}
    warm = touched(1.0) | {"largest_temperature_rise": 20.0, "settling_time": 0.75}
    summary = {"least_gap": 1e-4, "settling_time": 0.8, "gaps": gaps, **seats(A=warm)}
    words = [one.words() for one in judged(scene.requirements, summary)]
    assert words[:3] == [
        "least gap left of all: 100 um, at least 20 um (4.1): met, 80 um to spare",
        "least gap left, impeller: 200 um, at least 50 um: met, 150 um to spare",
        "least gap left, seal A: 100 um, at least 300 um (S): not met, 200 um beyond the limit",
    ]
    assert words[3:] == [
        "largest temperature rise, A: 20 K, at most 80 K: met, 75 % to spare",
        "settling time of all seats: 0.8 s, at most 1 s: met, 20 % to spare",
        "settling time, A: 0.75 s, at most 0.5 s: not met, 50 % beyond the limit",
    ]
    add_requirements(summary, scene.requirements)
    assert summary["requirements"]["least_gap.seal A"]["margin"] == pytest.approx(-2.0 / 3.0)
    assert requirement_lines([Member(1, {}, summary)])[3].startswith("    least gap left, seal A: 0 of 1 ")


@pytest.mark.parametrize(
    ("entry", "message"),
    [
        ('least_gap = { "seal B" = "20 um" }', "there is no seal B; did you mean seal A"),
        ('stroke = { clause = "4" }', "requirements.stroke.limit is missing; it must be a number in m"),
        ('stroke = { A = { limits = 1 } }', "requirements.stroke.A.limits is not a known key"),
        ('sensitivity = { limit = 3, A = 4 }', "requirements.sensitivity.A is not a known key"),
        ('stroke = { limit = 1e-4, clause = 4 }', "requirements.stroke.clause = 4 must be text"),
    ],
)  # fmt: skip
def test_what_is_not_there_cannot_be_limited(entry: str, message: str, tmp_path: Path) -> None:
    with pytest.raises(TouchdownError, match=message):
        load(tmp_path, NAMED.partition("least_gap")[0] + entry)


def test_a_bearing_that_is_not_there_is_refused_before_the_run(tmp_path: Path) -> None:
    scene = load(tmp_path, NAMED.replace("temperature.A", "temperature.B"))
    with pytest.raises(TouchdownError, match="there is no B; there are: A"):
        touchdown.run(scene, in_process=True)
    with pytest.raises(TouchdownError, match="there is no B; there are: A"):
        touchdown.sweep(scene, {"rotor.x": [0.0, 1e-6]}, tmp_path / "sweep", in_process=True)


def test_the_zone_of_the_loops_is_judged_by_their_margins(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Of the disk it is 2.485 (`tests/studies/loop`), in zone A; --require fails above the limit."""
    for limit, said, status in ((3, "met", 0), (2, "not met", STOPPED)):
        text = 'extends = "disk-caged-relevitated"\n[requirements]\n'
        load(tmp_path, f'{text}sensitivity = {{ limit = {limit}, clause = "ISO 14839-3" }}')
        words = ["amb-margins", str(tmp_path / "own.toml"), "--speeds", "9000 rpm", "--require"]
        assert main([*words, "-o", str(tmp_path / "loop")]) == status
        out = capsys.readouterr().out
        assert f"peak of the loops' sensitivity: 2.485, at most {limit} (ISO 14839-3): {said}, " in out


def test_what_the_loops_are_judged_by_is_not_passed_by_a_drop(tmp_path: Path) -> None:
    text = 'extends = "disk-caged-simplified"\n[requirements]\nsensitivity = 3\n'
    both = load(tmp_path, f'{text}contact_force = "1000 kN"').set({"run.duration": "10 ms"})
    dropped = touchdown.run(both, in_process=True)
    passed = "PASSES its requirement of a drop (`touchdown amb-margins` judges the loops); nearest"
    assert dropped.headline.startswith(passed)
    (_, of_loops) = requirements(Subject(dropped))["wanted"]
    assert of_loops.endswith(": judged by `touchdown amb-margins`.")
    speeds = [one.speed for one in loops_in(both, [100.0]).speeds]
    assert speeds == pytest.approx([0.0, 100.0, 0.5 * speeds[-1], speeds[-1]])
    with pytest.raises(TouchdownError, match="requires nothing to rank by"):
        touchdown.rank(load(tmp_path, text), bearings="6904")


def test_a_run_is_judged(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """In the summary, on the console, by the status where asked; and found again in its scene."""
    (tmp_path / "own.toml").write_text(SCENE, encoding="utf-8")
    run = [
        "run",
        str(tmp_path / "own.toml"),
        "--in-process",
        "--duration",
        "12 ms",
        "-o",
        str(tmp_path / "r"),
    ]
    assert main([*run, "--no-pictures", "--quiet"]) == 0
    said = capsys.readouterr().out
    assert "N, at most 400 N: met, 13.6 % to spare" in said
    beyond = (
        r"largest stroke of the housing: 2\.0\d+ um, at most 1 um: not met, 1\.0\d+ um beyond the limit"
    )
    assert re.search(beyond, said)
    assert re.match(r"FAILS: largest stroke of the housing, 2\.0\d+ um of at most 1 um\. No whirl ", said)
    assert main([*run, "--no-pictures", "--quiet"]) == 0
    said = capsys.readouterr().out
    assert "N, at most 400 N: met, 13.6 % to spare" in said
    assert re.search(
        r"largest stroke of the housing: 2\.0\d+ um, at most 1 um: not met, 1\.0\d+ um beyond the limit",
        said,
    )
    assert main([*run, "--no-pictures", "--quiet", "--require"]) == STOPPED
    summary = touchdown.open_result(tmp_path / "r").summary
    assert summary["requirements_met"] is False
    assert summary["requirements"]["contact_force"]["margin"] == pytest.approx(
        1.0 - summary["seats"]["A"]["peak_contact_force"] / 400.0
    )
    assert read_resolved(tmp_path / "r" / "scene.json").requirements == (
        Requirement("contact_force", 400.0),
        Requirement("stroke", 1e-6),
    )


def test_over_a_sweep() -> None:
    """Shares with their exact interval; margins at worst and in the median."""
    met = (True, 0.5), (True, 0.25), (False, -0.5), (True, 0.75)
    members = [Member(k, {}, heat(*one)) for k, one in enumerate(met)]
    assert requirement_lines(members) == [
        "  requirements met: 3 of 4 (75 %; 19.4 % to 99.4 % with 95% confidence)",
        "    heat in the bearing: 3 of 4 (75 %; 19.4 % to 99.4 % with 95% confidence), margin -50 % at "
        "worst, 37.5 % in the median",
    ]
    assert requirement_lines([Member(0, {}, {})]) == []


def test_a_drop_that_failed_meets_nothing() -> None:
    """Whatever its figures say until then; one that was not run does not count."""
    members = [
        Member(1, {}, heat(True, 0.5)),
        Member(2, {}, heat(True, 0.9), "stopped", Ended.STOPPED),
        Member(3, {}, {}, "crashed", Ended.STOPPED),
        Member(4, {}, {}, "not run", Ended.INTERRUPTED),
    ]
    assert requirement_lines(members) == [
        "  requirements met: 1 of 3 (33.3 %; 0.84 % to 90.6 % with 95% confidence)",
        "    heat in the bearing: 1 of 3 (33.3 %; 0.84 % to 90.6 % with 95% confidence), margin 50 % at "
        "worst, 50 % in the median",
    ]


def test_a_least_gap_needs_a_gap(tmp_path: Path) -> None:
    text = 'extends = "disk-caged-simplified"\n[requirements]\nleast_gap = "20 um"\n'
    (tmp_path / "own.toml").write_text(text, encoding="utf-8")
    with pytest.raises(TouchdownError, match="least_gap has no gap to look at; add"):
        touchdown.load(tmp_path / "own.toml")


def test_what_is_not_known_of_an_untouched_seat_counts_unless_contact_makes_it() -> None:
    both = seats(A=touched(1.0) | {"housing_stroke": 1e-6}, B=untouched() | {"housing_stroke": None})
    stroke, force = judged([Requirement("stroke", 1e-4), Requirement("contact_force", 2.0)], both)
    assert stroke.found is None
    assert force.found == 1.0


def test_a_bearing_that_was_not_recorded_is_not_passed_by_the_other(tmp_path: Path) -> None:
    text = """
    extends = "rotor1-9000"
    [run]
    duration = "10 ms"
    record = ["rotor", "bearing_A"]
    [requirements]
    ball_pressure = "4 GPa"
    heat = "100 J"
    stroke = "1 mm"
    """
    (tmp_path / "own.toml").write_text(text, encoding="utf-8")
    summary = touchdown.run(touchdown.load(tmp_path / "own.toml"), in_process=True).summary
    assert summary["seats"]["A"]["largest_ball_pressure"] > 0.0
    for kind in ("ball_pressure", "heat", "stroke"):
        assert summary["requirements"][kind]["margin"] is None
    assert summary["requirements_met"] is False
