"""A new machine from a few words: what is written, what it does, what is refused."""

from __future__ import annotations

import math
import shlex
import tomllib
from pathlib import Path

import numpy as np
import pytest

import touchdown
from touchdown.bearings.catalogue import bearing, bearing_file_text
from touchdown.bearings.contact.line import FROM_GEOMETRY
from touchdown.command.cli import main
from touchdown.master.common.errors import FAILED, TouchdownError
from touchdown.master.coupling.simulation import opened
from touchdown.master.scene.requirements import KINDS
from touchdown.rotor.file import load_rotor, shipped_rotors
from touchdown.studies.machine.new import Wanted, machine

ROTOR = """
title = 'The "drawn" rotor'

[material.steel]
modulus = "207 GPa"
density = "7830 kg/m3"
poisson = 0.3

[[element]]  # as drawn
count = 8
length = "120 mm"
outer_diameter = "68 mm"

[[disc]]
node = 5
outer_diameter = "300 mm"
inner_diameter = "68 mm"
width = "40 mm"

[[unbalance]]
node = 5
moment = "300 g.mm"

[stations]
A = 2  # drive end
B = 8
"""
BRIEF = {"run.duration": "2 ms", "amb_*.shutdown_time": "1 ms"}


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The user's folder, with a rotor's file."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "rotor.toml").write_text(ROTOR, encoding="utf-8")
    return tmp_path


def made(*more: str) -> int:
    """`touchdown new mine` with the rotor on 7014s and magnets at A and B; its exit status."""
    at = ("--bearings", "7014", "--at", "A,B", "--amb", "A,B")
    return main(["new", "mine", "--rotor", "rotor.toml", *at, *more])


