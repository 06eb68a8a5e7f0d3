"""Which bearing is best: what is run, how it is ranked, what is refused."""

from __future__ import annotations

from pathlib import Path

import pytest
from places import ROOT

import touchdown
from touchdown.command.cli import main
from touchdown.master.common.errors import Ended, TouchdownError
from touchdown.master.coupling.assembly import OF_A_BEARING
from touchdown.master.scene.scene import Scene
from touchdown.studies.machine.rank import (
    Candidate,
    Ranking,
    Spread,
    assumptions,
    candidates,
    notes,
    rank,
    ranked,
    read_table,
    rows_of,
    seats_of,
)
from touchdown.studies.sweep.design import Design
from touchdown.studies.sweep.members import Member

SCENE = """
extends = "disk-caged-simplified"
[requirements]
ball_pressure = "2.4 GPa"
[set.bearing]
contact.law = "line"
"""


@pytest.fixture
def scene(tmp_path: Path) -> Scene:
    (tmp_path / "own.toml").write_text(SCENE, encoding="utf-8")
    return touchdown.load(tmp_path / "own.toml")


def member(number: int, *margins: float | None, failed: str = "") -> Member:
    """A drop with margins of heat and stroke; None: it does not tell."""
    told = {name: {"margin": one} for name, one in zip(("heat", "stroke"), margins, strict=False)}
    met = bool(margins) and all(margin is not None and margin >= 0.0 for margin in margins)
    return Member(number, {}, {"requirements_met": met, "requirements": told} if margins else {}, failed)


def test_the_share_comes_first_then_the_worst_margin() -> None:
    """Two bearings that keep to all in one drop of two, and one that fails once."""
    chosen = [Candidate(name, "", {}) for name in ("a", "b", "c")]
    drops = [(0.1, 0.2), (-0.3, 0.5)], [(0.1, 0.2), (-0.2, 0.5)], [(0.9, 0.9), ()]
    members = [
        member(k, *margins, failed="" if margins else "stopped")
        for k, margins in enumerate(one for bearing in drops for one in bearing)
    ]
    found = ranked(chosen, members)
    assert [one.candidate.bearing for one in found] == ["b", "a", "c"]
    assert found[0].worst == (pytest.approx(-0.05), "heat")
    assert [one.failed for one in found] == [0, 0, 1]
    assert found[0].passing.value == 0.5
    table = list(Ranking(found).lines())
    assert "heat in the bearing, -5 %" in table[2]
    assert "1 of 2 drops failed" in table[4]


def test_a_drop_that_failed_keeps_to_none(tmp_path: Path) -> None:
    """Also where its figures until then do; what is not told is no number."""
    members = [member(1, 0.9, 0.9, failed="stopped"), member(2, 0.1, 0.1), member(3, 0.1, None)]
    found = ranked([Candidate(name, "", {}) for name in ("a", "b", "c")], members)
    assert [one.candidate.bearing for one in found] == ["b", "a", "c"]
    assert [one.passing.value for one in found] == [1.0, 0.0, 0.0]
    assert "largest stroke of the housing, not known" in list(Ranking(found).lines())[4]
    assert read_table(tmp_path) == []
    found = ranked([Candidate("a", "soft", {}, 9.0, ("x", "y"))], members[:1])  # without a finite margin
    Ranking(found).write(tmp_path)
    assert read_table(tmp_path) == rows_of(found)


def test_what_the_ranking_rests_on() -> None:
    """A bearing that is too fast for every cage; a mount that leaves what another one sets."""
    slow, fast = (Candidate(name, "", {}, 1.0, cages) for name, cages in (("a", ("bronze",)), ("b", ())))
    said = list(assumptions([slow, fast]))
    assert "a bearing's own drops alone" in said[0]
    assert said[1].startswith("b: faster than makers run any cage for long")
    soft = Candidate("a", "soft", {"bearing.preset": "a", "housing.stiffness": 1e6})
    damped = Candidate("a", "damped", {"bearing.preset": "a", "housing.damping": 1e3})
    told = list(assumptions([soft, damped]))[1:]
    assert told == [
        "mount soft says nothing of housing.damping: the scene's values stay",
        "mount damped says nothing of housing.stiffness: the scene's values stay",
    ]


