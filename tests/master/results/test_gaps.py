"""Gaps around the rotor: what is left of them, when, how often they close, and what is refused."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from stub import MACHINE, STUB

import touchdown
from touchdown.command.cli import main
from touchdown.master.common.errors import TouchdownError
from touchdown.master.quantities import Summary
from touchdown.master.results.final_state import Finished
from touchdown.master.results.least_gaps import add_gaps, left_of, unforced
from touchdown.master.scene.file import read_resolved
from touchdown.master.scene.gaps import RotorGap, read_gaps
from touchdown.modelkit.reader import Table
from touchdown.reports.chapters.summary import summary as summed_up
from touchdown.reports.figures import plot
from touchdown.reports.figures.style import sheet
from touchdown.reports.page import report_on
from touchdown.reports.subject import Subject

SCENE = """
extends = "disk-caged-simplified"
[[gap]]
name = "AMB A"
at = "rotor.amb"
radial = "0.5 mm"
[[gap]]
name = "impeller shroud"
at = "rotor.A"
radial = "0.29 mm"
stator = "housing.seat"
"""


@pytest.fixture(scope="module")
def dropped(tmp_path_factory: pytest.TempPathFactory) -> touchdown.Result:
    """A disk that falls 0.3 mm into its bearing, and bounces."""
    folder = tmp_path_factory.mktemp("gaps")
    (folder / "own.toml").write_text(SCENE, encoding="utf-8")
    scene = touchdown.load(folder / "own.toml").set({"run.duration": "30 ms"})
    return touchdown.run(scene, folder / "run", in_process=True)


def test_the_least_is_that_of_the_way(dropped: touchdown.Result) -> None:
    """Of recorded places, and of a cubic between them: some nanometres less."""
    summary, recording = dropped.summary, dropped.recording
    far = np.hypot(recording["rotor.amb.x"], recording["rotor.amb.y"])
    gap = summary["gaps"]["AMB A"]
    assert gap["least"] == pytest.approx(500e-6 - far.max(), abs=3e-7)
    assert gap["least"] <= 500e-6 - far.max()
    assert gap["touches"] == 0
    assert gap["least_rotor_speed"] == pytest.approx(9000.0 * np.pi / 30.0, rel=2e-3)


def test_a_stator_that_moves_counts(dropped: touchdown.Result) -> None:
    """Against the housing, which the landing pushes down: 0.3 mm and the bearing's give close 0.29 mm."""
    found = left_of(RotorGap("one", "rotor.A", 0.29e-3, "housing.seat"), dropped.recording)
    x, y = (dropped.recording[f"rotor.A.{k}"] - dropped.recording[f"housing.seat.{k}"] for k in "xy")
    assert found.left.min() == pytest.approx(0.29e-3 - np.hypot(x, y).max(), abs=3e-7)
    assert dropped.summary["gaps"]["impeller shroud"]["touches"] >= 1
    assert dropped.summary["least_gap_at"] == "impeller shroud"
    assert any("gap impeller shroud (0.29 mm at rotor.A) is closed" in w for w in dropped.warnings)
    finished = Finished(dropped.scene, dropped.ending, dropped.recording)
    figure = sheet()
    dict(plot._pictures(finished))["gaps"](figure)
    titles = [axes.get_title(loc="left") for axes in figure.axes]
    assert titles == ["AMB A, 0.5 mm", "impeller shroud, 0.29 mm"]
    (dot,) = (line for line in figure.axes[1].lines if line.get_marker() == "o")
    least = dropped.summary["gaps"]["impeller shroud"]
    assert [*dot.get_xydata()[0]] == pytest.approx([least["least_time"], 1e6 * least["least"]])


def test_times_count_from_the_shutdown_once(dropped: touchdown.Result) -> None:
    """Recorded times begin 5 ms before 0; the landing comes after the first contact."""
    summary, recording = dropped.summary, dropped.recording
    assert recording.time[0] == pytest.approx(-0.005)
    far = np.hypot(recording["rotor.amb.x"], recording["rotor.amb.y"])
    step = float(np.diff(recording.time).max())
    assert summary["gaps"]["AMB A"]["least_time"] == pytest.approx(recording.time[far.argmax()], abs=step)
    assert recording.time[far.argmax()] > summary["seats"]["A"]["first_contact_time"]