def test_it_runs_at_once_and_each_value_stands_once(here: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A magnetic bearing at the place of another gets a station; of the rotor's file all else stays."""
    assert made() == 0
    assert "touchdown run mine" in capsys.readouterr().out
    scene = touchdown.load("mine")
    assert scene.title == 'The "drawn" rotor dropped at 10000 rpm'
    assert touchdown.run(scene.set(BRIEF), in_process=True).summary["completed"]
    tables = tomllib.loads((here / "mine" / "scene.toml").read_text(encoding="utf-8"))
    own = [name for name, part in tables["components"].items() if "set" in part or "preset" in part]
    assert own == ["rotor"]
    assert list(tables["set"]) == ["amb_*", "bearing_*", "housing_*"]
    text = (here / "mine" / "rotor.toml").read_text(encoding="utf-8")
    assert "[[element]]  # as drawn" in text
    assert "A = 2  # drive end" in text
    before, after = load_rotor("rotor.toml"), load_rotor("mine/rotor.toml")
    assert after.levitated_at == ("amb_A", "amb_B")
    assert {s.name: s.node for s in after.stations} == {"A": 2, "B": 8, "amb_A": 2, "amb_B": 8}
    assert (after.elements, after.points) == (before.elements, before.points)


def test_the_rules_that_are_said_are_kept(here: Path) -> None:
    made("--clearance", "0.3 mm", "--speed", "9000 rpm")
    scene, rotor = touchdown.load("mine"), load_rotor("rotor.toml")
    with opened(scene, in_process=True) as system:
        value = system.value
        stiffness, held = value("amb_A.stiffness"), 0.5 * rotor.mass
        assert math.sqrt(stiffness / held) / (2.0 * math.pi) == pytest.approx(60.0, rel=0.02)
        assert value("amb_B.force_limit") == pytest.approx(6.0 * 9.81 * held, rel=0.05)
        assert value("bearing_B.journal_radius") == pytest.approx(35e-3 - 0.3e-3)
        assert value("bearing_A.balls.count") == 20
        assert value("bearing_A.contact.law") == FROM_GEOMETRY
        assert value("bearing_A.contact.length") == pytest.approx(20e-3)
        assert value("rotor.speed") == pytest.approx(300.0 * math.pi)
        assert value("housing_A.outer_ring") == pytest.approx(bearing("7014").outer_ring, rel=2e-3)
        housing = value("housing_A.stiffness") / value("housing_A.mass")
        assert math.sqrt(housing) / (2.0 * math.pi) == pytest.approx(500.0, rel=0.02)
        stiff = {
            name: value(f"housing_B.{name}") for name in ("mass", "stiffness", "damping", "outer_ring")
        }
    made("--clearance", "0.3 mm", "--mount", "stiff", "--force")  # which is the housing
    with opened(touchdown.load("mine"), in_process=True) as system:
        for name, own in (
            ("mass",) * 2,
            ("stiffness", "spring.yy"),
            ("damping", "damper.xx"),
            ("outer_ring",) * 2,
        ):
            assert system.value(f"housing_B.{own}") == stiff[name]


def test_what_stands_as_a_comment_can_be_made_true(here: Path) -> None:
    """All requirements, the cover of the report, and a gap."""
    assert made() == 0
    path = here / "mine" / "scene.toml"
    text, _, examples = path.read_text(encoding="utf-8").partition("# [requirements]")
    names = "# of one gap or bearing alone: "
    lines = [line.removeprefix("# ") for line in examples.splitlines() if not line.startswith(names)]
    path.write_text("\n".join([f"{text}[requirements]{lines[0]}", *lines[1:]]), encoding="utf-8")
    scene = touchdown.load(here / "mine")
    assert [one.kind for one in scene.requirements] == list(KINDS)
    assert scene.document.machine
    assert [gap.name for gap in scene.gaps] == ["seal"]


def test_other_bearings_than_the_catalogue_s_first(here: Path) -> None:
    """Two unlike ones keep what is different; one of a file of one's own goes along."""
    assert made("--bearings", "7014,6014") == 0
    scene = touchdown.load("mine")
    assert [scene.components[f"bearing_{end}"].preset for end in "AB"] == ["7014", "6014"]
    with opened(scene, in_process=True) as system:
        assert system.value("bearing_A.damping") == 300.0  # the rule
        assert system.value("bearing_B.damping") == 300.0  # the source's table
        assert system.value("housing_B.outer_ring") == pytest.approx(0.3)
    own = bearing_file_text(bearing("7014")).replace('["7014', '["ours')
    (here / "bearings.toml").write_text(own, encoding="utf-8")
    scene = touchdown.new("other", "ours", rotor="rotor.toml", at="A,B", amb="A,B")
    assert (here / "other" / "bearings.toml").read_text(encoding="utf-8") == own
    assert scene.components["bearing_A"].preset == f"{here / 'other' / 'bearings.toml'}:ours"


def test_a_soft_mount_by_its_rules(here: Path) -> None:
    """A rotor at rest sinks a twentieth of the clearance; friction takes most from a circle of a tenth."""
    assert made("--mount", "soft") == 0
    scene = touchdown.load("mine")
    assert scene.components["housing_A"].fmu == "mount"
    rotor = load_rotor("rotor.toml")
    with opened(scene, in_process=True) as system:
        value = system.value
        weight, clearance = 0.5 * 9.81 * rotor.mass, value("bearing_A.clearance")
        spring, slide = value("housing_A.spring.xx"), value("housing_A.slide[1].stiffness")
        assert weight / spring == pytest.approx(0.05 * clearance, rel=0.05)
        assert value("housing_B.spring.yy") == spring
        reach = value("housing_A.slide[1].force") / slide
        assert math.sqrt(2.0) * reach == pytest.approx(0.1 * clearance, rel=0.05)
        assert value("housing_A.mass") == pytest.approx(10.0 * bearing("7014").outer_ring, rel=0.05)
        assert value("housing_A.stop.gap") == pytest.approx(0.5 * clearance, rel=0.05)
    summary = touchdown.run(scene.set(BRIEF), in_process=True).summary
    assert summary["completed"]
    assert summary["seats"]["A"]["stop_hits"] == 0


def test_a_mount_of_a_file(here: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """As `rank` takes it; `new` writes what stands there."""
    text = (
        '[set."housing_*"]\nmass = "0.5 kg"\nspring = { xx = 1e7, yy = 2e7 }\n"slide[2].force" = "30 N"\n'
    )
    (here / "ribbon.toml").write_text(text, encoding="utf-8")
    assert made("--mount", "ribbon.toml") == 0
    with opened(touchdown.load("mine"), in_process=True) as system:
        assert system.value("housing_A.spring.yy") == 2e7
        assert system.value("housing_B.slide[2].force") == 30.0
        assert system.value("housing_B.mass") == 0.5
    capsys.readouterr()
    (here / "two.toml").write_text(
        "[set.housing_A]\nmass = 1\n[set.housing_B]\nmass = 1\n", encoding="utf-8"
    )
    for wrong, said in (("softer", "did you mean soft"), ("two.toml", "one mount for all is taken")):
        assert made("--mount", wrong) == 2
        assert said in capsys.readouterr().err


@pytest.mark.parametrize("name", sorted(shipped_rotors()))
def test_a_rotor_that_comes_along_needs_no_places(name: str) -> None:
    """Its own are taken, and its file stays as it is; without a rotor, places and mass are asked for."""
    files = machine(Wanted(["7014"], name), "mine").files
    assert files["rotor.toml"] == shipped_rotors()[name].read_text(encoding="utf-8")
    for wanted, said in (
        (Wanted(["6014"]), "--mass such as"),
        (Wanted(["6014"], at=["A"], mass=60.0), "give --rotor, too"),
    ):
        with pytest.raises(TouchdownError, match=said):
            machine(wanted, "mine")


@pytest.mark.parametrize(
    ("bearing", "model", "harmonics", "said"),
    [
        ("71909 AC", "simplified_caged", -1, "the inner ring bends"),
        (
            "71909 DB",
            "angular_simplified",
            0,
            "rigid: a ring with a contact angle also twists, which is left out",
        ),
    ],
)
def test_a_ring_bends_where_its_row_has_no_angle_in_the_drop(
    here: Path, bearing: str, model: str, harmonics: int, said: str
) -> None:
    """A single row of angular contact runs as a radial one; its growth is written where it matters."""
    new = ["new", "one", "--mass", "14 kg", "--bearings", bearing]
    assert main([*new, "--speed", "32000 rpm"]) == 0
    text = (here / "one" / "scene.toml").read_text()
    (line,) = (line for line in text.splitlines() if "ring.harmonics" in line)
    assert said in line
    scene = touchdown.load("one")
    assert scene.components["bearing"].fmu == model
    with opened(scene, in_process=True) as system:
        if model == "angular_simplified":
            assert system.value("bearing.balls.contact_angle") == pytest.approx(math.radians(15.0))
        assert system.value("bearing.ring.harmonics") == harmonics
        assert system.value("bearing.ring.growth") == 1


def test_a_rigid_rotor_on_a_pair_with_a_contact_angle(here: Path) -> None:
    assert main(["new", "disk", "--mass", "60 kg", "--bearings", "71907 DB"]) == 0
    found = touchdown.run(touchdown.load("disk").set({"run.duration": "8 ms"}), in_process=True)
    assert found.summary["seats"]["A"]["peak_ball_force"] > 100.0
    assert np.max(found.recording["bearing.along.contact_angle"]) > 0.2


PAIR = ("--bearings", "B=61909, A=71909 AC/HC DB", "--speed", "32000 rpm", "--clearance", "0.2 mm")


@pytest.mark.parametrize(
    ("more", "inclination"), [((), 0.0), (("--axial", "A", "--inclination", "90 deg"), 0.5 * math.pi)]
)
def test_a_pair_stops_the_rotor_along_its_shaft(
    here: Path, more: tuple[str, ...], inclination: float
) -> None:
    """Lying and upright: faces by the preset, an axial magnetic bearing, gaps both ways, growth by spin."""
    slim = ROTOR.replace("68 mm", "42 mm").replace("120 mm", "40 mm").replace("300 mm", "120 mm")
    (here / "rotor.toml").write_text(slim, encoding="utf-8")
    assert made(*PAIR, *more) == 0
    scene = touchdown.load("mine")
    assert scene.inclination == (pytest.approx(inclination) if inclination else None)
    assert [scene.components[f"bearing_{end}"].fmu for end in "AB"] == [
        "angular_simplified",
        "simplified_caged",
    ]
    with opened(scene, in_process=True) as system:
        value = system.value
        assert value("rotor.axial") == value("bearing_A.ring.growth") == value("bearing_B.ring.growth") == 1
        assert value("bearing_A.ring.hoop") == value("bearing_A.balls.centrifugal") == 1
        # from 22.5 mm to a fifth of a ball's diameter above a groove of (56.5 - 6.9)/2 mm
        assert value("bearing_A.shoulder.radius") == pytest.approx(0.5 * (22.5e-3 + 24.8e-3 + 1.38e-3))
        assert value("bearing_A.shoulder.gap_minus") == value("bearing_A.shoulder.gap_plus") == 0.2e-3
        assert [value(f"bearing_{end}.balls.material") for end in "AB"] == [1, 0]
        held = value("amb_A.axial.stiffness") / load_rotor("mine/rotor.toml").mass
        assert math.sqrt(held) / (2.0 * math.pi) == pytest.approx(60.0, rel=0.04)
        assert value("amb_B.axial.stiffness") == 0.0
    gaps = [(gap.name, gap.radial, gap.axial, gap.stator) for gap in scene.gaps]
    size, seat = pytest.approx(0.3e-3), "housing_A.seat"
    assert gaps == [("seal", size, None, seat), ("impeller", None, size, seat)]
    summary = touchdown.run(scene.set({**BRIEF, "run.duration": "7 ms"}), in_process=True).summary
    assert ((summary["seats"]["A"]["peak_face_force"] or 0.0) > 100.0) == bool(inclination)
    assert 0.0 < summary["gaps"]["impeller"]["least"] < (0.1e-3 if inclination else 0.3e-3)


def test_a_mount_gives_along_the_shaft_as_across(here: Path) -> None:
    """A carrier by a rule or of a file without `axial` as rubber in shear; a stiff one as a housing."""
    spring, slide = (
        'spring.yy = "5 MN/m"\ndamper.yy = 50\n',
        '"slide[1]" = { stiffness = 3e6, force = 9 }\n',
    )
    file = f'[set."housing_*"]\n{spring}{slide}'
    (here / "rings.toml").write_text(file, encoding="utf-8")
    (here / "own.toml").write_text(file + "axial.stiffness = 1e6\n", encoding="utf-8")
    new = ["new", "disk", "--force", "--mass", "14 kg", "--bearings", "71909 DB", "--mount"]
    expected = {"rings.toml": (0.4 * 8e6, 20.0), "own.toml": (1e6, 2500.0), "stiff": None, "soft": None}
    for mount, along in expected.items():
        assert main([*new, mount]) == 0
        with opened(touchdown.load("disk"), in_process=True) as system:
            found = [system.value(f"housing.axial.{name}") for name in ("stiffness", "damping")]
            spring, slide = system.value("housing.spring.yy"), system.value("housing.slide[1].stiffness")
            across = (spring + slide, system.value("housing.damper.yy"))
        share = 1.0 if mount == "stiff" else 0.4
        assert found == pytest.approx(along or [share * one for one in across], rel=0.02)


def test_files_that_are_there_stay(here: Path, capsys: pytest.CaptureFixture[str]) -> None:
    made()
    scene = here / "mine" / "scene.toml"
    scene.write_text("mine", encoding="utf-8")
    assert made() == FAILED
    assert "is there already; choose another folder, or --force" in capsys.readouterr().err
    assert scene.read_text(encoding="utf-8") == "mine"
    assert made("--force") == 0


def test_a_rotor_that_lies_in_the_folder_stays(
    here: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Nothing of it has to be changed; where something has, that is for --force."""
    mine = here / "mine"
    mine.mkdir()
    text = ROTOR.replace("B = 8", "B = 8\namb_A = 3\namb_B = 7")
    held = text.replace("[material.steel]", 'levitated_at = ["amb_A", "amb_B"]\n[material.steel]')
    (mine / "rotor.toml").write_text(held, encoding="utf-8")
    (here / "other.toml").write_text(text, encoding="utf-8")
    assert main(["new", "mine", "--rotor", "mine/rotor.toml", "--bearings", "7014"]) == 0
    assert (mine / "rotor.toml").read_text(encoding="utf-8") == held
    assert main(["new", "other.toml", "--rotor", "mine/rotor.toml", "--bearings", "7014"]) == FAILED
    assert "other.toml is a file" in capsys.readouterr().err
    (mine / "inner").mkdir()
    monkeypatch.chdir(mine / "inner")
    assert touchdown.load("..").name == "mine"  # a folder goes by its name, wherever it is named from


@pytest.mark.parametrize(
    ("places", "said"),
    [
        (
            "B = 8\n[sensors]\namb_A = 3\n",
            "the rotor with the places of its magnetic bearings: sensors.amb_A = 3 has",
        ),
        ("B = 8\namb_A = 5\n", "has a station amb_A elsewhere"),
    ],
)
def test_a_name_that_is_taken_is_said(
    here: Path, places: str, said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    """The name that a magnetic bearing's place would get, by a sensor or a station."""
    (here / "rotor.toml").write_text(ROTOR.replace("B = 8\n", places), encoding="utf-8")
    assert made() == FAILED
    told = capsys.readouterr().err.strip()
    assert said in told
    assert "\n" not in told


def test_what_to_know_of_the_rotor_is_said(here: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A bearing beside the centre of mass, a journal thicker than its bore, no unbalance."""
    text = ROTOR.replace("A = 2  # drive end", "A = 7").replace("300 g.mm", "0 g.mm")
    (here / "rotor.toml").write_text(text, encoding="utf-8")
    assert made("--bearings", "7014", "--clearance", "1.5 mm") == 0
    notes = [line for line in capsys.readouterr().out.splitlines() if line.startswith("note: ")]
    assert [note.split()[1:4] for note in notes] == [
        ["at", "rest", "bearing_B"],
        ["the", "rotor", "is"],
        ["the", "rotor", "is"],
        ["the", "rotor", "has"],
    ]
    with pytest.warns(match="would have to pull the rotor down"), pytest.warns(match="no unbalance"):
        touchdown.new("again", "7014", rotor="rotor.toml", at=["A", "B"], amb=["A", "B"])


@pytest.mark.parametrize(
    ("options", "says"),
    [
        (["--at", "A,C"], '--at C: The "drawn" rotor has no such station; there are: A, B'),
        (["--at", "A"], "--at A: name two stations of the rotor or more, each once; there are: A, B"),
        (["--amb", "A,A"], "--amb A,A: name two stations"),
        (["--amb", ""], "--amb is empty; give names, with commas between them"),
        (["--bearings", "7999"], "there is no bearing 7999; did you mean"),
        (["--bearings", "7004"], "7004 cannot be mounted at A: its bore is 20 mm, the rotor 68 mm thick"),
        (["--bearings", "7014,7014,7014"], "names 3 bearings for 2 places"),
        (["--bearings", ""], "--bearings is empty"),
        (["--rotor", "no.toml"], "cannot read no.toml"),
        (["--rotor", "rotor_X"], "there is no rotor called rotor_X"),
        (["--clearance", "20 mm"], "leaves no journal in the bore of 7014, 70 mm"),
        (["--speed", "9000 rpx"], "--speed = '9000 rpx' has the unit rpx"),
        (["--mass", "60 kg"], "are of a rigid rotor"),
        (["--bearings", "A=7014, 7014"], "--bearings A=7014, 7014: give all as STATION=NAME, or none"),
        (
            ["--bearings", "A=7014, C=7014"],
            "are at A and C, and the rotor is held at A and B; name each once",
        ),
        (
            ["--bearings", "7014 DB", "--axial", "C"],
            "--axial C: no touchdown bearing is there; there are: A",
        ),
        (["--axial", "A"], "--axial A: 7014 is a single row of angular contact; take a pair, 7014 DB, or"),
        (
            ["--inclination", "90 deg"],
            "--inclination: nothing stops the rotor along its shaft; name a station",
        ),
    ],
)
def test_a_mistake_is_one_line(
    options: list[str], says: str, here: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert made(*options) == FAILED
    said = capsys.readouterr().err.strip()
    assert says in said
    assert "\n" not in said
    assert not (here / "mine").exists()


@pytest.mark.parametrize(
    ("options", "says"),
    [
        (
            "--mass '12000 kg' --bearings 6004",
            "bearing carries 118 kN at rest, more than the static rating of 6004, C0 = ",
        ),
        ("--mass '2 kg' --bearings 6004 --speed 20000", "speed = 190986 rpm"),
        ("--mass '9 kg' --bearings 6204 --speed 45000", "speed 45000 has no unit: it is taken for rad/s"),
        ("--mass '9 kg' --bearings 6204 --speed '4.5e4 rpm'", ""),
    ],
)
@pytest.mark.usefixtures("here")
def test_what_cannot_be_meant_is_said_before_how_to_run_it(
    options: str, says: str, capsys: pytest.CaptureFixture[str]
) -> None:
    """Of a rigid rotor; with a unit, nothing is said of units, however fast that is."""
    assert main(["new", "mine", *shlex.split(options)]) == 0
    told = capsys.readouterr().out
    assert ("note: " in told) == bool(says)
    assert told.find(f"note: {says}") < told.index("now run it with")
    assert says in told
    assert ("has no unit" in told) == ("has no unit" in says or options.endswith("20000"))
    with opened(touchdown.load("mine"), in_process=True) as system:
        radius, mass = system.value("bearing.journal_radius"), system.value("rotor.mass")
        assert system.value("rotor.inertia") == pytest.approx(mass * radius**2, rel=1e-2)


def test_stations_that_levitate_are_no_places_of_touchdown_bearings(here: Path) -> None:
    (here / "rotor.toml").write_text(ROTOR.replace("B = 8\n", "B = 8\nL = 3\nR = 6\n"), encoding="utf-8")
    touchdown.new("mine", "7014", rotor="rotor.toml", amb=["L", "R"])
    scene = touchdown.load("mine/scene.toml")
    assert {"bearing_A", "bearing_B", "amb_L", "amb_R"} <= set(scene.components)
    assert not {"bearing_L", "bearing_R"} & set(scene.components)


def test_two_bearings_of_one_name_are_refused(here: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (here / "rotor.toml").write_text(
        ROTOR.replace("B = 8\n", "B = 8\namb_B = 6\nR = 3\n"), encoding="utf-8"
    )
    assert made("--at", "A,R", "--amb", "amb_B,B") == FAILED
    assert "two bearings would be called amb_B; rename a station" in capsys.readouterr().err
