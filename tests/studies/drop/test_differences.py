"""What runs differ in: settings however they are written, quantities as people read them, pictures."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

import touchdown
from touchdown.command.cli import main
from touchdown.master.common.errors import TouchdownError
from touchdown.master.scene.scene import Scene
from touchdown.studies.drop.differences import Differences, Side

GAPPED = """
extends = "disk-caged-simplified"
[run]
duration = "9 ms"
[[gap]]
name = "seal"
at = "rotor.A"
radial = "0.35 mm"
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Of runs `one` and `heavy`, which differ in two settings, and a sweep of three clearances."""
    found = tmp_path_factory.mktemp("runs")
    (found / "scene.toml").write_text(GAPPED)
    one = touchdown.load(found / "scene.toml")
    changed = {"rotor.mass": "2000 g", "bearing.clearance": "0.25 mm", "rotor.speed": "9 krpm"}
    touchdown.run(one, found / "one", in_process=True)
    touchdown.run(one.set(changed), found / "heavy", in_process=True)
    clearances = {"bearing.clearance": ["0.25 mm", "0.3 mm"]}
    touchdown.sweep(one.set({"rotor.mass": "2 kg"}), clearances, found / "sweep", in_process=True, jobs=1)
    return found


def test_settings_that_differ_are_named(folder: Path) -> None:
    """9000 rpm are 9 krpm; a clearance that is not set is the model's."""
    found = touchdown.diff([folder / "one", folder / "heavy"])
    assert found.settings == {"rotor.mass": ["1.65 kg", "2 kg"], "bearing.clearance": ["300 um", "250 um"]}


def test_settings_of_runs_and_of_components_that_one_has() -> None:
    of = (("disk-caged-simplified", {"run.duration": "0.03 s", "housing.every": 2}), ("rotor1-9000", {}))
    sides = [Side(name, touchdown.load(name).set(changes), {}) for name, changes in of]
    found = Differences(sides).settings
    assert found["run.duration"] == ["0.03 s", "1 s"]
    assert (found["housing.every"], found["housing.fmu"]) == (["2", "-"], ["housing", "-"])
    assert "amb.every" not in found


def test_settings_have_one_form_however_they_are_written(folder: Path, tmp_path: Path) -> None:
    """Words of a choice, truth values and numbers; a body's sizes that are given and those that are not."""
    base = touchdown.load("disk-caged-simplified").set({"run.duration": "0.2 ms"})
    for name, changes in {
        "number": {"bearing.thermal": 1, "inclination": "10 deg"},
        "word": {"bearing.thermal": "on", "inclination": 0.1},
    }.items():
        touchdown.run(base.set(changes), tmp_path / name, in_process=True)
    found = touchdown.diff([tmp_path / "number", tmp_path / "word"])
    assert found.settings == {"inclination": ["10 deg", "5.72958 deg"]}
    other = touchdown.diff([folder / "one", tmp_path / "word"]).settings
    assert other["bearing.thermal"] == ["off", "on"]


def test_a_node_is_no_size(tmp_path: Path) -> None:
    scene = touchdown.load("disk-caged-simplified")
    of = [{"components": {"rotor": {"peak_bending_stress_node": node}}} for node in (4.0, 5.0)]
    lines = Differences([Side(str(k), scene, one) for k, one in enumerate(of)]).findings().lines
    assert [line.split()[-3:] for line in lines if "at node" in line] == [["4", "5", "+1"]]


def test_a_drop_of_a_sweep_is_its_summary(folder: Path) -> None:
    """The first has the settings of `heavy` and so its quantities; of both there is one recording only."""
    found = touchdown.diff([folder / "heavy", folder / "sweep" / "1"])
    assert found.settings == {}
    assert found.items() == []
    assert found.sides[1].run is None
    assert found.findings().pictures.keys() == {"force.png", "orbit.png", "gaps.png"}
    other = touchdown.diff([folder / "sweep" / "1", folder / "sweep" / "2"])
    assert other.settings == {"bearing.clearance": ["0.25 mm", "0.3 mm"]}
    assert other.findings().pictures == {}
    frame = other.to_pandas()
    assert frame.loc["seats.A.first_contact_time", "1"] < frame.loc["seats.A.first_contact_time", "2"]


def test_the_command_prints_and_draws(
    folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "new" / "diff"
    assert main(["diff", str(folder / "one"), str(folder / "heavy"), "-o", str(out)]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].split() == ["settings", "one", "heavy"]
    times = [touchdown.open_result(folder / name).summary["seats"]["A"]["first_contact_time"] for name in
             ("one", "heavy")]  # fmt: skip
    row = next(line for line in lines if "first contact, after the shutdown, A [s]" in line)
    before, after = times
    told = [
        f"{before:.4g}",
        f"{after:.4g}",
        f"{after - before:+.3g}",
        f"({100 * (after / before - 1):+.1f}",
        "%)",
    ]
    assert row.split()[-5:] == told
    assert not any("end of the run" in line or "macro step" in line or "wall" in line for line in lines)
    assert {path.name for path in out.iterdir()} == {"force.png", "orbit.png", "gaps.png"}
    assert main(["diff", str(folder / "one"), str(folder / "one" / "."), "-o", str(out), "--all"]) != 0
    assert main(["diff", str(folder / "one"), str(folder / "heavy"), "-o", str(out), "--all"]) == 0
    assert "macro step [us]" in capsys.readouterr().out


def test_each_run_is_a_line_of_each_panel(folder: Path) -> None:
    found = touchdown.diff([folder / "one", folder / "heavy"])
    largest = [side.run.recording["bearing.contact.force"].max() for side in found.sides if side.run]
    figure = found.findings().pictures["force.png"]()
    (axes,) = figure.axes
    assert [line.get_ydata().max() for line in axes.lines] == pytest.approx(largest)
    assert [text.get_text() for text in figure.legends[0].get_texts()] == ["one", "heavy"]
    left = found.findings().pictures["gaps.png"]().axes[0].lines
    least = [side.summary["gaps"]["seal"]["least"] for side in found.sides]
    assert [1e-6 * line.get_ydata().min() for line in left] == pytest.approx(least, rel=1e-3)


def test_values_that_there_are_not_and_words() -> None:
    scene = replace(touchdown.load("disk-caged-simplified"))
    seats = [
        {"whirl": "pendulum", "settling_time": None},
        {"whirl": "backward whirl", "settling_time": 0.5},
    ]
    lines = Differences([_side(str(k), scene, seat) for k, seat in enumerate(seats)]).findings().lines
    assert "no setting differs" in lines
    assert [line.split() for line in lines if "settling time" in line] == [
        ["settling", "time,", "A", "[s]", "-", "0.5"]
    ]
    assert any(line.endswith("pendulum | backward whirl") for line in lines)
    same = Differences([_side(str(k), scene, seats[0]) for k in range(2)]).findings().lines
    assert same == ["no setting differs", "no quantity differs"]


def _side(label: str, scene: Scene, seat: dict[str, object]) -> Side:
    return Side(label, scene, {"seats": {"A": seat}})


@pytest.mark.parametrize(
    ("runs", "message"),
    [
        (["one"], "two runs or more"),
        (["one", "one"], "is there twice"),
        (["one", "sweep/3"], "the sweep has drops 1 to 2, and no 3"),
        (["one", "none"], "there is no folder"),
    ],
)
def test_what_is_no_difference(runs: list[str], message: str, folder: Path) -> None:
    with pytest.raises(TouchdownError, match=message):
        touchdown.diff([folder / run for run in runs])
