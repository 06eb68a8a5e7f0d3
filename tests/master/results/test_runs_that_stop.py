"""Runs that cannot be written, or that ledger or user stop: one line, and what was recorded stays."""

from __future__ import annotations

import json
import re
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest
from commands import SCENE, SHORT, Command, Ended
from places import COMMAND

from touchdown.master.common import interrupts
from touchdown.master.common.errors import FAILED, STOPPED
from touchdown.master.common.interrupts import interrupts_noted, signals_as_interrupt
from touchdown.master.coupling.observer import LOOK_INTERVAL_STEPS
from touchdown.master.coupling.recorder import Recorder
from touchdown.master.coupling.simulation import Outcome
from touchdown.master.results import run as results_run

PATIENCE = 120.0  # s; a test that waits longer has failed


# -- folders -----------------------------------------------------------------------------------------


def test_a_folder_that_cannot_be_written(command: Command, tmp_path: Path):
    (tmp_path / "file").write_text("in the way")
    out = tmp_path / "file" / "out"
    for arguments in (("run", SCENE, "--quiet", "--in-process"), ("build", "housing")):
        assert f"cannot write to {out}" in command(*arguments, "-o", out).line


@pytest.mark.parametrize("name", ["result.h5", "summary.json"])
def test_a_result_that_cannot_be_written(name: str, run: Command, tmp_path: Path):
    (tmp_path / "out" / name).mkdir(parents=True)
    assert name in run(SCENE, *SHORT).line


FULL = """
import os, sys
allowed, write = int(sys.argv[1]), os.write
def limited(descriptor, data):
    global allowed
    allowed -= 1
    if allowed < 0 and len(data) > 2000:
        raise OSError(28, "No space left on device")
    return write(descriptor, data)
os.write = limited
from touchdown.command.cli import main
sys.exit(main(sys.argv[2:]))
"""


@pytest.mark.slow
@pytest.mark.parametrize("allowed", [1, 9])  # writes: the folder claimed; a file begun
def test_a_disk_that_runs_full(allowed: int, tmp_path: Path):
    """The rows that were written stay."""
    settings = ("--set", "run.duration=0.1", "--set", "run.record_every=1")
    arguments = ("run", SCENE, *settings, "--in-process", "--no-pictures", "--quiet", "-o", str(tmp_path))
    made = subprocess.run(
        [sys.executable, "-c", FULL, str(allowed), *arguments], capture_output=True, text=True, check=False
    )
    line = f"cannot write {tmp_path / 'result.h5'}: No space left on device; make room for it"
    if allowed == 1:
        assert (made.returncode, made.stderr) == (FAILED, f"touchdown: {line}\n")
        return
    kept = f"what was recorded is in {tmp_path}"
    assert (made.returncode, made.stderr) == (STOPPED, f"touchdown: stopped: {line}; {kept}\n")
    summary, rows = left_behind(tmp_path)
    assert summary["ended"] == "stopped"
    assert rows > 100


# -- runs that stop ----------------------------------------------------------------------------------


def left_behind(folder: Path) -> tuple[dict[str, object], int]:
    """Summary and number of rows of a run that ended early."""
    summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
    with h5py.File(folder / "result.h5") as file:
        time, journal = file["time"], file["rotor/A.y"]
        assert isinstance(time, h5py.Dataset)
        assert isinstance(journal, h5py.Dataset)
        assert len(time) == len(journal)
        return summary, int(np.count_nonzero(~np.isnan(time)))


def test_a_macro_step_too_long_for_the_scene(run: Command, tmp_path: Path):
    """The ledger stops the run, says where energy comes from and what to try; what was recorded stays."""
    changes = ("run.scheme=hold", "run.macro_step=1 ms", "run.record_every=1")
    ended = run(SCENE, *(part for change in changes for part in ("--set", change)))
    assert ended.status == STOPPED
    assert re.search(r"energy error of the coupling at \w+\.\w+ on \w+\.\w+", ended.line)
    advice = re.search(r'try --set "run.macro_step=([-.\de]+) us"', ended.line)
    assert advice is not None
    assert 0.0 < 1e-6 * float(advice[1]) < 1e-3
    summary, rows = left_behind(tmp_path / "out")
    assert summary["completed"] is False
    assert rows > 1


