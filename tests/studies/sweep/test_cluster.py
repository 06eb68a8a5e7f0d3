"""A sweep on a Dask cluster on the loopback: rows as here, also where a worker is killed."""

from __future__ import annotations

import os
import socket
import subprocess
import sys
import time
from collections.abc import Generator
from pathlib import Path
from subprocess import Popen

import pytest
from places import ROOT

from touchdown.master.common.errors import TouchdownError
from touchdown.master.common.progress import Progress
from touchdown.master.scene.file import load_scene
from touchdown.studies.sweep.design import Design
from touchdown.studies.sweep.sweep import sweep
from touchdown.studies.sweep.tasks import Running

pytestmark = pytest.mark.slow

pytest.importorskip("distributed")

HOST = "127.0.0.1"
SCENE = "disk-caged-simplified"


def started(folder: Path, kind: str, *arguments: str) -> Popen[bytes]:
    """A process of `dask`; what it says is in a file."""
    environment = {**os.environ, "PYTHONPATH": str(ROOT / "src"), "OPENBLAS_NUM_THREADS": "1"}
    command = [sys.executable, "-m", "dask", kind, "--no-dashboard", *arguments]
    with (folder / f"{kind}.log").open("ab") as log:
        return Popen(command, cwd=folder, env=environment, stdout=log, stderr=subprocess.STDOUT)


@pytest.fixture
def cluster(tmp_path: Path) -> Generator[tuple[str, list[Popen[bytes]]]]:
    """The address of a scheduler, and its two workers."""
    with socket.socket() as probe:
        probe.bind((HOST, 0))
        address = f"tcp://{HOST}:{probe.getsockname()[1]}"
    scheduler = started(tmp_path, "scheduler", "--host", address)
    alone = ("--nthreads", "1", "--no-nanny", "--host", HOST, "--local-directory", str(tmp_path))
    workers = [started(tmp_path, "worker", address, *alone) for _ in range(2)]
    try:
        yield address, workers
    finally:
        for process in (*workers, scheduler):
            process.kill()
            process.wait()


@pytest.mark.long
def test_rows_are_those_of_this_machine_though_a_worker_is_killed(
    cluster: tuple[str, list[Popen[bytes]]], tmp_path: Path
) -> None:
    address, workers = cluster
    scene = load_scene(SCENE).set({"run.duration": "20 ms"})
    design = Design.grid({"rotor.mass": [1.0, 1.5, 2.0], "run.macro_step": ["20 us", "1 s"]})
    design *= Design.grid({"bearing.clearance": ["0.2 mm", "0.3 mm"]})
    heard: list[float] = []

    def done() -> None:
        heard.append(time.monotonic())
        if len(heard) == 3:
            workers[0].kill()

    running = Running(cluster=address, in_process=True)
    there = sweep(scene, design, tmp_path / "there", running, Progress(lambda _: None, done))
    here = sweep(scene, design, tmp_path / "here", Running(jobs=1, in_process=True))
    assert workers[0].wait() != 0
    assert len(heard) == len(design) == 12
    assert [m.failed for m in there] == [m.failed for m in here]
    assert [bool(m.failed) for m in there] == 3 * [False, False, True, True]
    for name in ("sweep.nc", "sweep.csv"):
        assert (tmp_path / "there" / name).read_bytes() == (tmp_path / "here" / name).read_bytes()


def test_a_scheduler_that_is_not_there_is_said(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from touchdown.master.common import pool

    monkeypatch.setattr(pool, "SCHEDULER_TIMEOUT_S", 0.5)
    design = Design.grid({"rotor.mass": [1.0]})
    for address in ("tcp://127.0.0.1:1", "nowhere"):
        with pytest.raises(TouchdownError, match=f"no Dask scheduler answers at {address[:3]}"):
            sweep(load_scene(SCENE), design, tmp_path / "out", Running(cluster=address, in_process=True))
        assert not (tmp_path / "out").exists()  # else the next command there would be another sweep