def test_the_first_of_the_drop_counts() -> None:
    """A gap that closes sooner after the shutdown than that came after the start."""

    class Way(dict):  # type: ignore[type-arg]
        time = np.linspace(-5e-3, 10e-3, 16)

    way = Way({"r.A.x": np.where(np.isclose(Way.time, 2e-3), 1.5e-3, 0.0), "r.A.y": np.zeros(16)})
    scene = replace(touchdown.load("disk-caged-simplified"), gaps=(RotorGap("one", "r.A", 1e-3),))
    summary: Summary = {}
    add_gaps(summary, scene, way)  # type: ignore[arg-type]
    gap = summary["gaps"]["one"]
    assert gap["touches"] == 1
    assert gap["least"] == pytest.approx(-500e-6)
    assert gap["least_time"] == gap["closed_time"] == pytest.approx(2e-3)
    ((time, said),) = unforced(scene, summary)
    assert time == pytest.approx(2e-3)
    assert said == "one is rubbed, where no force acts in this run"
    acting = replace(scene, gaps=(replace(scene.gaps[0], journal_radius=9e-3),))
    assert [*unforced(acting, summary)] == [*unforced(scene, {})] == []


def test_figures_without_a_gaps_force_are_said_first(
    dropped: touchdown.Result, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """In the report's headline, on the console and in the summary as Python shows it."""
    until = dropped.summary["valid_until"]
    assert until == dropped.summary["gaps"]["impeller shroud"]["closed_time"]
    assert "gaps.impeller shroud.least" in dropped.summary["invalid_figures"]
    assert [row[3].endswith(" (not valid)") for row in summed_up(Subject(dropped))["gaps"]] == [True, True]
    said = f"Figures are valid until {until:.4g} s after the shutdown, when impeller shroud is rubbed"
    first = dropped.headline
    assert re.match(rf"FAILS: impeller shroud is rubbed \([\d.]+ um beyond its gap\)\. {said}", first)
    assert repr(dropped).splitlines()[0] == f"Result of {dropped.scene.name}. {first}"
    assert report_on(dropped).headline == first.replace(" um", "\N{NO-BREAK SPACE}µm")
    scene = tmp_path / "gaps.toml"
    scene.write_text(SCENE, encoding="utf-8")
    arguments = ["run", str(scene), "--in-process", "--quiet", "--no-pictures", "--duration", "40 ms"]
    main([*arguments, "-o", str(tmp_path / "out")])
    assert capsys.readouterr().out.startswith("FAILS: impeller shroud is rubbed (")


def test_a_circle_between_few_points_is_followed() -> None:
    """Radius 1 mm, 8 recorded points a turn: the cubic's radius is off by 1e-3 of it at most."""

    class Way(dict):  # type: ignore[type-arg]
        time = np.linspace(0.0, 1.0, 9)

    turns = 2.0 * np.pi * Way.time
    way = Way({
        "r.A.x": 1e-3 * np.cos(turns), "r.A.y": 1e-3 * np.sin(turns),
        "r.A.vx": -2e-3 * np.pi * np.sin(turns), "r.A.vy": 2e-3 * np.pi * np.cos(turns),
    })  # fmt: skip
    left = left_of(RotorGap("one", "r.A", 2e-3), way).left  # type: ignore[arg-type]
    assert len(left) == 65
    assert left == pytest.approx(1e-3, abs=2e-6)


def test_a_fall_and_a_tilt_close_an_axial_gap(tmp_path: Path) -> None:
    """By g t^2/2 + R w t; the housing sags before, and by 1 nm more under the ring."""
    scene = """
        extends = "disk-upright-pair"
        [components.rotor.set]
        speed = 0
        transverse_inertia = 1e-3
        wx = 0.06
        wy = -0.08
        [[gap]]
        name = "impeller"
        at = "rotor.A"
        axial = "0.14 mm"
        radius = "10 mm"
        stator = "housing.seat"
        """
    (tmp_path / "own.toml").write_text(scene, encoding="utf-8")
    fallen, sag, rate = 5e-3, 5.042 * 9.81 / 2.5e8, 10e-3 * 0.1
    run = touchdown.load(tmp_path / "own.toml").set({"run.duration": fallen, "run.record_every": 4})
    result = touchdown.run(run, in_process=True)
    (gap,) = result.scene.gaps
    found = left_of(gap, result.recording)
    expected = 0.14e-3 - np.abs(4.905 * found.time**2 - sag) - rate * found.time
    assert found.left == pytest.approx(expected, abs=2e-9)
    values = result.summary["gaps"]["impeller"]
    assert values["least"] == pytest.approx(0.14e-3 - 4.905 * fallen**2 + sag - rate * fallen, abs=2e-9)
    assert values["least_time"] == pytest.approx(fallen)
    assert values["touches"] == 0
    later = touchdown.run(run.set({"run.duration": "8 ms"}), tmp_path / "run", in_process=True)
    assert later.summary["gaps"]["impeller"]["closed_time"] == pytest.approx(5.2454e-3, abs=5e-5)
    (said,) = (w for w in later.warnings if "impeller" in w)
    assert said.endswith("No force acts there in this run")
    figure = sheet()
    dict(plot._pictures(Finished(later.scene, later.ending, later.recording)))["gaps"](figure)
    assert figure.axes[0].get_title(loc="left") == "impeller, 0.14 mm along the shaft"


def test_it_is_left_and_found_again(dropped: touchdown.Result) -> None:
    """The scene as it was run has its gaps, as one of before that has none is read."""
    left = read_resolved(dropped.folder / "scene.json")
    assert [gap.name for gap in left.gaps] == ["AMB A", "impeller shroud"]
    values = json.loads((dropped.folder / "scene.json").read_text(encoding="utf-8"))
    del values["gaps"]
    (dropped.folder / "older.json").write_text(json.dumps(values), encoding="utf-8")
    assert read_resolved(dropped.folder / "older.json").gaps == ()


@pytest.mark.parametrize(
    ("entry", "message"),
    [
        ({"name": "AMB"}, r"gap\[1\].at is missing; it must be the name of a place on a rotor, such as"),
        ({"name": "AMB", "at": "rotor.A", "radial": "0 mm"}, "radial = '0 mm' must be above 0 m"),
        ({"name": "AMB", "at": "rotor.A"}, "name = 'AMB' needs one of radial and axial"),
        ({"name": "AMB", "at": "rotor.A", "radial": 1e-3, "axial": 1e-3}, "needs one of radial and axial"),
        ({"name": "AMB", "at": "rotor.A", "axial": 1e-3, "journal_radius": 1e-2}, "is of a radial gap"),
        ({"name": "AMB", "at": "rotor.A", "radial": 1e-3, "radius": 1e-2}, "is of an axial gap"),
        ({"name": "a/b", "at": "rotor.A", "radial": 1e-3}, "name = 'a/b' must be a name of letters"),
        ({"name": "AMB", "at": "rotor.A", "radial": 1e-3, "hits": 1}, r"gap\[1\].hits is not a known key"),
    ],
)
def test_mistakes_are_one_line(entry: dict[str, object], message: str) -> None:
    with pytest.raises(TouchdownError, match=message):
        read_gaps(Table("", {"gap": [entry]}).tables("gap"))


def test_a_place_that_is_none_is_refused(tmp_path: Path) -> None:
    (tmp_path / "own.toml").write_text(SCENE.replace("rotor.amb", "rotor.B"), encoding="utf-8")
    with pytest.raises(TouchdownError, match=r"gap AMB A: rotor has no place B; .*A, .*amb"):
        touchdown.run(touchdown.load(tmp_path / "own.toml"), in_process=True)


def test_a_gap_that_was_not_recorded_is_said(tmp_path: Path) -> None:
    (tmp_path / "own.toml").write_text(SCENE, encoding="utf-8")
    scene = touchdown.load(tmp_path / "own.toml").set({"run.duration": "9 ms", "run.record": "rotor.A"})
    result = touchdown.run(scene, in_process=True)
    assert result.summary["gaps"]["AMB A"]["least"] is None
    assert result.summary["least_gap"] is None
    assert "gap AMB A: rotor.amb was not recorded; see run.record" in result.warnings


def test_a_gap_may_act(tmp_path: Path) -> None:
    """A rub ring of 0.2 mm in the middle bears what the bushings of 0.3 mm at the ends do not reach."""
    (tmp_path / "stub.toml").write_text(STUB.replace("B = 5", "B = 5\nC = 3"), encoding="utf-8")
    gap = """
        [[gap]]
        name = "rub ring"
        at = "rotor.C"
        radial = "0.2 mm"
        journal_radius = "14 mm"
        [set.gap_rub_ring]
        friction.dynamic = 0.1
        """
    (tmp_path / "own.toml").write_text(f"{MACHINE}\n{gap}", encoding="utf-8")
    scene = touchdown.load(tmp_path / "own.toml").set({"run.duration": "12 ms", "run.macro_step": "10 us"})
    assert scene.components["gap_rub_ring"].fmu == "bushing"
    result = touchdown.run(scene, tmp_path / "run", in_process=True)
    assert result.recording["gap_rub_ring.contact.force"].max() > 10.0
    assert result.recording["bearing_A.contact.force"].max() == 0.0
    assert result.summary["gaps"]["rub ring"]["touches"] >= 1
    (said,) = (w for w in result.warnings if "rub ring" in w)
    assert said.endswith("It acts as the bushing gap_rub_ring, which has its forces and its heat")
    assert scene.components["gap_rub_ring"].set["friction.dynamic"] == 0.1
    again = touchdown.load(str(tmp_path / "run" / "scene.json"))
    assert again.gaps == scene.gaps
    assert again.components.keys() == scene.components.keys()


def test_gaps_add_up_over_files(tmp_path: Path) -> None:
    """Of the scene that is extended and of the rotor's file; one name is one gap, the last one's."""

    def gap(name: str, at: str, radial: str) -> str:
        return f'[[gap]]\nname = "{name}"\nat = "{at}"\nradial = "{radial}"\n'

    (tmp_path / "stub.toml").write_text(STUB, encoding="utf-8")
    base = MACHINE + gap("labyrinth", "rotor.B", "0.4 mm")
    (tmp_path / "base.toml").write_text(base, encoding="utf-8")
    own = gap("labyrinth", "rotor.B", "0.5 mm") + gap("shroud", "rotor.A", "0.6 mm")
    (tmp_path / "own.toml").write_text(f'extends = "base.toml"\n{own}', encoding="utf-8")
    found = {gap.name: (gap.at, gap.radial) for gap in touchdown.load(tmp_path / "own.toml").gaps}
    assert found == {
        "magnet": ("rotor.near_amb", pytest.approx(0.35e-3)),
        "labyrinth": ("rotor.B", pytest.approx(0.5e-3)),
        "shroud": ("rotor.A", pytest.approx(0.6e-3)),
    }


def test_a_gap_that_stays_open_keeps_no_drop_from_settling(tmp_path: Path) -> None:
    """Its bushing is never touched; the disk comes to rest in its bearing, and the run ends there."""
    (tmp_path / "stub.toml").write_text(STUB.replace("B = 5", "B = 5\nC = 3"), encoding="utf-8")
    gap = """
        [run]
        until = "settled"
        [components.rotor.set]
        speed = 0
        [[gap]]
        name = "wide"
        at = "rotor.C"
        radial = "1 mm"
        journal_radius = "14 mm"
        """
    (tmp_path / "own.toml").write_text(f"{MACHINE}\n{gap}", encoding="utf-8")
    scene = touchdown.load(tmp_path / "own.toml").set({"run.duration": "1 s", "run.macro_step": "20 us"})
    summary = touchdown.run(scene, in_process=True).summary
    assert summary["seats"]["C"]["settled"] is None
    assert summary["settling_time"] < summary["end_time"] < 0.9