def process(folder: Path, *head: str) -> subprocess.Popen[str]:
    """The scene, run through its FMUs by a process of its own for longer than any test waits."""
    run = ("run", SCENE, "--duration", "500 s", "--no-pictures", "--quiet", "-o", str(folder))
    return subprocess.Popen(
        [*(head or COMMAND), *run], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )


def interrupt(running: subprocess.Popen[str], ready: Callable[[], bool]) -> Ended:
    """Press Ctrl-C as soon as `ready`."""
    deadline = time.monotonic() + PATIENCE
    while not ready():
        assert running.poll() is None, "it ended before it could be interrupted"
        assert time.monotonic() < deadline
        time.sleep(0.002)
    running.send_signal(signal.SIGINT)
    return finished(running)


def finished(running: subprocess.Popen[str]) -> Ended:
    """Wait for its end."""
    try:
        _, stderr = running.communicate(timeout=PATIENCE)
    finally:
        running.kill()
    return Ended(running.returncode, stderr)


def check_interrupted(ended: Ended, folder: Path) -> None:
    """Interrupted: said in one line, and what was recorded is there."""
    assert ended.status == 130, ended.stderr
    assert "interrupted" in ended.line
    summary, rows = left_behind(folder)
    assert summary["completed"] is False
    assert rows > 0


