"""Runs that go on from the end of another: to the bit as one in one piece; forked; after a signal."""

from __future__ import annotations

import re
import shutil
import signal
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from systems import recorded

import touchdown
from touchdown.command.cli import main
from touchdown.master.common.errors import Ended, TouchdownError
from touchdown.master.coupling.bonds.bond import WAYS, Bond
from touchdown.master.coupling.bonds.exchange import BondExchange
from touchdown.master.coupling.connections import Connection
from touchdown.master.coupling.snapshot import read_state, write_state
from touchdown.master.interop.find_scene import find_scene
from touchdown.master.results import run as run_module
from touchdown.master.results.result import Result
from touchdown.master.results.resume import STATE_FILE
from touchdown.master.results.run import run_scene
from touchdown.master.scene.file import load_scene
from touchdown.master.scene.scene import Scene

CUT, END = "11.03 ms", "20 ms"  # not a recorded step; the disk has landed, the magnetic bearing has gone
TIMED = {"wall_time", "start_up_time", "wall_time_per_simulated_second"}


def disk(duration: str, **run: object) -> Scene:
    settings = {f"run.{key}": value for key, value in run.items()}
    return load_scene("disk-caged-simplified").set({"run.duration": duration, **settings})


def same(one: Result, other: Result) -> None:
    """Every row of every column, and all figures but of wall time."""
    rows, others = recorded(one.folder), recorded(other.folder)
    assert rows.keys() == others.keys()
    assert len(rows["time"]) > 100
    for name in rows:
        np.testing.assert_array_equal(rows[name], others[name], name)
    figures, expected = one.flat, other.flat
    assert {k: v for k, v in figures.items() if k not in TIMED} == {
        k: v for k, v in expected.items() if k not in TIMED
    }
    assert one.ending == other.ending


@pytest.fixture(scope="module")
def ended(tmp_path_factory: pytest.TempPathFactory) -> Result:
    """A run in process that ended while the disk bounces."""
    return run_scene(disk(CUT), tmp_path_factory.mktemp("ended"), in_process=True)


@pytest.mark.parametrize("in_process", [True, False])
@pytest.mark.parametrize("scheme", ["interface", "halving", "jacobi-lead"])
def test_it_goes_on_as_if_it_had_not_ended(tmp_path: Path, in_process: bool, scheme: str) -> None:
    run = {"scheme": scheme, "macro_step": 1e-4 if scheme == "interface" else 2e-5}
    whole = run_scene(disk(END, **run), tmp_path / "whole", in_process)
    run_scene(disk(CUT, **run), tmp_path / "run", in_process)
    beside = run_scene(disk(END, **run), tmp_path / "beside", continue_from=tmp_path / "run")
    same(beside, whole)
    same(run_scene(disk(END, **run), tmp_path / "run", continue_from=tmp_path / "run"), whole)


