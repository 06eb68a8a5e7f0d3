"""Sweeps: many runs that differ in some settings."""

from __future__ import annotations

import csv
import json
import os
import signal
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import xarray
from places import COMMAND, ROOT

from touchdown.command.cli import main
from touchdown.master.common.errors import STOPPED, Ended, TouchdownError
from touchdown.master.common.progress import Progress
from touchdown.master.scene.file import load_scene
from touchdown.master.scene.scene import Scene
from touchdown.reports.page import write_page
from touchdown.reports.sweeps import report_on_sweep
from touchdown.rotor.file import shipped_rotors
from touchdown.studies.sweep.definition import define, differences
from touchdown.studies.sweep.design import Design
from touchdown.studies.sweep.members import Member, read_journal
from touchdown.studies.sweep.report import (
    failures,
    items_of,
    picked,
    refuse_picks,
    report_lines,
    table,
    verdict_lines,
    without_effect,
)
from touchdown.studies.sweep.results import Sweep, read
from touchdown.studies.sweep.sweep import sweep
from touchdown.studies.sweep.tasks import Running

SCENE = "disk-caged-simplified"
ANGLE = "bearing.balls.first_angle"
PATIENCE = 120.0  # s


def command(*arguments: object) -> int:
    return main(["sweep", *(str(argument) for argument in arguments)])


