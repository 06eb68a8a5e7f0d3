"""Sweeps: many runs that differ in some settings."""

from __future__ import annotations

import csv
import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Sequence
from pathlib import Path

import pytest
from places import COMMAND, ROOT

from touchdown.master.cli import main
from touchdown.master.common.errors import FAILED, STOPPED, TouchdownError
from touchdown.master.scene.file import load_scene
from touchdown.master.scene.scene import Scene
from touchdown.master.studies.sweep.kept import identity, origins
from touchdown.master.studies.sweep.report import Member, picked, table, verdict_lines
from touchdown.master.studies.sweep.sweep import Execution, sweep
from touchdown.master.studies.sweep.variation import parse, parse_all
from touchdown.rotor.file import shipped

SCENE = "disk-caged-simplified"
ANGLE = "bearing.balls.first_angle"
PATIENCE = 120.0  # s


@pytest.mark.parametrize(
    ("text", "values"),
    [
        ("rotor.mass=1.5", ["1.5"]),
        ("rotor.mass = 1.5, 2", ["1.5", "2"]),
        ("bearing.clearance=0.2,0.25,0.3 mm", ["0.2 mm", "0.25 mm", "0.3 mm"]),
        ("bearing.clearance=0.2 mm,250 um", ["0.2 mm", "250 um"]),
        ("run.scheme=hold,interface", ["hold", "interface"]),
        (f"{ANGLE}=0:315:8 deg", [f"{45 * k} deg" for k in range(8)]),
        ("rotor.x=-1e-5:1e-5:3", ["-1e-05", "0", "1e-05"]),
        ("rotor.x=3e-5:1e-5:1", ["3e-05"]),
    ],
)
def test_values_as_people_write_them(text: str, values: Sequence[str]) -> None:
    variation = parse(text)
    assert variation.name == text.partition("=")[0].strip()
    assert list(variation.values) == values


@pytest.mark.parametrize(
    ("texts", "named"),
    [
        ([], "nothing varies"),
        (["rotor.mass"], "write NAME=VALUE"),
        (["=1,2"], "write NAME=VALUE"),
        (["rotor.mass="], "the list of values is empty"),
        (["rotor.mass=1,,2"], "a value is missing between the commas"),
        (["rotor.mass=,"], "a value is missing between the commas"),
        (["rotor.mass=1:2"], "write START:STOP:COUNT"),
        (["rotor.mass=1:2:3:4 kg"], "write START:STOP:COUNT"),
        (["rotor.mass=1 kg:2 kg:3"], "write START:STOP:COUNT"),
        (["rotor.mass=one:2:3"], "must be numbers"),
        (["rotor.mass=1:nan:3"], "must be finite numbers"),
        (["rotor.mass=1:2:0"], "COUNT must be a whole number from 1"),
        (["rotor.mass=1:2:-1"], "COUNT must be a whole number from 1"),
        (["rotor.mass=1:2:2.5"], "COUNT must be a whole number from 1"),
        (["rotor.mass=1,2", "rotor.mass=3"], "is given twice"),
    ],
)
def test_values_that_cannot_be(texts: list[str], named: str) -> None:
    with pytest.raises(TouchdownError, match=named):
        parse_all(texts)


def command(*arguments: object) -> int:
    return main(["sweep", *(str(argument) for argument in arguments)])