def test_what_is_said_beside_the_table() -> None:
    """Drops that ended in the air, failures and warnings."""
    touched, untouched = ({"seats": {"A": {"first_contact_time": time}}} for time in (0.01, None))
    landed = Member(1, {}, touched, warnings=("stays",))
    members = [landed, Member(2, {}, untouched), Member(3, {}, {}, "stopped")]
    said = list(notes(ranked([Candidate("a", "", {})], members)))
    assert said[0].startswith("1 of 2 drops ended before the rotor touched a bearing")
    assert said[1:] == ["failed:", "  1 x stopped (drop 3)", "warnings:", "  1 x stays (drop 1)"]
    assert list(notes(ranked([Candidate("a", "", {})], [landed]))) == said[3:]


def test_all_take_the_same_drops(scene: Scene) -> None:
    """Each bearing in each mount; what follows from the bearing goes with it, the journal stays."""
    asked: list[Design] = []

    def run(_: Scene, design: Design) -> list[Member]:
        asked.append(design)
        return [Member(k, {}, {}, "", Ended.COMPLETED) for k in range(len(design))]

    mounts = {"soft": {"housing.stiffness": 1e6}, "stiff": {"housing.stiffness": 1e9}}
    found = rank(scene, ["6004", "6304"], mounts, Spread(drops=3), run)
    assert len(found.candidates) == 4
    (design,) = asked
    points = [dict(zip(design.names, point, strict=True)) for point in design.points]
    assert len(points) == 12
    drawn = [{k: v for k, v in p.items() if k.endswith(("friction.dynamic", ".clearance"))} for p in points]
    assert drawn[:3] == drawn[3:6] == drawn[9:]
    assert [p["bearing.preset"] for p in points[::3]] == ["6004", "6004", "6304", "6304"]
    assert points[0]["housing.stiffness"] == 1e6
    assert points[0]["bearing.contact.load"] != points[6]["bearing.contact.load"]
    assert "bearing.journal_radius" not in points[0]


def test_seats_have_bearings_of_their_own() -> None:
    """Every combination; what is not named stays, or takes --bearings; seats go by the rotor's port."""
    scene = touchdown.load("rotor1-9000")
    seats, _ = seats_of(scene)
    preset = "bearing_A.preset"
    found = candidates(scene, seats, [], {}, {"A": ["6014", "7014"], "bearing_B": ["6014", "61914"]})
    assert [one.bearing for one in found] == [
        f"A={a}, bearing_B={b}" for a in ("6014", "7014") for b in ("6014", "61914")
    ]
    assert [one.settings[preset] for one in found] == ["6014", "6014", "7014", "7014"]
    alone = candidates(scene, seats, [], {}, {"A": ["6014"]})
    assert "bearing_B.preset" not in alone[0].settings
    rest = candidates(scene, seats, ["61914"], {}, {"A": ["6014"]})
    assert [one.bearing for one in rest] == ["A=6014, others=61914"]
    assert rest[0].settings["bearing_B.preset"] == "61914"
    for at, said in (
        ({"C": ["6014"]}, "--at C: there is no such"),
        ({"A": ["6014"] * 2}, "6014 twice"),
    ):
        with pytest.raises(TouchdownError, match=said):
            candidates(scene, seats, [], {}, at)
    with pytest.raises(TouchdownError, match="names bearing_A twice"):
        candidates(scene, seats, [], {}, {"A": ["6014"], "bearing_A": ["7014"]})


def test_the_answer_says_what_fails_and_mounts_stand_beside_each_other() -> None:
    chosen = [Candidate(name, mount, {}) for name in ("a", "b") for mount in ("soft", "stiff")]
    drops = (-0.3, 0.5), (0.1, -0.2), (-0.1, 0.5), (-0.6, 0.2)
    lines = list(Ranking(ranked(chosen, [member(k, *one) for k, one in enumerate(drops)])).lines())
    assert lines[0].startswith("None meets all requirements in every drop; closest is b in soft, in 0 %")
    assert "heat in the bearing, -10 %" in lines[0]
    soft, stiff = (next(line for line in lines if line.startswith(one)) for one in ("soft", "stiff"))
    assert soft.split() == ["soft", "0", "%", "-20", "%", "50", "%"]
    assert stiff.split() == ["stiff", "0", "%", "-25", "%", "0", "%"]
    good = list(Ranking(ranked([Candidate("a", "", {})], [member(0, 0.1, 0.2)])).lines())
    assert good[0] == "a ranks first: it meets all requirements in each of its 1 drops."
    assert not any("all bearings" in line for line in good)