def test_the_hint_of_a_fork_names_a_scene_that_there_is(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """A rotor of a file beside a scene somewhere; the fork's own record is a scene, too."""
    monkeypatch.chdir(tmp_path)
    scene = disk("9 ms").set({"rotor.eccentricity": "5 um"})
    run_scene(replace(scene, name="mine"), tmp_path / "run", in_process=True)
    assert (
        main(["run", "--from", "run", "--duration", "10 ms", "-o", "on", "--quiet", "--no-pictures"]) == 0
    )
    (named,) = re.findall("`touchdown verdict (.*?)`", capsys.readouterr().out)
    assert find_scene(named).name == "mine"


def interrupted(scene: Scene, folder: Path) -> Result:
    """A run that a signal ends as soon as it tells how far it is."""

    def shown(_: object) -> Callable[[float, float], None]:
        return lambda time, share: signal.raise_signal(signal.SIGTERM)

    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(run_module._Bar, "__enter__", shown)
        broken = run_scene(scene, folder, in_process=True)
    assert broken.ended is Ended.INTERRUPTED
    return broken


def test_so_does_one_that_a_signal_ended(ended: Result, tmp_path: Path) -> None:
    broken = interrupted(disk(CUT), tmp_path)
    assert broken.summary["end_time"] < ended.summary["end_time"]
    same(run_scene(disk(CUT), tmp_path, continue_from=tmp_path), ended)


def test_a_fork_differs_from_where_it_starts(ended: Result, tmp_path: Path) -> None:
    scene = disk("30 ms")  # it lands again
    plain = run_scene(scene, tmp_path / "plain", continue_from=ended.folder)
    rougher = scene.set({"bearing.friction.dynamic": 0.3})
    fork = run_scene(rougher, tmp_path / "fork", continue_from=ended.folder)
    rows, others = recorded(plain.folder), recorded(fork.folder)
    early = rows["time"] < 0.01102
    np.testing.assert_array_equal(rows["rotor/A.omega"][early], others["rotor/A.omega"][early])
    assert rows["rotor/A.omega"][-1] > others["rotor/A.omega"][-1] + 1e-3


def levitated(folder: Path) -> Result:
    """A run that ends ahead of a shutdown at 5 ms."""
    return run_scene(disk(END, until="shutdown"), folder, in_process=True)


def test_phases_of_the_shutdown_start_from_one_state(tmp_path: Path) -> None:
    """Times count from each fork's own shutdown, those of the rows before it, too."""
    held = levitated(tmp_path / "held")
    assert held.ended is Ended.COMPLETED
    assert held.recording.time[-1] == pytest.approx(0.0, abs=1e-9)
    assert held.summary["seats"]["A"]["first_contact_time"] is None
    scene = disk("12 ms")
    later = run_scene(
        scene.set({"amb.shutdown_time": "6.003 ms"}), tmp_path / "later", continue_from=held.folder
    )
    whole = run_scene(scene.set({"amb.shutdown_time": "6.003 ms"}), tmp_path / "whole", in_process=True)
    rows, others = recorded(later.folder), recorded(whole.folder)
    np.testing.assert_allclose(rows["time"], others["time"], atol=1e-15)
    np.testing.assert_array_equal(rows["bearing/contact.force"], others["bearing/contact.force"])
    first = whole.summary["seats"]["A"]["first_contact_time"]
    assert later.summary["seats"]["A"]["first_contact_time"] == first


def test_members_of_a_sweep_are_forks(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    held = levitated(tmp_path / "held").folder
    scene, times = disk("12 ms"), ["5 ms", "5.5 ms", "7.21 ms"]
    out = tmp_path / "sweep"
    varied = ["--vary", f"amb.shutdown_time={','.join(times).replace(' ms', '')} ms", "--duration", "12 ms"]
    command = ["sweep", "--from", str(held), *varied, "--jobs", "1", "--keep", "--quiet", "-o", str(out)]
    assert main(command) == 0
    members = touchdown.open_sweep(out)
    for member, time in zip(members, times, strict=True):
        alone = scene.set({"amb.shutdown_time": time})
        fork = run_scene(alone, tmp_path / time, continue_from=held)
        assert recorded(out / f"{member.number:03}").keys() == recorded(fork.folder).keys()
        for name, column in recorded(fork.folder).items():
            np.testing.assert_array_equal(recorded(out / f"{member.number:03}")[name], column, name)
        assert members.scene(member.number).run.until == "end"
    contacts = [member.summary["seats"]["A"]["first_contact_time"] for member in members]
    assert len(set(contacts)) == 3
    assert main(["run", str(out), "--member", "1"]) != 0
    assert "start at the end of" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("name", "values", "said"),
    [
        ("bearing.clearance", ["0.2 mm"], "bearing.clearance stays what it was in"),
        (
            "amb.shutdown_time",
            ["6 ms", "4.9 ms"],
            "amb.shutdown_time = 0.0049 s is before the end of the run",
        ),
        ("run.macro_step", ["5 us"], "in run.macro_step; a run that goes on may change"),
    ],
)
def test_a_sweep_of_what_no_fork_can_change_is_refused(
    tmp_path: Path, name: str, values: list[str], said: str
) -> None:
    held = levitated(tmp_path / "held").folder
    with pytest.raises(TouchdownError, match=said):
        touchdown.sweep(disk("12 ms"), {name: values}, tmp_path / "sweep", continue_from=held)
    assert not (tmp_path / "sweep").exists()


def test_a_fork_goes_through_the_shutdown_that_ended_the_levitated_run(tmp_path: Path) -> None:
    """From Python as from the command, alone and in sweeps."""
    held = levitated(tmp_path / "held")
    scene = touchdown.load(held.folder / "scene.json").set({"run.duration": "2 ms"})
    fork = touchdown.run(scene, tmp_path / "fork", continue_from=held.folder)
    assert fork.recording.time[-1] == pytest.approx(2e-3)
    swept = touchdown.sweep(
        scene, {"amb.shutdown_time": ["6 ms"]}, tmp_path / "sweep", jobs=1, continue_from=held.folder
    )
    assert swept[0].summary["end_time"] == pytest.approx(2e-3)
    assert swept.scene(1).run.until == "end"


def test_a_run_that_was_interrupted_still_ends_ahead_of_the_shutdown(ended: Result, tmp_path: Path) -> None:
    scene = disk(END, until="shutdown")
    later = scene.set({"amb.shutdown_time": "30 ms"})
    interrupted(later, tmp_path)
    assert run_scene(later, tmp_path, continue_from=tmp_path).recording.time[-1] == pytest.approx(0.0)
    with pytest.raises(
        TouchdownError, match=r"zero is 0\.005 s after the start, and this run begins at 0\.016"
    ):
        run_scene(scene, tmp_path, continue_from=ended.folder)


def test_nothing_happens_before_a_fork_starts(ended: Result, tmp_path: Path) -> None:
    """Neither a shutdown that is not the scene's zero, nor an event; one of no kind does nothing."""

    def fork(scene: Scene, start: Path, changes: Mapping[str, object], said: str) -> None:
        with pytest.raises(TouchdownError, match=f"{said} = 0.001 s is before the end of the run in"):
            run_scene(scene.set(changes), tmp_path / "fork", continue_from=start)

    without_zero = replace(disk("8 ms"), zero=None)
    run_scene(without_zero, tmp_path / "disk", in_process=True)
    later = without_zero.set({"run.duration": "9 ms"})
    fork(later, tmp_path / "disk", {"amb.shutdown_time": "1 ms"}, "amb.shutdown_time")
    scene = load_scene("disk-caged-relevitated").set({"run.until": "shutdown", "amb.event[3].time": "1 ms"})
    run_scene(scene, tmp_path / "held", in_process=True)
    for what, changes in {
        "amb.event[2].time": {"amb.event[2].time": "1 ms", "amb.event[2].kind": 1},
        "amb.event[3].time": {"amb.event[3].kind": 1},
        "controller.event[3].time": {"controller.event[3].time": "1 ms", "controller.event[3].kind": 1},
    }.items():
        fork(scene, tmp_path / "held", changes, re.escape(what))
    allowed = scene.set(
        {"run.duration": "0.1 ms", "amb.event[2].time": "1 ms", "amb.event[4].time": "6 ms"}
    )
    found = run_scene(
        allowed.set({"amb.event[4].kind": 1}), tmp_path / "on", continue_from=tmp_path / "held"
    )
    assert found.ending.value("amb.event[2].time") == 1e-3


REFUSED: Mapping[str, tuple[Mapping[str, object], str]] = {
    "a fixed parameter": (
        {"bearing.clearance": 3e-4},
        "bearing.clearance stays what it was .* friction.static",
    ),
    "another macro step": ({"run.macro_step": 5e-5}, "differs from that of .* in run.macro_step"),
    "the end that was": ({"run.duration": CUT}, "has come to run.duration = 0.01103 s already"),
    "a place of its own": ({"bearing.friction.dynamic": 0.2}, "needs a folder beside"),
}


@pytest.mark.parametrize("what", REFUSED)
def test_what_cannot_be_is_refused_and_leaves_the_run(ended: Result, tmp_path: Path, what: str) -> None:
    changes, said = REFUSED[what]
    folder = tmp_path / "run"
    shutil.copytree(ended.folder, folder)
    before = {path.name: path.read_bytes() for path in folder.iterdir()}
    with pytest.raises(TouchdownError, match=said):
        run_scene(disk(END).set(changes), folder, continue_from=folder)
    assert {path.name: path.read_bytes() for path in folder.iterdir()} == before


def test_a_setting_less_is_that_of_the_model(tmp_path: Path) -> None:
    """Where it is tunable, and the run goes on in a folder of its own; else it is refused."""
    settings = {"rotor.drag": 0.2, "bearing.ring.mass": 0.016}
    run_scene(disk("6 ms").set(settings), tmp_path / "run", in_process=True)
    kept = disk("7 ms").set({"bearing.ring.mass": 0.016})
    found = run_scene(kept, tmp_path / "next", continue_from=tmp_path / "run")
    assert found.ending.value("rotor.drag") == 0.0
    for scene, folder, said in (
        (kept, "run", "needs a folder beside"),
        (disk("7 ms").set({"rotor.drag": 0.2}), "other", "bearing.ring.mass stays what it was"),
    ):
        with pytest.raises(TouchdownError, match=said):
            run_scene(scene, tmp_path / folder, continue_from=tmp_path / "run")


def test_a_setting_less_is_what_a_swap_took_over(tmp_path: Path) -> None:
    scene = disk("6 ms").set({"bearing.friction.dynamic": 0.2})
    components = {**scene.components, "bearing": replace(scene.components["bearing"], own=())}
    swapped = replace(scene, components=components).swap(bearing="simplified_cageless")
    run_scene(swapped.set({"bearing.friction.dynamic": 0.3}), tmp_path / "run", in_process=True)
    found = run_scene(
        swapped.set({"run.duration": "7 ms"}), tmp_path / "on", continue_from=tmp_path / "run"
    )
    assert found.ending.value("bearing.friction.dynamic") == 0.2


def test_damaged_and_missing_states_are_refused(ended: Result, tmp_path: Path) -> None:
    folder = tmp_path / "run"
    shutil.copytree(ended.folder, folder)
    state = read_state(folder / STATE_FILE)

    def refused(said: str) -> None:
        with pytest.raises(TouchdownError, match=said):
            run_scene(disk(END), tmp_path / "next", continue_from=folder)

    for change, said in (
        ({"version": "0.0"}, "is of version 0.0"),
        ({"run": {}}, "not as a run leaves it"),
        ({"signals": np.zeros(1000)}, "is not of this scene"),
        ({"components": {**state["components"], "bearing": b"x"}}, "bearing: its state is of another"),
    ):
        write_state(folder / STATE_FILE, {**state, **change})
        refused(said)
    (folder / STATE_FILE).write_bytes(b"PK")
    refused("damaged or not a run's state")
    (folder / STATE_FILE).unlink()
    refused(f"has no {STATE_FILE}")


def test_a_bond_remembers_what_it_has_seen(tmp_path: Path) -> None:
    """Two motions and forces, both ways through the file."""
    force, position = Connection("a", "f", "b", "f"), Connection("b", "x", "a", "x")
    one, other = (BondExchange(Bond(force, position, None), WAYS["smooth"], late=True) for _ in range(2))
    one._signals, one._force, one._motion = np.array([3.0, 0.5]), 0, [1]
    for k in range(3):
        one.begin(0.1 * k, 0.1)
        one._signals[:] = 3.0 + k * k, 0.5 * k
        one.observe(1.0, [0.4], last=True)
        one.end()
    write_state(tmp_path / STATE_FILE, one.save())
    other.load(read_state(tmp_path / STATE_FILE))
    assert other.past == one.past
    assert len(other.past.moved) == 4