@pytest.mark.parametrize(
    ("arguments", "named"),
    [
        (["--vary", "rotor.weight=1,2"], "no variable weight"),
        (["--vary", "rtor.mass=1,2"], "no component rtor; did you mean rotor"),
        (["--vary", "mass=1,2"], "write COMPONENT.VARIABLE"),
        (["--vary", "rotor.mass=1,light"], "rotor.mass = 'light' is not a number"),
        (["--vary", "rotor.mass=1,2 mm"], "measured in kg"),
        (["--vary", "rotor.mass=1,-2"], "rotor.mass = -2"),
        (["--vary", "rotor.mass=1,2", "--vary", "bearing.as_printed=0:1:3"], "as_printed"),
        (["--vary", "run.scheme=hold,held"], "unknown scheme held"),
        (["--vary", "run.duration=1,0"], "run.duration = 0 must be above 0"),
        (["--vary", "rotor.mass=1", "--jobs", "0"], "--jobs 0 must be a whole number above 0"),
        (["--vary", "rotor.mass=1", "--jobs", "two"], "--jobs = 'two' is not a number"),
        (["--vary", "rotor.mass=1", "--duration", "-1"], "run.duration = -1 must be above 0"),
        ([], "nothing varies"),
    ],
)
def test_a_bad_sweep_is_one_line(
    arguments: list[str], named: str, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    scene = "disk-cageless-simplified" if "as_printed" in named else SCENE
    assert command(scene, *arguments, "--quiet", "-o", tmp_path / "out") == FAILED
    complaint = capsys.readouterr().err
    assert len(complaint.splitlines()) == 1
    assert named in complaint
    assert not (tmp_path / "out").exists()


def rows(folder: Path) -> list[dict[str, str]]:
    with (folder / "sweep.csv").open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def test_a_sweep_runs_every_combination(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    """In process; the third speed stops its runs, the others go on."""
    status = command(
        *(SCENE, "--in-process", "--quiet", "-o", tmp_path, "--set", "rotor.mass=2", "--duration", "12 ms"),
        *("--vary", f"{ANGLE}=0,20 deg", "--vary", "run.macro_step=20,100,20000 us"),
        *("--pick", "whirl_A", "--pick", "peak_contact*", "--pick", "no_such"),
    )
    shown = capsys.readouterr()
    found = rows(tmp_path)
    assert status == STOPPED
    assert [row["member"] for row in found] == list("123456")
    assert [row[f"{ANGLE} [deg]"] for row in found] == ["0.0"] * 3 + ["20.0"] * 3
    assert [row["run.macro_step [us]"] for row in found] == ["20.0", "100.0", "20000.0"] * 2
    for i, row in enumerate(found):
        folder = tmp_path / f"00{i + 1}"
        assert not (folder / "result.h5").exists()
        if i % 3 < 2:
            assert (folder / "summary.json").is_file()
            assert row["failed"] == ""
            assert float(row["peak_contact_force_N"]) > 100.0
            assert row["whirl_A"] == "no whirl"
        else:
            assert "is longer than the run" in row["failed"]
            assert row["peak_contact_force_N"] == ""
    lines = shown.out.splitlines()
    assert lines[0].split() == [ANGLE, "run.macro_step", "whirl_A", "peak_contact_force_N"]
    assert "failed: run.macro_step" in lines[3]
    assert "  whirl_A: 4 x no whirl" in lines
    assert "no member has a figure no_such" in shown.err
    assert "2 of 6 runs failed" in shown.err


def test_a_sweep_from_python_with_the_fmus(tmp_path: Path) -> None:
    scene = load_scene(SCENE).set({"run.duration": 2e-3})
    steps = []
    members = sweep(
        scene,
        {"rotor.mass": [1.0, "2000 g"]},
        tmp_path,
        execution=Execution(keep=True),
        done=lambda: steps.append(1),
    )
    assert [m.settings for m in members] == [{"rotor.mass": 1.0}, {"rotor.mass": "2000 g"}]
    assert [m.summary["energy_scale_J"] for m in members] == [
        pytest.approx(mass * 9.81 * 3e-4) for mass in (1.0, 2.0)
    ]
    assert len(steps) == 2
    assert [row["rotor.mass"] for row in rows(tmp_path)] == ["1.0", "2000 g"]
    assert (tmp_path / "002" / "result.h5").is_file()
    with pytest.raises(TouchdownError, match="at least one job"):
        sweep(scene, {"rotor.mass": [1.0]}, tmp_path, jobs=0)
    with pytest.raises(TouchdownError, match=r"rotor\.mass has no values"):
        sweep(scene, {"rotor.mass": []}, tmp_path)


def masses(folder: Path) -> dict[str, float]:
    """By folder of a finished member: the rotor's mass that it was run with."""
    scenes = [mark.parent / "scene.json" for mark in folder.glob("*/member.json")]
    ran = {path.parent.name: json.loads(path.read_text(encoding="utf-8")) for path in scenes}
    return {name: scene["components"]["rotor"]["set"]["mass"] for name, scene in ran.items()}


@pytest.mark.long
def test_finished_members_are_not_run_again(tmp_path: Path) -> None:
    """Known by their scene, they move to where they are wanted; those not asked for stay, elsewhere."""
    scene = load_scene(SCENE).set({"run.duration": 2e-3})

    def swept(*given: float) -> list[Member]:
        return sweep(scene, {"rotor.mass": given}, tmp_path, execution=Execution(in_process=True))

    first = swept(1.0, 2.0)
    assert [m.kept for m in first] == [False, False]
    more = swept(2.0, 3.0, 1.0)
    assert [m.kept for m in more] == [True, False, True]
    assert [m.summary for m in (more[2], more[0])] == [m.summary for m in first]
    assert [row["rotor.mass"] for row in rows(tmp_path)] == ["2.0", "3.0", "1.0"]
    assert masses(tmp_path) == {"001": 2.0, "002": 3.0, "003": 1.0}
    assert [m.kept for m in swept(3.0)] == [True]
    assert masses(tmp_path)["001"] == 3.0
    assert sorted(masses(tmp_path).values()) == [1.0, 2.0, 3.0]
    assert len(rows(tmp_path)) == 1
    (tmp_path / "001" / "summary.json").write_text("{")
    assert [m.kept for m in swept(3.0)] == [False]


def test_a_member_is_known_by_all_that_changes_its_numbers(tmp_path: Path) -> None:
    rotor = tmp_path / "rotor.toml"
    text = shipped()["rotor_I"].read_text(encoding="utf-8")
    rotor.write_text(text, encoding="utf-8")
    scene = load_scene("rotor1-9000").swap(rotor=rotor)

    def known(one: Scene, in_process: bool = True) -> str:
        return identity(one, origins(one), in_process)

    own = known(scene)
    assert known(load_scene("rotor1-9000").swap(rotor=rotor)) == own
    others = [known(scene.set({name: 3e-5})) for name in ("run.macro_step", "rotor.eccentricity")]
    others += [known(scene, in_process=False), known(scene.set({"run.scheme": "hold"}))]
    rotor.write_text(f"# the same, in other words\n{text}", encoding="utf-8")
    others.append(known(scene))
    assert len({own, *others}) == 6


def test_a_sweep_that_is_too_large_is_refused_before_it_is_listed(tmp_path: Path) -> None:
    many = {f"rotor.{name}": range(10**6) for name in ("mass", "speed", "x", "y")}
    with pytest.raises(TouchdownError, match=f"1{24 * '0'} members is too large, at most 10000"):
        sweep(load_scene(SCENE), many, tmp_path / "out")
    assert not (tmp_path / "out").exists()


@pytest.mark.long
def test_a_sweep_that_is_killed_goes_on_where_it_was(tmp_path: Path) -> None:
    """SIGKILL leaves no process, and loses only what was under way."""
    arguments = [*COMMAND, "sweep", SCENE, "--in-process", "--quiet", "-o", str(tmp_path)]
    arguments += ["--duration", "0.05 s", "--vary", "rotor.mass=1:2:8 kg"]
    environment = {**os.environ, "PYTHONPATH": str(ROOT / "src")}
    running = subprocess.Popen(arguments, env=environment, start_new_session=True)
    deadline = time.monotonic() + PATIENCE
    try:
        while len(masses(tmp_path)) < 2:
            assert running.poll() is None
            assert time.monotonic() < deadline
            time.sleep(0.01)
    finally:
        running.kill()
    running.wait()
    while left := processes_of_session(running.pid):
        assert time.monotonic() < deadline, left
        time.sleep(0.01)
    there = len(masses(tmp_path))
    assert 0 < len(rows(tmp_path)) <= there < 8
    again = subprocess.run(
        arguments, env=environment, capture_output=True, text=True, timeout=PATIENCE, check=True
    )
    assert f"{there} of 8 were finished before and not run again" in again.stdout
    assert [row["failed"] for row in rows(tmp_path)] == 8 * [""]


@pytest.mark.long
def test_a_process_that_dies_is_one_failed_member(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """It takes the pool along; the others are run again."""
    monkeypatch.setenv("PYTHONPATH", f"{tmp_path}{os.pathsep}{ROOT / 'src'}")
    (tmp_path / "sitecustomize.py").write_text(DIES)
    scene = load_scene(SCENE).set({"run.duration": 2e-3})
    members = sweep(
        scene, {"rotor.mass": [1.0, 2.0, 3.0]}, tmp_path / "out", execution=Execution(in_process=True)
    )
    assert [m.failed for m in members] == ["", "its process died", ""]
    assert [bool(m.summary) for m in members] == [True, False, True]


DIES = """
import os, sys
import h5py
opened = h5py.File.__init__
def dies(self, name, *arguments, **options):
    if "002" in str(name):
        os._exit(1)
    opened(self, name, *arguments, **options)
h5py.File.__init__ = dies
"""


def test_verdicts_are_counted() -> None:
    words = ["pendulum", "sustained backward whirl", "pendulum", None]
    members = [Member(i + 1, {"a.b": i}, {"whirl_A": word, "x": 1.5}) for i, word in enumerate(words)]
    members.append(Member(5, {"a.b": 4}, {}, "broke"))
    assert verdict_lines(members) == ["  whirl_A: 2 x pendulum, 1 x sustained backward whirl"]
    assert picked(members, []) == (["whirl_A"], [])
    assert picked(members, ["x", "whirl_?"]) == (["x", "whirl_A"], [])
    assert table(members, ["x"]).splitlines()[-1].split() == ["5", "4", "-", "failed:", "broke"]


@pytest.mark.long
def test_ctrl_c_ends_a_sweep(tmp_path: Path) -> None:
    """Sent to the command alone, as by `kill`: it leaves no process and the table of what there is."""
    script = "import sys; from touchdown.master.cli import main; sys.exit(main())"
    arguments = ("sweep", SCENE, "--in-process", "--quiet", "-o", str(tmp_path), "--duration", "500 s")
    running = subprocess.Popen(
        [sys.executable, "-c", script, *arguments, "--vary", "rotor.mass=1:2:6 kg"],
        env={**os.environ, "PYTHONPATH": str(ROOT / "src")},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )
    deadline = time.monotonic() + PATIENCE
    try:
        while not (tmp_path / "002" / "result.h5").exists():
            assert running.poll() is None, running.communicate()
            assert time.monotonic() < deadline
            time.sleep(0.01)
        running.send_signal(signal.SIGINT)
        out, err = running.communicate(timeout=PATIENCE)
    finally:
        running.kill()
    assert running.returncode == 130
    assert err == "touchdown: interrupted\n"
    assert out.count("failed: interrupted") == 6
    assert [row["failed"] for row in rows(tmp_path)] == ["interrupted"] * 6
    while left := processes_of_session(running.pid):
        assert time.monotonic() < deadline, left
        time.sleep(0.01)


def processes_of_session(session: int) -> list[str]:
    """Those that still run, from /proc/PID/stat: (name) state, parent, group, session."""
    found = []
    for path in Path("/proc").glob("[0-9]*/stat"):
        try:
            fields = path.read_text().rpartition(")")[2].split()
        except OSError:
            continue
        if fields[3] == str(session) and fields[0] != "Z":
            found.append(path.parent.name)
    return found