def test_it_ranks_and_goes_on(scene: Scene, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """By the command; a second time nothing is run again, and the answer is the same."""
    asked = ["rank", str(tmp_path / "own.toml"), "--bearings", "6004, 6304", "--drops", "2", "--jobs", "1"]
    asked += ["--duration", "9 ms", "-o", str(tmp_path / "runs"), "--quiet"]
    said: list[str] = []
    for _ in range(2):
        assert main(asked) == 0
        said.append(capsys.readouterr().out)
    assert said[0] == said[1]
    assert "largest pressure on a race" in said[0]
    rows = (tmp_path / "runs" / "rank.csv").read_text(encoding="utf-8").splitlines()
    assert len(rows) == 3
    page = (tmp_path / "runs" / "report.html").read_text(encoding="utf-8")
    assert "ranks first" in page
    assert "machined phenolic or polyamide-imide" in page
    assert scene.requirements[0].kind == "ball_pressure"


@pytest.mark.parametrize(
    ("names", "message"),
    [
        (["6001"], "6001 has a bore of 12 mm; journal and clearance at bearing take 20 mm"),
        (["9999"], "there is no bearing 9999"),
        (["6004", "6004"], "--bearings has 6004 twice"),
        (["71904 DB"], "71904 DB is a pair with a contact angle, and bearing is planar"),
        ([], "--bearings is missing"),
    ],
)
def test_what_cannot_be_chosen_is_refused(
    scene: Scene, names: list[str], message: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(TouchdownError, match=message):
        rank(scene, names, {}, Spread(), lambda _, __: [])
    with pytest.raises(TouchdownError, match="requires nothing to rank by; add"):
        rank(touchdown.load("disk-caged-simplified"), ["6004"], {}, Spread(), lambda _, __: [])
    mounts = []  # two of one name
    for folder in "ab":
        (tmp_path / folder).mkdir()
        (tmp_path / folder / "mount.toml").write_text("[set.housing]\nstiffness = 1e7\n", encoding="utf-8")
        mounts += ["--mount", str(tmp_path / folder / "mount.toml")]
    assert main(["rank", str(scene.folder / "own.toml"), "--bearings", "6004", *mounts]) == 2
    assert "there is a mount mount already; rename one" in capsys.readouterr().err


def test_what_hangs_on_a_bearing_is_derived_for_each_rotor_of_a_file_too(tmp_path: Path) -> None:
    """Its mass is known once the system is initialised."""
    rotor = ROOT / "examples" / "spindle_rotor.toml"
    scene = touchdown.new(tmp_path / "spindle", "7004", rotor=str(rotor))
    seats, _ = seats_of(scene)
    found, bearing = candidates(scene, seats, ["6004", "7004"], {}), seats[0].component
    loads = [one.settings[f"{bearing}.contact.load"] for one in found]
    written = {f"{bearing}.{name}" for name in OF_A_BEARING if name in scene.components[bearing].set}
    assert f"{bearing}.damping" in written
    assert all(written <= one.settings.keys() for one in found)  # nothing stays of the scene's bearing
    assert loads[0] != loads[1]
    known = float(str(scene.components[bearing].set["contact.load"]).split()[0])
    assert loads[1] == pytest.approx(known, rel=0.3)  # both seats as one, each half the rotor


def test_a_damping_known_of_one_bearing_alone_is_that_one_s(scene: Scene) -> None:
    """The 6014 has its own, from Halminen (2016); beside it, the 6214 takes what the scene assumes."""
    scene.components["bearing"].set["damping"] = 123.0
    known, assumed = candidates(scene, seats_of(scene)[0], ["6014", "6214"], {})
    assert known.settings["bearing.damping"] == 300.0
    assert assumed.settings["bearing.damping"] == 123.0
    assert known.settings.keys() == assumed.settings.keys()  # points of one table


def test_a_preset_beside_a_scene_says_what_stays(tmp_path: Path) -> None:
    """Of what the scene has for another bearing; not what is set along with it."""
    text = 'extends = "disk-caged-simplified"\n[set.bearing]\ncontact.stiffness = 2.4e9\ndamping = 300\n'
    (tmp_path / "own.toml").write_text(text, encoding="utf-8")
    scene = touchdown.load(tmp_path / "own.toml").set({"run.duration": "1 ms"})

    def said(settings: dict[str, object]) -> str:
        return "\n".join(touchdown.run(scene.set(settings), in_process=True).warnings)

    assert "preset" not in said({})
    assert (
        "bearing.preset = 6304 is set beside the scene, which has contact.stiffness, damping for"
        in said({"bearing.preset": "6304"})
    )
    assert "which has damping for" in said({"bearing.preset": "6304", "bearing.contact.stiffness": 3e9})