def rows(folder: Path) -> list[dict[str, str]]:
    with (folder / "sweep.csv").open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def test_the_unit_of_bare_values_is_told(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    short = (SCENE, "--in-process", "--quiet", "--no-pictures", "--duration", "1 ms", "-o", tmp_path)
    assert command(*short, "--vary", f"{ANGLE}=0,0.1", "--vary", "rotor.inertia=0.5e-3 kg.m2") == 0
    assert f"values without a unit are in SI: {ANGLE} in rad\n" in capsys.readouterr().out


def test_a_sweep_runs_every_combination(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    """In process; the third speed stops its runs, the others go on."""
    status = command(
        *(SCENE, "--in-process", "--quiet", "-o", tmp_path, "--set", "rotor.mass=2", "--duration", "12 ms"),
        *("--vary", f"{ANGLE}=0,20 deg", "--vary", "run.macro_step=20,100,20000 us"),
        *("--pick", "seats.A.whirl", "--pick", "peak_contact*", "--pick", "stop_hits"),
    )
    shown = capsys.readouterr()
    found = rows(tmp_path)
    assert status == STOPPED
    assert [row["member"] for row in found] == list("123456")
    assert [row[f"{ANGLE} [deg]"] for row in found] == ["0.0"] * 3 + ["20.0"] * 3
    assert [row["run.macro_step [us]"] for row in found] == ["20.0", "100.0", "20000.0"] * 2
    for i, row in enumerate(found):
        if i % 3 < 2:
            assert row["failed"] == ""
            assert float(row["seats.A.peak_contact_force [N]"]) > 100.0
            assert float(row["seats.A.peak_indentation_rotor_ring [m]"]) < 1e-4
            assert row["seats.A.whirl"] == "no whirl"
        else:
            assert "is longer than the run" in row["failed"]
            assert row["seats.A.peak_contact_force [N]"] == ""
    with xarray.open_dataset(tmp_path / "sweep.nc") as data:
        assert list(data["ended"].values) == ["completed", "completed", "stopped"] * 2
        assert data["run.macro_step"].values == pytest.approx([2e-5, 1e-4, 2e-2] * 2)
        assert data[ANGLE].attrs["units"] == "rad"
        force = data["seats.A.peak_contact_force"]
        assert force.attrs == {"units": "N", "long_name": "largest contact force, A"}
        assert np.isnan(force.values[2])
        assert data["components.rotor.speed_end"].attrs["units"] == "rad/s"
    assert {path.name for path in tmp_path.iterdir()} == {
        *("sweep.json", "members.jsonl", "sweep.nc", "sweep.csv", "whirl-map.png", "force-map.png"),
    }
    lines = shown.out.splitlines()
    assert lines[0] == "6 runs: 6 points of a grid"
    heads = [ANGLE, "run.macro_step", "whirl, A", "largest contact force, A [N]"]
    assert lines[1].strip().split("  ") == heads
    assert "failed: run.macro_step" in lines[4]
    assert "  whirl, A: 4 x no whirl" in lines
    assert "no drop has a quantity stop_hits" in shown.err
    assert "2 of 6 runs failed" in shown.err


def test_a_sweep_from_python_with_the_fmus(tmp_path: Path) -> None:
    scene, planned, steps = load_scene(SCENE).set({"run.duration": 2e-3}), list[int](), list[int]()
    design = Design.grid({"rotor.mass": [1.0, "2000 g"]})
    members = sweep(
        scene, design, tmp_path, Running(keep=True), Progress(planned.append, lambda: steps.append(1))
    )
    assert [m.settings for m in members] == [{"rotor.mass": 1.0}, {"rotor.mass": "2000 g"}]
    scales = [m.summary["energy_scale"] for m in members]
    assert scales == pytest.approx([mass * 9.81 * 3e-4 for mass in (1.0, 2.0)])
    assert planned == [len(steps)] == [2]
    assert [row["rotor.mass"] for row in rows(tmp_path)] == ["1.0", "2000 g"]
    assert (tmp_path / "002" / "result.h5").is_file()
    with pytest.raises(TouchdownError, match="at least one job"):
        sweep(scene, Design.grid({"rotor.mass": [1.0]}), tmp_path, Running(jobs=0))


def swept(folder: Path, design: Design, **changes: object) -> Sweep:
    """A short sweep in process."""
    scene = load_scene(SCENE).set({"run.duration": 2e-3, **changes})
    return sweep(scene, design, folder, Running(in_process=True, jobs=1))


def test_another_sweep_is_refused_with_what_differs(tmp_path: Path) -> None:
    design = Design.grid({"rotor.mass": [1.0, 2.0]})
    scene = load_scene(SCENE)
    define(scene, design, in_process=True).write(tmp_path)
    there = read(tmp_path).definition
    assert not differences(there, define(scene, design, in_process=True))
    assert [member.failed for member in read(tmp_path)] == ["not run"] * 2
    with pytest.raises(TouchdownError, match="there is no sweep in"):
        read(tmp_path / "nowhere")
    path = tmp_path / "of an earlier version, with flat figures.jsonl"
    path.write_text('{"member": 1, "ended": "completed", "failed": "", "figures": {}}\n', encoding="utf-8")
    with pytest.raises(TouchdownError, match=r"jsonl is of an earlier version; .* with --anew"):
        read_journal(path, {1: {}})

    def said(other: Scene, points: Design = design, in_process: bool = True) -> str:
        with pytest.raises(TouchdownError) as refused:
            sweep(other, points, tmp_path, Running(in_process=in_process))
        return str(refused.value)

    assert "run.duration is 5.0 there and 0.1 here" in said(scene.set({"run.duration": 0.1}))
    unbalanced = scene.set({"rotor.eccentricity": 1e-6})
    assert "rotor.eccentricity is not set there and 1e-06 here. Choose" in said(unbalanced)
    assert "in_process is True there and False here" in said(scene, in_process=False)
    assert "number of points is 2 there and 1 here" in said(scene, Design.grid({"rotor.mass": [1.0]}))
    assert "rotor.mass of point 2 is 2.0 there and 3.0 here" in said(
        scene, Design.grid({"rotor.mass": [1.0, 3.0]})
    )
    assert not (tmp_path / "members.jsonl").exists()


def test_what_a_sweep_is_made_of_is_part_of_it(tmp_path: Path) -> None:
    rotor = tmp_path / "rotor.toml"
    text = shipped_rotors()["rotor_I"].read_text(encoding="utf-8")
    rotor.write_text(text, encoding="utf-8")
    scene = load_scene("rotor1-9000").swap(rotor=rotor)
    design = Design.grid({"rotor.modes": [4]})
    before = define(scene, design, in_process=True)
    rotor.write_text(f"# the same, in other words\n{text}", encoding="utf-8")
    after = define(scene, design, in_process=True)
    assert differences(before, after) == ["what rotor is made of has changed"]


@pytest.mark.slow
def test_a_sweep_goes_on_after_half_a_line(tmp_path: Path) -> None:
    """What is torn, or no line at all, counts for nothing; a member that died runs again."""
    design = Design.grid({"rotor.mass": [1.0, 2.0, 3.0]})
    whole = swept(tmp_path, design)
    files = [(tmp_path / name).read_bytes() for name in ("sweep.nc", "sweep.csv")]
    path = tmp_path / "members.jsonl"
    lines = path.read_bytes().splitlines(keepends=True)
    died = json.dumps({**json.loads(lines[1]), "ended": "died", "failed": "its process died"}).encode()
    path.write_bytes(lines[0] + b"no line\n" + died + b"\n" + lines[2][:40])
    assert [m.ended.value for m in read(tmp_path)] == ["completed", "died", "interrupted"]
    again = swept(tmp_path, design)
    assert [m.kept for m in again] == [True, False, False]
    assert [m.summary for m in again] == [m.summary for m in whole]
    assert [(tmp_path / name).read_bytes() for name in ("sweep.nc", "sweep.csv")] == files
    last = path.read_bytes().splitlines()
    assert [json.loads(line)["member"] for line in last if line != b"no line"] == [1, 2, 2, 3]


@pytest.mark.slow
def test_a_sweep_that_is_killed_goes_on_where_it_was(tmp_path: Path) -> None:
    """SIGKILL leaves no process, and loses only what was under way."""
    (tmp_path / "sitecustomize.py").write_text(WAITS)
    gate, out = tmp_path / "gate", tmp_path / "out"
    arguments = [*COMMAND, "sweep", SCENE, "--in-process", "--quiet", "-o", str(out), "--no-pictures"]
    arguments += ["--duration", "0.01 s", "--vary", "rotor.mass=1:2:8 kg"]
    environment = {**os.environ, "PYTHONPATH": f"{tmp_path}{os.pathsep}{ROOT / 'src'}", "GATE": str(gate)}
    running = subprocess.Popen(arguments, env=environment, start_new_session=True)
    deadline = time.monotonic() + PATIENCE
    try:
        while len(ended(out)) < 2:
            assert running.poll() is None
            assert time.monotonic() < deadline
            time.sleep(0.01)
    finally:
        running.kill()
    running.wait()
    while left := processes_of_session(running.pid):
        assert time.monotonic() < deadline, left
        time.sleep(0.01)
    there = len(ended(out))
    assert 2 <= there <= 4
    gate.touch()
    again = subprocess.run(
        arguments, env=environment, capture_output=True, text=True, timeout=PATIENCE, check=True
    )
    assert f"{there} of 8 were finished before and not run again" in again.stdout
    assert [row["failed"] for row in rows(out)] == 8 * [""]
    assert sorted(ended(out)) == list(range(1, 9))


# Members from the fifth on wait for a file, so that none of them can end before the sweep is killed.
WAITS = """
import os, re, time
import h5py
opened = h5py.File.__init__
def waits(self, name, *arguments, **options):
    member = re.search(r"\\.under-way/(\\d+)/", str(name))
    while member and int(member[1]) > 4 and not os.path.exists(os.environ["GATE"]):
        time.sleep(0.01)
    opened(self, name, *arguments, **options)
h5py.File.__init__ = waits
"""


def ended(folder: Path) -> list[int]:
    """Members whose lines are whole."""
    path = folder / "members.jsonl"
    whole = path.read_bytes().split(b"\n")[:-1] if path.exists() else []
    return [json.loads(line)["member"] for line in whole]


@pytest.mark.slow
def test_a_worker_that_is_killed_costs_its_member_only(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """One whose process dies again when it runs alone is said; one whose process dies once is not."""
    monkeypatch.setenv("PYTHONPATH", f"{tmp_path}{os.pathsep}{ROOT / 'src'}")
    monkeypatch.setenv("DIED_ONCE", str(tmp_path / "died"))
    (tmp_path / "sitecustomize.py").write_text(DIES)
    scene = load_scene(SCENE).set({"run.duration": 2e-3})
    design = Design.grid({"rotor.mass": [1.0, 2.0, 3.0, 4.0]})
    members = sweep(scene, design, tmp_path / "out", Running(jobs=1, in_process=True))
    died = "its process was ended by SIGKILL while it ran alone"
    assert [m.failed for m in members] == ["", died, "", ""]
    assert [m.ended for m in members] == [Ended.COMPLETED, Ended.DIED, Ended.COMPLETED, Ended.COMPLETED]
    assert (tmp_path / "died").exists()
    assert sorted(ended(tmp_path / "out")) == [1, 2, 3, 4]


def test_a_member_that_exceeds_its_time_is_a_failed_drop(tmp_path: Path) -> None:
    """With one line; a report says so, also where every drop failed."""
    members = swept(tmp_path / "some", Design.grid({"run.time_limit": [0.0, 1e-9]}))
    late = "it takes longer than run.time_limit = 1e-09 s"
    assert [(m.failed, m.ended) for m in members] == [("", Ended.COMPLETED), (late, Ended.STOPPED)]
    none = swept(tmp_path / "none", Design.grid({"rotor.mass": [1.0, 2.0]}), **{"run.time_limit": 1e-9})
    page = report_on_sweep(none)
    assert page.headline == "No drop of 2 has a verdict. 2 of 2 drops failed or were not run."
    write_page(page, tmp_path / "page.html")
    assert late in (tmp_path / "page.html").read_text()


@pytest.mark.slow
def test_a_member_that_hangs_is_killed_and_costs_itself_only(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv("PYTHONPATH", f"{tmp_path}{os.pathsep}{ROOT / 'src'}")
    (tmp_path / "sitecustomize.py").write_text(HANGS)
    scene = load_scene(SCENE).set({"run.duration": 2e-3, "run.time_limit": "20 s"})
    design = Design.grid({"rotor.mass": [1.0, 2.0]})
    members = sweep(scene, design, tmp_path / "out", Running(jobs=1, in_process=True))
    assert [m.failed for m in members] == [
        "",
        "it took 60 s more than run.time_limit = 20 s and was killed",
    ]


HANGS = """
import h5py
from touchdown.studies.sweep import tasks
tasks.HANG_S = 0.0
opened = h5py.File.__init__
def hangs(self, name, *arguments, **options):
    while ".under-way/2/" in str(name):
        pass
    opened(self, name, *arguments, **options)
h5py.File.__init__ = hangs
"""
DIES = """
import os, signal
import h5py
opened = h5py.File.__init__
def dies(self, name, *arguments, **options):
    again = os.path.exists(os.environ["DIED_ONCE"])
    if ".under-way/2/" in str(name) or (".under-way/3/" in str(name) and not again):
        if ".under-way/3/" in str(name):
            open(os.environ["DIED_ONCE"], "w").close()
        os.kill(os.getpid(), signal.SIGKILL)
    opened(self, name, *arguments, **options)
h5py.File.__init__ = dies
"""


def test_verdicts_are_counted() -> None:
    words = ["pendulum", "backward whirl, at 0.5 s still whirling, steady", "pendulum", None]
    seats = [{"A": {"whirl": word, "whirl_revolutions": None}} for word in words]
    members = [Member(i + 1, {"a.b": i}, {"end_time": 1.5, "seats": s}) for i, s in enumerate(seats)]
    members.append(Member(5, {"a.b": 4}, {}, "broke"))
    assert verdict_lines(members) == ["  whirl, A: 2 x pendulum, 1 x backward whirl, still so at the end"]

    def paths(picks: list[str]) -> list[str]:
        chosen, complaints = picked(members, picks)
        assert not complaints
        return [item.path for item in chosen]

    assert paths([]) == ["seats.A.whirl", "seats.A.whirl_revolutions"]
    assert paths(["end_time", "seats.?.whirl"]) == ["end_time", "seats.A.whirl"]
    assert paths(["whirl*"]) == paths(["seats.*"]) == ["seats.A.whirl", "seats.A.whirl_revolutions"]
    shown = table(members, picked(members, ["end_time"])[0]).splitlines()
    assert shown[-1].split() == ["5", "4", "-", "failed:", "broke"]
    assert shown[0].endswith("end of the run, after the shutdown [s]")
    assert failures(members) == ["  1 x broke (drop 5)"]
    refuse_picks(
        ["*", "*whirl*", "end_time", "seats.A.*", "seats.[AB].whirl", "gaps.*.least", "seats.?.*force*"]
    )


def test_a_setting_without_effect_is_named() -> None:
    """Whatever the runs cost; drops that differ in more than one setting, or that failed, tell nothing."""
    forces = {(0, 1): 10.0, (0, 2): 10.0, (1, 1): 12.0, (1, 2): 12.0}
    members = [
        Member(i + 1, {"a.x": x, "a.phase": phase}, {"peak": force, "wall_time": 0.1 * i})
        for i, ((x, phase), force) in enumerate(forces.items())
    ]
    assert without_effect(members) == ["a.phase"]
    assert "  a.phase changes nothing in these drops" in report_lines(members, ())[0]
    assert without_effect([members[0], members[3]]) == []
    assert without_effect([members[0], replace(members[1], failed="broke"), *members[2:]]) == ["a.phase"]
    assert without_effect([*members[:3], replace(members[3], summary={"peak": 12.5})]) == []
    assert without_effect([]) == []


@pytest.mark.slow
def test_ctrl_c_ends_a_sweep(tmp_path: Path) -> None:
    """Sent to the command alone, as by `kill`: it leaves no process and the table of what there is."""
    script = "import sys; from touchdown.command.cli import main; sys.exit(main())"
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
        while not (tmp_path / ".under-way" / "2" / "result.h5").exists():
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


def test_a_table_is_short_and_of_the_worst_bearing() -> None:
    """Least safety, largest force; a drop of which one bearing has settled has not."""
    keys = ("first_contact_time", "peak_contact_force", "lowest_static_safety", "settling_time")
    first = dict(zip(keys, (0.007, 900.0, 2.0, 0.3), strict=True))
    first |= {"whirl": "no whirl", "whirl_revolutions": 0.0, "whirl_radius": 2e-4}
    second = dict(zip(keys, (0.007, 1000.0, 3.0, None), strict=True))
    run = {"settling_time": None, "least_gap": 2.5e-5, "requirements_met": False, "energy_scale": 0.1}
    summary = {"seats": {"A": first, "B": second}, **run}
    members = [Member(1, {"bearing_*.clearance": "0.2 mm"}, summary, "", Ended.COMPLETED)]
    lines, _ = report_lines(members, ())
    heads, units, row = (line.split() for line in lines[0].splitlines()[:3])
    assert " ".join(heads) == "bearing_*. whirl largest force safety least gap settled require-"
    assert units == ["clearance", "[N]", "[um]", "[s]", "ments"]
    assert row == ["1", "0.2", "mm", "no", "1000", "2", "25", "-", "not", "met"]
    more = 'of several bearings the worst; --pick "*": all 15 quantities'
    assert lines[0].splitlines()[3].startswith(more)
    assert lines[0].endswith("; keys: touchdown scenes --quantities")
    every, _ = report_lines(members, (), everything=True)
    shown = [line.rsplit("  ", 1) for line in every[0].splitlines() if line.startswith("  ")]
    told = {head.strip(): value for head, value in shown}
    names = list(told)
    assert {item.head for item in items_of(members)} <= set(names)
    forces = names.index("largest contact force, A [N]")
    assert names[forces + 1] == "largest contact force, B [N]"
    assert names.index("the scene's energy [J]") > names.index("requirements met")
    assert told["radius of the whirl, A [um]"] == "200"