def test_ctrl_c_before_the_first_row(
    command: Command, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The folder has nothing, or what an earlier run left, and that is said."""

    def broken(*_: object) -> None:
        raise KeyboardInterrupt

    arguments = ("run", SCENE, *SHORT, "--quiet", "--in-process", "--no-pictures", "-o", tmp_path / "out")
    with monkeypatch.context() as patched:
        patched.setattr(results_run, "make_ready", broken)
        ended = command(*arguments)
        assert (ended.status, ended.line) == (
            130,
            f"touchdown: interrupted; nothing was recorded in {tmp_path / 'out'}",
        )
    assert command(*arguments).status == 0
    monkeypatch.setattr(results_run, "make_ready", broken)
    assert "out has the results of a whole run, the earlier one" in command(*arguments).line
    (tmp_path / "out" / "summary.json").unlink()
    assert "out has no summary.json" in command(*arguments).line


@pytest.mark.slow
def test_ctrl_c_in_mid_run(tmp_path: Path):
    """There is more than the first row, so the loop is running."""
    result = tmp_path / "result.h5"
    ended = interrupt(process(tmp_path), lambda: result.exists() and rows_in(result) > 1)
    check_interrupted(ended, tmp_path)


def test_a_ctrl_c_that_comes_twice_at_once_is_one(monkeypatch: pytest.MonkeyPatch) -> None:
    """Another one, later, breaks off whatever it finds."""
    with interrupts_noted() as noted:
        for _ in range(2):
            signal.raise_signal(signal.SIGINT)
        assert noted.is_set()
        monkeypatch.setattr(interrupts, "SAME_SIGNAL_S", -1.0)
        with pytest.raises(KeyboardInterrupt):
            signal.raise_signal(signal.SIGINT)


# -- other signals, and kills ------------------------------------------------------------------------


@pytest.fixture(params=[signal.SIGTERM, signal.SIGQUIT])
def by(request: pytest.FixtureRequest) -> Iterator[signal.Signals]:
    """A signal that nobody ignores, though the tests may run under nohup."""
    before = signal.signal(request.param, signal.SIG_DFL)
    yield request.param
    signal.signal(request.param, before)


def test_batch_systems_end_a_run_as_ctrl_c_does(
    by: signal.Signals, run: Command, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    took, rows = Recorder.took, 0

    def sent(recorder: Recorder, count: int) -> None:
        nonlocal rows
        took(recorder, count)
        rows += count
        if rows - count < 9 <= rows:
            signal.raise_signal(by)

    monkeypatch.setattr(Recorder, "took", sent)
    ended = run(SCENE, *SHORT)
    assert ended.status == 130
    assert f"interrupted by {by.name}" in ended.line
    summary, kept = left_behind(tmp_path / "out")
    assert (summary["ended"], kept) == ("interrupted", rows)
    assert 9 <= rows < 9 + LOOK_INTERVAL_STEPS
    assert signal.getsignal(by) is signal.SIG_DFL


def test_a_signal_that_is_ignored_stays_ignored() -> None:
    """As nohup does with SIGHUP."""
    before = signal.signal(signal.SIGHUP, signal.SIG_IGN)
    try:
        with signals_as_interrupt(), interrupts_noted() as noted:
            signal.raise_signal(signal.SIGHUP)
            assert not noted.is_set()
    finally:
        signal.signal(signal.SIGHUP, before)


def test_outside_of_runs_they_break_off_what_the_command_does(by: signal.Signals) -> None:
    with signals_as_interrupt(), pytest.raises(KeyboardInterrupt):
        signal.raise_signal(by)


@pytest.mark.slow
def test_a_run_that_is_killed(run: Command, tmp_path: Path) -> None:
    """Nobody else writes where it lives; killed, it leaves its rows, no summary, and the folder free."""
    out = tmp_path / "out"
    out.mkdir()
    (out / "summary.json").write_text('{"completed": true}', encoding="utf-8")
    result = out / "result.h5"
    running = process(out)
    try:
        deadline = time.monotonic() + PATIENCE
        while not result.exists() or rows_in(result) < 2:
            assert running.poll() is None
            assert time.monotonic() < deadline
            time.sleep(0.002)
        assert f"another run is writing to {out}" in run(SCENE, *SHORT).line
    finally:
        running.kill()
        running.communicate()
    assert rows_in(result) >= 2
    assert not (out / "summary.json").exists()
    assert json.loads((out / "scene.json").read_text(encoding="utf-8"))["name"] == SCENE
    assert run(SCENE, *SHORT) == Ended(0, "")
    left = ["ending.json", "result.h5", "scene.json", "state.npz", "summary.json"]
    assert sorted(path.name for path in out.iterdir()) == left


def rows_in(path: Path) -> int:
    """How many rows there are, also while they are written."""
    with h5py.File(path) as file:
        return int(np.count_nonzero(~np.isnan(file["time"])))


@pytest.mark.parametrize("mistake", ["bearing.clearance=0.25", "run.macro_step=20"])
def test_a_run_that_is_refused_leaves_what_there_was(run: Command, tmp_path: Path, mistake: str) -> None:
    run(SCENE, *SHORT)
    before = {path.name: path.read_bytes() for path in (tmp_path / "out").iterdir()}
    assert run(SCENE, *SHORT, "--set", mistake).status == FAILED
    assert {path.name: path.read_bytes() for path in (tmp_path / "out").iterdir()} == before


def test_what_a_bearing_refuses_is_said_through_its_fmu_too(command: Command, tmp_path: Path) -> None:
    """It has no outputs then; the housing, which is handed them, is not to blame."""
    refused = command("run", SCENE, *SHORT, "--set", "bearing.clearance=0.25", "--quiet", "-o", tmp_path)
    assert "component bearing: clearance = 0.25 m is out of all proportion" in refused.line


def test_what_an_earlier_run_left_goes_first(
    run: Command, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its pictures too, and no others."""
    out = tmp_path / "out"
    run(SCENE, *SHORT)
    for name in ("result.csv", "orbit.png", "energy-bearing.png", "mine.png", "orbit-of-mine.png"):
        (out / name).touch()
    seen: list[str] = []
    simulate = results_run.simulate

    def looked_at(*given: Any) -> Outcome:
        *others, begin, resumed = given

        def look() -> None:
            begin()
            seen.extend(path.name for path in out.iterdir())

        return simulate(*others, look, resumed)

    monkeypatch.setattr(results_run, "simulate", looked_at)
    run(SCENE, *SHORT)
    assert sorted(seen) == [".touchdown.lock", "mine.png", "orbit-of-mine.png", "scene.json"]
