"""What a report says of a run."""

from __future__ import annotations

import base64
import html
import json
import re
import shlex
import shutil
import sys
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from commands import Command
from places import ROOT

import touchdown
from touchdown.command.cli import main
from touchdown.master.common.errors import Ended, TouchdownError
from touchdown.master.quantities import Summary, summary_items
from touchdown.master.results.required import add_requirements
from touchdown.master.scene.file import restored
from touchdown.master.scene.requirements import Requirement
from touchdown.master.scene.scene import Document
from touchdown.reports.chapters.basis import model
from touchdown.reports.chapters.contact import forces
from touchdown.reports.chapters.summary import summary
from touchdown.reports.contents import CHAPTERS, SHORT, scope, section
from touchdown.reports.layout import rendered
from touchdown.reports.numbers import RPM, digits, digits_of, head, quantity, speed
from touchdown.reports.page import report_on
from touchdown.reports.series import IMPACT_ROWS, MAX_ROWS, chosen_rows
from touchdown.reports.subject import Subject
from touchdown.reports.sweeps import _drops, _is_sample, _spread, _summary, report_on_sweep
from touchdown.studies.sweep.definition import Column, Definition
from touchdown.studies.sweep.members import Member
from touchdown.studies.sweep.results import Sweep


def test_a_run_is_read_back_as_it_was(dropped: Path) -> None:
    """And its scene can be run again."""
    scene = touchdown.load(dropped / "scene.json").set({"run.duration": "10 ms"})
    left = touchdown.run(scene, dropped.parent / "again", in_process=True)
    first = touchdown.open_result(dropped).ending.value("bearing.contact.first_time")
    assert left.recording.at_end("bearing.contact.first_time") == first
    back = touchdown.open_result(left.folder)
    assert back.scene == left.scene
    assert (back.summary, back.ended, back.warnings) == (left.summary, left.ended, left.warnings)
    assert back.ending == left.ending
    assert list(back.recording.time) == list(left.recording.time)


def test_every_chapter_is_there_or_says_why_not(page: Path) -> None:
    """The page asks for nothing beside it."""
    text = page.read_text(encoding="utf-8")
    for chapter in CHAPTERS:
        assert f'<section id="{chapter.name}"' in text
    lacking = re.findall(r'<p class="lacking">Not in this report: (.*)</p>', text)
    # requirements, environment, along, levitation, spectra, mounts, stresses, inspection
    assert len(lacking) == 8
    assert "the rotor has none: it is rigid" in " ".join(lacking)
    assert not set(re.findall(r'(?:src|href)="(?!#|data:)([^"]*)"', text))
    assert "url(http" not in text
    assert page.stat().st_size < 2_000_000


def test_no_text_of_a_scene_or_a_run_becomes_markup(dropped: Path) -> None:
    result, text = touchdown.open_result(dropped), "<script>alert(1)</script> `a<i>b`"
    scene = replace(result.scene, title=text, about=text)
    told = {"ended": Ended.STOPPED, "stopped_because": text, "warnings": [text]}
    summary = result.summary | {"not_audited": text}
    page = rendered("page.html", {"page": report_on(replace(result, scene=scene, summary=summary, **told))})
    assert "<script>alert" not in page
    assert "a<i>b" not in page
    escaped = "&lt;script&gt;alert(1)&lt;/script&gt; <code>a&lt;i&gt;b</code>"
    assert page.count(escaped) == 5  # headline, the summary's two remarks, about, accounts


def test_settings_tell_where_they_come_from(dropped: Path) -> None:
    chapter = next(c for c in CHAPTERS if c.name == "settings")
    found = chapter.tell(Subject(touchdown.open_result(dropped)))
    parts = [row for part in found["parts"] for row in (*part["chosen"], *part["defaults"])]
    rows = {row[0]: row for row in (*found["run"], *parts)}
    assert rows["bearing.clearance"][1:3] == ["250\N{NO-BREAK SPACE}µm", "set for this run"]
    assert rows["bearing.balls.count"][1:3] == ["9", "catalogue"]
    assert rows["rotor.mass"][2] == "scene"
    assert rows["run.duration"][2] == "set for this run"
    assert rows["run.scheme"][1:] == ["interface", "default"]


def test_a_rotor_without_unbalance_has_no_phase(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for file in ("spindle.toml", "spindle_rotor.toml"):
        shutil.copy(ROOT / "examples" / file, tmp_path)
    scene, rotor = tmp_path / "spindle.toml", tmp_path / "spindle_rotor.toml"
    for unbalance, phases in (("10 g.mm", "touchdown verdict"), ("0 g.mm", "does not depend on its phase")):
        rotor.write_text(rotor.read_text("utf-8").replace("10 g.mm", unbalance), "utf-8")
        folder = tmp_path / unbalance
        run = ["run", str(scene), "--duration", "20 ms", "--in-process", "--no-pictures", "-o", str(folder)]
        assert main(run) == 0
        assert phases in capsys.readouterr().out
        chapter = next(c for c in CHAPTERS if c.name == "summary")
        said = section(chapter, Subject(touchdown.open_result(folder))).html
        one_phase = "<li>This is one phase of the unbalance"
        assert (one_phase in said) == (unbalance == "10 g.mm")


def test_the_command_repeats_the_run(dropped: Path, page: Path) -> None:
    text = page.read_text(encoding="utf-8")
    assert "touchdown run disk-caged-simplified --set run.duration=0.06" in text
    found = re.search(r'href="data:application/json;base64,([^"]+)"', text)
    assert found is not None
    inside = json.loads(base64.b64decode(found[1]))
    assert inside["components"] == json.loads((dropped / "scene.json").read_text())["components"]


def test_lines_of_a_scene_s_about_stay_and_wrapped_prose_does_not(dropped: Path) -> None:
    subject = Subject(touchdown.open_result(dropped))
    about = "By rules.\nA: 2 A\nof 4 A.\n- one\n- two\n"
    scene = replace(subject.result.scene, about=about)
    told = model(replace(subject, result=replace(subject.result, scene=scene)))
    assert told["about"] == ["By rules.", "A: 2 A of 4 A.", "- one", "- two"]
    assert "By rules.<br>A: 2 A of 4 A.<br>" in rendered("chapters/model.html", told)
    assert "magnetic bearings after the shutdown" in rendered("chapters/model.html", told)


@pytest.mark.slow
def test_the_sweep_over_what_is_assumed_runs(dropped: Path, tmp_path: Path) -> None:
    """As the page prints it: drag and damping of the balls, each none and some."""
    chapter = next(c for c in CHAPTERS if c.name == "model")
    said = section(chapter, Subject(touchdown.open_result(dropped))).html
    (code,) = re.findall("<code>(touchdown sweep .*)</code>", html.unescape(said))
    assert "bearing.rolling.resistance=0,0.0015" in code
    words = shlex.split(code)[1:]
    assert main([*words, "--duration", "8 ms", "--jobs", "1", "--quiet", "-o", str(tmp_path)]) == 0
    assert len(touchdown.open_sweep(tmp_path).members) == 4


def test_what_touches_nothing_is_reported(tmp_path: Path) -> None:
    scene = touchdown.load("disk-caged-simplified").set({"run.duration": "4 ms"})
    page = touchdown.report(touchdown.run(scene, in_process=True), tmp_path / "none.html")[0]
    assert "touches no bearing within 0.004 s" in page.read_text(encoding="utf-8")
    with pytest.raises(touchdown.TouchdownError, match="nothing touched"):
        touchdown.animate(touchdown.run(scene, in_process=True), tmp_path / "none.gif")


def test_a_sweep_is_reported(command: Command, tmp_path: Path) -> None:
    changes = {"run.duration": "9 ms", "rotor.speed": 1000}
    scene = touchdown.load("disk-caged-simplified").set(changes)
    varied = {"bearing.clearance": ["0.2 mm", "0.25 mm"]}
    touchdown.sweep(scene, varied, tmp_path / "sweep", jobs=1, in_process=True)
    assert command("report", tmp_path / "sweep").status == 0
    assert "a sweep, which has no short report" in command("report", tmp_path / "sweep", "--short").line
    text = (tmp_path / "sweep" / "report.html").read_text(encoding="utf-8")
    text = text.replace("\N{NO-BREAK SPACE}", " ")
    assert "0 of 2 drops whirl (0 %; as drops drawn one by one, 0 % to 84 % of all with 95 %" in text
    assert "Each is followed for 9 ms from the shutdown on, 1" in text
    assert "All else is as scene disk-caged-simplified has it, but for what was set for the sweep: " in text
    assert "rotor.speed = 1000 rad/s (9549.3 rpm); run.duration = 0.009 s.</p>" in text
    assert "speed = 1000 rad/s (9549.3 rpm): 2 drops over clearance of the bearing</h1>" in text
    assert ">Largest contact force, A [N]</th>" in text
    assert "peak_contact_force" not in text
    assert "The map of stress: not in this report" in text
    assert "all drops ran to their end" in text
    found = touchdown.open_sweep(tmp_path / "sweep")
    assert f"<code>touchdown run {found.folder} --member 1</code>" in text
    none = replace(found, members=tuple(replace(m, summary={}, failed="it broke") for m in found))
    (page,) = touchdown.report(none, tmp_path / "none.html")
    assert "No drop of 2 has a verdict. 2 of 2 drops failed" in page.read_text(encoding="utf-8")


def test_a_sweep_is_judged(tmp_path: Path) -> None:
    """By its decision, by requirements of which what fails comes first, and by the worst drop of each."""
    wanted = (("heat", 100.0), ("least_gap", 50e-6))
    members = []
    for number, (heat, gap) in enumerate([(20.0, 80e-6), (30.0, -5e-6), (90.0, 60e-6)], start=1):
        seat = {"first_contact_time": 0.01, "bearing_heat": heat}
        told: Summary = {"seats": {"A": seat}, "gaps": {"seal": {"least": gap}}, "least_gap": gap}
        add_requirements(told, [Requirement(*one) for one in wanted])
        members.append(Member(number, {"rotor.unbalance_angle": number}, told))
    values = tuple((one.settings["rotor.unbalance_angle"],) for one in members)
    scene = touchdown.load("disk-caged-simplified").resolved() | {"requirements": wanted}
    column = Column("rotor.unbalance_angle", ("rotor.unbalance_angle",), "rad")
    asked = Definition((column,), values, values, "", scene, {}, {}, True, "made up", (), ())
    sweep = Sweep(asked, tuple(members), tmp_path / "drops")
    page = report_on_sweep(sweep)
    assert page.headline.startswith("FAILS in 1 of 3 drops, most often by least gap left of all (1). ")
    assert page.title.endswith(": 3 drops over unbalance angle of the rotor")
    assert [(one["label"], one["value"], one["met"]) for one in _summary(sweep)["limits"]] == [
        ("Least gap left of all", "2 of 3", False),
        ("Heat in the bearing", "3 of 3", True),
    ]
    beyond = "5\N{NO-BREAK SPACE}µm beyond it at most"
    assert _summary(sweep)["warnings"] == [f"Gap seal is rubbed in 1 of 3 drops, {beyond}."]
    rows = [[row[2], row[4].replace("\N{NO-BREAK SPACE}", " "), row[5]] for row in _drops(sweep)["worst"]]
    run = f"touchdown run {tmp_path / 'drops'} --member"
    assert rows[0] == ["2", "55 µm beyond the limit", f"{run} 2"]
    assert rows[3] == ["3", "10 % to spare", f"{run} 3"]


def test_a_speed_that_rounding_leaves_is_none() -> None:
    assert [speed(one) for one in (5e-7, -5e-7, 0.105, None)] == ["0 rpm", "0 rpm", "1.0027 rpm", "–"]


def test_figures_go_by_words() -> None:
    """Of what and in which unit stands with them, as a report spells it."""
    seat = {"peak_contact_force": 1.0, "peak_indentation_rings": 1e-6, "whirl": "no whirl"}
    summary = {
        "seats": {"A": seat, "rotor_B": {"whirl_force_phase": 0.1}},
        "components": {"rotor": {"speed_end": 100.0}},
        "energy_made": 0.1,
    }
    assert [head(item) for item in summary_items(summary)] == [
        "Rotor's speed at the end, rotor [rpm]",
        "Largest contact force, A [N]",
        "Largest approach of the rings, A [µm]",
        "Whirl, A",
        "Phase by which the force drives the whirl, rotor_B [deg]",
        "Energy error of the coupling [J]",
    ]


def test_a_peak_says_how_firm_it_is(dropped: Path) -> None:
    """By its spread where there is one, else whether it is that of the first impact."""
    result = touchdown.open_result(dropped)
    seat = result.summary["seats"]["A"]
    (peak,) = (i for i in summary_items(result.summary) if i.quantity.key == "peak_contact_force")
    alike = seat["peak_contact_force"] == seat["first_impact_contact_force"]
    said = "in the first impact" if alike else "one draw of a chaotic drop"
    assert Subject(result).firmness(peak) == said
    draws = {"least": 900.0, "median": 1000.0, "most": 1200.0}
    spread = {"siblings": 4, "apart": 1e-9, "quantities": {"seats.A.peak_contact_force": draws}}
    said = Subject(replace(result, summary=result.summary | {"spread": spread})).firmness(peak)
    assert said.replace("\N{NO-BREAK SPACE}", " ") == (
        "900 N to 1.2 kN, median 1 kN, over 5 drops started nanometres apart"
    )


def test_the_true_peak_is_a_dot_of_the_chart(dropped: Path) -> None:
    """At the row from which on no force was larger; kept where rows are left out."""
    subject = Subject(touchdown.open_result(dropped))
    curve, dot = forces(subject)["force"].chart.lines
    (row,) = np.flatnonzero(np.isfinite(dot.values))
    peak = subject.summary["seats"]["A"]["peak_contact_force"]
    assert (curve.dot, dot.dot, dot.values[row]) == (False, True, peak)
    assert curve.values.max() <= peak
    assert dot.label == f"largest at A, {quantity(peak, 'N', 3)}"


def test_what_is_assumed_begins_with_friction_mount_and_clearance(dropped: Path) -> None:
    rows = model(Subject(touchdown.open_result(dropped)))["assumed"]
    assert [row[0] for row in rows[:4]] == [
        *("bearing.friction.dynamic", "housing.stiffness", "housing.damping", "bearing.clearance"),
    ]
    assert rows[3][2:4] == ["250\N{NO-BREAK SPACE}µm", "set for this run"]


def test_warnings_speak_of_seats_each_once(dropped: Path) -> None:
    result = touchdown.open_result(dropped)
    line = "bearing: it is 5 um off; try --set bearing.micro_step=1e-06"
    (said,) = summary(Subject(replace(result, warnings=[line, line])))["warnings"]
    assert said == "At A it is 5\N{NO-BREAK SPACE}µm off; try `--set bearing.micro_step=1e-06`."


def test_requirements_are_the_first_tiles(dropped: Path) -> None:
    """What fails is red, with a full bar, before what is met; the headline begins with it."""
    result = touchdown.open_result(dropped)
    wanted = Requirement("ball_force", 1e4), Requirement("contact_force", 100.0)
    judged = replace(result, scene=replace(result.scene, requirements=wanted))
    failed, met = summary(Subject(judged))["limits"]
    assert (failed["met"], failed["used"], met["met"]) == (False, 100, True)
    assert "Largest ball load" not in [label for label, *_ in summary(Subject(judged))["figures"]]
    page = rendered("page.html", {"page": report_on(judged)})
    assert page.index('<p class="headline failed">FAILS: largest contact force, ') < page.index("<h1>")
    assert page.count('<div class="failed"><dt>Largest contact force</dt>') == 1


def test_the_short_form_answers_the_scope_item_by_item(dropped: Path) -> None:
    """Of the same run, without scripts; clauses in tiles, and on the cover what the scene has, as text."""
    result = touchdown.open_result(dropped)
    wanted = (Requirement("ball_force", 1e4, "spec <4>"), Requirement("sensitivity", 3.0))
    scene = replace(result.scene, requirements=wanted, document=Document(customer="A <i>& B", revision="C"))
    page = rendered("page.html", {"page": report_on(replace(result, scene=scene), short=True)})
    assert re.findall(r'<section id="(\w+)"', page) == [chapter.name for chapter in SHORT]
    assert re.findall(r"<div><dt>(Machine|Customer|Author|Revision)</dt><dd>(.*?)</dd>", page) == [
        ("Customer", "A &lt;i&gt;&amp; B"),
        ("Revision", "C"),
    ]
    assert "<script" not in page
    assert "met: at most 10000 N (spec &lt;4&gt;); " in page
    assert "peak of the loops&#39; sensitivity, at most 3." in page
    items = {row[0][0]: row for row in scope(Subject(result))["rows"]}
    assert "".join(items) == "abcdefghi"
    assert items["a"][1:] == ("The machine", [])
    assert items["b"][1] == ""  # this scene requires nothing
    assert [one.title for one in items["d"][2]] == ["Environment"]
    assert {row[2] for row in SHORT[-1].tell(Subject(result))["rows"]} == {
        *("catalogue", "scene", "set for this run")
    }


def test_a_document_stays_with_the_run(tmp_path: Path) -> None:
    text = 'extends = "disk-caged-simplified"\n[document]\n'
    (tmp_path / "own.toml").write_text(text + 'author = "M. M."\n', encoding="utf-8")
    scene = touchdown.load(tmp_path / "own.toml")
    left = json.loads(json.dumps(scene.resolved(), default=str))
    assert restored(left).document == Document(author="M. M.")
    (tmp_path / "own.toml").write_text(text + 'autor = "M. M."\n', encoding="utf-8")
    with pytest.raises(TouchdownError, match=r"document\.autor is not a known key; did you mean author"):
        touchdown.load(tmp_path / "own.toml")


def test_a_spread_can_be_told_apart_and_has_no_mean_of_nodes(tmp_path: Path) -> None:
    """Speeds that differ by little keep the difference; of nodes and their like there are no quartiles."""
    nodes = [{"peak_shear_stress_node": 3 + 8 * (n > 1), "kept_bending_x_node": 3 + n} for n in range(3)]
    rotors = [{"speed_end": (19995.5 + n) / RPM} | one for n, one in enumerate(nodes)]
    told = [{"components": {"rotor": one}, "energy_made": 1.0 + n} for n, one in enumerate(rotors)]
    members = tuple(Member(n, {}, summary) for n, summary in enumerate(told, start=1))
    told = _spread(Sweep(SimpleNamespace(), members, tmp_path))  # type: ignore[arg-type]
    assert [row[1:] for row in told["rows"]] == [["3", "19995.5", "19996", "19996.5", "19997", "19997.5"]]
    assert told["places"] == [["Largest shear stress, at node, rotor", "3 in 2 drops, 11 in 1 drop"]]
    assert [row[0] for row in told["others"]] == ["Energy error of the coupling [J]"]


def test_only_drops_drawn_one_by_one_tell_of_all() -> None:
    """Those of several phases at each drawn point are not independent of each other."""
    drawn = touchdown.Design.random({"bearing.clearance": "0.2:0.3 mm"}, 8, seed=1)
    phases = touchdown.Design.grid({"rotor.unbalance_angle": ["0 deg", "180 deg"]})
    assert _is_sample(drawn.about)
    assert not _is_sample((drawn * phases).about)
    assert not _is_sample(phases.about)
    assert not _is_sample(touchdown.Design.sobol({"bearing.clearance": "0.2:0.3 mm"}, 8, seed=1).about)


def test_the_rows_of_a_chart_keep_all_peaks() -> None:
    random = np.random.default_rng(1)
    time = np.linspace(0.0, 5.0, 200_001)
    columns = [random.normal(size=time.size) for _ in range(3)]
    columns[0][123_456] = 99.0
    columns[2][-1] = -99.0
    rows = chosen_rows(time, columns, 1.0)
    assert len(rows) <= MAX_ROWS + 10
    assert {0, 123_456, time.size - 1} <= set(rows.tolist())
    first = int(np.searchsorted(time, 1.0))
    assert set(range(first, first + IMPACT_ROWS // 2)) <= set(rows.tolist())


@pytest.mark.parametrize(
    ("value", "unit", "text"),
    [
        (0.00025, "m", "250 µm"),
        (1.5e9, "Pa", "1.5 GPa"),
        (2.4e9, "N/m^n", "2.4·10⁹ N/mⁿ"),
        (0.0, "m", "0 mm"),
        (1e-23, "m", "0 mm"),
        (25500.0, "1", "25\N{NARROW NO-BREAK SPACE}500"),
        (-3.2e-7, "J", "\N{MINUS SIGN}0.32 µJ"),
        (None, "s", "–"),
    ],
)
def test_numbers_are_readable(value: float | None, unit: str, text: str) -> None:
    assert quantity(value, unit).replace("\N{NO-BREAK SPACE}", " ") == text
    assert digits(float("inf")) == "∞"
    assert digits_of([-1e-17, 250.0]) == ("0", "250")


def test_what_cannot_be_reported_is_one_line(
    command: Command, tmp_path: Path, dropped: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Also where there is no browser for a PDF, and no ffmpeg for a film."""
    assert "there is no folder" in command("report", tmp_path / "nowhere").line
    (tmp_path / "empty").mkdir()
    assert "no summary.json" in command("report", tmp_path / "empty").line
    assert "is a folder" in command("report", dropped, "-o", tmp_path).line
    assert "ends in .html" in command("report", dropped, "-o", tmp_path / "drop.pdf").line
    assert "ends in .mp4 or .gif" in command("animate", dropped, "-o", tmp_path / "drop.avi").line
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", None)
    assert "is on the PATH" in command("report", dropped, "--pdf", "-o", tmp_path / "x.html").line
    assert "an .mp4 takes ffmpeg" in command("animate", dropped, "-o", tmp_path / "x.mp4").line


def test_a_sweep_is_proposed_of_settings_that_there_are() -> None:
    """Balls that are bodies have no drag by rolling."""
    scene = touchdown.load("disk-upright-caged").set({"run.duration": "0.1 ms"})
    data = model(Subject(touchdown.run(scene, in_process=True)))
    proposed = re.findall(r"--vary '?(\S*)=", str(data))
    assert proposed == ["bearing.balls.damping_ratio"]
